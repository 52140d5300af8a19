#pragma once
#include <string>
#include <string_view>

namespace limcycle {

// Pieces of the pictures that are written as SVG. Lengths are in the picture's units; classes are those of its style.

/// A picture; `label` states the finding for readers who cannot see it. `style` must define the class `title`.
std::string svg_picture(double width, double height, const std::string& label, std::string_view style,
                        const std::string& title, const std::string& body);

/// Words that begin at (x, y), or are placed by their class; `kind` may be empty.
std::string words_at(double x, double y, std::string_view kind, const std::string& words);

std::string line_of(double x1, double y1, double x2, double y2, std::string_view kind);

/// Position of a value between left and left + width, on a scale from low to high; limited to both ends.
double place(double value, double left, double width, double low, double high);

/// The colour of a share of 0 to 1: from light to dark in 24 steps, even in lightness.
std::string colour_of_share(double share);

}  // namespace limcycle
