#pragma once

// Normal equations of the window's photometric energy: residual linearization, accumulation and the Schur
// complement over the inverse depths (DSO section 2.3).

#include <functional>
#include <vector>

#include "odometry/residual/photometric_residual.h"
#include "odometry/state/window.h"
#include "util/thread_pool.h"

namespace ldso {

/// Geometry of all ordered pairs of keyframes of a window; empty on the diagonal.
class FramePairs {
 public:
  explicit FramePairs(const Window& window);
  const FramePair& operator()(int host, int target) const { return pairs_[host * size_ + target]; }

 private:
  int size_;
  std::vector<FramePair> pairs_;
};

/// The points that take part, grouped by host so that the work is cut the same way for any number of threads.
struct PointChunk {
  int host = 0;
  std::vector<ActivePoint*> points;
};

/// Cuts the points of all keyframes for which `take` holds into chunks.
std::vector<PointChunk> chunk_points(const Window& window, const std::function<bool(const ActivePoint&)>& take);

/// Sum of the robust energies, outliers at their threshold.
/// Writes the linearization `slot` of each residual and its state there.
double linearize(const Window& window, const FramePairs& pairs, const std::vector<PointChunk>& chunks, int slot,
                 ThreadPool& pool);

/// Sorts the residuals of a linearization anew into inliers and outliers after the thresholds changed.
/// Returns the energy.
double reclassify(const Window& window, const std::vector<PointChunk>& chunks, int slot);

/// Variables of a residual: intrinsics, relative pose, relative brightness.
inline constexpr int kRelativeDof = kCameraDof + kFrameDof;
using RelativeMatrix = Eigen::Matrix<float, kRelativeDof, kRelativeDof>;
using RelativeVector = Eigen::Matrix<float, kRelativeDof, 1>;

struct NormalEquations {
  Eigen::MatrixXd H;  ///< Without the inverse depths, before the Schur complement.
  Eigen::VectorXd b;
  Eigen::MatrixXd H_sc;  ///< What the Schur complement over the inverse depths takes away.
  Eigen::VectorXd b_sc;
};

/// Accumulates H = J^T W J and b = J^T W r of the accepted linearization (`window.front`), and for every point its
/// own Hessian; remembers the coupling of each point for back_substitute().
class NormalEquationsBuilder {
 public:
  explicit NormalEquationsBuilder(ThreadPool& pool) : pool_(pool) {}

  /// `damping` multiplies the diagonal of the inverse depths by 1 + damping.
  NormalEquations build(const Window& window, const FramePairs& pairs, const std::vector<PointChunk>& chunks,
                        double damping);

  /// Sets `idepth_step` of all points for the step of the other variables.
  void back_substitute(const std::vector<PointChunk>& chunks, const Eigen::VectorXd& step) const;

 private:
  /// What one chunk of points contributes.
  struct ChunkSystem {
    /// Row i: coupling of point i with all other variables times `scale[i]`.
    Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> coupling;
    Eigen::VectorXf gradient;       ///< b of each point, scaled alike.
    Eigen::VectorXf scale;          ///< 1 / sqrt(damped Hessian) of each point; 0: not determined.
    std::vector<RelativeMatrix> H;  ///< By target, over the relative variables; upper triangle.
    std::vector<RelativeVector> b;
    Eigen::MatrixXf H_sc;  ///< Lower triangle.
    Eigen::VectorXf b_sc;
  };
  static void accumulate_chunk(const Window& window, const FramePairs& pairs, const PointChunk& chunk, double damping,
                               ChunkSystem& system);

  ThreadPool& pool_;
  std::vector<ChunkSystem> systems_;
};

}  // namespace ldso
