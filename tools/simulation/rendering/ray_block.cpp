#include "simulation/rendering/ray_block.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace ldso::simulation {

RayBlock::RayBlock(const Scene& scene, const CameraRays& rays, int left, int top, int columns, int rows)
    : scene_(scene), rays_(rays), left_(left), top_(top), columns_(columns + 2), rows_(rows + 2) {
  load_rays();
}

void RayBlock::trace(const SE3d& T_world_camera) {
  T_world_camera_ = T_world_camera;
  R_ = T_world_camera.rotation_matrix();
  traverse();
}

void RayBlock::load_rays() {
  x_.fill(0);
  y_.fill(0);
  best_.fill(kNoRay);
  hit_.fill(-1);
  float x_low = 1e30f, x_high = -1e30f, y_low = 1e30f, y_high = -1e30f;
  for (int row = 0; row < rows_; ++row) {
    row_low_[row] = 1e30f;
    row_high_[row] = -1e30f;
    for (int column = 0; column < columns_; ++column) {
      const float x = rays_.x(left_ + column - 1, top_ + row - 1), y = rays_.y(left_ + column - 1, top_ + row - 1);
      const int i = index(column, row);
      if (!std::isfinite(x) || !std::isfinite(y)) continue;  // Stays "nearer than everything" and black.
      x_[i] = x;
      y_[i] = y;
      best_[i] = 0;
      x_low = std::min(x_low, x);
      x_high = std::max(x_high, x);
      row_low_[row] = std::min(row_low_[row], y);
      row_high_[row] = std::max(row_high_[row], y);
    }
    y_low = std::min(y_low, row_low_[row]);
    y_high = std::max(y_high, row_high_[row]);
  }
  low_ = {x_low, y_low};
  high_ = {x_high, y_high};
  // Change of the ray per pixel, in the middle of the block.
  const int column = columns_ / 2, row = rows_ / 2;
  change_.d_du = 0.5f * (ray(column + 1, row) - ray(column - 1, row));
  change_.d_dv = rows_ > 2 ? Eigen::Vector2f(0.5f * (ray(column, row + 1) - ray(column, row - 1))) : change_.d_du;
  if (!change_.d_du.allFinite() || !change_.d_dv.allFinite()) change_.d_du = change_.d_dv = Eigen::Vector2f::Zero();
}

Eigen::Vector2f RayBlock::ray(int column, int row) const {
  const int u = std::clamp(left_ + column - 1, -1, rays_.width());
  const int v = std::clamp(top_ + row - 1, -1, rays_.height());
  return {rays_.x(u, v), rays_.y(u, v)};
}

RayChange RayBlock::change_at(int column, int row) const {
  const RayChange here{0.5f * (ray(column + 1, row) - ray(column - 1, row)),
                       0.5f * (ray(column, row + 1) - ray(column, row - 1))};
  return here.d_du.allFinite() && here.d_dv.allFinite() ? here : change_;
}

void RayBlock::bound() {
  const float pad_x = change_.d_du.cwiseAbs().maxCoeff(), pad_y = change_.d_dv.cwiseAbs().maxCoeff();
  const float pad = std::max(pad_x, pad_y);
  low_.array() -= pad;
  high_.array() += pad;
  planes_[0] = (R_ * Eigen::Vector3d(1, 0, -low_.x())).cast<float>();
  planes_[1] = (R_ * Eigen::Vector3d(-1, 0, high_.x())).cast<float>();
  planes_[2] = (R_ * Eigen::Vector3d(0, 1, -low_.y())).cast<float>();
  planes_[3] = (R_ * Eigen::Vector3d(0, -1, high_.y())).cast<float>();
  axis_ = R_.col(2).cast<float>();
  position_ = T_world_camera_.translation().cast<float>();
}

void RayBlock::traverse() {
  if (!(low_.x() <= high_.x()) || scene_.nodes().empty()) return;
  bound();
  struct Entry {
    int node;
    float z;
  };
  Entry stack[64];
  int size = 0;
  float z = 0;
  if (node_visible(0, z)) stack[size++] = {0, z};
  while (size > 0) {
    const Entry entry = stack[--size];
    if (entry.z * farthest_ > 1) continue;
    const BvhNode& node = scene_.nodes()[entry.node];
    if (node.count > 0) {
      for (int i = node.first; i < node.first + node.count; ++i) visit(scene_.order()[i]);
      continue;
    }
    float z_first = 0, z_second = 0;
    const bool first = node_visible(node.first, z_first), second = node_visible(node.first + 1, z_second);
    const bool first_nearer = z_first <= z_second;
    if (first && second) {
      stack[size++] = first_nearer ? Entry{node.first + 1, z_second} : Entry{node.first, z_first};
      stack[size++] = first_nearer ? Entry{node.first, z_first} : Entry{node.first + 1, z_second};
    } else if (first) {
      stack[size++] = {node.first, z_first};
    } else if (second) {
      stack[size++] = {node.first + 1, z_second};
    }
  }
}

bool RayBlock::node_visible(int index, float& z) const {
  const BvhNode& node = scene_.nodes()[index];
  const Eigen::Vector3f centre = 0.5f * (node.low + node.high) - position_;
  const Eigen::Vector3f half = 0.5f * (node.high - node.low);
  for (const Eigen::Vector3f& plane : planes_) {
    if (plane.dot(centre) + plane.cwiseAbs().dot(half) < 0) return false;
  }
  const float middle = axis_.dot(centre), reach = axis_.cwiseAbs().dot(half);
  z = std::max(middle - reach, 0.0f);
  return middle + reach > 0;
}

template <bool kTriangle>
bool RayBlock::test(const SeenSurface& s, int id) {
  const LinearForm w_form = s.w, uw_form = s.uw, vw_form = s.vw;
  int taken = 0;
  for (int row = s.row_begin; row < s.row_end; ++row) {
    const float* x = x_.data() + row * kMaxColumns;
    const float* y = y_.data() + row * kMaxColumns;
    float* best = best_.data() + row * kMaxColumns;
    int* hit = hit_.data() + row * kMaxColumns;
    for (int i = 0; i < kMaxColumns; ++i) {
      const float w = w_form.a * x[i] + (w_form.b * y[i] + w_form.c);
      const float uw = uw_form.a * x[i] + (uw_form.b * y[i] + uw_form.c);
      const float vw = vw_form.a * x[i] + (vw_form.b * y[i] + vw_form.c);
      const float rest_u = kTriangle ? w - uw - vw : w - uw;
      const float rest_v = kTriangle ? rest_u : w - vw;
      const float near_side = uw < vw ? uw : vw;
      const float far_side = rest_u < rest_v ? rest_u : rest_v;
      const float inside = near_side < far_side ? near_side : far_side;
      const int take = static_cast<int>(inside >= 0.0f) & static_cast<int>(w > best[i]);
      best[i] = take ? w : best[i];
      hit[i] = take ? id : hit[i];
      taken |= take;
    }
  }
  return taken != 0;
}

void RayBlock::update_farthest() {
  float farthest = kNoRay;
  for (int row = 0; row < rows_; ++row) {
    const float* best = best_.data() + row * kMaxColumns;
    for (int i = 0; i < columns_; ++i) farthest = best[i] < farthest ? best[i] : farthest;
  }
  farthest_ = farthest;
}

void RayBlock::visit(int surface_index) {
  const Surface& s = scene_.surfaces()[surface_index];
  const Eigen::Vector3d o = s.origin - T_world_camera_.translation();
  const Eigen::Vector3d normal = s.edge_u.cross(s.edge_v);
  const double c = normal.dot(o);
  if ((c <= 0 && !s.two_sided) || std::abs(c) < 1e-9) return;
  SeenSurface seen;
  if (!in_frustum(s, o, seen)) return;
  const auto form = [&](const Eigen::Vector3d& in_world) {
    const Eigen::Vector3d in_camera = R_.transpose() * in_world / c;
    return LinearForm{static_cast<float>(in_camera.x()), static_cast<float>(in_camera.y()),
                      static_cast<float>(in_camera.z())};
  };
  seen.w = form(normal);
  seen.uw = form(s.edge_v.cross(o));
  seen.vw = form(o.cross(s.edge_u));
  seen.triangle = s.triangle;
  seen.surface = surface_index;
  const int id = static_cast<int>(seen_.size());
  seen_.push_back(seen);
  if (s.triangle ? test<true>(seen, id) : test<false>(seen, id)) update_farthest();
}

bool RayBlock::in_frustum(const Surface& s, const Eigen::Vector3d& o, SeenSurface& seen) const {
  Eigen::Vector3f corners[4];
  const Eigen::Matrix3d R_camera_world = R_.transpose();
  const Eigen::Vector3d first = R_camera_world * o, along_u = R_camera_world * s.edge_u,
                        along_v = R_camera_world * s.edge_v;
  corners[0] = first.cast<float>();
  corners[1] = (first + along_u).cast<float>();
  corners[2] = (first + along_v).cast<float>();
  corners[3] = (first + along_u + along_v).cast<float>();
  const int count = s.triangle ? 3 : 4;
  bool left = true, right = true, above = true, below = true, behind = true, all_front = true;
  float y_low = 1e30f, y_high = -1e30f;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3f& p = corners[i];
    left &= p.x() < low_.x() * p.z();
    right &= p.x() > high_.x() * p.z();
    above &= p.y() < low_.y() * p.z();
    below &= p.y() > high_.y() * p.z();
    behind &= p.z() <= 0;
    all_front &= p.z() > 1e-3f;
    y_low = std::min(y_low, p.y() / p.z());
    y_high = std::max(y_high, p.y() / p.z());
  }
  if (left || right || above || below || behind) return false;
  seen.row_begin = 0;
  seen.row_end = rows_;
  if (all_front) {
    const float pad = change_.d_dv.cwiseAbs().maxCoeff();
    while (seen.row_begin < rows_ && row_high_[seen.row_begin] + pad < y_low) ++seen.row_begin;
    while (seen.row_end > seen.row_begin && row_low_[seen.row_end - 1] - pad > y_high) --seen.row_end;
  }
  return seen.row_begin < seen.row_end;
}

}  // namespace ldso::simulation
