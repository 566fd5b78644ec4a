#pragma once

// The keyframes that left the odometry's window, with what loop closing needs of them: described corners with depth,
// and where the odometry put them relative to the keyframes they shared the window with.

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "ldso/loop_settings.h"
#include "ldso/records.h"
#include "ldso/sim3.h"
#include "mapping/map/map_feature.h"
#include "mapping/map/matrix7d.h"

namespace ldso {

/// A keyframe that shared the window with another one.
struct Neighbour {
  int index = 0;        ///< In the map.
  SE3d T_this_other;    ///< As the window estimated it last.
  Matrix7d covariance;  ///< Of x in S = exp(x) * T_this_other.
};

struct MapKeyframe {
  std::int64_t frame_id = 0;
  int segment = 0;                    ///< Of the run (KeyframeUpdate).
  SE3d T_world_camera;                ///< Of the odometry.
  std::vector<MapFeature> features;   ///< Described corners.
  std::vector<Neighbour> neighbours;  ///< In the order in which both had left the window.
  double median_idepth = 0;           ///< Of the features with depth [1 / map unit]; 0 if there are none.
  bool is_forgotten = false;          ///< Others show the same: of this one only its place is known any more.
};

/// The odometry's way from one keyframe to another.
struct OdometryChain {
  Sim3d S_from_to;                          ///< Scale 1.
  std::array<Matrix7d, 3> covariance = {};  ///< Of x in S_true = exp(x) * S_from_to: what errors of translation, of
                                            ///< rotation and of scale on the way add to it.
  double length = 0;                        ///< Of the way [map units].
  int breaks = 0;  ///< Changes of the segment on the way: across them nothing is known, whatever the rest says.
};

/// Of the features with depth [1 / map unit]; 0 if there are none.
double median_idepth(const std::vector<MapFeature>& features);

class KeyframeMap {
 public:
  explicit KeyframeMap(const LoopDriftSettings& settings = {}) : settings_(settings) {}

  /// Adds a keyframe with its constraints to others, which may come later; returns its index. Throws Error if its
  /// frame id is there already.
  int add(const KeyframeUpdate& update, std::vector<MapFeature> features);

  /// Forgets the features of keyframe `index` that have no depth: nothing can be learned from a match with them.
  void forget_depthless(int index);

  /// Forgets all that keyframe `index` shows; its place stays.
  void forget(int index);

  int size() const { return static_cast<int>(keyframes_.size()); }
  const MapKeyframe& operator[](int index) const { return keyframes_[index]; }
  std::optional<int> find(std::int64_t frame_id) const;

  /// Keyframes that shared the window with keyframe `index`, and those that shared it with them, and so on over `hops`
  /// steps; `index` itself included. Ascending.
  std::vector<int> covisible(int index, int hops) const;

  /// Along the keyframes in the order of time.
  OdometryChain chain(int from, int to) const;

  /// The keyframe before it in time, of those that are here.
  std::optional<int> before(int index) const;

  /// The last keyframe in time. There must be one.
  int newest() const { return index_of_.rbegin()->second; }

  /// Indices of all keyframes in the order of time.
  std::vector<int> in_time() const;

  /// Bytes held for keyframe `index`.
  std::size_t memory_bytes(int index) const;

 private:
  struct Link {
    SE3d T_first_second;
    Matrix7d covariance;
  };
  Link link(int first, int second) const;

  LoopDriftSettings settings_;
  std::vector<MapKeyframe> keyframes_;
  std::map<std::int64_t, int> index_of_;  ///< By frame id.
  /// Constraints of keyframes that are here to such that are not yet: by the frame id of the latter.
  std::multimap<std::int64_t, std::pair<int, KeyframeConstraint>> pending_;
};

}  // namespace ldso
