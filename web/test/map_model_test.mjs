// The model of the page without a page: node map_model_test.mjs NODE_MODULES
import assert from 'node:assert/strict';
import { createRequire } from 'node:module';
import { dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';

const modules = resolve(process.argv[2]);
const esbuild = createRequire(join(modules, 'x.js'))('esbuild');
const here = dirname(fileURLToPath(import.meta.url));
const { outputFiles } = await esbuild.build({
  entryPoints: [join(here, '../src/map_model.ts')], bundle: true, format: 'esm', write: false, nodePaths: [modules],
});
const { MapModel } = await import('data:text/javascript,' + encodeURIComponent(outputFiles[0].text));

const at = (x, s = 1) => ({ t: [x, 0, 0], q: [0, 0, 0, 1], s });
const points = { count: 0, xyz: new Float32Array(), depthStddev: new Float32Array(), intensity: new Uint8Array(), isCorner: new Uint8Array(), colors: null };
const keyframe = (id, segment = 0) => ({ kind: 'keyframe', id, timestamp: id, pose: at(id), points, links: [], segment });
const poses = (atFrame, correction, ...list) => ({ kind: 'poses', atFrame, correction, poses: list.map(([id, pose]) => ({ id, pose })) });
const x = (model, id) => model.correctedPose(model.keyframe(id)).t[0];

function someRun() {
  const model = new MapModel();
  model.apply({ kind: 'hello', version: 1, runId: 1n, epoch: 1, replay: true, hasControl: false, width: 1, height: 1, fx: 1, fy: 1, cx: 0, cy: 0, name: '' });
  for (const id of [0, 10, 20]) model.apply(keyframe(id));
  model.apply(poses(15, at(100), [0, at(1)]));
  model.apply(poses(25, at(200), [0, at(2)], [10, at(12)]));
  return model;
}

const model = someRun();
assert.equal(x(model, 0), 2);
assert.equal(x(model, 10), 12);
assert.equal(x(model, 20), 220, 'without a pose of its own it goes with the newest');

assert.equal(model.setTime(20), true);
assert.equal(x(model, 0), 1);
assert.equal(x(model, 10), 110);
assert.equal(model.setTime(22), false, 'nothing happened in between');
assert.equal(model.setTime(3), true);
assert.equal(x(model, 0), 0);
assert.equal(x(model, 10), 10);

// What is said while one looks at the past changes the present only.
model.takeChanges();
model.apply(poses(30, at(0), [0, at(3)]));
assert.equal(x(model, 0), 0);
assert.equal(model.takeChanges().poses, false);
assert.equal(model.setTime(Infinity), true);
assert.equal(x(model, 0), 3);
assert.equal(x(model, 10), 12);

// And while one does not, it is a change.
model.apply(poses(31, at(0), [10, at(13)], [40, at(44)]));
assert.equal(x(model, 10), 13);
assert.equal(model.takeChanges().poses, true);
model.apply(keyframe(40));
assert.equal(x(model, 40), 44, 'a pose may come before its keyframe');
// Two segments that no loop joins lie apart, the larger one where it was; a loop brings them together.
const lost = someRun();
for (const id of [30, 40]) lost.apply({ ...keyframe(id, 1), pose: at(id - 30) });
lost.apply(poses(45, at(0), [20, at(21)], [30, at(1)], [40, at(11)]));
lost.takeChanges();
assert.equal(lost.places.parts, 2);
assert.equal(x(lost, 10), 12);
assert.ok(x(lost, 30) > x(lost, 20) + 1, 'the smaller map lies beside the larger one');
assert.equal(Math.round(x(lost, 40) - x(lost, 30)), 10);
const odometry = (id) => lost.odometryPose(lost.keyframe(id)).t[0];
assert.ok(odometry(30) > odometry(20));
lost.apply({ kind: 'loops', loops: [{ keyframeId: 40, candidateId: 0, atFrame: 45, inliers: 1, score: 1 }] });
lost.takeChanges();
assert.equal(lost.places.parts, 1);
assert.equal(x(lost, 30), 1);
assert.ok(odometry(30) > odometry(20), 'before loop closing they still have nothing to do with each other');
lost.setTime(44);
assert.equal(lost.places.parts, 2, 'at that time nothing was joined');
console.log('all is well');
