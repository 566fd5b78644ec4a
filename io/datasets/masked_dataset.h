#pragma once

#include <filesystem>
#include <memory>

#include "ldso/io/dataset.h"

namespace ldso {

// Which pixels of a sequence are not to be used: as a mask says, or because the image is round or has black bars.

/// The word that takes the place of a mask's path if nothing is to be masked.
inline constexpr const char* kNoMask = "none";

/// The sequence with masks for its frames: as `mask` says, an image for all of them or a folder with one for each
/// (white counts), and where the images are black up to their edge in every frame (dark_border.h), of which a warning
/// tells. Masks of a folder belong to the images of the same name, whatever their endings; if none has such a name and
/// there are as many as frames, to those in their order. `mask` is `none`: the sequence as it is.
/// Throws Error if a mask cannot be read or has another size than the images.
std::unique_ptr<Dataset> make_masked_dataset(std::unique_ptr<Dataset> sequence,
                                             const std::optional<std::filesystem::path>& mask);

}  // namespace ldso
