#include <algorithm>

#include "limcycle/cases/loader/sections/parameters.hpp"
#include "limcycle/cases/loader/sections/sections.hpp"

namespace limcycle::case_file {
namespace {

Element read_friction(const Section& section, const std::optional<Element>& own) {
  const auto kind = section.find("kind");
  const auto* name = kind ? kind->value.as<std::string>() : nullptr;
  if (name != nullptr && *name == "own") {
    if (!own) throw kind->error("stands for a law of one's own, which C++ or Python hands over: no file holds it");
    section.allow({"kind"});
    return *own;
  }
  return read_element(section, catalogue_of_elements().friction_laws,
                      {.what = "friction law",
                       .elsewhere = limcycle::kinds_of(catalogue_of_elements().forward_elements),
                       .elsewhere_hint = "is an element in series: it belongs in [loop.element]"});
}

Element read_series(const Section& section) {
  return read_element(section, catalogue_of_elements().series_elements,
                      {.what = "element",
                       .elsewhere = limcycle::kinds_of(catalogue_of_elements().error_elements),
                       .elsewhere_hint = "acts on the error: it belongs in [loop.error]"});
}

Element read_error(const Section& section) {
  const auto& kinds = catalogue_of_elements();
  const std::string may = joined(limcycle::kinds_of(kinds.error_elements));
  return read_element(section, kinds.error_elements,
                      {.what = "element on the error",
                       .elsewhere = limcycle::kinds_of(kinds.series_elements),
                       .elsewhere_hint = "does not act on the error (" + may + " may)"});
}

Plant read_plant(const Section& section) {
  return read_any<Plant>(section, {.what = "plant", .elsewhere = {}, .elsewhere_hint = {}});
}

Controller read_controller(const std::optional<Section>& section) {
  if (!section) return NoController{};
  return read_any<Controller>(*section, {.what = "controller", .elsewhere = {}, .elsewhere_hint = {}});
}

/// Parameters that are valid one by one may still overflow together (a mass of 1e-320 kg has no finite inverse).
bool is_finite(const Plant& plant) {
  const PlantModel model = std::visit([](const auto& p) { return p.model(); }, plant);
  return model.A.allFinite() && model.B_u.allFinite() && model.C_y.allFinite() && model.C_v.allFinite();
}

bool is_finite(const Loop& loop) {
  bool finite = loop.A.allFinite() && loop.A_delayed.allFinite() && loop.B.allFinite() && loop.E.allFinite();
  for (const auto& port : loop.ports)
    finite = finite && port.C.allFinite() && port.D.allFinite() && port.C_v.allFinite() && port.D_v.allFinite();
  return finite;
}

bool plants_are_finite(const LoopParts& parts) {
  if (!parts.diagram) return is_finite(parts.plant);
  return std::ranges::all_of(parts.diagram->blocks, [](const Block& block) {
    const auto* plant = std::get_if<Plant>(&block.what);
    return plant == nullptr || is_finite(*plant);
  });
}

}  // namespace

void read_reference(const Place& place, LoopParts& parts) {
  if (place.value.as<Value::Table>() == nullptr) {
    if (place.value.as<double>() == nullptr && place.value.as<std::int64_t>() == nullptr)
      throw place.wrong_type("a number or {kind = \"ramp\", rate = ...}");
    parts.reference = read_number(place);
    return;
  }
  const Section section(place.document, place.value, place.path);
  section.allow({"kind", "rate"});
  constexpr std::string_view kinds[] = {"ramp"};
  read_choice(section.at("kind", "\"ramp\""), kinds);
  parts.reference_rate = read_number(section.at("rate", "slope of the ramp, 1/s"));
}

void check_together(const Section& section, const std::string& key, const LoopParts& parts) {
  const auto& document = section.document();
  const std::string overflows = "overflows: its parameters differ too much in size";
  if (!plants_are_finite(parts)) throw document.error_at(key + (parts.diagram ? "" : ".plant"), overflows);
  if (const auto broken = validate(parts)) throw document.error_at(broken->key, broken->rule);
  if (!is_finite(build_loop(parts))) throw document.error_at(key, overflows);
}

std::optional<Loop> finite_loop(const LoopParts& parts) {
  if (!plants_are_finite(parts) || validate(parts)) return std::nullopt;
  Loop loop = build_loop(parts);
  return is_finite(loop) ? std::optional(std::move(loop)) : std::nullopt;
}

void read_loop(const Section& section, Case& into) {
  section.allow({"plant", "controller", "friction", "element", "error", "reference", "load"});
  const auto plant = section.section("plant"), controller = section.section("controller");
  const auto friction = section.section("friction"), element = section.section("element");
  const auto error = section.section("error");
  const bool lone = !plant && !controller && !error && !section.find("reference") && !section.find("load") &&
                    friction.has_value() != element.has_value();
  if (!plant && !lone) throw section.error("plant", "is required: a loop needs [loop.plant]");

  into.element_path = friction ? "loop.friction" : element ? "loop.element" : "loop.error";
  if (lone) {
    into.element = friction ? read_friction(*friction, into.own) : read_series(*element);
    return;
  }
  LoopParts parts;
  parts.plant = read_plant(*plant);
  parts.controller = read_controller(controller);
  if (element) parts.element = read_series(*element);
  if (friction) parts.friction = read_friction(*friction, into.own);
  if (error) parts.error = read_error(*error);
  if (const auto reference = section.find("reference")) read_reference(*reference, parts);
  if (const auto load = section.find("load")) parts.load = read_number(*load);
  check_together(section, "loop", parts);
  into.loop = std::move(parts);
}

}  // namespace limcycle::case_file
