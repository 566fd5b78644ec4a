#include "odometry/init/rotation_alignment.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "geometry/levenberg_damping.h"
#include "image/interpolation.h"
#include "odometry/state/robust_weight.h"

namespace ldso {
namespace {

/// Gauss-Newton steps on each level.
constexpr int kRotationIterations = 12;
/// Levels with more pixels are not used: a prediction need not be precise.
constexpr std::size_t kMostPixels = 8000;
/// Share of the pixels that both images have to show.
constexpr double kMinOverlap = 0.4;
/// Distance between the rotations that are tried first [px of the coarsest level].
constexpr double kSearchStep = 2.0;
/// So many rotations are tried to the left, and as many to the right: images are wider than high, and cameras mostly
/// turn about what is upright.
constexpr int kSearchStepsX = 4;
/// So many rotations are tried upward, and as many downward.
constexpr int kSearchStepsY = 2;
/// So many of the best rotations that were tried are refined.
constexpr std::size_t kRotationFinalists = 3;
/// Least z of a ray (x, y, 1) once it is turned: below it the other camera does not see it.
constexpr float kLeastZ = 0.1f;
constexpr DampingRule kTurnDamping{.first = 1e-3, .least = 1e-6, .most = 1e3, .down = 0.2, .up = 10, .floor = 1e-6};
/// A smaller turn moves no pixel [rad].
constexpr double kSmallTurn = 1e-5;

using Vector5 = Eigen::Matrix<double, 5, 1>;
using Matrix5 = Eigen::Matrix<double, 5, 5>;

struct State {
  SO3d rotation;
  double gain = 1;
  double offset = 0;
};

/// Of one row of pixels: short enough for single precision.
struct RowSums {
  float H[15] = {};  ///< Upper triangle, row by row.
  float b[5] = {};
  float energy = 0;
  int used = 0;
};

/// Normal equations of rotation, gain and offset over all pixels of a level.
struct RotationEquations {
  Matrix5 H = Matrix5::Zero();
  Vector5 b = Vector5::Zero();
  double energy = 0;
  int used = 0;

  void add(const RowSums& row) {
    int entry = 0;
    for (int i = 0; i < 5; ++i) {
      b[i] += row.b[i];
      for (int j = i; j < 5; ++j, ++entry) {
        H(i, j) += row.H[entry];
        if (j != i) H(j, i) = H(i, j);
      }
    }
    energy += row.energy;
    used += row.used;
  }

  double mean_energy(double pixels) const {
    return used < kMinOverlap * pixels ? std::numeric_limits<double>::infinity() : energy / used;
  }
};

class Level {
 public:
  Level(const Image<Texel>& from, const Image<Texel>& to, const PinholeIntrinsics& camera)
      : from_(from), to_(to), camera_(camera) {}

  /// Without derivatives if they are not wanted.
  RotationEquations linearize(const State& state, bool derivatives = true) const {
    RotationEquations sums;
    const Eigen::Matrix3f R = state.rotation.matrix().cast<float>();
    for (int y = 1; y + 1 < from_.height(); ++y) {
      RowSums row;
      for (int x = 1; x + 1 < from_.width(); ++x) {
        if (from_(x, y).valid != 0) add_pixel(x, y, R, state, derivatives, row);
      }
      sums.add(row);
    }
    return sums;
  }

  const PinholeIntrinsics& camera() const { return camera_; }
  double pixels() const { return static_cast<double>(from_.width()) * from_.height(); }

 private:
  void add_pixel(int x, int y, const Eigen::Matrix3f& R, const State& state, bool derivatives, RowSums& sums) const {
    const float fx = static_cast<float>(camera_.fx);
    const float fy = static_cast<float>(camera_.fy);
    const float cx = static_cast<float>(camera_.cx);
    const float cy = static_cast<float>(camera_.cy);
    const Eigen::Vector3f q =
        R * Eigen::Vector3f((static_cast<float>(x) - cx) / fx, (static_cast<float>(y) - cy) / fy, 1);
    if (q.z() < kLeastZ) return;
    const float X = q.x() / q.z();
    const float Y = q.y() / q.z();
    const float u = fx * X + cx;
    const float v = fy * Y + cy;
    if (!is_interpolable(to_.view(), u, v)) return;
    const Texel s = bilinear(to_.view(), u, v);
    if (s.valid == 0) return;
    const float reference = from_(x, y).intensity;
    const float r = s.intensity - static_cast<float>(state.gain) * reference - static_cast<float>(state.offset);
    const float weight = huber_weight(r);
    const float gx = s.dx * fx;
    const float gy = s.dy * fy;
    sums.energy += huber_energy(r);
    ++sums.used;
    if (!derivatives) return;
    // d(u, v) / d omega for q -> q + omega x q at the normalized point (X, Y, 1).
    const float J[5] = {-gx * X * Y - gy * (1 + Y * Y), gx * (1 + X * X) + gy * X * Y, -gx * Y + gy * X, -reference,
                        -1};
    int entry = 0;
    for (int i = 0; i < 5; ++i) {
      const float wJ = weight * J[i];
      sums.b[i] += wJ * r;
      for (int j = i; j < 5; ++j) sums.H[entry++] += wJ * J[j];
    }
  }

  const Image<Texel>& from_;
  const Image<Texel>& to_;
  const PinholeIntrinsics camera_;
};

/// Levenberg-Marquardt on one level; returns the mean energy.
double refine(const Level& level, State& state) {
  RotationEquations now = level.linearize(state);
  double energy = now.mean_energy(level.pixels());
  LevenbergDamping damping(kTurnDamping);
  for (int i = 0; i < kRotationIterations && std::isfinite(energy); ++i) {
    Matrix5 H = now.H;
    damping.damp(H);
    const Vector5 step = -H.ldlt().solve(now.b);
    if (!step.allFinite()) break;
    const State trial{SO3d::exp(step.head<3>()) * state.rotation, state.gain + step[3], state.offset + step[4]};
    const RotationEquations next = level.linearize(trial);
    const double next_energy = next.mean_energy(level.pixels());
    if (!(next_energy < energy)) {
      if (!damping.stiffen()) break;
      continue;
    }
    state = trial;
    now = next;
    energy = next_energy;
    damping.relax();
    if (step.head<3>().norm() < kSmallTurn) break;
  }
  return energy;
}

struct Trial {
  State state;
  double energy;
  int distance;  ///< Squared, in steps from the centre.
};

/// Where nothing tells rotations from each other (a covered lens), the nearest one to the centre is the best.
bool is_better(const Trial& a, const Trial& b) {
  return a.energy < b.energy || (a.energy == b.energy && a.distance < b.distance);
}

/// Fast turns leave the basin of even the coarsest image: turns by whole steps in both directions around
/// `centre` are compared there, and the best few refined.
State search(const Level& level, const SO3d& centre) {
  const double step = kSearchStep / std::max(level.camera().fx, level.camera().fy);
  std::vector<Trial> trials;
  for (int y = -kSearchStepsY; y <= kSearchStepsY; ++y) {
    for (int x = -kSearchStepsX; x <= kSearchStepsX; ++x) {
      const State state{SO3d::exp({y * step, x * step, 0}) * centre, 1, 0};
      trials.push_back({state, level.linearize(state, false).mean_energy(level.pixels()), x * x + y * y});
    }
  }
  std::stable_sort(trials.begin(), trials.end(), is_better);
  trials.resize(std::min(trials.size(), kRotationFinalists));
  for (Trial& trial : trials) trial.energy = refine(level, trial.state);
  return std::min_element(trials.begin(), trials.end(), is_better)->state;
}

}  // namespace

RotationAlignment align_rotation(const PreparedFrame& from, const PreparedFrame& to, const PinholeIntrinsics& camera,
                                 const SO3d& guess) {
  const auto& images = from.pyramid.levels;
  const int coarsest = static_cast<int>(images.size()) - 1;
  State state;
  for (int l = coarsest; l >= 0; --l) {
    if (l < coarsest && images[l].size() > kMostPixels) break;
    const Level level(images[l], to.pyramid.levels[l], level_intrinsics(camera, l));
    if (l == coarsest) state = search(level, guess);
    refine(level, state);
  }
  return {state.rotation, {state.gain, state.offset}};
}

}  // namespace ldso
