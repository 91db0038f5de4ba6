// Draws Vega-Lite specifications as SVG files in the colours of print, without browser and canvas.
//
//   node render_svg.js FOLDER [SPECS.json]      SPECS.json (or standard input): [{"id": "path.line_x", "spec": {..}}, ..]
//
// vega.min.js, vega-lite.min.js and theme.js are expected beside this file. FOLDER/ID.svg is complete or not there.
'use strict';
const fs = require('node:fs');
const path = require('node:path');
const vm = require('node:vm');

for (const name of ['vega.min.js', 'vega-lite.min.js', 'theme.js'])
  vm.runInThisContext(fs.readFileSync(path.join(__dirname, name), 'utf8'), {filename: name});
const {vega, vegaLite, odobenchTheme} = globalThis;

// Without a canvas nothing measures text. These widths, in hundredths of the font size, are those of DejaVu Sans, the widest
// font that a viewer is likely to fall back on: text never takes more than the room made for it.
const widths = {i: 28, j: 28, l: 28, I: 30, "'": 28, '.': 32, ',': 32, ':': 34, ';': 34, '|': 34, ' ': 32, f: 35, t: 39, r: 41,
  '(': 39, ')': 39, '[': 39, ']': 39, '-': 36, '/': 34, J: 30, m: 97, w: 82, M: 86, W: 99, '%': 95, '@': 100, '+': 84, '=': 84,
  '−': 84, s: 52, c: 55, k: 58, x: 59, v: 59, y: 59, z: 53};
function textWidth(item, text) {
  let sum = 0;
  for (const letter of String(text ?? '')) sum += widths[letter] ?? (letter >= 'A' && letter <= 'Z' ? 72 : 63);
  return sum / 100 * (item.fontSize ?? 11) * (item.fontWeight >= 600 || item.fontWeight === 'bold' ? 1.1 : 1);
}
vega.textMetrics.width = textWidth;

async function draw(spec) {
  const width = 660;
  const logger = vega.logger(vega.Error);
  let view = null;
  for (let layout = odobenchTheme.firstLayout; layout; layout = odobenchTheme.betterLayout(view, width, layout)) {
    const compiled = vegaLite.compile(spec, {config: odobenchTheme.config('print', width, layout), logger}).spec;
    view = await new vega.View(vega.parse(compiled), {renderer: 'none', logLevel: vega.Error}).runAsync();
  }
  const svg = await view.toSVG();
  if (svg.includes('NaN')) throw new Error('the drawing has coordinates that are not numbers');
  return svg;
}

async function main() {
  const [folder, list] = process.argv.slice(2);
  for (const {id, spec} of JSON.parse(fs.readFileSync(list ?? 0, 'utf8'))) {
    if (!/^[A-Za-z0-9_.-]+$/.test(id) || /^\.+$/.test(id)) throw new Error(`'${id}' cannot name a file`);
    const file = path.join(folder, `${id}.svg`);
    const temporary = `${file}.${process.pid}.part`;
    try {
      fs.writeFileSync(temporary, `${await draw(spec)}\n`);
      fs.renameSync(temporary, file);
    } catch (error) {
      fs.rmSync(temporary, {force: true});
      throw new Error(`figure ${id}: ${error.message}`);
    }
  }
}
main().catch((error) => {
  process.stderr.write(`${error.message}\n`);
  process.exitCode = 1;
});
