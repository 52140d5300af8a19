#pragma once
#include <string_view>

namespace limcycle {

/// Writes all bytes to an open file; false, with errno, if that fails.
bool write_all(int file, std::string_view bytes);

}  // namespace limcycle
