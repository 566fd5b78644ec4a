#pragma once

#include <memory>

#include "ldso/io/dataset.h"

namespace ldso {

/// Another sequence played as the options start, end, stride and reverse say. Frame ids count the frames as they are
/// played; timestamps stay those of the sequence, so they decrease in reverse. Throws Error if no frame would be left.
std::unique_ptr<Dataset> make_playback_dataset(std::unique_ptr<Dataset> sequence, const DatasetOptions& options);

}  // namespace ldso
