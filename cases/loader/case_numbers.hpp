#pragma once
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "limcycle/cases/loader/case.hpp"

namespace limcycle {

/// A scalar parameter of a case's loop.
struct CaseNumber {
  std::string path;  ///< "loop.controller.kd"
  std::string unit;  ///< "1" if dimensionless
  std::string meaning;
  double value = 0.0;    ///< infinite if the parameter stands for something absent (a saturation)
  bool follows = false;  ///< not written: it takes the value of another one (Fs_minus, of Fs)
};

/// All of them: plant, controller, friction, elements, then reference and load; for a lone element its own.
std::vector<CaseNumber> numbers_of(const Case& from);

/// The number at a path. Throws InputError (of `argument`, such as "--parameter") if there is none.
CaseNumber number_at(const Case& from, const std::string& argument, const std::string& path);

/// The number with this path or, if only one has it, with this name at the end of its path ("kp", "controller.kp").
/// Throws InputError (of `argument`) if there is none, or several.
CaseNumber number_named(const Case& from, const std::string& argument, const std::string& name);

/// A value at a path as `--set` takes it, "loop.controller.kd=8.0".
std::string override_of(const std::string& path, double value);

/// The case with other values at some paths, read as `--set` would; empty if that is not a valid case.
std::optional<Case> case_with(const Case& from, std::span<const std::pair<std::string, double>> values);

}  // namespace limcycle
