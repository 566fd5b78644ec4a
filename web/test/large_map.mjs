// How fast the page is with a large map: node large_map.mjs DIST NODE_MODULES [POINTS [KEYFRAMES]]
//
// Feeds the bundled page a made-up map in headless Chromium (software rendering) and turns it: prints the time until
// everything is there, and frames per second while it turns and while the map grows.
import { readFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

import { figures, openBrowser } from './browser.mjs';

const [dist, modules, points = '2000000', keyframes = '5000'] = process.argv.slice(2);
const POINTS = Math.round(Number(points) / Number(keyframes));
const KEYFRAMES = Number(keyframes);
const FRAMES_PER_KEYFRAME = 4;

class Writer {
  parts = [];
  size = 8;
  put(array) {
    const bytes = Buffer.from(array.buffer, array.byteOffset, array.byteLength);
    this.parts.push(bytes);
    this.size += bytes.length;
    return this;
  }
  u8 = (...v) => this.put(new Uint8Array(v));
  u16 = (...v) => this.put(new Uint16Array(v));
  u32 = (...v) => this.put(new Uint32Array(v));
  f32 = (...v) => this.put(new Float32Array(v));
  f64 = (...v) => this.put(new Float64Array(v));
  i64 = (...v) => this.put(new BigInt64Array(v.map(BigInt)));
  align = () => this.put(new Uint8Array((8 - (this.size % 8)) % 8));
  finish(type) {
    this.align();
    const header = Buffer.alloc(8);
    header.writeUInt32LE(this.size, 0);
    header.writeUInt16LE(type, 4);
    return Buffer.concat([header, ...this.parts]);
  }
}

/** Round and round a block, like a car: x and z of keyframe i, and where it looks. */
function pose(i) {
  const angle = (2 * Math.PI * 3 * i) / KEYFRAMES;
  return { t: [200 * Math.sin(angle), 0, 200 * Math.cos(angle)], q: [0, Math.sin(angle / 2), 0, Math.cos(angle / 2)] };
}
function hello() {
  const w = new Writer();
  w.put(Buffer.from('LDSO')).u32(1).i64(1).u32(1).u8(1, 0).u16(0).u32(640, 480).f64(500, 500, 319.5, 239.5);
  return w.u32(5).put(Buffer.from('large')).finish(1);
}
function keyframe(i) {
  const { t, q } = pose(i);
  const xyz = new Float32Array(3 * POINTS);
  for (let k = 0; k < POINTS; ++k) {
    const depth = 4 + 30 * Math.random() ** 2;
    xyz.set([depth * (Math.random() - 0.5) * 1.3, depth * (Math.random() - 0.5), depth], 3 * k);
  }
  const deviation = new Float32Array(POINTS).map(() => 0.001 * 100 ** Math.random());
  const intensity = new Uint8Array(POINTS).map(() => 255 * Math.random());
  const w = new Writer().i64(FRAMES_PER_KEYFRAME * i).f64(i).f64(...t, ...q).u32(POINTS, Math.min(i, 6));
  for (let k = 1; k <= Math.min(i, 6); ++k) w.i64(FRAMES_PER_KEYFRAME * (i - k));
  return w.put(xyz).put(deviation).put(intensity).put(new Uint8Array(POINTS)).finish(2);
}
function frames(i) {
  const { t, q } = pose(i);
  const w = new Writer().u32(FRAMES_PER_KEYFRAME).align();
  for (let k = 0; k < FRAMES_PER_KEYFRAME; ++k) {
    w.i64(FRAMES_PER_KEYFRAME * i + k).f64(i + 0.25 * k).i64(FRAMES_PER_KEYFRAME * i);
    w.f32(0, 0, 0.06 * k, 0, 0, 0, 1).f32(...t, ...q).f32(20 + 5 * Math.random(), 4, 0.01, 0, 10).u32(2000);
    w.u8(1, k === 0 ? 1 : 0, 0, 1).align();
  }
  return w.finish(4);
}

const { context, close } = await openBrowser(modules);
const page = await context.newPage();
page.on('pageerror', (error) => console.log('error:', error));
const types = { '/': 'text/html', '/app.js': 'text/javascript', '/style.css': 'text/css', '/icon.svg': 'image/svg+xml' };
await page.route('http://127.0.0.1:1/**', (route) => {
  const { pathname } = new URL(route.request().url());
  const body = readFileSync(join(dist, pathname === '/' ? 'index.html' : pathname));
  return route.fulfill({ contentType: types[pathname], body });
});
let start = 0;
await page.routeWebSocket(/stream/, async (socket) => {
  start = Date.now();
  socket.send(hello());
  for (let i = 0; i < KEYFRAMES; i += 50) {
    const batch = [];
    for (let k = i; k < Math.min(i + 50, KEYFRAMES); ++k) batch.push(keyframe(k), frames(k));
    socket.send(Buffer.concat(batch));
    await new Promise((done) => setImmediate(done));
  }
});
await page.goto('http://127.0.0.1:1/');
for (;;) {
  const now = await figures(page);
  if (now.keyframes === KEYFRAMES && now.points >= POINTS * KEYFRAMES) break;
  await page.waitForTimeout(200);
}
console.log(`${KEYFRAMES} keyframes, ${(await figures(page)).points} points there after ${((Date.now() - start) / 1000).toFixed(1)} s`);
await page.waitForTimeout(2000);
const before = await figures(page);
const turning = Date.now();
await page.mouse.move(700, 450);
await page.mouse.down();
let slowest = 0;
for (let i = 0; Date.now() - turning < 5000; ++i) {
  const moved = Date.now();
  await page.mouse.move(700 + 150 * Math.sin(i / 20), 450 + 40 * Math.cos(i / 25));
  slowest = Math.max(slowest, Date.now() - moved);
}
await page.mouse.up();
const after = await figures(page);
console.log(`turning: ${((1000 * (after.renders - before.renders)) / (Date.now() - turning)).toFixed(1)} frames/s with ` +
  `${after.layers} of 32 layers; slowest answer to the mouse ${slowest} ms`);
const still = Date.now();
await page.evaluate(() => window.ldsoTest.map.screenshot());
console.log(`everything once: ${Date.now() - still} ms`);
await page.waitForTimeout(1000);
await page.screenshot({ path: join(tmpdir(), 'ldso-large-map.png') });
await close();
process.exit(0);
