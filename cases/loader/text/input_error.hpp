#pragma once
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include "limcycle/cases/loader/text/printable.hpp"

namespace limcycle {

/// An error in an input, and its place.
struct InputFault {
  std::string file;        ///< case file; empty: the error is in the command line
  int line = 0;            ///< counted from 1; 0: unknown or not in a file
  std::string override;    ///< "PATH=VALUE" if the value came from --set; then file and line do not count
  std::string key;         ///< path such as "loop.friction.Fs", or an argument such as "--parameter"; may be empty
  std::string value;       ///< as written, shortened; empty: there is none
  std::string rule;        ///< required condition
  std::string suggestion;  ///< nearest valid name, or empty
};

/// Bad input: exit code 2. what() is one line such as
///   `FILE:12: loop.friction.Fs = 0.5: must be at least Fc = 1 N`
///   `FILE:14: loop.friction.sigm0: unknown key; did you mean sigma0?`
///   `--set loop.plant.mass=-1: must be > 0 kg`
///   `--parameter loop.plant.mas: is not a parameter of this loop that is one number; did you mean loop.plant.mass?`
class InputError : public std::runtime_error {
 public:
  explicit InputError(InputFault fault);
  const InputFault& fault() const { return fault_; }

 private:
  InputFault fault_;
};

/// The candidate that is nearest to `name` by the Damerau-Levenshtein distance, ignoring case and the difference of '-'
/// and '_'; empty if none is near (more than a third of the letters differ). Cost: length squared per candidate.
std::string nearest_name(std::string_view name, std::span<const std::string> candidates);

/// "did you mean X?" or, if nothing is near, "known: a, b, c".
std::string suggest(std::string_view name, std::span<const std::string> candidates);

}  // namespace limcycle
