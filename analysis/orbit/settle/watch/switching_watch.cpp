#include "limcycle/analysis/orbit/settle/watch/switching_watch.hpp"

#include <algorithm>
#include <cmath>

#include "limcycle/analysis/motion/field/affine_flow.hpp"
#include "limcycle/analysis/motion/time_scales.hpp"
#include "limcycle/analysis/orbit/settle/linear_motion.hpp"
#include "limcycle/analysis/short_number.hpp"
#include "limcycle/models/element/with_memory/relay.hpp"

namespace limcycle {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::RowVectorXd;
using Eigen::VectorXd;

/// The two outputs between which a relay switches at one surface.
struct Jump {
  Mode low, high;
  double w_low = 0.0, w_high = 0.0;
};

Jump jump_at(const Relay<double>& relay, double input) {
  if (!(relay.dead_zone > 0.0)) return {{-1}, {1}, -relay.level, relay.level};
  if (input > 0.0) return {{0}, {1}, 0.0, relay.level};
  return {{-1}, {0}, -relay.level, 0.0};
}

/// The loop about its sliding mode of order two, in sizes and slowest time constants.
class SecondOrderSliding {
 public:
  SecondOrderSliding(LoopField field, const State& x, std::size_t relay, const LoopSizes& scale)
      : field_(std::move(field)), relay_(relay), scale_(scale), size_(std::ssize(x)) {
    const Port& port = field_.loop().ports[relay];
    sizes_ = Eigen::Map<const VectorXd>(scale.sizes.data(), size_);
    c_ = RowVectorXd::Zero(size_);
    c_.head(field_.loop().states()) = port.C;
    c_ = c_.cwiseProduct(sizes_.transpose()).eval();
    State dx, unused(field_.size());
    field_.rate(x, dx, 0.0);
    jump_ = jump_at(law_of<Relay<double>>(field_.loop().elements[relay]), field_.input(relay).x);
    field_.modes()[relay] = jump_.low;
    const VectorXd low = rates(x);
    field_.jacobian(x, J_, 0.0, unused);
    J_ = scale.slow * sizes_.cwiseInverse().asDiagonal() * J_ * sizes_.asDiagonal();
    field_.modes()[relay] = jump_.high;
    b_ = (rates(x) - low) / (jump_.w_high - jump_.w_low);
    field_.modes()[relay] = jump_.low;
    reach_ = c_ * J_ * b_;
    damping_ = (c_ * J_ * J_ * b_).value() / reach_;
    // On the surface with x' = 0: along b, which moves x' and not x.
    at_ = x;
    const VectorXd back = b_ * ((c_ * low).value() / reach_);
    for (Index k = 0; k < size_; ++k) at_[static_cast<std::size_t>(k)] -= back(k) * sizes_(k);
  }

  /// True if the relay acts on its input only through the second derivative, against it, with swings that decay.
  bool attracts() const {
    constexpr double negligible = 1e-10;
    const double size = c_.cwiseAbs() * b_.cwiseAbs();
    const double size_of_reach = c_.cwiseAbs() * J_.cwiseAbs() * b_.cwiseAbs();
    return std::abs((c_ * b_).value()) <= negligible * size && reach_ < -negligible * size_of_reach && damping_ < 0.0;
  }

  /// The state of rest that it approaches, if the mean output stays within the jump by `margin`, as a share of it.
  std::optional<Stillness> settles(double margin) {
    const VectorXd low = rates(at_);
    const RowVectorXd pull = c_ * J_;
    MatrixXd held(2, size_);
    held << c_.normalized(), pull.normalized();
    const VectorXd along = low + b_ * (mean_output(low) - jump_.w_low);
    const LinearMotion motion = linear_motion(J_ - b_ * (pull * J_) / reach_, along, held, sizes_);
    if (!motion.settles) return std::nullopt;
    const State centre = motion.around(at_, -motion.amounts);
    const double w = mean_output(rates(centre));
    const VectorXd left = rates(centre) + b_ * (w - jump_.w_low);  // A X + B w + E ext
    if (!(left.cwiseAbs().maxCoeff() <= 1e-9)) return std::nullopt;
    const auto inside = [&](const State& x, std::vector<double>& values) { limits(x, margin, values); };
    if (!stay_positive(inside, centre, motion)) return std::nullopt;
    const double decay = std::min(-damping_ / 3.0, motion.decay) / scale_.slow;
    return Stillness{rubs_at(field_, centre) ? Outcome::sliding : Outcome::rest,
                     "through ever faster switching of " + field_.loop().ports[relay_].path +
                         ", whose mean output becomes " + short_number(w) + "; what is left decays at " +
                         short_number(decay, 3) + " 1/s",
                     "switching"};
  }

 private:
  VectorXd rates(const State& x) {
    State dx;
    field_.rate(x, dx, 0.0);
    return scale_.slow * Eigen::Map<const VectorXd>(dx.data(), size_).cwiseQuotient(sizes_);
  }
  /// w with x'' = 0, from the rates at the low output.
  double mean_output(const VectorXd& low) const { return jump_.w_low - (c_ * J_ * low).value() / reach_; }

  /// Functions that must stay positive: the distances of the mean output from the ends of the jump, and the guards of
  /// the other elements at either output.
  void limits(const State& x, double margin, std::vector<double>& values) {
    const double w = mean_output(rates(x)), spare = margin * (jump_.w_high - jump_.w_low);
    values = {w - jump_.w_low - spare, jump_.w_high - spare - w};
    std::vector<double> guards;
    for (const Mode mode : {jump_.high, jump_.low}) {
      field_.modes()[relay_] = mode;
      field_.guards(x, 0.0, guards);
      for (std::size_t k = 0; k < guards.size(); ++k)
        if (field_.owner(k) != relay_) values.push_back(guards[k]);
    }
  }

  LoopField field_;
  std::size_t relay_;
  const LoopSizes& scale_;
  Index size_;
  VectorXd sizes_, b_;
  RowVectorXd c_;
  MatrixXd J_;
  Jump jump_;
  double reach_ = 0.0, damping_ = 0.0;
  State at_;
};

/// True if element i is an ideal relay whose input no other output reaches at once.
bool is_ideal_relay(const Loop& loop, std::size_t i) {
  const auto* relay = loop.elements[i].as<Relay<double>>();
  return relay && relay->hysteresis == 0.0 && loop.ports[i].D.isZero(0.0);
}

}  // namespace

SwitchingWatch::SwitchingWatch(const Loop& loop, LoopSizes scale) : loop_(loop), scale_(std::move(scale)) {
  for (std::size_t i = 0; i < loop.elements.size(); ++i) applies_ = applies_ || is_ideal_relay(loop, i);
  applies_ = applies_ && AffineFlow::applies(loop);
  const auto moduli = applies_ ? pole_moduli(loop) : std::vector<double>{};
  if (!moduli.empty()) fastest_ = moduli.back();
}

std::optional<Stillness> SwitchingWatch::switched(const LoopField& field, const State& x, double t, std::size_t i) {
  constexpr double short_swing = 0.02, sooner = 0.5;  // of the fastest time constant; of the swings at the last try
  if (!applies_ || !is_ideal_relay(loop_, i)) return std::nullopt;
  Swings& swings = swings_[i];
  std::shift_left(std::begin(swings.lengths), std::end(swings.lengths), 1);
  swings.lengths[3] = t - swings.last;
  swings.last = t;
  const double longest = *std::ranges::max_element(swings.lengths);
  if (!(longest * fastest_ <= short_swing) || !(longest <= sooner * swings.tried)) return std::nullopt;
  swings.tried = longest;
  SecondOrderSliding sliding(field, x, i, scale_);
  if (!sliding.attracts()) return std::nullopt;
  return sliding.settles(longest * fastest_);
}

}  // namespace limcycle
