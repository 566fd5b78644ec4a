// Archives of images.

#include <algorithm>

#include "fuzz_target.h"
#include "io/images/image_source.h"

using namespace ldso;

LDSO_FUZZ_TARGET(zip_archive) {
  const auto path = fuzz::scratch_file("images.zip", input);
  fuzz::accepted([&] {
    const auto archive = open_image_zip(path);
    const std::vector<std::string> names = archive->names();
    fuzz::expect(std::is_sorted(names.begin(), names.end(), natural_less), "names are in order");
    for (const std::string& name : names) {
      fuzz::accepted([&] { return archive->read(name).size(); });
    }
    return names.size();
  });
}
