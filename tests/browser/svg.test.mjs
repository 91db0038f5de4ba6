// SVG files without a browser: every figure is drawn, and nothing of it is cut off.
import assert from 'node:assert/strict';
import {spawnSync} from 'node:child_process';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import test from 'node:test';
import {chromium} from 'playwright-core';
import {launchOptions} from './support.mjs';

const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'odobench_svg_'));
test.after(() => fs.rmSync(folder, {recursive: true}));
for (const name of ['vega.min.js', 'vega-lite.min.js']) fs.copyFileSync(path.join(process.env.CHARTS, name), path.join(folder, name));
for (const name of ['theme.js', 'render_svg.js']) fs.copyFileSync(path.join(process.env.WEB, name), path.join(folder, name));
const run = (list, input) => spawnSync(process.execPath, [path.join(folder, 'render_svg.js'), folder, ...list], {input, encoding: 'utf8'});

test('every figure becomes a file', {skip: !process.env.FIGURES && 'FIGURES is not set'}, async () => {
  const begin = Date.now();
  const result = run([process.env.FIGURES]);
  assert.equal(result.status, 0, result.stderr);
  const figures = JSON.parse(fs.readFileSync(process.env.FIGURES, 'utf8'));
  console.log(`# ${figures.length} SVG files in ${Date.now() - begin} ms`);
  const browser = await chromium.launch(launchOptions);
  const page = await browser.newPage();
  for (const {id} of figures) {
    const svg = fs.readFileSync(path.join(folder, `${id}.svg`), 'utf8');
    assert.match(svg, /^<svg [^>]*width="\d+/);
    fs.copyFileSync(path.join(folder, `${id}.svg`), path.join(process.env.OUTPUT, `${id}.svg`));
    await page.setContent(`<body style="margin:0">${svg}`);
    const outside = await page.$eval('svg', (root) => {
      const box = root.getBoundingClientRect();
      return [...root.querySelectorAll('text')].filter((text) => {
        const own = text.getBoundingClientRect();
        return own.width > 0 && (own.left < box.left - 1 || own.right > box.right + 1 || own.top < box.top - 1 || own.bottom > box.bottom + 1);
      }).map((text) => text.textContent);
    });
    assert.deepEqual(outside, [], `figure ${id}: text that is cut off`);
  }
  await browser.close();
  assert.deepEqual(fs.readdirSync(folder).filter((name) => name.endsWith('.part')), []);
});

test('a figure that cannot be drawn is named and leaves no file', () => {
  const result = run([], JSON.stringify([{id: 'bad', spec: {mark: 'nonsense', data: {values: []}}}]));
  assert.equal(result.status, 1);
  assert.match(result.stderr, /^figure bad: /);
  assert.deepEqual(fs.readdirSync(folder).filter((name) => name.startsWith('bad')), []);
});

test('an id cannot leave the folder', () => {
  const result = run([], JSON.stringify([{id: '../outside', spec: {}}]));
  assert.equal(result.status, 1);
  assert.match(result.stderr, /cannot name a file/);
});
