// The poses of all keyframes for the graphics processor: points are kept where their keyframe saw them, so that a closed
// loop moves millions of them by rewriting some kilobytes.

import * as THREE from 'three';

import type { Pose } from './protocol';

export const TEXTURE_WIDTH = 1024;
/** For each keyframe: translation and scale, rotation; of the odometry, then corrected. */
export const TEXELS = 4;
const PER_ROW = TEXTURE_WIDTH / TEXELS;

export class PoseTexture {
  texture = this.make(16);

  set(index: number, odometry: Pose, corrected: Pose): void {
    let data = this.texture.image.data as Float32Array;
    const row = Math.floor(index / PER_ROW);
    if (row >= this.texture.image.height) {
      const old = this.texture;
      this.texture = this.make(Math.max(2 * old.image.height, row + 1));
      (this.texture.image.data as Float32Array).set(data);
      old.dispose();
      data = this.texture.image.data as Float32Array;
    }
    data.set([...odometry.t, odometry.s, ...odometry.q, ...corrected.t, corrected.s, ...corrected.q], 16 * index);
    this.texture.needsUpdate = true;
  }

  private make(rows: number): THREE.DataTexture {
    const data = new Float32Array(4 * TEXTURE_WIDTH * rows);
    const texture = new THREE.DataTexture(data, TEXTURE_WIDTH, rows, THREE.RGBAFormat, THREE.FloatType);
    texture.needsUpdate = true;
    return texture;
  }
}
