#include "limcycle/cases/loader/text/formula.hpp"

#include <fmt/format.h>
#include <muParser.h>

#include <algorithm>
#include <numbers>

namespace limcycle::case_file {
namespace {

[[noreturn]] void refuse(const mu::ParserError& error) {
  std::string words = error.GetMsg();
  // "... at position 3." counts positions from 0, which few readers do.
  if (const auto at = words.find(" at position"); at != std::string::npos) words.resize(at);
  if (const auto at = words.find(" found at position"); at != std::string::npos) words.resize(at);
  while (!words.empty() && (words.back() == '.' || words.back() == ' ')) words.pop_back();
  std::ranges::replace(words, '\n', ' ');
  std::string token = error.GetToken();
  while (!token.empty() && token.back() == ' ') token.pop_back();
  const int position = error.GetPos() + 1;
  if (error.GetCode() == mu::ecUNASSIGNABLE_TOKEN)
    throw FormulaError(fmt::format("unknown name '{}' in the formula, at position {}", token, position), token);
  throw FormulaError("is not a formula: " + words + (position > 0 ? fmt::format(" (at position {})", position) : ""),
                     "");
}

}  // namespace

double value_of_formula(const std::string& formula, const Names& names) {
  mu::Parser parser;
  parser.ClearConst();  // its own pi has 13 digits
  parser.DefineConst("pi", std::numbers::pi);
  for (const auto& [name, value] : names) {
    try {
      parser.DefineConst(name, value);
    } catch (const mu::ParserError&) {
      continue;  // a reserved name of the parser; the longer name, with its section, is available
    }
  }
  try {
    parser.SetExpr(formula);
    int results = 0;
    const double* values = parser.Eval(results);
    if (results != 1) throw FormulaError("is not a formula: it has several values", "");
    return values[0];
  } catch (const mu::ParserError& error) {
    refuse(error);
  }
}

}  // namespace limcycle::case_file
