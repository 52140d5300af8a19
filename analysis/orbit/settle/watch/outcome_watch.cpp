#include "limcycle/analysis/orbit/settle/watch/outcome_watch.hpp"

#include <algorithm>
#include <cmath>

namespace limcycle {
namespace {

/// Fraction at which f changes sign, until f is `share` of what it is at the ends, by the Illinois method; an end where
/// f does not change sign.
template <class F>
double root(const F& f, double share) {
  double a = 0.0, b = 1.0, fa = f(a), fb = f(b);
  if (!(fa * fb < 0.0)) return std::abs(fa) <= std::abs(fb) ? a : b;
  const double enough = share * (std::abs(fa) + std::abs(fb));
  double c = 0.5;
  for (int i = 0, side = 0; i < 60; ++i) {
    c = a - fa * (b - a) / (fb - fa);
    const double fc = f(c);
    if (!(std::abs(fc) > enough)) break;
    const int now = (fc < 0.0) == (fb < 0.0) ? 1 : -1;
    (now == 1 ? b : a) = c;
    (now == 1 ? fb : fa) = fc;
    if (now == side) (now == 1 ? fa : fb) *= 0.5;
    side = now;
  }
  return c;
}

}  // namespace

OutputStep OutputStep::through(double t0, double t1, double y0, double y1, double rate0, double rate1) {
  OutputStep out{t0, t1 - t0, y0, y1, {}};
  const double d0 = out.h * rate0, d1 = out.h * rate1, chord = y1 - y0;
  out.bend[0] = d0 - chord;
  out.bend[1] = 2.0 * chord - d0 - d1;
  return out;
}

OutputStep OutputStep::through(const Loop& loop, const Step& step) {
  const auto y = [&](const State& x) {
    return loop.C_y.dot(Eigen::Map<const Eigen::RowVectorXd>(x.data(), loop.C_y.size()));
  };
  return through(step.t0, step.t1, y(step.x0), y(step.x1), y(step.dx0), y(step.dx1));
}

double OutputStep::value(double theta) const {
  const double curve = bend[0] + theta * (bend[1] + theta * bend[2]);
  return (1.0 - theta) * y0 + theta * (y1 + (1.0 - theta) * curve);
}

double OutputStep::slope(double theta) const {
  const double curve = bend[0] + theta * (bend[1] + theta * bend[2]);
  return y1 - y0 + (1.0 - 2.0 * theta) * curve + theta * (1.0 - theta) * (bend[1] + 2.0 * theta * bend[2]);
}

TurningPoints::Point OutputStep::turning() const {
  const double theta = root([this](double at) { return slope(at); }, 1e-4);  // y there has the square of that error
  return {t + theta * h, value(theta)};
}

double OutputStep::crossing(double level) const {
  return t + h * root([&](double at) { return value(at) - level; }, 1e-14);
}

OutcomeWatch::OutcomeWatch(const Loop& loop, const OutcomeOptions& options, const State& sizes, double slow)
    : loop_(loop), options_(options), stillness_(loop, sizes, slow, options.rtol), switching_(loop, {sizes, slow}) {}

void OutcomeWatch::look(double t, const State& x, const State& dx, const std::vector<Mode>& modes) {
  if (const auto still = stillness_.look(t, x, dx, modes)) decide(still->outcome);
}

void OutcomeWatch::switched(const LoopField& field, const State& x, double t, std::size_t i) {
  if (decided()) return;
  if (loop_.elements[i].facts().has_clock) {
    if (const auto still = stillness_.read(t, x, field)) decide(still->outcome);
    return;
  }
  stillness_.restart(t);
  const auto still = switching_.switched(field, x, t, i);
  if (!still) return;
  by_ = still->by;
  decide(still->outcome);
}

void OutcomeWatch::turned(const OutputStep& step) {
  const auto [t, y] = step.turning();
  const auto& points = turning_.points();
  if (!turning_.feed(t, y) || points.size() < 5) return;
  if (!rest_y_) {
    bool exact = false;
    const double rest = loop_.C_y.dot(loop_.rest_point(exact).transpose());
    rest_y_ = exact ? rest : NAN;
  }
  if (!std::isnan(*rest_y_) && died_out(turning_, *rest_y_, options_.amplitude_floor)) return decide(stillness());
  order_ = repeating();
  if (order_ == 0) return;
  const auto of_y = [](const auto& a, const auto& b) { return a.y < b.y; };
  const auto [low, high] =
      std::minmax_element(points.end() - static_cast<std::ptrdiff_t>(order_) - 1, points.end(), of_y);
  amplitude_ = decided() && outcome_ != Outcome::cycle ? 0.0 : 0.5 * (high->y - low->y);
  // The level is kept as long as possible, so that its crossings can be compared.
  const double margin = 0.2 * (high->y - low->y);
  if (level_ > low->y + margin && level_ < high->y - margin) return;
  level_ = 0.5 * (low->y + high->y);
  crossings_.clear();
}

/// Turning points per period, if the last swings repeat those one period before to within 5 %; else 0.
std::size_t OutcomeWatch::repeating() const {
  for (const std::size_t order : {2U, 4U, 6U}) {
    if (turning_.points().size() <= 2 * order) break;
    bool repeats = true;
    for (std::size_t k = 0; k < order; ++k)
      repeats = repeats && std::abs(turning_.swing(k) / turning_.swing(k + order) - 1.0) <= 0.05;
    if (repeats) return order;
  }
  return 0;
}

/// Largest relative difference between the swings of one period and those of the period before it, `periods` ago.
double OutcomeWatch::difference(std::size_t periods) const {
  double largest = 0.0;
  for (std::size_t k = periods * order_; k < (periods + 1) * order_; ++k)
    largest = std::max(largest, std::abs(turning_.swing(k) / turning_.swing(k + order_) - 1.0));
  return largest;
}

/// The last period and the one before it, from one crossing of the level to that of like phase.
std::optional<std::pair<double, double>> OutcomeWatch::last_periods() const {
  const auto nearest = [this](double t) {
    return *std::ranges::min_element(crossings_, {}, [t](double at) { return std::abs(at - t); });
  };
  const auto& points = turning_.points();
  const double rough = points.back().t - points[points.size() - 1 - order_].t;
  const double now = crossings_.back(), before = nearest(now - rough);
  if (before == now || std::abs(now - before - rough) > 0.1 * rough) return std::nullopt;
  const double first = nearest(before - (now - before));
  if (first == before) return std::nullopt;
  return std::pair(now - before, before - first);
}

void OutcomeWatch::crossed(const OutputStep& step) {
  crossings_.push_back(step.crossing(level_));
  if (crossings_.size() > 16) crossings_.erase(crossings_.begin());
  if (order_ == 0 || (decided() && outcome_ != Outcome::cycle)) return;
  judge();
}

void OutcomeWatch::judge() {
  if (turning_.points().size() <= 4 * order_) return;
  const auto periods = last_periods();
  if (!periods) return;
  const double now = std::max(difference(0), std::abs(periods->first / periods->second - 1.0));
  const double before = difference(1), noise = 10.0 * options_.rtol;
  approached_ = approached_ || (std::max(before, difference(2)) > 10.0 * noise && now < 0.9 * before);
  // A geometric approach: the remaining change is the sum of all future differences. The slower of two paces counts, as
  // a fast part of the motion may hide a slow one for a while.
  const double pace = std::max(now / before, before / difference(2));
  const bool near = now <= noise || (pace < 1.0 && now / (1.0 - pace) <= options_.accuracy);
  if (!near && outcome_ != Outcome::cycle) return;
  decide(Outcome::cycle);
  period_ = periods->first;
}

}  // namespace limcycle
