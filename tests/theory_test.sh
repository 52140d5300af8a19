#!/usr/bin/env bash
# Does docs/theory.md name every claim about a formula (series A to E), and none that there is not?
#   tests/theory_test.sh PROGRAM
set -euo pipefail
program=$1
page=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)/docs/theory.md
claims=$("$program" claims --list --json - | grep -oE '"id":"[A-E][^"]*"' | cut -d'"' -f4 | sort)
named=$(grep -oE '`[A-E][0-9]+[a-z]?(-[0-9])?`|texttt\{[A-E][0-9]+\}' "$page" | grep -oE '[A-E][0-9]+[a-z]?(-[0-9])?' | sort -u)
[[ $(wc -l <<<"$claims") -gt 50 ]] || { echo "only these claims were listed: $claims" >&2; exit 1; }
diff <(echo "$claims") <(echo "$named") || { echo "docs/theory.md (>) does not name the claims of the program (<)" >&2; exit 1; }
