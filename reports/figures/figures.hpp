#pragma once
#include <string>
#include <vector>

#include "limcycle/analysis/study/predict/predict.hpp"
#include "limcycle/reports/units.hpp"

namespace limcycle {

/// A figure of the page: its finding, in words that also serve readers who cannot see it, and the numbers to draw.
struct Figure {
  std::string id;  ///< "nyquist", "time", "phase", "loop", "multipliers": the part of the script that draws it
  std::string heading;
  std::string finding;  ///< plain text: what the figure shows
  std::string data;     ///< JSON object, without '<'
};

/// The figures that a report allows: those with nothing to draw are left out. No curve has more than about 2000 points;
/// if a simulation is too long to draw, only its first part is shown, and the text states it.
std::vector<Figure> predict_figures(const PredictReport& report, const Units& units);

/// JSON text made safe for a script element of a page: without '<'.
std::string figure_data(const std::string& json);

/// Markup of figures, which the script of the page draws. Without scripts their findings remain. `hint`: adds a line on
/// how to move them, needed once a page.
std::string figures_html(const std::vector<Figure>& figures, bool hint = true);

}  // namespace limcycle
