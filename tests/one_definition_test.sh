#!/usr/bin/env bash
# Sources for one instruction set must hold no function that the linker may put in the place of another source's: it
# keeps one of those of a name, and the program would crash on an older machine or round otherwise than it promises.
#   one_definition_test.sh BUILD_FOLDER
set -euo pipefail
cd "$1/CMakeFiles/limcycle_analysis.dir"

weak() { nm -A "$@" | sed -nE 's/^([^:]*):[0-9a-f]* [Wu] (.*)$/\1 \2/p'; }
# How a source is compiled: lane_march_* rounds every product, other kernels may fuse them; all else, and those named
# scalar, are portable.
mapfile -t objects < <(find . ../limcycle_models.dir ../limcycle_reports.dir ../limcycle_cases.dir ../limcycle.dir -name '*.o')
((${#objects[@]} > 20)) || { echo "no objects under $PWD" >&2; exit 1; }
found=$(weak "${objects[@]}" | awk '
  { way = "portable"
    if (match($1, /_(avx2|avx512)\.cpp\.o$/)) way = substr($1, RSTART) ($1 ~ /lane_march_/ ? " rounded" : " fused")
    special[way] = way != "portable"
    if (!($2 in first)) { first[$2] = way; file[$2] = $1; next }
    if (first[$2] != way) print $2, file[$2], $1
  }
  END { for (way in special) ways += special[way]; if (ways < 4) print "only", ways, "ways" }' | sort -u)
[[ -z $found ]] || { echo "one name, compiled in two ways:" >&2; c++filt <<<"$found" >&2; exit 1; }
