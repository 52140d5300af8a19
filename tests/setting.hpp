#pragma once
#include <cstdlib>
#include <string>

/// What a test reads of its environment, so that tests compiled once serve the plain and the sanitized program.
namespace limcycle::test {

/// The program of a sanitizer run, or null: set by tests/CMakeLists.txt.
inline const char* const sanitized_program =
    std::getenv("LIMCYCLE_SANITIZED_PROGRAM");  // NOLINT(concurrency-mt-unsafe)

/// The program under test.
inline const std::string tested_program = sanitized_program != nullptr ? sanitized_program : LIMCYCLE_PROGRAM;

}  // namespace limcycle::test
