#include "mapping/graph/pose_graph.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "ldso/error.h"
#include "mapping/graph/loop_kernel.h"
#include "util/disjoint_sets.h"

namespace ldso {
namespace {

std::string name_of(std::int64_t id) { return "keyframe " + std::to_string(id); }

PoseGraphResidual::Vector7d weights_of(const Eigen::Vector3d& variance_factors) {
  const Eigen::Vector3d w = variance_factors.cwiseSqrt().cwiseInverse();
  PoseGraphResidual::Vector7d weights;
  weights << w[0], w[0], w[0], w[1], w[1], w[1], w[2];
  return weights;
}

}  // namespace

PoseGraph::PoseGraph(const PoseGraphSettings& settings)
    : settings_(settings), kernel_squared_(settings.kernel * settings.kernel) {}

void PoseGraph::add_keyframe(std::int64_t id, const Sim3d& S_world_keyframe) {
  if (!ids_.empty() && id <= ids_.back()) {
    throw Error(name_of(id), "it comes after " + name_of(ids_.back()), "add keyframes to the pose graph in order");
  }
  if (!is_finite(S_world_keyframe)) throw Error(name_of(id), "its pose is not finite", "leave it out");
  ids_.push_back(id);
  poses_.push_back(S_world_keyframe);
}

std::optional<PoseGraph::Edge> PoseGraph::make_edge(const PoseGraphEdge& edge) const {
  const std::size_t from = index_of(edge.from), to = index_of(edge.to);
  if (from == to) throw Error(name_of(edge.from), "an edge connects it with itself", "connect two keyframes");
  if (!is_usable(edge)) return std::nullopt;
  return Edge{from, to, PoseGraphResidual(edge)};
}

bool PoseGraph::add_odometry_edge(const PoseGraphEdge& edge) {
  const std::optional<Edge> made = make_edge(edge);
  if (made) odometry_.push_back(*made);
  return made.has_value();
}

bool PoseGraph::add_loop_edge(const PoseGraphEdge& edge) {
  const std::optional<Edge> made = make_edge(edge);
  if (!made) return false;
  loop_edges_.push_back(*made);
  loops_.push_back({edge});
  is_settled_.push_back(false);
  return true;
}

void PoseGraph::set_odometry_variance_factors(const Eigen::Vector3d& factors) {
  if (!factors.allFinite() || factors.minCoeff() < 1) {
    throw Error("pose graph", "a variance factor is not finite or below 1", "1 takes the odometry at its word");
  }
  if (factors == variance_factors_) return;
  variance_factors_ = factors;
  is_settled_.assign(loops_.size(), false);
}

PoseGraphReport PoseGraph::optimize(std::int64_t fixed_id) {
  Component component = component_of(index_of(fixed_id));
  component.problem.graduated = needs_graduation(component);
  PoseGraphReport report = solve(component.problem, settings_);
  if (report.ok) {
    kernel_squared_ = settings_.kernel * settings_.kernel * report.loop_variance_factor;
    take_over(component);
  }
  return report;
}

PoseGraph::Component PoseGraph::component_of(std::size_t fixed) const {
  DisjointSets sets(poses_.size());
  for (const Edge& edge : odometry_) sets.join(edge.from, edge.to);
  for (const Edge& edge : loop_edges_) sets.join(edge.from, edge.to);
  Component component;
  PoseGraphProblem& problem = component.problem;
  std::vector<int> places(poses_.size(), -1);
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    if (sets.find(i) != sets.find(fixed)) continue;
    places[i] = static_cast<int>(problem.poses.size());
    component.keyframes.push_back(i);
    problem.poses.push_back(poses_[i]);
  }
  problem.fixed = places[fixed];
  problem.odometry_weights = weights_of(variance_factors_);
  for (const Edge& edge : odometry_) {
    if (places[edge.from] >= 0) problem.odometry.push_back({places[edge.from], places[edge.to], &edge.residual});
  }
  for (std::size_t i = 0; i < loop_edges_.size(); ++i) {
    const Edge& edge = loop_edges_[i];
    if (places[edge.from] < 0) continue;
    component.loops.push_back(i);
    problem.loops.push_back({places[edge.from], places[edge.to], &edge.residual});
  }
  return component;
}

bool PoseGraph::needs_graduation(const Component& component) const {
  const std::vector<double> chi2 = loop_chi2(component.problem);
  for (std::size_t i = 0; i < chi2.size(); ++i) {
    if (!is_settled_[component.loops[i]] && !(chi2[i] < kernel_squared_)) return true;
  }
  return false;
}

void PoseGraph::take_over(const Component& component) {
  const PoseGraphProblem& problem = component.problem;
  for (std::size_t i = 0; i < problem.poses.size(); ++i) poses_[component.keyframes[i]] = problem.poses[i];
  const std::vector<double> chi2 = loop_chi2(problem);
  for (std::size_t i = 0; i < chi2.size(); ++i) {
    PoseGraphLoop& loop = loops_[component.loops[i]];
    loop.chi2 = chi2[i];
    loop.weight = geman_mcclure_weight(chi2[i], kernel_squared_);
    is_settled_[component.loops[i]] = true;
  }
}

const Sim3d& PoseGraph::S_world_keyframe(std::int64_t id) const { return poses_[index_of(id)]; }

bool PoseGraph::contains(std::int64_t id) const { return std::binary_search(ids_.begin(), ids_.end(), id); }

std::size_t PoseGraph::index_of(std::int64_t id) const {
  const auto place = std::lower_bound(ids_.begin(), ids_.end(), id);
  if (place == ids_.end() || *place != id) {
    throw Error(name_of(id), "the pose graph does not know it", "add_keyframe first");
  }
  return static_cast<std::size_t>(place - ids_.begin());
}

}  // namespace ldso
