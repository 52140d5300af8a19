#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "limcycle/cases/loader/sections/sections.hpp"

namespace limcycle::case_file {
namespace {

/// Limit on the size of a table of describing functions, and on the rows of a simulation; and on one axis of a table.
constexpr std::size_t largest_table = 5'000'000;
constexpr std::size_t longest_axis = 1'000'000;

std::vector<double> spread(double from, double to, std::size_t points, bool logarithmic) {
  std::vector<double> values(points, from);
  const double log_from = logarithmic ? std::log(from) : 0.0, log_to = logarithmic ? std::log(to) : 0.0;
  for (std::size_t i = 1; i < points; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(points - 1);
    values[i] = logarithmic ? std::exp(std::lerp(log_from, log_to, share)) : std::lerp(from, to, share);
  }
  if (points > 1) values.back() = to;  // exactly
  return values;
}

std::vector<double> read_spread(const Section& section, const Range& range, std::string_view unit, bool logarithmic) {
  section.allow({"from", "to", "points", "spacing"});
  constexpr std::string_view spacings[] = {"log", "linear"};
  if (const auto spacing = section.find("spacing")) logarithmic = read_choice(*spacing, spacings) == 0;
  const double from = read_number(section.at("from", "first value"), range, unit);
  const double to = read_number(section.at("to", "last value"), range, unit);
  const int points = read_integer(section.at("points", "number of values"), 1, static_cast<int>(longest_axis));
  if (!(from < to)) throw section.error("to", fmt::format("must be greater than from = {}", with_unit(from, unit)));
  if (logarithmic && !(from > 0.0)) throw section.error("from", "must be > 0 with spacing = \"log\"");
  return spread(from, to, static_cast<std::size_t>(points), logarithmic);
}

/// A number, a list of numbers or {from, to, points, spacing}.
std::vector<double> read_axis(const Place& place, const Range& range, std::string_view unit, bool logarithmic) {
  if (place.value.as<Value::Table>() != nullptr)
    return read_spread(Section(place.document, place.value, place.path), range, unit, logarithmic);
  if (place.value.as<Value::List>() == nullptr) {
    if (place.value.as<double>() == nullptr && place.value.as<std::int64_t>() == nullptr)
      throw place.wrong_type("a list of numbers or {from, to, points, spacing}");
    return {read_number(place, range, unit)};
  }
  auto values = read_list(place, longest_axis, range, unit);
  if (values.empty()) throw place.error("must not be empty");
  return values;
}

std::pair<double, double> read_interval(const Place& place, std::string_view unit) {
  const std::string rule =
      fmt::format("must be two numbers [from, to] with 0 < from < to{}{}", unit.empty() ? "" : ", ", unit);
  const auto* list = place.value.as<Value::List>();
  if (list == nullptr) throw place.wrong_type("a list of two numbers [from, to]");
  if (list->size() != 2) throw place.error(rule);
  const double from = read_number(place.item(0)), to = read_number(place.item(1));
  if (!(from > 0.0 && from < to)) throw place.error(rule);
  return {from, to};
}

}  // namespace

SearchBox read_search(const Section& section) {
  section.allow({"amplitude", "frequency"});
  const auto [a, A] = read_interval(section.at("amplitude", "range [from, to] of the element's input"), "");
  const auto [w, W] = read_interval(section.at("frequency", "range [from, to], rad/s"), "rad/s");
  return {.amplitude_min = a, .amplitude_max = A, .frequency_min = w, .frequency_max = W};
}

DissipativitySection read_dissipativity(const Section& section) {
  section.allow({"speed", "top_speed"});
  DissipativitySection result;
  if (const auto speed = section.find("speed")) result.speed = read_number(*speed, positive, "m/s");
  if (const auto top = section.find("top_speed")) result.top_speed = read_number(*top, positive, "m/s");
  return result;
}

OutputUnit read_units(const Section& section) {
  section.allow({"y"});
  const Place y = section.at("y", R"(a unit such as "mm", or {symbol = "mm", per_si = 1000.0})");
  constexpr std::size_t longest = 12;
  const auto symbol_of = [&](const Place& place) {
    std::string symbol = read_string(place);
    const bool printable = std::ranges::none_of(symbol, [](char c) { return static_cast<unsigned char>(c) <= ' '; });
    if (symbol.empty() || symbol.size() > longest || !printable)
      throw place.error("must be 1 to " + std::to_string(longest) + " letters or signs without spaces");
    return symbol;
  };
  if (y.value.as<Value::Table>() != nullptr) {
    const Section table(y.document, y.value, y.path);
    table.allow({"symbol", "per_si"});
    return {symbol_of(table.at("symbol", "as it is shown")),
            read_number(table.at("per_si", "y in this unit over y in SI units"), positive)};
  }
  // A length or an angle in SI units; any other symbol names the unit that the case is written in.
  constexpr std::array<std::pair<std::string_view, double>, 5> known{
      {{"mm", 1e3}, {"um", 1e6}, {"nm", 1e9}, {"cm", 1e2}, {"deg", 180.0 / std::numbers::pi}}};
  OutputUnit unit{symbol_of(y), 1.0};
  for (const auto& [symbol, per_si] : known)
    if (unit.symbol == symbol) unit.per_si = per_si;
  return unit;
}

DfSection read_df(const Section& section) {
  section.allow({"amplitude", "frequency", "bias", "harmonics", "accuracy", "method"});
  DfSection df;
  df.amplitude = read_axis(section.at("amplitude", "list or {from, to, points, spacing}"), positive, "1", true);
  df.frequency =
      read_axis(section.at("frequency", "list or {from, to, points, spacing}, rad/s"), positive, "rad/s", true);
  if (const auto bias = section.find("bias")) df.bias = read_axis(*bias, any_number, "1", false);
  // Each list has at most 1e6 entries, so that the product cannot overflow.
  if (df.amplitude.size() * df.frequency.size() > largest_table || df.size() > largest_table)
    throw section.document().error_at(section.path(),
                                      fmt::format("must have at most {} points, found {} x {} x {}", largest_table,
                                                  df.amplitude.size(), df.frequency.size(), df.bias.size()));
  if (const auto harmonics = section.find("harmonics")) df.options.harmonics = read_integer(*harmonics, 1, 1000);
  if (const auto accuracy = section.find("accuracy"))
    df.options.accuracy = read_number(*accuracy, {.low = 1e-13, .high = 1e-1});
  constexpr std::string_view methods[] = {"auto", "fft", "quadrature"};
  constexpr DfMethod choices[] = {DfMethod::automatic, DfMethod::fft, DfMethod::quadrature};
  if (const auto method = section.find("method")) df.options.method = choices[read_choice(*method, methods)];
  return df;
}

void read_predict(const Section& section, Case& into) {
  section.allow({"methods", "starts", "accuracy"});
  if (const auto starts = section.find("starts")) into.predict.starts = read_integer(*starts, 1, 1000);
  if (const auto accuracy = section.find("accuracy"))
    into.predict.accuracy = read_number(*accuracy, {.low = 1e-13, .high = 1e-1});
  const auto methods = section.find("methods");
  if (!methods) return;
  const auto* list = methods->value.as<Value::List>();
  if (list == nullptr) throw methods->wrong_type("a list of names");
  if (list->empty()) throw methods->error("must not be empty");
  constexpr std::string_view known[] = {"describing-function", "composite-describing-function", "harmonic-balance"};
  Methods& chosen = into.predict.methods;
  chosen = {false, false, false};
  const std::array<bool*, 3> switches{&chosen.describing_function, &chosen.composite, &chosen.harmonic_balance};
  for (std::size_t i = 0; i < list->size(); ++i)
    *switches[static_cast<std::size_t>(read_choice(methods->item(i), known))] = true;
}

SimulateOptions read_simulate(const Section& section, const std::vector<std::string>& states) {
  section.allow({"duration", "initial", "force", "reference", "stepper", "rtol", "sample"});
  SimulateOptions options;
  options.duration = read_number(section.at("duration", "how long, s"), positive, "s");
  if (const auto initial = section.section("initial")) {
    initial->allow(states);
    for (const auto& state : states)
      if (const auto value = initial->find(state)) options.initial[state] = read_number(*value);
  }
  if (const auto force = section.find("force")) options.force = read_signal(*force);
  if (const auto reference = section.find("reference")) options.reference = read_signal(*reference);
  constexpr std::string_view steppers[] = {"auto", "exact", "rodas5p", "dopri5", "fehlberg78", "cash-karp54"};
  if (const auto stepper = section.find("stepper")) options.stepper = steppers[read_choice(*stepper, steppers)];
  if (const auto rtol = section.find("rtol")) options.rtol = read_number(*rtol, {.low = 1e-13, .high = 1e-1});
  if (const auto sample = section.find("sample")) {
    options.sample = read_number(*sample, positive, "s");
    if (options.duration / options.sample > static_cast<double>(largest_table))
      throw section.error("sample",
                          fmt::format("makes more than {} rows of duration = {} s", largest_table, options.duration));
  }
  return options;
}

}  // namespace limcycle::case_file
