// Comments, as Doxygen gives them in XML -> HTML.
import { escaped } from './markdown.mjs';

/// A function that writes what is in an element; `link(id, html)` makes a reference of some text. An element that is not
/// known is an error, so that nothing gets lost in silence.
export function words_of(link) {
  const inside = (node) => node.children.map(render).join('');
  const wrap = (tag) => (node) => `<${tag}>${inside(node)}</${tag}>`;
  const sign = (text) => () => text;
  const kinds = {
    para: wrap('p'), bold: wrap('strong'), emphasis: wrap('em'), computeroutput: wrap('code'), verbatim: wrap('pre'),
    preformatted: wrap('pre'), programlisting: wrap('pre'), codeline: (node) => `${inside(node)}\n`, highlight: inside,
    itemizedlist: wrap('ul'), orderedlist: wrap('ol'), listitem: wrap('li'), sect1: inside, title: wrap('strong'),
    table: wrap('table'), row: wrap('tr'), entry: wrap('td'), superscript: wrap('sup'), subscript: wrap('sub'),
    parameterlist: wrap('dl'), parameteritem: inside, parameternamelist: inside, parametername: wrap('dt'),
    parameterdescription: wrap('dd'), simplesect: (node) => `<p>${escaped(node.attributes.kind)}:</p>${inside(node)}`,
    ulink: (node) => `<a href="${escaped(node.attributes.url)}" rel="external">${inside(node)}</a>`,
    ref: (node) => link(node.attributes.refid, inside(node)),
    blockquote: (node) => `&gt; ${inside(node).replace(/^<p>|<\/p>$/g, '')}`, // a comment that begins with "> 0"
    zwj: sign(''), anchor: sign(''), sp: sign(' '), nonbreakablespace: sign('&nbsp;'), linebreak: sign('<br>'),
    hruler: sign('<hr>'), ndash: sign('–'), mdash: sign('—'), lsquo: sign('‘'), rsquo: sign('’'),
  };
  function render(node) {
    if (typeof node === 'string') return escaped(node);
    if (!kinds[node.name]) throw new Error(`a comment holds <${node.name}>, which the site does not know`);
    return kinds[node.name](node);
  }
  return (node) => (node ? inside(node).replace(/<p>\s*<\/p>/g, '').trim() : '');
}
