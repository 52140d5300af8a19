/// @file
/// The cells of the root search: which hold a root, which cannot, and which must be bisected. (Internal to the search.)
#pragma once

#include <complex>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "limcycle/analysis/frequency/roots/root_cell.hpp"
#include "limcycle/analysis/frequency/roots/root_lattice.hpp"
#include "limcycle/analysis/frequency/roots/root_search.hpp"
#include "limcycle/analysis/frequency/roots/root_winding.hpp"

namespace limcycle {

/// State of the search in an initial block.
struct RootBlock {
  LatticeCell place;
  int min_depth = 1;                  ///< cells above are always bisected; one at least, so that every model is checked
  double caution = 1.0;               ///< see CellKnowledge
  std::vector<LatticeCell> leaves;    ///< decided cells in which f is defined
  std::vector<NearMiss> near_misses;  ///< in undecided cells
};

/// A root in the coordinates of the search.
struct FoundRoot {
  double p, q;  ///< ln A, ln w
  Root root;
};

/// The tree of cells over the lattice, bisected along p, q or both until each cell is decided or at its limit of depth.
class RootTree {
 public:
  RootTree(const LoopEquation& f, const SearchBox& box, const RootSearchOptions& options);

  /// Decides all waiting cells (at first all blocks). Throws RootBudgetExhausted, RootSearchInterrupted, and what f
  /// throws; results until then are kept.
  void search();
  /// Makes search() decide a block once more, from a finer grid and with more caution. False at the limit of depth.
  bool search_again(std::size_t block);
  /// True if the winding number along the border of the block agrees with the roots in it, or cannot be determined.
  bool agrees(const RootBlock& block);
  /// Sum of the indices of the roots that lie in the cells.
  int index_sum(const std::vector<LatticeCell>& cells) const;

  RootLattice& lattice() { return lattice_; }
  const std::vector<RootBlock>& blocks() const { return blocks_; }
  const std::vector<FoundRoot>& roots() const { return roots_; }
  /// f was sampled, and is defined at no sample.
  bool nowhere_defined() const { return any_sampled_ && !any_defined_; }

 private:
  struct Cell {
    std::size_t block;
    LatticeCell place;
    int depth_p = 0, depth_q = 0;  // bisections since the block
    std::size_t accuracy = 0;      // index in RootLattice::accuracies()
    CellSamples predicted{};       // by the model of the parent
    bool has_prediction = false;
  };
  struct Directions {
    bool p, q;
  };

  bool near_border(const FoundRoot& root, const LatticeCell& s) const;
  void line_up(const Cell& cell);
  void process(Cell cell);
  void prepare() const;
  bool decided_by_jump(const Cell& cell, const CellKnowledge& knowledge);
  void process_border(const Cell& cell, const CellSamples& values);
  void settle(const Cell& cell, const CellSamples& values, const CellAssessment& assessment);
  void give_up_or_split(const Cell& cell, const CellKnowledge& knowledge, const CellAssessment& assessment);
  bool split(const Cell& cell, Directions along, int limit, const CellSamples* model);
  void add_near_miss(const Cell& cell, const CellSamples& values);
  CellSamples gather(const Cell& cell);
  std::optional<FoundRoot> polish(const Cell& cell, double u, double v);
  void record(const FoundRoot& root);
  bool only_edge_defined(const Cell& cell, const CellSamples& values);
  double p_at(const LatticeCell& s, double u) const;
  double q_at(const LatticeCell& s, double v) const;
  double half_p(const LatticeCell& s) const { return 0.5 * (lattice_.p(s.i + s.width) - lattice_.p(s.i)); }
  double half_q(const LatticeCell& s) const { return 0.5 * (lattice_.q(s.j + s.height) - lattice_.q(s.j)); }
  double noise(std::size_t accuracy) const { return lattice_.accuracies()[accuracy]; }
  bool contains(const LatticeCell& s, const FoundRoot& root, double margin) const;

  const RootSearchOptions options_;
  RootLattice lattice_;
  std::vector<RootBlock> blocks_;
  std::deque<Cell> queue_;  // first in, first out, so that a limited search covers the box evenly
  std::vector<FoundRoot> roots_;
  bool any_sampled_ = false, any_defined_ = false;
};

}  // namespace limcycle
