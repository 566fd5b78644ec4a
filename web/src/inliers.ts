// What of a map belongs into the first view: a few points far away, or a pose that was lost, must not make all the rest a
// dot.

import type { Vec3 } from './protocol';

/** Of points so much is left out at either end of each axis. */
const STRAY_POINTS = 0.03;
/** A position farther from the middle than so many times the median distance from it is a stray one. */
const STRAY_POSITION = 12;

export function median(values: number[]): number {
  return percentile(values, 0.5);
}

function percentile(values: number[], share: number): number {
  const sorted = [...values].sort((a, b) => a - b);
  return sorted[Math.min(sorted.length - 1, Math.floor(share * sorted.length))];
}

const AXES = [0, 1, 2] as const;
const isFinitePoint = (p: Vec3) => p.every(Number.isFinite);

/** Positions without those that lie far away from most. */
function withoutStray(positions: Vec3[]): Vec3[] {
  if (positions.length < 8) return positions;
  const middle = AXES.map((k) => median(positions.map((p) => p[k])));
  const distance = (p: Vec3) => Math.hypot(...AXES.map((k) => p[k] - middle[k]));
  const usual = median(positions.map(distance));
  return positions.filter((p) => distance(p) <= STRAY_POSITION * usual);
}

/** Around the way of the camera and around most of the points; null if there is neither. */
export function inlierBox(way: Vec3[], points: Vec3[]): { low: Vec3; high: Vec3 } | null {
  const positions = withoutStray(way.filter(isFinitePoint));
  const finite = points.filter(isFinitePoint);
  if (positions.length + finite.length === 0) return null;
  const low: Vec3 = [Infinity, Infinity, Infinity];
  const high: Vec3 = [-Infinity, -Infinity, -Infinity];
  for (const p of positions) {
    for (const k of AXES) [low[k], high[k]] = [Math.min(low[k], p[k]), Math.max(high[k], p[k])];
  }
  if (finite.length > 0) {
    for (const k of AXES) {
      const values = finite.map((p) => p[k]);
      low[k] = Math.min(low[k], percentile(values, STRAY_POINTS));
      high[k] = Math.max(high[k], percentile(values, 1 - STRAY_POINTS));
    }
  }
  return { low, high };
}
