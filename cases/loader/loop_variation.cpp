#include "limcycle/cases/loader/loop_variation.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "limcycle/cases/loader/case_numbers.hpp"
#include "limcycle/cases/loader/owned_parts.hpp"
#include "limcycle/cases/loader/sections/sections.hpp"
#include "limcycle/cases/loader/text/value.hpp"

namespace limcycle {
namespace {

using case_file::owned_parts;
using case_file::OwnedPart;
using case_file::Value;

constexpr Range no_number{infinite, -infinite};

/// True if every part obeys its own rules.
bool parts_are_valid(const LoopParts& parts) {
  return std::ranges::all_of(owned_parts(parts), [&](const OwnedPart& part) { return part.valid(parts); });
}

}  // namespace

LoopVariation::LoopVariation(const Case& from, const std::string& flag, std::span<const std::string> paths)
    : parts_(need_loop(from)) {
  case_file::Document document = case_file::parse(from.text, from.file);
  for (const auto& override : from.overrides) case_file::apply_override(document, override);
  const auto written = [&](const std::string& path) {
    return document.root.at(path) != nullptr || std::ranges::find(paths, path) != paths.end();
  };
  numbers_.resize(paths.size());
  const auto found = [&](const std::string& path, const Range& range,
                         const std::function<void(LoopParts&, double)>& set) {
    for (std::size_t i = 0; i < paths.size(); ++i)
      if (paths[i] == path) numbers_[i] = {set, range};
  };
  for (const OwnedPart& part : owned_parts(parts_)) {
    const std::string& section = part.section;
    const bool there = document.root.at(section) != nullptr;  // a loop without a controller has none to change
    const auto& rows = part.rows(parts_);
    const auto values = part.values(parts_);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (!std::holds_alternative<double>(values[i]) || is_elsewhere(part, rows[i].key)) continue;
      found(section + "." + std::string(rows[i].key), there ? rows[i].range : no_number,
            [part, i](LoopParts& p, double value) {
              auto changed = part.values(p);
              changed[i] = value;
              part.set(p, changed);
            });
    }
    std::vector<std::string_view> kept;  // keys with a value of their own
    bool all = true;
    for (const auto& row : rows) {
      const bool own = row.default_from.empty() || written(section + "." + std::string(row.key));
      if (own) kept.push_back(row.key);
      all = all && own;
    }
    if (all) continue;
    not_written_.emplace_back([part, kept](LoopParts& p) {
      auto changed = part.values(p);
      follow_defaults(part.rows(p), changed,
                      [&](std::string_view key) { return std::ranges::find(kept, key) != kept.end(); });
      part.set(p, changed);
    });
  }
  const std::string reference = parts_.diagram ? "diagram.reference" : "loop.reference";
  if (parts_.reference_rate != 0.0)
    found(reference + ".rate", any_number, [](LoopParts& p, double value) { p.reference_rate = value; });
  else
    found(reference, any_number, [](LoopParts& p, double value) { p.reference = value; });
  if (!parts_.diagram) found("loop.load", any_number, [](LoopParts& p, double value) { p.load = value; });
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
