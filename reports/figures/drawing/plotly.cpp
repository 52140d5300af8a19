#include "limcycle/reports/figures/drawing/plotly.hpp"

#include <cstddef>
#include <cstdint>

// The assembler copies the file (1.4 MB): as an array in C++ it would take the compiler seconds. Its length is stored
// too, since the difference of two unrelated symbols is not defined in C++.
asm(R"(
    .pushsection .rodata
    .hidden limcycle_plotly_text
    .hidden limcycle_plotly_size
    .global limcycle_plotly_text
    .global limcycle_plotly_size
limcycle_plotly_text:
    .incbin ")" LIMCYCLE_PLOTLY_FILE R"("
limcycle_plotly_end:
    .balign 8
limcycle_plotly_size:
    .quad limcycle_plotly_end - limcycle_plotly_text
    .popsection
)");

extern "C" {
extern const char limcycle_plotly_text[];
extern const std::uint64_t limcycle_plotly_size;
}

namespace limcycle {

std::string_view plotly_script() { return {limcycle_plotly_text, static_cast<std::size_t>(limcycle_plotly_size)}; }

}  // namespace limcycle
