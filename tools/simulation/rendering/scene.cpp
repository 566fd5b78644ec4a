#include "simulation/rendering/scene.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

namespace ldso::simulation {
namespace {

constexpr int kLeafSize = 4;

void extend(Eigen::Vector3f& low, Eigen::Vector3f& high, const Eigen::Vector3d& point) {
  const Eigen::Vector3f p = point.cast<float>();
  low = low.cwiseMin(p);
  high = high.cwiseMax(p);
}

Eigen::Vector3d centre(const Surface& s) { return s.origin + 0.5 * (s.edge_u + s.edge_v); }

}  // namespace

int Scene::add_texture(Texture texture) {
  textures_.push_back(std::move(texture));
  return static_cast<int>(textures_.size()) - 1;
}

void Scene::add(Surface surface) {
  // Groups given by the worlds are small numbers; own groups start far above.
  if (surface.group < 0) surface.group = (1 << 20) + static_cast<int>(surfaces_.size());
  surfaces_.push_back(std::move(surface));
}

void Scene::finish() {
  order_.resize(surfaces_.size());
  std::iota(order_.begin(), order_.end(), 0);
  nodes_.assign(1, BvhNode{});
  nodes_.reserve(2 * surfaces_.size() + 1);
  build(0, 0, static_cast<int>(surfaces_.size()));
}

void Scene::build(int node, int begin, int end) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  Eigen::Vector3f low = Eigen::Vector3f::Constant(kInfinity), high = -low;
  Eigen::Vector3f centre_low = low, centre_high = high;
  for (int i = begin; i < end; ++i) {
    const Surface& s = surfaces_[order_[i]];
    extend(low, high, s.origin);
    extend(low, high, s.origin + s.edge_u);
    extend(low, high, s.origin + s.edge_v);
    if (!s.triangle) extend(low, high, s.origin + s.edge_u + s.edge_v);
    extend(centre_low, centre_high, centre(s));
  }
  // Room for the rounding to float.
  nodes_[node].low = low.array() - 1e-3f;
  nodes_[node].high = high.array() + 1e-3f;
  if (end - begin <= kLeafSize) {
    nodes_[node].first = begin;
    nodes_[node].count = end - begin;
    return;
  }
  int axis = 0;
  (centre_high - centre_low).maxCoeff(&axis);
  const int middle = (begin + end) / 2;
  std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end, [&](int a, int b) {
    const double ca = centre(surfaces_[a])[axis], cb = centre(surfaces_[b])[axis];
    return ca != cb ? ca < cb : a < b;
  });
  const int first = static_cast<int>(nodes_.size());
  nodes_[node].first = first;
  nodes_[node].count = 0;
  nodes_.resize(nodes_.size() + 2);
  build(first, begin, middle);
  build(first + 1, middle, end);
}

}  // namespace ldso::simulation
