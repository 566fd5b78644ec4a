#pragma once

// How pixels of a host image are found in a target image. Included by Highway code: includes no Eigen header.

#include <algorithm>

#include "image/frame.h"

namespace ldso {

/// q = KRKi * (u, v, 1) + Kt * idepth is seen at (q0, q1) / q2 in the target.
struct PixelWarp {
  float KRKi[9] = {};  ///< K_t R_t_h K_h^-1, row-major.
  float Kt[3] = {};    ///< K_t t_t_h.
};

/// What the motion of both cameras during the readout of their images adds to a warp, for a row that is read one whole
/// readout after the middle one.
struct RollingWarp {
  bool on = false;
  PixelWarp host;             ///< Is added, multiplied by the time of the host's row.
  float target_KwKi[9] = {};  ///< K [angular velocity]x K^-1: is multiplied by q and the time of the target's row.
  float target_Kv[3] = {};    ///< K * velocity: is multiplied by the inverse depth and that time.
};

/// What is common to all residuals between one host and one target keyframe, at the current estimate.
struct PatternWarp : PixelWarp {
  const Texel* texels = nullptr;  ///< Target image, row-major without padding.
  int width = 0;
  int height = 0;
  RollingWarp rolling;
  float factor = 1;  ///< Brightness: I_target = factor * I_host + offset, current estimate.
  float offset = 0;
  float factor_lin = 1;  ///< The same factor at the linearization point.
  float host_b_lin = 0;  ///< b of the host at the linearization point.
};

/// The warp of one row of the host, as if the target had a global shutter.
inline PixelWarp warp_of_host_row(const PatternWarp& warp, float v) {
  PixelWarp result = warp;
  const float time = v / static_cast<float>(warp.height) - 0.5f;
  for (int i = 0; i < 9; ++i) result.KRKi[i] += time * warp.rolling.host.KRKi[i];
  for (int i = 0; i < 3; ++i) result.Kt[i] += time * warp.rolling.host.Kt[i];
  return result;
}

/// The warp around one pixel of the host: with a rolling shutter, of the rows that show it in both images.
inline PixelWarp warp_at(const PatternWarp& warp, float u, float v, float idepth) {
  if (!warp.rolling.on) return warp;
  const PixelWarp w = warp_of_host_row(warp, v);
  const float* W = warp.rolling.target_KwKi;
  float q[3], dq[3];
  for (int r = 0; r < 3; ++r) q[r] = w.KRKi[3 * r] * u + w.KRKi[3 * r + 1] * v + w.KRKi[3 * r + 2] + w.Kt[r] * idepth;
  if (!(q[2] > 1e-6f)) return w;
  for (int r = 0; r < 3; ++r) {
    dq[r] = W[3 * r] * q[0] + W[3 * r + 1] * q[1] + W[3 * r + 2] * q[2] + warp.rolling.target_Kv[r] * idepth;
  }
  // Which row shows the pixel depends on the motion, too: y' = y + time(y') * dy.
  const auto height = static_cast<float>(warp.height);
  const float y = q[1] / q[2], dy = (dq[1] - y * dq[2]) / q[2];
  const float time = std::clamp((y / height - 0.5f) / std::max(1 - dy / height, 0.5f), -0.6f, 0.6f);
  PixelWarp result = w;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) {
      result.KRKi[3 * r + c] +=
          time * (W[3 * r] * w.KRKi[c] + W[3 * r + 1] * w.KRKi[3 + c] + W[3 * r + 2] * w.KRKi[6 + c]);
    }
    result.Kt[r] +=
        time * (W[3 * r] * w.Kt[0] + W[3 * r + 1] * w.Kt[1] + W[3 * r + 2] * w.Kt[2] + warp.rolling.target_Kv[r]);
  }
  return result;
}

}  // namespace ldso
