#include "limcycle/cases/parameters.hpp"
#include "limcycle/cases/sections.hpp"

namespace limcycle::case_file {
namespace {

// Kinds and keys that the case format fixes and later versions bring. A kind that has arrived is found first, so that
// nothing here needs to change when a law is added.
const std::vector<std::string> later_laws = {
    "karnopp", "quinn",   "awrejcewicz",  "wojewoda", "kikuuwe", "bouc-wen", "lugre-spline", "elasto-plastic",
    "leuven",  "jenkins", "maxwell-slip", "iwan",     "gms",     "xiong",    "two-state",    "non-drift"};
const std::vector<std::string> later_plants = {"froude-pendulum"};

using AnyElement = Element<double>;
using FrictionLaw = FrictionLaws::On<double>;
using ForwardElement = ForwardElements::On<double>;
using SeriesElement = SeriesElements::On<double>;
using ErrorElement = ErrorElements::On<double>;

AnyElement read_friction(const Section& section) {
  return read_any<FrictionLaw, AnyElement>(section,
                                           {.what = "friction law",
                                            .later = later_laws,
                                            .elsewhere = kinds_of<ForwardElement>(),
                                            .elsewhere_hint = "is an element in series: it belongs in [loop.element]",
                                            .later_keys = {}});
}

AnyElement read_element(const Section& section) {
  return read_any<SeriesElement, AnyElement>(section,
                                             {.what = "element",
                                              .later = later_laws,
                                              .elsewhere = kinds_of<ErrorElement>(),
                                              .elsewhere_hint = "acts on the error: it belongs in [loop.error]",
                                              .later_keys = {}});
}

AnyElement read_error(const Section& section) {
  return read_any<ErrorElement, AnyElement>(
      section, {.what = "element on the error",
                .later = later_laws,
                .elsewhere = kinds_of<SeriesElement>(),
                .elsewhere_hint = "does not act on the error (" + joined(kinds_of<ErrorElement>()) + " may)",
                .later_keys = {}});
}

Plant read_plant(const Section& section) {
  return read_any<Plant>(
      section, {.what = "plant", .later = later_plants, .elsewhere = {}, .elsewhere_hint = {}, .later_keys = {}});
}

Controller read_controller(const std::optional<Section>& section) {
  if (!section) return NoController{};
  return read_any<Controller>(
      *section, {.what = "controller", .later = {}, .elsewhere = {}, .elsewhere_hint = {}, .later_keys = {}});
}

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

void check_together(const Section& section, const LoopParts& parts) {
  const auto& document = section.document();
  if (!is_finite(parts.plant))
    throw document.error_at("loop.plant", "overflows: its parameters differ too much in size");
  if (const auto broken = validate(parts)) throw document.error_at(broken->key, broken->rule);
  if (!is_finite(build_loop(parts)))
    throw document.error_at("loop", "overflows: its parameters differ too much in size");
}

}  // namespace

InputError unknown_kind(const Place& kind, const std::vector<std::string>& available, const KindNames& names) {
  const std::string name = *kind.value.as<std::string>();
  const auto among = [&](const std::vector<std::string>& list) { return std::ranges::find(list, name) != list.end(); };
  if (among(names.elsewhere)) return kind.error(names.elsewhere_hint);
  if (among(names.later))
    return kind.error("known to the case format, not available in this version", "available: " + joined(available));
  std::vector<std::string> all = available;
  all.insert(all.end(), names.later.begin(), names.later.end());
  const auto near = nearest_name(name, all);
  return kind.error("unknown " + names.what,
                    near.empty() ? "known: " + joined(available) : "did you mean \"" + near + "\"?");
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
    into.element = friction ? read_friction(*friction) : read_element(*element);
    return;
  }
  LoopParts parts;
  parts.plant = read_plant(*plant);
  parts.controller = read_controller(controller);
  if (element) parts.element = read_element(*element);
  if (friction) parts.friction = read_friction(*friction);
  if (error) parts.error = read_error(*error);
  if (const auto reference = section.find("reference")) read_reference(*reference, parts);
  if (const auto load = section.find("load")) parts.load = read_number(*load);
  check_together(section, parts);
  into.loop = std::move(parts);
}

}  // namespace limcycle::case_file
