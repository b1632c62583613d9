// node page.mjs [--pictures FOLDER] [--leading] REPORT.html...: what a person does with each page, at 1400 and at 390 px: it opens,
// nothing is said on the console, axe finds no violation, nothing is wider than the window; both tabs of the 3D view are
// drawn, the design can be shown; the deepest and the highest place of the part are those of metrics.json beside the page,
// within 0.1 um. At 1400 px also: a section in the plane of a wall shows no part of it; the tool stands over the work as
// blocks.csv says and the stock is cut in stages; each finding leads to its place, where its pin stands, to its line and the movie's second.
// --leading: each page has a finding that leads to a place, to a line and to the movie.
// FOLDER: for what was seen. Prints one line for each width; exits 1 on the first thing that is not so.
import assert from 'node:assert/strict';
import { existsSync, readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { dirname, join, resolve } from 'node:path';
import { pathToFileURL } from 'node:url';

const require = createRequire(join(process.env.SWARF_PAGE_MODULES, 'package.json'));
const { chromium } = require('playwright-core');
const axe = readFileSync(require.resolve('axe-core/axe.min.js'), 'utf8');

const words = process.argv.slice(2);
const pictures = words[0] === '--pictures' ? words.splice(0, 2)[1] : null;
const leading = words[0] === '--leading' && Boolean(words.shift());
const readLimitUm = 0.1, opensWithinMs = 2000, findingsVisited = 5, findingsVisitedNarrow = 2, pinsApartMm = 10;
const narrowPx = 500;  // a telephone: what follows from the models alone is looked at once
const wordsWithinPx = 100;  // at least
const drawnPixels = 0.25;  // for each pixel of the page: a processor draws the 3D view, and what is looked at is not its grain
const sectionsDiffer = 0.005;  // share of the picture: the rim moves by a part of a pixel
const cycleS = 1e-3;
const tipWithinMm = 0.2;  // keys of up to five axes, each within 0.02 mm or 0.0115 deg, and milliseconds in the slider

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

async function checkExtremes(page, metrics) {
  const surface = metrics?.surface;
  if (!surface?.samples || !(await page.getByRole('button', { name: 'Deepest' }).count())) return 'no deviations';
  const info = page.locator('.viewer-info'), read = [];
  for (const [button, expected] of [['Deepest', -surface.gouge_max_um], ['Highest', Math.max(surface.excess_max_um, surface.scallop_max_um)]]) {
    if (!(await page.getByRole('button', { name: button }).isVisible())) return 'nothing measured on the part';
    await page.getByRole('button', { name: button }).click();
    const value = numberAfter(await info.textContent(), button);
    read.push(`${button.toLowerCase()} ${value} um`);
    if (button === 'Deepest' && expected === 0) continue;  // nothing lies deeper: the mesh says how high the lowest is
    assert.ok(Math.abs(value - expected) <= readLimitUm, `${button}: the page says ${value} um, metrics.json ${expected}`);
  }
  return read.join(', ');
}

/** The design is hidden at first, and shown by its switch. */
async function checkDesign(page, metrics) {
  const design = page.getByRole('checkbox', { name: 'Design' });
  if (!metrics?.surface?.samples) return;
  assert.equal(await design.isChecked(), false);
  await design.check();
  await design.uncheck();
}

/** A section in the very plane of the part's top takes it away, all of it: as one a thousandth below. Where material is
 * left on the design, which may be that thin, the top is no plane. */
async function checkSection(page, metrics) {
  const topIsFlatUm = 1;
  if (metrics?.surface?.excess_max_um > topIsFlatUm) return;
  const at = page.getByLabel('Place of the section'), across = page.locator('select').filter({ hasText: 'across Z' });
  await across.selectOption('2');
  const shots = [];
  for (const share of [1, 0.999]) {
    await at.evaluate((element, value) => { element.value = value; element.dispatchEvent(new Event('input')); }, share);
    shots.push((await page.locator('#viewer canvas').screenshot()).toString('base64'));
  }
  await across.selectOption('');
  const differ = await page.evaluate(async (pngs) => {
    const [one, other] = await Promise.all(pngs.map(async (png) => {
      const bitmap = await createImageBitmap(new Blob([Uint8Array.from(atob(png), (c) => c.charCodeAt(0))], { type: 'image/png' }));
      const context = new OffscreenCanvas(bitmap.width, bitmap.height).getContext('2d');
      context.drawImage(bitmap, 0, 0);
      return context.getImageData(0, 0, bitmap.width, bitmap.height).data;
    }));
    return one.filter((value, k) => Math.abs(value - other[k]) > 24).length / one.length;
  }, shots);
  assert.ok(differ < sectionsDiffer, `a section in the plane of a wall: ${(100 * differ).toFixed(2)} % of the picture differ from one beside it`);
}

/** A click a little above the middle of the picture, where the visited place is: its pin is hit. */
async function checkPin(page, number, findings) {
  const box = await page.locator('#viewer canvas').boundingBox(), host = page.locator('#viewer');
  await host.evaluate((element) => { delete element.dataset.finding; });
  await page.mouse.click(box.x + box.width / 2, box.y + box.height / 2 - 6);
  await page.locator('#viewer[data-finding]').waitFor({ timeout: 5000 });
  const hit = Number(await host.getAttribute('data-finding')), at = findings[hit - 1].place, wanted = findings[number - 1].place;
  const apart = Math.hypot(...at.map((value, k) => value - wanted[k]));
  assert.ok(apart < pinsApartMm, `finding ${number}: the pin of ${hit} stands there, ${apart} mm away`);
}

async function checkFindings(page, visited) {
  const findings = await page.evaluate(() => JSON.parse(document.getElementById('findings-data')?.textContent ?? '[]'));
  const told = { part: 0, machine: 0, line: 0, movie: 0 };
  for (const [i, finding] of findings.slice(0, visited).entries()) {
    const show = page.locator(`#finding-${i + 1} button[data-show="view"]`);
    if (!(await show.count())) continue;
    await show.click();
    await page.locator(`#viewer[data-finding="${i + 1}"]`).waitFor();
    const tab = await page.locator('#viewer').getAttribute('data-tab');
    if (finding.place) assert.equal(tab, finding.in_machine ? 'machine' : 'part');
    if (finding.place) await checkPin(page, i + 1, findings);
    told[tab] += 1;
    assert.match(await page.locator('.viewer-info').textContent(), /^Finding \d+: /);
    if (finding.line) {
      assert.match(await page.locator('.viewer-program .at').textContent(), new RegExp(`^${finding.line}`));
      told.line += 1;
    }
    const video = page.locator('#movie video[data-even]');
    if (!(await video.count()) || finding.t_s === null) continue;
    await page.waitForFunction(() => document.querySelector('#movie video').readyState >= 1);
    const [at, wanted] = await video.evaluate((element, t_s) => {
      const { from_s, to_s } = JSON.parse(document.getElementById('program-data').textContent);
      return [element.currentTime, (element.duration * (t_s - from_s)) / (to_s - from_s)];
    }, finding.t_s);
    assert.ok(Math.abs(at - wanted) < 0.1, `finding ${i + 1}: the movie is at ${at} s, not at ${wanted}`);
    told.movie += 1;
  }
  if (leading) assert.ok(told.part + told.machine > 0 && told.line > 0 && told.movie > 0, `a finding leads to ${JSON.stringify(told)}`);
  return `${findings.length} findings, shown on the part ${told.part}, in the machine ${told.machine}, in the movie ${told.movie}`;
}

/** Rows of blocks.csv beside the page: ends of blocks. */
function blocksOf(file) {
  if (!existsSync(file)) return [];
  const [head, ...rows] = readFileSync(file, 'utf8').trim().split('\n').map((row) => row.split(','));
  return rows.map((row) => Object.fromEntries(head.map((name, k) => [name, Number(row[k])])));
}

/** The animation in three.js: the tool's tip over the work at ends of blocks, the stock in later and later stages. */
async function checkMachine(page, width, folder) {
  await page.getByRole('tab', { name: 'Machine' }).click();
  await tabShown(page, 'machine');
  const scrub = page.locator('.viewer-scrub'), host = page.locator('#viewer');
  await scrub.focus();
  await page.keyboard.press('ArrowRight');
  assert.match(await page.locator('.viewer-time').first().textContent(), /^[0-9.]+ of [0-9.]+ s/);
  const blocks = blocksOf(join(folder, 'blocks.csv')), from_s = await page.evaluate(() => JSON.parse(document.getElementById('program-data').textContent).from_s);
  let worst = 0;
  const stages = [];
  for (const share of [0.1, 0.6, 1]) {
    let nth = Math.round(share * (blocks.length - 1));
    if (!blocks.length) break;
    if (blocks[nth + 1] && blocks[nth + 1].tool !== blocks[nth].tool) nth += 1;  // at a tool change both stand there
    const block = blocks[nth];
    const scale = Number(await host.getAttribute('data-time-scale'));
    await scrub.evaluate((element, time) => { element.value = time; element.dispatchEvent(new Event('input')); }, share === 1 ? Number(await scrub.getAttribute('max')) : (block.t_s - from_s) / scale);
    const tip = (await page.locator('.viewer-tip').textContent()).replaceAll('\u2212', '-').match(/[XYZ] ([-0-9.]+)/g).map((word) => Number(word.slice(2)));
    const off = Math.hypot(...['x', 'y', 'z'].map((axis, k) => block[`tip_${axis}_mm`] - tip[k]));
    const cycle = (block.feed_mm_min / 60) * cycleS;  // a block that does not end in a stop ends within a cycle
    assert.ok(off < tipWithinMm + cycle, `line ${block.line}, ${block.t_s} s: the tip stands at ${tip}, ${off} mm away`);
    worst = Math.max(worst, off);
    stages.push((await host.getAttribute('data-stock')).replace(/^part.*/, 'stock_part'));
  }
  assert.deepEqual(stages, [...stages].sort(), 'stages of the stock');
  if (blocks.length) assert.equal(stages.at(-1), 'stock_part', 'the finished part at the end');
  if (pictures) await page.locator('#view').screenshot({ path: join(pictures, `machine_${width}.png`) });
  return `tip within ${worst.toFixed(3)} mm, ${new Set(stages).size} stages`;
}

/// On a narrow page words have room, and tables of words need no scrolling.
async function checkNarrow(page) {
  const squeezed = await page.evaluate((least) => [...document.querySelectorAll('.finding p, .stacks tbody td, .stacks tbody th')]
    .filter((cell) => cell.textContent.length > 20 && cell.getBoundingClientRect().width < least)
    .map((cell) => `${cell.getBoundingClientRect().width} px: ${cell.textContent.slice(0, 40)}`), wordsWithinPx);
  assert.deepEqual(squeezed, [], 'words without room');
  const scrolled = await page.evaluate(() => [...document.querySelectorAll('.stacks')].filter((table) => table.scrollWidth > table.clientWidth).map((table) => table.ariaLabel));
  assert.deepEqual(scrolled, [], 'tables that scroll');
}

async function checkAt(file, width) {
  const beside = join(dirname(resolve(file)), 'metrics.json');
  const metrics = existsSync(beside) ? JSON.parse(readFileSync(beside)) : null;
  const page = await browser.newPage({ viewport: { width, height: 900 }, deviceScaleFactor: pictures ? 1 : drawnPixels });
  const said = [];
  page.on('console', (message) => { if (['error', 'warning'].includes(message.type()) && !/GPU stall|GL Driver/.test(message.text())) said.push(message.text()); });
  page.on('pageerror', (error) => said.push(String(error)));
  const started = Date.now();
  await page.goto(pathToFileURL(resolve(file)).href, { waitUntil: 'load' });
  const opened = Date.now() - started;
  if (pictures) await page.screenshot({ path: join(pictures, `top_${width}.png`) });
  assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= window.innerWidth), `wider than ${width} px`);
  if (width <= narrowPx) await checkNarrow(page);
  const told = [];
  if (await page.locator('#viewer').count()) {
    await page.locator('#viewer').scrollIntoViewIfNeeded();
    await tabShown(page, 'part');
    told.push(await checkExtremes(page, metrics));
    await checkDesign(page, metrics);
    if (width > narrowPx) await checkSection(page, metrics);
    if (pictures) await page.locator('#view').screenshot({ path: join(pictures, `part_${width}.png`) });
    if (width > narrowPx && (await page.locator('#machine-glb').count())) told.push(await checkMachine(page, width, dirname(resolve(file))));
  }
  told.push(await checkFindings(page, width > narrowPx ? findingsVisited : findingsVisitedNarrow));
  if (pictures) await page.screenshot({ path: join(pictures, `page_${width}.png`), fullPage: true });
  await page.evaluate(axe);
  const { violations } = await page.evaluate(() => window.axe.run(document, { resultTypes: ['violations'] }));
  assert.deepEqual(violations.map((one) => `${one.id}: ${one.nodes.map((node) => node.html.slice(0, 160)).join(' | ')}`), []);
  assert.deepEqual(said, [], 'the console');
  assert.ok(opened < opensWithinMs || process.env.SWARF_PAGE_SLOW, `opens in ${opened} ms`);
  console.log(`${width} px: opens in ${opened} ms; ${told.join('; ')}; 0 violations, 0 console errors`);
  await page.close();
}

let current = '';
try {
  for (const file of words) for (const width of [1400, 390]) {
    current = `${file} at ${width} px`;
    await checkAt(file, width);
  }
} catch (problem) {
  console.error(`${current}: ${problem.message}`);
  process.exitCode = 1;
} finally {
  await browser.close();
}
