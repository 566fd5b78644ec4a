// The page in a real browser: node browser_test.mjs PROGRAM SEQUENCE WORK NODE_MODULES
//
// Runs the program on the sequence with its page open in headless Chromium, and looks at what the page shows, by its
// test hook and by the pixels of the map. Exit code 77: there is no Chromium. Pictures of each step are left in WORK.
import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { mkdirSync, rmSync } from 'node:fs';
import { join } from 'node:path';
import { isDeepStrictEqual } from 'node:util';

import {
  GREEN, RED, WHITE, YELLOW, collectComplaints, figures, findChromium, finish, openBrowser, pixels,
  until,
} from './browser.mjs';

const [program, sequence, work, modules] = process.argv.slice(2);
findChromium();
const folder = join(work, 'viewer');
rmSync(folder, { recursive: true, force: true });
mkdirSync(folder, { recursive: true });

const children = [];

/** Starts the program; resolves once it has printed the address of its page. */
function start(...args) {
  const child = spawn(program, args, { stdio: ['ignore', 'pipe', 'inherit'], env: { ...process.env, DISPLAY: '', WAYLAND_DISPLAY: '' } });
  children.push(child);
  const ended = new Promise((done) => child.on('exit', (code, signal) => done(code ?? signal)));
  const url = new Promise((found, failed) => {
    let text = '';
    child.stdout.on('data', (data) => {
      text += data;
      const match = /^viewer +(http\S+)$/m.exec(text);
      if (match) found(match[1]);
    });
    child.on('exit', (code) => failed(new Error(`the program ended with ${code} before it had a page:\n${text}`)));
  });
  url.catch(() => {});
  return { child, url, ended };
}

async function stop(run) {
  run.child.kill('SIGINT');
  return await run.ended;
}

const { context, close } = await openBrowser(modules);

const complaints = [];
const hosts = new Set();
let serverIsDown = false; // what the browser says of the line being down is no error of the page

async function openPage(url) {
  const page = await context.newPage();
  collectComplaints(page, complaints, () => !serverIsDown);
  page.on('request', (request) => hosts.add(new URL(request.url()).host || new URL(request.url()).protocol));
  page.on('websocket', (socket) => hosts.add(new URL(socket.url()).host));
  await page.goto(url);
  return page;
}
const picture = (page, name) => page.screenshot({ path: join(folder, `${name}.png`) });

async function testRun() {
  const out = join(folder, 'out');
  const run = start('run', sequence, '-o', out, '--view=127.0.0.1', '--view-paused');
  const url = await run.url;
  const page = await openPage(url);
  await until(page, 'the page is connected to a paused run', (f) => f.connected && f.state === 'paused');
  assert.equal((await figures(page)).frames, 0);
  await page.click('#step');
  await until(page, 'a step is one frame', (f) => f.frames === 1);
  await page.keyboard.press('n');
  await until(page, 'a key steps as well', (f) => f.frames === 2);
  await page.click('#pause');
  await until(page, 'the window is shown', (f) => f.edges.window >= 2 && f.image.active > 100);
  await page.keyboard.press(' ');
  const paused = await until(page, 'a key pauses', (f) => f.state === 'paused' || f.state === 'finished');
  await page.waitForTimeout(500);
  if (paused.state === 'paused') {
    const before = (await figures(page)).frames;
    await page.waitForTimeout(500);
    assert.equal((await figures(page)).frames, before, 'a paused run goes on');
    await picture(page, 'paused');
    await page.keyboard.press(' ');
  }
  await until(page, 'the run ends', (f) => f.state === 'finished');
  // What is drawn follows at the browser's own pace, after the state of the run has come.
  const end = await until(page, 'all trajectories are drawn', (f) =>
    f.segments.odometry >= 40 && f.segments.trajectory >= 40 && f.segments.truth > 40);
  assert.ok(end.frames >= 50, `only ${end.frames} frames`);
  assert.ok(end.keyframes >= 5 && end.points > 1000, `${end.keyframes} keyframes, ${end.points} points`);
  assert.ok(end.truth && end.truth.ate < 0.1, `ground truth: ${JSON.stringify(end.truth)}`);
  assert.ok(end.image.candidates > 50 && end.image.corners > 50, 'candidates and corners are missing in the image');
  assert.ok(end.log > 0, 'the log is empty');
  assert.match(await page.textContent('#ate'), /^[0-9.e-]+ m$/);
  assert.match(end.scale, /^[0-9.]+ (k|c|m)?m$/, 'the ground truth tells the scale');
  assert.equal(end.parts, 1);
  await page.waitForTimeout(800);
  await picture(page, 'finished');
  await testToggles(page);
  await testSlider(page);
  await testLateJoiner(url, page);
  return { run, url, page, out, end };
}

async function testToggles(page) {
  await page.keyboard.press('t');
  await page.setChecked('#show-grid', false);
  // Before a loop is closed the corrected trajectory is the odometry's, and is not drawn over it.
  const hasLoops = (await figures(page)).loops > 0;
  assert.equal(await page.isVisible('#show-trajectory'), hasLoops);
  const lines = [['odometry', RED, 'odometry'], ['truth', GREEN, 'ground truth'], ['frustums', WHITE, 'camera']];
  if (hasLoops) lines.push(['trajectory', YELLOW, 'trajectory']);
  else assert.ok(await pixels(page, YELLOW) < 40, 'there is a trajectory with loops, but no loop');
  const switches = ['odometry', 'truth', 'frustums', 'points', ...(hasLoops ? ['trajectory', 'loops'] : [])];
  for (const [setting, color, name] of lines) {
    // One at a time: where they lie on each other, only the last is seen.
    for (const other of switches) await page.setChecked(`#show-${other}`, other === setting);
    const shown = await pixels(page, color);
    await page.setChecked(`#show-${setting}`, false);
    const hidden = await pixels(page, color);
    assert.ok(shown > 40 && hidden < shown / 10, `${name}: ${shown} pixels when shown, ${hidden} when hidden`);
  }
  for (const setting of switches) await page.setChecked(`#show-${setting}`, true);
  await page.keyboard.press('1');
  assert.equal((await figures(page)).settings.points, false, 'the key 1 hides the points');
  await page.keyboard.press('1');
  for (const mode of ['1', '2', '3']) {
    await page.selectOption('#color', mode);
    await page.waitForTimeout(300);
    await picture(page, `color-${mode}`);
  }
  await page.keyboard.press('v');
  await page.waitForTimeout(500);
  await picture(page, 'through-the-lens');
  await page.keyboard.press('v');
  await page.keyboard.press('?');
  assert.ok(await page.isVisible('#keys'), 'the keys are not shown');
  await picture(page, 'keys');
  await page.keyboard.press('Escape');
  await page.selectOption('#color', '0');
  const [download] = await Promise.all([page.waitForEvent('download'), page.click('#shot')]);
  assert.match(download.suggestedFilename(), /^ldso-.*\.png$/);
  await page.keyboard.press('r');
}

async function testSlider(page) {
  const all = await figures(page);
  await page.evaluate(() => window.ldsoTest.seek(30));
  await until(page, 'the slider shortens the trajectory', (f) => f.cutoff === 30 &&
    f.segments.trajectory < all.segments.trajectory && f.segments.trajectory > 0);
  await picture(page, 'seek');
  await page.keyboard.press('End');
  await until(page, 'its end shows all again', (f) => f.segments.trajectory === all.segments.trajectory);
}

async function testLateJoiner(url, first) {
  const late = await openPage(url);
  const wanted = await figures(first);
  const got = await until(late, 'a late joiner gets the map', (f) => f.frames === wanted.frames &&
    f.keyframes === wanted.keyframes && isDeepStrictEqual(f.segments, wanted.segments));
  assert.equal(got.points, wanted.points);
  assert.equal(got.loops, wanted.loops);
  assert.equal((await figures(first)).status.viewers, 2);
  await late.close();
}

async function testReconnect({ run, url, page, out, end }) {
  serverIsDown = true;
  assert.equal(await stop(run), 0, 'Ctrl-C after the end is no failure');
  await until(page, 'the page says that the line is down', (f) => !f.connected);
  assert.ok(await page.isVisible('#banner'));
  await picture(page, 'disconnected');
  const replay = start('view', out, '--address', new URL(url).host);
  assert.equal(await replay.url, url);
  const again = await until(page, 'the page connects again', (f) => f.connected && f.replay && f.frames === end.frames);
  serverIsDown = false;
  assert.ok(!(await page.isVisible('#image-card')), 'a replay has no images to show');
  assert.equal(again.keyframes, end.keyframes);
  assert.ok(!(await page.isVisible('#banner')));
  await page.evaluate(() => window.ldsoTest.seek(0));
  await page.keyboard.press(' ');
  await until(page, 'the replay goes on by itself', (f) => f.cutoff > 3);
  await picture(page, 'replay');
  await until(page, 'and ends at the end', (f) => f.cutoff === null || f.cutoff === Infinity);
  assert.equal(await stop(replay), 0);
}

let failure = null;
try {
  await testReconnect(await testRun());
  assert.deepEqual(complaints, [], 'the browser complained');
  assert.deepEqual([...hosts].filter((host) => !/^127\.0\.0\.1:\d+$/.test(host) && host !== 'blob:'), [],
    'the page asked other hosts');
} catch (error) {
  failure = error;
}
for (const child of children) if (child.exitCode === null) child.kill('SIGKILL');
await finish(close, folder, failure);
