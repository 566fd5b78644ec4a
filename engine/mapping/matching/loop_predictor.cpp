#include "mapping/matching/loop_predictor.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "geometry/pinhole_projection.h"

namespace ldso {
namespace {

/// From keyframe to keyframe in the order of time [map units]; infinite if it is longer than `limit` or the map was
/// lost on it.
double way_between(const KeyframeMap& map, int a, int b, double limit) {
  const int earlier = map[a].frame_id < map[b].frame_id ? a : b;
  double length = 0;
  for (int at = a + b - earlier; at != earlier;) {
    const int next = *map.before(at);
    length += (map[at].T_world_camera.translation() - map[next].T_world_camera.translation()).norm();
    if (!(length <= limit) || map[at].segment != map[next].segment) return std::numeric_limits<double>::infinity();
    at = next;
  }
  return length;
}

/// Of both views, seen from the other one, the smaller; 0 if they are turned too far.
double mutual_view(const KeyframeMap& map, const Sim3d& S_b_a, int a, int b, const PinholeIntrinsics& camera,
                   const LoopPredictionSettings& settings) {
  const double turn = Eigen::AngleAxisd(S_b_a.rotation().matrix()).angle() * 180 / std::numbers::pi;
  if (!(turn <= settings.max_angle_deg)) return 0;
  const double of_a = shared_view(camera, S_b_a, map[a].median_idepth);
  return of_a < settings.min_share ? 0 : std::min(of_a, shared_view(camera, S_b_a.inverse(), map[b].median_idepth));
}

/// Where keyframes of a segment lie in a world, and the current one's pose there.
struct Prediction {
  int segment = 0;
  Sim3d S_current_world;
  std::function<Sim3d(int)> S_world_keyframe;
};

std::optional<KnownLoop> best_view(const KeyframeMap& map, const Prediction& prediction, int current,
                                   std::span<const int> excluded, int newest, const PinholeIntrinsics& camera,
                                   const LoopPredictionSettings& settings) {
  // Farther off than so many depths no two views share enough; that is told first, for it is told soon.
  constexpr double kFarOff = 2;
  const double far = kFarOff / map[current].median_idepth;
  std::optional<KnownLoop> best;
  double most = settings.min_share;
  for (int i = 0; i <= newest; ++i) {
    if (map[i].segment != prediction.segment || map[i].is_forgotten) continue;
    const Sim3d S_world_keyframe = prediction.S_world_keyframe(i);
    if (!((prediction.S_current_world * S_world_keyframe.translation()).norm() <= far)) continue;
    if (!(map[i].median_idepth > 0) || std::binary_search(excluded.begin(), excluded.end(), i)) continue;
    const Sim3d S = prediction.S_current_world * S_world_keyframe;
    const double share = mutual_view(map, S, i, current, camera, settings);
    if (share <= most) continue;
    most = share;
    best = KnownLoop{current, i, S};
  }
  return best;
}

}  // namespace

double shared_view(const PinholeIntrinsics& camera, const Sim3d& S_b_a, double idepth_a) {
  constexpr int kColumns = 8, kRows = 6;
  int seen = 0;
  for (int i = 0; i < kColumns * kRows; ++i) {
    const Eigen::Vector2d pixel((i % kColumns + 0.5) * camera.width / kColumns,
                                (std::floor(i / kColumns) + 0.5) * camera.height / kRows);
    const Eigen::Vector3d p = S_b_a * (viewing_ray(camera, pixel) / idepth_a).eval();
    const double magnification = S_b_a.scale() / (idepth_a * p.z());
    if (!(p.z() > 0) || !(magnification < 2) || !(magnification > 0.5)) continue;
    const Eigen::Vector2d q = project(camera, p);
    seen += q.x() >= 0 && q.y() >= 0 && q.x() <= camera.width - 1 && q.y() <= camera.height - 1;
  }
  return static_cast<double>(seen) / (kColumns * kRows);
}

std::optional<KnownLoop> predict_loop(const KeyframeMap& map, std::span<const Sim3d> S_world_keyframe,
                                      const std::optional<KnownLoop>& last, int current, std::span<const int> excluded,
                                      int newest, const PinholeIntrinsics& camera,
                                      const LoopPredictionSettings& settings) {
  if (!(map[current].median_idepth > 0) || !(settings.max_way > 0)) return std::nullopt;
  const double limit = settings.max_way / map[current].median_idepth;
  const auto look = [&](const Prediction& prediction) {
    return best_view(map, prediction, current, excluded, newest, camera, settings);
  };
  const double behind = last ? way_between(map, last->current, current, limit) : limit;
  if (behind < limit) {
    const Sim3d S_current_old(map[current].T_world_camera.inverse() * map[last->current].T_world_camera);
    const Sim3d S_current_world =
        S_current_old * last->S_current_candidate * Sim3d(map[last->candidate].T_world_camera.inverse());
    const auto found =
        look({map[last->candidate].segment, S_current_world, [&](int i) { return Sim3d(map[i].T_world_camera); }});
    if (found && behind + way_between(map, last->candidate, found->candidate, limit) <= limit) return found;
  }
  const auto found =
      look({map[current].segment, S_world_keyframe[current].inverse(), [&](int i) { return S_world_keyframe[i]; }});
  if (found && way_between(map, current, found->candidate, limit) <= limit) return found;
  return std::nullopt;
}

}  // namespace ldso
