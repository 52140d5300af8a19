#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "limcycle/cases/loader/sections/sections.hpp"
#include "limcycle/cases/loader/text/formula.hpp"

namespace limcycle {
namespace case_file {
namespace {

constexpr std::size_t most_claims = 1000;
constexpr std::array at_paths{"at.amplitude", "at.frequency", "at.bias"};

double& coordinate(DfPoint& at, std::size_t i) { return i == 0 ? at.amplitude : i == 1 ? at.frequency : at.bias; }

/// Names for a formula: every number of the case by its last key, unless two sections have that key, and by section and
/// key ("mass", "plant_mass"); A, w and bias for a describing function.
Names names_of(const std::vector<CaseNumber>& numbers, const std::optional<DfPoint>& at) {
  Names names;
  const auto last = [](const std::string& path) { return path.substr(path.rfind('.') + 1); };
  if (at) names = {{"A", at->amplitude}, {"w", at->frequency}, {"bias", at->bias}};
  const auto taken = [&](const std::string& key) {
    const bool of_at = at && std::ranges::any_of(std::array{"A", "w", "bias"}, [&](auto* name) { return key == name; });
    return of_at || std::ranges::count_if(numbers, [&](const auto& one) { return last(one.path) == key; }) > 1;
  };
  for (const auto& number : numbers) {
    const std::string key = last(number.path);
    if (!taken(key)) names.emplace_back(key, number.value);
    const std::string rest = number.path.substr(0, number.path.size() - key.size() - 1);
    if (const std::string section = last(rest); section != "loop")
      names.emplace_back(section + "_" + key, number.value);
  }
  return names;
}

DfPoint read_at(const Section& section) {
  section.allow({"amplitude", "frequency", "bias"});
  DfPoint at;
  at.amplitude = read_number(section.at("amplitude", "of the element's input"), positive);
  at.frequency = read_number(section.at("frequency", "rad/s"), positive, "rad/s");
  if (const auto bias = section.find("bias")) at.bias = read_number(*bias);
  return at;
}

const ClaimQuantity& read_quantity(const Section& section, const Case& from) {
  const auto& all = claim_quantities();
  std::vector<std::string_view> names;
  names.reserve(all.size());
  for (const auto& one : all) names.push_back(one.name);
  const Place place = section.at("quantity", "what the claim is about, such as \"period\"");
  const ClaimQuantity& quantity = all[read_choice(place, names)];
  if (quantity.of == QuantityOf::cycle && !from.loop)
    throw place.error("needs a loop, and the case holds a lone element: add [loop.plant]");
  if (quantity.of == QuantityOf::law && from.loop && !from.loop->friction)
    throw place.error("needs a friction law, and the loop has none");
  if (quantity.of == QuantityOf::describing_function && !section.find("at"))
    throw section.error("at", "is required with this quantity: {amplitude, frequency}");
  if (quantity.of != QuantityOf::describing_function && section.find("at"))
    throw section.error("at", "is allowed only with describing functions (gain.real, gain.imag, dissipation, mean)");
  return quantity;
}

void read_random(const Section& section, const std::vector<CaseNumber>& case_numbers, UserClaim& into) {
  std::vector<CaseNumber> numbers = case_numbers;
  if (into.at)
    for (std::size_t i = 0; i < at_paths.size(); ++i)
      numbers.push_back({at_paths[i], i == 1 ? "rad/s" : "1", "", coordinate(*into.at, i), false});
  if (const auto over = section.find("over")) into.over = read_spread_list(*over, numbers);
  if (const auto random = section.find("random")) {
    if (into.over.empty()) throw section.error("random", "needs over, the numbers to draw");
    into.random_points = read_integer(*random, 0, 100'000);
  }
}

void check_formula(const Section& section, const UserClaim& claim, const std::vector<CaseNumber>& numbers) {
  const Names names = names_of(numbers, claim.at);
  try {
    value_of_formula(claim.formula, names);
  } catch (const FormulaError& error) {
    std::vector<std::string> known{"pi"};
    for (const auto& [name, value] : names) known.push_back(name);
    throw section.at("formula", "").error(error.what(), error.token.empty() ? "" : suggest(error.token, known));
  }
}

/// Text of a formula; a number is a formula too.
std::string read_formula(const Place& place) {
  if (place.value.as<double>() != nullptr || place.value.as<std::int64_t>() != nullptr)
    return fmt::format("{}", read_number(place));
  return read_string(place);
}

UserClaim read_claim(const Section& section, const Case& from, const std::vector<CaseNumber>& numbers) {
  section.allow({"id", "statement", "source", "quantity", "comparison", "tolerance", "formula", "expected", "at",
                 "over", "random"});
  UserClaim claim;
  const Place id = section.at("id", "a name for the claim");
  claim.id = read_string(id);
  if (claim.id.empty() || claim.id.find_first_of(" \t\n") != std::string::npos)
    throw id.error("must be a word without spaces");
  if (const auto statement = section.find("statement")) claim.statement = read_string(*statement);
  if (const auto source = section.find("source")) claim.source = read_string(*source);
  claim.quantity = read_quantity(section, from).name;
  if (const auto comparison = section.find("comparison")) {
    constexpr std::string_view signs[] = {"=", "<", "<=", ">", ">="};
    constexpr Comparison kinds[] = {Comparison::equal, Comparison::less, Comparison::at_most, Comparison::greater,
                                    Comparison::at_least};
    claim.comparison = kinds[read_choice(*comparison, signs)];
  }
  if (const auto tolerance = section.find("tolerance")) {
    if (claim.comparison != Comparison::equal)
      throw section.error("tolerance", "is allowed only with comparison = \"=\"");
    claim.tolerance = read_number(*tolerance, {.low = 1e-12, .high = 10.0});
  }
  claim.formula = read_formula(section.at("formula", "with what it is compared, such as \"4*Fs/(pi*A)\""));
  if (const auto expected = section.find("expected")) {
    constexpr std::string_view names[] = {"holds", "fails"};
    claim.expected = read_choice(*expected, names) == 0 ? ClaimVerdict::holds : ClaimVerdict::fails;
  }
  if (const auto at = section.section("at")) claim.at = read_at(*at);
  read_random(section, numbers, claim);
  check_formula(section, claim, numbers);
  return claim;
}

}  // namespace

std::vector<UserClaim> read_claims(const Place& list, const Case& from) {
  const auto* items = list.value.as<Value::List>();
  if (items == nullptr) throw list.wrong_type("a list of tables [[claim]]");
  if (items->size() > most_claims) throw list.error(fmt::format("must have at most {} entries", most_claims));
  const auto numbers = numbers_of(from);
  std::vector<UserClaim> claims;
  for (std::size_t i = 0; i < items->size(); ++i) {
    const Place item = list.item(i);
    const Section section(item.document, item.value, item.path);
    claims.push_back(read_claim(section, from, numbers));
    if (std::ranges::count(claims, claims.back().id, &UserClaim::id) > 1)
      throw section.error("id", "appears twice in the case");
  }
  return claims;
}

}  // namespace case_file

namespace {

/// The case with other numbers at some paths, as a point of a claim.
std::optional<ClaimPoint> point_of(const Case& from, const UserClaim& claim, bool needs_loop,
                                   const std::vector<std::pair<std::string, double>>& values) {
  ClaimPoint point;
  point.at = claim.at.value_or(DfPoint{});
  std::vector<std::pair<std::string, double>> of_case;
  for (const auto& value : values) {
    const auto i =
        static_cast<std::size_t>(std::ranges::find(case_file::at_paths, value.first) - case_file::at_paths.begin());
    if (i < case_file::at_paths.size())
      case_file::coordinate(point.at, i) = value.second;
    else
      of_case.push_back(value);
  }
  if (claim.at && !(point.at.amplitude > 0.0 && point.at.frequency > 0.0)) return std::nullopt;
  const auto changed = of_case.empty() ? std::optional(from) : case_with(from, of_case);
  if (!changed) return std::nullopt;
  try {
    if (needs_loop)
      point.loop = build_loop(*changed->loop);
    else
      point.element = df_element(*changed);
  } catch (const std::invalid_argument&) {
    return std::nullopt;
  }
  const auto at = claim.at ? std::optional(point.at) : std::nullopt;
  point.claimed = case_file::value_of_formula(claim.formula, case_file::names_of(numbers_of(*changed), at));
  return point;
}

}  // namespace

std::vector<Claim> claims_of(const Case& from) {
  std::vector<Claim> list;
  for (const auto& claim : from.claims) {
    const auto& all = claim_quantities();
    const bool needs_loop =
        std::ranges::find(all, std::string_view(claim.quantity), &ClaimQuantity::name)->of == QuantityOf::cycle;
    list.push_back(user_claim(
        claim, from.predict,
        [from, claim, needs_loop](const auto& values) { return point_of(from, claim, needs_loop, values); },
        "case file " + from.file));
  }
  return list;
}

}  // namespace limcycle
