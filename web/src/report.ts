// The map in a report: the recording that the page carries, in a view with the few switches that a document needs. No
// server, no connection; see docs/viewer.md.

import { MapModel } from './map_model';
import { MapView, type Switch } from './map_view';
import { partsNote } from './map_parts';
import { COLOR_MODES, IMAGE_COLOR } from './point_cloud';
import { decode } from './protocol';
import { ScaleBar } from './scale_bar';
import { Timeline } from './timeline';

const SWITCHES: { setting: Switch; label: string; color?: string }[] = [
  { setting: 'points', label: 'points' },
  { setting: 'odometry', label: 'odometry', color: '#ff4d4f' },
  { setting: 'trajectory', label: 'with loops', color: '#ffd23f' },
  { setting: 'truth', label: 'ground truth', color: '#58d68d' },
  { setting: 'loops', label: 'loop edges', color: '#33d6ff' },
  { setting: 'keyframes', label: 'keyframes', color: '#6c7686' },
  { setting: 'covisibility', label: 'covisibility', color: '#7d8fd0' },
  { setting: 'corrected', label: 'map with loops' },
];

const OF_LOOPS: Switch[] = ['loops', 'corrected', 'trajectory'];

function make<K extends keyof HTMLElementTagNameMap>(
  tag: K, properties: Partial<HTMLElementTagNameMap[K]> = {}, ...children: (Node | string)[]
): HTMLElementTagNameMap[K] {
  const element = Object.assign(document.createElement(tag), properties);
  element.append(...children);
  return element;
}

/** The bytes that the page carries; it forgets them. */
function takeRecording(): ArrayBuffer {
  const element = document.getElementById('recording')!;
  const text = atob(element.textContent!);
  element.remove();
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return bytes.buffer;
}

function makeTools(root: HTMLElement, map: MapView, model: MapModel): HTMLElement {
  const tools = make('div', { className: 'map-tools' });
  for (const { setting, label, color } of SWITCHES) {
    if (OF_LOOPS.includes(setting) && model.loops.length === 0) continue;
    if (setting === 'truth' && !model.alignment) continue;
    const box = make('input', { type: 'checkbox', id: `show-${setting}`, checked: map.settings[setting] });
    box.addEventListener('change', () => map.set({ [setting]: box.checked }));
    const mark = make('i', { className: 'mark' });
    if (color) mark.style.background = color;
    tools.append(make('label', {}, box, ...(color ? [mark] : []), label));
  }
  const color = make('select', { ariaLabel: 'Color of the points', id: 'color' });
  COLOR_MODES.forEach((mode, i) => (i !== IMAGE_COLOR || model.hasColors) && color.add(new Option(mode, String(i))));
  color.value = String(map.settings.colorMode);
  color.addEventListener('change', () => map.set({ colorMode: Number(color.value) }));
  const button = (text: string, title: string, action: () => void) => {
    const made = make('button', { textContent: text, title });
    made.addEventListener('click', action);
    return made;
  };
  tools.append(
    color,
    button('−', 'Smaller points', () => map.set({ pointSize: Math.max(0.5, map.settings.pointSize - 0.5) })),
    button('+', 'Larger points', () => map.set({ pointSize: Math.min(8, map.settings.pointSize + 0.5) })),
    button('fit', 'Everything into view', () => map.fit()),
    button('top', 'From above', () => map.top()),
    button('full screen', 'The map alone', () => {
      if (document.fullscreenElement) void document.exitFullscreen();
      else void root.requestFullscreen();
    }),
  );
  return tools;
}

function makeTimeline(model: MapModel, map: MapView): { element: HTMLElement; timeline: Timeline } {
  const play = make('button', { title: 'Replay' });
  play.dataset.play = '';
  const time = make('span');
  time.dataset.time = '';
  const end = make('button', { textContent: 'end', title: 'The last frame' });
  end.dataset.live = '';
  const element = make('div', { className: 'map-time' }, play,
    make('input', { type: 'range', min: '0', max: '0', step: '1', value: '0', ariaLabel: 'Frame' }), time,
    make('select', { ariaLabel: 'Speed' }), end);
  return { element, timeline: new Timeline(element, model, (frameId) => map.setCutoff(frameId)) };
}

/** The wheel scrolls the page until the map has been clicked at, and again once the pointer has left it. */
function keepWheelForThePage(root: HTMLElement): void {
  const hint = make('span', { className: 'map-hint', textContent: 'drag to turn; click, then the wheel zooms' });
  root.append(hint);
  const setActive = (active: boolean) => {
    root.classList.toggle('active', active);
    hint.hidden = active;
  };
  root.addEventListener('pointerdown', () => setActive(true), { capture: true });
  root.addEventListener('pointerleave', () => setActive(false));
  root.addEventListener('wheel', (event) => {
    const isActive = root.classList.contains('active') || document.fullscreenElement === root;
    if (!isActive) event.stopPropagation();
  }, { capture: true });
}

function show(root: HTMLElement): void {
  const model = new MapModel();
  const canvas = make('canvas', { tabIndex: 0, ariaLabel: 'The map in three dimensions' });
  root.replaceChildren(canvas);
  const scaleBar = new ScaleBar(make('div'), model);
  const map: MapView = new MapView(canvas, model, () => scaleBar.update(map));
  for (const message of decode(takeRecording())) model.apply(message);
  map.sync(model.takeChanges());
  if (model.hasColors) map.set({ colorMode: IMAGE_COLOR });
  const { element, timeline } = makeTimeline(model, map);
  root.append(makeTools(root, map, model), element, scaleBar.element);
  const note = partsNote(model.places);
  if (note) root.append(make('div', { className: 'map-parts', textContent: note }));
  keepWheelForThePage(root);
  timeline.update();
  map.fit();
  const figures = () => ({
    frames: model.frames.length, keyframes: model.keyframes.length, points: map.pointCount, loops: model.loops.length,
    segments: { ...map.stats.segments }, edges: map.edgeCounts, settings: { ...map.settings }, cutoff: timeline.cutoff,
    parts: model.places.parts, scale: scaleBar.element.textContent, renders: map.stats.renders, readyMs: performance.now(),
  });
  const ready = figures().readyMs;
  Object.assign(window, {
    ldsoTest: { figures: () => ({ ...figures(), readyMs: ready }), seek: (index: number) => timeline.seek(index), map },
  });
}

function start(): void {
  const root = document.getElementById('map-view')!;
  try {
    show(root);
  } catch (error) {
    const text = error instanceof Error ? error.message : String(error);
    root.replaceChildren(make('div', { className: 'map-problem', textContent: `The map cannot be shown: ${text}` }));
  }
}

// The text of the page comes first.
requestAnimationFrame(() => setTimeout(start));
