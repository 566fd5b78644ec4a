#include "viewer/web_assets.h"

#include <array>

// The assembler puts the files as they are; LDSO_WEB_DIR comes from CMakeLists.txt.
#ifdef __APPLE__
#define LDSO_SECTION ".const_data"
#define LDSO_SYMBOL(name) "_" name
#else
#define LDSO_SECTION ".section .rodata"
#define LDSO_SYMBOL(name) name
#endif
#define LDSO_EMBED(name, file)                                                                                         \
  __asm__(LDSO_SECTION "\n.globl " LDSO_SYMBOL(#name "_begin") "\n.globl " LDSO_SYMBOL(#name "_end") "\n" LDSO_SYMBOL( \
      #name "_begin") ":\n.incbin \"" LDSO_WEB_DIR "/" file "\"\n" LDSO_SYMBOL(#name "_end") ":\n.byte 0\n.text\n");   \
  extern "C" const char name##_begin[];                                                                                \
  extern "C" const char name##_end[]

LDSO_EMBED(ldso_web_index, "index.html");
LDSO_EMBED(ldso_web_script, "app.js");
LDSO_EMBED(ldso_web_style, "style.css");
LDSO_EMBED(ldso_web_icon, "icon.svg");

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
