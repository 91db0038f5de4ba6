// Every specification of a page is valid Vega-Lite, and its controls set parameters that it has.
import assert from 'node:assert/strict';
import fs from 'node:fs';
import test from 'node:test';
import Ajv from 'ajv';

const page = fs.readFileSync(process.env.REPORT, 'utf8');
const elements = page.matchAll(/<script type="application\/json" data-(figure|dataset)="([^"]*)">(.*?)<\/script>/gs);
const figures = new Map();
const datasets = new Map();
for (const [, kind, name, text] of elements) (kind === 'figure' ? figures : datasets).set(name, JSON.parse(text));

const schema = JSON.parse(fs.readFileSync('node_modules/vega-lite/build/vega-lite-schema.json', 'utf8'));
const ajv = new Ajv({allowUnionTypes: true, strict: false, validateFormats: false, logger: false, verbose: false});
const validate = ajv.compile(schema);

function names(node, found = new Set()) {
  if (node === null || typeof node !== 'object') return found;
  if (node.data?.name !== undefined) found.add(node.data.name);
  Object.values(node).forEach((child) => names(child, found));
  return found;
}

// Of a union of types the schema complains about every member; the deepest complaint is the one to read.
function complaint(errors) {
  const depth = (error) => error.instancePath.split('/').length;
  const deepest = Math.max(...errors.map(depth));
  return errors.filter((error) => depth(error) === deepest).slice(0, 3)
    .map((error) => `${error.instancePath || '/'} ${error.message} ${JSON.stringify(error.params)}`).join('; ');
}

test('the page has figures', () => assert.ok(figures.size > 0));
test('the schema refuses nonsense', () => assert.equal(validate({mark: 'nonsense', data: {values: []}}), false));

for (const [id, spec] of figures)
  test(`figure ${id} is valid`, () => {
    assert.ok(validate(spec), validate.errors && complaint(validate.errors));
    for (const name of names(spec)) assert.ok(datasets.has(name), `no data set ${name}`);
    for (const control of spec.usermeta?.odobench?.controls ?? []) {
      const param = spec.params?.find((candidate) => candidate.name === control.param);
      assert.ok(param, `control of an unknown parameter ${control.param}`);
      assert.ok(control.options.some((option) => option.value === param.value), `${control.param} has a value that is no option`);
    }
  });

test('data sets have the columns that figures read', () => {
  for (const [id, spec] of figures) {
    const columns = new Set([...names(spec)].flatMap((name) => datasets.get(name).split(/\r?\n/, 1)[0].split(',')));
    const visit = (node) => {
      if (node === null || typeof node !== 'object') return;
      const parsed = Object.keys(node.format?.parse ?? {});  // figures of one kind may share a list that is longer than needed
      assert.ok(parsed.length === 0 || parsed.some((column) => columns.has(column)), `figure ${id}: none of the columns ${parsed}`);
      Object.values(node).forEach(visit);
    };
    visit(spec);
  }
});
