// Numbers for a shader in a texture that grows, four a texel: it takes them by their index with the function `texel`.

import * as THREE from 'three';

const WIDTH = 1024;

/** For shaders: vec4 texel(sampler2D numbers, int index). */
export const TEXEL_FUNCTION = /* glsl */ `
  precision highp sampler2D;
  vec4 texel(sampler2D numbers, int index) {
    return texelFetch(numbers, ivec2(index % ${WIDTH}, index / ${WIDTH}), 0);
  }
`;

export class FloatTexture {
  readonly uniform: { value: THREE.DataTexture };

  constructor(rows = 1) {
    this.uniform = { value: make(rows) };
  }

  /** From texel `index` on. */
  set(index: number, values: ArrayLike<number>): void {
    this.reserve(index + Math.ceil(values.length / 4));
    numbers(this.uniform.value).set(values, 4 * index);
    this.uniform.value.needsUpdate = true;
  }

  private reserve(texels: number): void {
    const before = this.uniform.value;
    if (texels <= WIDTH * before.image.height) return;
    const larger = make(Math.max(2 * before.image.height, Math.ceil(texels / WIDTH)));
    numbers(larger).set(numbers(before));
    before.dispose();
    this.uniform.value = larger;
  }
}

function make(rows: number): THREE.DataTexture {
  const texture = new THREE.DataTexture(new Float32Array(4 * WIDTH * rows), WIDTH, rows, THREE.RGBAFormat, THREE.FloatType);
  texture.needsUpdate = true;
  return texture;
}

function numbers(texture: THREE.DataTexture): Float32Array {
  return texture.image.data as Float32Array;
}
