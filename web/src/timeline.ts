// The slider over the frames: at its end it follows the run, elsewhere the run is shown as it was.

import type { MapModel } from './map_model';

const SPEEDS = [0.25, 0.5, 1, 2, 4, 8];

export class Timeline {
  private readonly slider: HTMLInputElement;
  private readonly play: HTMLButtonElement;
  private readonly speed: HTMLSelectElement;
  private readonly text: HTMLElement;
  private readonly liveButton: HTMLButtonElement;
  private isLive = true;
  private playing = false;
  private position = 0; // index of the frame, with a fraction while it plays
  private last = 0;

  constructor(
    root: HTMLElement,
    private readonly model: MapModel,
    private readonly onCutoff: (frameId: number) => void,
  ) {
    this.slider = root.querySelector('input')!;
    this.play = root.querySelector('[data-play]')!;
    this.speed = root.querySelector('select')!;
    this.text = root.querySelector('[data-time]')!;
    this.liveButton = root.querySelector('[data-live]')!;
    for (const speed of SPEEDS) this.speed.add(new Option(`${speed}×`, String(speed), speed === 1, speed === 1));
    this.slider.addEventListener('input', () => this.seek(this.slider.valueAsNumber));
    this.play.addEventListener('click', () => this.togglePlay());
    this.liveButton.addEventListener('click', () => this.goLive());
  }

  get cutoff(): number {
    return this.isLive ? Infinity : (this.model.frames[Math.floor(this.position)]?.id ?? Infinity);
  }

  /** To the frame with this id. */
  goTo(frameId: number): void {
    this.seek(this.model.frameIndexAt(frameId));
  }

  goLive(): void {
    this.setPlaying(false);
    this.isLive = true;
    this.position = this.model.frames.length - 1;
    this.onCutoff(Infinity);
    this.update();
  }

  seek(index: number): void {
    const last = this.model.frames.length - 1;
    this.position = Math.max(0, Math.min(index, last));
    this.isLive = this.position >= last && !this.playing;
    this.onCutoff(this.cutoff);
    this.update();
  }

  togglePlay(): void {
    if (!this.playing && this.position >= this.model.frames.length - 1) this.position = 0;
    this.setPlaying(!this.playing);
  }

  reset(): void {
    this.setPlaying(false);
    this.isLive = true;
    this.position = 0;
    this.onCutoff(Infinity);
  }

  update(): void {
    const frames = this.model.frames;
    const last = Math.max(0, frames.length - 1);
    if (this.isLive) this.position = last;
    this.slider.max = String(last);
    this.slider.value = String(Math.floor(this.position));
    this.slider.style.setProperty('--done', `${(100 * this.position) / Math.max(1, last)}%`);
    const frame = frames[Math.floor(this.position)];
    const seconds = frame ? Math.abs(frame.timestamp - frames[0].timestamp) : 0;
    this.text.textContent = frame ? `frame ${frame.id}  ·  ${seconds.toFixed(1)} s` : '–';
    this.liveButton.classList.toggle('on', this.isLive);
    this.play.textContent = this.playing ? '❚❚' : '▶';
  }

  private setPlaying(playing: boolean): void {
    if (playing && this.model.frames.length < 2) return;
    this.playing = playing;
    this.last = performance.now();
    if (playing) {
      this.isLive = false;
      requestAnimationFrame(this.advance);
    }
    this.update();
  }

  /** By the frames' own times. */
  private readonly advance = (now: number): void => {
    if (!this.playing) return;
    const frames = this.model.frames;
    const duration = Math.abs(frames[frames.length - 1].timestamp - frames[0].timestamp);
    const rate = duration > 0 ? (frames.length - 1) / duration : 30;
    this.position += ((now - this.last) / 1000) * rate * Number(this.speed.value);
    this.last = now;
    if (this.position >= frames.length - 1) {
      this.goLive();
      return;
    }
    this.onCutoff(this.cutoff);
    this.update();
    requestAnimationFrame(this.advance);
  };
}
