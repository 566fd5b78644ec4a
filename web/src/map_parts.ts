// Where the map was lost and no loop has joined what came before to what came after, both are maps of their own: where
// they lie to each other, and how large they are, nobody knows. They are drawn side by side, so that nobody takes them for
// one.

import type { Vec3 } from './protocol';

/** By how much each segment of a run is moved; none at all while there is one part only. */
export interface Places {
  odometry: (Vec3 | undefined)[];
  corrected: (Vec3 | undefined)[];
  parts: number; // that no loop has joined
}

export const NO_PLACES: Places = { odometry: [], corrected: [], parts: 1 };

export interface PlacedKeyframe {
  segment: number;
  odometry: Vec3;
  corrected: Vec3;
}

/** Between two maps, as a share of the width of the larger one. */
const GAP = 0.25;

/** The part of each segment: the smallest segment that loops have joined it to. */
export function partsOf(segments: number, joined: [number, number][]): number[] {
  const part = Array.from({ length: segments }, (_, i) => i);
  const find = (i: number): number => (part[i] === i ? i : find(part[i]));
  for (const [a, b] of joined) {
    const [low, high] = [find(a), find(b)].sort((p, q) => p - q);
    part[high] = low;
  }
  return part.map((_, i) => find(i));
}

/** The largest stays where it is, the others come beside it, along x. */
function sideBySide(positions: Vec3[], partOf: number[]): (Vec3 | undefined)[] {
  const boxes = new Map<number, { count: number; low: Vec3; high: Vec3 }>();
  positions.forEach((p, i) => {
    const box = boxes.get(partOf[i]);
    if (!box) {
      boxes.set(partOf[i], { count: 1, low: [...p], high: [...p] });
      return;
    }
    ++box.count;
    for (let k = 0; k < 3; ++k) {
      box.low[k] = Math.min(box.low[k], p[k]);
      box.high[k] = Math.max(box.high[k], p[k]);
    }
  });
  const order = [...boxes.entries()].sort(([, a], [, b]) => b.count - a.count);
  const moves: (Vec3 | undefined)[] = [];
  const widest = Math.max(...order.map(([, b]) => Math.max(...[0, 1, 2].map((k) => b.high[k] - b.low[k]))), 1e-9);
  const [, main] = order[0];
  let edge = main.high[0];
  for (const [part, box] of order.slice(1)) {
    const left = edge + GAP * widest;
    moves[part] = [left - box.low[0], main.low[1] - box.low[1], main.low[2] - box.low[2]];
    edge = left + box.high[0] - box.low[0];
  }
  return moves;
}

/** `joined`: pairs of segments between which loops were closed. */
export function layOut(keyframes: PlacedKeyframe[], joined: [number, number][]): Places {
  const segments = keyframes.reduce((most, k) => Math.max(most, k.segment + 1), 1);
  const part = partsOf(segments, joined);
  const used = new Set(keyframes.map((k) => k.segment));
  const parts = new Set([...used].map((segment) => part[segment])).size;
  if (used.size < 2) return NO_PLACES;
  const odometry = sideBySide(keyframes.map((k) => k.odometry), keyframes.map((k) => k.segment));
  const moves = sideBySide(keyframes.map((k) => k.corrected), keyframes.map((k) => part[k.segment]));
  return { odometry, corrected: part.map((p) => moves[p]), parts };
}

/** What is to be said of it; empty if there is one part only. */
export function partsNote(places: Places): string {
  if (places.parts < 2) return '';
  return `${places.parts} maps that no loop has joined, drawn side by side: where they lie to each other, and their sizes, are unknown`;
}
