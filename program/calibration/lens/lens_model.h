#pragma once
// The lens models that are calibrated, as one vector of parameters each.

#include <Eigen/Core>
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "geometry/camera_model.h"

namespace ldso {

enum class LensKind { kPinhole, kFov, kRadTan, kRadTanK3, kKannalaBrandt };

inline constexpr std::array kLensKinds{LensKind::kPinhole, LensKind::kFov, LensKind::kRadTan, LensKind::kKannalaBrandt,
                                       LensKind::kRadTanK3};

/// As `--model` calls it: "radtan-k3".
std::string lens_name(LensKind kind);

/// "fx", "fy", "cx", "cy" and the coefficients.
std::vector<std::string> lens_parameter_names(LensKind kind);

/// A lens with numbers: projects points with derivatives by its parameters.
class Lens {
 public:
  /// Throws Error if no camera has such parameters.
  Lens(LensKind kind, const Eigen::VectorXd& parameters, int width, int height);

  /// As CameraModel::project(); `J_parameters` is 2 x parameters.size().
  Eigen::Vector2d project(const Eigen::Vector3d& p, CameraModel::Matrix23* J_point,
                          Eigen::Matrix2Xd* J_parameters) const;

  const CameraModel& model() const { return *model_; }

 private:
  LensKind kind_;
  std::unique_ptr<CameraModel> model_;
};

}  // namespace ldso
