// How long a report takes to open: node report_time.mjs REPORT NODE_MODULES [TIMES]
//
// In headless Chromium (software rendering), a fresh page each time: from the request until the map has been drawn.
import { statSync } from 'node:fs';
import { resolve } from 'node:path';
import { pathToFileURL } from 'node:url';

import { openBrowser } from './browser.mjs';

const [report, modules, times = '5'] = process.argv.slice(2);
const { context, close } = await openBrowser(modules, { viewport: { width: 1200, height: 900 } });
const taken = [];
for (let i = 0; i < Number(times); ++i) {
  const page = await context.newPage();
  const start = Date.now();
  await page.goto(pathToFileURL(resolve(report)).href);
  await page.waitForFunction(() => window.ldsoTest?.figures().renders > 0);
  taken.push(Date.now() - start);
  await page.close();
}
console.log(`${(statSync(report).size / 1e6).toFixed(2)} MB; opened in ${taken.join(', ')} ms`);
await close();
