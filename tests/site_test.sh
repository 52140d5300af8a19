#!/usr/bin/env bash
# Does tools/site find what is wrong? It is run on a small repository that is made here.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir -p "$folder"/{tools,docs,cases,models,analysis,reports}
cp -r "$root"/tools/{site,site.mjs,site_parts,Doxyfile,install,assets} "$folder/tools"
cp "$root/package-lock.json" "$folder"
ln -s "$root/node_modules" "$folder/node_modules"
echo 'mass = 1.0' >"$folder/cases/a.toml"

readme='# Title
[a page](docs/page.md#a-part), [a file](cases/a.toml), [a folder](cases), [elsewhere](https://example.org/), $x^2$
## Two words
[here](#two-words)'
page='# Page
## A part
[back](../README.md#two-words)'
header='/// Length, m.
struct Rod {
  double length;  ///< > 0, m
};
/// Of a Rod.
double weight(const Rod& rod);'

# accepts/rejects WHAT README PAGE HEADER
build() {
  printf '%s\n' "$2" >"$folder/README.md"
  printf '%s\n' "$3" >"$folder/docs/page.md"
  printf '%s\n' "$4" >"$folder/models/rod.hpp"
  "$folder/tools/site" "$folder/site" >"$folder/said" 2>&1
}
accepts() { build "$@" || { echo "a site with $1 is not accepted: $(cat "$folder/said")"; exit 1; }; }
rejects() {
  [[ $2$3$4 != "$readme$page$header" ]] || { echo "the site with $1 is the good one"; exit 1; }
  ! build "$@" || { echo "a site with $1 is accepted"; exit 1; }
}

accepts "all links right" "$readme" "$page" "$header"
holds() { grep -q -- "$2" "$folder/site/$1" || { echo "$1 does not hold $2"; exit 1; }; }
holds index.html '<msup>'                       # the formula, as MathML
holds index.html 'href="page.html#a-part"'
holds files/cases/a.toml.html 'mass = 1.0'
holds api/models/rod.hpp.html '&gt; 0, m'
holds api/models/rod.hpp.html '>Rod</a> &amp; rod'
grep -q 'https://example.org/' "$folder/said" || { echo "the link to another site is not listed"; exit 1; }

rejects "a page that is not there" "${readme/docs\/page.md/docs/no.md}" "$page" "$header"
rejects "a file that is not there" "${readme/cases\/a.toml/cases\/b.toml}" "$page" "$header"
rejects "an anchor that is not there" "${readme/\#a-part/#another-part}" "$page" "$header"
rejects "an anchor on its own page that is not there" "${readme/(#two-words)/(#three-words)}" "$page" "$header"
rejects "a wrong link back" "$readme" "${page/\#two-words/#two}" "$header"
rejects "a formula that cannot be read" "${readme/x^2/\\frac{x}" "$page" "$header"
rejects "a page without a title" "$readme" "${page/\# Page/Page}" "$header"
rejects "a picture from elsewhere" "$readme
![x](https://example.org/x.png)" "$page" "$header"
rejects "a comment that Doxygen cannot read" "$readme" "$page" "${header/Of a Rod./Of a <Rod>.}"
