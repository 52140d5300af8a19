// Just enough XML for what Doxygen writes: elements as {name, attributes, children}, texts as strings.
const names = { amp: '&', lt: '<', gt: '>', quot: '"', apos: "'" };
const unescape = (text) =>
  text.replace(/&(#x[0-9a-f]+|#\d+|\w+);/gi, (whole, name) => {
    if (name[0] === '#') return String.fromCodePoint(name[1] === 'x' ? parseInt(name.slice(2), 16) : Number(name.slice(1)));
    if (!(name in names)) throw new Error(`unknown entity ${whole}`);
    return names[name];
  });

/// The root element of a document.
export function parse(text) {
  const root = { name: '', attributes: {}, children: [] };
  const open = [root];
  for (const [, tag, words] of text.matchAll(/<([^>]*)>|([^<]+)/g)) {
    const top = open[open.length - 1];
    if (words !== undefined) {
      top.children.push(unescape(words));
    } else if (tag[0] === '?' || tag[0] === '!') {
      continue;
    } else if (tag[0] === '/') {
      if (open.pop().name !== tag.slice(1)) throw new Error(`</${tag.slice(1)}> closes <${top.name}>`);
    } else {
      const attributes = {};
      for (const [, key, value] of tag.matchAll(/([\w:]+)="([^"]*)"/g)) attributes[key] = unescape(value);
      const node = { name: /^[\w:-]+/.exec(tag)[0], attributes, children: [] };
      top.children.push(node);
      if (!tag.endsWith('/')) open.push(node);
    }
  }
  if (open.length !== 1) throw new Error(`<${open[open.length - 1].name}> is not closed`);
  return root.children.find((one) => one.name);
}

export const all = (node, name) => node.children.filter((one) => one.name === name);
export const first = (node, name) => node.children.find((one) => one.name === name);
export const text_of = (node) =>
  typeof node === 'string' ? node : node ? node.children.map(text_of).join('') : '';
