// Every specification of a page compiles without a warning and draws marks over the page's rows; no browser is needed.
//   node specs_test.mjs REPORT_FOLDER PAGE
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { pathToFileURL } from 'node:url';

const [libraries, page_file] = process.argv.slice(2);
const library = (file) => import(pathToFileURL(join(resolve(libraries), 'node_modules', file)).href);
const vega = await library('vega/build/vega.module.js').catch(() => library('vega/build/vega.node.js'));
const vega_lite = await library('vega-lite/build/index.js');

const page = readFileSync(page_file, 'utf8');
const read = (id) => JSON.parse(page.match(new RegExp(`<script type="application/json" id="${id}-data">(.*)</script>`))[1]);
const { columns, rows: lists } = read('rows');
const rows = lists.map((list) => Object.fromEntries(list.map((value, i) => [columns[i].field, value]).filter(([, value]) => value !== null)));
assert.ok(rows.length > 0);
const known = new Set(columns.map((column) => column.field));

// The staircase of a Pareto plot holds exactly the rows that no other of their scene beats.
function check_front(chart, view) {
  const cost = chart.spec.layer[0].encoding.x.field;
  const beaten = (row) => rows.some((other) => other.scene === row.scene && other[cost] <= row[cost]
    && other.cycles_per_ray <= row.cycles_per_ray && (other[cost] < row[cost] || other.cycles_per_ray < row.cycles_per_ray));
  const key = (row) => `${row.scene} ${row[cost]} ${row.cycles_per_ray}`;
  const front = [...new Set(rows.filter((row) => row[cost] !== undefined && !beaten(row)).map(key))].sort();
  assert.ok(front.length > 0);
  const sets = Object.keys(view.getState({ data: () => true, signals: () => false }).data)
    .map((name) => view.data(name)).filter((list) => list.length > 0 && list.every((row) => 'fewest_before' in row));
  assert.ok(sets.some((list) => JSON.stringify([...new Set(list.map(key))].sort()) === JSON.stringify(front)),
    `${chart.id}: no data are the ${front.length} rows of the front, but ${sets.map((list) => list.length)}`);
}

for (const chart of read('charts')) {
  const said = [];
  const logger = { warn: (...text) => (said.push(text.join(' ')), logger), error: (...text) => (said.push(text.join(' ')), logger), info: () => logger, debug: () => logger, level: () => logger };
  const spec = { ...chart.spec, width: 400, data: { name: 'rows', values: (chart.rows ?? rows).map((row) => ({ ...row })) } };
  const { spec: compiled } = vega_lite.compile(spec, { logger });
  const view = new vega.View(vega.parse(compiled), { renderer: 'none', logger });
  const svg = await view.toSVG();
  const warnings = said.filter((text) => text !== 'Can not resolve event source: window');  // node has none
  assert.deepEqual(warnings, [], `${chart.id}: ${warnings}`);
  const marks = svg.match(/aria-roledescription="(point|symbol|bar|rect mark|rect|line mark|circle)"/g)?.length ?? 0;
  assert.ok(marks > 0, `${chart.id} draws nothing`);
  if (chart.rows === null)
    for (const field of chart.columns) assert.ok(known.has(field) || ['r', 'r_ray', 'lut_entries'].includes(field), `${chart.id}: ${field} is no column of the page`);
  if (chart.id.startsWith('pareto-')) check_front(chart, view);
  console.log(`ok: ${chart.id}, ${marks} marks`);
}
