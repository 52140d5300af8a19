#pragma once
#include <string_view>

namespace limcycle {

/// The script of a page, one concern a part. They share one scope and are joined in this order.
std::string_view script_ground();   ///< colours, axes, numbers: what the others draw with
std::string_view script_figures();  ///< each kind of figure: its data to curves
std::string_view script_nyquist();  ///< the Nyquist plot, and the sliders that walk along it
std::string_view script_tables();   ///< each kind of figure: its data to rows of CSV
std::string_view script_saving();   ///< buttons that save pictures, rows and the document
std::string_view script_page();     ///< draws all, and again when the screen, the colours or the paper change; keys

}  // namespace limcycle
