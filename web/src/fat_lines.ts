// Polylines some pixels wide, of any length, of which parts are rewritten while they grow. Each vertex says whether it
// is joined to the one before it, so that one object holds a trajectory with gaps or many separate edges. Vertices lie in
// a texture from which the shader takes a segment's two: where a processor draws, an instance a segment costs ten times
// as much.

import * as THREE from 'three';

import { FloatTexture, TEXEL_FUNCTION } from './float_texture';

const CORNERS = 6; // of the two triangles of a segment

const VERTEX = /* glsl */ `
  ${TEXEL_FUNCTION}
  uniform sampler2D vertices; // xyz, 1 if joined to the one before
  uniform vec2 viewport;
  uniform float width;
  varying float across;

  void main() {
    int segment = gl_VertexID / ${CORNERS};
    int k = gl_VertexID % ${CORNERS}; // corners 0 1 2, 2 1 3
    int corner = k < 3 ? k : (k == 3 ? 2 : (k == 4 ? 1 : 3));
    bool at_end = (corner & 1) == 1;
    float side = corner < 2 ? -1.0 : 1.0;
    vec4 start = texel(vertices, segment), end = texel(vertices, segment + 1);
    vec4 a = projectionMatrix * modelViewMatrix * vec4(start.xyz, 1.0);
    vec4 b = projectionMatrix * modelViewMatrix * vec4(end.xyz, 1.0);
    const float near = 1e-3;
    if (end.w < 0.5 || (a.w < near && b.w < near)) {
      gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
      return;
    }
    if (a.w < near) a = mix(b, a, (b.w - near) / (b.w - a.w));
    if (b.w < near) b = mix(a, b, (a.w - near) / (a.w - b.w));
    vec2 way = (b.xy / b.w - a.xy / a.w) * viewport;
    float way_length = length(way);
    vec2 along = way_length > 1e-6 ? way / way_length : vec2(1.0, 0.0);
    vec4 here = at_end ? b : a;
    // Half a width beyond both ends, so that joints have no notch.
    vec2 offset = vec2(-along.y, along.x) * side + along * (at_end ? 0.5 : -0.5);
    here.xy += offset * width / viewport * here.w;
    across = side;
    gl_Position = here;
  }
`;
const FRAGMENT = /* glsl */ `
  uniform vec3 color;
  uniform float opacity;
  varying float across;
  void main() {
    gl_FragColor = vec4(color, opacity * (1.0 - smoothstep(0.6, 1.0, abs(across))));
    #include <colorspace_fragment>
  }
`;

export class FatLines {
  readonly object: THREE.Mesh;
  private readonly geometry = new THREE.BufferGeometry();
  private readonly vertices = new FloatTexture();
  private count_ = 0;
  private shown = Infinity;

  constructor(color: THREE.ColorRepresentation, width: number, viewport: THREE.Vector2, opacity = 1) {
    const material = new THREE.ShaderMaterial({
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
      uniforms: {
        vertices: this.vertices.uniform,
        color: { value: new THREE.Color(color) },
        opacity: { value: opacity },
        width: { value: width },
        viewport: { value: viewport },
      },
      transparent: true,
      depthWrite: false,
      side: THREE.DoubleSide,
    });
    this.object = new THREE.Mesh(this.geometry, material);
    this.object.frustumCulled = false;
    this.apply();
  }

  /** Vertices that are set. */
  get count(): number {
    return this.count_;
  }
  /** Segments that are drawn at most. */
  get segments(): number {
    return Math.max(0, Math.min(this.count_, this.shown) - 1);
  }

  set(index: number, p: ArrayLike<number>, isJoined: boolean): void {
    this.vertices.set(index, [p[0], p[1], p[2], isJoined ? 1 : 0]);
  }
  /** Adds edges between pairs of vertices. */
  addEdge(a: ArrayLike<number>, b: ArrayLike<number>): void {
    this.set(this.count_, a, false);
    this.set(this.count_ + 1, b, true);
    this.count_ += 2;
  }
  /** After vertices were set. */
  update(count: number): void {
    this.count_ = count;
    this.apply();
  }
  clear(): void {
    this.count_ = 0;
    this.apply();
  }
  /** Draws the first vertices only. */
  show(vertices: number): void {
    this.shown = vertices;
    this.apply();
  }

  private apply(): void {
    this.geometry.setDrawRange(0, CORNERS * this.segments);
  }
}
