// Ways to break a page, the check that must find it and what it must say: a test of the test.
import { mkdtempSync, readFileSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

const inBody = (markup) => (page) => page.replace('</main>', `${markup}</main>`);
const inHead = (markup) => (page) => page.replace('</head>', `${markup}</head>`);
const instead = (old, fresh) => (page) => page.replace(old, fresh);
const open = (page) => page.replace(/<meta http-equiv="Content-Security-Policy"[^>]*>/, '');

const nothing = '{"run":{"t":[0,1],"y":[null,null],"stuck":[0,0]},"labels":{"y":"y"},"name":"","repeat":false}';

const ways = [
  ['an error', 'drawn', inBody('<script>throw new Error("broken")</script>'), 'exception: Error: broken'],
  ['a message of an error', 'drawn', inBody('<script>console.error("broken")</script>'), 'console: broken'],
  ['a picture from elsewhere', 'drawn', (page) => inBody('<img alt="x" src="http://127.0.0.1:9/x.png">')(open(page)), 'request: http://127.0.0.1:9/x.png'],
  ['a picture that the policy forbids', 'drawn', inBody('<img alt="x" src="http://127.0.0.1:9/x.png">'), 'browser: '],
  ['a figure without its data', 'drawn', instead(/id="data-phase"/, 'id="data-lost"'), 'figures drawn, as the page says'],
  ['a figure without curves', 'drawn', instead(/id="data-time">[^<]*/, `id="data-time">${nothing}`), 'hold curves'],
  ['a figure without words', 'drawn', instead(/<figcaption>[^<]*/, '<figcaption>A figure.'), 'says little'],
  ['an empty picture', 'drawn', inBody('<figure><svg role="img" aria-label="An empty picture"></svg></figure>'), 'is empty'],
  ['a wrong distance', 'sliders', instead('[1 + NG[0]', '[2 + NG[0]'), '1 + N G is said to be'],
  ['a wrong interpolation', 'sliders', instead('(w - low.w) / (high.w - low.w)', '0.5'), '-1/N is said to be'],
  ['an announcement that never comes', 'sliders', instead('spoken.textContent = said.text', 'spoken.textContent = ""'), 'announced: '],
  ['a file that is not saved', 'saving', instead('  link.click();', ''), 'nothing was saved'],
  ['a table saved with semicolons', 'saving', instead('row.map(cell).join(",")', 'row.map(cell).join(";")'), 'CSV of'],
  ['rows that are lost', 'saving', instead('join(",")).join(', 'join(",")).slice(0, -1).join('), 'CSV of'],
  ['a dark picture on a dark ground', 'saving', instead('root.classList.add("print");\n  try', 'try'), 'its ground is'],
  ['a trap for the keyboard', 'keyboard', inBody('<script>document.addEventListener("keydown",(e)=>{if(e.key==="Tab"&&document.activeElement.matches(".plot"))e.preventDefault()})</script>'), 'Tab does not reach'],
  ['a focus that is not seen', 'keyboard', inHead('<style>:focus-visible{outline:none!important}</style>'), 'the focus is not seen'],
  ['a button without a name', 'names', inBody('<button type="button" style="width:60px;height:60px"></button>'), 'a button has no name'],
  ['a heading too deep', 'names', inBody('<h2>A</h2><h4>B</h4>'), 'jumps from level 2 to 4'],
  ['a second title', 'names', inBody('<h1>Another</h1>'), 'headings of level 1: 2'],
  ['a table without a caption', 'names', instead(/<caption><span>[^<]*/, '<caption><span>'), 'has no caption'],
  ['words too faint', 'sizes', inHead('<style>:root{--soft:#b0b4b8!important}</style>'), 'in the light: too little contrast'],
  ['words too faint in the dark', 'sizes', inHead('<style>@media (prefers-color-scheme: dark){:root{--soft:#4a5058!important}}</style>'), 'in the dark: too little contrast'],
  ['curves too faint', 'sizes', inHead('<style>:root{--one:#c0d8f0!important}</style>'), 'curve of'],
  ['something wide', 'sizes', inBody('<div style="width:1500px">wide</div>'), 'at a width of 320 the page is'],
  ['buttons too small', 'sizes', inHead('<style>button{min-height:1.4rem!important}</style>'), 'too small for a finger'],
  ['buttons on paper', 'paper', inHead('<style>@media print{.tools{display:flex!important}}</style>'), 'buttons are printed'],
  ['figures that stay light', 'sizes', instead('addEventListener("change", drawAll);', 'addEventListener("never", drawAll);'), 'in the dark figures stay light'],
  ['figures that stay wide', 'sizes', instead('waiting = setTimeout(drawAll, 100);', ''), 'figures do not follow it'],
  ['a figure moved by no key', 'keyboard', instead('plot.onkeydown = keys;', ''), "does not change a figure's view"],
];

export function breakages(page) {
  const whole = readFileSync(page, 'utf8'), folder = mkdtempSync(join(tmpdir(), 'limcycle-broken-'));
  return ways.map(([name, check, act, expected], i) => {
    const broken = act(whole), path = join(folder, `${i}.html`);
    if (broken === whole) throw new Error(`'${name}' breaks nothing: the page has changed`);
    writeFileSync(path, broken);
    return { name, path, check, expected };
  });
}
