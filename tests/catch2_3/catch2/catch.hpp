#pragma once
// The tests are written for Catch2 2 (Debian 12). With Catch2 3 (Debian 13, Ubuntu 24.04) this header replaces its own
// and offers the names that version 3 moved or renamed.
#include <catch2/catch_all.hpp>
#include <concepts>
#include <string>
#include <utility>

namespace Catch {
namespace Matchers {

/// In version 3 this name matches ranges, and ContainsSubstring matches texts. More constrained than the template of
/// version 3, so that a text always selects this one.
template <class Text>
requires std::convertible_to<Text, std::string> StringContainsMatcher Contains(Text&& text) {
  return ContainsSubstring(std::forward<Text>(text));
}

}  // namespace Matchers
using Matchers::Contains;
using Matchers::Predicate;
}  // namespace Catch

using namespace Catch::literals;
using Catch::Approx;
