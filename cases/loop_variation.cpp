#include "limcycle/cases/loop_variation.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "limcycle/cases/case_numbers.hpp"
#include "limcycle/cases/sections.hpp"
#include "limcycle/cases/value.hpp"

namespace limcycle {
namespace {

using case_file::Value;

constexpr Range no_number{infinite, -infinite};

/// Calls visitor(path, part) for every part of a loop that has parameters; part(parts) is that variant in any
/// LoopParts.
template <class Visitor>
void for_each_part(const LoopParts& parts, const Visitor& visitor) {
  visitor(
      "loop.plant", [](auto& p) -> auto& { return p.plant; });
  visitor(
      "loop.controller", [](auto& p) -> auto& { return p.controller; });
  if (parts.friction)
    visitor(
        "loop.friction", [](auto& p) -> auto& { return *p.friction; });
  if (parts.element)
    visitor(
        "loop.element", [](auto& p) -> auto& { return *p.element; });
  if (parts.error)
    visitor(
        "loop.error", [](auto& p) -> auto& { return *p.error; });
}

/// The value at a path of dots, or null.
const Value* value_at(const Value& root, std::string_view path) {
  const Value* at = &root;
  while (at != nullptr && !path.empty()) {
    const std::size_t dot = std::min(path.find('.'), path.size());
    at = at->find(path.substr(0, dot));
    path.remove_prefix(std::min(dot + 1, path.size()));
  }
  return at;
}

/// The member of a parameter that is one number.
template <class Owner>
auto number_member(const Parameter<Owner, double>& parameter) {
  const auto* member = std::get_if<double Owner::*>(&parameter.member);
  return member != nullptr ? *member : nullptr;
}

/// Whether every part keeps its own rules.
bool parts_are_valid(const LoopParts& parts) {
  bool valid = true;
  for_each_part(parts, [&](const char*, auto part) {
    valid = valid && !std::visit([](const auto& owner) { return owner.validate(); }, part(parts));
  });
  return valid;
}

}  // namespace

LoopVariation::LoopVariation(const Case& from, const std::string& flag, std::span<const std::string> paths)
    : parts_(need_loop(from)) {
  case_file::Document document = case_file::parse(from.text, from.file);
  for (const auto& override : from.overrides) case_file::apply_override(document, override);
  const auto written = [&](const std::string& path) {
    return value_at(document.root, path) != nullptr || std::ranges::find(paths, path) != paths.end();
  };
  numbers_.resize(paths.size());
  const auto found = [&](const std::string& path, const Range& range,
                         const std::function<void(LoopParts&, double)>& set) {
    for (std::size_t i = 0; i < paths.size(); ++i)
      if (paths[i] == path) numbers_[i] = {set, range};
  };
  for_each_part(parts_, [&](const std::string& section, auto part) {
    const bool there = value_at(document.root, section) != nullptr;  // a loop without a controller has none to change
    std::visit(
        [&]<class Owner>(const Owner&) {
          const auto table = Owner::parameters();
          for (const auto& parameter : table) {
            const auto member = number_member(parameter);
            if (member == nullptr) continue;
            const std::string path = section + "." + std::string(parameter.key);
            found(path, there ? parameter.range : no_number,
                  [part, member](LoopParts& p, double value) { std::get<Owner>(part(p)).*member = value; });
            if (parameter.default_from.empty() || written(path)) continue;
            const auto source =
                number_member(*std::ranges::find(table, parameter.default_from, &Parameter<Owner, double>::key));
            if (source == nullptr) continue;
            not_written_.emplace_back([part, member, source](LoopParts& p) {
              auto& owner = std::get<Owner>(part(p));
              owner.*member = owner.*source;
            });
          }
        },
        part(parts_));
  });
  if (parts_.reference_rate != 0.0)
    found("loop.reference.rate", any_number, [](LoopParts& p, double value) { p.reference_rate = value; });
  else
    found("loop.reference", any_number, [](LoopParts& p, double value) { p.reference = value; });
  found("loop.load", any_number, [](LoopParts& p, double value) { p.load = value; });
  for (std::size_t i = 0; i < paths.size(); ++i)
    if (!numbers_[i].set) static_cast<void>(number_at(from, flag, paths[i]));  // throws
}

std::optional<LoopParts> LoopVariation::changed(std::span<const double> values) const {
  if (values.size() != numbers_.size()) throw std::invalid_argument("as many values as paths are needed");
  LoopParts parts = parts_;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i]) || !numbers_[i].range.contains(values[i])) return std::nullopt;
    numbers_[i].set(parts, values[i]);
  }
  for (const auto& follow : not_written_) follow(parts);
  if (!parts_are_valid(parts)) return std::nullopt;
  return parts;
}

std::optional<LoopParts> LoopVariation::parts(std::span<const double> values) const {
  auto parts = changed(values);
  if (!parts || !case_file::finite_loop(*parts)) return std::nullopt;
  return parts;
}

std::optional<Loop> LoopVariation::loop(std::span<const double> values) const {
  const auto parts = changed(values);
  return parts ? case_file::finite_loop(*parts) : std::nullopt;
}

}  // namespace limcycle
