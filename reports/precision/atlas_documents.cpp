#include <cmath>

#include "limcycle/reports/document_header.hpp"
#include "limcycle/reports/format/json_values.hpp"
#include "limcycle/reports/format/number.hpp"
#include "limcycle/reports/page/html_parts.hpp"
#include "limcycle/reports/precision/atlas.hpp"

namespace limcycle {
namespace {

Json point_json(const AtlasPoint& point) {
  return {{"law", point.law},
          {"stiffness", number(point.stiffness)},
          {"stepper", point.stepper},
          {"setting", number(point.setting)},
          {"of", point.fixed_step ? "step" : "rtol"},
          {"result", to_string(point.kind)},
          {"error", number(point.error)},
          {"steps", point.steps},
          {"why", point.why}};
}

/// For each stepper and stiffness: the loosest tolerance that is right, as are all tighter ones.
Json limits_json(const StepperAtlas& atlas) {
  Json out = Json::array();
  std::vector<std::pair<std::string, double>> seen;
  for (const auto& point : atlas.points) {
    const std::pair key(point.stepper, std::isfinite(point.stiffness) ? point.stiffness : 0.0);
    if (std::ranges::find(seen, key) != seen.end()) continue;
    seen.push_back(key);
    out.push_back({{"stepper", point.stepper},
                   {"up_to_stiffness", number(point.stiffness)},
                   {"loosest_right", number(loosest_right(atlas, point.stepper, key.second))}});
  }
  return out;
}

}  // namespace

std::string atlas_json(const Provenance& provenance, const StepperAtlas& atlas) {
  Json top;
  top["answer"] = atlas_answer(atlas);
  top["points"] = Json::array();
  for (const auto& point : atlas.points) top["points"].push_back(point_json(point));
  top["reference"] = Json::array();
  for (const auto& one : atlas.references)
    top["reference"].push_back({{"law", one.law},
                                {"stiffness", number(one.stiffness)},
                                {"verified", one.verified},
                                {"hunts", one.hunts},
                                {"period", number(one.period)},
                                {"agreement", number(one.agreement)},
                                {"words", one.words}});
  top["limits"] = limits_json(atlas);
  top["right_within"] = atlas_right;
  top["rough_within"] = atlas_rough;
  top["status"] = to_string(atlas.status);
  return json_document("precision", provenance, json_text(top));
}

std::string atlas_csv(const StepperAtlas& atlas) {
  std::string out = csv_line({"law", "stiffness", "stepper", "setting", "of", "result", "error", "steps", "why"});
  for (const auto& point : atlas.points)
    out += csv_line({point.law, shortest(point.stiffness), point.stepper, shortest(point.setting),
                     point.fixed_step ? "step" : "rtol", std::string(to_string(point.kind)), shortest(point.error),
                     std::to_string(point.steps), point.why});
  return out;
}

std::string atlas_page(const StepperAtlas& atlas, const Provenance& provenance, const std::string& case_text) {
  std::string body =
      "<h2>Outcome of every run</h2>\n" +
      html_picture(atlas_picture(atlas),
                   "Each square is a run: of a stepper, at a tolerance or step, at a stiffness before sliding. "
                   "Colour and letter show its outcome.",
                   atlas_csv(atlas));
  std::vector<std::string> laws;
  for (const auto& one : atlas.references)
    if (std::ranges::find(laws, one.law) == laws.end()) laws.push_back(one.law);
  for (const auto& law : laws) {
    body += html_tag("h2", law);
    body += html_table(atlas_table(atlas, law),
                       "The largest tolerance, or step, from which on all are right (*: tighter ones were too slow); "
                       "else what became of the tightest; by stiffness before sliding");
    body += "<ul>\n";
    for (const auto& one : atlas.references)
      if (one.law == law)
        body +=
            html_tag("li", (std::isfinite(one.stiffness) ? with_digits(one.stiffness, 1) + " N/m: " : std::string()) +
                               (one.verified ? "" : "left out, no verified reference: ") + one.words);
    body += "</ul>\n";
  }
  return html_page({.provenance = provenance,
                    .answer = atlas_answer(atlas),
                    .worth = {},
                    .body = body,
                    .command = "precision",
                    .flags = laws.size() > 1 ? "--stability --families" : "--stability",
                    .case_text = case_text});
}

}  // namespace limcycle
