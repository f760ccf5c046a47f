// What the page does beyond drawing: rows are chosen by filters and by dragging over points, and all plots and tables
// show what is chosen; a point that is clicked tells how to run it again.
'use strict';

const read = (id) => JSON.parse(document.getElementById(`${id}-data`).textContent);
const element = (name, properties, ...children) => {
  const made = Object.assign(document.createElement(name), properties);
  made.append(...children);
  return made;
};

const { columns, rows: lists } = read('rows');
const charts = read('charts');
const filters = read('filters');
const columnOf = new Map(columns.map((column) => [column.field, column]));
const rows = lists.map((list) => {
  const row = {};
  list.forEach((value, i) => { if (value !== null) row[columns[i].field] = value; });
  return row;
});

const views = new Map();  // by the plot's name
const left = new Map(filters.map((filter) => [filter.field, new Set()]));  // values that are not ticked
let brush = null;  // { chart, ranges: [[field, least, most], ...] }

function passes(row, exceptChart) {
  for (const [field, values] of left) if (values.size && values.has(row[field])) return false;
  if (brush === null || brush.chart === exceptChart) return true;
  return brush.ranges.every(([field, least, most]) => row[field] >= least && row[field] <= most);
}
const chosen = (exceptChart) => rows.filter((row) => passes(row, exceptChart));

// Vega writes its own marks onto the rows it is given.
const copies = (list) => list.map((row) => ({ ...row }));

function format(value) {
  if (value === undefined) return '';
  if (typeof value !== 'number') return String(value);
  return Number.isInteger(value) ? value.toLocaleString('en') : String(Number(value.toPrecision(6)));
}

// ---- Tables

const kMostCells = 500;
function fillTable(chart) {
  const details = document.querySelector(`#${chart.id} details.table`);
  if (!details.open) return;
  const list = chart.rows ?? chosen(null);
  const fields = (chart.columns.length ? chart.columns : Object.keys(list[0] ?? {}))
    .filter((field) => list.some((row) => row[field] !== undefined));
  const { field: by, down } = chart.sort ?? {};
  const sorted = by === undefined ? list : [...list].sort((a, b) => {
    const order = typeof a[by] === 'number' && typeof b[by] === 'number'
      ? a[by] - b[by] : String(a[by] ?? '').localeCompare(String(b[by] ?? ''));
    return down ? -order : order;
  });
  const head = element('tr', {}, ...fields.map((field) => {
    const column = columnOf.get(field);
    const button = element('button', { type: 'button', title: column?.meaning ?? '', textContent: (column?.name ?? field) + (by === field ? (down ? ' ▼' : ' ▲') : '') });
    button.onclick = () => { chart.sort = { field, down: by === field && !down }; fillTable(chart); };
    return element('th', { scope: 'col' }, button);
  }));
  const body = sorted.slice(0, kMostCells).map((row) => {
    const line = element('tr', {}, ...fields.map((field) => element('td', { textContent: format(row[field]) })));
    if (row.id !== undefined) line.onclick = () => { location.hash = row.id; };
    return line;
  });
  const parts = [element('table', {}, element('thead', {}, head), element('tbody', {}, ...body))];
  if (sorted.length > kMostCells)
    parts.push(element('p', { textContent: `The first ${kMostCells} of ${sorted.length}; all of them are in results.csv.` }));
  details.querySelector('.cells').replaceChildren(...parts);
}

// ---- One run

function settingsOf(command) {
  return [...(command ?? '').matchAll(/--set (?:'([^']*)'|(\S+))/g)].map((found) => found[1] ?? found[2]);
}
function toml(settings) {
  return settings.map((setting) => {
    const [key, value] = [setting.slice(0, setting.indexOf('=')), setting.slice(setting.indexOf('=') + 1)];
    return `${key} = ${/^(true|false|-?[0-9.]+(e[-+]?[0-9]+)?)$/i.test(value) ? value : JSON.stringify(value)}\n`;
  }).join('');
}
function showPoint() {
  const panel = document.getElementById('point');
  const row = rows.find((one) => one.id === location.hash.slice(1));
  panel.hidden = row === undefined;
  if (row === undefined) return;
  const settings = settingsOf(row.command);
  const file = element('a', {
    textContent: 'configuration (TOML)', download: `${row.id}.toml`,
    href: `data:text/plain;charset=utf-8,${encodeURIComponent(toml(settings))}`,
  });
  const trace = element('a', { textContent: row.trace ?? '', href: row.trace ?? '' });
  const terms = columns.filter((column) => row[column.field] !== undefined
    && !/^(stage|ray_cycles)\./.test(column.name) && !['id', 'command', 'trace'].includes(column.name));
  const close = element('button', { type: 'button', textContent: 'Close', onclick: () => { location.hash = ''; } });
  panel.replaceChildren(
    element('h2', { textContent: `${row.scene}, ${row.design}: ${format(row.cycles_per_ray)} cycles a ray` }),
    element('p', {}, 'Trace: ', trace, ' · ', file),
    element('code', { textContent: row.command ?? '' }),
    element('details', {}, element('summary', { textContent: 'All its numbers' }),
      element('dl', {}, ...terms.flatMap((column) => [
        element('dt', { textContent: column.name, title: column.meaning }),
        element('dd', { textContent: `${format(row[column.field])} ${column.unit}` }),
      ]))),
    close,
  );
  panel.scrollIntoView({ block: 'nearest' });
}

// ---- Choice

let waiting = 0;
function changed() {
  clearTimeout(waiting);
  waiting = setTimeout(update, 120);
}
function count() {
  const shown = chosen(null).length;
  document.getElementById('shown').textContent = `${shown} of ${rows.length} runs shown`;
  document.getElementById('all').hidden = shown === rows.length;
}
async function update() {
  count();
  for (const chart of charts) {
    fillTable(chart);
    const view = views.get(chart.id);
    if (view !== undefined && chart.rows === null) await view.data('rows', copies(chosen(chart.id))).runAsync();
  }
}

function addFilters() {
  const places = filters.map((filter) => element('fieldset', {}, element('legend', { textContent: filter.title }),
    ...filter.values.map((value) => {
      const box = element('input', { type: 'checkbox', checked: true });
      box.dataset.field = filter.field;
      box.dataset.value = value;
      box.onchange = () => {
        left.get(filter.field)[box.checked ? 'delete' : 'add'](value);
        changed();
      };
      return element('label', {}, box, ` ${value}`);
    })));
  document.getElementById('boxes').append(...places);
  document.getElementById('filters').hidden = filters.length === 0;
  document.getElementById('all').onclick = () => {
    for (const values of left.values()) values.clear();
    for (const box of document.querySelectorAll('#boxes input')) box.checked = true;
    clearBrush();
    changed();
  };
}

// A plot's own mark of what was dragged over goes with it.
function clearBrush() {
  if (brush === null) return;
  const { chart } = brush;
  brush = null;
  const view = views.get(chart);
  view.signal('brush_x', [0, 0]).signal('brush_y', [0, 0]).run();
}

function watch(chart, view) {
  if (JSON.stringify(chart.spec).includes('"name":"brush"'))
    view.addSignalListener('brush', (_, value) => {
      const ranges = Object.entries(value ?? {}).filter(([, range]) => Array.isArray(range))
        .map(([field, range]) => [field.replaceAll('\\', ''), Math.min(...range), Math.max(...range)]);
      if (ranges.length === 0 && brush?.chart !== chart.id) return;
      if (ranges.length !== 0 && brush !== null && brush.chart !== chart.id) clearBrush();
      brush = ranges.length === 0 ? null : { chart: chart.id, ranges };
      changed();
    });
  view.addEventListener('click', (_, item) => {
    if (item?.datum?.id !== undefined) location.hash = item.datum.id;
  });
}

// Legends stand below the plot, in as many columns as are wide enough for most names.
const legendColumns = (place) => Math.max(1, Math.floor(place.clientWidth / 150));
async function draw(chart) {
  const place = document.querySelector(`#${chart.id} .plot`);
  chart.legendColumns = legendColumns(place);
  const style = {
    font: 'system-ui, sans-serif', axis: { titleFontWeight: 'normal' },
    legend: {
      orient: 'bottom', columns: chart.legendColumns, symbolLimit: 60, labelLimit: 140,
      layout: { bottom: { direction: 'vertical', anchor: 'start' } },
    },
  };
  views.get(chart.id)?.finalize();
  const spec = { ...chart.spec, data: { name: 'rows', values: copies(chart.rows ?? chosen(chart.id)) } };
  const { view } = await vegaEmbed(place, spec, {
    ast: true, renderer: chart.renderer, config: style, mode: 'vega-lite',
    actions: { export: true, source: false, compiled: false, editor: false },
  });
  views.set(chart.id, view);
  watch(chart, view);
  document.querySelector(`#${chart.id} details.table`).ontoggle = () => fillTable(chart);
}

// Vega makes plots as wide as their places by itself; legends are laid out anew here.
let turning = 0;
window.onresize = () => {
  clearTimeout(turning);
  turning = setTimeout(async () => {
    for (const chart of charts)
      if (legendColumns(document.querySelector(`#${chart.id} .plot`)) !== chart.legendColumns) await draw(chart);
  }, 150);
};

async function begin() {
  addFilters();
  window.onhashchange = showPoint;
  showPoint();
  count();
  for (const chart of charts) await draw(chart);
  document.documentElement.dataset.drawn = charts.length;
}
window.report = { views, chosen };  // for whoever asks in the browser's console
begin();
