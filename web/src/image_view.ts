// The current image with the points in it: active ones filled and coloured by inverse depth (corners with a ring),
// candidates as open grey marks (corners as diamonds).

import type { ImageMessage } from './protocol';

const CORNER = 1;
const CANDIDATE = 2;
const STOPS: [number, number, number][] = [
  [48, 70, 180], [33, 117, 229], [28, 196, 184], [148, 224, 82], [250, 194, 51], [230, 64, 46],
];

function ramp(x: number): string {
  const at = Math.min(0.9999, Math.max(0, x)) * (STOPS.length - 1);
  const i = Math.floor(at);
  const mix = (k: number) => Math.round(STOPS[i][k] + (at - i) * (STOPS[i + 1][k] - STOPS[i][k]));
  return `rgb(${mix(0)},${mix(1)},${mix(2)})`;
}

export class ImageView {
  readonly shown = { frameId: -1, active: 0, candidates: 0, corners: 0 };
  showPoints = true;
  showCandidates = true;
  private decoding = false;
  private waiting: ImageMessage | null = null;
  private latest: { bitmap: ImageBitmap; message: ImageMessage } | null = null;

  constructor(private readonly canvas: HTMLCanvasElement) {}

  /** Images that come while one is being decoded replace each other. */
  async show(message: ImageMessage): Promise<void> {
    this.waiting = message;
    if (this.decoding) return;
    this.decoding = true;
    try {
      while (this.waiting) {
        const next: ImageMessage = this.waiting;
        this.waiting = null;
        const bitmap = await createImageBitmap(new Blob([next.jpeg as BlobPart], { type: 'image/jpeg' }));
        this.latest?.bitmap.close();
        this.latest = { bitmap, message: next };
        this.draw();
      }
    } finally {
      this.decoding = false;
    }
  }

  clear(): void {
    this.latest = null;
    this.canvas.getContext('2d')!.clearRect(0, 0, this.canvas.width, this.canvas.height);
  }

  draw(): void {
    if (!this.latest) return;
    const { bitmap, message } = this.latest;
    const ratio = Math.min(window.devicePixelRatio, 2);
    const width = Math.max(1, Math.round(this.canvas.clientWidth * ratio));
    const height = Math.round((width * message.height) / message.width);
    if (this.canvas.width !== width || this.canvas.height !== height) {
      this.canvas.width = width;
      this.canvas.height = height;
    }
    const context = this.canvas.getContext('2d')!;
    context.drawImage(bitmap, 0, 0, width, height);
    this.drawPoints(context, message, width / message.width, ratio);
  }

  private drawPoints(context: CanvasRenderingContext2D, message: ImageMessage, scale: number, ratio: number): void {
    const { pixels, flags, count } = message;
    const [low, high] = this.range(message);
    const r = 1.4 * ratio;
    Object.assign(this.shown, { frameId: message.frameId, active: 0, candidates: 0, corners: 0 });
    context.lineWidth = 0.8 * ratio;
    for (let i = 0; i < count; ++i) {
      const isCandidate = (flags[4 * i + 3] & CANDIDATE) !== 0;
      const isCorner = (flags[4 * i + 3] & CORNER) !== 0;
      if (isCandidate) ++this.shown.candidates;
      else ++this.shown.active;
      if (isCorner) ++this.shown.corners;
      if (!this.showPoints || (isCandidate && !this.showCandidates)) continue;
      const x = (pixels[4 * i] + 0.5) * scale;
      const y = (pixels[4 * i + 1] + 0.5) * scale;
      if (isCandidate) {
        context.strokeStyle = isCorner ? 'rgba(255,255,255,0.75)' : 'rgba(190,200,215,0.4)';
        context.beginPath();
        if (isCorner) {
          context.moveTo(x, y - 1.6 * r);
          context.lineTo(x + 1.6 * r, y);
          context.lineTo(x, y + 1.6 * r);
          context.lineTo(x - 1.6 * r, y);
          context.closePath();
        } else {
          context.rect(x - 0.5 * r, y - 0.5 * r, r, r);
        }
        context.stroke();
        continue;
      }
      context.fillStyle = ramp((pixels[4 * i + 2] - low) / (high - low));
      if (isCorner) {
        context.beginPath();
        context.arc(x, y, 1.5 * r, 0, 2 * Math.PI);
        context.fill();
        context.strokeStyle = 'rgba(0,0,0,0.8)';
        context.stroke();
      } else {
        context.fillRect(x - r, y - r, 2 * r, 2 * r);
      }
    }
  }

  /** From the 3rd to the 97th percentile of the active points' inverse depths. */
  private range(message: ImageMessage): [number, number] {
    const active: number[] = [];
    for (let i = 0; i < message.count; ++i) {
      if ((message.flags[4 * i + 3] & CANDIDATE) === 0) active.push(message.pixels[4 * i + 2]);
    }
    if (active.length < 2) return [0, 1];
    active.sort((a, b) => a - b);
    const low = active[Math.floor(0.03 * active.length)];
    return [low, Math.max(active[Math.floor(0.97 * (active.length - 1))], low + 1e-9)];
  }
}
