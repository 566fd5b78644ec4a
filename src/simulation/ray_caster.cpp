#include "simulation/ray_caster.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "ldso/error.h"

namespace ldso::simulation {
namespace {

constexpr int kMaxColumns = 32;
constexpr int kMaxRows = 16;
constexpr int kMaxRays = kMaxColumns * kMaxRows;
constexpr int kSubsamples = 32;
constexpr int kMaxProbes = 12;
constexpr int kMaxDetailProbes = 6;
constexpr int kMaxNear = 64;  ///< Surfaces that are looked at within one pixel.
/// The subsamples of a mixed pixel reach one pixel to all sides.
constexpr float kReach = 1.02f;

/// Linear function of the ray direction: a * x + b * y + c.
struct LinearForm {
  float a = 0, b = 0, c = 0;
  float operator()(float x, float y) const { return a * x + b * y + c; }
};

/// A surface seen from one place: inverse depth w, and u * w, v * w, as functions of the ray.
struct Candidate {
  LinearForm w, uw, vw;
  int surface = 0;
  bool triangle = false;
  int row_begin = 0, row_end = 0;  ///< Rows of the block it can appear in.
};

/// Boundaries of a candidate as four forms that are positive inside.
struct EdgeValues {
  float value[4];
};

EdgeValues edges(const Candidate& s, float x, float y) {
  const float w = s.w(x, y), uw = s.uw(x, y), vw = s.vw(x, y);
  if (s.triangle) return {{uw, vw, w - uw - vw, w - uw - vw}};
  return {{uw, vw, w - uw, w - vw}};
}

/// How far each boundary form moves over the reach of the subsamples.
EdgeValues edge_margins(const Candidate& s, const Eigen::Vector2f& d_du, const Eigen::Vector2f& d_dv) {
  const auto reach = [&](float a, float b) {
    return kReach * (std::abs(a * d_du.x() + b * d_du.y()) + std::abs(a * d_dv.x() + b * d_dv.y()));
  };
  const LinearForm& w = s.w;
  const LinearForm& u = s.uw;
  const LinearForm& v = s.vw;
  const float far_u = s.triangle ? reach(w.a - u.a - v.a, w.b - u.b - v.b) : reach(w.a - u.a, w.b - u.b);
  const float far_v = s.triangle ? far_u : reach(w.a - v.a, w.b - v.b);
  return {{reach(u.a, u.b), reach(v.a, v.b), far_u, far_v}};
}

/// Distribution of a tent over -1..1 from a uniform one over 0..1. Tents of neighbouring pixels add up to one
/// everywhere, so a thing thinner than a pixel has the same weight wherever it lies.
float tent_quantile(float p) { return p < 0.5f ? std::sqrt(2 * p) - 1 : 1 - std::sqrt(2 * (1 - p)); }

/// Points around a pixel whose projections on both axes are spread evenly (Hammersley set) under a tent.
std::array<Eigen::Vector2f, kSubsamples> make_subsamples() {
  std::array<Eigen::Vector2f, kSubsamples> points;
  for (int i = 0; i < kSubsamples; ++i) {
    int reversed = 0;
    for (int bit = 1; bit < kSubsamples; bit *= 2) reversed = 2 * reversed + ((i & bit) != 0 ? 1 : 0);
    points[i] = {tent_quantile((static_cast<float>(i) + 0.5f) / kSubsamples),
                 tent_quantile((static_cast<float>(reversed) + 0.5f) / kSubsamples)};
  }
  return points;
}

/// The rays of a block of pixels with a border of one pixel, and what they hit.
class Block {
 public:
  Block(const Scene& scene, const CameraRays& rays, int left, int top, int columns, int rows)
      : scene_(scene), rays_(rays), left_(left), top_(top), columns_(columns + 2), rows_(rows + 2) {
    load_rays();
  }

  void trace(const SE3d& T_world_camera) {
    T_world_camera_ = T_world_camera;
    R_ = T_world_camera.rotation_matrix();
    traverse();
  }

  void shade(const RenderTarget& target) {
    find_mixed_pixels();
    for (int row = 1; row < rows_ - 1; ++row) {
      for (int column = 1; column < columns_ - 1; ++column) {
        const int u = left_ + column - 1, v = top_ + row - 1, i = index(column, row);
        if (target.depth != nullptr) (*target.depth)(u, v) = hit_[i] >= 0 ? 1.0f / best_[i] : 0.0f;
        if (target.radiance != nullptr) (*target.radiance)(u, v) = radiance(column, row);
      }
    }
  }

 private:
  int index(int column, int row) const { return row * kMaxColumns + column; }

  void load_rays() {
    x_.fill(0);
    y_.fill(0);
    best_.fill(1e30f);
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
    d_du_ = 0.5f * (ray(column + 1, row) - ray(column - 1, row));
    d_dv_ = rows_ > 2 ? Eigen::Vector2f(0.5f * (ray(column, row + 1) - ray(column, row - 1))) : d_du_;
    if (!d_du_.allFinite() || !d_dv_.allFinite()) d_du_ = d_dv_ = Eigen::Vector2f::Zero();
  }

  Eigen::Vector2f ray(int column, int row) const {
    const int u = std::clamp(left_ + column - 1, -1, rays_.width());
    const int v = std::clamp(top_ + row - 1, -1, rays_.height());
    return {rays_.x(u, v), rays_.y(u, v)};
  }

  /// Change of the ray per pixel at one pixel.
  void ray_derivatives(int column, int row, Eigen::Vector2f& d_du, Eigen::Vector2f& d_dv) const {
    d_du = 0.5f * (ray(column + 1, row) - ray(column - 1, row));
    d_dv = 0.5f * (ray(column, row + 1) - ray(column, row - 1));
    if (!d_du.allFinite() || !d_dv.allFinite()) {
      d_du = d_du_;
      d_dv = d_dv_;
    }
  }

  void traverse() {
    if (!(low_.x() <= high_.x()) || scene_.nodes().empty()) return;
    // Planes through the camera that bound the block, pointing inwards.
    const float pad_x = d_du_.cwiseAbs().maxCoeff(), pad_y = d_dv_.cwiseAbs().maxCoeff();
    const float pad = std::max(pad_x, pad_y);
    low_.array() -= pad;
    high_.array() += pad;
    planes_[0] = (R_ * Eigen::Vector3d(1, 0, -low_.x())).cast<float>();
    planes_[1] = (R_ * Eigen::Vector3d(-1, 0, high_.x())).cast<float>();
    planes_[2] = (R_ * Eigen::Vector3d(0, 1, -low_.y())).cast<float>();
    planes_[3] = (R_ * Eigen::Vector3d(0, -1, high_.y())).cast<float>();
    axis_ = R_.col(2).cast<float>();
    position_ = T_world_camera_.translation().cast<float>();
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

  /// False if the box is outside of the block's frustum; `z`: a lower bound of its depth.
  bool node_visible(int index, float& z) const {
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

  void visit(int surface_index) {
    const Surface& s = scene_.surfaces()[surface_index];
    const Eigen::Vector3d o = s.origin - T_world_camera_.translation();
    const Eigen::Vector3d normal = s.edge_u.cross(s.edge_v);
    const double c = normal.dot(o);
    if ((c <= 0 && !s.two_sided) || std::abs(c) < 1e-9) return;
    Candidate candidate;
    if (!in_frustum(s, o, candidate)) return;
    const auto form = [&](const Eigen::Vector3d& in_world) {
      const Eigen::Vector3d in_camera = R_.transpose() * in_world / c;
      return LinearForm{static_cast<float>(in_camera.x()), static_cast<float>(in_camera.y()),
                        static_cast<float>(in_camera.z())};
    };
    candidate.w = form(normal);
    candidate.uw = form(s.edge_v.cross(o));
    candidate.vw = form(o.cross(s.edge_u));
    candidate.triangle = s.triangle;
    candidate.surface = surface_index;
    const int id = static_cast<int>(candidates_.size());
    candidates_.push_back(candidate);
    if (s.triangle ? test<true>(candidate, id) : test<false>(candidate, id)) update_farthest();
  }

  /// Tests the corners against the frustum; finds the rows the surface can appear in.
  bool in_frustum(const Surface& s, const Eigen::Vector3d& o, Candidate& candidate) const {
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
    candidate.row_begin = 0;
    candidate.row_end = rows_;
    if (all_front) {
      const float pad = d_dv_.cwiseAbs().maxCoeff();
      while (candidate.row_begin < rows_ && row_high_[candidate.row_begin] + pad < y_low) ++candidate.row_begin;
      while (candidate.row_end > candidate.row_begin && row_low_[candidate.row_end - 1] - pad > y_high)
        --candidate.row_end;
    }
    return candidate.row_begin < candidate.row_end;
  }

  /// Where the surface is nearer than what was found, takes it. True if it was taken anywhere.
  template <bool kTriangle>
  bool test(const Candidate& s, int id) {
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

  void update_farthest() {
    float farthest = 1e30f;
    for (int row = 0; row < rows_; ++row) {
      const float* best = best_.data() + row * kMaxColumns;
      for (int i = 0; i < columns_; ++i) farthest = best[i] < farthest ? best[i] : farthest;
    }
    farthest_ = farthest;
  }

  int group_of(int i) const { return hit_[i] < 0 ? -1 : scene_.surfaces()[candidates_[hit_[i]].surface].group; }

  /// Marks the pixels that show more than one surface.
  void find_mixed_pixels() {
    mixed_.fill(0);
    for (int row = 1; row < rows_ - 1; ++row) {
      for (int column = 1; column < columns_ - 1; ++column) {
        const int i = index(column, row);
        const int group = group_of(i);
        mixed_[i] = group_of(i - 1) != group || group_of(i + 1) != group || group_of(i - kMaxColumns) != group ||
                    group_of(i + kMaxColumns) != group;
      }
    }
    for (const Candidate& candidate : candidates_) mark_outline(candidate);
  }

  /// Outlines of surfaces that no pixel centre may have hit (thin poles).
  void mark_outline(const Candidate& s) {
    const std::uint8_t sharp = scene_.surfaces()[s.surface].sharp_edges;
    if (sharp == 0) return;
    const EdgeValues margin = edge_margins(s, d_du_, d_dv_);
    for (int row = std::max(s.row_begin, 1); row < std::min(s.row_end, rows_ - 1); ++row) {
      for (int column = 1; column < columns_ - 1; ++column) {
        const int i = index(column, row);
        const float w = s.w(x_[i], y_[i]);
        if (w < best_[i] * 0.999f || w <= 0) continue;
        const EdgeValues edge = edges(s, x_[i], y_[i]);
        bool inside = true, crossed = false;
        for (int k = 0; k < 4; ++k) {
          inside &= edge.value[k] > -margin.value[k];
          crossed |= ((sharp >> k) & 1) != 0 && edge.value[k] < margin.value[k];
        }
        if (inside && crossed) mixed_[i] = 1;
      }
    }
  }

  float radiance(int column, int row) const {
    const int i = index(column, row);
    if (best_[i] >= 1e30f) return 0;
    Eigen::Vector2f d_du, d_dv;
    ray_derivatives(column, row, d_du, d_dv);
    if (mixed_[i] != 0) return mixed_radiance(x_[i], y_[i], d_du, d_dv);
    if (hit_[i] < 0) return sky_radiance(x_[i], y_[i], d_du);
    return surface_radiance(candidates_[hit_[i]], x_[i], y_[i], d_du, d_dv);
  }

  /// Mean over the surfaces in the pixel, each looked up once, where it is seen, and weighted with what it covers.
  float mixed_radiance(float x, float y, const Eigen::Vector2f& d_du, const Eigen::Vector2f& d_dv) const {
    static const std::array<Eigen::Vector2f, kSubsamples> kOffsets = make_subsamples();
    const Candidate* near[kMaxNear];
    const int count = candidates_near(x, y, d_du, d_dv, near);
    std::array<int, kSubsamples> seen;  // Index in `near`, or -1 for the sky.
    for (int k = 0; k < kSubsamples; ++k) {
      const Eigen::Vector2f at = Eigen::Vector2f(x, y) + kOffsets[k].x() * d_du + kOffsets[k].y() * d_dv;
      seen[k] = nearest_of(near, count, at.x(), at.y());
    }
    float sum = 0;
    std::array<bool, kSubsamples> done{};
    for (int k = 0; k < kSubsamples; ++k) {
      if (done[k]) continue;
      Eigen::Vector2f middle = Eigen::Vector2f::Zero();
      int covered = 0;
      for (int l = k; l < kSubsamples; ++l) {
        if (seen[l] != seen[k]) continue;
        done[l] = true;
        middle += kOffsets[l];
        ++covered;
      }
      middle /= static_cast<float>(covered);
      const Eigen::Vector2f at = Eigen::Vector2f(x, y) + middle.x() * d_du + middle.y() * d_dv;
      const float narrow = covered == kSubsamples ? 1.0f : 0.75f;
      const float value = seen[k] < 0 ? sky_radiance(at.x(), at.y(), d_du)
                                      : surface_radiance(*near[seen[k]], at.x(), at.y(), narrow * d_du, narrow * d_dv);
      sum += static_cast<float>(covered) * value;
    }
    return sum / kSubsamples;
  }

  /// Candidates that any subsample of the pixel can see.
  int candidates_near(float x, float y, const Eigen::Vector2f& d_du, const Eigen::Vector2f& d_dv,
                      const Candidate** near) const {
    int count = 0;
    for (const Candidate& s : candidates_) {
      const EdgeValues edge = edges(s, x, y), margin = edge_margins(s, d_du, d_dv);
      bool touched = count < kMaxNear;
      for (int k = 0; k < 4; ++k) touched &= edge.value[k] > -margin.value[k];
      if (touched) near[count++] = &s;
    }
    return count;
  }

  static int nearest_of(const Candidate* const* near, int count, float x, float y) {
    int nearest = -1;
    float best = 0;
    for (int i = 0; i < count; ++i) {
      const float w = near[i]->w(x, y);
      if (w <= best) continue;
      const EdgeValues edge = edges(*near[i], x, y);
      if (edge.value[0] < 0 || edge.value[1] < 0 || edge.value[2] < 0 || edge.value[3] < 0) continue;
      best = w;
      nearest = i;
    }
    return nearest;
  }

  float surface_radiance(const Candidate& c, float x, float y, const Eigen::Vector2f& d_du,
                         const Eigen::Vector2f& d_dv) const {
    const Surface& s = scene_.surfaces()[c.surface];
    const float depth = 1.0f / c.w(x, y);
    const float u = c.uw(x, y) * depth, v = c.vw(x, y) * depth;
    // Derivatives of the quotients u = uw / w and v = vw / w along the two pixel axes.
    const auto along = [&](const LinearForm& form, float value, const Eigen::Vector2f& d) {
      return ((form.a - value * c.w.a) * d.x() + (form.b - value * c.w.b) * d.y()) * depth;
    };
    const float du_dx = along(c.uw, u, d_du), dv_dx = along(c.vw, v, d_du);
    const float du_dy = along(c.uw, u, d_dv), dv_dy = along(c.vw, v, d_dv);
    const auto look_up = [&](const TextureMapping& m, int most) {
      const Footprint footprint{m.s0 + u * m.s_u, m.t0 + v * m.t_v, du_dx * m.s_u,
                                dv_dx * m.t_v,    du_dy * m.s_u,    dv_dy * m.t_v};
      return scene_.texture(m.texture).sample(footprint, most);
    };
    float value = look_up(s.base, kMaxProbes);
    if (s.detail.texture >= 0) {
      // Fine detail averages out over large footprints: no need to look it up there.
      const float area = std::abs(du_dx * dv_dy - du_dy * dv_dx) * std::abs(s.detail.s_u * s.detail.t_v);
      if (area < 32.0f * 32.0f) value += s.detail_gain * (look_up(s.detail, kMaxDetailProbes) - Scene::kDetailMean);
    }
    return std::max(0.0f, value * s.gain);
  }

  float sky_radiance(float x, float y, const Eigen::Vector2f& d_du) const {
    if (scene_.sky() < 0) return 0;
    const Eigen::Vector3f direction = (R_.cast<float>() * Eigen::Vector3f(x, y, 1)).normalized();
    const Texture& sky = scene_.texture(scene_.sky());
    const float turn = std::atan2(direction.x(), direction.z()) * (0.5f * std::numbers::inv_pi_v<float>)+0.5f;
    const float elevation = std::asin(std::clamp(direction.y(), -1.0f, 1.0f)) * std::numbers::inv_pi_v<float> + 0.5f;
    const float texel_angle = std::numbers::pi_v<float> / static_cast<float>(sky.height());
    return sky.probe(turn * static_cast<float>(sky.width()), elevation * static_cast<float>(sky.height()),
                     d_du.norm() / texel_angle);
  }

  const Scene& scene_;
  const CameraRays& rays_;
  int left_, top_, columns_, rows_;
  SE3d T_world_camera_;
  Eigen::Matrix3d R_;
  std::array<float, kMaxRays> x_, y_;
  std::array<float, kMaxRays> best_;  ///< Inverse depth; 0: nothing, 1e30: no ray.
  std::array<int, kMaxRays> hit_;     ///< Index in candidates_, -1: sky.
  std::array<std::uint8_t, kMaxRays> mixed_;
  std::array<float, kMaxRows> row_low_, row_high_;
  Eigen::Vector2f low_, high_;
  Eigen::Vector2f d_du_, d_dv_;
  std::array<Eigen::Vector3f, 4> planes_;
  Eigen::Vector3f axis_, position_;
  float farthest_ = 0;  ///< Least inverse depth of the block.
  std::vector<Candidate> candidates_;
};

}  // namespace

CameraRays::CameraRays(int width, int height, const Unproject& unproject)
    : width_(width), height_(height), x_(width + 2, height + 2), y_(width + 2, height + 2) {
  for (int v = -1; v <= height; ++v) {
    for (int u = -1; u <= width; ++u) {
      const Eigen::Vector2d ray = unproject(u, v);
      x_(u + 1, v + 1) = static_cast<float>(ray.x());
      y_(u + 1, v + 1) = static_cast<float>(ray.y());
    }
  }
}

void RayCaster::render(const std::vector<SE3d>& row_poses, const RenderTarget& target, ThreadPool* pool) const {
  const int width = rays_.width(), height = rays_.height();
  const bool rolling = row_poses.size() > 1;
  if (row_poses.empty() || (rolling && static_cast<int>(row_poses.size()) != height)) {
    throw Error("ray caster", "needs one pose, or one for each row", "");
  }
  if (target.radiance != nullptr) *target.radiance = Image<float>(width, height);
  if (target.depth != nullptr) *target.depth = Image<float>(width, height);
  const int block_columns = kMaxColumns - 2;
  const int block_rows = rolling ? 1 : kMaxRows - 2;
  const int across = (width + block_columns - 1) / block_columns;
  const int down = (height + block_rows - 1) / block_rows;
  const auto render_block = [&](int i) {
    const int left = (i % across) * block_columns, top = (i / across) * block_rows;
    Block block(scene_, rays_, left, top, std::min(block_columns, width - left), std::min(block_rows, height - top));
    block.trace(row_poses[rolling ? top : 0]);
    block.shade(target);
  };
  if (pool != nullptr) {
    pool->run(across * down, render_block);
  } else {
    for (int i = 0; i < across * down; ++i) render_block(i);
  }
}

}  // namespace ldso::simulation
