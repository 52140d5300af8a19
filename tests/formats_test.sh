#!/usr/bin/env bash
# Does docs/formats.md name every key that the loader knows, and has every command a schema that the page links to, a
# section of docs/how-to.md and a line of README.md?
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
failed=false
complain() {
  echo "documentation: $*" >&2
  failed=true
}

keys=$(tr '\n' ' ' <<<"$(cat cases/loader/sections/read_*.cpp)" | grep -oE 'allow\(\{[^}]*\}' | grep -oE '"[^"]+"' | tr -d '"' | sort -u)
(($(wc -w <<<"$keys") > 30)) || complain "only these keys were found: $keys"
for key in $keys; do
  grep -qE "[\`{. ]$key[\`,} ]|loop\\.$key\\]" docs/formats.md || complain "docs/formats.md does not name the key $key"
done

commands=$(grep -rl 'wants_json()' cli --include=*.cpp | sed 's|.*/||; s|\.cpp||' | grep -v '^output$')
(($(wc -w <<<"$commands") > 10)) || complain "only these commands were found: $commands"
for command in $commands; do
  [[ $command != report ]] || continue # its document is that of predict
  [[ -s docs/schema/$command.json ]] || complain "the command $command has no schema"
  grep -q "(schema/$command.json)" docs/formats.md || complain "the schema of $command is not linked to"
  grep -q "^## $command\$" docs/how-to.md || complain "docs/how-to.md has no section on $command"
  grep -q "^| \`limcycle $command" README.md || complain "README.md does not list $command"
done
[[ $failed == false ]]
