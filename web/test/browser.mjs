// Chromium without a window, as the tests of the pages use it: pictures are drawn by the processor, nothing is fetched by
// the browser itself.
import { existsSync, mkdtempSync, rmSync } from 'node:fs';
import { createRequire } from 'node:module';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';

export const PATIENCE_MS = 120_000;

/** Ends the program with 77, "skipped", if there is none. */
export function findChromium() {
  const paths = [process.env.LDSO_CHROMIUM, '/usr/bin/chromium', '/usr/bin/chromium-browser', '/usr/bin/google-chrome'];
  const executable = paths.find((path) => path && existsSync(path));
  if (executable) return executable;
  console.log('skipped: there is no Chromium (package chromium; LDSO_CHROMIUM names another one)');
  process.exit(77);
}

/** A browser with a profile of its own, which close() removes. `modules`: where playwright-core is. */
export async function openBrowser(modules, options = {}) {
  const executablePath = findChromium();
  const { chromium } = createRequire(resolve(modules, 'x.js'))('playwright-core');
  const profile = mkdtempSync(join(tmpdir(), 'ldso-chromium-'));
  const context = await chromium.launchPersistentContext(profile, {
    executablePath,
    headless: true,
    viewport: { width: 1440, height: 900 },
    args: [
      '--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--disable-quic', '--no-first-run',
      '--disable-background-networking', '--disable-component-update', '--disable-sync',
    ],
    ...options,
  });
  context.setDefaultTimeout(PATIENCE_MS);
  const close = async () => {
    await context.close();
    rmSync(profile, { recursive: true, force: true });
  };
  return { context, close };
}

/** What the browser complains of on this page, appended to `complaints` as long as `listens()`. */
export function collectComplaints(page, complaints, listens = () => true) {
  page.on('console', (message) => {
    if (!['error', 'warning'].includes(message.type()) || !listens()) return;
    // What the software renderer says of reading back its own pictures.
    if (/GPU stall due to ReadPixels/.test(message.text())) return;
    complaints.push(message.text());
  });
  page.on('pageerror', (error) => complaints.push(String(error)));
}

export const figures = (page) => page.evaluate(() => window.ldsoTest.figures());

/** Waits until the page's figures are as wanted. */
export async function until(page, what, condition) {
  const end = Date.now() + PATIENCE_MS;
  for (;;) {
    const now = await figures(page);
    if (condition(now)) return now;
    if (Date.now() > end) throw new Error(`${what}: not within ${PATIENCE_MS / 1000} s: ${JSON.stringify(now)}`);
    await page.waitForTimeout(100);
  }
}

/** How many pixels of the map have about this color. */
export function pixels(page, color) {
  return page.evaluate(async ([r, g, b]) => {
    const bitmap = await createImageBitmap(await window.ldsoTest.map.screenshot());
    const canvas = new OffscreenCanvas(bitmap.width, bitmap.height);
    const drawing = canvas.getContext('2d');
    drawing.drawImage(bitmap, 0, 0);
    const data = drawing.getImageData(0, 0, bitmap.width, bitmap.height).data;
    let count = 0;
    for (let i = 0; i < data.length; i += 4) {
      if (Math.abs(data[i] - r) + Math.abs(data[i + 1] - g) + Math.abs(data[i + 2] - b) < 60) ++count;
    }
    return count;
  }, color);
}
export const RED = [255, 77, 79], YELLOW = [255, 210, 63], GREEN = [88, 214, 141], WHITE = [255, 255, 255];

/** Ends the program: after `failure`, if there is one, with its message and exit code 1. `folder`: of the pictures. */
export async function finish(close, folder, failure) {
  await close();
  if (failure) {
    console.error(failure);
    process.exit(1);
  }
  console.log(`all is well; pictures in ${folder}`);
  process.exit(0);
}
