// Do the sliders of the Nyquist plot say the right numbers? They are computed here once more, from the page's data.
import { wait } from './browser.mjs';

const times = ([a, b], [c, d]) => [a * c - b * d, a * d + b * c];
const over = ([a, b], [c, d]) => times([a, b], [c / (c * c + d * d), -d / (c * c + d * d)]);

// N at an amplitude of the family; between two of its frequencies linear in ω.
function gain(data, a, w) {
  const N = (one) => over([-1, 0], [one.re[a], one.im[a]]);
  const { members } = data.family;
  if (members.length === 1) return N(members[0]);
  const above = members.findIndex((one) => one.w >= w * (1 - 1e-6));
  if (Math.abs(members[above].w - w) <= 1e-6 * w) return N(members[above]);
  const [low, high] = [members[above - 1], members[above]], share = (w - low.w) / (high.w - low.w);
  const [below, beyond] = [N(low), N(high)];
  return [below[0] + share * (beyond[0] - below[0]), below[1] + share * (beyond[1] - below[1])];
}

const close = (a, b, tolerance) => Math.abs(a - b) <= tolerance * Math.max(Math.abs(b), 1e-12);
const read = (text) => Number(text.replaceAll('−', '-').replace(/\s/g, ''));

// "a + bj" of the readout after a name
function complexIn(text, name) {
  const found = text.match(new RegExp(`${name} = (−?[\\d.e-]+) ([+−]) ([\\d.e-]+)j`));
  return found ? [read(found[1]), (found[2] === '+' ? 1 : -1) * read(found[3])] : [NaN, NaN];
}

async function checkAt(tab, data, w, a) {
  const seen = await tab.ask((w, a) => {
    for (const [id, value] of [['nyquist-w', w], ['nyquist-a', a]]) {
      const input = document.getElementById(id);
      input.value = value;
      input.dispatchEvent(new Event('input', { bubbles: true }));
    }
    const plot = document.querySelector('.plot[data-figure=nyquist]'), mark = plot.data.find((trace) => trace.name === 'at the sliders');
    return { text: document.getElementById('readout-nyquist').textContent, x: mark.x, y: mark.y, G: plot.calcdata.length,
      words: document.getElementById('nyquist-w').getAttribute('aria-valuetext') };
  }, w, a);
  const G = [data.G.re[w], data.G.im[w]], N = gain(data, a, data.G.w[w]), inverse = over([-1, 0], N), NG = times(N, G);
  const distance = [1 + NG[0], NG[1]], size = Math.hypot(...distance), where = `sliders at ${w}, ${a}`;
  const expect = (name, found, right) => {
    const scale = Math.hypot(...right);
    if (!found.every((value, i) => Math.abs(value - right[i]) <= 1e-3 * Math.abs(right[i]) + 1e-9 * scale + 1e-12))
      tab.blame(`${where}: ${name} is said to be ${found}, is ${right}: '${seen.text}'`);
  };
  if (G.concat(N).some((value) => value === null || !Number.isFinite(value))) return;
  expect('G', complexIn(seen.text, ' G'), G);
  expect('-1/N', complexIn(seen.text, '−1/N'), inverse);
  const rounding = 2e-3 * (1 + Math.hypot(...NG));
  const said = complexIn(seen.text, 'N G');
  if (Math.hypot(said[0] - distance[0], said[1] - distance[1]) > rounding) tab.blame(`${where}: 1 + N G is said to be ${said}, is ${distance}`);
  const saidSize = read(seen.text.match(/of size (?:less than )?([\d.e-]*\d)/)?.[1] ?? 'nothing');
  if (!(Math.abs(saidSize - size) <= rounding)) tab.blame(`${where}: its size is said to be ${saidSize}, is ${size}`);
  if (!close(read(seen.text.match(/ω = ([\d.e-]+) rad/)?.[1] ?? ''), data.G.w[w], 1e-3)) tab.blame(`${where}: wrong frequency: '${seen.text}'`);
  if (!close(read(seen.text.match(/A = ([\d.e-]+)/)?.[1] ?? ''), data.family.A[a], 1e-3)) tab.blame(`${where}: wrong amplitude: '${seen.text}'`);
  if (![[seen.x[0], G[0]], [seen.y[0], G[1]], [seen.x[1], inverse[0]], [seen.y[1], inverse[1]]].every(([x, right]) => close(x, right, 1e-5)))
    tab.blame(`${where}: the marks stand at ${seen.x}; ${seen.y}`);
  if (!seen.words.includes('rad/s')) tab.blame(`${where}: the slider says '${seen.words}'`);
}

export async function checkSliders(tab) {
  const data = await tab.ask(() => {
    if (!document.querySelector('.plot[data-figure=nyquist]')) return null;
    return JSON.parse(document.getElementById('data-nyquist').textContent);
  });
  if (!data) return 0;
  if (await tab.value('document.querySelectorAll(".sliders input[type=range]").length') < 2) {
    tab.blame('the Nyquist plot has no sliders');
    return 0;
  }
  const [nw, na] = [data.G.w.length, data.family.A.length];
  for (const [w, a] of [[0, 0], [Math.floor(0.27 * nw), na >> 1], [Math.floor(0.56 * nw), na - 2], [nw - 1, na >> 2]]) await checkAt(tab, data, w, a);

  await wait(600);  // what is announced waits until the slider rests
  const spoken = await tab.ask(() => [document.querySelector('.sliders [aria-live=polite]').textContent, document.getElementById('readout-nyquist').textContent]);
  if (spoken[0] !== spoken[1]) tab.blame(`announced: '${spoken[0]}', shown: '${spoken[1]}'`);
  const before = await tab.ask(() => { const one = document.getElementById('nyquist-w'); one.focus(); one.value = 3; one.dispatchEvent(new Event('input')); return document.getElementById('readout-nyquist').textContent; });
  await tab.press('ArrowRight', 'ArrowRight', 39);
  const [value, after] = await tab.ask(() => [document.getElementById('nyquist-w').value, document.getElementById('readout-nyquist').textContent]);
  if (value !== '4' || before === after) tab.blame(`an arrow moves the slider from 3 to ${value}`);

  if (data.roots.length > 0 && !data.small_motions) {
    const size = await tab.ask(() => {
      [...document.querySelectorAll('.sliders button')].find((one) => one.textContent.startsWith('Prediction')).click();
      return Number(document.getElementById('readout-nyquist').dataset.distance);
    });
    if (!(size < 0.02)) tab.blame(`at the prediction |1 + N G| is ${size}`);
  }
  const polar = await tab.ask(() => {
    const one = [...document.querySelectorAll('.sliders button')].find((each) => each.textContent === 'Gain and phase');
    one.click();
    const plot = document.querySelector('.plot[data-figure=nyquist]'), x = plot.data.find((trace) => trace.name === 'G(jω)');
    const found = { pressed: one.getAttribute('aria-pressed'), type: plot._fullLayout.yaxis.type, x: x.x.slice(0, 50), y: x.y.slice(0, 50) };
    one.click();
    return found;
  });
  const wrong = polar.x.some((phase, i) => phase !== null && (!close(polar.y[i], Math.hypot(data.G.re[i], data.G.im[i]), 1e-9)
    || Math.abs(Math.sin(phase * Math.PI / 180) - data.G.im[i] / polar.y[i]) > 1e-9));
  if (wrong || polar.pressed !== 'true' || polar.type !== 'log') tab.blame('gain and phase of G are not those of its data');
  return 2;
}
