// What is known of a run: keyframes, frames, loops, and where all of it lies by what is known now. Knows nothing of how
// it is shown; a recording that is fed to it in one go gives the same as a run that is watched.

import { apply, compose, IDENTITY } from './pose';
import type {
  AlignmentMessage, Frame, Hello, ImageMessage, LogLine, Loop, Message, PointArrays, Pose, PosesMessage, StatusMessage,
  WindowMessage,
} from './protocol';

export interface Keyframe {
  index: number; // in the order in which they left the window
  id: number;
  odometry: Pose;
  corrected: Pose | null; // as far as loop closing has told
  links: number[];
  pointCount: number;
}

/** What has changed since it was last asked for. */
export interface Changes {
  reset: boolean;
  keyframes: { keyframe: Keyframe; points: PointArrays }[]; // new ones
  poses: boolean;
  framesFrom: number; // first index of `frames` whose pose is to be computed again; Infinity if there is none
  loops: boolean;
  window: boolean;
  truth: boolean;
  log: boolean;
  status: boolean;
  image: ImageMessage | null;
}

function noChanges(): Changes {
  return {
    reset: false, keyframes: [], poses: false, framesFrom: Infinity, loops: false, window: false, truth: false,
    log: false, status: false, image: null,
  };
}

export class MapModel {
  hello: Hello | null = null;
  readonly keyframes: Keyframe[] = [];
  readonly frames: Frame[] = []; // in the order of their ids
  readonly loops: Loop[] = [];
  readonly log: LogLine[] = [];
  /** What loop closing said, one time after the other. */
  private readonly history: PosesMessage[] = [];
  private applied = 0; // so much of it is what the poses are
  private time = Infinity; // frame id, see setTime()
  truth: Float64Array | null = null;
  alignment: AlignmentMessage | null = null;
  status: StatusMessage | null = null;
  window: WindowMessage | null = null;
  correction: Pose = IDENTITY;
  pointCount = 0;

  private readonly keyframeById = new Map<number, Keyframe>();
  private readonly pendingPoses = new Map<number, Pose>(); // of keyframes that have not come yet
  private readonly firstFrameOf = new Map<number, number>(); // keyframe id to index in `frames`
  private changes = noChanges();

  takeChanges(): Changes {
    const changes = this.changes;
    this.changes = noChanges();
    return changes;
  }

  keyframe(id: number): Keyframe | undefined {
    return this.keyframeById.get(id);
  }

  apply(message: Message): void {
    switch (message.kind) {
      case 'hello':
        this.reset(message);
        break;
      case 'keyframe':
        this.addKeyframe(message.id, message.pose, message.links, message.points);
        break;
      case 'poses':
        this.history.push(message);
        if (this.setTime(this.time)) {
          for (const { id } of message.poses) this.recompute(id);
          this.changes.poses = true;
        }
        break;
      case 'frames':
        for (const frame of message.frames) this.addFrame(frame);
        break;
      case 'loops':
        this.loops.push(...message.loops);
        this.changes.loops = true;
        break;
      case 'log':
        this.log.push(...message.lines);
        this.changes.log = true;
        break;
      case 'truth':
        this.truth = message.xyz.slice();
        this.changes.truth = true;
        break;
      case 'alignment':
        this.alignment = message;
        this.changes.truth = true;
        break;
      case 'status':
        this.status = message;
        this.changes.status = true;
        break;
      case 'window':
        this.setWindow(message);
        break;
      case 'image':
        this.changes.image = message;
        break;
    }
  }

  /** Poses as loop closing had them at a frame; Infinity: as it has them now. Whether any of them is another one now. */
  setTime(frameId: number): boolean {
    this.time = frameId;
    let wanted = 0;
    while (wanted < this.history.length && this.history[wanted].atFrame <= frameId) ++wanted;
    if (wanted === this.applied) return false;
    if (wanted < this.applied) {
      for (const keyframe of this.keyframes) keyframe.corrected = null;
      this.pendingPoses.clear();
      this.correction = IDENTITY;
      this.applied = 0;
    }
    for (; this.applied < wanted; ++this.applied) {
      const step = this.history[this.applied];
      this.correction = step.correction;
      for (const { id, pose } of step.poses) this.setCorrected(id, pose);
    }
    return true;
  }

  /** A keyframe's pose with loops; without loop closing that of the odometry. */
  correctedPose(keyframe: Keyframe): Pose {
    return keyframe.corrected ?? compose(this.correction, keyframe.odometry);
  }

  /** Where a frame was: by the odometry, and with loops. Null if it has no pose. */
  framePoses(frame: Frame): { odometry: Pose; corrected: Pose } | null {
    const keyframe = this.keyframeById.get(frame.keyframeId);
    if (!frame.world) return null;
    if (keyframe) {
      return {
        odometry: compose(keyframe.odometry, frame.relative),
        corrected: compose(this.correctedPose(keyframe), frame.relative),
      };
    }
    const inWindow = this.window?.keyframes.find((k) => k.id === frame.keyframeId);
    const odometry = inWindow ? compose(inWindow.pose, frame.relative) : frame.world;
    return { odometry, corrected: compose(this.correction, odometry) };
  }

  /** Ground truth in the map's world; null as long as it is not known where it lies. */
  truthPosition(index: number): [number, number, number] | null {
    if (!this.truth || !this.alignment) return null;
    return apply(this.alignment.worldFromTruth, [
      this.truth[3 * index], this.truth[3 * index + 1], this.truth[3 * index + 2],
    ]);
  }

  /** Index of the last frame whose id is at most `id`; -1 if there is none. */
  frameIndexAt(id: number): number {
    let [low, high] = [0, this.frames.length];
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.frames[middle].id <= id) low = middle + 1;
      else high = middle;
    }
    return low - 1;
  }

  private reset(hello: Hello): void {
    this.hello = hello;
    this.keyframes.length = this.frames.length = this.loops.length = this.log.length = 0;
    this.truth = this.alignment = this.status = this.window = null;
    this.correction = IDENTITY;
    this.history.length = this.applied = 0;
    this.time = Infinity;
    this.pointCount = 0;
    this.keyframeById.clear();
    this.pendingPoses.clear();
    this.firstFrameOf.clear();
    this.changes = noChanges();
    this.changes.reset = this.changes.log = this.changes.status = this.changes.loops = true;
  }

  private addKeyframe(id: number, odometry: Pose, links: number[], points: PointArrays): void {
    if (this.keyframeById.has(id)) return;
    const keyframe: Keyframe = {
      index: this.keyframes.length, id, odometry, corrected: this.pendingPoses.get(id) ?? null, links,
      pointCount: points.count,
    };
    this.pendingPoses.delete(id);
    this.keyframes.push(keyframe);
    this.keyframeById.set(id, keyframe);
    this.pointCount += points.count;
    this.changes.keyframes.push({ keyframe, points });
    this.changes.poses = true;
    this.recompute(id);
  }

  private setCorrected(id: number, pose: Pose): void {
    const keyframe = this.keyframeById.get(id);
    if (keyframe) keyframe.corrected = pose;
    else this.pendingPoses.set(id, pose);
  }

  private addFrame(frame: Frame): void {
    const before = this.frameIndexAt(frame.id);
    let index = before + 1;
    if (before >= 0 && this.frames[before].id === frame.id) {
      index = before;
      const old = this.frames[before];
      if (frame.isLate) {
        // A late record knows the pose, the first one what it had cost.
        frame = { ...frame, frameMs: old.frameMs, exposureMs: old.exposureMs, points: old.points };
      }
      this.frames[before] = frame;
    } else if (index === this.frames.length) {
      this.frames.push(frame);
    } else {
      this.frames.splice(index, 0, frame);
      for (const [id, first] of this.firstFrameOf) if (first >= index) this.firstFrameOf.set(id, first + 1);
    }
    const first = this.firstFrameOf.get(frame.keyframeId);
    if (first === undefined || index < first) this.firstFrameOf.set(frame.keyframeId, index);
    this.changes.framesFrom = Math.min(this.changes.framesFrom, index);
  }

  private setWindow(window: WindowMessage): void {
    this.window = window;
    this.changes.window = true;
    for (const keyframe of window.keyframes) this.recompute(keyframe.id);
  }

  private recompute(keyframeId: number): void {
    const first = this.firstFrameOf.get(keyframeId);
    if (first !== undefined) this.changes.framesFrom = Math.min(this.changes.framesFrom, first);
  }
}
