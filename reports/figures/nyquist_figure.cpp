#include "limcycle/reports/figures/nyquist_figure.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "limcycle/reports/figures/nyquist_window.hpp"
#include "limcycle/reports/format/json_values.hpp"
#include "limcycle/reports/format/number.hpp"

namespace limcycle {
namespace {

constexpr std::size_t most_of_response = 2000;
constexpr std::size_t drawn_members = 7;
constexpr double on_the_curve = 0.03;  ///< relative distance of a root from G that its sampling explains

/// The error discs of all predictions, and the text about them.
Json error_discs(const PredictReport& report, std::string& words) {
  Json discs = Json::array();
  std::string proved, guessed;
  for (const auto& one : report.predictions) {
    if (!one.trust || one.trust->band.discs.empty()) continue;
    const Band& band = one.trust->band;
    for (const auto& disc : band.discs)
      discs.push_back({{"kind", to_string(band.kind)},
                       {"re", rounded(disc.centre.real())},
                       {"im", rounded(disc.centre.imag())},
                       {"r", rounded(disc.radius)},
                       {"w", rounded(disc.frequency)}});
    if (band.kind == BandKind::rigorous)
      proved += fmt::format("{} {} to {} rad/s", proved.empty() ? "" : " and", with_digits(band.frequency.low, 4),
                            with_digits(band.frequency.high, 4));
    else
      guessed += fmt::format("{} {} rad/s", guessed.empty() ? "" : " and", with_digits(one.frequency, 3));
  }
  if (!proved.empty())
    words += fmt::format(
        " Rigorous error discs (Mees-Bergen, solid circles) are drawn over the band{} in which a cycle "
        "is proved.",
        proved);
  if (!guessed.empty())
    words += fmt::format(" The error {} (dashed) at{} {} heuristic.",
                         guessed.find(" and") == std::string::npos ? "disc" : "discs", guessed,
                         guessed.find(" and") == std::string::npos ? "is" : "are");
  return discs;
}

Json response_curve(const NyquistPicture& picture) {
  Json G = {{"re", Json::array()}, {"im", Json::array()}, {"w", Json::array()}};
  const std::size_t stride = picture.G.size() / most_of_response + 1;
  for (std::size_t i = 0; i < std::min(picture.G.size(), picture.frequency.size()); i += stride) {
    G["re"].push_back(rounded(picture.G[i].real()));
    G["im"].push_back(rounded(picture.G[i].imag()));
    G["w"].push_back(rounded(picture.frequency[i]));
  }
  return G;
}

bool near(double a, double b) { return std::abs(a - b) <= 1e-9 * std::abs(b); }

/// True for a few evenly spaced members, and those at the frequency of a root.
bool is_member_drawn(std::size_t member, const PredictReport& report) {
  const auto& frequencies = report.nyquist.family_frequency;
  const std::size_t stride = std::max<std::size_t>(1, (frequencies.size() - 1) / (drawn_members - 1));
  if (member % stride == 0 || member >= frequencies.size()) return true;
  return std::ranges::any_of(report.predictions, [&](const Prediction& one) {
    return one.method == "describing-function" && near(frequencies[member], one.frequency);
  });
}

/// Curves of the family; frequencies are null if N does not depend on them.
Json family_curves(const PredictReport& report, const std::string& unit) {
  const auto& picture = report.nyquist;
  Json A = Json::array(), members = Json::array();
  for (const double amplitude : picture.family_amplitude) A.push_back(rounded(amplitude));
  const bool depends = picture.minus_inverse_N.size() > 1;
  for (std::size_t m = 0; m < picture.minus_inverse_N.size(); ++m) {
    Json re = Json::array(), im = Json::array();
    for (const auto& point : picture.minus_inverse_N[m]) {
      re.push_back(rounded(point.real()));
      im.push_back(rounded(point.imag()));
    }
    const bool known = depends && m < picture.family_frequency.size();
    members.push_back({{"w", known ? rounded(picture.family_frequency[m]) : Json(nullptr)},
                       {"drawn", is_member_drawn(m, report)},
                       {"re", re},
                       {"im", im}});
  }
  return {{"A", A}, {"unit", unit}, {"members", members}};
}

/// -1/N of a root: the point of the family that was computed there; empty if the family ends before it.
std::optional<std::complex<double>> place_of(const NyquistPicture& picture, const Prediction& root) {
  const auto amplitude =
      std::ranges::find_if(picture.family_amplitude, [&](double A) { return near(A, root.input_amplitude); });
  std::size_t member = 0;
  if (picture.minus_inverse_N.size() > 1)
    while (member < picture.family_frequency.size() && !near(picture.family_frequency[member], root.frequency))
      ++member;
  if (amplitude == picture.family_amplitude.end() || member >= picture.minus_inverse_N.size()) return std::nullopt;
  const auto column = static_cast<std::size_t>(amplitude - picture.family_amplitude.begin());
  const auto& points = picture.minus_inverse_N[member];
  if (column >= points.size() || !std::isfinite(std::abs(points[column]))) return std::nullopt;
  return points[column];
}

struct Crossings {
  Json roots = Json::array();
  std::vector<std::complex<double>> places;
  std::string words;     ///< their places
  bool on_curve = true;  ///< all of them lie on G
};

Crossings crossings_of(const PredictReport& report, const Units& units) {
  Crossings out;
  for (std::size_t i = 0; i < report.predictions.size(); ++i) {
    const auto& one = report.predictions[i];
    if (one.method != "describing-function") continue;
    const auto on_G = response_at(report.nyquist, one.frequency);
    const auto drawn = place_of(report.nyquist, one);
    const auto place = drawn ? drawn : on_G;
    if (!place) continue;
    if (on_G && std::abs(*place - *on_G) > on_the_curve * std::abs(*on_G)) out.on_curve = false;
    out.places.push_back(*place);
    out.roots.push_back({{"prediction", i},
                         {"re", rounded(place->real())},
                         {"im", rounded(place->imag())},
                         {"A", rounded(one.input_amplitude)},
                         {"w", rounded(one.frequency)},
                         {"verdict", to_string(one.verdict)}});
    out.words += fmt::format("{} amplitude {} and {} rad/s ({})", out.words.empty() ? "" : ";",
                             Units::attach(with_digits(one.input_amplitude, 3), units.input),
                             with_digits(one.frequency, 3), to_string(one.verdict));
  }
  return out;
}

}  // namespace

Figure nyquist_figure(const PredictReport& report, const Units& units) {
  const Crossings crossings = crossings_of(report, units);
  std::string about_discs;
  const Json discs = error_discs(report, about_discs);
  const auto box = nyquist_window(report.nyquist, crossings.places);
  std::string finding =
      "The Nyquist curve G(jω) of the linear part and the curves −1/N(A,ω) of the element have no point in common at "
      "equal frequency: the describing function predicts no limit cycle.";
  if (!crossings.places.empty() && crossings.on_curve)
    finding = "The Nyquist curve G(jω) of the linear part meets the curves −1/N(A,ω) of the element at";
  else if (!crossings.places.empty())
    finding =
        "1 + N G = 0 holds where crosses are drawn, off the curve G(jω): that is the one for small motions, and in "
        "this loop G changes with the amplitude. The crosses stand at";
  if (!crossings.places.empty()) finding += crossings.words + "." + about_discs;
  return {"nyquist", "Nyquist plot and describing function", finding,
          figure_data(json_text({{"G", response_curve(report.nyquist)},
                                 {"small_motions", !crossings.on_curve},
                                 {"family", family_curves(report, units.input)},
                                 {"roots", crossings.roots},
                                 {"discs", discs},
                                 {"window", {{"re", {box.re_from, box.re_to}}, {"im", {box.im_from, box.im_to}}}}}))};
}

}  // namespace limcycle
