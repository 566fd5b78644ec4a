// Bundles the front end: node build.mjs NODE_MODULES OUT
import { copyFileSync, mkdirSync } from 'node:fs';
import { createRequire } from 'node:module';
import { dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';

const here = dirname(fileURLToPath(import.meta.url));
const modules = resolve(process.argv[2] ?? join(here, 'node_modules'));
const out = resolve(process.argv[3] ?? join(here, 'dist'));
const esbuild = createRequire(join(modules, 'x.js'))('esbuild');

mkdirSync(out, { recursive: true });
await esbuild.build({
  // The page of the server, and the map in a report.
  entryPoints: { app: join(here, 'src/main.ts'), report: join(here, 'src/report.ts') },
  outdir: out,
  bundle: true,
  minify: true,
  format: 'iife',
  target: ['es2021'],
  legalComments: 'inline',
  nodePaths: [modules],
  logLevel: 'warning',
});
for (const file of ['index.html', 'style.css', 'icon.svg']) copyFileSync(join(here, 'static', file), join(out, file));
