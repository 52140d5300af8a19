#!/usr/bin/env bash
# The layering check must be able to fail: each wrong line below, put alone into a tree that passes, has to be found.
set -euo pipefail
layering=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)/tools/layering
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT
failures=0

put() {  # FILE LINE
  mkdir -p "$tree/$(dirname "$1")"
  echo "$2" >"$tree/$1"
}

right() {  # FILE LINE
  put "$1" "$2"
  if ! "$layering" "$tree"; then
    echo "wrongly rejected: $1: $2"
    failures=$((failures + 1))
  fi
}

wrong() {  # FILE LINES MESSAGE [number of the line, 1]
  local said status=0
  put "$1" "$2"
  said=$("$layering" "$tree" 2>&1) || status=$?
  if ((status == 0)) || [[ $said != *"$1:${4:-1}:"*"$3"* ]]; then
    echo "not found: $1: $2 (status $status, said: $said)"
    failures=$((failures + 1))
  fi
  rm "$tree/$1"
}

right models/loop.hpp '#include <Eigen/Core>'
right models/friction/bristle/dahl.hpp '#include "limcycle/models/loop.hpp"'
right analysis/cycle.hpp '#include "limcycle/models/loop.hpp"'
right analysis/motion/steppers/rodas5p.hpp '#include <boost/numeric/odeint/stepper/stepper_categories.hpp>'
right analysis/motion/march.cpp '#include "limcycle/analysis/motion/steppers/rodas5p.hpp"'
right analysis/frequency/root.cpp '#include <gsl/gsl_multiroots.h>'
right analysis/orbit/cycle/shooting.cpp '  #  include "limcycle/analysis/cycle.hpp"  // not "limcycle/analysis/frequency/root.hpp"'
right analysis/study/predict/predict.cpp '#include "limcycle/analysis/frequency/root.hpp"'
right cases/load.cpp '#include <toml++/toml.h>'
right reports/page.cpp '#include "limcycle/analysis/orbit/cycle/shooting.hpp"'
right questions/predict.cpp '#include "limcycle/reports/text.hpp"'
right questions/asking/provenance_of.cpp '#include "build_info.hpp"'
right cli/main.cpp '#include "build_info.hpp"'
right cli/commands/predict.cpp '#include "limcycle/cases/load.hpp"'
right tests/analysis/root_test.cpp '#include <gsl/gsl_sf_ellint.h>'

arrow='may not include'
wrong models/a.hpp '#include "limcycle/analysis/cycle.hpp"' "$arrow"
wrong models/a.cpp '#include <gsl/gsl_math.h>' 'not a library of models'
wrong models/a.hpp '#include <boost/math/special_functions.hpp>' 'third-party header'
wrong models/a.cpp '#include <fstream>' 'prints nothing'
wrong analysis/a.hpp '#include "limcycle/analysis/motion/march.hpp"' "$arrow"
wrong analysis/motion/a.cpp '#include "limcycle/analysis/orbit/cycle/shooting.hpp"' "$arrow"
wrong analysis/frequency/a.cpp '#include "limcycle/analysis/orbit/cycle/shooting.hpp"' "$arrow"
wrong analysis/orbit/a.cpp '#include "limcycle/analysis/frequency/root.hpp"' "$arrow"
wrong analysis/orbit/a.cpp '#include "limcycle/analysis/study/predict/predict.hpp"' "$arrow"
wrong analysis/energy/a.cpp '#include "limcycle/analysis/orbit/cycle/shooting.hpp"' "$arrow"
wrong analysis/frequency/a.hpp '#include <fftw3.h>' 'third-party header'
wrong analysis/orbit/a.hpp '#include "limcycle/analysis/motion/steppers/rodas5p.hpp"' 'third-party types'
wrong analysis/study/a.cpp '#include <iostream>' 'prints nothing'
wrong analysis/study/a.cpp '#include <nlohmann/json.hpp>' 'not a library of analysis'
wrong analysis/study/a.cpp '#include "limcycle/cases/load.hpp"' "$arrow"
wrong analysis/new/a.cpp '#include "limcycle/models/loop.hpp"' 'no rule for the folder'
wrong cases/a.cpp '#include "limcycle/reports/page.hpp"' "$arrow"
wrong cases/a.cpp '#include "limcycle/questions/predict.hpp"' "$arrow"
wrong reports/a.cpp '#include "limcycle/questions/predict.hpp"' "$arrow"
wrong questions/a.cpp '#include "limcycle/cli/options.hpp"' "$arrow"
wrong cases/a.hpp '#include <toml++/toml.h>' 'third-party header'
wrong cases/a.cpp '#include "limcycle/analysis/motion/steppers/rodas5p.hpp"' 'third-party types'
wrong reports/a.cpp '#include "limcycle/cases/load.hpp"' "$arrow"
wrong reports/a.cpp '#include "limcycle/cli/options.hpp"' "$arrow"
wrong reports/a.cpp '#include <CLI/CLI.hpp>' 'not a library of reports'
wrong reports/a.hpp '#include <nlohmann/json_fwd.hpp>' 'third-party header'
wrong reports/a.hpp '#include "limcycle/reports/format/json_values.hpp"' 'third-party types'
wrong cli/a.cpp '#include "limcycle/reports/format/json_values.hpp"' 'third-party types'
wrong reports/a.cpp '#include "build_info.hpp"' 'spell it from the root'
wrong cli/a.cpp '#include "limcycle/tests/reference.hpp"' "$arrow"
wrong cli/a.cpp '#include "limcycle/bench/peer.hpp"' "$arrow"
wrong cli/a.cpp '#include "options.hpp"' 'spell it from the root'
wrong cli/a.cpp '#include "limcycle/models/../tests/reference.hpp"' 'no . or ..'
wrong cli/a.cpp '#include <limcycle/models/loop.hpp>' 'included with quotes'
wrong cli/a.cpp '#include HEADER' 'not a macro'
wrong tests/cli/a_test.cpp '#include "limcycle/cli/options.hpp"' "$arrow"
wrong bench/a.cpp '#include "limcycle/tests/reference.hpp"' "$arrow"

alike='in the same unnamed namespace'
right cli/a.cpp $'namespace {\nconstexpr int most = 3, least = 1;\nstruct Wait {};\n}  // namespace'
wrong cli/ranks/b.cpp $'namespace {\nconstexpr double most = 3.0;\n}  // namespace' "$alike" 2
wrong cli/b.cpp $'namespace {\nconst std::vector<int> few{1}, least{1, 2};\n}  // namespace' "$alike" 2
wrong cli/b.cpp $'namespace {\nclass Wait {\n};\n}  // namespace' "$alike" 2
right cases/b.cpp $'namespace {\nconstexpr double most = 3.0;\n}  // namespace'
right cli/b.cpp $'namespace {\nvoid wait() {\n  const int most = 2;\n}\n}  // namespace'

rm -rf "${tree:?}"/*
if "$layering" "$tree"; then
  echo "an empty tree passed"
  failures=$((failures + 1))
fi
exit $((failures > 0))
