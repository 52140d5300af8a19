#pragma once
#include <vector>

#include "limcycle/models/element/element.hpp"

namespace limcycle {

/// A law with one state at the point (z, v), its mode settled there.
struct OneStatePoint {
  double rate = 0.0;    ///< f(z, v) = dz/dt
  double supply = 0.0;  ///< F(z, v) v, W; at x = 0
  double force = 0.0;   ///< F(z, v), N; at x = 0
  Mode mode{};
  bool exists = true;  ///< false if the law does not stay in that state (a slider beyond its limit)
};

/// A law dz/dt = f(z, v), F = F(z, v) with one state, whose mode is a function of state and velocity, so that both
/// determine the further motion. A parallel spring to the place x = 0 (Bouc-Wen, alpha > 0) is lossless and not
/// counted: F is taken at x = 0.
class OneStateLaw {
 public:
  /// Laws of this kind: dahl, bouc-wen, lugre, lugre-spline, elasto-plastic, jenkins, kikuuwe. Not wojewoda, whose
  /// force follows the drive and whose mode is a memory, nor a single element of gms, whose slip is one.
  static bool fits(const Element& element);

  /// Throws std::invalid_argument for a law that does not fit, or a top speed that is not positive.
  OneStateLaw(const Element& law, double top_speed);

  OneStatePoint at(double z, double v) const;
  /// Energy taken out per unit of |z| passed, -F v/|f|, where sign(f) = direction; -infinite otherwise.
  double gain(double z, double v, int direction) const;

  const Element& law() const { return law_; }
  double top_speed() const { return top_speed_; }
  double velocity_scale() const { return velocity_scale_; }
  bool rate_independent() const { return rate_independent_; }

  /// Speeds at which the law is evaluated, ascending: the limit v -> 0+, then logarithmic from 1e-9 to 1e9 times the
  /// velocity scale or up to the top speed, dense about the scale and between the knots of a curve, with the speeds of
  /// the largest and least f/|v|. A rate-independent law: one speed.
  const std::vector<double>& speeds() const { return speeds_; }

  /// States that can be reached from z = 0, closed interval: z grows as long as some |v| <= top speed has f > 0. The
  /// sharp bound of the state; infinite if there is none.
  double low() const { return low_; }
  double high() const { return high_; }

 private:
  void choose_speeds();
  void add_extreme_speeds();
  /// Velocities that drive z outwards there, and a test if any of given ones does.
  std::vector<double> outward(double z, int direction) const;
  bool goes(double z, int direction, const std::vector<double>& velocities) const;
  double last_place(double here, double there, int direction, const std::vector<double>& velocities) const;
  double edge(int direction) const;

  Element law_;
  double top_speed_, velocity_scale_, low_ = 0.0, high_ = 0.0;
  bool rate_independent_;
  std::vector<double> speeds_;
};

}  // namespace limcycle
