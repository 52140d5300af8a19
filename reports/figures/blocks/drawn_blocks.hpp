#pragma once
#include <string>
#include <vector>

#include "limcycle/reports/figures/blocks/block_words.hpp"

/// @file
/// What block diagrams are drawn with: boxes with words, arrows, sums.

namespace limcycle {

inline constexpr double block_line_height = 17.0, sum_radius = 10.0;

/// A block at its place: its upper left corner and its size.
struct PlacedBlock {
  BlockWords words;
  double x = 0.0, y = 0.0, width = 0.0, height = 0.0;
  double middle() const { return x + 0.5 * width; }
  double right() const { return x + width; }
  double bottom() const { return y + height; }
};

struct Spot {
  double x, y;
};

/// Estimated width of words, px: fonts differ.
double width_of(const std::string& words);

/// A block as large as its words need.
PlacedBlock sized(BlockWords words);

// Parts of an SVG picture.
std::string words_in(double x, double y, const std::string& words, std::string_view kind = {});
std::string drawn(const PlacedBlock& block);
/// A line through corners, with an arrow head at its end.
std::string arrow(const std::vector<Spot>& corners);
/// The circle of a sum.
std::string circle_at(Spot spot);
/// A dot where lines meet.
std::string node_at(Spot spot);

/// The whole picture: it follows the colours of the text around it and never exceeds its natural width.
std::string framed_diagram(const std::string& body, double width, double height, const std::string& label);

}  // namespace limcycle
