#pragma once

// Idea: a texture is a band-limited pyramid of radiance; a look-up integrates it over the ellipse that a pixel covers
// (several trilinear probes along the long axis, after McCormack et al., "Feline", SIGGRAPH 1999), so that what the
// camera sees depends on the surface and not on how it was sampled.

#include <cstdint>
#include <vector>

#include "ldso/image.h"

namespace ldso::simulation {

/// A point on a texture and the change of its coordinates per pixel, all in texels of the finest level.
/// Texel centres are at integer + 0.5.
struct Footprint {
  float s = 0, t = 0;
  float ds_dx = 0, dt_dx = 0;
  float ds_dy = 0, dt_dy = 0;
};

enum class TextureWrap { kClamp, kRepeat };

/// Values in [0, 2) with 16 bits, in pages of 64x64 texels. Pages of the fine levels may be missing where nobody will
/// look closely; look-ups then use the next coarser level.
class Texture {
 public:
  static constexpr int kPageBits = 6;
  static constexpr int kPage = 1 << kPageBits;

  Texture() = default;

  /// All levels of an image.
  explicit Texture(const Image<float>& finest, TextureWrap wrap = TextureWrap::kClamp);

  /// An empty texture to be filled page by page. `width`, `height` of the finest level [texels].
  Texture(int width, int height, int levels);

  int width() const { return levels_.empty() ? 0 : levels_[0].width; }
  int height() const { return levels_.empty() ? 0 : levels_[0].height; }
  int level_count() const { return static_cast<int>(levels_.size()); }
  int level_width(int level) const { return levels_[level].width; }
  int level_height(int level) const { return levels_[level].height; }
  int pages_x(int level) const { return levels_[level].pages_x; }
  int pages_y(int level) const { return levels_[level].pages_y; }
  bool has_page(int level, int page_x, int page_y) const;

  /// Adds storage for a page; not thread-safe. Call before the pages are filled.
  void add_page(int level, int page_x, int page_y);
  /// Sets a texel of an existing page. Different pages can be filled by different threads.
  void set(int level, int x, int y, float value);
  float texel(int level, int x, int y) const;
  /// Computes the pages of `level` that have the four finer pages below them from level - 1.
  void downsample_to(int level);
  /// Copies the first row and column of neighbouring pages, which makes bilinear look-ups local. Call when all is set.
  void finish();

  /// Mean over the footprint of one pixel. `max_probes` bounds the work at grazing angles.
  float sample(const Footprint& footprint, int max_probes) const;
  /// One trilinear probe of the given width [texels].
  float probe(float s, float t, float width) const;

 private:
  static constexpr float kScale = 2.0f / 65536.0f;
  struct Level {
    int width = 0, height = 0;
    int pages_x = 0, pages_y = 0;
    std::vector<std::int32_t> page_index;  ///< -1: no such page.
    std::vector<std::uint16_t> texels;     ///< `page_texels` for each page.
    int stride = 0;       ///< Of a stored page: it has one more row and column, owned by its neighbours.
    int page_texels = 0;  ///< Stored texels of a page.

    std::size_t offset(int page, int x, int y) const {
      return static_cast<std::size_t>(page) * page_texels + (y & (kPage - 1)) * stride + (x & (kPage - 1));
    }
    int page_of(int x, int y) const { return page_index[(y >> kPageBits) * pages_x + (x >> kPageBits)]; }
  };

  void add_level(int width, int height, bool dense);
  static std::uint16_t raw_texel(const Level& level, int x, int y);
  void finish_page(Level& level, int page_x, int page_y) const;
  bool fetch(int level, float s, float t, float& value) const;
  float fetch_or_coarser(int level, float s, float t) const;

  std::vector<Level> levels_;
  TextureWrap wrap_ = TextureWrap::kClamp;
};

}  // namespace ldso::simulation
