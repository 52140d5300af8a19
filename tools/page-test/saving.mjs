// Do the buttons save what they name: pictures that open, black on white, and tables with all their rows?
import { parseCsv, parsePng } from './files.mjs';

const luminance = ([r, g, b]) => 0.2126 * r + 0.7152 * g + 0.0722 * b;

// How many rows the CSV of a figure has without its headings, counted in the data; null: not known here.
function rowsOf(id, d) {
  const length = (list) => list.length, sum = (list) => list.reduce((a, b) => a + b, 0);
  if (id.startsWith('work-')) return sum(d.series.map((one) => length(one.x)));
  switch (id) {
    case 'nyquist': return length(d.G.w) + sum(d.family.members.map((one) => length(one.re))) + length(d.roots) + length(d.discs);
    case 'time': case 'loop': return length(d.run.t);
    case 'phase': return sum(d.cycles.concat(d.runs).map((one) => length(one.t)));
    case 'multipliers': return sum(d.cycles.map((one) => length(one.re)));
    case 'harmonics': return length(d.order) * length(d.curves);
    default: return null;
  }
}

const numbersIn = (value) => typeof value === 'number' ? [value] : value && typeof value === 'object' ? Object.values(value).flatMap(numbersIn) : [];

function checkPng(tab, name, content) {
  const png = parsePng(content);
  if (png.width < 1000) tab.blame(`${name}: only ${png.width} pixels wide`);
  if (png.at(1, 1).some((value) => value !== 255)) tab.blame(`${name}: its ground is ${png.at(1, 1)}, not white`);
  let dark = 0;
  for (let y = 0; y < png.height; y += 2) for (let x = 0; x < png.width; x += 2) if (luminance(png.at(x, y)) < 160) ++dark;
  if (dark < 200) tab.blame(`${name}: hardly anything dark on its white: ${dark} pixels`);
}

async function checkSvg(tab, name, content) {
  const text = content.toString('utf8');
  if (!text.startsWith('<svg') || !text.includes('http://www.w3.org/2000/svg')) tab.blame(`${name}: no SVG`);
  const found = await tab.ask((text) => {
    const read = new DOMParser().parseFromString(text, 'image/svg+xml');
    return { wrong: read.querySelector('parsererror')?.textContent, words: read.querySelectorAll('text').length,
      shapes: read.querySelectorAll('path, rect, circle, line').length };
  }, text);
  if (found.wrong) tab.blame(`${name}: ${found.wrong}`);
  if (found.words < 2 || found.shapes < 4) tab.blame(`${name}: ${found.shapes} shapes, ${found.words} words`);
}

async function checkCsv(tab, name, content, button) {
  const rows = parseCsv(content.toString('utf8')), wide = rows[0]?.length ?? 0;
  if (rows.some((row) => row.length !== wide)) tab.blame(`${name}: rows of different length`);
  const from = await tab.ask((i) => {
    const button = [...document.querySelectorAll('.tools button')][i], tools = button.closest('.tools');
    const plot = tools.closest('figure')?.querySelector('.plot');
    if (plot) return { id: plot.dataset.figure, data: JSON.parse(document.getElementById('data-' + plot.dataset.figure).textContent) };
    const rows = tools.closest('figure')?.querySelector('script.rows');
    if (rows) return { text: JSON.parse(rows.textContent) };
    const near = tools.previousElementSibling, table = near.matches('table') ? near : near.querySelector('table');
    return { cells: [...table.querySelectorAll('tr')].map((row) => [...row.children].map((cell) => cell.textContent.trim())) };
  }, button);
  if (from.cells) {
    if (JSON.stringify(from.cells) !== JSON.stringify(rows)) tab.blame(`${name}: other cells than the table`);
    return;
  }
  if (from.text !== undefined) {
    if (from.text !== content.toString('utf8') || rows.length < 2) tab.blame(`${name}: other rows than the page holds`);
    return;
  }
  const right = rowsOf(from.id, from.data);
  if (right !== null && rows.length - 1 !== right) tab.blame(`${name}: ${rows.length - 1} rows, the data has ${right}`);
  const held = new Set(numbersIn(from.data).map(String)), saved = rows.slice(1).flat().filter((cell) => cell !== '' && !Number.isNaN(Number(cell)));
  if (saved.length < 2 || !saved.every((cell) => held.has(cell))) tab.blame(`${name}: numbers that the data does not hold`);
}

// In the dark: what is saved is to be light all the same.
export async function checkSaving(tab) {
  await tab.media('screen', 'dark');
  const buttons = await tab.ask(() => [...document.querySelectorAll('.tools button')].map((one, i) => ({ i, kind: one.textContent,
    of: one.closest('.tools').getAttribute('aria-label') })).filter((one) => ['SVG', 'PNG', 'CSV', 'JSON'].includes(one.kind)));
  const owed = await tab.ask(() => ({ plots: document.querySelectorAll('.plot').length, tables: document.querySelectorAll('main table').length,
    pictures: [...document.querySelectorAll('main svg[role=img]')].filter((svg) => !svg.closest('.plot')).length,
    rows: document.querySelectorAll('figure script.rows').length, result: document.querySelectorAll('#result').length }));
  for (const [kind, right] of [['SVG', owed.plots + owed.pictures], ['PNG', owed.plots + owed.pictures], ['CSV', owed.plots + owed.rows + owed.tables], ['JSON', owed.result]]) {
    const there = buttons.filter((one) => one.kind === kind).length;
    if (there !== right) tab.blame(`${there} buttons ${kind}, ${right} are due`);
  }
  const tables = buttons.filter((one) => one.of.startsWith('Table')).map((one) => one.i);
  const tried = buttons.filter((one) => !tables.includes(one.i) || tables.indexOf(one.i) < 3);  // of many tables the first
  for (const { i, kind, of } of tried) {
    const file = await tab.savedBy(() => tab.ask((i) => document.querySelectorAll('.tools button')[i].click(), i));
    const name = `${kind} of ${of}`;
    if (!file) { tab.blame(`${name}: nothing was saved`); break; }
    if (!new RegExp(`^[a-z0-9-]+\\.${kind.toLowerCase()}$`).test(file.name)) tab.blame(`${name}: saved as '${file.name}'`);
    try {
      if (kind === 'PNG') checkPng(tab, name, file.content);
      else if (kind === 'SVG') await checkSvg(tab, name, file.content);
      else if (kind === 'CSV') await checkCsv(tab, name, file.content, i);
      else if (JSON.parse(file.content.toString('utf8')).schema !== 'limcycle/1') tab.blame(`${name}: another schema`);
    } catch (error) {
      tab.blame(`${name}: ${error.message}`);
    }
  }
  return tried.length;
}
