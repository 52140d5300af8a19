// A friction law of one's own in a servo: will it hunt?
#include <cmath>
#include <cstdio>

#include "limcycle/analysis/study/predict/predict.hpp"
#include "limcycle/models/friction/own_law.hpp"
#include "limcycle/reports/text.hpp"

/// A bristle z under a Stribeck curve of Lorentz' shape: dz/dt = v - s |v| z/g(v), F = s z + d dz/dt.
struct LorentzBristle {
  static constexpr std::string_view kind = "lorentz-bristle";
  double Fs = 1.5, Fc = 1.0, vs = 0.001, s = 1e5, d = 300.0;  // N, N, m/s, N/m, N s/m

  double slip(double v, double z) const {
    return v - s * std::abs(v) * z / (Fc + (Fs - Fc) / (1.0 + v * v / (vs * vs)));
  }
  int states() const { return 1; }
  void rate(const limcycle::Input<double>& in, limcycle::Mode, std::span<const double> z, std::span<double> dz) const {
    dz[0] = slip(in.v, z[0]);
  }
  double output(const limcycle::Input<double>& in, limcycle::Mode, std::span<const double> z) const {
    return s * z[0] + d * slip(in.v, z[0]);
  }
  limcycle::Scales scales() const { return {.displacement = Fs / s, .velocity = vs, .output = Fs}; }
  bool odd() const { return true; }
};

int main() {
  limcycle::LoopParts parts;
  parts.plant = limcycle::Mass{1.0};                    // kg
  parts.controller = limcycle::Pid{{}, 3.0, 4.0, 6.0};  // kp, ki, kd
  parts.friction = limcycle::own_law(LorentzBristle{});
  const auto report = limcycle::predict(limcycle::build_loop(parts));
  std::fputs(limcycle::predict_text("A servo with a law of its own", report, {}).c_str(), stdout);
}
