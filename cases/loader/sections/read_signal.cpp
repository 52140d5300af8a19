#include <fmt/format.h>

#include "limcycle/cases/loader/sections/sections.hpp"

namespace limcycle::case_file {
namespace {

void read_table(const Section& section, Signal& signal) {
  constexpr std::size_t most = 1'000'000;
  signal.times = read_list(section.at("times", "list of times, s"), most);
  signal.values = read_list(section.at("values", "one value for each of times"), most);
  if (signal.times.empty()) throw section.error("times", "must not be empty");
  if (signal.values.size() != signal.times.size())
    throw section.error("values", fmt::format("must have as many entries as times ({}), found {}", signal.times.size(),
                                              signal.values.size()));
  for (std::size_t i = 1; i < signal.times.size(); ++i)
    if (!(signal.times[i] > signal.times[i - 1]))
      throw section.error("times", fmt::format("must increase, but entry {} is not above the one before", i));
}

}  // namespace

Signal read_signal(const Place& place) {
  Signal signal;
  if (place.value.as<Value::Table>() == nullptr) {
    if (place.value.as<double>() == nullptr && place.value.as<std::int64_t>() == nullptr)
      throw place.wrong_type("a number or {kind = ..., ...}");
    signal.value = read_number(place);
    return signal;
  }
  const Section section(place.document, place.value, place.path);
  constexpr std::string_view kinds[] = {"constant", "step", "ramp", "sine", "zigzag", "table"};
  constexpr Signal::Kind of[] = {Signal::Kind::constant, Signal::Kind::step,   Signal::Kind::ramp,
                                 Signal::Kind::sine,     Signal::Kind::zigzag, Signal::Kind::table};
  signal.kind = of[read_choice(section.at("kind", "step, ramp, sine, zigzag or table"), kinds)];
  const auto start = [&] {
    if (const auto from = section.find("start")) signal.start = read_number(*from, not_negative, "s");
  };
  switch (signal.kind) {
    case Signal::Kind::constant:
      section.allow({"kind", "value"});
      signal.value = read_number(section.at("value", "the constant"));
      break;
    case Signal::Kind::step:
      section.allow({"kind", "value", "start"});
      signal.value = read_number(section.at("value", "height of the step"));
      start();
      break;
    case Signal::Kind::ramp:
      section.allow({"kind", "rate", "start"});
      signal.rate = read_number(section.at("rate", "slope, 1/s"));
      start();
      break;
    case Signal::Kind::sine:
      section.allow({"kind", "amplitude", "frequency", "start"});
      signal.value = read_number(section.at("amplitude", "height of the sine"));
      signal.frequency = read_number(section.at("frequency", "rad/s"), positive, "rad/s");
      start();
      break;
    case Signal::Kind::zigzag:
      section.allow({"kind", "amplitude", "rate", "start"});
      signal.value = read_number(section.at("amplitude", "height of the peaks"), positive);
      signal.rate = read_number(section.at("rate", "slope of the flanks, 1/s"), positive, "1/s");
      start();
      break;
    case Signal::Kind::table:
      section.allow({"kind", "times", "values"});
      read_table(section, signal);
      break;
  }
  return signal;
}

}  // namespace limcycle::case_file
