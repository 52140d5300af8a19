#include "limcycle/analysis/energy/passivity/certificate.hpp"

#include <algorithm>
#include <cmath>

namespace limcycle {
namespace {

constexpr double rounding = 1e-12;      ///< of the scales of the states, and of the powers
constexpr double share_of_step = 1e-6;  ///< error permitted in the energies of one step; the march itself: 1e-9
constexpr double neighbour = 1e-8;      ///< of the scales of the states
constexpr int velocities_a_decade = 3;
constexpr std::size_t states_a_motion = 24;

class StorageCheck {
 public:
  StorageCheck(const Element& element, const MotionScales& scales, double top_speed)
      : element_(element),
        dual_(element.on<Dual<1>>()),
        march_(element, 1e-9),
        energy_(element.scales().output * scales.way) {
    // Far beyond the speeds of any motion, so that growth with the speed shows.
    const double most = std::min(top_speed, 1e6 * std::max(1e3 * scales.signal, scales.damping));
    const double decades = std::log10(most / scales.least);
    const int count = static_cast<int>(std::ceil(velocities_a_decade * decades));
    for (int k = 0; k <= count; ++k) speeds_.push_back(scales.least * std::pow(10.0, decades * k / count));
  }

  /// Follows a motion, checks the balance of energy on the way, and some of the states reached.
  Status follow(const std::vector<SignalPiece>& pieces, Certificate& certificate) {
    std::vector<ElementPoint> met;
    ElementPoint at = march_.virgin(pieces.front());
    double supplied = 0.0, stored = 0.0;
    bool balanced = true;
    march_.restart();
    march_.watch = [&](const Input<double>& in, const ElementPoint& point, double total) {
      const double now = element_.storage(point.mode, point.z);
      const double gain = total - supplied, rise = now - stored;
      const double size = rounding * (energy_ + std::abs(total) + std::abs(now));
      balanced =
          balanced && gain - rise >= -share_of_step * (std::abs(gain) + std::abs(rise)) - 1e3 * size && now >= -size;
      supplied = total, stored = now;
      if (!march_.switches(in, point)) met.push_back(point);
    };
    Status status = Status::converged;
    for (int round = 0; round < 2 && status == Status::converged; ++round)
      for (const SignalPiece& piece : pieces) {
        if (!march_.settle(piece, at)) status = Status::chattering;
        if (status == Status::converged) status = march_.cross(piece, at);
      }
    certificate.holds = certificate.holds && balanced;
    const std::size_t stride = std::max<std::size_t>(1, met.size() / states_a_motion);
    for (std::size_t k = met.size() % stride; k < met.size() && certificate.holds; k += stride)
      check(met[k], certificate);
    return status;
  }

  /// All velocities at one state, with both signs of the acceleration.
  void check(const ElementPoint& at, Certificate& certificate) {
    ++certificate.states;
    for (const double speed : speeds_)
      for (const double v : {speed, -speed}) {
        judge(at, {1.0, v, v * (1.0 + 1e-6)}, certificate);
        if (needs_sign_) judge(at, {1.0, v, v * (1.0 - 1e-6)}, certificate);
      }
  }

 private:
  /// The state `at`, if the velocity jumps to that of the piece.
  void judge(const ElementPoint& at, const SignalPiece& piece, Certificate& certificate) {
    ElementPoint here = at;
    if (!march_.settle(piece, here)) return;
    const double stored = element_.storage(at.mode, at.z), rise = element_.storage(here.mode, here.z) - stored;
    if (!(rise <= 1e3 * rounding * (energy_ + stored))) certificate.holds = false;
    const Input<double> in = march_.input(piece, 0.0, here.x);
    const Balance balance = balance_at(in, here.mode, here.z);
    double left = balance.left;
    if (!(left >= 0.0)) {
      if (explained(piece, in, at, here, balance))
        left = 0.0;
      else
        certificate.holds = false;
    }
    const double share = balance.size > 0.0 ? left / balance.size : 0.0;
    if (!(share >= certificate.least)) {
      certificate.least = share;
      certificate.velocity = piece.from;
    }
  }

  struct Balance {
    double left, size;  ///< F v - dU/dt and |F v| + |dU/dt|, W
  };
  Balance balance_at(const Input<double>& in, Mode mode, const std::vector<double>& z) {
    rate_.resize(z.size());
    dual_z_.resize(z.size());
    element_.rate(in, mode, z, rate_);
    for (std::size_t i = 0; i < z.size(); ++i) {
      dual_z_[i] = z[i];
      dual_z_[i].d[0] = rate_[i];
    }
    const double supply = in.v * element_.output(in, mode, z), rise = dual_.storage(mode, dual_z_).d[0];
    return {supply - rise, std::abs(supply) + std::abs(rise)};
  }
  /// True if roundings explain a negative balance, or if `at` (before it was settled into the piece) is a state that
  /// the law holds only within its own slack while a neighbour satisfies the balance.
  bool explained(const SignalPiece& piece, const Input<double>& in, const ElementPoint& at, const ElementPoint& here,
                 const Balance& balance) {
    if (!std::isfinite(balance.left)) return false;
    const double power = 0.1 * rounding * element_.scales().output * std::abs(in.v);
    double slack = power + rounding * balance.size;
    std::vector<double> z = here.z;
    for (std::size_t i = 0; i < z.size(); ++i) {
      z[i] = here.z[i] + rounding * element_.state_scale(static_cast<int>(i));
      slack += std::abs(balance_at(in, here.mode, z).left - balance.left);
      z[i] = here.z[i];
    }
    if (balance.left >= -slack) return true;
    for (std::size_t i = 0; i < z.size(); ++i)
      for (const double change : {neighbour, -neighbour}) {
        ElementPoint next = at;
        next.z[i] += change * element_.state_scale(static_cast<int>(i));
        if (march_.settle(piece, next) && balance_at(in, next.mode, next.z).left >= -slack) return true;
      }
    return false;
  }

  const Element& element_;
  ElementOn<Dual<1>> dual_;
  SupplyMarch march_;
  double energy_;
  bool needs_sign_ = element_.needs_drive();
  std::vector<double> speeds_, rate_;
  std::vector<Dual<1>> dual_z_;
};

}  // namespace

Certificate certify(const Element& element, const MotionScales& scales, const PassivityOptions& options) {
  Certificate certificate;
  // The energy of a spring to a place is not a function of the state alone.
  certificate.offered = element.has_storage() && !element.follows_position();
  if (!certificate.offered) return certificate;
  certificate.holds = true;
  certificate.least = 1.0;
  StorageCheck check(element, scales, options.top_speed);
  std::vector<Strokes> motions = known_strokes(scales, DrivenBy::velocity);
  std::mt19937_64 random(options.seed);
  for (int k = 0; k < 60 * options.effort; ++k) motions.push_back(random_strokes(scales, DrivenBy::velocity, random));
  for (const Strokes& motion : motions) {
    if (options.stop && options.stop()) {
      certificate.status = Status::interrupted;
      certificate.holds = false;
      return certificate;
    }
    // A motion that cannot be marched to its end proves nothing beyond it; too few states are no certificate.
    check.follow(pieces_of(motion, DrivenBy::velocity), certificate);
    if (!certificate.holds) return certificate;
  }
  if (certificate.states < 100) certificate.holds = false;
  return certificate;
}

}  // namespace limcycle
