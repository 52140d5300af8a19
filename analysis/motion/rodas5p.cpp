#include "limcycle/analysis/motion/rodas5p.hpp"

#include <type_traits>

namespace limcycle {

namespace {

/// Column of the solver's size over raw storage.
template <class Lu>
using Column = Eigen::Matrix<double, Lu::MatrixType::RowsAtCompileTime, 1>;
template <class Lu>
using ColumnMap = Eigen::Map<Column<Lu>>;
template <class Lu>
using ConstColumnMap = Eigen::Map<const Column<Lu>>;

/// Where a sum over stages is built: in registers at fixed size, else in storage that is already there.
template <class Lu>
using Sum = std::conditional_t<Lu::MatrixType::RowsAtCompileTime == Eigen::Dynamic, ColumnMap<Lu>, Column<Lu>>;

/// sum_{j < count} weight[j] k_j
template <class Lu>
// NOLINTNEXTLINE(readability-non-const-parameter): the map writes to the storage
Sum<Lu> sum_stages(const rodas5p::Row& weight, std::size_t count, const double* k, Eigen::Index n, double* storage) {
  Sum<Lu> sum = ColumnMap<Lu>(storage, n);
  sum.setZero();
  for (std::size_t j = 0; j < count; ++j, k += n) sum += weight[j] * ConstColumnMap<Lu>(k, n);
  return sum;
}

}  // namespace

void Rodas5p::resize(std::size_t n) {
  if (x0_.size() == n && jacobian_.rows() == static_cast<Eigen::Index>(n)) return;
  for (State* vector : {&x0_, &f0_, &dfdt_, &x1_, &stage_x_, &stage_f_, &unused_error_}) vector->assign(n, 0.0);
  k_.assign(rodas5p::stages * n, 0.0);
  jacobian_.setZero(static_cast<Eigen::Index>(n), static_cast<Eigen::Index>(n));
  switch (n) {
    case 1:
      lu_.emplace<Lu<1>>();
      break;
    case 2:
      lu_.emplace<Lu<2>>();
      break;
    case 3:
      lu_.emplace<Lu<3>>();
      break;
    case 4:
      lu_.emplace<Lu<4>>();
      break;
    case 5:
      lu_.emplace<Lu<5>>();
      break;
    case 6:
      lu_.emplace<Lu<6>>();
      break;
    case 7:
      lu_.emplace<Lu<7>>();
      break;
    case 8:
      lu_.emplace<Lu<8>>();
      break;
    default:
      lu_.emplace<Lu<Eigen::Dynamic>>(static_cast<Eigen::Index>(n));
      break;
  }
}

void Rodas5p::factorise(double h) {
  h_ = h;
  std::visit(
      [&]<class L>(L& lu) {
        using Matrix = typename L::MatrixType;
        const Eigen::Map<const Matrix> jacobian(jacobian_.data(), jacobian_.rows(), jacobian_.cols());
        lu.compute(Matrix::Identity(jacobian.rows(), jacobian.cols()) * (1 / (rodas5p::gamma * h)) - jacobian);
      },
      lu_);
}

void Rodas5p::place_stage(std::size_t s) {
  const auto n = static_cast<Eigen::Index>(x0_.size());
  std::visit(
      [&]<class L>(const L&) {
        ColumnMap<L> x(stage_x_.data(), n);
        if (s + 2 < rodas5p::stages) {
          x = sum_stages<L>(rodas5p::A[s], s, k_.data(), n, stage_x_.data()) + ConstColumnMap<L>(x0_.data(), n);
        } else {  // the last stages only add the one before
          x += ConstColumnMap<L>(k_.data() + static_cast<Eigen::Index>(s - 1) * n, n);
        }
      },
      lu_);
}

void Rodas5p::solve_stage(std::size_t s, const State& f) {
  const auto n = static_cast<Eigen::Index>(x0_.size());
  std::visit(
      [&]<class L>(const L& lu) {
        // x1_ is free until the step is finished.
        Sum<L> right = sum_stages<L>(rodas5p::C[s], s, k_.data(), n, x1_.data());
        right = right / h_ + ConstColumnMap<L>(f.data(), n);
        if (rodas5p::time_weight[s] != 0) right += (h_ * rodas5p::time_weight[s]) * ConstColumnMap<L>(dfdt_.data(), n);
        ColumnMap<L> k(k_.data() + static_cast<Eigen::Index>(s) * n, n);
        k.noalias() = lu.solve(right);
      },
      lu_);
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
