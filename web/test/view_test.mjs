// What the view takes for the map's size, and the scale bar, without a page: node view_test.mjs NODE_MODULES
import assert from 'node:assert/strict';
import { createRequire } from 'node:module';
import { dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';

const modules = resolve(process.argv[2]);
const esbuild = createRequire(join(modules, 'x.js'))('esbuild');
const here = dirname(fileURLToPath(import.meta.url));

async function load(name) {
  const { outputFiles } = await esbuild.build({
    entryPoints: [join(here, '../src', name)], bundle: true, format: 'esm', write: false, nodePaths: [modules],
  });
  return import('data:text/javascript,' + encodeURIComponent(outputFiles[0].text));
}

const { inlierBox, median } = await load('inliers.ts');
const { roundLength, lengthText, metresPerUnit } = await load('scale_bar.ts');
const { decode } = await load('protocol.ts');

assert.equal(median([3, 1, 2]), 2);
const way = Array.from({ length: 100 }, (_, i) => [i / 100, 0, 0]);
const points = Array.from({ length: 1000 }, (_, i) => [i / 1000, (i % 10) / 10, 2]);
const box = inlierBox([...way, [5000, 0, 0], [NaN, 0, 0]], [...points, [0, 1e6, 0], [0, 0, -1e9]]);
assert.ok(box.low[0] >= -0.01 && box.high[0] < 1.01, 'a lost pose is in the view');
assert.ok(box.high[1] < 1 && box.low[2] === 0 && box.high[2] === 2, 'stray points are in the view');
assert.deepEqual(inlierBox([[1, 2, 3]], []), { low: [1, 2, 3], high: [1, 2, 3] });
assert.equal(inlierBox([], []), null);

assert.equal(roundLength(7.3), 5);
assert.equal(roundLength(0.0021), 0.002);
assert.equal(lengthText(2000, true), '2 km');
assert.equal(lengthText(0.05, true), '5 cm');
assert.equal(lengthText(0.5, false), '0.5 (unit of the map)');
assert.equal(metresPerUnit({ hello: { metresPerUnit: 0 }, alignment: null }), null);
assert.equal(metresPerUnit({ hello: { metresPerUnit: 0 }, alignment: { worldFromTruth: { s: 4 } } }).metres, 0.25);
assert.equal(metresPerUnit({ hello: { metresPerUnit: 2 }, alignment: { worldFromTruth: { s: 4 } } }).metres, 2);

// A keyframe as the first versions wrote it, and with what came to its end later.
function keyframeMessage(tail) {
  const bytes = new ArrayBuffer(8 + 80 + 24 + tail.length);
  const view = new DataView(bytes);
  view.setUint32(0, bytes.byteLength, true);
  view.setUint16(4, 2, true);
  view.setBigInt64(8, 7n, true);
  view.setFloat64(72, 1, true); // w of the rotation
  view.setUint32(80, 1, true); // points
  new Uint8Array(bytes).set(tail, 8 + 80 + 24);
  return bytes;
}
const [old] = decode(keyframeMessage([]));
assert.equal(old.id, 7);
assert.equal(old.points.count, 1);
assert.deepEqual([old.segment, old.points.colors], [0, null]);
const [grey] = decode(keyframeMessage([2, 0, 0, 0, 0, 0, 0, 0]));
assert.deepEqual([grey.segment, grey.points.colors], [2, null]);
const [colored] = decode(keyframeMessage([3, 0, 0, 0, 1, 0, 0, 0, 10, 20, 30, 0, 0, 0, 0, 0]));
assert.deepEqual([colored.segment, [...colored.points.colors]], [3, [10, 20, 30]]);
console.log('all is well');
