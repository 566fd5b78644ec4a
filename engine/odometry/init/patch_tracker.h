#pragma once

// Where the surroundings of chosen pixels of one frame are seen in later frames: pyramidal alignment of
// small patches (inverse compositional, Baker & Matthews, IJCV 2004). Direct methods start from a wrong depth;
// patches that move freely need none, and their structure tensor says which direction of their motion is
// determined, so pixels on edges are as welcome as corners.

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "image/frame.h"
#include "odometry/state/brightness.h"
#include "util/thread_pool.h"

namespace ldso {

/// Where a patch is expected: `starts` are candidates for its centre [px, level 0], `warp` maps offsets in
/// the reference to offsets in the current frame.
struct PatchPrediction {
  std::vector<Eigen::Vector2d> starts;
  Eigen::Matrix2d warp = Eigen::Matrix2d::Identity();
  int coarsest = 100;  ///< Pyramid level to begin with: lower for a start that is known better.
};

struct PatchMatch {
  bool found = false;
  Eigen::Vector2d position = Eigen::Vector2d::Zero();        ///< Centre in the current frame [px, level 0].
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Identity();  ///< Of the position [px^2], from the patch's own misfit.
  double gain = 1;                                           ///< Contrast of the current patch over the reference's.
  double mean = 0;                                           ///< Of the current patch [grey levels].
  double reference_mean = 0;                                 ///< Of the reference's.
  double correlation = 0;                                    ///< Zero-mean normalized cross-correlation.
};

/// Patches of one reference frame, prepared on all pyramid levels.
class PatchTracker {
 public:
  /// `pixels`: level-0 positions, at least 4 px inside the image (others are never found).
  PatchTracker(const PreparedFrame& reference, const std::vector<Eigen::Vector2d>& pixels, ThreadPool& pool);

  /// One match a pixel. `brightness`: expected transfer from the reference to the current frame.
  std::vector<PatchMatch> track(const PreparedFrame& current, const std::vector<PatchPrediction>& predictions,
                                const BrightnessTransfer& brightness, ThreadPool& pool) const;

 private:
  /// Of a patch [px]: 7 x 7 pixels hold enough texture on coarse levels, and little of what lies at another depth.
  static constexpr int kRadius = 3;
  static constexpr int kSide = 2 * kRadius + 1;
  static constexpr int kPixels = kSide * kSide;
  /// A patch's own brightness offset, known to be small (1 grey level against noise of 5), is eliminated:
  /// sums of products lose this share of the product of their sums.
  static constexpr float kOffsetShare = 1.0f / (kPixels + 25.0f);

  /// Intensities and gradients of a patch on one level.
  struct Template {
    bool usable = false;
    float intensity[kPixels];
    float gx[kPixels];
    float gy[kPixels];
    float hxx = 0, hxy = 0, hyy = 0;  ///< Structure tensor, the patch's offset eliminated.
    float sum_gx = 0, sum_gy = 0;
    float mean = 0;
    float energy = 0;  ///< Sum of squared intensities less their mean.
  };
  struct Misfit {
    double squared = 0;
    double gain = 1;
    double mean = 0;
    double correlation = 0;
  };

  Template make_template(const Image<Texel>& image, const Eigen::Vector2d& centre) const;
  PatchMatch track_patch(const PreparedFrame& current, std::size_t index, const PatchPrediction& prediction,
                         const BrightnessTransfer& brightness) const;
  Eigen::Vector2d best_start(const PreparedFrame& current, std::size_t index, const PatchPrediction& prediction,
                             const BrightnessTransfer& brightness) const;
  bool align(const Image<Texel>& image, const Template& patch, const Eigen::Matrix2f& warp,
             const BrightnessTransfer& brightness, Eigen::Vector2f& centre) const;
  static bool sample(const Image<Texel>& image, const Eigen::Vector2f& centre, const Eigen::Matrix2f& warp,
                     float* values);
  static bool all_valid(const Image<Texel>& image, const Eigen::Vector2f& centre, const Eigen::Matrix2f& warp);
  Misfit misfit(const float* values, const Template& patch, const BrightnessTransfer& brightness) const;

  int levels_ = 0;
  std::vector<Template> templates_;  ///< [pixel * levels_ + level]
};

/// A level-0 pixel on level `level` and back; pixel centres are at integers.
inline Eigen::Vector2d to_level(const Eigen::Vector2d& p, int level) {
  return (p.array() + 0.5) / static_cast<double>(1 << level) - 0.5;
}
inline Eigen::Vector2d from_level(const Eigen::Vector2d& p, int level) {
  return (p.array() + 0.5) * static_cast<double>(1 << level) - 0.5;
}

}  // namespace ldso
