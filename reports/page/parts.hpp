#pragma once
#include <string_view>

namespace limcycle {

/// The script of a page, split by task. The parts share one scope and are joined in this order.
std::string_view script_base();     ///< colours, axes, numbers: common to all drawings
std::string_view script_figures();  ///< data to curves, for each kind of figure
std::string_view script_nyquist();  ///< the Nyquist plot, and the sliders that move along it
std::string_view script_tables();   ///< data to rows of CSV, for each kind of figure
std::string_view script_saving();   ///< buttons that save pictures, rows and the document
std::string_view script_page();     ///< draws all, and again when the screen, the colours or the paper change; keys

}  // namespace limcycle
