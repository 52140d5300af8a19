#include "limcycle/cli/parameter_range.hpp"

#include <algorithm>
#include <cmath>

#include "limcycle/cli/command.hpp"
#include "limcycle/cli/option_values.hpp"

namespace limcycle {

ParameterRange parameter_range(const std::string& flag, const std::string& text) {
  const auto refuse = [&](const std::string& rule) { return refusal(flag + " " + (text.empty() ? "''" : text), rule); };
  const auto equals = text.find('='), colon = text.find(':', equals == std::string::npos ? 0 : equals);
  if (equals == std::string::npos || colon == std::string::npos || equals == 0)
    throw refuse("must be PATH=FROM:TO, such as loop.controller.kd=1:50");
  ParameterRange range;
  range.path = text.substr(0, equals);
  const std::string_view rest(text);
  const auto from = finite_number(rest.substr(equals + 1, colon - equals - 1)),
             to = finite_number(rest.substr(colon + 1));
  if (!from || !to) throw refuse("FROM and TO must be finite numbers");
  range.from = *from;
  range.to = *to;
  if (range.from == range.to) throw refuse("FROM and TO must differ");
  return range;
}

MapAxis map_axis(const std::string& flag, const std::string& text) {
  const auto refuse = [&](const std::string& rule) { return refusal(flag + " " + (text.empty() ? "''" : text), rule); };
  std::string rest = text;
  const bool logarithmic = rest.ends_with(":log");
  if (logarithmic) rest.resize(rest.size() - 4);
  const auto last = rest.rfind(':');
  const auto points = last == std::string::npos ? std::nullopt : finite_number(std::string_view(rest).substr(last + 1));
  if (std::ranges::count(rest, ':') != 2 || !points)
    throw refuse("must be PATH=FROM:TO:N or PATH=FROM:TO:N:log, such as loop.controller.kd=1:50:60");
  if (*points != std::floor(*points) || *points < 2.0 || *points > 10000.0)
    throw refuse("N must be a whole number, 2..10000");
  const ParameterRange range = parameter_range(flag, rest.substr(0, last));
  if (logarithmic && !(range.from * range.to > 0.0)) throw refuse("a logarithmic side needs ends of one sign, not 0");
  return {range.path, range.from, range.to, static_cast<int>(*points), logarithmic};
}

}  // namespace limcycle
