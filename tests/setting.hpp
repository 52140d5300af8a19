#pragma once
#include <filesystem>
#include <string>

extern "C" [[gnu::weak]] void __asan_init();

/// What a test finds out where it runs, so that tests compiled once serve the plain and the sanitized build.
namespace limcycle::test {

/// True where the test program is linked with AddressSanitizer. A function, and so is what follows from it: clang
/// initialises inline variables of several sources in any order, and one that read another had its value before it.
inline bool sanitized() { return &__asan_init != nullptr; }

/// The program under test: the one in the build folder that the test program stands in.
inline const std::string tested_program =
    (std::filesystem::read_symlink("/proc/self/exe").parent_path().parent_path() / "limcycle").string();

}  // namespace limcycle::test
