// What the page shows, in figures, for tests that drive a browser: window.ldsoTest.

import type { Connection } from './connection';
import type { ImageView } from './image_view';
import type { MapModel } from './map_model';
import type { MapView } from './map_view';
import type { Panel } from './panel';
import type { Timeline } from './timeline';

interface Parts {
  model: MapModel;
  map: MapView;
  image: ImageView;
  panel: Panel;
  timeline: Timeline;
  connection: Connection;
}

export function installTestHook({ model, map, image, panel, timeline, connection }: Parts): void {
  const figures = () => ({
    connected: panel.isConnected,
    runId: model.hello ? String(model.hello.runId) : '',
    replay: panel.isReplay,
    state: document.getElementById('state')!.textContent,
    frames: model.frames.length,
    keyframes: model.keyframes.length,
    points: map.pointCount,
    loops: model.loops.length,
    parts: model.places.parts,
    scale: document.getElementById('scale')!.textContent,
    segments: { ...map.stats.segments },
    edges: map.edgeCounts,
    image: { ...image.shown },
    settings: { ...map.settings },
    cutoff: timeline.cutoff,
    truth: model.alignment ? { ate: model.alignment.ateRmse, pairs: model.alignment.pairs } : null,
    status: model.status ? { ...model.status } : null,
    log: model.log.length,
    renders: map.stats.renders,
    renderMs: map.stats.renderMs,
    layers: map.stats.layers,
    bytes: connection.bytes,
  });
  Object.assign(window, { ldsoTest: { figures, seek: (index: number) => timeline.seek(index), map } });
}
