#include "limcycle/analysis/motion/steppers/rodas5p.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace limcycle {

namespace {

/// Size known at compile time, so that the loops of a small system are unrolled; 0: known at run time only.
template <int N>
std::size_t size_of(std::size_t n) {
  return N > 0 ? static_cast<std::size_t>(N) : n;
}

/// True for the sizes of which run() has code of its own, which solves for all states, standing or not.
constexpr bool is_unrolled(std::size_t n) { return n >= 2 && n <= 6; }

/// sum_{j < s} weight[j] k_j, component i, of a stage whose number is known at compile time.
template <std::size_t s>
double sum_stages(const rodas5p::Row& weight, const double* k, std::size_t n, std::size_t i) {
  double sum = 0.0;
#pragma GCC unroll 8
  for (std::size_t j = 0; j < s; ++j) sum += weight[j] * k[j * n + i];
  return sum;
}

/// LU factors by columns, in place, the pivots inverted; `order`: rows in the order of the pivots.
void decompose(double* a, std::size_t* order, std::size_t n) {
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t pivot = k;
    for (std::size_t i = k + 1; i < n; ++i)
      if (std::abs(a[k * n + i]) > std::abs(a[k * n + pivot])) pivot = i;
    if (pivot != k) {
      for (std::size_t j = 0; j < n; ++j) std::swap(a[j * n + k], a[j * n + pivot]);
      std::swap(order[k], order[pivot]);
    }
    const double inverse = a[k * n + k] = 1.0 / a[k * n + k];
    for (std::size_t i = k + 1; i < n; ++i) a[k * n + i] *= inverse;
    for (std::size_t j = k + 1; j < n; ++j) {
      const double factor = a[j * n + k];
      for (std::size_t i = k + 1; i < n; ++i) a[j * n + i] -= factor * a[k * n + i];
    }
  }
}

/// Inverse in place by Gauss and Jordan, on lines of n numbers (columns as well as rows: the inverse of the transpose
/// is the transpose of the inverse), with the largest remaining number at each line's place as the pivot.
template <int N>
void invert(double* a, std::size_t* order) {
  constexpr std::size_t n = N;
#pragma GCC unroll 6
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t pivot = k;
    for (std::size_t i = k + 1; i < n; ++i)
      if (std::abs(a[i * n + k]) > std::abs(a[pivot * n + k])) pivot = i;
    if (pivot != k) {
      std::swap_ranges(a + k * n, a + k * n + n, a + pivot * n);
      std::swap(order[k], order[pivot]);
    }
    const double inverse = 1.0 / a[k * n + k];
    a[k * n + k] = 1.0;
    for (std::size_t j = 0; j < n; ++j) a[k * n + j] *= inverse;
    for (std::size_t i = 0; i < n; ++i) {
      if (i == k) continue;
      const double factor = a[i * n + k];
      a[i * n + k] = 0.0;
      for (std::size_t j = 0; j < n; ++j) a[i * n + j] -= factor * a[k * n + j];
    }
  }
  // Place k of every line belongs to line order[k] of the original matrix.
  for (std::size_t i = 0; i < n; ++i) {
    double line[n];
    for (std::size_t k = 0; k < n; ++k) line[order[k]] = a[i * n + k];
    std::copy_n(line, n, a + i * n);
  }
}

}  // namespace

void Rodas5p::resize(std::size_t n) {
  if (x0_.size() == n && jacobian_.rows() == static_cast<Eigen::Index>(n)) return;
  for (State* vector : {&x0_, &f0_, &dfdt_, &x1_, &stage_x_, &stage_f_, &right_, &unused_error_})
    vector->assign(n, 0.0);
  k_.assign(rodas5p::stages * n, 0.0);
  lu_.assign(n * n, 0.0);
  order_.assign(n, 0);
  jacobian_.setZero(static_cast<Eigen::Index>(n), static_cast<Eigen::Index>(n));
}

void Rodas5p::begin(const State& x, double t) {
  resize(x.size());
  x0_ = x;
  t0_ = t;
}

/// A law with memory keeps many numbers that stand still for most of the time, such as return points.
void Rodas5p::find_moving() {
  const auto n = jacobian_.rows();
  if (is_unrolled(x0_.size())) return;
  moving_.clear();
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j)
      if (jacobian_(i, j) != 0.0) {
        moving_.push_back(static_cast<std::size_t>(i));
        break;
      }
}

/// I/(gamma h) - J into lu_, of a large system for the moving states: its LU factors with row pivoting, or for a small
/// system its inverse, because a product with that has no chain of dependent operations. A vanishing pivot makes the
/// stages infinite or NaN, which the error norm detects.
template <int N>
void Rodas5p::factorise() {
  const std::size_t n = N > 0 ? static_cast<std::size_t>(N) : moving_.size();
  double* const a = lu_.data();
  const double* const jacobian = jacobian_.data();
  const double diagonal = 1.0 / (rodas5p::gamma * h_);
  if constexpr (N > 0) {
    for (std::size_t i = 0; i < n * n; ++i) a[i] = -jacobian[i];
  } else {
    for (std::size_t j = 0; j < n; ++j)
      for (std::size_t i = 0; i < n; ++i) a[j * n + i] = -jacobian[moving_[j] * x0_.size() + moving_[i]];
  }
  for (std::size_t i = 0; i < n; ++i) a[i * n + i] += diagonal;
  std::iota(order_.begin(), order_.end(), std::size_t{0});
  if constexpr (N > 0)
    invert<N>(a, order_.data());
  else
    decompose(a, order_.data(), n);
}

/// Solution for the right side right_. A state whose row of the Jacobian is zero has an equation of its own.
template <int N>
void Rodas5p::solve(double* solution) {
  const double* const a = lu_.data();
  if constexpr (N > 0) {
    constexpr std::size_t n = N;
    double sum[N] = {};
#pragma GCC unroll 6
    for (std::size_t j = 0; j < n; ++j)
      for (std::size_t i = 0; i < n; ++i) sum[i] += a[j * n + i] * right_[j];
    std::copy_n(sum, n, solution);
  } else {
    const std::size_t n = moving_.size();
    solved_.resize(n);
    for (std::size_t j = 0, next = 0; j < x0_.size(); ++j) {
      if (next < n && moving_[next] == j) {
        ++next;
        continue;
      }
      solution[j] = rodas5p::gamma * h_ * right_[j];
      if (solution[j] == 0.0) continue;
      for (const std::size_t i : moving_) right_[i] += jacobian_.data()[j * x0_.size() + i] * solution[j];
    }
    for (std::size_t i = 0; i < n; ++i) solved_[i] = right_[moving_[order_[i]]];
    for (std::size_t j = 0; j < n; ++j)
      for (std::size_t i = j + 1; i < n; ++i) solved_[i] -= a[j * n + i] * solved_[j];
    for (std::size_t j = n; j-- > 0;) {
      solved_[j] *= a[j * n + j];
      for (std::size_t i = 0; i < j; ++i) solved_[i] -= a[j * n + i] * solved_[j];
    }
    for (std::size_t i = 0; i < n; ++i) solution[moving_[i]] = solved_[i];
  }
}

template <int N, std::size_t s>
void Rodas5p::stage(const RightSide& f) {
  const std::size_t n = size_of<N>(x0_.size());
  double* const k = k_.data();
  const double inverse_h = 1.0 / h_;
  if constexpr (s > 0) {
    if constexpr (s + 2 < rodas5p::stages) {
      for (std::size_t i = 0; i < n; ++i) stage_x_[i] = x0_[i] + sum_stages<s>(rodas5p::A[s], k, n, i);
    } else {  // the last stages only add the previous one
      for (std::size_t i = 0; i < n; ++i) stage_x_[i] += k[(s - 1) * n + i];
    }
    f.rate(f.system, stage_x_, stage_f_, t0_ + rodas5p::node[s] * h_);
  }
  const State& rate = s == 0 ? f0_ : stage_f_;
  for (std::size_t i = 0; i < n; ++i) right_[i] = sum_stages<s>(rodas5p::C[s], k, n, i) * inverse_h + rate[i];
  if constexpr (rodas5p::time_weight[s] != 0)
    for (std::size_t i = 0; i < n; ++i) right_[i] += h_ * rodas5p::time_weight[s] * dfdt_[i];
  solve<N>(k + s * n);
}

template <int N>
void Rodas5p::run_sized(const RightSide& f, double h) {
  h_ = h;
  factorise<N>();
  [&]<std::size_t... s>(std::index_sequence<s...>) { (stage<N, s>(f), ...); }
  (std::make_index_sequence<rodas5p::stages>{});
}

void Rodas5p::run(const RightSide& f, double h) {
  if (!is_unrolled(x0_.size())) return run_sized<0>(f, h);
  switch (x0_.size()) {
    case 2:
      return run_sized<2>(f, h);
    case 3:
      return run_sized<3>(f, h);
    case 4:
      return run_sized<4>(f, h);
    case 5:
      return run_sized<5>(f, h);
    default:
      return run_sized<6>(f, h);
  }
}

void Rodas5p::finish(State& xout, State& xerr) {
  const std::size_t n = x0_.size();
  const double* last = k_.data() + (rodas5p::stages - 1) * n;
  for (std::size_t i = 0; i < n; ++i) x1_[i] = stage_x_[i] + last[i];
  xout = x1_;
  xerr.assign(last, last + n);
}

void Rodas5p::interpolant(DenseSegment& segment) const {
  segment.start_ = t0_;
  segment.end_ = t0_ + h_;
  segment.first_ = x0_;
  segment.last_ = x1_;
  const std::size_t n = x0_.size();
  for (std::size_t q = 0; q < rodas5p::H.size(); ++q) {
    segment.bend_[q].assign(n, 0.0);
    for (std::size_t j = 0; j < rodas5p::stages; ++j)
      for (std::size_t i = 0; i < n; ++i) segment.bend_[q][i] += rodas5p::H[q][j] * k_[j * n + i];
  }
}

}  // namespace limcycle
