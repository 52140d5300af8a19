#include "limcycle/reports/figures/work_figures.hpp"

#include <cmath>
#include "limcycle/reports/format/json_values.hpp"

namespace limcycle {
namespace {}  // namespace

Figure work_figure(const std::string& id, const std::string& heading, const std::string& finding,
                   const std::string& x_title, const std::string& y_title, const std::vector<WorkSeries>& series) {
  Json data = {{"x", x_title}, {"y", y_title}, {"series", Json::array()}};
  double top = 0.0;
  for (const auto& one : series)
    for (const auto& mark : one.marks)
      if (std::isfinite(mark.y)) top = std::max(top, mark.y);
  top = top > 0.0 ? std::pow(10.0, std::ceil(std::log10(top) + 0.3)) : 1.0;
  for (const auto& one : series) {
    Json out = {{"name", one.name}, {"joined", one.joined}, {"dash", one.dash}, {"colour", one.colour}};
    for (const char* key : {"x", "y", "good", "label"}) out[key] = Json::array();
    for (const auto& mark : one.marks) {
      out["x"].push_back(number(mark.x));
      out["y"].push_back(number(std::isfinite(mark.y) ? mark.y : top));
      out["good"].push_back(mark.good && std::isfinite(mark.y));
      out["label"].push_back(mark.label);
    }
    data["series"].push_back(std::move(out));
  }
  return {id, heading, finding, figure_data(json_text(data))};
}

}  // namespace limcycle
