#pragma once
#include <algorithm>
#include <span>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include "limcycle/analysis/study/identify/record/friction_response.hpp"
#include "limcycle/models/dual.hpp"
#include "limcycle/models/friction/bristle/dahl.hpp"
#include "limcycle/models/friction/bristle/elasto_plastic.hpp"
#include "limcycle/models/friction/bristle/lugre.hpp"
#include "limcycle/models/friction/dry/coulomb.hpp"
#include "limcycle/models/friction/dry/stribeck.hpp"
#include "limcycle/models/friction/sliders/gms.hpp"
#include "limcycle/models/laws.hpp"

namespace limcycle {

/// Kinds of laws that can be identified.
using IdentifiedLaws = KindList<Coulomb, Stribeck, Dahl, LuGre, ElastoPlastic, Gms>;

/// The law on dual numbers D, with `numbers` as its variables. Rows of the table that follow another one by default
/// follow it, unless they are among `own_rows` or have a value of their own.
template <template <class> class Law, class D>
Law<D> seeded(const Law<double>& law, std::span<const LawNumber> numbers, const std::vector<std::size_t>& own_rows) {
  auto result = recast<Law, D>(law);
  const auto table = Law<D>::parameters();
  using Number = D Law<D>::*;
  using List = std::vector<D> Law<D>::*;
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    const auto& member = table.at(numbers[k].row).member;
    D* number = nullptr;
    if (const auto* one = std::get_if<Number>(&member)) number = &(result.*(*one));
    if (const auto* list = std::get_if<List>(&member)) number = &(result.*(*list)).at(numbers[k].entry);
    if (number == nullptr) throw std::invalid_argument(std::string(table[numbers[k].row].key) + " is no number");
    number->d[k] = 1.0;
  }
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (table[i].default_from.empty() || std::ranges::find(own_rows, i) != own_rows.end()) continue;
    const auto from = std::ranges::find(table, table[i].default_from, &ParameterRow::key);
    if (const auto* to = std::get_if<Number>(&table[i].member), *of = std::get_if<Number>(&from->member); to && of)
      if ((result.*(*to)).value == (result.*(*of)).value) result.*(*to) = result.*(*of);
  }
  return result;
}

}  // namespace limcycle
