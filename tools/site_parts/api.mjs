// The API reference: one page a header, in the order of the header, from Doxygen's XML.
import { readFileSync, readdirSync } from 'node:fs';
import { all, first, parse, text_of } from './xml.mjs';
import { escaped } from './markdown.mjs';

const types = new Set(['struct', 'class', 'union', 'concept']);
const short = (name) => name.replace(/^limcycle::/, '').replaceAll(/(?<![\w:])limcycle::/g, '');
const page_of_header = (file) => `api/${file}.html`;

/// Reads the XML: {headers: Map file -> entities in order, places: Map refid -> {page, id}}.
function read(folder) {
  const headers = new Map();
  const places = new Map();
  const seen = new Set();
  const header = (file) => headers.get(file) ?? headers.set(file, { about: null, entities: [] }).get(file);
  const place = (node) => {
    const at = first(node, 'location')?.attributes;
    return at?.file?.endsWith('.hpp') ? { file: at.file, line: Number(at.line ?? 0) } : null;
  };
  const hidden = (node) => node.attributes.prot === 'private' || text_of(first(node, 'compoundname') ?? '').includes('anonymous');
  const add = (node, into, line) => {
    if (seen.has(node.attributes.id)) return;
    seen.add(node.attributes.id);
    into.push({ node, line });
  };
  for (const name of readdirSync(folder).sort()) {
    if (name === 'index.xml' || !name.endsWith('.xml') || name === 'Doxyfile.xml') continue;
    const compound = first(parse(readFileSync(`${folder}/${name}`, 'utf8')), 'compounddef');
    if (!compound || hidden(compound)) continue;
    const kind = compound.attributes.kind;
    const at = place(compound);
    if (kind === 'file' && at) header(at.file).about = compound;
    if (types.has(kind) && at) add(compound, header(at.file).entities, at.line);
    if (kind !== 'file' && kind !== 'namespace') continue;
    for (const section of all(compound, 'sectiondef'))
      for (const member of all(section, 'memberdef')) {
        const of = place(member);
        if (of && !hidden(member)) add(member, header(of.file).entities, of.line);
      }
  }
  for (const [file, { about, entities }] of headers) {
    entities.sort((a, b) => a.line - b.line);
    const put = (node) => places.set(node.attributes.id, { page: page_of_header(file), id: node.attributes.id });
    if (about) places.set(about.attributes.id, { page: page_of_header(file), id: '' });
    for (const { node } of entities) {
      put(node);
      for (const value of all(node, 'enumvalue')) put(value);
      for (const section of all(node, 'sectiondef'))
        for (const member of all(section, 'memberdef').filter((one) => !hidden(one))) {
          put(member);
          for (const value of all(member, 'enumvalue')) put(value);
        }
    }
  }
  return { headers, places, hidden };
}

/// Comments of Doxygen -> HTML. An element that is not known is an error, so that nothing gets lost in silence.
function words_of(link) {
  const inside = (node) => node.children.map(render).join('');
  const wrap = (tag) => (node) => `<${tag}>${inside(node)}</${tag}>`;
  const sign = (text) => () => text;
  const kinds = {
    para: wrap('p'), bold: wrap('strong'), emphasis: wrap('em'), computeroutput: wrap('code'), verbatim: wrap('pre'),
    preformatted: wrap('pre'), itemizedlist: wrap('ul'), orderedlist: wrap('ol'), listitem: wrap('li'), table: wrap('table'),
    row: wrap('tr'), entry: wrap('td'), superscript: wrap('sup'), subscript: wrap('sub'), programlisting: wrap('pre'),
    codeline: (node) => `${inside(node)}\n`, highlight: inside, sect1: inside, title: wrap('strong'),
    parameterlist: wrap('dl'), parameteritem: inside, parameternamelist: inside, parametername: wrap('dt'), parameterdescription: wrap('dd'),
    simplesect: (node) => `<p class="note">${{ return: 'Returns' }[node.attributes.kind] ?? node.attributes.kind}:</p>${inside(node)}`,
    ulink: (node) => `<a href="${escaped(node.attributes.url)}" rel="external">${inside(node)}</a>`,
    ref: (node) => link(node.attributes.refid, inside(node)),
    blockquote: (node) => `&gt; ${inside(node).replace(/^<p>|<\/p>$/g, '')}`, // a comment that begins with "> 0"
    zwj: sign(''), sp: sign(' '), ndash: sign('–'), mdash: sign('—'), lsquo: sign('‘'), rsquo: sign('’'), linebreak: sign('<br>'),
    hruler: sign('<hr>'), nonbreakablespace: sign('&nbsp;'), anchor: sign(''),
  };
  function render(node) {
    if (typeof node === 'string') return escaped(node);
    if (!kinds[node.name]) throw new Error(`a comment holds <${node.name}>, which the site does not know`);
    return kinds[node.name](node);
  }
  return (node) => (node ? inside(node).replace(/<p>\s*<\/p>/g, '').trim() : '');
}

/// The pages: Map address -> {title, body}, and the list of headers with a sentence each.
export function api_pages(folder, relative) {
  const { headers, places, hidden } = read(folder);
  const pages = new Map();
  const summaries = [];
  for (const [file, { about, entities }] of [...headers].sort(([a], [b]) => (a < b ? -1 : 1))) {
    const address = page_of_header(file);
    const link = (refid, html) => {
      const to = places.get(refid);
      return to ? `<a href="${relative(address, to.page)}${to.id ? `#${to.id}` : ''}">${html}</a>` : html;
    };
    const words = words_of(link);
    // Doxygen parts a comment after its first sentence.
    const comment = (node) =>
      (words(first(node, 'briefdescription')) + words(first(node, 'detaileddescription'))).replace(/\s*<\/p><p>/, ' ');
    const linked = (one) => (typeof one === 'string' ? escaped(one) : link(one.attributes.refid, escaped(text_of(one))));
    const type = (node) => (node ? node.children.map(linked).join('').replaceAll('&lt; ', '&lt;').replaceAll(' &gt;', '&gt;') : '');
    const template = (node) => {
      const list = first(node, 'templateparamlist');
      if (!list) return '';
      const one = (param) => [type(first(param, 'type')), text_of(first(param, 'declname'))].filter(Boolean).join(' ');
      return `template &lt;${all(list, 'param').map(one).join(', ')}&gt;\n`;
    };
    const parameters = (node) =>
      all(node, 'param')
        .map((param) => {
          const standard = text_of(first(param, 'defval'));
          return `${type(first(param, 'type'))} ${escaped(text_of(first(param, 'declname')))}${standard ? ` = ${escaped(standard)}` : ''}`.trim();
        })
        .join(', ');
    const declaration = (node) => {
      const kind = node.attributes.kind;
      const name = `<b>${escaped(text_of(first(node, 'name')))}</b>`;
      const value = text_of(first(node, 'initializer'));
      if (kind === 'function') {
        const after = /\)([^)]*)$/.exec(text_of(first(node, 'argsstring')))?.[1] ?? '';
        return `${template(node)}${node.attributes.static === 'yes' ? 'static ' : ''}${type(first(node, 'type'))} ${name}(${parameters(node)})${escaped(after)}`.trim();
      }
      if (kind === 'enum') return `enum ${name}`;
      if (kind === 'typedef') return `using ${name} = ${type(first(node, 'type'))}${escaped(text_of(first(node, 'argsstring')))}`;
      return `${type(first(node, 'type'))} ${name}${value && value.length < 60 ? ` ${escaped(value)}` : ''}`;
    };
    const member = (node) => {
      const values = all(node, 'enumvalue').map(
        (one) => `<dt id="${one.attributes.id}"><code>${escaped(text_of(first(one, 'name')))}</code></dt><dd>${comment(one)}</dd>`,
      );
      return `<div class="member" id="${node.attributes.id}"><pre>${declaration(node)}</pre>${comment(node)}${values.length ? `<dl>${values.join('')}</dl>` : ''}</div>\n`;
    };
    const compound = (node) => {
      const name = escaped(short(text_of(first(node, 'compoundname'))));
      const kind = node.attributes.kind;
      const definition = kind === 'concept' ? `<pre>${escaped(short(text_of(first(node, 'initializer')).trim()))}</pre>` : '';
      const bases = all(node, 'basecompoundref').map((one) => link(one.attributes.refid, escaped(short(text_of(one)))));
      const members = all(node, 'sectiondef').flatMap((section) => all(section, 'memberdef')).filter((one) => !hidden(one));
      return `<section><h2 id="${node.attributes.id}"><small>${kind}</small> ${name}</h2>${template(node) && kind !== 'concept' ? `<pre>${template(node).trim()}</pre>` : ''}${bases.length ? `<p>Extends ${bases.join(', ')}.</p>` : ''}${definition}${comment(node)}${members.map(member).join('')}</section>\n`;
    };
    if (!entities.length) continue;
    const one = ({ node }) => (node.name === 'memberdef' ? member(node) : compound(node));
    const intro = about ? comment(about) : '';
    const told = intro || entities.map(({ node }) => words(first(node, 'briefdescription'))).find(Boolean) || '';
    summaries.push({ file, address, names: entities.map(({ node }) => short(text_of(first(node, 'compoundname') ?? first(node, 'name')))), sentence: told.replace(/<\/p>.*$/s, '').replace(/<[^>]*>/g, '') });
    pages.set(address, { title: file, body: `<h1>${file}</h1>\n<pre class="include">#include "limcycle/${file}"</pre>\n${intro}${entities.map(one).join('')}` });
  }
  return { pages, summaries };
}
