#pragma once

#include <string>

namespace ldso {

/// The frames of a checkpoint.json that were processed, of those that there are, in words. Throws Error, with `name` as
/// the context, if the text is damaged.
std::string describe_checkpoint(const std::string& text, const std::string& name);

}  // namespace ldso
