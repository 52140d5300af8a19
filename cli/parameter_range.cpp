#include "limcycle/cli/parameter_range.hpp"

#include <charconv>
#include <cmath>

#include "limcycle/cases/input_error.hpp"

namespace limcycle {
namespace {

bool read(std::string_view text, double& value) {
  if (text.starts_with('+')) text.remove_prefix(1);
  const auto end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, value);
  return result.ec == std::errc() && result.ptr == end && std::isfinite(value);
}

}  // namespace

ParameterRange parameter_range(const std::string& flag, const std::string& text) {
  const auto refuse = [&](const std::string& rule) {
    return InputError({.file = {},
                       .line = 0,
                       .override = {},
                       .key = flag + " " + (text.empty() ? "''" : text),
                       .value = {},
                       .rule = rule,
                       .suggestion = {}});
  };
  const auto equals = text.find('='), colon = text.find(':', equals == std::string::npos ? 0 : equals);
  if (equals == std::string::npos || colon == std::string::npos || equals == 0)
    throw refuse("must be PATH=FROM:TO, such as loop.controller.kd=1:50");
  ParameterRange range;
  range.path = text.substr(0, equals);
  const std::string_view rest(text);
  if (!read(rest.substr(equals + 1, colon - equals - 1), range.from) || !read(rest.substr(colon + 1), range.to))
    throw refuse("FROM and TO must be finite numbers");
  if (range.from == range.to) throw refuse("FROM and TO must differ");
  return range;
}

}  // namespace limcycle
