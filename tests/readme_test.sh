#!/usr/bin/env bash
# Does tools/readme find what is wrong? It is run on pages made here, with a program that prints known lines.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/tools" "$folder/docs" "$folder/cases"
cp "$root/tools/readme" "$folder/tools"
echo 'mass = 1.0' >"$folder/cases/a.toml"
touch "$folder/README.md"

cat >"$folder/program" <<'END'
#!/usr/bin/env bash
case $1 in
  say) printf 'Title\n\nperiod 24.43678 s\nerror 1.0e-09\n\nNotes\n%s\n' "$2" ;;
  refuse) echo "limcycle: no such key" >&2; exit 2 ;;
  predict) echo '<svg/>' >"${@: -1}" ;;
esac
END
chmod +x "$folder/program"

good='<!-- output: limcycle say "two words" -->
```
Title

period 24.43678 s
error 1.0e-09

Notes
two words
```
<!-- output from "period" to "Notes": limcycle say x -->
```
period 24.43678 s
error 1.0e-09
```
<!-- refused: limcycle refuse -->
```
limcycle: no such key
```
<!-- file: cases/a.toml -->
```toml
mass = 1.0
```'

readme() { "$folder/tools/readme" "$@" "$folder/program" >"$folder/said" 2>&1; }
# accepts/rejects WHAT PAGE
accepts() {
  printf '%s\n' "$2" >"$folder/docs/page.md"
  readme || { echo "a page with $1 is not accepted: $(cat "$folder/said")"; exit 1; }
}
rejects() {
  printf '%s\n' "$2" >"$folder/docs/page.md"
  [[ $2 != "$good" ]] || { echo "the page with $1 is the good one"; exit 1; }
  ! readme || { echo "a page with $1 is accepted"; exit 1; }
}

printf '%s\n' "$good" >"$folder/docs/page.md"
readme --fix # makes the pictures
cmp -s "$folder/docs/page.md" <(printf '%s\n' "$good") || { echo "--fix changes a page that is right"; exit 1; }

accepts "all as printed" "$good"
accepts "a number within 1e-5" "${good//24.43678/24.43679}"
accepts "another tiny error" "${good//1.0e-09/3.0e-09}"
rejects "another number" "${good//24.43678/24.43778}"
rejects "another word" "${good/two words
/three words
}"
rejects "a line too few" "${good/error 1.0e-09
/}"
rejects "another message" "${good/no such key/no key}"
rejects "a file with another number" "${good/mass = 1.0/mass = 1.000001}"
rejects "a file that is not there" "${good/a.toml/b.toml}"
rejects "a part that does not end" "${good/to \"Notes\"/to \"End\"}"
rejects "a part that does not begin" "${good/from \"period\"/from \"frequency\"}"
rejects "a command that is refused" "${good/limcycle say x/limcycle refuse}"
rejects "a refusal that does not happen" "${good/limcycle refuse/limcycle say x}"
rejects "a block that cannot be read" "${good/ from \"period\" to/ from period to}"
rejects "a block without its fence" "${good/-->
\`\`\`toml/-->}"
rejects "nothing to check" "words only"

printf '%s\n' "${good//24.43678/25}" >"$folder/docs/page.md"
readme --fix
cmp -s "$folder/docs/page.md" <(printf '%s\n' "$good") || { echo "--fix does not mend a page"; exit 1; }
