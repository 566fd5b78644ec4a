#include "viewer/server/web_assets.h"

#include <array>

#include "util/embedded_file.h"

// LDSO_WEB_DIR comes from CMakeLists.txt.
LDSO_EMBED_FILE(ldso_web_index, LDSO_WEB_DIR "/index.html");
LDSO_EMBED_FILE(ldso_web_script, LDSO_WEB_DIR "/app.js");
LDSO_EMBED_FILE(ldso_web_style, LDSO_WEB_DIR "/style.css");
LDSO_EMBED_FILE(ldso_web_icon, LDSO_WEB_DIR "/icon.svg");

namespace ldso {
namespace {

std::string_view between(const char* begin, const char* end) { return {begin, static_cast<std::size_t>(end - begin)}; }

}  // namespace

const WebAsset* find_web_asset(std::string_view path) {
  static const std::array<WebAsset, 4> assets{{
      {"/", "text/html; charset=utf-8", between(ldso_web_index_begin, ldso_web_index_end), true},
      {"/app.js", "text/javascript; charset=utf-8", between(ldso_web_script_begin, ldso_web_script_end)},
      {"/style.css", "text/css; charset=utf-8", between(ldso_web_style_begin, ldso_web_style_end)},
      {"/icon.svg", "image/svg+xml", between(ldso_web_icon_begin, ldso_web_icon_end)},
  }};
  for (const WebAsset& asset : assets) {
    if (asset.path == path) return &asset;
  }
  return nullptr;
}

}  // namespace ldso
