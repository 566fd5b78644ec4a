#include "output/model_images.h"

#include <algorithm>
#include <system_error>

#include "imagery/frame_images.h"
#include "io/images/image_file.h"
#include "ldso/error.h"
#include "util/format_text.h"

namespace ldso {

namespace fs = std::filesystem;

std::string model_image_name(std::int64_t frame_id) {
  return format_text("%06lld.png", static_cast<long long>(frame_id));
}

std::string copy_model_image(const Dataset& sequence, std::int64_t frame_id, const fs::path& folder) {
  const Image<Rgb> image = sequence.read_color(static_cast<int>(frame_id));
  const fs::path source = sequence.read(static_cast<int>(frame_id)).name;
  std::error_code error;
  const bool is_file = fs::is_regular_file(source, error) && has_image_extension(source);
  if (!is_file || !has_color(image)) {  // Grey files have one channel, which not every program takes.
    std::string name = is_file ? source.stem().string() + ".png" : model_image_name(frame_id);
    write_png(folder / name, image.view());
    return name;
  }
  fs::copy_file(source, folder / source.filename(), fs::copy_options::overwrite_existing, error);
  if (error) {
    throw Error(source.string(), "cannot be copied to " + folder.string() + " (" + error.message() + ")",
                "check the permissions and the free space");
  }
  return source.filename().string();
}

}  // namespace ldso
