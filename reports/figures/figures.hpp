#pragma once
#include <string>
#include <vector>

#include "limcycle/analysis/study/predict.hpp"
#include "limcycle/reports/units.hpp"

namespace limcycle {

/// A figure of the page: what it shows, in words that also serve those who do not see it, and the numbers to draw.
struct Figure {
  std::string id;  ///< "nyquist", "time", "phase", "loop", "multipliers": the part of the script that draws it
  std::string heading;
  std::string finding;  ///< plain text: what one sees
  std::string data;     ///< JSON object, without '<'
};

/// The figures that a report allows: those for which there is nothing to draw are left out. No curve has more than
/// about 2000 points; where a simulation is too long to draw only its first part is shown, and the text says so.
std::vector<Figure> predict_figures(const PredictReport& report, const Units& units);

/// JSON text as it may stand inside a script element of a page: without '<'.
std::string figure_data(const std::string& json);

/// Markup of figures, which the script of the page draws. Without scripts their findings remain. `hint`: with a line on
/// how to move them, once a page is enough.
std::string figures_html(const std::vector<Figure>& figures, bool hint = true);

}  // namespace limcycle
