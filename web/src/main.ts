// The page: connects the stream, the model, the views and the controls.

import { Connection } from './connection';
import { ImageView } from './image_view';
import { MapModel } from './map_model';
import { MapView } from './map_view';
import { Panel } from './panel';
import { Plots } from './plots';
import { ScaleBar } from './scale_bar';
import { Timeline } from './timeline';
import { installTestHook } from './test_hook';

const element = <T extends HTMLElement>(id: string) => document.getElementById(id) as T;

const model = new MapModel();
const scaleBar = new ScaleBar(element('scale'), model);
const map: MapView = new MapView(element<HTMLCanvasElement>('map'), model, () => scaleBar.update(map));
const image = new ImageView(element<HTMLCanvasElement>('image'));
let cutoff = Infinity;

function setCutoff(frameId: number): void {
  cutoff = frameId;
  map.setCutoff(frameId);
  plots.show(model.frames, cutoff);
  panel.showFigures(cutoff);
}

const timeline = new Timeline(element('timeline'), model, setCutoff);
const plots = new Plots(element<HTMLCanvasElement>('plots'), (frameId) => timeline.goTo(frameId));

/** All that has come since the last frame of the screen is brought in at once. */
let scheduled = false;
function schedule(): void {
  if (scheduled) return;
  scheduled = true;
  // A page in the background gets no frames but must not fall behind either.
  if (document.hidden) setTimeout(update, 250);
  else requestAnimationFrame(update);
}

function update(): void {
  scheduled = false;
  const changes = model.takeChanges();
  if (changes.reset) {
    timeline.reset();
    image.clear();
  }
  map.sync(changes);
  timeline.update();
  if (changes.framesFrom < Infinity || changes.reset) plots.show(model.frames, cutoff);
  if (changes.image && !panel.isReplay) void image.show(changes.image);
  panel.update(changes, cutoff);
}

const connection: Connection = new Connection({
  onMessages(messages) {
    for (const message of messages) model.apply(message);
    schedule();
  },
  onStateChange(isOpen, problem) {
    panel.setConnected(isOpen, problem);
  },
});

const panel = new Panel({ model, map, image, timeline, send: (command) => connection.send(command) });
installTestHook({ model, map, image, panel, timeline, connection });
