// report.html in a real browser: node report_test.mjs PROGRAM SEQUENCE WORK NODE_MODULES
//
// Opened as a file, without a server. Exit code 77: there is no Chromium. Pictures are left in WORK.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { mkdirSync, rmSync, statSync, symlinkSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { pathToFileURL } from 'node:url';

import { GREEN, RED, YELLOW, collectComplaints, figures, findChromium, finish, openBrowser, pixels, until } from './browser.mjs';

const [program, sequence, work, modules] = process.argv.slice(2);
findChromium();
const folder = join(work, 'report');
rmSync(folder, { recursive: true, force: true });
mkdirSync(folder, { recursive: true });

/** Runs a sequence; returns the report. The sequence's name tries to be more than a name. */
function makeReport() {
  const name = `<img src=x onerror="window.evil=1"> & 'co'`;
  const link = join(folder, name);
  symlinkSync(resolve(sequence), link);
  const out = join(folder, 'out');
  const run = spawnSync(program, ['run', link, '-o', out, '--quiet'], { stdio: 'inherit' });
  assert.equal(run.status, 0);
  return { file: join(out, 'report.html'), name };
}

const { file, name } = makeReport();
const { context, close } = await openBrowser(modules, { viewport: { width: 1200, height: 900 } });
const complaints = [], requests = [];

async function open(listens = () => true) {
  const page = await context.newPage();
  collectComplaints(page, complaints, listens);
  page.on('request', (request) => requests.push(request.url()));
  await page.goto(pathToFileURL(file).href);
  return page;
}
const waitForMap = (page) => page.waitForFunction(() => window.ldsoTest?.figures().renders > 0);
const background = (page) => page.evaluate(() => getComputedStyle(document.body).backgroundColor);

async function testContent(page) {
  assert.equal(await page.title(), `${name} – ldso`);
  assert.equal(await page.textContent('h1'), name);
  assert.equal(await page.evaluate(() => window.evil), undefined, 'the name of the sequence was taken for HTML');
  assert.equal(await page.locator('main img[src="x"]').count(), 0);
  const titles = await page.locator('h2').allTextContents();
  assert.deepEqual(titles,
    ['Map', 'Trajectory and error', 'Frames', 'Time', 'Loops', 'Problems', 'Camera', 'Settings']);
  assert.equal(await page.locator('.chart svg').count(), 3);
  assert.match(await page.textContent('#timing'), /odometry/);
}

async function testMap(page) {
  const shown = await until(page, 'all trajectories are drawn', (f) =>
    f.segments.odometry >= 40 && f.segments.trajectory >= 40 && f.segments.truth > 40);
  assert.ok(shown.frames >= 50 && shown.keyframes >= 5 && shown.points > 1000, JSON.stringify(shown));
  assert.match(shown.scale, /^[0-9.]+ (k|c|m)?m$/, 'the ground truth tells the scale');
  // Before a loop is closed the corrected trajectory is the odometry's: there is nothing to switch.
  const lines = [['odometry', RED], ['truth', GREEN], ...(shown.loops > 0 ? [['trajectory', YELLOW]] : [])];
  assert.equal(await page.locator('#show-trajectory').count(), shown.loops > 0 ? 1 : 0);
  const switches = ['points', ...lines.map(([setting]) => setting)];
  for (const [setting, color] of lines) {
    for (const other of switches) await page.setChecked(`#show-${other}`, other === setting);
    const visible = await pixels(page, color);
    await page.setChecked(`#show-${setting}`, false);
    const hidden = await pixels(page, color);
    assert.ok(visible > 40 && hidden < visible / 10, `${setting}: ${visible} pixels when shown, ${hidden} when hidden`);
  }
  for (const setting of switches) await page.setChecked(`#show-${setting}`, true);
  await page.evaluate(() => window.ldsoTest.seek(30));
  await until(page, 'the slider shortens the trajectory', (f) =>
    f.cutoff === 30 && f.segments.trajectory < shown.segments.trajectory);
  await page.click('[data-live]');
  await page.click('[data-play]');
  await until(page, 'it plays', (f) => f.cutoff > 3);
  await page.click('[data-live]');
}

async function testLooks(page) {
  await page.emulateMedia({ colorScheme: 'light' });
  const light = await background(page);
  await page.screenshot({ path: join(folder, 'light.png'), fullPage: true });
  await page.emulateMedia({ colorScheme: 'dark' });
  assert.notEqual(await background(page), light, 'there is no dark look');
  await page.screenshot({ path: join(folder, 'dark.png'), fullPage: true });
}

/** The rest of the report is there without WebGL, too. */
async function testWithoutGraphics() {
  await context.addInitScript(() => (HTMLCanvasElement.prototype.getContext = () => null));
  const page = await open(() => false);
  await page.waitForSelector('.map-problem');
  assert.match(await page.textContent('.map-problem'), /The map cannot be shown/);
  assert.equal(await page.locator('.chart svg').count(), 3);
}

let failure = null;
try {
  const start = Date.now();
  const page = await open();
  await waitForMap(page);
  console.log(`opened in ${Date.now() - start} ms, ${(statSync(file).size / 1e6).toFixed(2)} MB`);
  await testContent(page);
  await testMap(page);
  await testLooks(page);
  await testWithoutGraphics();
  assert.deepEqual(complaints, [], 'the browser complained');
  assert.deepEqual(requests.filter((url) => !/^(data|blob):/.test(url) && url !== pathToFileURL(file).href), [],
    'the page asked for something');
} catch (error) {
  failure = error;
}
await finish(close, folder, failure);
