#!/usr/bin/env bash
# Does docs/formats.md name every key that the loader knows, and has every command a schema that the page links to?
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
failed=false
complain() {
  echo "docs/formats.md: $*" >&2
  failed=true
}

keys=$(tr '\n' ' ' <<<"$(cat cases/read_*.cpp)" | grep -oE 'allow\(\{[^}]*\}' | grep -oE '"[^"]+"' | tr -d '"' | sort -u)
(($(wc -w <<<"$keys") > 30)) || complain "only these keys were found: $keys"
for key in $keys; do
  grep -qE "[\`{. ]$key[\`,} ]|loop\\.$key\\]" docs/formats.md || complain "the key $key is missing"
done

commands=$(grep -l 'wants_json()' cli/*.cpp | sed 's|cli/||; s|\.cpp||' | grep -v '^output$')
(($(wc -w <<<"$commands") > 10)) || complain "only these commands were found: $commands"
for command in $commands; do
  [[ -s docs/schema/$command.json ]] || complain "the command $command has no schema"
  grep -q "(schema/$command.json)" docs/formats.md || complain "the schema of $command is not linked to"
done
[[ $failed == false ]]
