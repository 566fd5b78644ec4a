// A bar of a round length in the corner of the map. In metres where a length of the run was given or the ground truth
// tells it, else in the unit of the map, which a single camera leaves free.

import type { MapModel } from './map_model';
import type { MapView } from './map_view';

const WIDEST_PX = 140;

/** The largest of 1, 2, 5, 10, ... that is not larger. */
export function roundLength(most: number): number {
  const power = 10 ** Math.floor(Math.log10(most));
  return (most >= 5 * power ? 5 : most >= 2 * power ? 2 : 1) * power;
}

export function lengthText(length: number, isMetric: boolean): string {
  if (!isMetric) return `${Number(length.toPrecision(3))} (unit of the map)`;
  if (length >= 1000) return `${Number((length / 1000).toPrecision(3))} km`;
  if (length >= 1) return `${Number(length.toPrecision(3))} m`;
  return length >= 0.01 ? `${Number((100 * length).toPrecision(3))} cm` : `${Number((1000 * length).toPrecision(3))} mm`;
}

/** Metres in a unit of the map, and how one knows; null if nobody does. */
export function metresPerUnit(model: MapModel): { metres: number; by: string } | null {
  const given = model.hello?.metresPerUnit ?? 0;
  if (given > 0) return { metres: given, by: 'a length that was given' };
  const scale = model.alignment?.worldFromTruth.s ?? 0;
  return scale > 0 ? { metres: 1 / scale, by: 'the ground truth' } : null;
}

export class ScaleBar {
  private readonly bar = document.createElement('i');
  private readonly text = document.createElement('span');
  private shown = '';

  constructor(readonly element: HTMLElement, private readonly model: MapModel) {
    element.classList.add('scale-bar');
    element.append(this.bar, this.text);
  }

  /** After each picture. */
  update(view: MapView): void {
    const metric = metresPerUnit(this.model);
    const perPixel = view.unitsPerPixel * (metric?.metres ?? 1);
    if (!(perPixel > 0 && Number.isFinite(perPixel))) return;
    const length = roundLength(WIDEST_PX * perPixel);
    const text = lengthText(length, metric !== null);
    const width = `${Math.round(length / perPixel)}px`;
    if (this.shown === width + text) return;
    this.shown = width + text;
    this.bar.style.width = width;
    this.text.textContent = text;
    this.element.title = `At the distance that is looked at; ${metric ? `metres by ${metric.by}` : 'the scale of the map is free'}`;
  }
}
