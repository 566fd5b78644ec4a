#pragma once

// Idea: the same room in looks that are hard on a direct method, one difficulty at a time.

namespace ldso::simulation {

enum class RoomStyle {
  kUsual,
  kWeak,       ///< Everything with a quarter of its contrast.
  kWallpaper,  ///< Bare walls with a paper that repeats exactly.
  kDark,       ///< A tenth of the light, so much more noise in comparison.
};

}  // namespace ldso::simulation
