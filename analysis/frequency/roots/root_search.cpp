#include "limcycle/analysis/frequency/roots/root_search.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <sstream>
#include <stdexcept>
#include <tuple>

#include "limcycle/analysis/frequency/roots/root_lattice.hpp"
#include "limcycle/analysis/frequency/roots/root_tree.hpp"
#include "limcycle/analysis/frequency/roots/root_winding.hpp"

namespace limcycle {
namespace {

// Searches until the roots in every block agree with the winding number along its border; false if some never agree.
bool search_until_blocks_agree(RootTree& tree) {
  constexpr int repetitions = 3;
  for (int attempt = 0;; ++attempt) {
    tree.search();
    bool agree = true, again = false;
    for (std::size_t k = 0; k < tree.blocks().size(); ++k) {
      if (tree.agrees(tree.blocks()[k])) continue;
      agree = false;
      if (attempt < repetitions && tree.search_again(k)) again = true;
    }
    if (!again) return agree;
  }
}

// Winding number and index sum of the whole region where f is defined; false if they disagree or cannot be determined.
bool compare_with_winding(RootTree& tree, RootSearch& out) {
  std::vector<LatticeCell> all;
  for (const RootBlock& block : tree.blocks()) all.insert(all.end(), block.leaves.begin(), block.leaves.end());
  const auto winding = border_winding(tree.lattice(), all);
  out.winding_number = winding.value_or(0);
  out.index_sum = tree.index_sum(all);
  return winding && *winding == out.index_sum;
}

void collect(const RootTree& tree, RootSearch& out) {
  for (const FoundRoot& found : tree.roots()) out.roots.push_back(found.root);
  for (const RootBlock& block : tree.blocks()) {
    out.near_misses.insert(out.near_misses.end(), block.near_misses.begin(), block.near_misses.end());
  }
  const auto by_frequency = [](const auto& a, const auto& b) {
    return std::tie(a.frequency, a.amplitude) < std::tie(b.frequency, b.amplitude);
  };
  std::sort(out.roots.begin(), out.roots.end(), by_frequency);
  std::sort(out.near_misses.begin(), out.near_misses.end(), by_frequency);
}

RootSearch conclude(RootTree& tree) {
  RootSearch out;
  try {
    const bool blocks_agree = search_until_blocks_agree(tree);
    const bool whole_agrees = compare_with_winding(tree, out);
    collect(tree, out);
    out.status = out.roots.empty() ? Status::no_cycle : Status::converged;
    if (!blocks_agree || !whole_agrees || !out.near_misses.empty()) out.status = Status::incomplete;
    if (tree.nowhere_defined()) out.status = Status::not_finite;
  } catch (const RootBudgetExhausted&) {
    collect(tree, out);
    out.status = Status::max_iterations;
  } catch (const RootSearchInterrupted&) {
    collect(tree, out);
    out.status = Status::interrupted;
  }
  out.evaluations = tree.lattice().evaluations();
  return out;
}

template <typename T>
void require(bool good, const char* name, T value, const char* range) {
  if (good) return;
  std::ostringstream message;
  message << "root search: " << name << " must be " << range << ", not " << value;
  throw std::invalid_argument(message.str());
}

}  // namespace

void validate(const RootSearchOptions& o) {
  const auto cells = [](int n) { return n >= 1 && n <= 1000; };
  require(cells(o.initial_cells_amplitude), "initial_cells_amplitude", o.initial_cells_amplitude, "in 1..1000");
  require(cells(o.initial_cells_frequency), "initial_cells_frequency", o.initial_cells_frequency, "in 1..1000");
  require(o.max_depth >= 2 && o.max_depth <= 40, "max_depth", o.max_depth, "in 2..40");
  require(o.max_border_depth >= 2 && o.max_border_depth <= o.max_depth, "max_border_depth", o.max_border_depth,
          "in 2..max_depth");
  require(o.max_evaluations > 0, "max_evaluations", o.max_evaluations, "positive");
  require(o.residual > 0.0 && o.residual < 1.0, "residual", o.residual, "in (0, 1)");
  require(o.fine_accuracy >= 1e-15 && o.fine_accuracy <= 0.01, "fine_accuracy", o.fine_accuracy, "in 1e-15..0.01");
  require(o.coarse_accuracy >= o.fine_accuracy && o.coarse_accuracy <= 0.01, "coarse_accuracy", o.coarse_accuracy,
          "in fine_accuracy..0.01");
  for (const double a : o.amplitude_hints) require(a > 0.0 && std::isfinite(a), "amplitude hint", a, "positive");
  for (const double w : o.frequency_hints) require(w > 0.0 && std::isfinite(w), "frequency hint", w, "positive");
}

RootSearch find_roots(const LoopEquation& f, const SearchBox& box, const RootSearchOptions& options) {
  validate(options);
  RootLattice probe(f, box, options);
  RootSearchOptions extended = options;
  try {
    const auto borders = existence_borders(probe, box, options.initial_cells_amplitude);
    extended.amplitude_hints.insert(extended.amplitude_hints.end(), borders.begin(), borders.end());
  } catch (const RootBudgetExhausted&) {
    extended.max_evaluations = probe.evaluations();  // nothing is left for the search
  } catch (const RootSearchInterrupted&) {
    RootSearch none;
    none.status = Status::interrupted;
    none.evaluations = probe.evaluations();
    return none;
  }
  extended.max_evaluations -= probe.evaluations();
  RootTree tree(f, box, extended);
  RootSearch out = conclude(tree);
  out.evaluations += probe.evaluations();
  return out;
}

}  // namespace limcycle
