#pragma once
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace limcycle::case_file {

/// An error in a formula.
class FormulaError : public std::runtime_error {
 public:
  FormulaError(const std::string& rule, std::string name) : std::runtime_error(rule), token(std::move(name)) {}
  std::string token;  ///< the unknown name; empty for any other error
};

/// Names a formula may use, with their values.
using Names = std::vector<std::pair<std::string, double>>;

/// Value of a formula over these names and pi, by muParser: + - * / ^, comparisons, c ? a : b, && ||, and sqrt, cbrt,
/// exp, ln, log2, log10, sin, cos, tan, asin, acos, atan, atan2, sinh, cosh, tanh, asinh, acosh, atanh, abs, sign,
/// rint, min, max, sum, avg. Throws FormulaError with the parser's message and the position (from 1). The value may be
/// NaN or infinite.
double value_of_formula(const std::string& formula, const Names& names);

}  // namespace limcycle::case_file
