#pragma once

// Keeps points apart: remembers positions in the image and tells whether a new one has room around it.

#include <vector>

namespace ldso {

class SpacingGrid {
 public:
  /// Positions in [0, width) x [0, height); `spacing` is the largest distance that will be asked for [px].
  SpacingGrid(int width, int height, float spacing);

  void add(float x, float y);

  /// Whether no position lies nearer than `distance` [px]; `distance` at most the spacing.
  bool has_room(float x, float y, float distance) const;

 private:
  struct Position {
    float x, y;
  };
  int cell(float value, int cells) const;

  float spacing_;
  int columns_, rows_;
  std::vector<std::vector<Position>> cells_;
};

}  // namespace ldso
