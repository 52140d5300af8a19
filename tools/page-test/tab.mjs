// A page in a tab of its own, what went wrong in it, and what a visitor does there.
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';
import { pathToFileURL } from 'node:url';

import { wait } from './browser.mjs';

const patience = 60_000;  // ms for the page to draw itself, or for a file to be saved

export async function openTab(browser, page) {
  const url = pathToFileURL(resolve(page)).href;
  const { browserContextId } = await browser.send('Target.createBrowserContext');
  const { targetId } = await browser.send('Target.createTarget', { url: 'about:blank', browserContextId });
  const { sessionId } = await browser.send('Target.attachToTarget', { targetId, flatten: true });
  const call = (method, params) => browser.send(method, params, sessionId);
  const listen = (event, act) => browser.on(event, act, sessionId);
  const problems = [];
  const blame = (text) => { if (!problems.includes(text)) problems.push(text); };

  listen('Runtime.consoleAPICalled', ({ type, args }) => {
    if (['error', 'assert', 'warning'].includes(type)) blame(`console: ${args.map((a) => a.value ?? a.description).join(' ')}`);
  });
  listen('Runtime.exceptionThrown', ({ exceptionDetails: e }) => blame(`exception: ${e.exception?.description ?? e.text}`));
  listen('Log.entryAdded', ({ entry }) => {
    if (entry.level === 'error') blame(`browser: ${entry.text} ${entry.url ?? ''}`);
  });
  listen('Network.requestWillBeSent', ({ request }) => {
    if (request.url.split('#')[0] !== url && !/^(data|blob):/.test(request.url)) blame(`request: ${request.url.slice(0, 200)}`);
  });
  listen('Network.webSocketCreated', ({ url: to }) => blame(`request: ${to}`));
  for (const domain of ['Runtime', 'Log', 'Network', 'Page', 'Accessibility']) await call(`${domain}.enable`);

  const folder = mkdtempSync(join(tmpdir(), 'limcycle-saved-'));
  const saved = new Map();  // of a download -> {name, state}
  await browser.send('Browser.setDownloadBehavior', { behavior: 'allowAndName', downloadPath: folder, browserContextId, eventsEnabled: true });
  browser.on('Browser.downloadWillBegin', ({ guid, suggestedFilename, frameId }) => {
    if (frameId === targetId) saved.set(guid, { name: suggestedFilename, state: 'inProgress' });
  });
  browser.on('Browser.downloadProgress', ({ guid, state }) => { if (saved.has(guid)) saved.get(guid).state = state; });

  async function value(expression) {
    const { result, exceptionDetails } = await call('Runtime.evaluate', { expression, returnByValue: true, awaitPromise: true, userGesture: true });
    if (exceptionDetails) throw new Error(exceptionDetails.exception?.description ?? exceptionDetails.text);
    return result.value;
  }

  async function until(question, ms = patience) {
    for (const end = Date.now() + ms; Date.now() < end; await wait(40)) if (await question()) return true;
    return false;
  }

  return {
    page, url, problems, blame, call, value, until,
    // A function of this file, run in the page with arguments that JSON can hold.
    ask: (question, ...given) => value(`(${question})(...${JSON.stringify(given)})`),
    open: async () => {
      await call('Page.navigate', { url });
      if (!await until(() => value('document.readyState === "complete" && document.documentElement.dataset.ready === "yes"')))
        blame('the page did not get ready');
    },
    async resize(width, height = 900) {
      await call('Emulation.setDeviceMetricsOverride', { width, height, deviceScaleFactor: 1, mobile: false });
      await wait(350);  // figures follow the width
    },
    async media(media, scheme) {
      await call('Emulation.setEmulatedMedia', { media, features: [{ name: 'prefers-color-scheme', value: scheme }] });
      await wait(150);
    },
    async press(key, code, keyCode) {
      const what = { key, code, windowsVirtualKeyCode: keyCode };
      await call('Input.dispatchKeyEvent', { type: 'rawKeyDown', ...what });
      await call('Input.dispatchKeyEvent', { type: 'keyUp', ...what });
    },
    // What `act` saves: name and content, or nothing.
    async savedBy(act) {
      const before = new Set(saved.keys());
      await act();
      const fresh = () => [...saved.entries()].find(([guid, one]) => !before.has(guid) && one.state === 'completed');
      if (!await until(fresh, 15_000)) return null;
      const [guid, { name }] = fresh();
      return { name, content: readFileSync(join(folder, guid)) };
    },
    async close() {
      await browser.send('Target.disposeBrowserContext', { browserContextId });
      rmSync(folder, { recursive: true, force: true });
    },
  };
}
