// Opens a report page in headless Chromium, over its debugging pipe, and says whether it is whole:
// no error on the console, no request to anywhere, every figure drawn. Takes a picture at two widths.
//   node tools/page.mjs CHROMIUM PAGE.html PICTURES
import { spawn } from 'node:child_process';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';
import { pathToFileURL } from 'node:url';

const [chromium, page, pictures] = process.argv.slice(2);
const patience = 60_000;  // ms for the page to draw itself
const profile = mkdtempSync(join(tmpdir(), 'limcycle-page-'));
const browser = spawn(chromium, [
  '--headless', '--no-sandbox', '--disable-gpu', '--disable-dev-shm-usage', '--no-first-run',
  '--disable-background-networking', '--disable-component-update', '--disable-sync', '--remote-debugging-pipe',
  `--user-data-dir=${profile}`, 'about:blank',
], { stdio: ['ignore', 'ignore', 'pipe', 'pipe', 'pipe'] });

let said = '';
browser.stderr.on('data', (data) => { said += data; });
const answers = new Map();  // request id -> promise's ends
const listeners = new Map();  // event -> function
let last = 0;
let rest = '';

function send(method, params = {}, sessionId) {
  browser.stdio[3].write(JSON.stringify({ id: ++last, method, params, sessionId }) + '\0');
  return new Promise((answer, refuse) => answers.set(last, { answer, refuse }));
}

browser.stdio[4].setEncoding('utf8').on('data', (data) => {
  const messages = (rest + data).split('\0');
  rest = messages.pop();
  for (const message of messages.map((text) => JSON.parse(text))) {
    if (message.id === undefined) listeners.get(message.method)?.(message.params);
    else if (message.error) answers.get(message.id).refuse(new Error(message.error.message));
    else answers.get(message.id).answer(message.result);
  }
});

const problems = [];
const wait = (ms) => new Promise((done) => setTimeout(done, ms));

async function look() {
  const url = pathToFileURL(resolve(page)).href;
  const { targetId } = await send('Target.createTarget', { url: 'about:blank' });
  const { sessionId } = await send('Target.attachToTarget', { targetId, flatten: true });
  const call = (method, params) => send(method, params, sessionId);
  const value = async (expression) => {
    const { result } = await call('Runtime.evaluate', { expression, returnByValue: true });
    return result.value;
  };
  const show = async (width) => {
    await call('Emulation.setDeviceMetricsOverride', { width, height: 900, deviceScaleFactor: 1, mobile: false });
    await wait(500);  // figures follow the width
    const wide = await value('document.documentElement.scrollWidth');
    if (wide > width) problems.push(`at a width of ${width} the page is ${wide} wide`);
    const { data } = await call('Page.captureScreenshot', { captureBeyondViewport: true });
    writeFileSync(`${pictures}-${width}.png`, Buffer.from(data, 'base64'));
  };

  listeners.set('Runtime.consoleAPICalled', ({ type, args }) => {
    if (type === 'error' || type === 'assert') problems.push(`console: ${args.map((a) => a.value ?? a.description).join(' ')}`);
  });
  listeners.set('Runtime.exceptionThrown', ({ exceptionDetails: e }) => {
    problems.push(`exception: ${e.exception?.description ?? e.text}`);
  });
  listeners.set('Log.entryAdded', ({ entry }) => {
    if (entry.level === 'error') problems.push(`browser: ${entry.text} ${entry.url ?? ''}`);
  });
  listeners.set('Network.requestWillBeSent', ({ request }) => {
    if (request.url.split('#')[0] !== url && !/^(data|blob):/.test(request.url)) problems.push(`request: ${request.url.slice(0, 200)}`);
  });
  listeners.set('Network.webSocketCreated', ({ url: to }) => problems.push(`request: ${to}`));
  for (const domain of ['Runtime', 'Log', 'Network', 'Page']) await call(`${domain}.enable`);
  await call('Page.navigate', { url });

  // The page itself counts its figures ("drawn/total") and its errors; the drawings are counted here once more.
  let figures;
  const end = Date.now() + patience;
  do {
    await wait(200);
    figures = (await value('document.documentElement.dataset.figures')) ?? '';
  } while (!(/^(\d+)\/\1$/.test(figures)) && Date.now() < end && problems.length === 0);
  const drawn = await value(`[...document.querySelectorAll('.js-plotly-plot')]
    .filter((figure) => figure.querySelector('.main-svg .trace path[d], .main-svg .trace image, .main-svg .hm image')).length`);
  const errors = await value('document.documentElement.dataset.errors');
  if (!/^([1-9]\d*)\/\1$/.test(figures)) problems.push(`figures drawn, as the page says: '${figures}'`);
  else if (drawn !== Number(figures.split('/')[0])) problems.push(`the page says ${figures} figures, ${drawn} hold curves`);
  if (errors !== '0') problems.push(`errors, as the page says: '${errors}'`);
  await show(1200);
  await show(480);
  return figures;
}

browser.on('exit', (code) => answers.forEach(({ refuse }) => refuse(new Error(`${chromium} ended (${code})\n${said}`))));
try {
  const figures = await look();
  for (const problem of problems) console.error(`${page}: ${problem}`);
  if (problems.length === 0) console.log(`${page}: ${figures} figures, no error, no request; pictures ${pictures}-*.png`);
} catch (error) {
  problems.push(error);
  console.error(`${page}: ${error.message}`);
} finally {
  browser.removeAllListeners('exit');
  const gone = new Promise((done) => browser.once('exit', done));
  if (browser.exitCode === null && browser.kill()) await gone;
  rmSync(profile, { recursive: true, force: true, maxRetries: 5, retryDelay: 100 });
}
process.exit(problems.length === 0 ? 0 : 1);
