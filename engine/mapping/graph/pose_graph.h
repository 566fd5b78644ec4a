#pragma once

// The keyframes' poses as similarities, held together by the odometry's relative poses and corrected by loops
// (LDSO, Gao et al., IROS 2018, III-D; Strasdat et al., RSS 2010: a monocular map drifts in scale, so the poses of its
// graph are similarities). Odometry edges are least squares, loop edges robust: a wrong loop among true ones loses its
// pull.

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "ldso/sim3.h"
#include "mapping/graph/pose_graph_edge.h"
#include "mapping/graph/pose_graph_solver.h"

namespace ldso {

/// A loop edge and what optimize() made of it.
struct PoseGraphLoop {
  PoseGraphEdge edge;
  double chi2 = 0;    ///< Squared residual in its standard deviations; about 7 for a true loop.
  double weight = 1;  ///< From 0, it has been let go, to 1, it pulls with all its information.
};

/// Not for several threads at once. The same calls give the same poses to the last bit.
class PoseGraph {
 public:
  explicit PoseGraph(const PoseGraphSettings& settings = {});

  /// A keyframe where the odometry puts it. Throws Error unless the id is above those before, the pose finite and its
  /// scale positive.
  void add_keyframe(std::int64_t id, const Sim3d& S_world_keyframe);

  /// False, and the edge is left out, if it is not usable: something is not finite, the scale not positive or the
  /// information negative somewhere. Throws Error if it names an unknown keyframe or twice the same.
  bool add_odometry_edge(const PoseGraphEdge& edge);
  /// The same for a loop. Where the graph cannot tell a wrong loop from drift, as when it is the only one, it closes.
  bool add_loop_edge(const PoseGraphEdge& edge);

  /// By how much the variances of the odometry edges, of translation, rotation and log scale, are larger than their
  /// information says. Throws Error unless each is finite and at least 1.
  void set_odometry_variance_factors(const Eigen::Vector3d& factors);

  /// Least squares over all keyframes that edges connect with `fixed_id`, which keeps its pose to the last bit. The
  /// others stay where they are: nothing is known of where they are from here. Where edges leave a direction open (two
  /// chains that a loop without scale connects) the solution is one of those that fit equally well. A failed solve
  /// leaves all poses and says so. Throws Error if the id is unknown.
  PoseGraphReport optimize(std::int64_t fixed_id);

  /// Throws Error if the id is unknown.
  const Sim3d& S_world_keyframe(std::int64_t id) const;
  bool contains(std::int64_t id) const;

  std::size_t size() const { return poses_.size(); }
  std::size_t num_odometry_edges() const { return odometry_.size(); }
  /// In the order in which they were added.
  const std::vector<PoseGraphLoop>& loops() const { return loops_; }

 private:
  struct Edge {
    std::size_t from, to;  // places in poses_
    PoseGraphResidual residual;
  };

  /// What hangs together with a keyframe, as the solver wants it.
  struct Component {
    PoseGraphProblem problem;
    std::vector<std::size_t> keyframes, loops;  // the places here of the problem's
  };

  std::size_t index_of(std::int64_t id) const;
  std::optional<Edge> make_edge(const PoseGraphEdge& edge) const;
  Component component_of(std::size_t fixed) const;
  /// Whether a loop that is new does not fit the poses.
  bool needs_graduation(const Component& component) const;
  void take_over(const Component& component);

  PoseGraphSettings settings_;
  std::vector<std::int64_t> ids_;  // rising
  std::vector<Sim3d> poses_;
  std::vector<Edge> odometry_, loop_edges_;
  std::vector<PoseGraphLoop> loops_;
  std::vector<bool> is_settled_;  // of the loops: the poses take account of it
  double kernel_squared_;         // of the loops, as the last optimization found it
  Eigen::Vector3d variance_factors_ = Eigen::Vector3d::Ones();
};

}  // namespace ldso
