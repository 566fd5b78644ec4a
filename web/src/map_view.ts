// The map in 3D, as a component: give it a canvas and a MapModel, call sync() after the model has changed. It renders
// only when there is something new to see. The page of the live viewer and any other page can use it.

import * as THREE from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';

import { FatLines } from './fat_lines';
import { inlierBox, median } from './inliers';
import type { Changes, Keyframe, MapModel } from './map_model';
import { LAYERS, PointCloud, deviationOnScale } from './point_cloud';
import { apply } from './pose';
import type { PointArrays, Pose, Vec3 } from './protocol';

export type Follow = 'free' | 'follow' | 'camera';

export interface MapViewSettings {
  corrected: boolean; // points and frustums with loops; otherwise of the odometry
  points: boolean;
  odometry: boolean;
  trajectory: boolean;
  frustums: boolean; // of the window
  keyframes: boolean; // all frustums
  loops: boolean;
  covisibility: boolean;
  truth: boolean;
  grid: boolean;
  pointSize: number;
  mostDeviation: number; // points with a larger relative deviation of the inverse depth are hidden
  colorMode: number;
  follow: Follow;
}

/** What can be shown or hidden. */
export type Switch = { [K in keyof MapViewSettings]: MapViewSettings[K] extends boolean ? K : never }[keyof MapViewSettings];

export const DEFAULT_SETTINGS: MapViewSettings = {
  corrected: true, points: true, odometry: true, trajectory: true, frustums: true, keyframes: false, loops: true,
  covisibility: false, truth: true, grid: true, pointSize: 2, mostDeviation: 0.5, colorMode: 0, follow: 'free',
};

const COLORS = {
  background: 0x0b0e14, odometry: 0xff4d4f, trajectory: 0xffd23f, truth: 0x58d68d, loops: 0x33d6ff,
  covisibility: 0x7d8fd0, window: 0x4f9dff, keyframes: 0x6c7686, camera: 0xffffff, grid: 0x1d2430,
};
/** The window's keyframes are no part of the numbering of those that have left it. */
const MOST_WINDOW = 64;
const SLOW_MS = 55;
const FAST_MS = 22;
const REST_MS = 250;
const LONGEST_REST_MS = 700;
/** So many can always be drawn. */
const FEW_POINTS = 60000;

/** Of a keyframe's points every so many'th is looked at for the size of the map, if it is as certain as this. */
const SAMPLED = 20;
const CERTAIN = 0.1;

const FRUSTUM_EDGES: [number, number][] = [[0, 1], [0, 2], [0, 3], [0, 4], [1, 2], [2, 3], [3, 4], [4, 1]];

/** Whether a processor draws the pictures instead of a graphics card. */
function isSoftwareRenderer(): boolean {
  const gl = document.createElement('canvas').getContext('webgl2');
  const info = gl?.getExtension('WEBGL_debug_renderer_info');
  const name = info ? String(gl!.getParameter(info.UNMASKED_RENDERER_WEBGL)) : '';
  gl?.getExtension('WEBGL_lose_context')?.loseContext();
  return /swiftshader|llvmpipe|software/i.test(name);
}

export class MapView {
  readonly settings: MapViewSettings = { ...DEFAULT_SETTINGS };
  /** Figures for those that watch the watching. */
  readonly stats = { renders: 0, layers: LAYERS, renderMs: 0, segments: { odometry: 0, trajectory: 0, truth: 0 } };
  private readonly renderer: THREE.WebGLRenderer;
  private readonly scene = new THREE.Scene();
  private readonly world = new THREE.Group(); // camera axes (y down) turned upright
  private readonly camera = new THREE.PerspectiveCamera(55, 1, 0.01, 1e4);
  private readonly controls: OrbitControls;
  private readonly viewport = new THREE.Vector2(1, 1);
  private readonly cloud = new PointCloud();
  private readonly windowCloud = new PointCloud();
  private readonly odometry = new FatLines(COLORS.odometry, 2.2, this.viewport);
  private readonly trajectory = new FatLines(COLORS.trajectory, 2.8, this.viewport);
  private readonly truth = new FatLines(COLORS.truth, 2, this.viewport, 0.8);
  private readonly loopEdges = new FatLines(COLORS.loops, 2.2, this.viewport, 0.85);
  private readonly links = new FatLines(COLORS.covisibility, 1.2, this.viewport, 0.3);
  private readonly windowFrustums = new FatLines(COLORS.window, 1.6, this.viewport);
  private readonly keyframeFrustums = new FatLines(COLORS.keyframes, 1.2, this.viewport, 0.55);
  private readonly cameraFrustum = new FatLines(COLORS.camera, 2.6, this.viewport);
  private readonly grid = new THREE.GridHelper(1, 20, COLORS.grid, COLORS.grid);
  private cutoff = Infinity; // frame id up to which things are shown
  private lastPosition: THREE.Vector3 | null = null; // of the camera that is followed
  private fittedSize = 0;
  private box: THREE.Box3 | null = null; // see bounds(); null if it has to be computed again
  private touched = false; // the user has moved the view
  private dirty = true;
  private hasRendered = false; // when the last picture was asked for
  private lastFrame = 0;
  private lastChange = 0;
  private drawnLayers = LAYERS;
  private msPerLayer = 0;
  private readonly samples: { keyframe: Keyframe; xyz: Vec3 }[] = []; // of the more certain points
  private depth = 1; // see unit()
  private depthOf = 0; // samples that it is the median of
  private heightRange = new THREE.Vector2(-1, 1);

  constructor(
    canvas: HTMLCanvasElement,
    private readonly model: MapModel,
    private readonly onRender: () => void = () => {},
  ) {
    const isSlow = isSoftwareRenderer();
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: !isSlow, powerPreference: 'high-performance' });
    this.renderer.setPixelRatio(isSlow ? 1 : Math.min(window.devicePixelRatio, 2));
    if (isSlow) this.stats.layers = LAYERS / 4;
    this.scene.background = new THREE.Color(COLORS.background);
    this.world.rotation.x = Math.PI;
    this.scene.add(this.world, this.grid);
    this.world.add(this.cloud.object, this.windowCloud.object);
    const lines = [
      this.links, this.keyframeFrustums, this.truth, this.odometry, this.trajectory, this.loopEdges,
      this.windowFrustums, this.cameraFrustum,
    ];
    lines.forEach((line, i) => {
      line.object.renderOrder = 1 + i;
      this.world.add(line.object);
    });
    this.camera.position.set(-4, 4, 6);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableDamping = true;
    this.controls.dampingFactor = 0.12;
    this.controls.zoomToCursor = true;
    this.controls.addEventListener('change', () => this.invalidate());
    this.controls.addEventListener('start', () => (this.touched = true));
    new ResizeObserver(() => this.resize()).observe(canvas);
    this.resize();
    requestAnimationFrame(this.loop);
  }

  set(settings: Partial<MapViewSettings>): void {
    const before = { ...this.settings };
    Object.assign(this.settings, settings);
    if (before.corrected !== this.settings.corrected) {
      this.box = null;
      this.rebuildEdges();
      this.updateWindow();
      this.updateCamera();
    }
    if (before.follow !== this.settings.follow) this.lastPosition = null;
    if (before.keyframes !== this.settings.keyframes || before.covisibility !== this.settings.covisibility) {
      this.rebuildEdges();
    }
    this.invalidate();
  }

  /** Shows the run as it was at a frame; Infinity: as it is. */
  setCutoff(frameId: number): void {
    this.cutoff = frameId;
    if (this.model.setTime(frameId)) {
      this.updatePoses();
      this.updateTrajectories(0);
    }
    this.showUpToCutoff();
    this.rebuildEdges();
  }

  /** Brings in what the model says has changed. */
  sync(changes: Changes): void {
    if (changes.reset) this.clear();
    if (changes.reset || changes.poses || changes.framesFrom < Infinity) this.box = null;
    for (const { keyframe, points } of changes.keyframes) {
      this.cloud.add(keyframe.index, points);
      this.sample(keyframe, points);
    }
    if (changes.poses) this.updatePoses();
    if (changes.framesFrom < Infinity) this.updateTrajectories(changes.framesFrom);
    if (changes.window) this.updateWindow();
    if (changes.truth) this.updateTruth();
    if (changes.poses || changes.loops) this.rebuildEdges();
    if (changes.keyframes.length > 0 || changes.framesFrom < Infinity) this.showUpToCutoff();
    if (changes.framesFrom < Infinity || changes.window || changes.poses) this.updateCamera();
    if (changes.framesFrom < Infinity) this.keepInView();
    this.invalidate();
  }

  /** Everything into view, from behind and above. */
  fit(): void {
    const box = this.bounds();
    if (box.isEmpty()) return;
    const center = box.getCenter(new THREE.Vector3());
    const radius = Math.max(0.5 * box.getSize(new THREE.Vector3()).length(), 1.4 * this.unit());
    const distance = radius / Math.sin((0.5 * this.camera.fov * Math.PI) / 180);
    this.look(center, center.clone().add(new THREE.Vector3(-0.45, 0.62, 0.75).normalize().multiplyScalar(distance)));
    this.fittedSize = 2 * radius;
    this.touched = false;
  }

  /** From straight above. */
  top(): void {
    const box = this.bounds();
    if (box.isEmpty()) return;
    const center = box.getCenter(new THREE.Vector3());
    const size = box.getSize(new THREE.Vector3());
    const half = Math.tan((0.5 * this.camera.fov * Math.PI) / 180);
    const height = 0.58 * Math.max(size.z / half, size.x / (half * this.camera.aspect), 4 * this.unit());
    this.set({ follow: 'free' });
    this.look(center, center.clone().add(new THREE.Vector3(0, Math.max(height, size.y), 1e-3 * height)));
    this.touched = true;
  }

  screenshot(): Promise<Blob | null> {
    this.render(LAYERS);
    return new Promise((done) => this.renderer.domElement.toBlob(done, 'image/png'));
  }

  invalidate(): void {
    this.dirty = true;
  }

  /** Points drawn if all layers are. */
  get pointCount(): number {
    return this.cloud.count + this.windowCloud.count;
  }
  get edgeCounts(): { loops: number; links: number; window: number; keyframes: number } {
    return {
      loops: this.loopEdges.count / 2, links: this.links.count / 2,
      window: this.windowFrustums.count / (2 * FRUSTUM_EDGES.length),
      keyframes: this.keyframeFrustums.count / (2 * FRUSTUM_EDGES.length),
    };
  }

  /** As the map grows, as long as the user has not taken the view. */
  private keepInView(): void {
    if (this.touched || this.settings.follow !== 'free' || this.model.frames.length < 8) return;
    const box = this.bounds();
    if (!box.isEmpty() && box.getSize(new THREE.Vector3()).length() > 1.2 * this.fittedSize) this.fit();
  }

  private look(target: THREE.Vector3, from: THREE.Vector3): void {
    this.controls.target.copy(target);
    this.camera.position.copy(from);
    this.controls.update();
    this.invalidate();
  }

  private clear(): void {
    this.cloud.clear();
    this.windowCloud.clear();
    for (const line of [this.odometry, this.trajectory, this.truth, this.loopEdges, this.links, this.windowFrustums,
      this.keyframeFrustums, this.cameraFrustum]) {
      line.clear();
    }
    this.lastPosition = null;
    this.fittedSize = 0;
    this.samples.length = 0;
    this.depth = 1;
    this.depthOf = 0;
  }

  /** Median distance of the points from their cameras: what "near" means in this map, however far some seem to be. */
  unit(): number {
    if (this.samples.length > 1.1 * this.depthOf) {
      this.depth = median(this.samples.map(({ xyz }) => xyz[2]));
      this.depthOf = this.samples.length;
    }
    return this.depth;
  }

  private sample(keyframe: Keyframe, points: PointArrays): void {
    for (let i = 0; i < points.count; i += SAMPLED) {
      if (points.depthStddev[i] > CERTAIN) continue;
      this.samples.push({ keyframe, xyz: [points.xyz[3 * i], points.xyz[3 * i + 1], points.xyz[3 * i + 2]] });
    }
  }

  private updatePoses(): void {
    for (const keyframe of this.model.keyframes) {
      this.cloud.setPoses(keyframe.index, this.model.odometryPose(keyframe), this.model.correctedPose(keyframe));
    }
    this.updateWindow();
  }

  private updateTrajectories(from: number): void {
    const frames = this.model.frames;
    // A vertex a frame; one without a pose lies where the last one with a pose was and joins nothing.
    let joined = from > 0 && this.model.framePoses(frames[from - 1]) !== null;
    for (let i = from; i < frames.length; ++i) {
      const poses = this.model.framePoses(frames[i]);
      this.odometry.set(i, poses?.odometry.t ?? [0, 0, 0], joined && poses !== null);
      this.trajectory.set(i, poses?.corrected.t ?? [0, 0, 0], joined && poses !== null);
      joined = poses !== null;
    }
    this.odometry.update(frames.length);
    this.trajectory.update(frames.length);
  }

  private updateWindow(): void {
    const window = this.model.window;
    this.windowFrustums.clear();
    if (!window || this.cutoff < Infinity) {
      this.windowCloud.replace([]);
      this.windowFrustums.update(0);
      return;
    }
    // Those that have left the window are in the large cloud already.
    const keyframes = window.keyframes.filter((k) => !this.model.keyframe(k.id)).slice(0, MOST_WINDOW);
    keyframes.forEach((k, i) => {
      const { odometry, corrected } = this.model.inWindow(k.pose);
      this.windowCloud.setPoses(i, odometry, corrected);
    });
    this.windowCloud.replace(keyframes.map((k, i) => ({ host: i, points: k.points })));
    for (const k of keyframes) this.addFrustum(this.windowFrustums, this.shownPose(k.pose), 0.11);
    this.windowFrustums.update(this.windowFrustums.count);
  }

  private shownPose(pose: Pose): Pose {
    const { odometry, corrected } = this.model.inWindow(pose);
    return this.settings.corrected ? corrected : odometry;
  }

  private updateTruth(): void {
    const count = this.model.truth ? this.model.truth.length / 3 : 0;
    for (let i = 0; i < count; ++i) {
      const position = this.model.truthPosition(i);
      if (!position) {
        this.truth.update(0);
        return;
      }
      this.truth.set(i, position, i > 0);
    }
    this.truth.update(count);
  }

  private rebuildEdges(): void {
    const shown = (id: number) => id <= this.cutoff;
    const model = this.model;
    const poseOf = (id: number): Pose | null => {
      const keyframe = model.keyframe(id);
      if (keyframe) return this.settings.corrected ? model.correctedPose(keyframe) : model.odometryPose(keyframe);
      const inWindow = model.window?.keyframes.find((k) => k.id === id);
      return inWindow ? this.shownPose(inWindow.pose) : null;
    };
    const join = (lines: FatLines, a: number, b: number): void => {
      const [p, q] = [poseOf(a), poseOf(b)];
      if (p && q) lines.addEdge(p.t, q.t);
    };
    this.loopEdges.clear();
    for (const loop of model.loops) if (shown(loop.atFrame)) join(this.loopEdges, loop.keyframeId, loop.candidateId);
    this.loopEdges.update(this.loopEdges.count);
    this.links.clear();
    this.keyframeFrustums.clear();
    for (const keyframe of model.keyframes) {
      if (!shown(keyframe.id)) continue;
      if (this.settings.covisibility) {
        for (const other of keyframe.links) if (shown(other)) join(this.links, keyframe.id, other);
      }
      if (this.settings.keyframes) this.addFrustum(this.keyframeFrustums, poseOf(keyframe.id)!, 0.07);
    }
    this.links.update(this.links.count);
    this.keyframeFrustums.update(this.keyframeFrustums.count);
    this.invalidate();
  }

  private addFrustum(lines: FatLines, pose: Pose, size: number): void {
    const hello = this.model.hello;
    if (!hello) return;
    const depth = size * this.unit();
    const corner = (u: number, v: number): Vec3 => [
      (depth * (u - hello.cx)) / hello.fx, (depth * (v - hello.cy)) / hello.fy, depth,
    ];
    const [w, h] = [hello.width - 1, hello.height - 1];
    const s = 1 / pose.s; // A camera does not grow with the unit of its map.
    const corners = ([[0, 0, 0], corner(0, 0), corner(w, 0), corner(w, h), corner(0, h)] as Vec3[]).map((p) =>
      apply(pose, [s * p[0], s * p[1], s * p[2]]),
    );
    for (const [a, b] of FRUSTUM_EDGES) lines.addEdge(corners[a], corners[b]);
  }

  private showUpToCutoff(): void {
    const frames = this.model.frames;
    const vertices = this.cutoff === Infinity ? Infinity : this.model.frameIndexAt(this.cutoff) + 1;
    this.odometry.show(vertices);
    this.trajectory.show(vertices);
    let last = this.model.keyframes.length - 1;
    while (last >= 0 && this.model.keyframes[last].id > this.cutoff) --last;
    this.cloud.uniforms.lastHost.value = last;
    this.stats.segments.odometry = this.odometry.segments;
    this.stats.segments.trajectory = this.trajectory.segments;
    this.stats.segments.truth = this.truth.segments;
    if (frames.length > 0) this.updateCamera();
    this.updateWindow();
    this.invalidate();
  }

  /** The camera of the newest frame that is shown, and the view that goes with it. */
  private updateCamera(): void {
    const frames = this.model.frames;
    let index = this.cutoff === Infinity ? frames.length - 1 : this.model.frameIndexAt(this.cutoff);
    let poses = null;
    for (let tries = 0; index >= 0 && tries < 100 && !poses; --index, ++tries) {
      poses = this.model.framePoses(frames[index]);
    }
    this.cameraFrustum.clear();
    if (!poses) {
      this.cameraFrustum.update(0);
      return;
    }
    const pose = this.settings.corrected ? poses.corrected : poses.odometry;
    this.addFrustum(this.cameraFrustum, pose, 0.16);
    this.cameraFrustum.update(this.cameraFrustum.count);
    this.followPose(pose);
  }

  private followPose(pose: Pose): void {
    const position = this.toScene(pose.t);
    if (this.settings.follow === 'follow') {
      if (this.lastPosition) {
        const step = position.clone().sub(this.lastPosition);
        this.controls.target.add(step);
        this.camera.position.add(step);
      } else {
        const offset = this.camera.position.clone().sub(this.controls.target).setLength(5 * this.unit());
        this.controls.target.copy(position);
        this.camera.position.copy(position).add(offset);
      }
      this.lastPosition = position;
    } else if (this.settings.follow === 'camera') {
      const at = (p: Vec3) => this.toScene(apply({ ...pose, s: 1 }, p));
      const u = this.unit();
      this.camera.position.copy(at([0, -0.15 * u, -0.5 * u]));
      this.controls.target.copy(at([0, 0, u]));
    }
  }

  private toScene(p: Vec3): THREE.Vector3 {
    return new THREE.Vector3(p[0], -p[1], -p[2]);
  }

  /** Of the trajectory and of the points, but for stray ones, in the scene. */
  private bounds(): THREE.Box3 {
    if (this.box) return this.box;
    const { model, settings } = this;
    const way: Vec3[] = [];
    const step = Math.max(1, Math.floor(model.frames.length / 2000));
    for (let i = 0; i < model.frames.length; i += step) {
      const poses = model.framePoses(model.frames[i]);
      if (poses) way.push(settings.corrected ? poses.corrected.t : poses.odometry.t);
    }
    const points: Vec3[] = [];
    const stride = Math.max(1, Math.floor(this.samples.length / 4000));
    for (let i = 0; i < this.samples.length; i += stride) {
      const { keyframe, xyz } = this.samples[i];
      points.push(apply(settings.corrected ? model.correctedPose(keyframe) : model.odometryPose(keyframe), xyz));
    }
    this.box = new THREE.Box3();
    const inliers = inlierBox(way, points);
    if (inliers) {
      this.box.expandByPoint(this.toScene(inliers.low)).expandByPoint(this.toScene(inliers.high));
      this.box.expandByScalar(0.1 * this.unit());
    }
    return this.box;
  }

  /** Length in the map, in its own unit, of a pixel in the middle of the picture, where it is looked at. */
  get unitsPerPixel(): number {
    const distance = this.camera.position.distanceTo(this.controls.target);
    return (2 * distance * Math.tan((0.5 * this.camera.fov * Math.PI) / 180)) / this.viewport.y;
  }

  private updateLook(): void {
    const s = this.settings;
    for (const cloud of [this.cloud, this.windowCloud]) {
      cloud.object.visible = s.points;
      cloud.uniforms.which.value = s.corrected ? 1 : 0;
      cloud.uniforms.size.value = s.pointSize * this.renderer.getPixelRatio();
      cloud.uniforms.mode.value = s.colorMode;
      cloud.uniforms.heights.value = this.heightRange;
      cloud.uniforms.mostDeviation.value = s.mostDeviation >= 0.5 ? 2 : deviationOnScale(s.mostDeviation);
    }
    this.windowCloud.uniforms.firstHost.value = -this.cloud.uniforms.lastHost.value;
    this.windowCloud.uniforms.lastHost.value = MOST_WINDOW;
    this.odometry.object.visible = s.odometry;
    // Without a closed loop it is the odometry's, and would only hide that.
    this.trajectory.object.visible = s.trajectory && this.model.hasLoops;
    this.truth.object.visible = s.truth;
    this.loopEdges.object.visible = s.loops;
    this.links.object.visible = s.covisibility;
    this.windowFrustums.object.visible = s.frustums;
    this.cameraFrustum.object.visible = s.frustums && s.follow !== 'camera';
    this.keyframeFrustums.object.visible = s.keyframes;
    this.grid.visible = s.grid;
    const box = this.bounds();
    if (box.isEmpty()) return;
    this.heightRange.set(box.min.y - 0.5 * this.unit(), box.max.y + 0.5 * this.unit());
    const cell = 10 ** Math.round(Math.log10(this.unit()));
    this.grid.scale.setScalar(20 * cell * Math.max(1, Math.ceil(box.getSize(new THREE.Vector3()).length() / (10 * cell))));
    this.grid.position.set(0, box.min.y - 0.2 * this.unit(), 0);
  }

  private resize(): void {
    const canvas = this.renderer.domElement;
    const [width, height] = [Math.max(1, canvas.clientWidth), Math.max(1, canvas.clientHeight)];
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.viewport.set(width, height);
    this.invalidate();
  }

  /** Clip planes around what is looked at, so that neither a street nor a desk flickers. */
  private updateClipping(): void {
    const distance = this.camera.position.distanceTo(this.controls.target);
    this.camera.near = Math.max(1e-4, Math.min(0.05 * distance, 0.1 * this.unit()));
    this.camera.far = 1e4 * Math.max(distance, this.unit());
    this.camera.updateProjectionMatrix();
  }

  private readonly loop = (now: number): void => {
    requestAnimationFrame(this.loop);
    this.controls.update();
    if (this.hasRendered) this.adapt(now - this.lastFrame);
    this.lastFrame = now;
    this.hasRendered = true;
    if (this.dirty) {
      this.dirty = false;
      this.lastChange = now;
      this.stats.layers = Math.max(this.stats.layers, this.leastLayers());
      this.render(this.stats.layers);
    } else if (this.drawnLayers < this.layersAtRest() && now - this.lastChange > REST_MS) {
      this.render(this.layersAtRest());
    } else {
      this.hasRendered = false;
    }
  };

  /** To the time until the browser asks for the next picture: it says how long one takes, wherever it is drawn. */
  private adapt(elapsed: number): void {
    if (document.hidden) return;
    const perLayer = elapsed / this.drawnLayers;
    this.stats.renderMs += 0.3 * (Math.min(elapsed, 5000) - this.stats.renderMs);
    this.msPerLayer += 0.3 * (perLayer - this.msPerLayer);
    if (this.drawnLayers !== this.stats.layers) return; // That was one at rest.
    const step = 1 + (this.stats.layers >> 3);
    if (elapsed > 4 * SLOW_MS) this.stats.layers >>= 1;
    else if (this.stats.renderMs > SLOW_MS) this.stats.layers -= step;
    else if (this.stats.renderMs < FAST_MS) this.stats.layers += step;
    this.stats.layers = Math.min(LAYERS, Math.max(1, this.stats.layers));
  }

  private leastLayers(): number {
    return Math.min(LAYERS, Math.floor((LAYERS * FEW_POINTS) / Math.max(this.pointCount, 1)));
  }

  /** As many as can be drawn without keeping the user waiting for the next movement. */
  private layersAtRest(): number {
    const affordable = Math.floor(LONGEST_REST_MS / Math.max(this.msPerLayer, 1e-3));
    return Math.min(LAYERS, Math.max(this.stats.layers, affordable));
  }

  private render(layers: number): void {
    this.updateLook();
    this.updateClipping();
    this.cloud.showLayers(layers);
    this.drawnLayers = layers;
    this.renderer.render(this.scene, this.camera);
    ++this.stats.renders;
    this.onRender();
  }
}
