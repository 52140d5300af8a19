// Is every figure drawn, and do its words say what it shows?
export async function checkDrawn(tab) {
  const page = await tab.ask(() => {
    const root = document.documentElement;
    const drawn = (plot) => plot.querySelector('.main-svg .trace path[d], .main-svg .trace image, .main-svg .hm image, .main-svg .point path[d]') !== null;
    return {
      figures: root.dataset.figures, errors: root.dataset.errors, error: root.dataset.error,
      plots: [...document.querySelectorAll('.plot')].map((plot) => ({
        id: plot.dataset.figure, drawn: drawn(plot), label: plot.getAttribute('aria-label') ?? '',
        caption: plot.closest('figure')?.querySelector('figcaption')?.textContent ?? '',
      })),
      pictures: [...document.querySelectorAll('main svg[role=img]')].filter((svg) => !svg.closest('.plot')).map((svg) => ({
        label: svg.getAttribute('aria-label') ?? '', wide: svg.getBoundingClientRect().width,
        shapes: svg.querySelectorAll('path, rect, line, circle, polyline, polygon').length,
      })),
    };
  });
  if (page.errors !== '0') tab.blame(`errors, as the page says: '${page.errors}' (${page.error})`);
  const drawn = page.plots.filter((one) => one.drawn).length;
  if (page.figures !== `${page.plots.length}/${page.plots.length}`) tab.blame(`figures drawn, as the page says: '${page.figures}'`);
  if (drawn !== page.plots.length) tab.blame(`the page says ${page.figures} figures, ${drawn} hold curves`);
  for (const one of page.plots) {
    if (one.caption.length < 40) tab.blame(`figure ${one.id}: its caption says little: '${one.caption}'`);
    if (!one.label.includes(one.caption)) tab.blame(`figure ${one.id}: its label does not state its finding`);
  }
  page.pictures.forEach((one, i) => {
    if (one.shapes < 2) tab.blame(`picture ${i} is empty`);
    if (one.label.length < 10) tab.blame(`picture ${i} has no words: '${one.label}'`);
    if (!(one.wide > 100)) tab.blame(`picture ${i} is not seen`);
  });
  return page.plots.length + page.pictures.length;
}
