#pragma once
#include <cstddef>
#include <stdexcept>

#include "limcycle/analysis/frequency/march/radau_iia.hpp"
#include "limcycle/analysis/lanes/elimination.hpp"
#include "limcycle/models/element/linear_state.hpp"

namespace limcycle {

/// A solution of dz/dt = source - decay z and one without its source, at one time; the sum of the first and any
/// multiple of the second is a solution.
struct LinearPair {
  double particular = 0.0, homogeneous = 1.0;

  double from(double start) const { return particular + start * homogeneous; }
};

/// Radau IIA collocation with S stages of that equation over a time `step`, from the pair `start`: `take(i, pair)` gets
/// the solutions at stage i, where `rate(i)` is the LinearRate. Returns those at the end. Cost: about S^3/3
/// multiplications.
template <int S, class Rate, class Take>
LinearPair solve_linear_panel(const RadauIIA& table, double step, LinearPair start, const Rate& rate,
                              const Take& take) {
  double m[S][S], x[S], y[S];
  for (int i = 0; i < S; ++i) {
    const auto row = static_cast<std::size_t>(i);
    const LinearRate<double> here = rate(row);
    for (int j = 0; j < S; ++j) m[i][j] = table.inverse[row * S + static_cast<std::size_t>(j)];
    m[i][i] += here.decay * step;
    x[i] = here.source * step + table.row_sum[row] * start.particular;
    y[i] = table.row_sum[row] * start.homogeneous;
  }
  eliminate(m, x, y);
  for (int i = 0; i < S; ++i) take(static_cast<std::size_t>(i), LinearPair{x[i], y[i]});
  return {x[S - 1], y[S - 1]};
}

/// Calls f with the number of stages, 4 to 10, as its template argument.
template <class Function>
decltype(auto) with_stages(int stages, const Function& f) {
  switch (stages) {
    case 4:
      return f.template operator()<4>();
    case 5:
      return f.template operator()<5>();
    case 6:
      return f.template operator()<6>();
    case 7:
      return f.template operator()<7>();
    case 8:
      return f.template operator()<8>();
    case 9:
      return f.template operator()<9>();
    case 10:
      return f.template operator()<10>();
    default:
      throw std::invalid_argument("collocation of a linear law: 4 to 10 stages");
  }
}

}  // namespace limcycle
