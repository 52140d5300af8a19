#include "limcycle/analysis/motion/field/plain_field.hpp"

#include <algorithm>
#include <cmath>

namespace limcycle {
namespace {

using Eigen::Index;

std::vector<double> numbers(const auto& row) { return {row.begin(), row.end()}; }

}  // namespace

bool PlainField::applies(const Loop& loop) {
  for (std::size_t i = 0; i < loop.elements.size(); ++i) {
    const auto later = loop.ports[i].D_v.tail(std::ssize(loop.elements) - static_cast<Index>(i));
    const bool waits = !later.isZero(0.0);  // the rate of its input depends on later elements
    const ElementFacts& facts = loop.elements[i].facts();
    const bool asks_rate = facts.needs_rate || loop.elements[i].states() > 0;
    const bool plain = facts.holds == Held::nothing && !facts.needs_drive && !(waits && asks_rate);
    if (!plain || loop.ports[i].selection_of) return false;
  }
  return true;
}

PlainField::PlainField(const Loop& loop) : n_(static_cast<std::size_t>(loop.states())), E_(loop.E) {
  for (const auto column : loop.A.colwise()) A_.insert(A_.end(), column.begin(), column.end());
  std::size_t size = n_;
  for (std::size_t i = 0; i < loop.elements.size(); ++i) {
    const Port& port = loop.ports[i];
    const auto column = loop.B.col(static_cast<Index>(i));
    Part part{&loop.elements[i],
              size,
              0,
              numbers(column),
              numbers(port.C),
              numbers(port.C_v),
              numbers(port.D.head(static_cast<Index>(i))),
              numbers(port.D_v.head(static_cast<Index>(i))),
              port.c,
              port.c_v};
    part.states = static_cast<std::size_t>(loop.elements[i].states());
    size += part.states;
    parts_.push_back(std::move(part));
  }
  w_gradient_.setZero(static_cast<Index>(size), std::ssize(parts_));
  input_gradient_.setZero(static_cast<Index>(size));
  rate_gradient_.setZero(static_cast<Index>(size));
  set_external(loop.external);
}

void PlainField::set_external(const External& ext) {
  const Eigen::VectorXd outside = E_ * ext;
  outside_.assign(outside.begin(), outside.end());
  for (Part& part : parts_) {
    part.input_outside = part.c.dot(ext);
    part.rate_outside = part.c_v.dot(ext);
  }
}

/// N: number of linear states if that is known when compiling, else 0.
template <std::size_t N>
void PlainField::rate_sized(const State& x, std::span<const Mode> modes, std::span<Input<double>> inputs,
                            std::span<double> w, State& dx) const {
  const std::size_t n = N > 0 ? N : n_;
  double small[N > 0 ? N : 1];
  double* const dX = N > 0 ? small : dx.data();
  std::copy_n(outside_.data(), n, dX);
#pragma GCC unroll 5
  for (std::size_t j = 0; j < n; ++j)
#pragma GCC unroll 5
    for (std::size_t r = 0; r < n; ++r) dX[r] += A_[j * n + r] * x[j];
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const Part& part = parts_[i];
    double input = part.input_outside, speed = part.rate_outside;
#pragma GCC unroll 5
    for (std::size_t j = 0; j < n; ++j) {
      input += part.C[j] * x[j];
      speed += part.C_v[j] * x[j];
    }
    for (std::size_t k = 0; k < i; ++k) {
      input += part.D[k] * w[k];
      speed += part.D_v[k] * w[k];
    }
    inputs[i].x = input;
    inputs[i].v = speed;
    w[i] = part.element->respond(inputs[i], modes[i], {x.data() + part.first, part.states},
                                 {dx.data() + part.first, part.states});
#pragma GCC unroll 5
    for (std::size_t r = 0; r < n; ++r) dX[r] += part.B[r] * w[i];
  }
  if constexpr (N > 0) std::copy_n(small, n, dx.data());
}

void PlainField::rate(const State& x, std::span<const Mode> modes, std::span<Input<double>> inputs, std::span<double> w,
                      State& dx) const {
  dx.resize(x.size());
  switch (n_) {
    case 2:
      return rate_sized<2>(x, modes, inputs, w, dx);
    case 3:
      return rate_sized<3>(x, modes, inputs, w, dx);
    case 4:
      return rate_sized<4>(x, modes, inputs, w, dx);
    case 5:
      return rate_sized<5>(x, modes, inputs, w, dx);
    default:
      return rate_sized<0>(x, modes, inputs, w, dx);
  }
}

void PlainField::jacobian(const State& x, std::span<const Mode> modes, std::span<const Input<double>> inputs,
                          std::span<ElementSlopes> slopes, Eigen::MatrixXd& J) {
  const std::size_t size = x.size();
  J.resize(static_cast<Index>(size), static_cast<Index>(size));
  double* const out = J.data();
  for (std::size_t j = 0; j < size; ++j)
    for (std::size_t r = 0; r < size; ++r) out[j * size + r] = r < n_ && j < n_ ? A_[j * n_ + r] : 0.0;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const Part& part = parts_[i];
    const auto& by_input = slopes[i].response(inputs[i], modes[i], x.data() + part.first);
    double* const by_x = input_gradient_.data();
    double* const by_v = rate_gradient_.data();
    for (std::size_t j = 0; j < size; ++j) {
      by_x[j] = j < n_ ? part.C[j] : 0.0;
      by_v[j] = j < n_ ? part.C_v[j] : 0.0;
      for (std::size_t k = 0; k < i; ++k) {
        const double before = w_gradient_(static_cast<Index>(j), static_cast<Index>(k));
        by_x[j] += part.D[k] * before;
        by_v[j] += part.D_v[k] * before;
      }
    }
    for (std::size_t j = 0; j < size; ++j) {
      const bool own = j >= part.first && j < part.first + part.states;
      const auto slope = [&](Index row) {
        const double* const at = &by_input(row, 0);
        return at[0] * by_x[j] + at[1] * by_v[j] + (own ? at[2 + j - part.first] : 0.0);
      };
      const double w = slope(0);
      w_gradient_(static_cast<Index>(j), static_cast<Index>(i)) = w;
      for (std::size_t r = 0; r < n_; ++r) out[j * size + r] += part.B[r] * w;
      for (std::size_t k = 0; k < part.states; ++k) out[j * size + part.first + k] = slope(static_cast<Index>(k) + 1);
    }
  }
}

}  // namespace limcycle
