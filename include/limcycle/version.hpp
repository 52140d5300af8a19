#pragma once
#include <string_view>

/// Version of the library, as limcycle MAJOR.MINOR.PATCH; docs/library.md says what it promises.
#define LIMCYCLE_VERSION_MAJOR 0
#define LIMCYCLE_VERSION_MINOR 2
#define LIMCYCLE_VERSION_PATCH 0

namespace limcycle {
inline constexpr std::string_view library_version = "0.2.0";
}  // namespace limcycle
