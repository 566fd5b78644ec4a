#pragma once
// A lens from views of a board: adjusted, without points and views that are wrong, with standard deviations.

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "calibration/board/board.h"
#include "calibration/board/board_detector.h"
#include "calibration/lens/lens_model.h"
#include "ldso/calibration.h"
#include "ldso/se3.h"

namespace ldso {

/// The board as one frame shows it.
struct BoardView {
  int frame = 0;
  std::string name;  ///< For messages: the image's file, or the frame's number.
  std::vector<SeenPoint> points;
};

/// A point that the calibration was made from.
struct LensResidual {
  Eigen::Vector2d pixel;
  Eigen::Vector2d residual;  ///< Seen minus projected [px].
};

struct CalibratedView {
  int frame = 0;
  std::string name;
  SE3d pose;  ///< Board to camera.
  std::vector<LensResidual> points;
  double rms = 0;  ///< Of the distances [px].
};

struct LensCalibration {
  LensKind kind = LensKind::kRadTan;
  CameraCalibration camera;
  Eigen::VectorXd parameters;  ///< In the order of lens_parameter_names().
  Eigen::VectorXd deviations;  ///< Their standard deviations; empty if the views do not determine all of them.
  double rms = 0;              ///< Of the distances of all points [px], as OpenCV gives it.
  std::vector<CalibratedView> views;
  std::vector<std::string> refused_views;  ///< Names of those that fit to no lens that fits to the others.
  int refused_points = 0;
  bool sees_whole_image = true;  ///< Whether each pixel has a ray; false where the distortion folds over.

  int point_count() const;
};

/// Throws Error that calls the views `where` if there are fewer than three, or if they do not determine the lens at
/// all.
LensCalibration calibrate_lens(const std::vector<BoardView>& views, const Board& board, LensKind kind, int width,
                               int height, const std::string& where);

/// With the model that explains the views best without parameters that they do not need; `others` receives all of them.
LensCalibration calibrate_best_lens(const std::vector<BoardView>& views, const Board& board, int width, int height,
                                    const std::string& where, std::vector<LensCalibration>* others = nullptr);

}  // namespace ldso
