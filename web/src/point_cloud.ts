// Points of many keyframes, kept where their keyframe saw them: the poses of all keyframes are a texture, so that a
// closed loop moves millions of points by rewriting some kilobytes. They lie in layers, each with an even share of every
// keyframe's points: a slow machine draws fewer layers while the view moves.

import * as THREE from 'three';

import { FloatTexture, TEXEL_FUNCTION } from './float_texture';
import type { PointArrays, Pose } from './protocol';

export const LAYERS = 32;
const CHUNK = 1 << 13; // points
/** Of a keyframe's poses: translation and scale, rotation; of the odometry, then corrected. */
const TEXELS = 4;

export const COLOR_MODES = ['intensity', 'height', 'depth variance', 'keyframe age', 'image color'] as const;
export const IMAGE_COLOR = COLOR_MODES.indexOf('image color');

const VERTEX = /* glsl */ `
  ${TEXEL_FUNCTION}
  attribute float host;
  attribute vec3 rgb;
  attribute vec4 look; // intensity, relative deviation of the inverse depth (log scale), corner
  uniform sampler2D poses;
  uniform float which; // 0: odometry, 1: corrected
  uniform float lastHost;
  uniform float firstHost;
  uniform float size;
  uniform int mode;
  uniform vec2 heights;
  uniform float mostDeviation;
  varying vec3 tint;

  vec3 ramp(float x) {
    x = clamp(x, 0.0, 1.0) * 5.0;
    vec3 c0 = vec3(0.19, 0.16, 0.55), c1 = vec3(0.13, 0.46, 0.90), c2 = vec3(0.11, 0.77, 0.72);
    vec3 c3 = vec3(0.58, 0.88, 0.32), c4 = vec3(0.98, 0.76, 0.20), c5 = vec3(0.90, 0.25, 0.18);
    if (x < 1.0) return mix(c0, c1, x);
    if (x < 2.0) return mix(c1, c2, x - 1.0);
    if (x < 3.0) return mix(c2, c3, x - 2.0);
    if (x < 4.0) return mix(c3, c4, x - 3.0);
    return mix(c4, c5, x - 4.0);
  }

  void main() {
    int first = int(host) * ${TEXELS} + 2 * int(which);
    vec4 t = texel(poses, first), q = texel(poses, first + 1);
    vec3 turned = position + 2.0 * cross(q.xyz, cross(q.xyz, position) + q.w * position);
    vec3 world = t.w * turned + t.xyz;
    if (host > lastHost || look.y > mostDeviation) {
      gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
      gl_PointSize = 0.0;
      return;
    }
    if (mode == 0) tint = vec3(pow(look.x, 0.6) * 0.85 + 0.15);
    else if (mode == 1) tint = ramp((-world.y - heights.x) / max(heights.y - heights.x, 1e-6));
    else if (mode == 2) tint = ramp(look.y);
    else if (mode == 4) tint = rgb;
    else tint = ramp((host - firstHost) / max(lastHost - firstHost, 1.0));
    vec4 p = modelViewMatrix * vec4(world, 1.0);
    gl_Position = projectionMatrix * p;
    gl_PointSize = size;
  }
`;
const FRAGMENT = /* glsl */ `
  varying vec3 tint;
  void main() {
    gl_FragColor = vec4(tint, 1.0);
  }
`;

/** 0..1 for 0.05 % .. 50 %. */
export function deviationOnScale(relative: number): number {
  return Math.min(1, Math.max(0, Math.log(Math.max(relative, 1e-9) / 5e-4) / Math.log(1000)));
}

const ATTRIBUTES = ['position', 'host', 'look', 'rgb'];

interface Chunk {
  points: THREE.Points;
  used: number;
}

export class PointCloud {
  readonly object = new THREE.Group();
  private readonly poses = new FloatTexture(16);
  readonly uniforms = {
    poses: this.poses.uniform,
    which: { value: 1 },
    firstHost: { value: 0 },
    lastHost: { value: 1e9 },
    size: { value: 2 },
    mode: { value: 0 },
    heights: { value: new THREE.Vector2(-1, 1) },
    mostDeviation: { value: 1 },
  };
  count = 0;
  private readonly layers: Chunk[][] = Array.from({ length: LAYERS }, () => []);
  private readonly material = new THREE.ShaderMaterial({
    vertexShader: VERTEX,
    fragmentShader: FRAGMENT,
    uniforms: this.uniforms,
  });

  clear(): void {
    for (const layer of this.layers) {
      for (const chunk of layer) {
        this.object.remove(chunk.points);
        chunk.points.geometry.dispose();
      }
      layer.length = 0;
    }
    this.count = 0;
  }

  /** Points of keyframe number `host`. */
  add(host: number, arrays: PointArrays): void {
    for (let layer = 0; layer < LAYERS; ++layer) {
      for (let i = layer; i < arrays.count; ) i = this.fill(layer, i, host, arrays);
    }
    this.count += arrays.count;
  }

  /** Overwrites everything with the points of a few keyframes: for those that still change. */
  replace(parts: { host: number; points: PointArrays }[]): void {
    for (const layer of this.layers) {
      for (const chunk of layer) this.setUsed(chunk, 0, 0);
    }
    this.count = 0;
    for (const { host, points } of parts) this.add(host, points);
  }

  showLayers(count: number): void {
    this.layers.forEach((chunks, layer) => {
      for (const chunk of chunks) chunk.points.visible = layer < count;
    });
  }

  setPoses(host: number, odometry: Pose, corrected: Pose): void {
    const numbers = [odometry, corrected].flatMap((pose) => [...pose.t, pose.s, ...pose.q]);
    this.poses.set(TEXELS * host, numbers);
  }

  /** Puts points i, i + LAYERS, ... into the layer's last chunk while there is room; returns where it stopped. */
  private fill(layer: number, i: number, host: number, arrays: PointArrays): number {
    const chunk = this.openChunk(layer);
    const geometry = chunk.points.geometry;
    const [position, hosts, looks, colors] = ATTRIBUTES.map(
      (name) => (geometry.getAttribute(name) as THREE.BufferAttribute).array);
    const first = chunk.used;
    let at = first;
    for (; i < arrays.count && at < CHUNK; i += LAYERS, ++at) {
      position[3 * at] = arrays.xyz[3 * i];
      position[3 * at + 1] = arrays.xyz[3 * i + 1];
      position[3 * at + 2] = arrays.xyz[3 * i + 2];
      hosts[at] = host;
      looks[4 * at] = arrays.intensity[i];
      looks[4 * at + 1] = Math.round(255 * deviationOnScale(arrays.depthStddev[i]));
      looks[4 * at + 2] = 255 * arrays.isCorner[i];
      for (let k = 0; k < 3; ++k) colors[3 * at + k] = arrays.colors?.[3 * i + k] ?? arrays.intensity[i];
    }
    this.setUsed(chunk, at, first);
    return i;
  }

  private setUsed(chunk: Chunk, used: number, first: number): void {
    chunk.used = used;
    const geometry = chunk.points.geometry;
    geometry.setDrawRange(0, used);
    if (used <= first) return;
    for (const name of ATTRIBUTES) {
      const attribute = geometry.getAttribute(name) as THREE.BufferAttribute;
      if (attribute.updateRanges.length > 64) attribute.clearUpdateRanges(); // not seen for long: all at once then
      else attribute.addUpdateRange(first * attribute.itemSize, (used - first) * attribute.itemSize);
      attribute.needsUpdate = true;
    }
  }

  private openChunk(layer: number): Chunk {
    const open = this.layers[layer].find((chunk) => chunk.used < CHUNK);
    if (open) return open;
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array(3 * CHUNK), 3));
    geometry.setAttribute('host', new THREE.BufferAttribute(new Float32Array(CHUNK), 1));
    geometry.setAttribute('look', new THREE.BufferAttribute(new Uint8Array(4 * CHUNK), 4, true));
    geometry.setAttribute('rgb', new THREE.BufferAttribute(new Uint8Array(3 * CHUNK), 3, true));
    const points = new THREE.Points(geometry, this.material);
    points.frustumCulled = false;
    this.object.add(points);
    const chunk = { points, used: 0 };
    this.layers[layer].push(chunk);
    return chunk;
  }
}
