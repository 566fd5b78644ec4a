#pragma once
// Two images side by side with the points that they have in common: to see with one's own eyes whether they show the
// same place.

#include <Eigen/Core>
#include <filesystem>
#include <span>
#include <string>

#include "io/images/image_file.h"
#include "ldso/image.h"

namespace ldso {

/// A point in both images [px].
struct PictureMatch {
  Eigen::Vector2f left = Eigen::Vector2f::Zero();
  Eigen::Vector2f right = Eigen::Vector2f::Zero();
};

/// Height of the strip below the images that holds the caption [px].
int caption_height(const std::string& caption);

/// Both images (grey levels 0..255, rounded and clamped) beside each other, the right one beginning at column
/// `left.width`, a circle around each point and a thin line from one to the other; below, the caption, in smaller
/// letters if it is too long. The colour of a match goes with its column on the left from red over green to blue, so
/// that a match that crosses the others stands out. A point that is inside of one image only, as those of a local map
/// may be, gets a small magenta cross there. Images of different height are aligned at the top.
Image<Rgb> draw_matches(ImageView<const float> left, ImageView<const float> right,
                        std::span<const PictureMatch> matches, const std::string& caption);

/// The colour of a match at that column of a left image of that width.
Rgb match_colour(float column, int width);

}  // namespace ldso
