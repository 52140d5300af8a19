#pragma once
#include <complex>
#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "limcycle/cases/loader/case.hpp"
#include "limcycle/questions/asking/asking.hpp"

namespace limcycle::python {

/// Numbers for NumPy, the last index fastest.
struct Array {
  std::vector<std::size_t> shape;
  std::variant<std::vector<double>, std::vector<std::complex<double>>> values;
};

/// The result of a question, from which each document is made when it is asked for.
struct Answer {
  std::function<std::string()> json, csv, text;
  std::function<std::string()> latex;                    ///< the tables of the text
  std::function<std::string()> picture;                  ///< SVG; empty: the question has none
  std::function<std::string()> page;                     ///< HTML; empty likewise
  std::function<std::map<std::string, Array>()> arrays;  ///< beside the document; empty: none
  std::vector<std::string> columns;                      ///< of the array "rows", if there is one
  /// The case that follows from the result: with the remedy of this name, with the numbers found, with the fitted law.
  /// Empty: none does.
  std::function<Case(const std::string&)> applied;
};

/// A question to a case, and how it is worked on.
struct Question {
  std::shared_ptr<const Case> from;
  Asking asking;
  double time_limit = 0.0;  ///< s; 0: none
  std::function<bool()> time_is_over;
};

}  // namespace limcycle::python
