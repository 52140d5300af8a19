#include "limcycle/analysis/frequency/roots/root_tree.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "limcycle/analysis/frequency/roots/root_jump.hpp"
#include "limcycle/analysis/frequency/roots/root_polish.hpp"

namespace limcycle {
namespace {

using Complex = std::complex<double>;

bool defined(Complex f) { return !std::isnan(f.real()); }

}  // namespace

RootTree::RootTree(const LoopEquation& f, const SearchBox& box, const RootSearchOptions& options)
    : options_(options), lattice_(f, box, options) {
  const std::int64_t unit = lattice_.unit();
  for (std::int64_t column = 0; column < lattice_.columns(); ++column) {
    for (std::int64_t row = 0; row < lattice_.rows(); ++row) {
      const LatticeCell place{column * unit, row * unit, unit, unit};
      line_up({blocks_.size(), place});
      blocks_.push_back({place, 1, 1.0, {}, {}});
    }
  }
}

void RootTree::line_up(const Cell& cell) {
  if (!options_.rootless) return queue_.push_back(cell);
  const auto& [i, j, width, height] = cell.place;
  const SearchBox part{lattice_.amplitude(lattice_.p(i)), lattice_.amplitude(lattice_.p(i + width)),
                       lattice_.frequency(lattice_.q(j)), lattice_.frequency(lattice_.q(j + height))};
  if (!options_.rootless(part)) queue_.push_back(cell);
}

bool RootTree::search_again(std::size_t k) {
  RootBlock& block = blocks_[k];
  if (block.min_depth + 1 >= options_.max_depth) return false;
  block = {block.place, block.min_depth + 1, 2.0 * block.caution, {}, {}};
  line_up({k, block.place});
  return true;
}

double RootTree::p_at(const LatticeCell& s, double u) const { return lattice_.p(s.i + s.width / 2) + u * half_p(s); }
double RootTree::q_at(const LatticeCell& s, double v) const { return lattice_.q(s.j + s.height / 2) + v * half_q(s); }

// margin: in half-widths of the square
bool RootTree::contains(const LatticeCell& s, const FoundRoot& root, double margin) const {
  return std::abs(root.p - p_at(s, 0.0)) <= (1.0 + margin) * half_p(s) &&
         std::abs(root.q - q_at(s, 0.0)) <= (1.0 + margin) * half_q(s);
}

CellSamples RootTree::gather(const Cell& cell) {
  CellSamples values;
  const std::int64_t right = cell.place.width / 2, up = cell.place.height / 2;
  for (std::size_t k = 0; k < 9; ++k) {
    const auto a = static_cast<std::int64_t>(k % 3), b = static_cast<std::int64_t>(k / 3);
    values[k] = lattice_.sample(cell.place.i + a * right, cell.place.j + b * up, lattice_.accuracies()[cell.accuracy]);
  }
  return values;
}

// Bisects in the directions requested that are not at their limit; false if there is none.
bool RootTree::split(const Cell& cell, Directions along, int limit, const CellSamples* model) {
  const bool by_p = along.p && cell.depth_p < limit, by_q = along.q && cell.depth_q < limit;
  const double width = by_p ? 0.5 : 1.0, height = by_q ? 0.5 : 1.0;  // of the child, in those of the cell
  Cell child = cell;
  child.depth_p += by_p ? 1 : 0;
  child.depth_q += by_q ? 1 : 0;
  child.has_prediction = model != nullptr;
  if (by_p) child.place.width /= 2;
  if (by_q) child.place.height /= 2;
  for (std::int64_t right = 0; right < (by_p ? 2 : 1) && (by_p || by_q); ++right) {
    for (std::int64_t up = 0; up < (by_q ? 2 : 1); ++up) {
      child.place.i = cell.place.i + right * child.place.width;
      child.place.j = cell.place.j + up * child.place.height;
      for (std::size_t k = 0; model != nullptr && k < 9; ++k) {
        const double u = -1.0 + width * static_cast<double>(2 * right + static_cast<std::int64_t>(k % 3));
        const double v = -1.0 + height * static_cast<double>(2 * up + static_cast<std::int64_t>(k / 3));
        child.predicted[k] = interpolate(*model, u, v);
      }
      line_up(child);
    }
  }
  return by_p || by_q;
}

void RootTree::process(Cell cell) {
  for (; cell.accuracy < lattice_.accuracies().size(); ++cell.accuracy) {
    const CellSamples values = gather(cell);
    const auto known = std::count_if(values.begin(), values.end(), defined);
    any_sampled_ = true;
    any_defined_ = any_defined_ || known > 0;
    const int first = blocks_[cell.block].min_depth;
    if (split(cell, {true, true}, first, known == 9 ? &values : nullptr)) return;
    if (known == 0) return;
    if (known < 9) return process_border(cell, values);
    CellKnowledge knowledge{values, {}, cell.has_prediction, noise(cell.accuracy), blocks_[cell.block].caution};
    for (std::size_t k = 0; cell.has_prediction && k < 9; ++k) knowledge.surprise[k] = values[k] - cell.predicted[k];
    const CellAssessment assessment = assess(knowledge);
    if (assessment.verdict == CellVerdict::no_root) return blocks_[cell.block].leaves.push_back(cell.place);
    if (assessment.verdict == CellVerdict::at_most_one) return settle(cell, values, assessment);
    if (decided_by_jump(cell, knowledge)) return;
    const bool finest = cell.accuracy + 1 == lattice_.accuracies().size();
    if (assessment.verdict == CellVerdict::unclear || finest) {
      return give_up_or_split(cell, knowledge, assessment);
    }
  }
}

void RootTree::give_up_or_split(const Cell& cell, const CellKnowledge& knowledge, const CellAssessment& assessment) {
  const bool finest = cell.accuracy + 1 == lattice_.accuracies().size();
  // in one direction, the values of the whole cell cannot be distinguished from zero: subdivision does not help
  const bool hopeless = finest && assessment.thickness <= knowledge.noise;
  const Directions along{assessment.split_u, assessment.split_v};
  if (!hopeless && split(cell, along, options_.max_depth, &knowledge.values)) return;
  add_near_miss(cell, knowledge.values);
  blocks_[cell.block].leaves.push_back(cell.place);
}

// Reports where |f| is smallest in the cell, by a few corrections of the cell's model by f itself.
void RootTree::add_near_miss(const Cell& cell, const CellSamples& values) {
  NearMiss miss{0.0, 0.0, std::numeric_limits<double>::infinity()};
  const auto look_at = [&](double u, double v) {
    const double p = p_at(cell.place, u), q = q_at(cell.place, v);
    const Complex f = lattice_.at(p, q, options_.fine_accuracy);
    if (std::abs(f) < miss.residual) miss = {lattice_.amplitude(p), lattice_.frequency(q), std::abs(f)};
    return f;
  };
  if (std::all_of(values.begin(), values.end(), defined)) {
    CellSamples corrected = values;
    for (int round = 0; round < 5; ++round) {
      const auto [u, v] = smallest_point(corrected);
      const Complex error = look_at(u, v) - interpolate(corrected, u, v);
      if (!defined(error)) break;
      for (Complex& value : corrected) value += error;
    }
  } else {
    for (const double row : {-1.0, 0.0, 1.0})
      for (const double column : {-1.0, 0.0, 1.0}) look_at(column, row);
  }
  blocks_[cell.block].near_misses.push_back(miss);
}

// For a cell with a jump of f, which no bisection resolves: no root if both sides keep away from zero, a near miss if
// they do not in the smallest cell. The larger the cell, the more room there is for f to be steep and not to jump.
bool RootTree::decided_by_jump(const Cell& cell, const CellKnowledge& knowledge) {
  constexpr int first_depth = 5;
  const int depth = std::min(cell.depth_p, cell.depth_q);
  if (depth < std::min(first_depth, options_.max_border_depth)) return false;
  const auto jump = jump_in(knowledge.values);
  if (!jump || jump->height <= 10.0 * knowledge.noise) return false;
  const bool smallest = depth >= options_.max_border_depth;
  const double margin = (smallest ? 0.125 : 0.9) * jump->height + 2.0 * jump->spread + knowledge.noise;
  const bool away = jump->distance > knowledge.caution * margin;
  if (!away && !smallest) return false;
  if (!away) add_near_miss(cell, knowledge.values);
  blocks_[cell.block].leaves.push_back(cell.place);
  return true;
}

// For a cell that holds at most one root: uses the known root, finds it, or shows that it is outside.
void RootTree::settle(const Cell& cell, const CellSamples& values, const CellAssessment& assessment) {
  const auto is_here = [&](const FoundRoot& root) { return contains(cell.place, root, 0.5); };
  if (std::none_of(roots_.begin(), roots_.end(), is_here)) {
    const auto root = polish(cell, assessment.u, assessment.v);
    // further out the Jacobian may be singular, and the point no root at all
    const bool near = root && contains(cell.place, *root, 0.5 + 1e-6);
    if (near) record(*root);
    if (!near) {
      if (split(cell, {assessment.split_u, assessment.split_v}, options_.max_depth, &values)) return;
      add_near_miss(cell, values);
    }
  }
  blocks_[cell.block].leaves.push_back(cell.place);
}

std::optional<FoundRoot> RootTree::polish(const Cell& cell, double u, double v) {
  const double fine = options_.fine_accuracy;
  const RootGuess guess{p_at(cell.place, u), q_at(cell.place, v), half_p(cell.place), half_q(cell.place)};
  const auto found = polish_root([&](double p, double q) { return lattice_.at(p, q, fine); }, guess, fine);
  if (!found) return std::nullopt;
  const Complex f = lattice_.equation(found->p, found->q, fine);
  const double residual = std::abs(f), scale2 = 1.0 + std::norm(f - 1.0);
  if (!(residual < options_.residual)) return std::nullopt;
  const double determinant = scale2 * found->jacobian.determinant();  // at a root the scaling is a constant factor
  return FoundRoot{
      found->p,
      found->q,
      {lattice_.amplitude(found->p), lattice_.frequency(found->q), residual, determinant > 0.0 ? 1 : -1, determinant}};
}

void RootTree::record(const FoundRoot& root) {
  // roots of opposite index are two, however close
  const auto same = [&](const FoundRoot& other) {
    return std::abs(other.p - root.p) < 1e-7 && std::abs(other.q - root.q) < 1e-7 &&
           other.root.index == root.root.index;
  };
  if (lattice_.inside(root.p, root.q) && std::none_of(roots_.begin(), roots_.end(), same)) roots_.push_back(root);
}

// All defined samples lie on one edge of the cell and f ends right behind it.
bool RootTree::only_edge_defined(const Cell& cell, const CellSamples& values) {
  constexpr double just_inside = 1.0 - 1e-6;
  for (const bool along_p : {true, false}) {
    for (const int side : {-1, 1}) {
      bool elsewhere = false;
      for (std::size_t k = 0; k < 9; ++k) {
        const int across = static_cast<int>(along_p ? k / 3 : k % 3) - 1;
        elsewhere = elsewhere || (defined(values[k]) && across != side);
      }
      if (elsewhere) continue;
      const auto is_undefined = [&](double along) {
        const double u = along_p ? along : side * just_inside, v = along_p ? side * just_inside : along;
        return !defined(lattice_.at(p_at(cell.place, u), q_at(cell.place, v), options_.coarse_accuracy));
      };
      return is_undefined(-0.9) && is_undefined(0.05) && is_undefined(0.9);
    }
  }
  return false;
}

// A cell across the border of the region where f is defined. Away from zero by more than it varies: done.
void RootTree::process_border(const Cell& cell, const CellSamples& values) {
  double smallest = std::numeric_limits<double>::infinity(), spread = 0.0;
  std::size_t best = 0;
  int known = 0;
  for (std::size_t k = 0; k < 9; ++k) {
    if (!defined(values[k])) continue;
    ++known;
    for (std::size_t m = 0; m < k; ++m) {
      if (defined(values[m])) spread = std::max(spread, std::abs(values[k] - values[m]));
    }
    if (std::abs(values[k]) < smallest) {
      smallest = std::abs(values[k]);
      best = k;
    }
  }
  // 4: were f to end like a square root, its change beyond the last sample could be 2.4 times the change between
  // samples; five samples cannot all be at the same distance from the border
  const bool away = smallest > 4.0 * spread;
  const bool seen_across = known >= 5 || (known >= 3 && smallest > 0.3);
  if (away && seen_across && std::min(cell.depth_p, cell.depth_q) > 1) return;
  if (only_edge_defined(cell, values)) return;
  if (split(cell, {true, true}, options_.max_border_depth, nullptr)) return;
  // the strip that is left unseen is narrow: only a steep end of f could bring it to zero from here
  if (smallest > 4.0 * spread + 0.002) return;
  const auto row = best / 3, column = best % 3;
  const auto root = polish(cell, static_cast<double>(column) - 1.0, static_cast<double>(row) - 1.0);
  if (root && contains(cell.place, *root, 0.5)) return record(*root);
  add_near_miss(cell, values);
}

// Announces the points that all waiting cells will evaluate first.
void RootTree::prepare() const {
  std::set<std::pair<std::int64_t, std::int64_t>> nodes;
  for (const Cell& cell : queue_)
    for (std::int64_t a = 0; a < 3; ++a)
      for (std::int64_t b = 0; b < 3; ++b) {
        const std::int64_t i = cell.place.i + a * (cell.place.width / 2),
                           j = cell.place.j + b * (cell.place.height / 2);
        if (!lattice_.is_known(i, j)) nodes.emplace(i, j);
      }
  std::vector<SearchPoint> points;
  points.reserve(nodes.size());
  for (const auto& [i, j] : nodes)
    points.push_back({lattice_.amplitude(lattice_.p(i)), lattice_.frequency(lattice_.q(j))});
  options_.prepare(points, lattice_.accuracies().front());
}

void RootTree::search() {
  std::size_t prepared = 0;  // of the cells that wait
  while (!queue_.empty()) {
    if (options_.interrupted && options_.interrupted()) throw RootSearchInterrupted{};
    if (prepared == 0 && options_.prepare) {
      prepare();
      prepared = queue_.size();
    }
    if (prepared > 0) --prepared;
    const Cell cell = queue_.front();
    queue_.pop_front();
    process(cell);
  }
}

int RootTree::index_sum(const std::vector<LatticeCell>& cells) const {
  int sum = 0;
  for (const FoundRoot& root : roots_) {
    const auto holds = [&](const LatticeCell& s) { return contains(s, root, 1e-9); };
    if (std::any_of(cells.begin(), cells.end(), holds)) sum += root.root.index;
  }
  return sum;
}

bool RootTree::near_border(const FoundRoot& root, const LatticeCell& s) const {
  const double du = std::abs(std::abs(root.p - p_at(s, 0.0)) - half_p(s));
  const double dv = std::abs(std::abs(root.q - q_at(s, 0.0)) - half_q(s));
  return std::min(du, dv) < 1e-7;
}

bool RootTree::agrees(const RootBlock& block) {
  const auto on_border = [&](const FoundRoot& root) { return near_border(root, block.place); };
  if (std::any_of(roots_.begin(), roots_.end(), on_border)) return true;
  const auto winding = border_winding(lattice_, block.leaves);
  return !winding || *winding == index_sum(block.leaves);
}

}  // namespace limcycle
