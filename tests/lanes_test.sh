#!/usr/bin/env bash
# What a source for one instruction set leaves to the linker to choose from (weak symbols) must name that set and how it
# rounds in its type, Pack<lanes, set, products>. Else its code could stand in for the portable one and end the program
# on a machine without it, or in a lane_march_* source, which rounds every product, for one that does not.
#   tests/lanes_test.sh ARCHIVE
set -euo pipefail
symbols=$(nm -C --defined-only "$1" 2>/dev/null)
awk '
  /^[^ ]+\.o:$/ { special = /_(avx2|avx512)\.cpp\.o:$/; seen += special; member = $1
    type = "Pack<[0-9]+, \\(limcycle::Isa\\)[0-9], \\(limcycle::Products\\)" (/lane_march_/ ? 1 : 0) ">"; next }
  special && $2 ~ /^[WVuU]$/ && $0 !~ type { print "lanes: " member " shares " $0; bad = 1 }
  END {
    if (seen < 2) { print "lanes: no sources for instruction sets found"; bad = 1 }
    exit bad
  }' <<<"$symbols"
