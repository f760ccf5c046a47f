// The page of `ctusim report` in a browser, as people use it: everything is drawn, answers to the pointer, to filters and
// to dragging, fits a phone, prints, and asks nobody for anything.
//   node browser_test.mjs REPORT_FOLDER PAGE CHROMIUM [SCREENSHOT_FOLDER]
import assert from 'node:assert/strict';
import { mkdtempSync, rmSync } from 'node:fs';
import { createRequire } from 'node:module';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';
import { pathToFileURL } from 'node:url';

const [libraries, page_file, chromium_path, screenshots] = process.argv.slice(2);
const { chromium } = createRequire(join(resolve(libraries), 'package.json'))('playwright-core');

const profile = mkdtempSync(join(tmpdir(), 'ctu_browser_'));
const browser = await chromium.launchPersistentContext(profile, {
  executablePath: chromium_path,
  headless: true,
  viewport: { width: 1280, height: 900 },
  args: ['--headless', '--no-sandbox', '--disable-gpu', '--disable-quic', '--no-first-run',
    '--disable-background-networking', '--disable-component-update', '--disable-sync'],
});

const complaints = [];
const page = browser.pages()[0] ?? await browser.newPage();
page.setDefaultTimeout(60_000);
page.on('console', (message) => { if (['error', 'warning'].includes(message.type())) complaints.push(message.text()); });
page.on('pageerror', (error) => complaints.push(String(error)));
page.on('request', (request) => {
  if (!/^(file|data|blob):/.test(request.url())) complaints.push(`asked for ${request.url()}`);
});

async function step(name, body) {
  await body();
  console.log(`ok: ${name}`);
}
const rows_of = (chart) => page.evaluate((id) => window.report.views.get(id).data('rows').length, chart);
const shown = () => page.textContent('#shown');
const picture = (name, of = page) => screenshots && of.screenshot({ path: join(screenshots, `${name}.png`) });
// Rows change a moment after the last change of a choice.
const until_rows = (chart, count) => page.waitForFunction(
  ([id, rows]) => window.report.views.get(id).data('rows').length === rows, [chart, count]);

try {
  await page.goto(pathToFileURL(resolve(page_file)).href);
  const all = await page.evaluate(() => JSON.parse(document.getElementById('rows-data').textContent).rows.length);
  const scenes = await page.evaluate(() => JSON.parse(document.getElementById('filters-data').textContent)[0]);

  await step('every plot is drawn', async () => {
    await page.waitForSelector('html[data-drawn]');
    const figures = page.locator('figure');
    assert.ok(await figures.count() >= 5);
    for (const figure of await figures.all()) {
      const id = await figure.getAttribute('id');
      const marks = await figure.locator('.plot svg .mark-symbol.marks path, .plot svg .mark-rect.marks path, .plot svg .mark-line path').count();
      const canvas = await figure.locator('.plot canvas').count();
      assert.ok(marks > 0 || canvas > 0, `nothing is drawn in ${id}`);
    }
    assert.match(await shown(), new RegExp(`^${all} of ${all} `));
    await picture('report');
  });

  const dots = page.locator('#pareto-bits .plot svg .layer_0_marks path');
  await step('the pointer over a point tells of it', async () => {
    await page.locator('#pareto-bits').scrollIntoViewIfNeeded();
    await dots.first().hover({ force: true });
    const tip = page.locator('#vg-tooltip-element.visible');
    await tip.waitFor();
    assert.match(await tip.textContent(), /cycles a ray/);
    await picture('report-hover', page.locator('#pareto-bits'));
  });

  await step('a click on a point tells how to run it again', async () => {
    await dots.first().click({ force: true });
    await page.locator('#point').waitFor();
    assert.match(await page.textContent('#point code'), /ctusim run .*\.ctut/);
    const file = await page.getAttribute('#point a[download]', 'href');
    assert.match(decodeURIComponent(file), /mask_test\.design = "/);
    assert.ok((await page.locator('#point dt').count()) > 10);
    await page.locator('#point button').click();
    assert.equal(await page.locator('#point').isVisible(), false);
  });

  await step('a filter takes rows out of every plot, and Show all brings them back', async () => {
    await page.locator('#filters summary').click();
    const box = page.locator(`#boxes input[data-field="${scenes.field}"]`).first();
    await box.uncheck();
    await page.waitForFunction((count) => !document.getElementById('shown').textContent.startsWith(`${count} `), all);
    const count = parseInt(await shown(), 10);
    assert.ok(count > 0 && count < all);
    for (const chart of ['pareto-bits', 'stages', 'rays']) await until_rows(chart, count);
    const names = await page.evaluate(() => window.report.chosen(null).map((row) => row.scene));
    assert.ok(!names.includes(scenes.values[0]));
    await picture('report-filter');
    await page.locator('#all').click();
    await until_rows('stages', all);
    assert.ok(await box.isChecked());
    await page.locator('#filters summary').click();
  });

  await step('dragging over points keeps only them elsewhere', async () => {
    await page.locator('#pareto-bits').scrollIntoViewIfNeeded();
    const area = await page.locator('#pareto-bits .plot svg .root > g > path.background').first().boundingBox();
    const heights = await dots.evaluateAll((list) => list.map((dot) => dot.getBoundingClientRect().y).sort((a, b) => a - b));
    await page.mouse.move(area.x + 8, heights[Math.floor(heights.length / 2)] - 1);
    await page.mouse.down();
    await page.mouse.move(area.x + area.width - 8, area.y + area.height - 8, { steps: 6 });
    await page.mouse.up();
    await page.waitForFunction((count) => !document.getElementById('shown').textContent.startsWith(`${count} `), all);
    const count = parseInt(await shown(), 10);
    assert.ok(count > 0 && count < all, `${count} of ${all}`);
    await until_rows('stages', count);
    assert.equal(await rows_of('pareto-bits'), all, 'the plot itself keeps its points');
    const kept = await page.evaluate(() => window.report.chosen(null).map((row) => row.cycles_per_ray));
    const left = await page.evaluate(() => window.report.chosen('pareto-bits').map((row) => row.cycles_per_ray));
    assert.ok(Math.max(...kept) < Math.max(...left), 'the slow ones are above what was dragged over');
    await picture('report-brush', page.locator('#pareto-bits'));
    await page.locator('#all').click();
    await until_rows('stages', all);
  });

  await step('the table behind a plot opens and is sorted by a click', async () => {
    await page.locator('#pareto-bits details.table summary').click();
    const lines = page.locator('#pareto-bits tbody tr');
    await lines.first().waitFor();
    assert.equal(await lines.count(), Math.min(all, 500));
    const numbers = async () => (await page.locator('#pareto-bits tbody tr').evaluateAll((list, index) =>
      list.map((line) => Number(line.cells[index].textContent.replaceAll(',', ''))), await column()));
    const column = () => page.locator('#pareto-bits th').evaluateAll(
      (list) => list.findIndex((cell) => cell.textContent.startsWith('cycles_per_ray')));
    const press = () => page.locator('#pareto-bits th button', { hasText: 'cycles_per_ray' }).click();
    await press();
    const up = await numbers();
    assert.deepEqual(up, [...up].sort((a, b) => a - b));
    await press();
    const down = await numbers();
    assert.deepEqual(down, [...down].sort((a, b) => b - a));
    assert.ok(down[0] > down[down.length - 1]);
  });

  await step('on a phone nothing is wider than the screen', async () => {
    await page.setViewportSize({ width: 375, height: 800 });
    await page.waitForFunction(() => [...document.querySelectorAll('.plot svg, .plot canvas')]
      .every((plot) => plot.getBoundingClientRect().right <= innerWidth));
    const [width, screen] = await page.evaluate(() => [document.documentElement.scrollWidth, innerWidth]);
    assert.ok(width <= screen, `${width} > ${screen}`);
    await page.evaluate(() => scrollTo(0, 0));
    await picture('report-phone');
  });

  await step('on paper there are the plots and not the controls', async () => {
    await page.setViewportSize({ width: 1280, height: 900 });
    await page.emulateMedia({ media: 'print' });
    assert.equal(await page.locator('#filters').isVisible(), false);
    for (const figure of await page.locator('figure .plot').all()) assert.ok(await figure.isVisible());
    const pdf = await page.pdf({ format: 'A4' });
    assert.ok(pdf.subarray(0, 5).toString() === '%PDF-' && pdf.length > 20_000);
  });

  assert.deepEqual(complaints, [], 'errors, warnings, or requests');
} finally {
  await browser.close();
  rmSync(profile, { recursive: true, force: true });
}
