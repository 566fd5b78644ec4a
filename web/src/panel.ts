// Everything around the map: state and figures, switches, keys, messages.

import type { ImageView } from './image_view';
import type { Changes, MapModel } from './map_model';
import type { Follow, MapView, Switch } from './map_view';
import { partsNote } from './map_parts';
import { COLOR_MODES, IMAGE_COLOR } from './point_cloud';
import { Command, RunState, Tracking } from './protocol';
import type { Timeline } from './timeline';

interface Parts {
  model: MapModel;
  map: MapView;
  image: ImageView;
  timeline: Timeline;
  send: (command: Command) => void;
}

/** Name, what the key does, color of its mark. */
const SWITCHES: { setting: Switch; label: string; key: string; mark?: string }[] = [
  { setting: 'points', label: 'points', key: '1' },
  { setting: 'odometry', label: 'odometry', key: '2', mark: 'odometry' },
  { setting: 'trajectory', label: 'with loops', key: '3', mark: 'trajectory' },
  { setting: 'truth', label: 'ground truth', key: '4', mark: 'truth' },
  { setting: 'loops', label: 'loop edges', key: '5', mark: 'loops' },
  { setting: 'frustums', label: 'window', key: '6', mark: 'window' },
  { setting: 'keyframes', label: 'all keyframes', key: '7', mark: 'keyframes' },
  { setting: 'covisibility', label: 'covisibility', key: '8', mark: 'covisibility' },
  { setting: 'grid', label: 'grid', key: '9' },
  { setting: 'corrected', label: 'map with loops', key: 'l' },
];
/** Of no use before a loop is closed. */
const OF_LOOPS: Switch[] = ['loops', 'corrected', 'trajectory'];
const MOST_LOG_LINES = 200;

const element = <T extends HTMLElement>(id: string) => document.getElementById(id) as T;
const thousands = (n: number) => Math.round(n).toLocaleString('en-US').replaceAll(',', ' ');

export class Panel {
  isConnected = false;
  private readonly boxes = new Map<Switch, HTMLInputElement>();
  private readonly colorMode = element<HTMLSelectElement>('color');
  private readonly follow = element<HTMLSelectElement>('follow');
  private readonly pointSize = element<HTMLInputElement>('size');
  private readonly deviation = element<HTMLInputElement>('deviation');
  private logLines = 0;
  private hasChosenColor = false;

  constructor(private readonly parts: Parts) {
    this.makeSwitches();
    this.makeInputs();
    this.makeButtons();
    window.addEventListener('keydown', (event) => this.onKey(event));
  }

  get isReplay(): boolean {
    return this.parts.model.hello?.replay ?? false;
  }
  get isPaused(): boolean {
    return this.parts.model.status?.state === RunState.Paused;
  }

  setSwitch(setting: Switch, on: boolean): void {
    this.boxes.get(setting)!.checked = on;
    this.parts.map.set({ [setting]: on });
  }

  setConnected(isOpen: boolean, problem: string): void {
    this.isConnected = isOpen;
    const banner = element('banner');
    banner.hidden = isOpen;
    banner.textContent = problem || 'The connection is lost: ldso has ended, or the line is down. Trying again …';
    this.showState();
  }

  update(changes: Changes, cutoff: number): void {
    if (changes.reset) this.onHello();
    if (changes.log) this.showLog(changes.reset);
    if (changes.keyframes.length > 0) this.offerColors();
    this.showState();
    this.showFigures(cutoff);
  }

  /** Counts and figures of the frame that is shown. */
  showFigures(cutoff: number): void {
    const { model, image } = this.parts;
    const frame = model.frames[model.frameIndexAt(Math.min(cutoff, Number.MAX_SAFE_INTEGER))];
    const status = model.status;
    const set = (id: string, text: string) => (element(id).textContent = text);
    set('n-points', thousands(model.pointCount));
    const inWindow = model.window?.keyframes.filter((k) => !model.keyframe(k.id)).length ?? 0;
    set('n-keyframes', thousands(model.keyframes.length + inWindow));
    set('n-loops', thousands(model.loops.length));
    const [done, count] = [status?.done ?? 0, status?.count ?? 0];
    set('n-frames', count > 0 ? `${thousands(done)} / ${thousands(count)}` : thousands(Math.max(done, model.frames.length)));
    element('dropped-row').hidden = !status?.dropped;
    set('dropped', thousands(status?.dropped ?? 0));
    set('rate', status && status.framesPerSecond > 0 ? `${status.framesPerSecond.toFixed(1)} /s` : '–');
    set('memory', status && status.memoryMb > 0 ? `${thousands(status.memoryMb)} MB` : '–');
    set('tracked', frame ? thousands(frame.points) : '–');
    const alignment = model.alignment;
    element('truth-row').hidden = !alignment;
    if (alignment) set('ate', `${alignment.ateRmse.toPrecision(3)} m`);
    const note = partsNote(model.places);
    element('parts').hidden = note === '';
    set('parts', note);
    for (const setting of OF_LOOPS) this.boxes.get(setting)!.parentElement!.hidden = model.loops.length === 0;
    set('image-info', image.shown.frameId >= 0
      ? `frame ${image.shown.frameId} · ${image.shown.active} active · ${image.shown.candidates} candidates` : '');
  }

  /** The colours of the images, where there are any, unless somebody has chosen others. */
  private offerColors(): void {
    const option = this.colorMode.options[IMAGE_COLOR];
    if (option.disabled !== this.parts.model.hasColors) return;
    option.disabled = !this.parts.model.hasColors;
    if (this.hasChosenColor) return;
    this.colorMode.value = String(option.disabled ? 0 : IMAGE_COLOR);
    this.parts.map.set({ colorMode: Number(this.colorMode.value) });
  }

  private onHello(): void {
    const hello = this.parts.model.hello!;
    const name = hello.name.split('/').filter(Boolean).at(-1) ?? '';
    element('name').textContent = name;
    element('name').title = hello.name;
    document.title = `${name} – ldso`;
    document.body.classList.toggle('replay', hello.replay);
    document.body.classList.toggle('controllable', hello.hasControl);
  }

  private showState(): void {
    const { model } = this.parts;
    const status = model.status;
    let [text, look] = ['connecting', 'idle'];
    if (!this.isConnected && model.hello) [text, look] = ['disconnected', 'lost'];
    else if (this.isReplay) [text, look] = ['replay', 'idle'];
    else if (status?.state === RunState.Finished) [text, look] = ['finished', 'done'];
    else if (status?.state === RunState.Paused) [text, look] = ['paused', 'paused'];
    else if (model.frames.length > 0) {
      const state = model.frames[model.frames.length - 1].state;
      if (state === Tracking.Tracked) [text, look] = ['tracking', 'good'];
      else if (state === Tracking.Lost) [text, look] = ['lost', 'lost'];
      else [text, look] = ['initializing', 'paused'];
    }
    const chip = element('state');
    chip.textContent = text;
    chip.className = `chip ${look}`;
    const isOver = status?.state === RunState.Finished;
    for (const id of ['pause', 'step']) element<HTMLButtonElement>(id).disabled = isOver || !this.isConnected;
    element('pause').textContent = this.isPaused ? 'Continue' : 'Pause';
  }

  private showLog(fromStart: boolean): void {
    const list = element('log');
    if (fromStart) {
      list.replaceChildren();
      this.logLines = 0;
    }
    const log = this.parts.model.log;
    for (; this.logLines < log.length; ++this.logLines) {
      const line = log[this.logLines];
      const item = document.createElement('li');
      item.textContent = line.text;
      item.className = line.isWarning ? 'warning' : '';
      list.append(item);
      if (list.childElementCount > MOST_LOG_LINES) list.firstElementChild!.remove();
    }
    list.scrollTop = list.scrollHeight;
  }

  private makeSwitches(): void {
    const root = element('switches');
    for (const { setting, label, key, mark } of SWITCHES) {
      const row = document.createElement('label');
      const box = document.createElement('input');
      box.type = 'checkbox';
      box.id = `show-${setting}`;
      box.checked = this.parts.map.settings[setting];
      box.addEventListener('change', () => this.parts.map.set({ [setting]: box.checked }));
      const swatch = document.createElement('i');
      swatch.className = `mark ${mark ?? ''}`;
      const hint = document.createElement('kbd');
      hint.textContent = key.toUpperCase();
      row.append(box, swatch, label, hint);
      root.append(row);
      this.boxes.set(setting, box);
    }
  }

  private makeInputs(): void {
    const { map, image } = this.parts;
    COLOR_MODES.forEach((mode, i) => this.colorMode.add(new Option(mode, String(i))));
    this.colorMode.options[IMAGE_COLOR].disabled = true;
    this.colorMode.addEventListener('change', () => {
      this.hasChosenColor = true;
      map.set({ colorMode: Number(this.colorMode.value) });
    });
    this.follow.addEventListener('change', () => this.setFollow(this.follow.value as Follow));
    this.pointSize.addEventListener('input', () => map.set({ pointSize: this.pointSize.valueAsNumber }));
    this.deviation.addEventListener('input', () => {
      const most = 10 ** this.deviation.valueAsNumber;
      map.set({ mostDeviation: most });
      element('deviation-value').textContent = most >= 0.5 ? 'all' : `≤ ${(100 * most).toPrecision(2)} %`;
    });
    for (const [id, name] of [['image-points', 'showPoints'], ['image-candidates', 'showCandidates']] as const) {
      const box = element<HTMLInputElement>(id);
      box.addEventListener('change', () => {
        image[name] = box.checked;
        image.draw();
      });
    }
  }

  private makeButtons(): void {
    const { map } = this.parts;
    const actions: Record<string, () => void> = {
      pause: () => this.togglePause(),
      step: () => this.parts.send(Command.Step),
      fit: () => {
        this.setFollow('free');
        map.fit();
      },
      top: () => {
        this.setFollow('free');
        map.top();
      },
      shot: () => void this.screenshot(),
      help: () => this.toggleHelp(),
      'help-close': () => this.toggleHelp(),
    };
    for (const [id, action] of Object.entries(actions)) {
      element(id).addEventListener('click', (event) => {
        action();
        (event.currentTarget as HTMLElement).blur(); // So that the space bar stays a shortcut.
      });
    }
  }

  private onKey(event: KeyboardEvent): void {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.target instanceof HTMLSelectElement) return;
    const toggled = SWITCHES.find(({ key }) => key === event.key.toLowerCase());
    if (toggled) {
      this.setSwitch(toggled.setting, !this.parts.map.settings[toggled.setting]);
      return;
    }
    const step = (frames: number) => {
      const { timeline, model } = this.parts;
      const now = timeline.cutoff === Infinity ? model.frames.length - 1 : model.frameIndexAt(timeline.cutoff);
      timeline.seek(now + frames);
    };
    const actions: Record<string, () => void> = {
      ' ': () => (this.isReplay || !this.canControl() ? this.parts.timeline.togglePlay() : this.togglePause()),
      n: () => this.canControl() && this.parts.send(Command.Step),
      c: () => this.nextColor(),
      f: () => this.setFollow(this.parts.map.settings.follow === 'follow' ? 'free' : 'follow'),
      v: () => this.setFollow(this.parts.map.settings.follow === 'camera' ? 'free' : 'camera'),
      t: () => element('top').click(),
      r: () => element('fit').click(),
      s: () => void this.screenshot(),
      '+': () => this.setPointSize(this.pointSize.valueAsNumber + 0.5),
      '-': () => this.setPointSize(this.pointSize.valueAsNumber - 0.5),
      arrowleft: () => step(event.shiftKey ? -25 : -1),
      arrowright: () => step(event.shiftKey ? 25 : 1),
      end: () => this.parts.timeline.goLive(),
      home: () => this.parts.timeline.seek(0),
      '?': () => this.toggleHelp(),
      h: () => this.toggleHelp(),
      escape: () => (element('keys').hidden = true),
    };
    const action = actions[event.key.toLowerCase()];
    if (!action) return;
    event.preventDefault();
    action();
  }

  private canControl(): boolean {
    const { model } = this.parts;
    return (model.hello?.hasControl ?? false) && model.status?.state !== RunState.Finished;
  }

  private togglePause(): void {
    this.parts.send(this.isPaused ? Command.Continue : Command.Pause);
  }
  private toggleHelp(): void {
    element('keys').hidden = !element('keys').hidden;
  }
  setFollow(follow: Follow): void {
    this.follow.value = follow;
    this.parts.map.set({ follow });
  }
  private nextColor(): void {
    const modes = this.parts.model.hasColors ? COLOR_MODES.length : IMAGE_COLOR; // It is the last one.
    this.hasChosenColor = true;
    this.colorMode.value = String((Number(this.colorMode.value) + 1) % modes);
    this.parts.map.set({ colorMode: Number(this.colorMode.value) });
  }
  private setPointSize(size: number): void {
    this.pointSize.value = String(size);
    this.parts.map.set({ pointSize: this.pointSize.valueAsNumber });
  }

  private async screenshot(): Promise<void> {
    const blob = await this.parts.map.screenshot();
    if (!blob) return;
    const link = document.createElement('a');
    const { model, timeline } = this.parts;
    const frame = timeline.cutoff === Infinity ? model.frames.at(-1)?.id : timeline.cutoff;
    link.download = `ldso-${element('name').textContent || 'map'}-${frame ?? 0}.png`;
    link.href = URL.createObjectURL(blob);
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 1000);
  }
}
