#include "limcycle/questions/dissipativity.hpp"

#include <fmt/format.h>

#include <array>
#include <stdexcept>

#include "limcycle/cases/loader/case_numbers.hpp"
#include "limcycle/questions/asking/argument_error.hpp"
#include "limcycle/reports/format/number.hpp"

namespace limcycle {
namespace {

std::string range_text(const DissipativityWishes& wishes) {
  return fmt::format("{}={}:{}", wishes.path, shortest(wishes.from), shortest(wishes.to));
}

/// The number of the element whose values are searched, checked against the element.
PassivityRange range_of(const Case& from, const DissipativityWishes& range) {
  const std::string path = !from.loop ? from.element_path : subject_of(*from.loop).path;
  const auto refuse = [&](const std::string& rule) { return argument_error(range.argument, range_text(range), rule); };
  if (!range.path.starts_with(path + ".")) throw refuse("must be a number of the element examined, " + path + ".KEY");
  if (!(range.from < range.to)) throw refuse("must begin below its end");
  const std::string key = range.path.substr(path.size() + 1);
  try {
    family_of(df_element(from), key);
  } catch (const std::invalid_argument& no_such_number) {
    throw refuse(no_such_number.what());
  }
  // As --set would: what follows the number by default follows it here.
  const auto with = [from, path = range.path](double value) -> std::optional<Element> {
    const auto changed = case_with(from, std::array{std::pair(path, value)});
    return changed ? std::optional(df_element(*changed)) : std::nullopt;
  };
  return {key, range.from, range.to, with};
}

}  // namespace

std::string flags_of(const DissipativityWishes& wishes) {
  std::string text;
  if (!wishes.path.empty()) text += " --parameter " + range_text(wishes);
  if (wishes.speed > 0.0) text += " --speed " + shortest(wishes.speed);
  if (wishes.top_speed > 0.0) text += " --top-speed " + shortest(wishes.top_speed);
  return text.empty() ? text : text.substr(1);
}

DissipativityReport ask_dissipativity(const Case& from, const DissipativityWishes& wishes, const Asking& asking) {
  DissipativityOptions options;
  options.speed = wishes.speed > 0.0 ? wishes.speed : from.dissipativity.speed;
  options.passivity.top_speed = wishes.top_speed > 0.0 ? wishes.top_speed : from.dissipativity.top_speed;
  options.passivity.seed = asking.seed;
  options.predict = from.predict;
  if (!wishes.path.empty()) options.range = range_of(from, wishes);
  options.passivity.stop = asking.stop;
  options.passivity.progress = asking.progress;
  if (!from.loop) return dissipativity(need_element(from), from.element_path, options);
  const Subject subject = subject_of(*from.loop);
  if (subject.element == nullptr || subject.path == "loop.error")
    throw InputError({.file = from.file,
                      .line = 0,
                      .override = {},
                      .key = from.loop->diagram ? "diagram" : "loop.friction",
                      .value = {},
                      .rule = from.loop->diagram ? "has several friction laws or elements: one is examined"
                                                 : "is required: the loop holds neither friction nor a forward element",
                      .suggestion = {}});
  return dissipativity(*from.loop, options);
}

}  // namespace limcycle
