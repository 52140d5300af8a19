// Is the page whole on a wide screen, on phones, in the dark and on paper? Takes pictures of each.
import { writeFileSync } from 'node:fs';

import { checkContrast } from './reading.mjs';

async function picture(tab, path) {
  const { cssContentSize: { width, height } } = await tab.call('Page.getLayoutMetrics');
  const { data } = await tab.call('Page.captureScreenshot', { captureBeyondViewport: true, clip: { x: 0, y: 0, width, height: Math.min(height, 16_000), scale: 1 } });
  writeFileSync(path, Buffer.from(data, 'base64'));
}

async function checkWidth(tab, width) {
  await tab.resize(width);
  const { wide, beyond, small } = await tab.ask((width) => {
    const scrolls = (one) => one.closest('.scroll, pre, .plot, .unseen, .skip');
    const beyond = [...document.body.querySelectorAll('*')].filter((one) => one.checkVisibility() && !scrolls(one.parentElement)
      && one.getBoundingClientRect().right > width + 1).map((one) => `${one.tagName.toLowerCase()}.${one.className}`);
    const small = [...document.querySelectorAll('button, input, summary, nav a')].filter((one) => one.checkVisibility())
      .map((one) => ({ words: one.textContent || one.id, box: one.getBoundingClientRect() }))
      .filter(({ box }) => box.height < 40 || box.width < 40).map(({ words }) => words.slice(0, 30));
    return { wide: document.documentElement.scrollWidth, beyond, small };
  }, width);
  if (wide > width) tab.blame(`at a width of ${width} the page is ${wide} wide`);
  if (beyond.length > 0) tab.blame(`at a width of ${width} there is more to the right: ${[...new Set(beyond)].slice(0, 4).join(', ')}`);
  if (width <= 640 && small.length > 0) tab.blame(`at a width of ${width} ${small.length} are too small for a finger: ${small.slice(0, 3).join(', ')}`);
  const fits = await tab.ask(() => [...document.querySelectorAll('.plot')].filter((plot) => plot.checkVisibility()
    && Math.abs(plot.querySelector('.main-svg').getBoundingClientRect().width - plot.clientWidth) > 2).map((plot) => plot.dataset.figure));
  if (fits.length > 0) tab.blame(`at a width of ${width} figures do not follow it: ${fits.join(', ')}`);
}

// Waits until all figures have the ground of the page (or for two seconds: then what they lack is said).
const followed = (tab) => tab.until(() => tab.ask(() => [...document.querySelectorAll('.plot .main-svg:first-of-type')]
  .every((svg) => getComputedStyle(svg).backgroundColor === getComputedStyle(document.body).backgroundColor)), 2000);

async function checkDark(tab) {
  await tab.media('screen', 'dark');
  await followed(tab);
  const grounds = await tab.ask(() => ({ page: getComputedStyle(document.body).backgroundColor,
    plots: [...document.querySelectorAll('.plot .main-svg:first-of-type')].map((svg) => getComputedStyle(svg).backgroundColor) }));
  const dark = (colour) => colour.match(/\d+/g).slice(0, 3).every((value) => Number(value) < 64);
  if (!dark(grounds.page)) tab.blame(`in the dark the page is ${grounds.page}`);
  if (!grounds.plots.every(dark)) tab.blame('in the dark figures stay light');
  await checkContrast(tab, 'in the dark');
}

async function checkPaper(tab, pictures) {
  await tab.media('print', 'dark');
  await followed(tab);
  const paper = await tab.ask(() => ({ ground: getComputedStyle(document.body).backgroundColor,
    tools: [...document.querySelectorAll('button, input, .skip')].filter((one) => one.checkVisibility()).length,
    shut: document.querySelectorAll('details:not([open])').length,
    wide: [...document.querySelectorAll('.plot .main-svg')].map((one) => one.getBoundingClientRect().width).filter((width) => width > 680).length,
    dark: [...document.querySelectorAll('.plot .main-svg:first-of-type')].filter((svg) => getComputedStyle(svg).backgroundColor !== 'rgb(255, 255, 255)').length }));
  if (paper.ground !== 'rgb(255, 255, 255)') tab.blame(`paper is ${paper.ground}`);
  if (paper.tools > 0) tab.blame(`${paper.tools} buttons are printed`);
  if (paper.shut > 0) tab.blame(`${paper.shut} details are not open on paper`);
  if (paper.wide > 0) tab.blame(`${paper.wide} figures are wider than paper`);
  if (paper.dark > 0) tab.blame(`${paper.dark} figures are dark on paper`);
  await checkContrast(tab, 'on paper');
  const { data } = await tab.call('Page.printToPDF', { printBackground: true, paperWidth: 8.27, paperHeight: 11.69 });
  const pdf = Buffer.from(data, 'base64');
  if (pdf.toString('latin1', 0, 5) !== '%PDF-') tab.blame('it cannot be printed');
  if (pictures) writeFileSync(`${pictures}.pdf`, pdf);
  await tab.media('', 'light');
  if (await tab.value('document.documentElement.classList.contains("print")')) tab.blame('after printing the page stays as on paper');
}

export async function checkSizes(tab, pictures) {
  for (const width of [480, 320, 1200]) {
    await checkWidth(tab, width);
    if (pictures) await picture(tab, `${pictures}-${width}.png`);
  }
  await checkContrast(tab, 'in the light');
  await checkDark(tab);
  if (pictures) await picture(tab, `${pictures}-dark.png`);
}

export { checkPaper };
