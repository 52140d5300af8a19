#include "limcycle/models/sampled_response.hpp"

#include <algorithm>
#include <cmath>

#include "limcycle/models/element/of_controllers/clamped_pi.hpp"
#include "limcycle/models/element/of_controllers/sampled.hpp"
#include "limcycle/models/linear/dense.hpp"
#include "limcycle/models/loop.hpp"

namespace limcycle {
namespace {

using Complex = std::complex<double>;
using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::RowVectorXcd;

/// (1 - exp(-x))/x.
Complex hold(Complex x) {
  if (std::abs(x) < 1e-4) return 1.0 - x * (0.5 - x * (1.0 / 6.0 - x / 24.0));
  return (1.0 - std::exp(-x)) / x;
}

/// The linear equations of a sampled loop for signals exp(st): unknowns are the linear states, the outputs of all its
/// elements, and the states of the parts of the controller; known are the outputs of the elements of the averaged loop.
class SampledEquations {
 public:
  SampledEquations(const Loop& loop, Complex s) : averaged_(loop), loop_(*loop.sampled), s_(s) {
    first_element_ = loop_.states();
    Index size = first_element_ + std::ssize(loop_.elements);
    for (const Element& element : loop_.elements) {
      first_own_.push_back(size);
      if (const auto* sampled = element.as<Sampled<double>>()) size += sampled->order();
    }
    left_ = MatrixXcd::Zero(size, size);
    right_ = MatrixXcd::Zero(size, std::ssize(averaged_.elements));
    write_linear_part();
    for (std::size_t k = 0; k < loop_.elements.size(); ++k) write_element(k);
    solution_ = solve_columns(left_, right_);
  }

  SampledResponse response() const {
    const Index count = std::ssize(averaged_.elements);
    SampledResponse made{MatrixXcd(count, count), loop_.C_y.cast<Complex>() * solution_.topRows(loop_.states())};
    for (Index i = 0; i < count; ++i) {
      const auto at = static_cast<std::size_t>(i);
      const auto own = position(loop_, averaged_.ports[at].path);
      made.elements.row(i) = own ? input(*own) * solution_ : RowVectorXcd(limited(at));
    }
    return made;
  }

 private:
  static std::optional<std::size_t> position(const Loop& loop, const std::string& path) {
    const auto found = std::ranges::find(loop.ports, path, &Port::path);
    if (found == loop.ports.end()) return std::nullopt;
    return static_cast<std::size_t>(found - loop.ports.begin());
  }
  const Sampled<double>* clock(std::size_t k) const { return loop_.elements[k].as<Sampled<double>>(); }
  Index output(std::size_t k) const { return first_element_ + static_cast<Index>(k); }
  double period(const Sampled<double>& part) const { return part.sample_time * part.every; }

  void write_linear_part() {
    const Index n = loop_.states();
    const auto [from, B] = loop_.resolved(s_);  // of measured plants the data
    left_.topLeftCorner(n, n) = from;
    left_.block(0, first_element_, n, B.cols()) = -B;
  }

  /// What element k reads, as a row over the unknowns. A part of the controller reads another at a tick: what that has
  /// just put out, or still holds from a slower clock; without a hold of its own, and one tick late if it is computed
  /// meanwhile.
  RowVectorXcd input(std::size_t k) const {
    const Port& port = loop_.ports[k];
    const bool by_rate = port.rubs && port.C.isZero(0.0);  // no state holds the rubbing displacement
    const Complex scale = by_rate ? 1.0 / s_ : 1.0;
    RowVectorXcd row = RowVectorXcd::Zero(left_.cols());
    row.head(loop_.states()) = scale * (by_rate ? port.C_v : port.C).cast<Complex>();
    if (!by_rate) row.head(loop_.states()) += std::exp(-s_ * loop_.delay) * port.C_delayed.cast<Complex>();
    for (std::size_t j = 0; j < loop_.elements.size(); ++j) {
      const double direct = (by_rate ? port.D_v : port.D)(static_cast<Index>(j));
      if (direct != 0.0) row(output(j)) = scale * direct * (clock(k) && clock(j) ? reading(*clock(k), *clock(j)) : 1.0);
    }
    return row;
  }
  Complex reading(const Sampled<double>& by, const Sampled<double>& of) const {
    const Complex direct = 1.0 / hold(s_ * std::min(period(by), period(of)));
    if (!of.delays()) return direct;
    return direct * std::exp(s_ * (of.computation_delay - period(by)));
  }

  void write_element(std::size_t k) {
    const Index row = output(k);
    left_(row, row) = 1.0;
    const Sampled<double>* part = clock(k);
    if (part && !position(averaged_, loop_.ports[k].path)) return write_part(k, *part);
    if (const auto known = position(averaged_, loop_.ports[k].path))
      right_(row, static_cast<Index>(*known)) = part ? out_of(*part) : 1.0;
  }

  /// From what a part puts out at its ticks to its output in between, behind its delay.
  Complex out_of(const Sampled<double>& part) const {
    return hold(s_ * period(part)) * std::exp(-s_ * part.computation_delay);
  }

  /// X_(k+1) = A X_k + B e_k + hold_back (limited - u_k), u_k = C X_k + D e_k.
  void write_part(std::size_t k, const Sampled<double>& part) {
    const Index row = output(k), first = first_own_[k];
    const auto limit = position(averaged_, loop_.ports[k].path + ".limit"),
               steps = position(averaged_, loop_.ports[k].path + ".steps");
    const RowVectorXcd e = input(k), u = command(k, part);
    const Complex z = std::exp(s_ * period(part)), out = out_of(part);
    for (Index i = 0; i < part.order(); ++i) {
      const auto at = static_cast<std::size_t>(i);
      left_(first + i, first + i) += z;
      for (Index j = 0; j < part.order(); ++j)
        left_(first + i, first + j) -= part.A[at * part.B.size() + static_cast<std::size_t>(j)];
      left_.row(first + i) -= part.B[at] * e;
      if (!limit || part.hold_back.empty()) continue;
      left_.row(first + i) += part.hold_back[at] * u;
      right_(first + i, static_cast<Index>(*limit)) += part.hold_back[at];
    }
    if (steps || limit)
      right_(row, static_cast<Index>(steps ? *steps : *limit)) = out;
    else
      left_.row(row) -= out * u;
  }

  /// The command of a part before its limit.
  RowVectorXcd command(std::size_t k, const Sampled<double>& part) const {
    RowVectorXcd u = part.D * input(k);
    for (Index i = 0; i < part.order(); ++i) u(first_own_[k] + i) += part.C[static_cast<std::size_t>(i)];
    return u;
  }

  /// Input of the limit of a part of the controller, or of the steps behind it, an element of the averaged loop only:
  /// the command, or of a PI that holds its integral itself the error, or of steps what the limit lets through.
  RowVectorXcd limited(std::size_t i) const {
    const std::string& path = averaged_.ports[i].path;
    const std::string whole = path.substr(0, path.rfind('.'));
    if (const auto limit = position(averaged_, whole + ".limit"); limit && *limit != i)
      return RowVectorXcd::Unit(std::ssize(averaged_.elements), static_cast<Index>(*limit));
    const std::size_t k = position(loop_, whole).value();
    const bool own_integral = averaged_.elements[i].as<ClampedPi<double>>() != nullptr;
    return (own_integral ? input(k) : command(k, *clock(k))) * solution_;
  }

  const Loop& averaged_;
  const Loop& loop_;
  Complex s_;
  Index first_element_ = 0;
  std::vector<Index> first_own_;  ///< of the states of each part
  MatrixXcd left_, right_, solution_;
};

}  // namespace

SampledResponse sampled_response(const Loop& loop, std::complex<double> s) {
  return SampledEquations(loop, s).response();
}

}  // namespace limcycle
