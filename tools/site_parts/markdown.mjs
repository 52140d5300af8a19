// Markdown as on GitHub -> HTML: headings get GitHub's anchors, formulas in $...$ become MathML (no script and no font
// has to be fetched to show them), and blocks of shown output tell the command that made them.
import { createRequire } from 'node:module';

const require = createRequire(import.meta.url);
const { Marked } = require('marked');
const temml = require('temml');

export const escaped = (text) =>
  text.replaceAll('&', '&amp;').replaceAll('<', '&lt;').replaceAll('>', '&gt;').replaceAll('"', '&quot;');

/// The anchor that GitHub gives a heading.
const slug = (text) =>
  text.replace(/<[^>]*>/g, '').replace(/&\w+;/g, '').trim().toLowerCase().replace(/[^\p{L}\p{N}\p{M}_ -]/gu, '').replaceAll(' ', '-');

const math = (tex, block) => temml.renderToString(tex, { displayMode: block, throwOnError: true, annotate: false });

const inline_math = {
  name: 'inline_math',
  level: 'inline',
  start: (text) => text.match(/\$/)?.index,
  tokenizer(text) {
    const found = /^\$(?!\s)((?:\\.|[^$\\])+?)(?<!\s)\$(?!\d)/.exec(text);
    return found ? { type: 'inline_math', raw: found[0], tex: found[1] } : undefined;
  },
  renderer: (token) => math(token.tex, false),
};

const block_math = {
  name: 'block_math',
  level: 'block',
  start: (text) => text.match(/\n\$\$/)?.index,
  tokenizer(text) {
    const found = /^\$\$([\s\S]+?)\$\$[ \t]*(?:\n|$)/.exec(text);
    return found ? { type: 'block_math', raw: found[0], tex: found[1] } : undefined;
  },
  renderer: (token) => `<div class="formula">${math(token.tex, true)}</div>\n`,
};

const shown = /^<!-- (?:output|refused)( from "[^"]*")?( to "[^"]*")?: (.*) -->\s*$/;

/// {html, title, headings: [{level, id, html}], anchors}; `resolve(href)` gives the address of a link or an image.
export function page_of(text, resolve) {
  const headings = [];
  const taken = new Map();
  const renderer = {
    heading({ tokens, depth }) {
      const html = this.parser.parseInline(tokens);
      const plain = slug(html);
      const times = taken.get(plain) ?? 0;
      taken.set(plain, times + 1);
      const id = times ? `${plain}-${times}` : plain;
      headings.push({ level: depth, id, html: html.replace(/<\/?a[^>]*>/g, '') });
      const anchor = depth > 1 ? ` <a class="anchor" href="#${id}" aria-label="Link to this section">#</a>` : '';
      return `<h${depth} id="${id}">${html}${anchor}</h${depth}>\n`;
    },
    link({ href, title, tokens }) {
      const outside = /^[a-z]+:/.test(href) ? ' rel="external"' : '';
      return `<a href="${escaped(resolve(href))}"${title ? ` title="${escaped(title)}"` : ''}${outside}>${this.parser.parseInline(tokens)}</a>`;
    },
    image({ href, text: words }) {
      return `<img src="${escaped(resolve(href))}" alt="${escaped(words)}">`;
    },
    table(token) {
      const cell = (kind) => (one) =>
        `<${kind}${one.align ? ` style="text-align:${one.align}"` : ''}>${this.parser.parseInline(one.tokens)}</${kind}>`;
      const row = (cells, kind) => `<tr>${cells.map(cell(kind)).join('')}</tr>\n`;
      return `<div class="wide"><table>\n<thead>${row(token.header, 'th')}</thead>\n<tbody>${token.rows.map((r) => row(r, 'td')).join('')}</tbody></table></div>\n`;
    },
    html({ text: html }) {
      const block = shown.exec(html);
      if (!block) return html.trimStart().startsWith('<!--') ? '' : html;
      const part = block[1] || block[2] ? ' <span class="part">(a part of what it prints)</span>' : '';
      return `<p class="command"><code>${escaped(block[3])}</code>${part}</p>\n`;
    },
  };
  const marked = new Marked({ gfm: true, renderer, extensions: [inline_math, block_math] });
  const html = marked.parse(text);
  const title = headings.find((one) => one.level === 1);
  if (!title) throw new Error('a page without a title');
  return { html, headings, title: title.html.replace(/<[^>]*>/g, '') };
}
