#include "limcycle/cases/loader/case.hpp"

#include <filesystem>

#include "limcycle/cases/loader/sections/sections.hpp"
#include "limcycle/models/measured/plants_of_loop.hpp"

namespace limcycle {
namespace {

/// The second derivative of a reference is not among the signals of a loop: it is zero, or the run would lack it.
void check_feedforward(const case_file::Document& document, const Case& from) {
  const auto* cascade = std::get_if<Cascade>(&from.loop->controller);
  if (cascade == nullptr || cascade->acceleration_feedforward == 0.0 || !from.simulate->reference) return;
  const auto kind = from.simulate->reference->kind;
  if (kind == Signal::Kind::constant || kind == Signal::Kind::step || kind == Signal::Kind::ramp) return;
  throw document.error_at("simulate.reference",
                          "accelerates, and acceleration_feedforward is not simulated: use a constant, step or ramp");
}

Case read_document(const case_file::Document& document, const std::optional<Element>& own) {
  const case_file::Section top(document, document.root, "");
  top.allow({"title", "loop", "diagram", "units", "search", "df", "simulate", "predict", "sensitivity", "dissipativity",
             "claim", "identify"});
  Case result;
  result.own = own;
  result.file = document.file;
  result.overrides = document.overrides;
  result.title = std::filesystem::path(document.file).stem().string();
  if (const auto title = top.find("title")) result.title = case_file::read_string(*title);

  const auto loop = top.section("loop"), diagram = top.section("diagram"), identify = top.section("identify");
  if (!loop && !diagram && !identify) throw top.error("loop", "is required: a case needs [loop] or [diagram]");
  if (loop && diagram) throw top.error("diagram", "cannot stand beside [loop]: the diagram is the whole loop");
  if (loop)
    case_file::read_loop(*loop, result);
  else if (diagram)
    case_file::read_diagram(*diagram, result);
  if (const auto units = top.section("units")) result.y_unit = case_file::read_units(*units);
  if (const auto search = top.section("search")) result.predict.search = case_file::read_search(*search);
  if (const auto df = top.section("df")) result.df = case_file::read_df(*df);
  if (const auto predict = top.section("predict")) case_file::read_predict(*predict, result);
  if (const auto simulate = top.section("simulate")) {
    if (!result.loop) throw simulate->document().error_at("simulate", "needs a loop: add [loop.plant]");
    result.simulate = case_file::read_simulate(*simulate, state_names(build_loop(*result.loop)));
    check_feedforward(simulate->document(), result);
  }
  if (const auto energy = top.section("dissipativity")) result.dissipativity = case_file::read_dissipativity(*energy);
  if (const auto sensitivity = top.section("sensitivity"))
    result.sensitivity = case_file::read_sensitivity(*sensitivity, result);
  if (identify) result.identify = case_file::read_identify(*identify);
  if (const auto claims = top.find("claim")) result.claims = case_file::read_claims(*claims, result);
  return result;
}

InputError missing(const Case& from, const std::string& key, const std::string& rule) {
  return InputError(
      {.file = from.file, .line = 0, .override = {}, .key = key, .value = {}, .rule = rule, .suggestion = {}});
}

}  // namespace

std::vector<DfPoint> DfSection::points() const {
  std::vector<DfPoint> all;
  all.reserve(size());
  for (const double a : amplitude)
    for (const double w : frequency)
      for (const double b : bias) all.push_back({.amplitude = a, .frequency = w, .bias = b});
  return all;
}

Case read_case(std::string_view text, const std::string& file, const std::vector<std::string>& overrides,
               const std::optional<Element>& own) {
  case_file::check_text(text, file);
  case_file::Document document = case_file::parse(text, file);
  for (const auto& override : overrides) case_file::apply_override(document, override);
  auto curves = case_file::read_curves(document);
  auto matrices = case_file::read_matrices(document);
  Case result = read_document(document, own);
  result.curves = std::move(curves);
  result.matrices = std::move(matrices);
  result.text = text;
  if (!own) result.sha256 = sha256(text);
  return result;
}

Case read_again(const Case& from, const std::vector<std::string>& overrides) {
  return read_case(from.text, from.file, overrides, from.own);
}

Case load_case(const std::string& file, const std::vector<std::string>& overrides) {
  return read_case(case_file::read_text(file), file, overrides);
}

std::vector<CaseData> data_of(const Case& from) {
  std::vector<CaseData> files;
  if (from.loop)
    for (const MeasuredPlantAt& plant : measured_plants(*from.loop))
      if (!plant.response->data().sha256.empty())
        files.push_back({plant.path, plant.response->data().file, plant.response->data().sha256});
  for (const CurveFile& curve : from.curves) files.push_back({curve.path, curve.file, curve.sha256});
  for (const MatrixFile& one : from.matrices) files.push_back({one.path, one.file, one.sha256});
  return files;
}

const LoopParts& need_loop(const Case& from) {
  if (!from.loop)
    throw missing(from, "loop.plant",
                  from.element ? "is required by this command: the case holds a lone element"
                               : "is required by this command: the case holds records only");
  return *from.loop;
}

const Element& need_element(const Case& from) {
  if (!from.element) throw missing(from, "loop", "is required by this command: the case holds records only");
  return *from.element;
}

const DfSection& need_df(const Case& from) {
  if (!from.df) throw missing(from, "df", "is required by this command: add [df] with amplitude and frequency");
  return *from.df;
}

const SimulateOptions& need_simulate(const Case& from) {
  if (!from.simulate) throw missing(from, "simulate", "is required by this command: add [simulate] with duration");
  return *from.simulate;
}

const Element& df_element(const Case& from) {
  if (!from.loop) return need_element(from);
  const Subject subject = subject_of(*from.loop);
  if (subject.element == nullptr && !from.loop->diagram)
    throw missing(from, "loop.friction", "is required by this command: the loop holds neither friction nor an element");
  if (subject.element == nullptr)
    throw missing(from, "diagram", "has several friction laws or elements: a describing function is of one");
  return *subject.element;
}

}  // namespace limcycle
