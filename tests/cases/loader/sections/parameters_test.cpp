#include <fmt/format.h>
#include <catch2/catch.hpp>
#include <cmath>
#include <type_traits>

#include "limcycle/models/laws.hpp"
#include "limcycle/tests/cases/message.hpp"

// Every parameter of every law, element, plant and controller can be read, has its default, and obeys its range.

using namespace limcycle;
using limcycle::test::message;

namespace {

template <class Owner, class Variant>
constexpr bool is_among = false;
template <class Owner, class... Kinds>
constexpr bool is_among<Owner, std::variant<Kinds...>> = (std::is_same_v<Owner, Kinds> || ...);

template <class Owner>
constexpr bool is_plant = is_among<Owner, Plant>;
template <class Owner>
constexpr bool is_controller = is_among<Owner, Controller>;
template <class Owner>
constexpr bool is_law = requires {
  Owner::features;
};
template <class Owner>
constexpr bool is_on_error = std::is_same_v<Owner, Quantizer<double>>;

template <class Owner>
constexpr const char* section_of() {
  if (is_plant<Owner>) return "plant";
  if (is_controller<Owner>) return "controller";
  if (is_law<Owner>) return "friction";
  return is_on_error<Owner> ? "error" : "element";
}

/// The section of the owner first, so that its body begins in line 3, then the rest of a valid case.
template <class Owner>
std::string case_text(const std::string& body) {
  const std::string relay = "[loop.element]\nkind = \"relay\"\nlevel = 1\n",
                    mass = "[loop.plant]\nkind = \"mass\"\nmass = 1\n";
  const std::string law = "[loop.friction]\nkind = \"coulomb\"\nFc = 1\n", section = section_of<Owner>();
  return "[loop." + section + "]\nkind = \"" + std::string(Owner::kind) + "\"\n" + body +
         (is_plant<Owner>        ? relay
          : is_controller<Owner> ? mass + relay + law
          : is_on_error<Owner>   ? mass + relay
                                 : "");
}

template <class Owner>
Owner read(const std::string& body) {
  const Case from = read_case(case_text<Owner>(body), "a.toml");
  if constexpr (is_plant<Owner>) {
    return std::get<Owner>(from.loop->plant);
  } else if constexpr (is_controller<Owner>) {
    return std::get<Owner>(from.loop->controller);
  } else if constexpr (is_on_error<Owner>) {
    return law_of<Owner>(*from.loop->error);
  } else {
    return law_of<Owner>(*from.element);
  }
}

/// Valid values for lists and matrices, by key.
std::string structured(std::string_view key) {
  const std::map<std::string_view, std::string> values = {{"numerator", "[1]"},
                                                          {"denominator", "[1, 2, 3]"},
                                                          {"zeros", "[]"},
                                                          {"poles", "[-1, -2]"},
                                                          {"velocity", "[0, 1]"},
                                                          {"velocities", "[1]"},
                                                          {"forces", "[1]"},
                                                          {"velocities_minus", "[1]"},
                                                          {"forces_minus", "[1]"},
                                                          {"coefficients", "[2, 2, 2, 2]"},
                                                          {"inputs", "[1, 2]"},
                                                          {"outputs", "[1, 2]"},
                                                          {"k", "[1]"},
                                                          {"W", "[2]"},
                                                          {"alpha", "[1]"},
                                                          {"K", "[1]"},
                                                          {"sigma", "[1]"},
                                                          {"lambda", "[1]"},
                                                          {"A", "[[0, 1], [-1, -1]]"},
                                                          {"B", "[[0], [1]]"},
                                                          {"C", "[[1, 0]]"}};
  return values.at(key);
}

template <class Owner>
bool is_number(const Parameter<Owner, double>& parameter) {
  return std::holds_alternative<double Owner::*>(parameter.member);
}

/// The required parameters except `except`, all numbers 1.
template <class Owner>
std::string required(std::string_view except = {}) {
  std::string body;
  for (const auto& parameter : Owner::parameters())
    if (parameter.required && parameter.key != except)
      body += std::string(parameter.key) + " = " + (is_number(parameter) ? "1.0" : structured(parameter.key)) + "\n";
  return body;
}

template <class Owner>
std::string with(const Parameter<Owner, double>& parameter, const std::string& value) {
  return std::string(parameter.key) + " = " + value + "\n" + required<Owner>(parameter.key);
}

template <class Owner>
double value_of(const Owner& owner, const Parameter<Owner, double>& parameter) {
  return owner.*std::get<double Owner::*>(parameter.member);
}

/// Message for a value of the parameter, which is in line 3.
template <class Owner>
std::string said(const Parameter<Owner, double>& parameter, const std::string& value) {
  const std::string text = message(case_text<Owner>(with(parameter, value)));
  const std::string head =
      "a.toml:3: loop." + std::string(section_of<Owner>()) + "." + std::string(parameter.key) + " = ";
  CHECK(text.starts_with(head));
  const auto rule = text.find(": ", std::min(head.size(), text.size()));
  return rule == std::string::npos ? text : text.substr(rule + 2);
}

template <class Owner>
void check_number(const Parameter<Owner, double>& parameter) {
  // Levels of sliding are below those of break-away, which are 1 here; the limit of the relay's hysteresis is its dead
  // zone.
  const double value = parameter.key.starts_with("Fc") || parameter.range.high == 1.0 ? 0.75 : 1.25;
  const Owner owner = read<Owner>(with(parameter, value == 0.75 ? "0.75" : "1.25"));
  CHECK(value_of(owner, parameter) == value);
  if (parameter.range.high == 1.0) CHECK(said(parameter, "1.25").ends_with("1"));
  CHECK(said(parameter, "\"abc\"") == "must be a number, found a string");
  CHECK(said(parameter, "[1.0]") == "must be a number, found a list");
  CHECK(said(parameter, "nan") == "must be a finite number");
  CHECK(said(parameter, "-inf") == "must be a finite number");
  CHECK(said(parameter, "1979-05-27") == "must be a number, found a date or time");
  const std::string unit = parameter.unit == "1" ? "" : " " + std::string(parameter.unit);
  std::string most;
  if (std::isfinite(parameter.range.high))
    most = (parameter.range.high_open ? " and < " : " and <= ") + fmt::format("{:g}", parameter.range.high);
  if (parameter.range.low == 1.0) {
    CHECK(said(parameter, "0.999").starts_with("must be >= 1"));
  } else if (std::isfinite(parameter.range.low)) {
    REQUIRE(parameter.range.low == 0.0);
    CHECK(said(parameter, "-1e-9") == (parameter.range.low_open ? "must be > 0" : "must be >= 0") + most + unit);
    if (parameter.range.low_open) CHECK(said(parameter, "0") == "must be > 0" + most + unit);
    if (!parameter.range.low_open) CHECK(value_of(read<Owner>(with(parameter, "0")), parameter) == 0.0);
  } else {
    CHECK(value_of(read<Owner>(with(parameter, "-0.25")), parameter) == -0.25);
  }
}

template <class Owner>
void check_default(const Parameter<Owner, double>& parameter) {
  const Owner owner = read<Owner>(required<Owner>());
  const double value = value_of(owner, parameter);
  if (parameter.default_from.empty()) {
    CHECK(value == value_of(Owner{}, parameter));
  } else {
    CHECK(value == 1.0);  // the value of the key that gives the default, directly or through another one
  }
}

template <class Owner>
void check_choice(const Parameter<Owner, double>& parameter) {
  const auto member = std::get<Choice Owner::*>(parameter.member);
  for (std::size_t i = 0; i < parameter.choices.size(); ++i)
    CHECK((read<Owner>(with(parameter, '"' + std::string(parameter.choices[i]) + '"')).*member).index ==
          static_cast<int>(i));
  CHECK(said(parameter, "\"nonsense\"").starts_with("must be one of \""));
  CHECK(said(parameter, "1") == "must be a string, found a number");
  CHECK(read<Owner>(required<Owner>()).*member == Owner{}.*member);
}

/// Parameters that a loop rejects although they exist: tested with that rule.
constexpr std::string_view elsewhere[] = {"clearance",          "elements",       "anti_windup",   "sample_time",
                                          "computation_delay",  "input_step",     "output_step",   "velocity_window",
                                          "position_every",     "integral_limit", "integral_band", "integral_reset",
                                          "reset_interval",     "reset_speed",    "impulse_width", "impulse_pause",
                                          "impulse_band",       "impulse_speed",  "impulse",       "integral_dead_zone",
                                          "integral_hysteresis"};

template <class Owner>
void check_owner() {
  INFO(Owner::kind);
  for (const auto& parameter : Owner::parameters()) {
    INFO(parameter.key);
    if (std::ranges::find(elsewhere, parameter.key) != std::end(elsewhere)) continue;
    if (is_number(parameter)) {
      check_number(parameter);
      if (!parameter.required) check_default(parameter);
    } else if (std::holds_alternative<Choice Owner::*>(parameter.member)) {
      check_choice(parameter);
    } else {
      CHECK(said(parameter, "3").starts_with("must be a list"));
    }
    if (parameter.required)
      CHECK(message(case_text<Owner>(required<Owner>(parameter.key)))
                .find("." + std::string(parameter.key) + ": is required: ") != std::string::npos);
  }
  const std::string misspelt = message(case_text<Owner>("zzz = 1\n" + required<Owner>()));
  CHECK(misspelt.find(".zzz: unknown key; known: kind, ") != std::string::npos);
}

template <class... Owners>
void check_all(std::type_identity<std::variant<Owners...>>) {
  const auto check = []<class Owner>(std::type_identity<Owner>) {
    if constexpr (!std::is_same_v<Owner, MeasuredPlant>) check_owner<Owner>();  // needs data: see frf_section_test.cpp
  };
  (check(std::type_identity<Owners>{}), ...);
}

template <class Kinds>
void check_elements() {
  Kinds::for_each([]<template <class> class Kind>() { check_owner<Kind<double>>(); });
}

}  // namespace

TEST_CASE("every parameter of every friction law") { check_elements<FrictionLaws>(); }
TEST_CASE("every parameter of every element") { check_elements<ForwardElements>(); }
TEST_CASE("every parameter of the quantizer") { check_owner<Quantizer<double>>(); }
TEST_CASE("every parameter of every plant") { check_all(std::type_identity<Plant>{}); }
TEST_CASE("every parameter of every controller") { check_all(std::type_identity<Controller>{}); }

TEST_CASE("a default that comes from a default that is written") {
  const auto law = read<Coulomb<double>>("Fc = 2.0\n");
  CHECK(law.Fs == 2.0);
  CHECK(law.Fc_minus == 2.0);
  CHECK(law.Fs_minus == 2.0);
  const auto lugre = read<LuGre<double>>("Fc = 2.0\nFs = 3.0\nvs = 1\nsigma0 = 1\nFs_minus = 4.0\n");
  CHECK(lugre.Fc_minus == 2.0);
  CHECK(lugre.Fs_minus == 4.0);
}

TEST_CASE("integers are numbers as long as they are exact") {
  CHECK(read<Coulomb<double>>("Fc = 9007199254740992\n").Fc == 9007199254740992.0);
  CHECK(message(case_text<Coulomb<double>>("Fc = 9007199254740993\n")) ==
        "a.toml:3: loop.friction.Fc = 9007199254740993: is too large for an exact integer; write it with a decimal "
        "point or an "
        "exponent");
  CHECK(read<Coulomb<double>>("Fc = 0x10\n").Fc == 16.0);
}
