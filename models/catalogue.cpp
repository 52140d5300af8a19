#include "limcycle/models/catalogue.hpp"

#include <algorithm>

#include "limcycle/models/laws.hpp"

namespace limcycle {
namespace {

template <class Kinds>
std::vector<Element> made() {
  std::vector<Element> list;
  Kinds::for_each([&]<template <class> class Kind>() { list.emplace_back(Kind<double>{}); });
  return list;
}

}  // namespace

const Catalogue& catalogue_of_elements() {
  static const Catalogue all = [] {
    Catalogue found{made<FrictionLaws>(), made<ForwardElements>(), made<FrictionLaws>(), made<ErrorElements>()};
    for (const auto& element : found.forward_elements) found.series_elements.push_back(element);
    return found;
  }();
  return all;
}

const Element* find_kind(const std::vector<Element>& list, std::string_view kind) {
  const auto found = std::ranges::find_if(list, [kind](const Element& one) { return one.kind() == kind; });
  return found == list.end() ? nullptr : &*found;
}

std::vector<std::string> kinds_of(const std::vector<Element>& list) {
  std::vector<std::string> kinds;
  kinds.reserve(list.size());
  for (const auto& element : list) kinds.emplace_back(element.kind());
  return kinds;
}

}  // namespace limcycle
