// Figures of all frames over time, one strip each, with the value under the pointer.

import { Tracking, type Frame } from './protocol';

interface Strip {
  name: string;
  unit: string;
  digits: number;
  color: string;
  fromZero: boolean;
  value: (frame: Frame) => number; // NaN: none
}

const tracked = (frame: Frame, value: number) => (frame.state === Tracking.Tracked ? value : NaN);

export const STRIPS: Strip[] = [
  { name: 'frame time', unit: 'ms', digits: 1, color: '#4f9dff', fromZero: true,
    value: (f) => (f.frameMs > 0 ? f.frameMs : NaN) },
  { name: 'tracked points', unit: '', digits: 0, color: '#58d68d', fromZero: true, value: (f) => tracked(f, f.points) },
  { name: 'residual', unit: 'grey levels', digits: 2, color: '#ffd23f', fromZero: true,
    value: (f) => (f.residual > 0 ? tracked(f, f.residual) : NaN) },
  { name: 'brightness a', unit: '', digits: 3, color: '#d28bff', fromZero: false, value: (f) => tracked(f, f.a) },
  { name: 'exposure', unit: 'ms', digits: 2, color: '#ff8f5a', fromZero: true,
    value: (f) => (f.exposureMs > 0 ? f.exposureMs : NaN) },
];
const STRIP_HEIGHT = 46;
const GAP = 8;
const LABEL = 15;

export class Plots {
  private pointer: number | null = null; // 0..1 over the width
  private frames: readonly Frame[] = [];
  private cutoff = Infinity;
  private pending = false;

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly onPick: (frameId: number) => void,
  ) {
    canvas.style.height = `${STRIPS.length * (STRIP_HEIGHT + LABEL + GAP)}px`;
    const at = (event: PointerEvent | MouseEvent) => event.offsetX / Math.max(1, canvas.clientWidth);
    canvas.addEventListener('pointermove', (event) => {
      this.pointer = at(event);
      this.invalidate();
    });
    canvas.addEventListener('pointerleave', () => {
      this.pointer = null;
      this.invalidate();
    });
    canvas.addEventListener('click', (event) => {
      const frame = this.frameAt(at(event));
      if (frame) this.onPick(frame.id);
    });
    new ResizeObserver(() => this.invalidate()).observe(canvas);
  }

  show(frames: readonly Frame[], cutoff: number): void {
    this.frames = frames;
    this.cutoff = cutoff;
    this.invalidate();
  }

  private invalidate(): void {
    if (this.pending) return;
    this.pending = true;
    requestAnimationFrame(() => {
      this.pending = false;
      this.draw();
    });
  }

  private frameAt(share: number): Frame | undefined {
    return this.frames[Math.min(this.frames.length - 1, Math.max(0, Math.floor(share * this.frames.length)))];
  }

  private draw(): void {
    const ratio = Math.min(window.devicePixelRatio, 2);
    const [width, height] = [this.canvas.clientWidth, this.canvas.clientHeight];
    if (width < 2) return;
    this.canvas.width = width * ratio;
    this.canvas.height = height * ratio;
    const context = this.canvas.getContext('2d')!;
    context.scale(ratio, ratio);
    STRIPS.forEach((strip, i) => this.drawStrip(context, strip, i * (STRIP_HEIGHT + LABEL + GAP), width));
  }

  private drawStrip(context: CanvasRenderingContext2D, strip: Strip, top: number, width: number): void {
    const frames = this.frames;
    const columns = this.columns(strip, Math.floor(width));
    let [low, high] = [strip.fromZero ? 0 : Infinity, -Infinity];
    for (const column of columns) {
      if (!column) continue;
      low = Math.min(low, column.low);
      high = Math.max(high, column.high);
    }
    const hasData = high > -Infinity;
    if (!hasData) [low, high] = [0, 1];
    if (high - low < 1e-9) [low, high] = strip.fromZero ? [0, Math.max(1e-9, 2 * high)] : [low - 0.1, high + 0.1];
    const y = (value: number) => top + LABEL + STRIP_HEIGHT - 2 - ((value - low) / (high - low)) * (STRIP_HEIGHT - 5);

    context.fillStyle = '#10151e';
    context.fillRect(0, top + LABEL, width, STRIP_HEIGHT);
    context.strokeStyle = context.fillStyle = strip.color;
    context.lineWidth = 1.3;
    context.beginPath();
    let pen = false;
    columns.forEach((column, x) => {
      if (!column) {
        pen = false;
        return;
      }
      if (pen) context.lineTo(x, y(column.first));
      else context.moveTo(x, y(column.first));
      if (column.low !== column.high) {
        context.lineTo(x, y(column.low));
        context.lineTo(x, y(column.high));
        context.lineTo(x, y(column.last));
      }
      pen = true;
    });
    context.stroke();

    const picked = this.pointer !== null ? this.frameAt(this.pointer) : this.cutoff < Infinity ? null : frames.at(-1);
    this.drawMarks(context, top, width);
    context.font = '11px ui-sans-serif, system-ui, sans-serif';
    context.textAlign = 'left';
    context.fillStyle = '#93a0b4';
    const unit = strip.unit ? ` [${strip.unit}]` : '';
    const range = strip.fromZero ? `up to ${high.toFixed(strip.digits)}`
      : `${low.toFixed(strip.digits)} to ${high.toFixed(strip.digits)}`;
    context.fillText(strip.name + unit, 0, top + 11);
    const textWidth = context.measureText(strip.name + unit).width;
    context.fillStyle = '#5c6879';
    if (hasData) context.fillText(range, textWidth + 8, top + 11);
    context.textAlign = 'right';
    context.fillStyle = strip.color;
    const value = picked ? strip.value(picked) : NaN;
    const where = this.pointer !== null && picked ? `frame ${picked.id}: ` : '';
    if (!hasData) context.fillStyle = '#5c6879';
    context.fillText(
      hasData ? where + (Number.isFinite(value) ? value.toFixed(strip.digits) : '–') : 'not known', width, top + 11);
  }

  private drawMarks(context: CanvasRenderingContext2D, top: number, width: number): void {
    const line = (x: number, color: string) => {
      context.fillStyle = color;
      context.fillRect(Math.round(x), top + LABEL, 1, STRIP_HEIGHT);
    };
    if (this.pointer !== null) line(this.pointer * width, '#ffffff66');
    if (this.cutoff < Infinity && this.frames.length > 0) {
      let index = this.frames.findIndex((frame) => frame.id > this.cutoff);
      if (index < 0) index = this.frames.length;
      line(((index - 0.5) / this.frames.length) * width, '#ffffffaa');
    }
  }

  /** Least, largest, first and last value of the frames that share a column of pixels. */
  private columns(strip: Strip, width: number) {
    type Column = { low: number; high: number; first: number; last: number };
    const columns: (Column | null)[] = [];
    const count = this.frames.length;
    for (let x = 0; x < width; ++x) {
      const begin = Math.floor((x * count) / width);
      const end = Math.max(begin + 1, Math.floor(((x + 1) * count) / width));
      let column: Column | null = null;
      for (let i = begin; i < end && i < count; ++i) {
        const value = strip.value(this.frames[i]);
        if (!Number.isFinite(value)) continue;
        if (!column) column = { low: value, high: value, first: value, last: value };
        column.low = Math.min(column.low, value);
        column.high = Math.max(column.high, value);
        column.last = value;
      }
      columns.push(column);
    }
    return columns;
  }
}
