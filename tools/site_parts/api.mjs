// The API reference: one page a header, in the order of the header, from Doxygen's XML.
import { readFileSync, readdirSync } from 'node:fs';
import { all, first, parse, text_of } from './xml.mjs';
import { escaped } from './markdown.mjs';
import { words_of } from './comments.mjs';

const types = new Set(['struct', 'class', 'union', 'concept']);
const short = (name) => name.replaceAll(/(?<![\w:])limcycle::/g, '');
const address_of = (file) => `api/${file}.html`;
const hidden = (node) => node.attributes.prot === 'private' || text_of(first(node, 'compoundname')).includes('anonymous');
const members_of = (node) => all(node, 'sectiondef').flatMap((section) => all(section, 'memberdef')).filter((one) => !hidden(one));

/// Where a compound or a member is declared, or null if that is no header.
function declared(node) {
  const at = first(node, 'location')?.attributes;
  return at?.file?.endsWith('.hpp') ? { file: at.file, line: Number(at.line ?? 0) } : null;
}

/// Map of header -> {about, entities: [{node, line}]} in the order of the header.
function read_headers(folder) {
  const headers = new Map();
  const seen = new Set();
  const header = (file) => headers.get(file) ?? headers.set(file, { about: null, entities: [] }).get(file);
  const add = (node) => {
    const at = declared(node);
    if (!at || hidden(node) || seen.has(node.attributes.id)) return;
    seen.add(node.attributes.id);
    header(at.file).entities.push({ node, line: at.line });
  };
  for (const name of readdirSync(folder).sort()) {
    if (name === 'index.xml' || name === 'Doxyfile.xml' || !name.endsWith('.xml')) continue;
    const compound = first(parse(readFileSync(`${folder}/${name}`, 'utf8')), 'compounddef');
    const kind = compound?.attributes.kind;
    if (!compound || hidden(compound)) continue;
    if (kind === 'file' && declared(compound)) header(declared(compound).file).about = compound;
    if (types.has(kind)) add(compound);
    else members_of(compound).forEach(add); // of a file or a namespace
  }
  for (const { entities } of headers.values()) entities.sort((a, b) => a.line - b.line);
  return headers;
}

/// Map of Doxygen's ids -> {page, id}: what a reference may lead to.
function read_places(headers) {
  const places = new Map();
  for (const [file, { about, entities }] of headers) {
    if (!entities.length) continue;
    const page = address_of(file);
    if (about) places.set(about.attributes.id, { page, id: '' });
    const put = (node) => {
      places.set(node.attributes.id, { page, id: node.attributes.id });
      [...all(node, 'enumvalue'), ...members_of(node)].forEach(put);
    };
    for (const { node } of entities) put(node);
  }
  return places;
}

/// What writes the entities of one header as HTML; `link(id, html)` makes a reference of some text.
function writer(link) {
  const words = words_of(link);
  // Doxygen parts a comment after its first sentence.
  const comment = (node) =>
    (words(first(node, 'briefdescription')) + words(first(node, 'detaileddescription'))).replace(/\s*<\/p><p>/, ' ');
  const linked = (one) => (typeof one === 'string' ? escaped(one) : link(one.attributes.refid, escaped(text_of(one))));
  const type = (node) =>
    (node?.children ?? []).map(linked).join('').replaceAll('&lt; ', '&lt;').replaceAll(' &gt;', '&gt;');
  const text = (node, name) => escaped(text_of(first(node, name)));

  const template = (node) => {
    const list = first(node, 'templateparamlist');
    const one = (param) => [type(first(param, 'type')), text(param, 'declname')].filter(Boolean).join(' ');
    return list ? `template &lt;${all(list, 'param').map(one).join(', ')}&gt;\n` : '';
  };
  const parameter = (param) => {
    const standard = text(param, 'defval');
    return `${type(first(param, 'type'))} ${text(param, 'declname')}${standard ? ` = ${standard}` : ''}`.trim();
  };
  const declaration = (node) => {
    const name = `<b>${text(node, 'name')}</b>`;
    const what = type(first(node, 'type'));
    const value = text(node, 'initializer');
    switch (node.attributes.kind) {
      case 'function': {
        const after = /\)([^)]*)$/.exec(text(node, 'argsstring'))?.[1] ?? '';
        const is_static = node.attributes.static === 'yes' ? 'static ' : '';
        return `${template(node)}${is_static}${what} ${name}(${all(node, 'param').map(parameter).join(', ')})${after}`;
      }
      case 'enum':
        return `enum ${name}`;
      case 'typedef':
        return `using ${name} = ${what}${text(node, 'argsstring')}`;
      default:
        return `${what} ${name}${value.length < 60 ? ` ${value}` : ''}`;
    }
  };
  const enumerator = (node) =>
    `<dt id="${node.attributes.id}"><code>${text(node, 'name')}</code></dt><dd>${comment(node)}</dd>`;
  const member = (node) => {
    const values = all(node, 'enumvalue').map(enumerator).join('');
    const list = values && `<dl>${values}</dl>`;
    return `<div class="member" id="${node.attributes.id}"><pre>${declaration(node).trim()}</pre>${comment(node)}${list}</div>\n`;
  };
  const compound = (node) => {
    const is_concept = node.attributes.kind === 'concept';
    const code = is_concept ? short(text(node, 'initializer').trim()) : template(node).trim();
    const bases = all(node, 'basecompoundref').map((one) => link(one.attributes.refid, escaped(short(text_of(one)))));
    const heading = `<h2 id="${node.attributes.id}"><small>${node.attributes.kind}</small> ${short(text(node, 'compoundname'))}</h2>`;
    const extended = bases.length ? `<p>Extends ${bases.join(', ')}.</p>` : '';
    return `<section>${heading}${code && `<pre>${code}</pre>`}${extended}${comment(node)}${members_of(node).map(member).join('')}</section>\n`;
  };
  return { comment, entity: (node) => (node.name === 'memberdef' ? member(node) : compound(node)) };
}

/// {pages: Map of address -> {title, body}, summaries: [{file, address, sentence, names: [{name, id}]}]}.
export function api_pages(folder, relative) {
  const headers = read_headers(folder);
  const places = read_places(headers);
  const pages = new Map();
  const summaries = [];
  for (const [file, { about, entities }] of [...headers].sort(([a], [b]) => (a < b ? -1 : 1))) {
    if (!entities.length) continue;
    const address = address_of(file);
    const { comment, entity } = writer((refid, html) => {
      const to = places.get(refid);
      return to ? `<a href="${relative(address, to.page)}${to.id && `#${to.id}`}">${html}</a>` : html;
    });
    const intro = about ? comment(about) : '';
    const told = intro || entities.map(({ node }) => comment(node)).find(Boolean) || '';
    const name_of = (node) => short(text_of(first(node, 'compoundname') ?? first(node, 'qualifiedname') ?? first(node, 'name')));
    const names = entities.map(({ node }) => ({ name: name_of(node), id: node.attributes.id }));
    const sentence = told.replace(/<\/p>.*$/s, '').replace(/<[^>]*>/g, '').replace(/(\.)\s.*$/s, '$1');
    summaries.push({ file, address, names, sentence });
    const body = entities.map(({ node }) => entity(node)).join('');
    pages.set(address, { title: file, body: `<h1>${file}</h1>\n<pre class="include">#include "limcycle/${file}"</pre>\n${intro}${body}` });
  }
  return { pages, summaries };
}
