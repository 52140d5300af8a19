// What those who do not see the page, or see it badly, get of it: headings, names, captions, contrast.
const named = ['image', 'img', 'button', 'slider', 'region', 'group', 'link', 'table', 'DisclosureTriangle', 'figure'];

export async function checkNames(tab) {
  const { nodes } = await tab.call('Accessibility.getFullAXTree');
  const roles = nodes.filter((node) => !node.ignored && named.includes(node.role?.value));
  for (const node of roles) {
    const role = node.role.value, name = node.name?.value ?? '';
    if (name.trim() === '' && role !== 'figure' && !(role === 'group' && node.properties?.length === 0)) {
      const { node: { nodeName, attributes } } = await tab.call('DOM.describeNode', { backendNodeId: node.backendDOMNodeId });
      tab.blame(`a ${role} has no name for a screen reader: ${nodeName.toLowerCase()} ${(attributes ?? []).join(' ').slice(0, 80)}`);
    };
  }
  const count = (...kinds) => roles.filter((node) => kinds.includes(node.role.value)).length;
  const page = await tab.ask(() => ({
    levels: [...document.querySelectorAll('h1, h2, h3, h4, h5, h6')].filter((one) => one.checkVisibility()).map((one) => Number(one.tagName[1])),
    empty: [...document.querySelectorAll('h1, h2, h3, h4')].filter((one) => one.textContent.trim() === '').length,
    figures: [...document.querySelectorAll('.plot, main svg[role=img]')].filter((one) => one.checkVisibility() && !one.parentElement.closest('.plot')).length,
    tables: [...document.querySelectorAll('table')].map((table) => ({ caption: table.caption?.textContent ?? '',
      scopes: [...table.querySelectorAll('th')].every((th) => ['col', 'row'].includes(th.scope)), heads: table.querySelectorAll('th').length })),
    language: document.documentElement.lang, title: document.title,
    doubles: [...document.querySelectorAll('[id]')].map((one) => one.id).filter((id, i, all) => all.indexOf(id) !== i),
    labels: [...document.querySelectorAll('input')].filter((one) => one.labels.length === 0 && !one.getAttribute('aria-label')).length,
    moving: document.getAnimations().length,
  }));
  if (page.levels.filter((level) => level === 1).length !== 1 || page.levels[0] !== 1) tab.blame(`headings of level 1: ${page.levels.filter((level) => level === 1).length}`);
  page.levels.forEach((level, i) => { if (i > 0 && level > page.levels[i - 1] + 1) tab.blame(`heading ${i} jumps from level ${page.levels[i - 1]} to ${level}`); });
  if (page.empty > 0) tab.blame(`${page.empty} empty headings`);
  if (count('image', 'img') < page.figures) tab.blame(`${page.figures} figures, ${count('image', 'img')} of them told to a screen reader`);
  page.tables.forEach((one, i) => {
    if (one.caption.trim().length < 8) tab.blame(`table ${i} has no caption: '${one.caption}'`);
    if (!one.scopes || one.heads === 0) tab.blame(`table '${one.caption}' has headings without scope`);
  });
  if (page.language !== 'en' || page.title.length < 8) tab.blame(`language '${page.language}', title '${page.title}'`);
  if (page.doubles.length > 0) tab.blame(`ids used twice: ${page.doubles.join(', ')}`);
  if (page.labels > 0) tab.blame(`${page.labels} inputs have no label`);
  if (page.moving > 0) tab.blame('something moves by itself');
  return roles.length;
}

// Contrast by WCAG 2: of words to their ground 4.5 (large ones 3), of curves to theirs 3.
export async function checkContrast(tab, when) {
  const faint = await tab.ask(() => {
    const parse = (text) => (text.match(/[\d.]+/g) ?? []).map(Number);
    const channel = (c) => c / 255 <= 0.04045 ? c / 255 / 12.92 : ((c / 255 + 0.055) / 1.055) ** 2.4;
    const luminance = ([r, g, b]) => 0.2126 * channel(r) + 0.7152 * channel(g) + 0.0722 * channel(b);
    const ratio = (a, b) => (Math.max(luminance(a), luminance(b)) + 0.05) / (Math.min(luminance(a), luminance(b)) + 0.05);
    const over = (colour, ground) => colour.length < 4 ? colour : [0, 1, 2].map((i) => colour[3] * colour[i] + (1 - colour[3]) * ground[i]);
    const groundOf = (one) => {
      const layers = [];
      for (let at = one; at; at = at.parentElement) {
        const colour = parse(getComputedStyle(at).backgroundColor);
        if (colour.length === 3 || colour[3] === 1) return layers.reduceRight((ground, layer) => over(layer, ground), colour);
        if (colour[3] > 0) layers.push(colour);
      }
      return [255, 255, 255];
    };
    const middle = (one) => { const box = one.getBoundingClientRect(); return [box.x + box.width / 2, box.y + box.height / 2]; };
    // What lies under a word of a picture: the last filled shape before it that holds its middle.
    const underWord = (word) => {
      const svg = word.ownerSVGElement, [x, y] = middle(word);
      let ground = groundOf(svg.parentElement);
      for (const shape of svg.querySelectorAll('rect, path, circle')) {
        if (!(shape.compareDocumentPosition(word) & Node.DOCUMENT_POSITION_FOLLOWING) || shape.closest('.xy, .legend, defs')) continue;
        const style = getComputedStyle(shape), fill = parse(style.fill), box = shape.getBoundingClientRect();
        if (style.fill === 'none' || fill.length < 3 || x < box.left || x > box.right || y < box.top || y > box.bottom) continue;
        ground = over([...fill.slice(0, 3), (fill[3] ?? 1) * Number(style.fillOpacity) * Number(style.opacity)], ground);
      }
      return ground;
    };
    const found = new Map();
    const tell = (kind, words, value) => found.set(`${kind}: ${value.toFixed(2)}`, `'${words.trim().slice(0, 40)}'`);
    const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
    for (let node = walker.nextNode(); node; node = walker.nextNode()) {
      const one = node.parentElement;
      if (!node.textContent.trim() || !one.checkVisibility() || one.closest('script, style, noscript, .unseen')) continue;
      const style = getComputedStyle(one), isWord = one instanceof SVGElement;
      const ground = isWord ? underWord(one.closest('text') ?? one) : groundOf(one), colour = parse(isWord ? style.fill : style.color);
      const size = parseFloat(style.fontSize), large = size >= 24 || (size >= 18.66 && Number(style.fontWeight) >= 700);
      const value = ratio(over(colour, ground), ground);
      if (value < (large ? 3 : 4.5)) tell(`words ${one.tagName.toLowerCase()}.${one.className.baseVal ?? one.className}`, node.textContent, value);
    }
    for (const plot of document.querySelectorAll('.plot')) {
      const ground = parse(getComputedStyle(plot.querySelector('.main-svg')).backgroundColor);
      for (const path of plot.querySelectorAll('.scatterlayer .js-line')) {
        const value = ratio(parse(getComputedStyle(path).stroke), ground);
        if (value < 3) tell(`curve of ${plot.dataset.figure}`, '', value);
      }
    }
    return [...found];
  });
  for (const [kind, words] of faint.slice(0, 8)) tab.blame(`${when}: too little contrast, ${kind} ${words}`);
}
