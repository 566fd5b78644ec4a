#pragma once

#include <string_view>

namespace ldso {

/// Whether the bytes are a text in UTF-8: what YAML and JSON are written in, and names of files need not be.
bool is_utf8(std::string_view text);

}  // namespace ldso
