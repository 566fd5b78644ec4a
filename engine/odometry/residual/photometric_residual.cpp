#include "odometry/residual/photometric_residual.h"

namespace ldso {
namespace {

Eigen::Matrix3d camera_matrix(const Eigen::Vector4d& camera) {
  Eigen::Matrix3d K = Eigen::Matrix3d::Identity();
  K(0, 0) = camera[0];
  K(1, 1) = camera[1];
  K(0, 2) = camera[2];
  K(1, 2) = camera[3];
  return K;
}

void store(const Eigen::Matrix3d& M, const Eigen::Vector3d& m, float* to_M, float* to_m) {
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) to_M[3 * r + c] = static_cast<float>(M(r, c));
    to_m[r] = static_cast<float>(m[r]);
  }
}

}  // namespace

PatternWarp make_warp(const SE3d& T_target_host, const Eigen::Vector4d& camera, const BrightnessTransfer& transfer,
                      const Image<Texel>& target_image) {
  const Eigen::Matrix3d K = camera_matrix(camera);
  PatternWarp warp;
  warp.texels = target_image.data();
  warp.width = target_image.width();
  warp.height = target_image.height();
  store(K * T_target_host.rotation_matrix() * K.inverse(), K * T_target_host.translation(), warp.KRKi, warp.Kt);
  warp.factor = static_cast<float>(transfer.factor);
  warp.offset = static_cast<float>(transfer.offset);
  warp.factor_lin = warp.factor;
  return warp;
}

void add_readout(const SE3d& T_target_host, const Eigen::Vector4d& camera, const ReadoutMotion& host,
                 const ReadoutMotion& target, PatternWarp& warp) {
  RollingWarp& rolling = warp.rolling;
  rolling.on = !host.isZero(0) || !target.isZero(0);
  if (!rolling.on) return;
  const Eigen::Matrix3d K = camera_matrix(camera), Ki = K.inverse(), KR = K * T_target_host.rotation_matrix();
  // A host's pixel is given: what it shows had moved with the camera already, which is taken back.
  store(-KR * SO3d::hat(host.tail<3>()) * Ki, -KR * host.head<3>(), rolling.host.KRKi, rolling.host.Kt);
  store(K * SO3d::hat(target.tail<3>()) * Ki, K * target.head<3>(), rolling.target_KwKi, rolling.target_Kv);
}

FramePair make_frame_pair(const Keyframe& host, const Keyframe& target, const Eigen::Vector4d& camera,
                          const Eigen::Vector4d& camera_lin, double readout_s) {
  const double host_exposure = host.frame->exposure_ms;
  const double target_exposure = target.frame->exposure_ms;
  FramePair pair;
  const SE3d T_target_host = target.state.T_c_w() * host.state.T_c_w().inverse();
  pair.warp =
      make_warp(T_target_host, camera,
                brightness_transfer(host_exposure, host.state.brightness(), target_exposure, target.state.brightness()),
                target.image());
  add_readout(T_target_host, camera, readout_s * host.velocity, readout_s * target.velocity, pair.warp);
  const SE3d T_lin = target.state.T_c_w_lin * host.state.T_c_w_lin.inverse();
  const BrightnessTransfer lin =
      brightness_transfer(host_exposure, host.state.brightness_lin, target_exposure, target.state.brightness_lin);
  pair.warp.factor_lin = static_cast<float>(lin.factor);
  pair.warp.host_b_lin = static_cast<float>(host.state.brightness_lin.b);
  pair.R_lin = T_lin.rotation_matrix().cast<float>();
  pair.t_lin = T_lin.translation().cast<float>();
  pair.camera_lin = camera_lin.cast<float>();
  pair.host_adjoint.setZero();
  pair.host_adjoint.topLeftCorner<6, 6>() = -T_lin.adjoint();
  pair.host_adjoint(6, 6) = -1;
  pair.host_adjoint(7, 7) = -lin.factor;
  pair.host_adjoint_f = pair.host_adjoint.cast<float>();
  return pair;
}

bool projection_jacobian(const FramePair& pair, float u, float v, float idepth, ProjectionJacobian& J) {
  const float fx = pair.camera_lin[0], fy = pair.camera_lin[1];
  const Eigen::Vector3f ray((u - pair.camera_lin[2]) / fx, (v - pair.camera_lin[3]) / fy, 1.0f);
  const Eigen::Vector3f p = pair.R_lin * ray + pair.t_lin * idepth;
  if (!(p.z() > 1e-6f)) return false;
  const float inverse_z = 1.0f / p.z();
  const float x = p.x() * inverse_z, y = p.y() * inverse_z;
  const float target_idepth = idepth * inverse_z;
  const auto& R = pair.R_lin;
  const Eigen::Vector3f& t = pair.t_lin;
  J.pose << fx * target_idepth, 0, -fx * target_idepth * x, -fx * x * y, fx * (1 + x * x), -fx * y,  //
      0, fy * target_idepth, -fy * target_idepth * y, -fy * (1 + y * y), fy * x * y, fy * x;
  J.idepth << fx * inverse_z * (t.x() - t.z() * x), fy * inverse_z * (t.y() - t.z() * y);
  // Through the host's ray: d ray / d fx = (-ray.x / fx, 0, 0), d ray / d cx = (-1 / fx, 0, 0), y likewise.
  const float ux = fx * inverse_z * (R(0, 0) - x * R(2, 0)), uy = fx * inverse_z * (R(0, 1) - x * R(2, 1));
  const float vx = fy * inverse_z * (R(1, 0) - y * R(2, 0)), vy = fy * inverse_z * (R(1, 1) - y * R(2, 1));
  J.camera << x - ux * ray.x() / fx, -uy * ray.y() / fy, 1 - ux / fx, -uy / fy,  //
      -vx * ray.x() / fx, y - vy * ray.y() / fy, -vx / fx, 1 - vy / fy;
  return true;
}

}  // namespace ldso
