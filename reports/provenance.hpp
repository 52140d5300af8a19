#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "limcycle/models/measured/curve_file.hpp"
#include "limcycle/models/measured/matrix_file.hpp"
#include "limcycle/models/measured/plants_of_loop.hpp"

namespace limcycle {

/// Program, settings and input of a result, as every document states them.
struct Provenance {
  std::string version, commit, compiler, build_type;  ///< of the program
  std::string isa = "x86-64";                         ///< instruction set used; "x86-64" is the portable one
  std::uint64_t seed = 0;
  int threads = 1;

  bool time_is_over = false;  ///< the command reached its time limit, which interrupted its work

  std::string title, file, sha256;          ///< of the case; empty: the command has no case
  std::vector<std::string> overrides;       ///< "PATH=VALUE" as given by --set, in order
  std::vector<std::string> flags{};         ///< words of the command line that change the result: "--only", "gain-kp"
  std::vector<MeasuredPlantAt> measured{};  ///< plants of the case that are known by data
  std::vector<CurveFile> curves{};          ///< measured friction curves of the case
  std::vector<MatrixFile> matrices{};       ///< MAT-files of the case
};

}  // namespace limcycle
