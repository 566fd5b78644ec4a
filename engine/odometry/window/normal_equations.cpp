#include "odometry/window/normal_equations.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace ldso {
namespace {

/// Points of a chunk: the Schur complement of so many fits a processor's cache.
constexpr int kChunkSize = 96;
/// Below this the inverse depth is not determined by its residuals.
constexpr float kLeastHessian = 1e-4f;

/// Energy of one residual, outliers at their threshold; sets its state at `slot`.
double classify(const Keyframe& host, PointResidual& residual, int slot) {
  const PatternSums& sums = residual.sums[slot];
  if (!sums.in_view || !std::isfinite(sums.energy)) {
    residual.states[slot] = ResidualState::kOutOfView;
    return 0;
  }
  const float threshold = std::max(host.outlier_energy, residual.target->outlier_energy);
  const bool outlier = sums.energy > threshold;
  residual.states[slot] = outlier ? ResidualState::kOutlier : ResidualState::kInlier;
  return outlier ? threshold : sums.energy;
}

/// Residuals of one host on their way through the kernel, which is faster with many at once.
class ResidualBatch {
 public:
  ResidualBatch(const Keyframe& host, int slot) : host_(host), slot_(slot) {}

  void add(const PatternJob& job, PointResidual& residual) {
    jobs_[count_] = job;
    residuals_[count_] = &residual;
    if (++count_ == kMost) evaluate();
  }

  /// Their energy, after the last one was added.
  double finish() {
    evaluate();
    return energy_;
  }

 private:
  static constexpr int kMost = 64;

  void evaluate() {
    evaluate_patterns(jobs_.data(), sums_.data(), count_);
    for (int i = 0; i < count_; ++i) {
      residuals_[i]->sums[slot_] = sums_[i];
      energy_ += classify(host_, *residuals_[i], slot_);
    }
    count_ = 0;
  }

  const Keyframe& host_;
  int slot_;
  int count_ = 0;
  double energy_ = 0;
  std::array<PatternJob, kMost> jobs_;
  std::array<PatternSums, kMost> sums_;
  std::array<PointResidual*, kMost> residuals_;
};

/// Adds J^T M J of one residual, M being its sums over the pattern, and its right-hand side.
void accumulate_residual(const PatternSums& s, const ProjectionJacobian& J, RelativeMatrix& H, RelativeVector& b) {
  Eigen::Matrix<float, kCameraDof + 6, 1> jx, jy;
  jx << J.camera.row(0).transpose(), J.pose.row(0).transpose();
  jy << J.camera.row(1).transpose(), J.pose.row(1).transpose();
  const Eigen::Matrix<float, kCameraDof + 6, 1> mx = s.gxx * jx + s.gxy * jy;
  const Eigen::Matrix<float, kCameraDof + 6, 1> my = s.gxy * jx + s.gyy * jy;
  constexpr int n = kCameraDof + 6;
  H.topLeftCorner<n, n>().noalias() += jx * mx.transpose() + jy * my.transpose();
  H.block<n, 1>(0, n) += s.gxa * jx + s.gya * jy;
  H.block<n, 1>(0, n + 1) += s.gxb * jx + s.gyb * jy;
  H(n, n) += s.aa;
  H(n, n + 1) += s.ab;
  H(n + 1, n + 1) += s.bb;
  b.head<n>() += s.rgx * jx + s.rgy * jy;
  b[n] += s.ra;
  b[n + 1] += s.rb;
}

/// Maps sums over the relative variables of a pair to the window's variables.
void add_pair(const Eigen::Matrix<double, kRelativeDof, kRelativeDof>& H_rel,
              const Eigen::Matrix<double, kRelativeDof, 1>& b_rel, const FramePair& pair, int host, int target,
              Eigen::MatrixXd& H, Eigen::VectorXd& b) {
  const int h = Window::offset(host), t = Window::offset(target);
  constexpr int c = kCameraDof, f = kFrameDof;
  const auto& A = pair.host_adjoint;
  const Eigen::Matrix<double, f, f> H_xx = H_rel.bottomRightCorner<f, f>();
  const Eigen::Matrix<double, c, f> H_cx = H_rel.topRightCorner<c, f>();
  const Eigen::Matrix<double, f, f> H_xh = H_xx * A;
  const Eigen::Matrix<double, c, f> H_ch = H_cx * A;
  H.topLeftCorner<c, c>() += H_rel.topLeftCorner<c, c>();
  H.block<c, f>(0, t) += H_cx;
  H.block<f, c>(t, 0) += H_cx.transpose();
  H.block<c, f>(0, h) += H_ch;
  H.block<f, c>(h, 0) += H_ch.transpose();
  H.block<f, f>(t, t) += H_xx;
  H.block<f, f>(t, h) += H_xh;
  H.block<f, f>(h, t) += H_xh.transpose();
  H.block<f, f>(h, h) += A.transpose() * H_xh;
  b.head<c>() += b_rel.head<c>();
  b.segment<f>(t) += b_rel.tail<f>();
  b.segment<f>(h) += A.transpose() * b_rel.tail<f>();
}

}  // namespace

FramePairs::FramePairs(const Window& window)
    : size_(window.size()), pairs_(static_cast<std::size_t>(window.size()) * window.size()) {
  for (int host = 0; host < size_; ++host) {
    for (int target = 0; target < size_; ++target) {
      if (host == target) continue;
      pairs_[host * size_ + target] = make_frame_pair(*window.keyframes[host], *window.keyframes[target], window.camera,
                                                      window.camera_lin, window.readout_s);
    }
  }
}

std::vector<PointChunk> chunk_points(const Window& window, const std::function<bool(const ActivePoint&)>& take) {
  std::vector<PointChunk> chunks;
  for (const auto& keyframe : window.keyframes) {
    chunks.push_back({keyframe->index, {}});
    for (ActivePoint& point : keyframe->points) {
      if (!take(point)) continue;
      if (chunks.back().points.size() == kChunkSize) chunks.push_back({keyframe->index, {}});
      chunks.back().points.push_back(&point);
    }
    if (chunks.back().points.empty()) chunks.pop_back();
  }
  return chunks;
}

double linearize(const Window& window, const FramePairs& pairs, const std::vector<PointChunk>& chunks, int slot,
                 ThreadPool& pool) {
  std::vector<double> energies(chunks.size(), 0.0);
  pool.run(static_cast<int>(chunks.size()), [&](int c) {
    const PointChunk& chunk = chunks[c];
    ResidualBatch batch(*window.keyframes[chunk.host], slot);
    for (ActivePoint* point : chunk.points) {
      for (PointResidual& residual : point->residuals) {
        batch.add({&point->patch, &pairs(chunk.host, residual.target->index).warp, point->u, point->v, point->idepth},
                  residual);
      }
    }
    energies[c] = batch.finish();
  });
  double energy = 0;
  for (const double e : energies) energy += e;
  return energy;
}

double reclassify(const Window& window, const std::vector<PointChunk>& chunks, int slot) {
  double energy = 0;
  for (const PointChunk& chunk : chunks) {
    for (ActivePoint* point : chunk.points) {
      for (PointResidual& residual : point->residuals)
        energy += classify(*window.keyframes[chunk.host], residual, slot);
    }
  }
  return energy;
}

NormalEquations NormalEquationsBuilder::build(const Window& window, const FramePairs& pairs,
                                              const std::vector<PointChunk>& chunks, double damping) {
  const int count = static_cast<int>(chunks.size());
  systems_.resize(count);
  pool_.run(count, [&](int c) { accumulate_chunk(window, pairs, chunks[c], damping, systems_[c]); });
  NormalEquations result;
  result.H = Eigen::MatrixXd::Zero(window.dim(), window.dim());
  result.H_sc = result.H;
  result.b = Eigen::VectorXd::Zero(window.dim());
  result.b_sc = result.b;
  std::vector<Eigen::Matrix<double, kRelativeDof, kRelativeDof>> H_rel(window.size());
  std::vector<Eigen::Matrix<double, kRelativeDof, 1>> b_rel(window.size());
  for (int c = 0; c < count; ++c) {
    const int host = chunks[c].host;
    const bool first = c == 0 || chunks[c - 1].host != host;
    const bool last = c + 1 == count || chunks[c + 1].host != host;
    // The chunks of one host follow each other: their relative sums are mapped together.
    for (int t = 0; t < window.size(); ++t) {
      if (t == host) continue;
      if (first) {
        H_rel[t].setZero();
        b_rel[t].setZero();
      }
      H_rel[t] += systems_[c].H[t].cast<double>();
      b_rel[t] += systems_[c].b[t].cast<double>();
      if (!last) continue;
      const Eigen::Matrix<double, kRelativeDof, kRelativeDof> full = H_rel[t].selfadjointView<Eigen::Upper>();
      add_pair(full, b_rel[t], pairs(host, t), host, t, result.H, result.b);
    }
    result.H_sc += systems_[c].H_sc.cast<double>();
    result.b_sc += systems_[c].b_sc.cast<double>();
  }
  result.H_sc = Eigen::MatrixXd(result.H_sc.selfadjointView<Eigen::Lower>());
  return result;
}

void NormalEquationsBuilder::accumulate_chunk(const Window& window, const FramePairs& pairs, const PointChunk& chunk,
                                              double damping, ChunkSystem& system) {
  const auto count = static_cast<Eigen::Index>(chunk.points.size());
  system.coupling.setZero(count, window.dim());
  system.gradient.setZero(count);
  system.scale.setZero(count);
  system.H.assign(window.size(), RelativeMatrix::Zero());
  system.b.assign(window.size(), RelativeVector::Zero());
  for (Eigen::Index i = 0; i < count; ++i) {
    ActivePoint& point = *chunk.points[i];
    auto coupling = system.coupling.row(i);
    float hessian = point.idepth_damping;
    float gradient = 0;
    for (const PointResidual& residual : point.residuals) {
      if (residual.states[window.front] != ResidualState::kInlier) continue;
      const int target = residual.target->index;
      const FramePair& pair = pairs(chunk.host, target);
      const PatternSums& s = residual.sums[window.front];
      ProjectionJacobian J;
      if (!projection_jacobian(pair, point.u, point.v, point.idepth, J)) continue;
      accumulate_residual(s, J, system.H[target], system.b[target]);
      const Eigen::Vector2f md(s.gxx * J.idepth.x() + s.gxy * J.idepth.y(),
                               s.gxy * J.idepth.x() + s.gyy * J.idepth.y());
      Eigen::Matrix<float, kFrameDof, 1> relative;
      relative << J.pose.transpose() * md, s.gxa * J.idepth.x() + s.gya * J.idepth.y(),
          s.gxb * J.idepth.x() + s.gyb * J.idepth.y();
      coupling.segment<kFrameDof>(Window::offset(target)) += relative.transpose();
      coupling.segment<kFrameDof>(Window::offset(chunk.host)) +=
          (pair.host_adjoint_f.transpose() * relative).transpose();
      coupling.head<kCameraDof>() += (J.camera.transpose() * md).transpose();
      hessian += J.idepth.dot(md);
      gradient += s.rgx * J.idepth.x() + s.rgy * J.idepth.y();
    }
    point.idepth_hessian = hessian;
    if (!(hessian > kLeastHessian)) {
      coupling.setZero();  // A point that is not eliminated takes nothing away.
      continue;
    }
    system.scale[i] = 1.0f / std::sqrt(hessian * static_cast<float>(1.0 + damping));
    coupling *= system.scale[i];
    system.gradient[i] = gradient * system.scale[i];
  }
  system.H_sc.setZero(window.dim(), window.dim());
  system.H_sc.selfadjointView<Eigen::Lower>().rankUpdate(system.coupling.transpose());
  system.b_sc = system.coupling.transpose() * system.gradient;
}

void NormalEquationsBuilder::back_substitute(const std::vector<PointChunk>& chunks, const Eigen::VectorXd& step) const {
  const Eigen::VectorXf step_f = step.cast<float>();
  for (std::size_t c = 0; c < chunks.size(); ++c) {
    const ChunkSystem& system = systems_[c];
    const Eigen::VectorXf scaled = -(system.gradient + system.coupling * step_f).cwiseProduct(system.scale);
    for (std::size_t i = 0; i < chunks[c].points.size(); ++i) {
      chunks[c].points[i]->idepth_step = scaled[static_cast<Eigen::Index>(i)];
    }
  }
}

}  // namespace ldso
