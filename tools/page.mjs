// Opens pages of the program in headless Chromium and says whether they are whole: no error, no request to anywhere,
// every figure drawn, sliders that say the right numbers, buttons that save what they name, everything reached by
// keyboard and told to a screen reader, legible on a wide screen, on phones, in the dark and on paper.
//   node tools/page.mjs CHROMIUM PAGE.html...       pictures and a PDF of each beside it
//   node tools/page.mjs CHROMIUM --broken PAGE.html    breaks a page in many ways: each must be found
import { openBrowser } from './page-test/browser.mjs';
import { checkDrawn } from './page-test/drawn.mjs';
import { checkKeyboard } from './page-test/keyboard.mjs';
import { checkNames } from './page-test/reading.mjs';
import { checkSaving } from './page-test/saving.mjs';
import { checkPaper, checkSizes } from './page-test/sizes.mjs';
import { checkSliders } from './page-test/sliders.mjs';
import { openTab } from './page-test/tab.mjs';
import { breakages } from './page-test/breakages.mjs';

const [chromium, ...rest] = process.argv.slice(2);
const browser = openBrowser(chromium);

// `wanted`: only these checks.
async function look(page, pictures, wanted = ['drawn', 'sliders', 'keyboard', 'names', 'sizes', 'saving', 'paper']) {
  const tab = await openTab(browser, page), said = [];
  const checks = {
    drawn: async () => said.push(`${await checkDrawn(tab)} figures`),
    sliders: async () => said.push(`${await checkSliders(tab)} sliders`),
    keyboard: async () => said.push(`${await checkKeyboard(tab)} stops of Tab`),
    names: async () => said.push(`${await checkNames(tab)} names`),
    sizes: () => checkSizes(tab, pictures),
    saving: async () => said.push(`${await checkSaving(tab)} files saved`),
    paper: () => checkPaper(tab, pictures),
  };
  try {
    await tab.resize(1200);
    await tab.media('', 'light');
    await tab.open();
    for (const name of wanted) await checks[name]();
    return { problems: tab.problems, words: said.join(', ') };
  } catch (error) {
    return { problems: [...tab.problems, error.message], words: '' };
  } finally {
    await tab.close();
  }
}

// Three pages at a time: much of a visit is waiting.
async function inTurns(list, act) {
  const waiting = [...list];
  const visitor = async () => { while (waiting.length > 0) await act(waiting.shift()); };
  await Promise.all([visitor(), visitor(), visitor()]);
}

async function lookAtAll(pages) {
  let failures = 0;
  await inTurns(pages, async (page) => {
    const { problems, words } = await look(page, page.replace(/\.html$/, ''));
    for (const problem of problems) console.error(`${page}: ${problem}`);
    if (problems.length === 0) console.log(`${page}: ${words}`);
    else ++failures;
  });
  return failures;
}

async function lookAtBroken(page) {
  let failures = 0;
  await inTurns(breakages(page), async ({ name, path, check, expected }) => {
    const { problems } = await look(path, null, [check]);
    const found = problems.find((problem) => problem.includes(expected));
    console.log(`${found ? 'found' : 'NOT FOUND'}: ${name}: ${found?.split('\n')[0] ?? `expected '${expected}', heard: ${problems.join('; ') || 'nothing'}`}`);
    if (!found) ++failures;
  });
  return failures;
}

let failures = 1;
try {
  failures = rest[0] === '--broken' ? await lookAtBroken(rest[1]) : await lookAtAll(rest);
} catch (error) {
  console.error(error);
} finally {
  await browser.close();
}
process.exit(failures === 0 ? 0 : 1);
