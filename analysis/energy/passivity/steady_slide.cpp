#include "limcycle/analysis/energy/passivity/steady_slide.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "limcycle/analysis/motion/field/element_slopes.hpp"
#include "limcycle/models/element/element.hpp"
#include "limcycle/models/linear/dense.hpp"

namespace limcycle {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// A law that slides at in.v, on the way to its steady state.
class Settling {
 public:
  Settling(const Element& law, const Input<double>& in) : law_(law), in_(in), slopes_(law), n_(law.states()) {
    z_.assign(static_cast<std::size_t>(n_), 0.0);
    mode_ = law.knows_sliding() ? law.after_sliding(in, z_) : law.start(in, z_);
    scale_.resize(n_);
    for (Index i = 0; i < n_; ++i) scale_(i) = law.state_scale(static_cast<int>(i));
  }

  /// Implicit Euler steps, each four times as long as the one before, that become Newton's method in the end; a step
  /// ends where its mode ends.
  bool run() {
    double step = 0.0, size = 0.0;
    for (int k = 0; k < 1000; ++k) {
      const VectorXd rate = rates();
      if (!rate.allFinite()) return false;
      const MatrixXd J = jacobian();
      size = std::max({size, n_ == 0 ? 0.0 : rate.cwiseAbs().maxCoeff(), J.norm()});
      if (size == 0.0 || n_ == 0 || rate.cwiseAbs().maxCoeff() <= 1e-15 * size) return fired() < 0;
      step = step == 0.0 ? 1e-3 / size : 4.0 * step;
      if (step * size > 1e18) return rate.cwiseAbs().maxCoeff() <= 1e-11 * size;
      if (advance(rate, J, step)) step = 0.0;
    }
    return false;
  }

  const std::vector<double>& z() const { return z_; }
  Mode mode() const { return mode_; }
  const ElementSlopes::Table& table() { return slopes_.response(in_, mode_, z_.data()); }

 private:
  VectorXd rates() const {
    VectorXd rate(n_);
    law_.rate(in_, mode_, z_, std::span<double>(rate.data(), z_.size()));
    return rate.cwiseQuotient(scale_);
  }
  MatrixXd jacobian() { return scale_.cwiseInverse().asDiagonal() * table().block(1, 2, n_, n_) * scale_.asDiagonal(); }

  /// The guard farthest below zero; -1: none.
  int fired() const {
    std::vector<double> g(static_cast<std::size_t>(law_.guards(mode_)));
    if (g.empty()) return -1;
    law_.guard(in_, mode_, z_, g);
    const auto least = std::ranges::min_element(g);
    return *least < 0.0 ? static_cast<int>(least - g.begin()) : -1;
  }

  void move(const std::vector<double>& from, const VectorXd& rate, const MatrixXd& J, double step) {
    const VectorXd by = least_squares(MatrixXd::Identity(n_, n_) / step - J, rate);
    for (Index i = 0; i < n_; ++i)
      z_[static_cast<std::size_t>(i)] = from[static_cast<std::size_t>(i)] + scale_(i) * by(i);
  }

  /// Takes a step; true if it ended with a switch.
  bool advance(const VectorXd& rate, const MatrixXd& J, double step) {
    const std::vector<double> from = z_;
    move(from, rate, J, step);
    if (fired() < 0) return false;
    double low = 0.0, high = 1.0;
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (low + high);
      move(from, rate, J, middle * step);
      (fired() < 0 ? low : high) = middle;
    }
    move(from, rate, J, high * step);
    if (const int guard = fired(); guard >= 0) mode_ = law_.next(in_, mode_, z_, guard);
    return true;
  }

  const Element& law_;
  Input<double> in_;
  ElementSlopes slopes_;
  Index n_;
  std::vector<double> z_;
  Mode mode_{};
  VectorXd scale_;
};

}  // namespace

std::optional<SteadySlide> steady_slide(const Element& element, double V) {
  if (V == 0.0 || !std::isfinite(V)) return std::nullopt;
  const auto slide_under = [&](double drive) -> std::optional<SteadySlide> {
    const Input<double> in{0.0, V, drive};
    Settling settling(element, in);
    if (!settling.run()) return std::nullopt;
    const MatrixXd table = settling.table();
    const Index n = element.states();
    SteadySlide slide{settling.z(), settling.mode(), element.output(in, settling.mode(), settling.z()), {}};
    slide.response = {table.block(1, 2, n, n), table.block(1, 1, n, 1), table.block(0, 2, 1, n),
                      table.block(0, 1, 1, 1)};
    if (!std::isfinite(slide.force) || !table.allFinite()) return std::nullopt;
    return slide;
  };
  if (!element.needs_drive()) return slide_under(V < 0.0 ? -infinite : infinite);
  // Such an element may need the drive at this speed (its band), or jump with the sign of the acceleration.
  const double pull = 10.0 * element.scales().output;
  auto forwards = slide_under(pull);
  const auto backwards = slide_under(-pull);
  if (!forwards || !backwards || std::abs(forwards->force - backwards->force) > 1e-12 * pull) return std::nullopt;
  return forwards;
}

}  // namespace limcycle
