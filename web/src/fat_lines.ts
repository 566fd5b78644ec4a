// Polylines some pixels wide, of any length, of which parts are rewritten while they grow. Each vertex says whether it
// is joined to the one before it, so that one object holds a trajectory with gaps or many separate edges.

import * as THREE from 'three';

const VERTEX = /* glsl */ `
  attribute vec4 start; // xyz
  attribute vec4 end; // xyz, 1 if joined to the start
  uniform vec2 viewport;
  uniform float width;
  varying float across;
  void main() {
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
    vec4 here = position.x < 0.5 ? a : b;
    // Half a width beyond both ends, so that joints have no notch.
    vec2 offset = vec2(-along.y, along.x) * position.y + along * (position.x * 2.0 - 1.0) * 0.5;
    here.xy += offset * width / viewport * here.w;
    across = position.y;
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

const MOST_RANGES = 64;

export class FatLines {
  readonly object: THREE.Mesh;
  private array = new Float32Array(4 * 1024);
  private buffer!: THREE.InstancedInterleavedBuffer;
  private readonly material: THREE.ShaderMaterial;
  private count_ = 0;
  private shown = Infinity;

  constructor(color: THREE.ColorRepresentation, width: number, viewport: THREE.Vector2, opacity = 1) {
    this.material = new THREE.ShaderMaterial({
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
      uniforms: {
        color: { value: new THREE.Color(color) },
        opacity: { value: opacity },
        width: { value: width },
        viewport: { value: viewport },
      },
      transparent: true,
      depthWrite: false,
      side: THREE.DoubleSide,
    });
    this.object = new THREE.Mesh(new THREE.InstancedBufferGeometry(), this.material);
    this.object.frustumCulled = false;
    this.allocate();
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
    this.reserve(index + 1);
    this.array.set([p[0], p[1], p[2], isJoined ? 1 : 0], 4 * index);
  }
  /** Adds edges between pairs of vertices. */
  addEdge(a: ArrayLike<number>, b: ArrayLike<number>): void {
    this.set(this.count_, a, false);
    this.set(this.count_ + 1, b, true);
    this.count_ += 2;
  }
  /** After vertices from `first` on were set. */
  update(count: number, first = 0): void {
    this.count_ = count;
    // What is not seen is not uploaded, and its parts would pile up: then all of it is, once.
    if (this.buffer.updateRanges.length > MOST_RANGES) this.buffer.clearUpdateRanges();
    else if (count > first) this.buffer.addUpdateRange(4 * first, 4 * (count - first));
    this.buffer.needsUpdate = true;
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
    (this.object.geometry as THREE.InstancedBufferGeometry).instanceCount = this.segments;
  }
  private reserve(vertices: number): void {
    if (4 * (vertices + 1) <= this.array.length) return;
    const larger = new Float32Array(Math.max(2 * this.array.length, 4 * (vertices + 1)));
    larger.set(this.array);
    this.array = larger;
    this.allocate();
  }
  private allocate(): void {
    this.object.geometry.dispose();
    const geometry = new THREE.InstancedBufferGeometry();
    geometry.setAttribute(
      'position', new THREE.Float32BufferAttribute([0, -1, 0, 1, -1, 0, 0, 1, 0, 1, 1, 0], 3));
    geometry.setIndex([0, 1, 2, 2, 1, 3]);
    this.buffer = new THREE.InstancedInterleavedBuffer(this.array, 4, 1);
    this.buffer.setUsage(THREE.DynamicDrawUsage);
    geometry.setAttribute('start', new THREE.InterleavedBufferAttribute(this.buffer, 4, 0));
    geometry.setAttribute('end', new THREE.InterleavedBufferAttribute(this.buffer, 4, 4));
    this.object.geometry = geometry;
    this.apply();
  }
}
