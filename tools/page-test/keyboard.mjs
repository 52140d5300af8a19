// Does Tab reach everything that can be used, in order, seen, and out again?
export async function checkKeyboard(tab) {
  const due = await tab.ask(() => {
    const usable = [...document.querySelectorAll('a[href], button, input, select, textarea, summary, [tabindex]:not([tabindex="-1"])')]
      .filter((one) => !one.disabled && one.checkVisibility());
    usable.forEach((one, i) => { one.dataset.stop = i; });
    document.body.tabIndex = -1;  // where Tab starts
    document.body.focus();
    document.body.removeAttribute('tabindex');
    return usable.map((one) => `${one.tagName.toLowerCase()} '${(one.getAttribute('aria-label') ?? one.textContent).trim().slice(0, 60)}'`);
  });
  const visited = [];
  for (let i = 0; i < due.length + 5; ++i) {
    await tab.press('Tab', 'Tab', 9);
    const at = await tab.ask(() => {
      const one = document.activeElement, style = getComputedStyle(one);
      if (one === document.body) return null;
      const [width, height] = [one.getBoundingClientRect().width, one.getBoundingClientRect().height];
      return { stop: Number(one.dataset.stop ?? -1), seen: style.outlineStyle !== 'none' && parseFloat(style.outlineWidth) >= 2 && width > 1 && height > 1 };
    });
    if (!at || visited.includes(at.stop)) break;
    visited.push(at.stop);
    if (!at.seen) tab.blame(`the focus is not seen on ${due[at.stop]}`);
  }
  const missed = due.filter((_, i) => !visited.includes(i));
  if (missed.length > 0) tab.blame(`Tab does not reach ${missed.length} of ${due.length}: ${missed.slice(0, 3).join(', ')}`);
  if (visited.some((stop, i) => i > 0 && stop < visited[i - 1])) tab.blame('Tab goes another order than the page');

  if (await tab.value('document.querySelector(".plot") !== null')) {
    const range = 'document.querySelector(".plot")._fullLayout.xaxis.range.join()';
    await tab.value('document.querySelector(".plot").focus()');
    const first = await tab.value(range);
    for (const [key, code, keyCode] of [['ArrowLeft', 'ArrowLeft', 37], ['+', 'Equal', 187]]) {
      const before = await tab.value(range);
      await tab.press(key, code, keyCode);
      if (!await tab.until(async () => await tab.value(range) !== before, 2000)) tab.blame(`the key ${key} does not change a figure's view`);
    }
    await tab.press('0', 'Digit0', 48);
    const isFirst = async () => {
      const [now, then] = [await tab.value(range), first].map((text) => text.split(',').map(Number));
      return now.every((value, i) => Math.abs(value - then[i]) < 0.01 * (then[1] - then[0]));
    };
    if (!await tab.until(isFirst, 2000)) tab.blame(`the key 0 does not bring the first view back: ${await tab.value(range)}, not ${first}`);
  }
  return due.length;
}
