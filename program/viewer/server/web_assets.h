#pragma once

// The files of the front end, which the build put into the program.

#include <string_view>

namespace ldso {

struct WebAsset {
  std::string_view path;  ///< "/", "/app.js", ...
  std::string_view type;  ///< Media type.
  std::string_view content;
  bool is_page = false;  ///< The page itself, which takes the token; the rest is code without anything of the run.
};

/// Nothing if there is no such file.
const WebAsset* find_web_asset(std::string_view path);

}  // namespace ldso
