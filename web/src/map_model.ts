// What is known of a run: keyframes, frames, loops, and where all of it lies by what is known now. Knows nothing of how
// it is shown; a recording that is fed to it in one go gives the same as a run that is watched.

import { layOut, NO_PLACES, type Places } from './map_parts';
import { apply, compose, IDENTITY } from './pose';
import type {
  AlignmentMessage, Frame, Hello, ImageMessage, KeyframeMessage, LogLine, Loop, Message, PointArrays, Pose, PosesMessage, StatusMessage,
  Vec3, WindowMessage,
} from './protocol';

export interface Keyframe {
  index: number; // in the order in which they left the window
  id: number;
  odometry: Pose;
  corrected: Pose | null; // as far as loop closing has told
  links: number[];
  pointCount: number;
  segment: number; // counted as they come
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

/** The pose beside where it is. */
function moved(pose: Pose, by: Vec3 | undefined): Pose {
  return by ? { ...pose, t: [pose.t[0] + by[0], pose.t[1] + by[1], pose.t[2] + by[2]] } : pose;
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
  hasColors = false;
  /** Where the parts of the run are drawn that have nothing to do with each other. */
  places: Places = NO_PLACES;

  private readonly keyframeById = new Map<number, Keyframe>();
  private readonly pendingPoses = new Map<number, Pose>(); // of keyframes that have not come yet
  private readonly segments = new Map<number, number>();
  private readonly firstFrameOf = new Map<number, number>(); // keyframe id to index in `frames`
  private changes = noChanges();

  takeChanges(): Changes {
    const changes = this.changes;
    if (changes.poses && this.newestSegment > 0) {
      this.placeParts();
      changes.framesFrom = 0;
    }
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
        this.addKeyframe(message);
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
        if (this.newestSegment > 0) this.changes.poses = true; // It may have joined two parts.
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
    if (this.newestSegment > 0) this.placeParts();
    return true;
  }

  /** A keyframe's pose with loops, where its part is drawn; without loop closing that of the odometry. */
  correctedPose(keyframe: Keyframe): Pose {
    return moved(this.ownPose(keyframe), this.places.corrected[keyframe.segment]);
  }

  /** The same before loop closing: then no two segments have anything to do with each other. */
  odometryPose(keyframe: Keyframe): Pose {
    return moved(keyframe.odometry, this.places.odometry[keyframe.segment]);
  }

  /** Whether a loop was closed by the time that is shown. */
  get hasLoops(): boolean {
    return this.loops.some((loop) => loop.atFrame <= this.time);
  }

  private ownPose(keyframe: Keyframe): Pose {
    return keyframe.corrected ?? compose(this.correction, keyframe.odometry);
  }

  private placeParts(): void {
    const loops = this.loops.filter((loop) => loop.atFrame <= this.time);
    const joined = loops.map((loop) => [loop.keyframeId, loop.candidateId].map((id) => this.keyframe(id)?.segment ?? 0));
    const keyframes = this.keyframes.map((k) => ({ segment: k.segment, odometry: k.odometry.t, corrected: this.ownPose(k).t }));
    this.places = layOut(keyframes, joined as [number, number][]);
  }

  /** Where a frame was: by the odometry, and with loops. Null if it has no pose. */
  framePoses(frame: Frame): { odometry: Pose; corrected: Pose } | null {
    const keyframe = this.keyframeById.get(frame.keyframeId);
    if (!frame.world) return null;
    if (keyframe) {
      return {
        odometry: compose(this.odometryPose(keyframe), frame.relative),
        corrected: compose(this.correctedPose(keyframe), frame.relative),
      };
    }
    const inWindow = this.window?.keyframes.find((k) => k.id === frame.keyframeId);
    const odometry = inWindow ? compose(inWindow.pose, frame.relative) : frame.world;
    return this.inWindow(odometry);
  }

  /** A pose of the odometry that no keyframe of the map holds yet: of the newest segment. */
  inWindow(odometry: Pose): { odometry: Pose; corrected: Pose } {
    const segment = this.newestSegment;
    return {
      odometry: moved(odometry, this.places.odometry[segment]),
      corrected: moved(compose(this.correction, odometry), this.places.corrected[segment]),
    };
  }

  private segmentIndex(segment: number): number {
    if (!this.segments.has(segment)) this.segments.set(segment, this.segments.size);
    return this.segments.get(segment)!;
  }

  private get newestSegment(): number {
    return this.keyframes.at(-1)?.segment ?? 0;
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
    this.hasColors = false;
    this.places = NO_PLACES;
    this.keyframeById.clear();
    this.pendingPoses.clear();
    this.firstFrameOf.clear();
    this.segments.clear();
    this.changes = noChanges();
    this.changes.reset = this.changes.log = this.changes.status = this.changes.loops = true;
  }

  private addKeyframe({ id, pose, links, points, segment }: KeyframeMessage): void {
    if (this.keyframeById.has(id)) return;
    const keyframe: Keyframe = {
      index: this.keyframes.length, id, odometry: pose, corrected: this.pendingPoses.get(id) ?? null, links,
      pointCount: points.count, segment: this.segmentIndex(segment),
    };
    this.pendingPoses.delete(id);
    this.keyframes.push(keyframe);
    this.keyframeById.set(id, keyframe);
    this.pointCount += points.count;
    this.hasColors ||= points.colors !== null;
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
