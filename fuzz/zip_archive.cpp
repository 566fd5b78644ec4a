// Archives of images.

#include <algorithm>

#include "fuzz_target.h"
#include "io/images/image_names.h"
#include "io/images/image_source.h"

using namespace ldso;

LDSO_FUZZ_TARGET(zip_archive) {
  const auto path = fuzz::scratch_file("images.zip", input);
  fuzz::accepted([&] {
    const auto archive = open_image_zip(path);
    const std::vector<std::string> names = archive->names();
    std::vector<std::string> sorted = names;
    sort_image_names(sorted);
    fuzz::expect(sorted == names, "names are in order");
    for (const ImageFamily& family : image_families(names)) {
      const auto own = [&](const std::string& name) { return matches_pattern(name, family.pattern); };
      fuzz::expect(std::any_of(names.begin(), names.end(), own), "a kind of images has images");
    }
    for (const std::string& name : names) {
      fuzz::accepted([&] { return archive->read(name).size(); });
    }
    return names.size();
  });
}
