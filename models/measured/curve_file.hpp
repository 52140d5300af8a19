#pragma once
#include <cstddef>
#include <string>

namespace limcycle {

/// A file of friction that was measured at some speeds, the curve of a law.
struct CurveFile {
  std::string path;  ///< of the law, "loop.friction" or "diagram.NAME"
  std::string file;  ///< as named in the case
  std::string sha256;
  std::size_t points = 0;
};

}  // namespace limcycle
