// Makes the static site: node tools/site.mjs XML FOLDER, called by tools/site.
import { copyFileSync, existsSync, mkdirSync, readFileSync, readdirSync, rmSync, statSync, writeFileSync } from 'node:fs';
import { dirname, posix } from 'node:path';
import { api_pages } from './site_parts/api.mjs';
import { escaped, page_of } from './site_parts/markdown.mjs';

const [xml, out] = process.argv.slice(2);

// The chapters, as they are listed at the side; pages of docs/ that are not named here follow.
const chapters = [
  ['Begin', ['README.md', 'docs/tutorial.md', 'docs/gallery.md']],
  ['Use', ['docs/how-to.md', 'docs/formats.md', 'docs/laws.md', 'docs/python.md', 'docs/notebooks.md', 'docs/library.md']],
  ['Understand', ['docs/methods.md', 'docs/theory.md', 'docs/dissipativity.md', 'docs/sensitivity.md', 'docs/numerical-stability.md']],
];
const short_titles = {
  'README.md': 'limcycle', 'docs/tutorial.md': 'Tutorial: ten minutes', 'docs/how-to.md': 'How to ask each question',
  'docs/methods.md': 'Methods and their limits', 'docs/theory.md': 'Theory', 'docs/formats.md': 'Files and formats', 'docs/dissipativity.md': 'Energy', 'docs/sensitivity.md': 'Sensitivity and maps',
  'docs/numerical-stability.md': 'Numerical stability', 'docs/laws.md': 'Laws, elements, plants',
};

const relative = (from, to) => posix.relative(posix.dirname(from), to) || posix.basename(to);
const problems = [];
const outside = new Map(); // address -> pages that link there
const written = new Map(); // address in the site -> {ids, links: [{href, page}]}

/// Where a file of the repository is in the site.
function address_of(path) {
  if (path === 'README.md') return 'index.html';
  const page = /^docs\/([\w-]+)\.md$/.exec(path);
  if (page) return `${page[1]}.html`;
  if (/\.(svg|png|jpg)$/.test(path)) return `files/${path}`;
  return `files/${path}.html`;
}

const wanted = []; // files of the repository that pages link to, in the order met
const queued = new Set();
function want(path) {
  if (!queued.has(path)) {
    queued.add(path);
    wanted.push(path);
  }
}

/// The address of a link of `path` to `href`; notes what is wrong with it.
function resolved(path, href) {
  if (/^[a-z]+:/.test(href)) {
    outside.set(href, [...(outside.get(href) ?? []), path]);
    return href;
  }
  const [file, anchor] = href.split('#');
  const target = file === '' ? path : posix.normalize(posix.join(posix.dirname(path), decodeURI(file))).replace(/\/$/, '');
  if (target.startsWith('..') || !existsSync(target)) {
    problems.push(`${path}: no ${href}`);
    return '#';
  }
  want(target);
  return (file === '' ? '' : relative(address_of(path), address_of(target))) + (anchor ? `#${anchor}` : '');
}

function write(address, text) {
  mkdirSync(dirname(`${out}/${address}`), { recursive: true });
  writeFileSync(`${out}/${address}`, text);
}

const style = readFileSync(new URL('site_parts/style.css', import.meta.url), 'utf8');
let menu = []; // [heading, [{address, title}]]

function side(address) {
  return menu
    .map(([heading, pages]) => {
      const links = pages.map((page) => {
        const here = page.address === address ? ' aria-current="page"' : '';
        return `<li><a href="${relative(address, page.address)}"${here}>${escaped(page.title)}</a></li>`;
      });
      return `<p>${heading}</p>\n<ul>\n${links.join('\n')}\n</ul>`;
    })
    .join('\n');
}

function contents(headings) {
  const parts = headings.filter((one) => one.level === 2);
  if (parts.length < 3) return '';
  const links = parts.map((one) => `<li><a href="#${one.id}">${one.html}</a></li>`);
  return `<details class="contents" open><summary>On this page</summary>\n<ul>\n${links.join('\n')}\n</ul></details>\n`;
}

function write_page(address, title, body) {
  const html = `<!doctype html>
<html lang="en">
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<title>${escaped(title)}${address === 'index.html' ? '' : ' · limcycle'}</title>
<link rel="stylesheet" href="${relative(address, 'style.css')}">
<body>
<a class="skip" href="#content">Skip to the text</a>
<nav aria-label="Pages">
${side(address)}
</nav>
<main id="content">
${body}
</main>
</body>
</html>
`;
  if (/<(?:img|script|link|iframe|source)[^>]*(?:src|href)="(?:https?:)?\/\//.test(html)) problems.push(`${address}: asks the network for something`);
  const ids = [...html.matchAll(/\sid="([^"]+)"/g)].map((found) => found[1]);
  for (const id of new Set(ids)) if (ids.filter((one) => one === id).length > 1) problems.push(`${address}: the anchor #${id} stands there twice`);
  const links = [...html.matchAll(/<(?:a|img|link)\s[^>]*?(?:href|src)="([^"]+)"/g)].map((found) => found[1]);
  written.set(address, { ids: new Set(ids), links });
  write(address, html);
}

/// A page of Markdown with its contents after the title.
function write_markdown(path) {
  const { html, headings, title } = page_of(readFileSync(path, 'utf8'), (href) => resolved(path, href));
  const end = html.indexOf('</h1>') + 5;
  write_page(address_of(path), title, html.slice(0, end) + contents(headings) + html.slice(end));
}

/// A file that is linked to: pictures as they are, folders as a list, other text in a page.
function write_file(path) {
  const address = address_of(path);
  if (/\.(svg|png|jpg)$/.test(path)) {
    mkdirSync(dirname(`${out}/${address}`), { recursive: true });
    copyFileSync(path, `${out}/${address}`);
    written.set(address, { ids: new Set(), links: [] });
  } else if (statSync(path).isDirectory()) {
    const files = readdirSync(path).filter((one) => statSync(`${path}/${one}`).isFile()).sort();
    for (const file of files) want(`${path}/${file}`);
    const links = files.map((file) => `<li><a href="${relative(address, address_of(`${path}/${file}`))}">${escaped(file)}</a></li>`);
    write_page(address, path, `<h1>${path}</h1>\n<ul>${links.join('\n')}</ul>`);
  } else if (path.endsWith('.md')) {
    write_markdown(path);
  } else {
    const text = readFileSync(path, 'utf8');
    if (text.includes('\0')) throw new Error(`${path} is linked to, and is no text`);
    write_page(address, path, `<h1>${path}</h1>\n<pre><code>${escaped(text)}</code></pre>`);
  }
}

/// Every type and function in the order of the alphabet; of overloads the first.
function write_names(summaries) {
  const names = new Map();
  for (const one of summaries)
    for (const { name, id } of one.names) if (!names.has(name)) names.set(name, `${relative('api/names.html', one.address)}#${id}`);
  const letters = new Map();
  for (const [name, href] of [...names].sort(([a], [b]) => a.localeCompare(b, 'en'))) {
    const letter = name[0].toUpperCase();
    letters.set(letter, `${letters.get(letter) ?? ''}<li><a href="${href}"><code>${escaped(name)}</code></a></li>\n`);
  }
  const parts = [...letters].map(([letter, list]) => `<h2 id="${letter}">${letter}</h2>\n<ul class="names">\n${list}</ul>\n`);
  write_page('api/names.html', 'All types and functions', `<h1>All types and functions</h1>\n${parts.join('')}`);
}

function write_api() {
  const { pages, summaries } = api_pages(xml, relative);
  const folders = new Map();
  for (const one of summaries) folders.set(posix.dirname(one.file), [...(folders.get(posix.dirname(one.file)) ?? []), one]);
  write_names(summaries);
  let body = `<h1>API reference</h1>\n<p>Every header, by folder. Dependence runs <code>models &lt;- analysis &lt;- {cases, reports}</code>; all names are in namespace <code>limcycle</code>. The same by name: <a href="names.html">all types and functions</a>.</p>\n`;
  const layers = ['models', 'analysis', 'cases', 'reports'];
  const layer = (folder) => layers.indexOf(folder.split('/')[0]);
  for (const [folder, list] of [...folders].sort(([a], [b]) => layer(a) - layer(b) || (a < b ? -1 : 1))) {
    body += `<h2 id="${folder.replaceAll('/', '-')}">${folder}</h2>\n<dl class="headers">\n`;
    for (const one of list)
      body += `<dt><a href="${relative('api/index.html', one.address)}">${posix.basename(one.file)}</a></dt><dd>${one.sentence}</dd>\n`;
    body += '</dl>\n';
  }
  write_page('api/index.html', 'API reference', body);
  for (const [address, { title, body: text }] of pages) write_page(address, title, text);
  return pages.size;
}

/// Does every link of every page lead to a page, and to an anchor that is there?
function check_links() {
  let links = 0;
  for (const [address, page] of written)
    for (const href of page.links) {
      if (/^[a-z]+:/.test(href)) continue;
      ++links;
      const [file, anchor] = href.replaceAll('&amp;', '&').split('#');
      const target = file === '' ? address : posix.normalize(posix.join(posix.dirname(address), file));
      if (target === 'style.css') continue;
      if (!written.has(target)) problems.push(`${address}: links to ${href}, which is not there`);
      else if (anchor && !written.get(target).ids.has(decodeURIComponent(anchor))) problems.push(`${address}: links to ${href}, which has no such anchor`);
    }
  return links;
}

function site() {
  rmSync(out, { recursive: true, force: true });
  const named = chapters.flatMap(([, pages]) => pages);
  const docs = readdirSync('docs').filter((file) => file.endsWith('.md')).map((file) => `docs/${file}`);
  chapters[2][1].push(...docs.filter((file) => !named.includes(file)).sort());
  const title = (path) => short_titles[path] ?? /^# (.*)$/m.exec(readFileSync(path, 'utf8'))[1].replaceAll('`', '');
  menu = chapters.map(([heading, pages]) => [
    heading,
    pages.filter((path) => existsSync(path)).map((path) => ({ address: address_of(path), title: title(path) })),
  ]);
  menu[1][1].push({ address: 'api/index.html', title: 'API reference' });
  write('style.css', style);
  for (const [, pages] of chapters) pages.filter((path) => existsSync(path)).forEach(want);
  for (let i = 0; i < wanted.length; ++i) write_file(wanted[i]); // pages add to the list
  const headers = write_api();
  const links = check_links();
  if (outside.size) {
    console.log('tools/site: links to other sites, not followed:');
    for (const [href, pages] of [...outside].sort()) console.log(`  ${href} (${[...new Set(pages)].join(', ')})`);
  }
  for (const problem of problems) console.error(`tools/site: ${problem}`);
  console.log(`tools/site: ${out}/index.html: ${written.size} pages and pictures, ${headers} headers, ${links} links, ${problems.length} wrong`);
  process.exit(problems.length ? 1 : 0);
}

site();
