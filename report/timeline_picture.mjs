// A picture of a stretch of a Kanata log, as SVG: for pages where a viewer cannot be opened.
//   node timeline_picture.mjs FILE.kanata OUT.svg FIRST_CYCLE LAST_CYCLE [CONTEXT...]
// Rows are visits, in the order in which they begin; visits that culling ended are pale. Contexts choose rays.
import { readFileSync, writeFileSync } from 'node:fs';
import * as vega from 'vega';
import * as vegaLite from 'vega-lite';

const [file, out, first, last, ...contexts] = process.argv.slice(2);
const ops = [];
let now = 0;
for (const line of readFileSync(file, 'utf8').split('\n')) {
  const [command, id, ...rest] = line.split('\t');
  const op = ops[id];
  if (command === 'C=') now = Number(id);
  else if (command === 'C') now += Number(id);
  else if (command === 'I') ops.push({ context: rest[1], label: '', stages: [], end: Infinity, pale: false });
  else if (command === 'L' && rest[0] === '0') op.label += rest[1];
  else if (command === 'S') op.stages.push({ stage: rest[1], begin: now, end: Infinity });
  else if (command === 'E') op.stages.at(-1).end = now;
  else if (command === 'R') Object.assign(op, { end: now, pale: rest[1] === '1' });
}
const [from, to] = [Number(first), Number(last)];
const rows = ops.filter((op) => op.stages[0].begin <= to && op.end > from && (contexts.length === 0 || contexts.includes(op.context)))
  .flatMap((op, row) => op.stages.map((stage) => ({
    row, label: op.label, stage: stage.stage, pale: op.pale, begin: Math.max(stage.begin, from), end: Math.min(stage.end, now, to + 1),
  }))).filter((bar) => bar.begin < bar.end);

const spec = {
  $schema: 'https://vega.github.io/schema/vega-lite/v6.json',
  width: 560, height: { step: 17 }, data: { values: rows },
  mark: { type: 'bar', height: 14 },
  encoding: {
    x: { field: 'begin', type: 'quantitative', scale: { domain: [from, to + 1] }, title: 'cycle' },
    x2: { field: 'end' },
    y: { field: 'row', type: 'ordinal', axis: null },
    color: { field: 'stage', type: 'nominal', title: null, sort: null, scale: { scheme: 'tableau20' }, legend: { orient: 'bottom', columns: 5 } },
    opacity: { condition: { test: 'datum.pale', value: 0.35 }, value: 1 },
  },
};
const labels = {
  mark: { type: 'text', align: 'right', x: -6, fontSize: 11 },
  encoding: { y: spec.encoding.y, text: { aggregate: 'max', field: 'label', type: 'nominal' } },
};
const { mark, encoding, ...common } = spec;
const layered = { ...common, background: 'white', padding: 8, autosize: 'pad', layer: [{ mark, encoding }, labels] };
const view = new vega.View(vega.parse(vegaLite.compile(layered).spec), { renderer: 'none' });
writeFileSync(out, await view.toSVG());
