#include "odometry/keyframe_maker.h"

#include <algorithm>
#include <cstddef>

#include "odometry/depth/epipolar_tracer.h"
#include "odometry/tracking/keyframe_policy.h"

namespace ldso {
namespace {

/// Iterations at least with two keyframes: depths are still rough then.
constexpr int kFirstIterations = 20;
/// Iterations at least with three keyframes.
constexpr int kSecondIterations = 15;

/// What an optimization changes of a window, but for the point of linearization of the prior, which stays.
class WindowBackup {
 public:
  explicit WindowBackup(const Window& window) : camera_(window.camera), hessian_(window.hessian), rmse_(window.rmse) {
    for (const auto& keyframe : window.keyframes) {
      states_.push_back(keyframe->state);
      prior_means_.push_back(keyframe->prior_mean);
      std::vector<float>& idepths = idepths_.emplace_back();
      for (const ActivePoint& point : keyframe->points) idepths.push_back(point.idepth);
    }
  }

  /// Of the same keyframes; they may have got more points behind those they had.
  void restore(Window& window) const {
    window.camera = camera_;
    window.hessian = hessian_;
    window.rmse = rmse_;
    for (std::size_t k = 0; k < states_.size(); ++k) {
      Keyframe& keyframe = *window.keyframes[k];
      keyframe.state = states_[k];
      keyframe.prior_mean = prior_means_[k];
      keyframe.points.resize(idepths_[k].size());
      for (std::size_t i = 0; i < idepths_[k].size(); ++i) keyframe.points[i].idepth = idepths_[k][i];
    }
  }

 private:
  CameraVector camera_;
  Eigen::MatrixXd hessian_;
  double rmse_;
  std::vector<FrameState> states_;
  std::vector<FrameVector> prior_means_;
  std::vector<std::vector<float>> idepths_;
};

}  // namespace

KeyframeMaker::KeyframeMaker(const Settings& settings, const BrightnessPriors& priors, ThreadPool& pool,
                             StageTimes& times)
    : keyframes_(settings.keyframes),
      candidates_(settings.selection.candidates),
      iterations_(settings.window.iterations),
      priors_(priors),
      times_(times),
      selector_(make_point_selector(settings.selection)),
      activator_(settings.tracing, settings.window, pool),
      optimizer_(pool),
      marginalizer_(settings.window, pool) {}

bool KeyframeMaker::add(Window& window, const std::shared_ptr<const PreparedFrame>& frame, const SE3d& T_c_w,
                        const Brightness& brightness, const SE3d::Tangent& velocity) {
  const WindowBackup backup(window);
  Keyframe& keyframe = window.append(frame, T_c_w, brightness);
  const BrightnessPrior prior = priors_.of(*frame, brightness.a);
  keyframe.prior.tail<2>() << prior.a, prior.b;
  keyframe.prior_mean.tail<2>() << prior.mean_a - brightness.a, -brightness.b;
  keyframe.velocity = velocity;
  flag_leaving(keyframes_, window);
  {
    const StageTimer stage(times_, "keyframe/activate");
    activator_.activate(window);
  }
  if (optimize(window)) return true;
  window.drop_newest();
  backup.restore(window);
  return false;
}

bool KeyframeMaker::optimize(Window& window) {
  const StageTimer stage(times_, "keyframe/optimize");
  const int young = window.size() <= 2 ? kFirstIterations : window.size() == 3 ? kSecondIterations : 0;
  const OptimizationReport report = optimizer_.optimize(window, std::max(young, iterations_));
  return report.finite && report.residuals > 0;
}

std::vector<FinishedKeyframe> KeyframeMaker::clear_up(Window& window) {
  {
    const StageTimer stage(times_, "keyframe/marginalize_points");
    marginalizer_.remove_points(window);
  }
  {
    const StageTimer stage(times_, "keyframe/select");
    select_candidates(*window.keyframes.back());
  }
  const StageTimer stage(times_, "keyframe/marginalize_frames");
  return marginalizer_.remove_keyframes(window);
}

void KeyframeMaker::select_candidates(Keyframe& keyframe) {
  const auto pixels = selector_->select(keyframe.frame->pyramid, keyframe.id(), candidates_);
  keyframe.immature.reserve(pixels.size());
  for (const SelectedPixel& pixel : pixels) {
    if (pixel.is_corner) keyframe.corners.emplace_back(static_cast<float>(pixel.x), static_cast<float>(pixel.y));
    ImmaturePoint point;
    if (!make_immature_point(keyframe.image(), static_cast<float>(pixel.x), static_cast<float>(pixel.y), point))
      continue;
    point.is_corner = pixel.is_corner;
    point.density_scale = pixel.gradient_scale;
    keyframe.immature.push_back(point);
  }
}

}  // namespace ldso
