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

// In the dark while files are saved: they are to be light all the same.
async function look(page, pictures) {
  const tab = await openTab(browser, page);
  try {
    await tab.resize(1200);
    await tab.media('', 'light');
    await tab.open();
    const { plots, pictures: drawings } = await checkDrawn(tab);
    const sliders = await checkSliders(tab), stops = await checkKeyboard(tab), names = await checkNames(tab);
    await checkSizes(tab, pictures);
    const saved = await checkSaving(tab);
    await checkPaper(tab, pictures);
    return { problems: tab.problems, words: `${plots + drawings} figures, ${sliders} sliders, ${stops} stops of Tab, ${names} names, ${saved} files saved` };
  } catch (error) {
    return { problems: [...tab.problems, error.message], words: '' };
  } finally {
    await tab.close();
  }
}

async function lookAtAll(pages) {
  let failures = 0;
  const waiting = [...pages];
  const visitor = async () => {
    for (let page = waiting.shift(); page; page = waiting.shift()) {
      const { problems, words } = await look(page, page.replace(/\.html$/, ''));
      for (const problem of problems) console.error(`${page}: ${problem}`);
      if (problems.length === 0) console.log(`${page}: ${words}`);
      else ++failures;
    }
  };
  await Promise.all([visitor(), visitor()]);
  return failures;
}

async function lookAtBroken(page) {
  let failures = 0;
  for (const { name, path, expected } of breakages(page)) {
    const { problems } = await look(path, null);
    const found = problems.find((problem) => problem.includes(expected));
    console.log(`${found ? 'found' : 'NOT FOUND'}: ${name}: ${found ?? `expected '${expected}', heard: ${problems.join('; ') || 'nothing'}`}`);
    if (!found) ++failures;
  }
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
