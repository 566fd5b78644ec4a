// Similarities: applied, composed, inverted.

import type { Pose, Quat, Vec3 } from './protocol';

export const IDENTITY: Pose = { t: [0, 0, 0], q: [0, 0, 0, 1], s: 1 };

export function rotate(q: Quat, v: Vec3): Vec3 {
  const [x, y, z, w] = q;
  const tx = 2 * (y * v[2] - z * v[1]);
  const ty = 2 * (z * v[0] - x * v[2]);
  const tz = 2 * (x * v[1] - y * v[0]);
  return [
    v[0] + w * tx + y * tz - z * ty,
    v[1] + w * ty + z * tx - x * tz,
    v[2] + w * tz + x * ty - y * tx,
  ];
}

export function apply(pose: Pose, p: Vec3): Vec3 {
  const r = rotate(pose.q, p);
  return [pose.s * r[0] + pose.t[0], pose.s * r[1] + pose.t[1], pose.s * r[2] + pose.t[2]];
}

export function multiply(a: Quat, b: Quat): Quat {
  return [
    a[3] * b[0] + a[0] * b[3] + a[1] * b[2] - a[2] * b[1],
    a[3] * b[1] - a[0] * b[2] + a[1] * b[3] + a[2] * b[0],
    a[3] * b[2] + a[0] * b[1] - a[1] * b[0] + a[2] * b[3],
    a[3] * b[3] - a[0] * b[0] - a[1] * b[1] - a[2] * b[2],
  ];
}

/** a * b: first b, then a. */
export function compose(a: Pose, b: Pose): Pose {
  return { t: apply(a, b.t), q: multiply(a.q, b.q), s: a.s * b.s };
}
