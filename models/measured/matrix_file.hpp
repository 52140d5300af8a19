#pragma once
#include <string>
#include <vector>

namespace limcycle {

/// A MAT-file with matrices of a plant or controller.
struct MatrixFile {
  std::string path;  ///< of the plant or controller, "loop.plant" or "diagram.NAME"
  std::string file;  ///< as named in the case
  std::string sha256;
  std::vector<std::string> variables;  ///< those taken
};

}  // namespace limcycle
