#pragma once
// The vignette of a camera from many images of a plane with a board on it (J. Engel, V. Usenko, D. Cremers, "A
// photometrically calibrated benchmark for monocular visual odometry", arXiv:1607.02555, section 2.3.2): each part of
// the plane looks the same from everywhere, so that where it is darker in one image than in another is the lens.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "calibration/board/board.h"
#include "geometry/camera_model.h"
#include "ldso/image.h"
#include "ldso/se3.h"

namespace ldso {

/// What one image shows of the plane: pixels of its cells, and their irradiance (inverse response of the level); cells
/// out of sight are left out.
struct PlaneView {
  struct Sample {
    int cell = 0;
    Eigen::Vector2f pixel;
    float irradiance = 0;
  };
  std::vector<Sample> samples;
  std::optional<double> exposure_ms;
};

/// The plane around a board, in cells; the board's own markers are a part of it.
class ObservedPlane {
 public:
  /// `inverse_response`: of levels 0..255; nothing for a linear camera.
  ObservedPlane(const Board& board, const CameraModel& camera,
                const std::optional<std::array<double, 256>>& inverse_response);

  int cells() const { return kCellsAlong * kCellsAlong; }

  /// Of an image with grey levels 0..255; nothing if the board is not found in it.
  std::optional<PlaneView> view(ImageView<const float> grey) const;

 private:
  static constexpr int kCellsAlong = 160;

  std::optional<SE3d> find_pose(ImageView<const float> grey) const;
  double irradiance(float level) const;

  const Board board_;
  const CameraModel& camera_;
  const std::optional<std::array<double, 256>> response_;
  Eigen::Vector2d corner_;
  double cell_size_ = 0;
};

struct VignetteEstimate {
  Image<float> vignette;  ///< Of the image's size, at most 1.
  double rms = 0;         ///< Of irradiances minus what plane and vignette explain, relative to their mean.
  double seen_share = 0;  ///< Of the image in which the plane was seen often enough; the rest is continued from it.
  bool exposures_known = false;
};

/// Throws Error that calls the images `where` if there are fewer than 10 views or they cover less than half of the
/// image.
VignetteEstimate estimate_vignette(const std::vector<PlaneView>& views, int plane_cells, int width, int height,
                                   const std::string& where);

}  // namespace ldso
