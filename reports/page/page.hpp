#pragma once
#include <string_view>

namespace limcycle {

/// Style and script of every page, ready for its style and script elements.
std::string_view page_style();
std::string_view page_script();

}  // namespace limcycle
