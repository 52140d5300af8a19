// A headless Chromium, spoken to over its debugging pipe: no dependency, no port.
import { spawn } from 'node:child_process';
import { mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

export const wait = (ms) => new Promise((done) => setTimeout(done, ms));

export function openBrowser(chromium) {
  const profile = mkdtempSync(join(tmpdir(), 'limcycle-page-'));
  const browser = spawn(chromium, [
    '--headless', '--no-sandbox', '--disable-gpu', '--disable-dev-shm-usage', '--no-first-run', '--hide-scrollbars',
    '--disable-background-networking', '--disable-component-update', '--disable-sync', '--remote-debugging-pipe',
    `--user-data-dir=${profile}`, 'about:blank',
  ], { stdio: ['ignore', 'ignore', 'pipe', 'pipe', 'pipe'] });

  let said = '', rest = '', last = 0;
  browser.stderr.on('data', (data) => { said += data; });
  const answers = new Map();  // request id -> the ends of its promise
  const listeners = [];  // {event, sessionId, act}

  browser.stdio[4].setEncoding('utf8').on('data', (data) => {
    const messages = (rest + data).split('\0');
    rest = messages.pop();
    for (const { id, error, result, method, params, sessionId } of messages.map((text) => JSON.parse(text))) {
      if (id === undefined) {
        for (const one of listeners) if (one.event === method && (!one.sessionId || one.sessionId === sessionId)) one.act(params);
      } else if (error) {
        answers.get(id).refuse(new Error(`${answers.get(id).method}: ${error.message}`));
      } else {
        answers.get(id).answer(result);
      }
    }
  });
  browser.on('exit', (code) => answers.forEach(({ refuse }) => refuse(new Error(`${chromium} ended (${code})\n${said}`))));

  return {
    send(method, params = {}, sessionId) {
      browser.stdio[3].write(JSON.stringify({ id: ++last, method, params, sessionId }) + '\0');
      return new Promise((answer, refuse) => answers.set(last, { answer, refuse, method }));
    },
    on(event, act, sessionId) { listeners.push({ event, act, sessionId }); },
    async close() {
      browser.removeAllListeners('exit');
      const gone = new Promise((done) => browser.once('exit', done));
      if (browser.exitCode === null && browser.kill()) await gone;
      rmSync(profile, { recursive: true, force: true, maxRetries: 20, retryDelay: 200 });
    },
  };
}
