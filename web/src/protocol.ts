// The messages of a run as typed values. The format is documented in docs/viewer.md.

export const PROTOCOL_VERSION = 1;

export type Vec3 = [number, number, number];
export type Quat = [number, number, number, number]; // x y z w

/** A similarity p -> s R(q) p + t; rigid motions have s = 1. */
export interface Pose {
  t: Vec3;
  q: Quat;
  s: number;
}

export interface PointArrays {
  count: number;
  xyz: Float32Array; // in the keyframe's coordinates
  depthStddev: Float32Array; // relative
  intensity: Uint8Array;
  isCorner: Uint8Array;
  colors: Uint8Array | null; // red, green, blue of each, if the images have colour and were read again
}

export interface Hello {
  kind: 'hello';
  version: number;
  runId: bigint;
  epoch: number;
  replay: boolean;
  hasControl: boolean;
  width: number;
  height: number;
  fx: number;
  fy: number;
  cx: number;
  cy: number;
  name: string;
  metresPerUnit: number; // 0: nobody knows
}

export interface KeyframeMessage {
  kind: 'keyframe';
  id: number;
  timestamp: number;
  pose: Pose; // of the odometry
  points: PointArrays;
  links: number[];
  segment: number; // the map was lost between two of them
}

export interface PosesMessage {
  kind: 'poses';
  atFrame: number;
  correction: Pose;
  poses: { id: number; pose: Pose }[];
}

export const enum Tracking {
  Initializing = 0,
  Tracked = 1,
  Lost = 2,
}

export interface Frame {
  id: number;
  timestamp: number;
  keyframeId: number;
  relative: Pose; // frame to keyframe
  world: Pose | null; // of the odometry, when it was tracked
  frameMs: number;
  residual: number;
  a: number;
  b: number;
  exposureMs: number;
  points: number;
  state: Tracking;
  isKeyframe: boolean;
  isLate: boolean;
}

export interface FramesMessage {
  kind: 'frames';
  frames: Frame[];
}

export interface Loop {
  keyframeId: number;
  candidateId: number;
  atFrame: number;
  inliers: number;
  score: number;
}

export interface LoopsMessage {
  kind: 'loops';
  loops: Loop[];
}

export interface LogLine {
  atFrame: number;
  isWarning: boolean;
  text: string;
}

export interface LogMessage {
  kind: 'log';
  lines: LogLine[];
}

export interface TruthMessage {
  kind: 'truth';
  xyz: Float64Array;
}

export interface AlignmentMessage {
  kind: 'alignment';
  worldFromTruth: Pose;
  ateRmse: number;
  pairs: number;
}

export const enum RunState {
  Running = 0,
  Paused = 1,
  Finished = 2,
}

export interface StatusMessage {
  kind: 'status';
  state: RunState;
  done: number;
  count: number;
  viewers: number;
  loopCandidates: number;
  memoryMb: number;
  framesPerSecond: number;
  dropped: number; // frames of a live run that came too fast
}

export interface WindowMessage {
  kind: 'window';
  frameId: number;
  correction: Pose;
  camera: Pose | null;
  keyframes: { id: number; pose: Pose; points: PointArrays }[];
}

export interface ImageMessage {
  kind: 'image';
  frameId: number;
  width: number;
  height: number;
  count: number;
  pixels: Float32Array; // u, v, inverse depth and flags of each point
  flags: Uint32Array; // the same memory; flags: 1 corner, 2 candidate
  jpeg: Uint8Array;
}

export type Message =
  | Hello
  | KeyframeMessage
  | PosesMessage
  | FramesMessage
  | LoopsMessage
  | LogMessage
  | TruthMessage
  | AlignmentMessage
  | StatusMessage
  | WindowMessage
  | ImageMessage;

export const enum Command {
  Pause = 1,
  Continue = 2,
  Step = 3,
}

const HEADER_BYTES = 8;

/** Reads values in order; offsets of arrays are multiples of their elements' size by the format. */
class Reader {
  private readonly view: DataView;
  constructor(
    private readonly buffer: ArrayBuffer,
    private at: number,
    private readonly end: number,
  ) {
    this.view = new DataView(buffer);
  }
  u8 = () => this.view.getUint8(this.at++);
  u16 = () => this.advance(2, (at) => this.view.getUint16(at, true));
  u32 = () => this.advance(4, (at) => this.view.getUint32(at, true));
  i32 = () => this.advance(4, (at) => this.view.getInt32(at, true));
  f32 = () => this.advance(4, (at) => this.view.getFloat32(at, true));
  f64 = () => this.advance(8, (at) => this.view.getFloat64(at, true));
  u64 = () => this.advance(8, (at) => this.view.getBigUint64(at, true));
  i64 = () => Number(this.advance(8, (at) => this.view.getBigInt64(at, true)));
  align(unit: number): void {
    this.at = Math.ceil(this.at / unit) * unit;
  }
  /** Whether the message goes on: older servers and recordings leave out what came to its end later. */
  hasMore(): boolean {
    this.align(8);
    return this.at < this.end;
  }
  text(bytes: number): string {
    return new TextDecoder().decode(this.bytes(bytes));
  }
  bytes = (count: number) => this.advance(count, (at) => new Uint8Array(this.buffer, at, count));
  f32s = (count: number) => this.advance(4 * count, (at) => new Float32Array(this.buffer, at, count));
  u32s = (count: number) => this.advance(4 * count, (at) => new Uint32Array(this.buffer, at, count));
  f64s = (count: number) => this.advance(8 * count, (at) => new Float64Array(this.buffer, at, count));
  /** Looks at the next values once more, as another type. */
  peek<T>(read: () => T): T {
    const at = this.at;
    const result = read();
    this.at = at;
    return result;
  }
  rigid(read: () => number): Pose {
    return { t: [read(), read(), read()], q: [read(), read(), read(), read()], s: 1 };
  }
  similarity(): Pose {
    const pose = this.rigid(this.f64);
    pose.s = this.f64();
    return pose;
  }
  points(count: number): PointArrays {
    const xyz = this.f32s(3 * count);
    const depthStddev = this.f32s(count);
    const intensity = this.bytes(count);
    const isCorner = this.bytes(count);
    this.align(8);
    return { count, xyz, depthStddev, intensity, isCorner, colors: null };
  }
  private advance<T>(bytes: number, read: (at: number) => T): T {
    const at = this.at;
    this.at += bytes;
    return read(at);
  }
}

function readHello(r: Reader): Hello {
  if (r.text(4) !== 'LDSO') throw new Error('this is no stream of ldso');
  const version = r.u32();
  if (version !== PROTOCOL_VERSION) {
    throw new Error(`the server speaks version ${version}, this page version ${PROTOCOL_VERSION}: reload it`);
  }
  const runId = r.u64();
  const epoch = r.u32();
  const replay = r.u8() === 1;
  const hasControl = r.u8() === 1;
  r.u16();
  const [width, height] = [r.u32(), r.u32()];
  const [fx, fy, cx, cy] = [r.f64(), r.f64(), r.f64(), r.f64()];
  const name = r.text(r.u32());
  const metresPerUnit = r.hasMore() ? r.f64() : 0;
  return { kind: 'hello', version, runId, epoch, replay, hasControl, width, height, fx, fy, cx, cy, name, metresPerUnit };
}

function readKeyframe(r: Reader): KeyframeMessage {
  const id = r.i64();
  const timestamp = r.f64();
  const pose = r.rigid(r.f64);
  const count = r.u32();
  const linkCount = r.u32();
  const links: number[] = [];
  for (let i = 0; i < linkCount; ++i) links.push(r.i64());
  const points = r.points(count);
  let segment = 0;
  if (r.hasMore()) {
    segment = r.u32();
    if (r.u32() === 1) points.colors = r.bytes(3 * count);
  }
  return { kind: 'keyframe', id, timestamp, pose, links, points, segment };
}

function readPoses(r: Reader): PosesMessage {
  const atFrame = r.i64();
  const correction = r.similarity();
  const count = r.u32();
  r.align(8);
  const poses = [];
  for (let i = 0; i < count; ++i) poses.push({ id: r.i64(), pose: r.similarity() });
  return { kind: 'poses', atFrame, correction, poses };
}

function readFrame(r: Reader): Frame {
  const [id, timestamp, keyframeId] = [r.i64(), r.f64(), r.i64()];
  const relative = r.rigid(r.f32);
  const world = r.rigid(r.f32);
  const [frameMs, residual, a, b, exposureMs] = [r.f32(), r.f32(), r.f32(), r.f32(), r.f32()];
  const points = r.u32();
  const state: Tracking = r.u8();
  const [isKeyframe, isLate, hasPose] = [r.u8() === 1, r.u8() === 1, r.u8() === 1];
  r.align(8);
  return {
    id, timestamp, keyframeId, relative, world: hasPose ? world : null, frameMs, residual, a, b, exposureMs, points,
    state, isKeyframe, isLate,
  };
}

function readFrames(r: Reader): FramesMessage {
  const count = r.u32();
  r.align(8);
  const frames = [];
  for (let i = 0; i < count; ++i) frames.push(readFrame(r));
  return { kind: 'frames', frames };
}

function readLoops(r: Reader): LoopsMessage {
  const count = r.u32();
  r.align(8);
  const loops = [];
  for (let i = 0; i < count; ++i) {
    loops.push({ keyframeId: r.i64(), candidateId: r.i64(), atFrame: r.i64(), inliers: r.i32(), score: r.f32() });
  }
  return { kind: 'loops', loops };
}

function readLog(r: Reader): LogMessage {
  const count = r.u32();
  const lines = [];
  for (let i = 0; i < count; ++i) {
    r.align(8);
    const atFrame = r.i64();
    const isWarning = r.u32() === 1;
    lines.push({ atFrame, isWarning, text: r.text(r.u32()) });
  }
  return { kind: 'log', lines };
}

function readTruth(r: Reader): TruthMessage {
  const count = r.u32();
  r.align(8);
  return { kind: 'truth', xyz: r.f64s(3 * count) };
}

function readWindow(r: Reader): WindowMessage {
  const frameId = r.i64();
  const correction = r.similarity();
  const pose = r.rigid(r.f64);
  const camera = r.u32() === 1 ? pose : null;
  const count = r.u32();
  const keyframes = [];
  for (let i = 0; i < count; ++i) {
    const id = r.i64();
    const keyframePose = r.rigid(r.f64);
    const points = r.u32();
    r.align(8);
    keyframes.push({ id, pose: keyframePose, points: r.points(points) });
  }
  return { kind: 'window', frameId, correction, camera, keyframes };
}

function readImage(r: Reader): ImageMessage {
  const frameId = r.i64();
  const [width, height, count, jpegBytes] = [r.u32(), r.u32(), r.u32(), r.u32()];
  const flags = r.peek(() => r.u32s(4 * count));
  const pixels = r.f32s(4 * count);
  return { kind: 'image', frameId, width, height, count, pixels, flags, jpeg: r.bytes(jpegBytes) };
}

function readMessage(type: number, r: Reader): Message | null {
  switch (type) {
    case 1:
      return readHello(r);
    case 2:
      return readKeyframe(r);
    case 3:
      return readPoses(r);
    case 4:
      return readFrames(r);
    case 5:
      return readLoops(r);
    case 6:
      return readLog(r);
    case 7:
      return readTruth(r);
    case 8:
      return { kind: 'alignment', worldFromTruth: r.similarity(), ateRmse: r.f64(), pairs: r.u32() };
    case 9:
      return {
        kind: 'status', state: r.u32(), done: r.u32(), count: r.u32(), viewers: r.u32(), loopCandidates: r.u32(),
        memoryMb: r.f32(), framesPerSecond: r.f32(), dropped: r.u32(),
      };
    case 10:
      return readWindow(r);
    case 11:
      return readImage(r);
    default:
      return null; // of a newer server
  }
}

/** All messages of a stream, or of a part of one that begins and ends with a message. */
export function decode(buffer: ArrayBuffer): Message[] {
  const messages: Message[] = [];
  const view = new DataView(buffer);
  for (let at = 0; at + HEADER_BYTES <= buffer.byteLength; ) {
    const size = view.getUint32(at, true);
    if (size < HEADER_BYTES || at + size > buffer.byteLength) throw new Error('a message is cut off');
    const message = readMessage(view.getUint16(at + 4, true), new Reader(buffer, at + HEADER_BYTES, at + size));
    if (message) messages.push(message);
    at += size;
  }
  return messages;
}
