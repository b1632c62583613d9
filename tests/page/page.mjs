// node page.mjs REPORT.html [PICTURES]: what a person does with the page, at 1400 and at 390 px: it opens, nothing is said on the
// console, axe finds no violation, nothing is wider than the window; both tabs of the 3D view are drawn; the deepest and
// the highest place of the part are those of metrics.json beside the page, within 0.1 um; each finding leads to its
// place, its line and the movie's second. PICTURES: folder for what was seen. Prints one line for each width;
// exits 1 on the first thing that is not so.
import assert from 'node:assert/strict';
import { existsSync, readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { dirname, join, resolve } from 'node:path';
import { pathToFileURL } from 'node:url';

const require = createRequire(join(process.env.SWARF_PAGE_MODULES, 'package.json'));
const { chromium } = require('playwright-core');
const axe = readFileSync(require.resolve('axe-core/axe.min.js'), 'utf8');

const [file, pictures] = process.argv.slice(2);
const folder = dirname(resolve(file));
const metrics = existsSync(join(folder, 'metrics.json')) ? JSON.parse(readFileSync(join(folder, 'metrics.json'))) : null;
const readLimitUm = 0.1, opensWithinMs = 2000;

const browser = await chromium.launch({
  executablePath: '/usr/bin/chromium',
  args: ['--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'],
});

/** A number after a word in a status line; the minus sign is a typographic one. */
const numberAfter = (text, word) => Number(new RegExp(`${word}: ([\u2212+])([0-9.]+)`).exec(text).slice(1).join('').replace('\u2212', '-'));

async function tabShown(page, name) {
  await page.locator(`#viewer[data-tab="${name}"]`).waitFor({ timeout: 60_000 });
  assert.equal(await page.locator('.viewer-message').textContent(), '', `${name}: the model is shown`);
}

async function checkExtremes(page) {
  const surface = metrics?.surface;
  if (!surface?.samples || !(await page.getByRole('button', { name: 'Deepest' }).count())) return 'no deviations';
  const info = page.locator('.viewer-info'), read = [];
  for (const [button, expected] of [['Deepest', -surface.gouge_max_um], ['Highest', Math.max(surface.excess_max_um, surface.scallop_max_um)]]) {
    await page.getByRole('button', { name: button }).click();
    const value = numberAfter(await info.textContent(), button);
    if (button === 'Deepest' && expected === 0) continue;  // nothing lies deeper: the mesh says how high the lowest is
    assert.ok(Math.abs(value - expected) <= readLimitUm, `${button}: the page says ${value} um, metrics.json ${expected}`);
    read.push(`${button.toLowerCase()} ${value} um`);
  }
  return read.join(', ');
}

async function checkFindings(page) {
  const findings = await page.evaluate(() => JSON.parse(document.getElementById('findings-data')?.textContent ?? '[]'));
  for (const [i, finding] of findings.slice(0, 5).entries()) {
    const show = page.locator(`#finding-${i + 1} button[data-show="view"]`);
    if (!(await show.count())) continue;
    await show.click();
    await page.locator(`#viewer[data-finding="${i + 1}"]`).waitFor();
    assert.match(await page.locator('.viewer-info').textContent(), new RegExp(`^Finding ${i + 1}: `));
    if (finding.line) assert.match(await page.locator('.viewer-program .at').textContent(), new RegExp(`^${finding.line}`));
    const video = page.locator('#movie video[data-even]');
    if (!(await video.count()) || finding.t_s === null) continue;
    await page.waitForFunction(() => document.querySelector('#movie video').readyState >= 1);
    const [at, wanted] = await video.evaluate((element, t_s) => {
      const { from_s, to_s } = JSON.parse(document.getElementById('program-data').textContent);
      return [element.currentTime, (element.duration * (t_s - from_s)) / (to_s - from_s)];
    }, finding.t_s);
    assert.ok(Math.abs(at - wanted) < 0.1, `finding ${i + 1}: the movie is at ${at} s, not at ${wanted}`);
  }
  return `${findings.length} findings`;
}

async function checkMachine(page, width) {
  await page.getByRole('tab', { name: 'Machine' }).click();
  await tabShown(page, 'machine');
  await page.locator('.viewer-scrub').focus();
  await page.keyboard.press('ArrowRight');
  const time = await page.locator('.viewer-time').textContent();
  assert.match(time, /^[0-9.]+ of [0-9.]+ s/);
  if (pictures) await page.locator('#view').screenshot({ path: join(pictures, `machine_${width}.png`) });
}

async function checkAt(width) {
  const page = await browser.newPage({ viewport: { width, height: 900 } });
  const said = [];
  page.on('console', (message) => { if (['error', 'warning'].includes(message.type()) && !/GPU stall|GL Driver/.test(message.text())) said.push(message.text()); });
  page.on('pageerror', (error) => said.push(String(error)));
  const started = Date.now();
  await page.goto(pathToFileURL(resolve(file)).href, { waitUntil: 'load' });
  const opened = Date.now() - started;
  if (pictures) await page.screenshot({ path: join(pictures, `top_${width}.png`) });
  assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= window.innerWidth), `wider than ${width} px`);
  const told = [];
  if (await page.locator('#viewer').count()) {
    await page.locator('#viewer').scrollIntoViewIfNeeded();
    await tabShown(page, 'part');
    told.push(await checkExtremes(page));
    if (pictures) await page.locator('#view').screenshot({ path: join(pictures, `part_${width}.png`) });
    if (await page.locator('#machine-glb').count()) await checkMachine(page, width);
  }
  told.push(await checkFindings(page));
  if (pictures) await page.screenshot({ path: join(pictures, `page_${width}.png`), fullPage: true });
  await page.evaluate(axe);
  const { violations } = await page.evaluate(() => window.axe.run(document, { resultTypes: ['violations'] }));
  assert.deepEqual(violations.map((one) => `${one.id}: ${one.nodes.map((node) => node.html.slice(0, 160)).join(' | ')}`), []);
  assert.deepEqual(said, [], 'the console');
  assert.ok(opened < opensWithinMs || process.env.SWARF_PAGE_SLOW, `opens in ${opened} ms`);
  console.log(`${width} px: opens in ${opened} ms; ${told.join('; ')}; 0 violations, 0 console errors`);
  await page.close();
}

try {
  for (const width of [1400, 390]) await checkAt(width);
} catch (problem) {
  console.error(problem.message);
  process.exitCode = 1;
} finally {
  await browser.close();
}
