#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace limcycle {

/// What a result must say about the program, the settings and the input that made it.
struct Provenance {
  std::string version, commit, compiler, build_type;  ///< of the program
  std::string isa = "x86-64";                         ///< instruction set used; "x86-64" is the portable one
  std::uint64_t seed = 0;
  int threads = 1;

  bool time_is_over = false;  ///< the command reached its time limit: what was interrupted was cut short by that

  std::string title, file, sha256;     ///< of the case; empty: the command has no case
  std::vector<std::string> overrides;  ///< "PATH=VALUE" as given by --set, in order
};

}  // namespace limcycle
