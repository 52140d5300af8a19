#include "limcycle/reports/figures/staircase.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "limcycle/reports/figures/blocks/drawn_blocks.hpp"

namespace limcycle {
namespace {

constexpr double margin = 14.0, gap_x = 34.0, gap_y = 26.0, port_spacing = 16.0;
constexpr std::string_view minus = "\xE2\x88\x92";

/// "-", "2", "-0.5": what stands at the dot of a term; empty for a plain plus.
std::string factor_words(double factor) {
  if (factor == 1.0) return "";
  if (factor == -1.0) return std::string(minus);
  return diagram_number(factor);
}

class Staircase {
 public:
  Staircase(const LoopParts& parts, const Units& units) : diagram_(*parts.diagram) {
    BlockWords reference;
    reference.title = "r";
    reference.whole = reference_words(parts, units);
    reference.lines.push_back({reference.whole, false, false});
    place("r", std::move(reference));
    for (const Block& block : diagram_.blocks) place(block.name, words_of_block(block, units));
    leaves(diagram_.output);
    for (const Block& block : diagram_.blocks) {
      for (const SignalSum& sum : block.inputs)
        for (const Term& term : sum) leaves(term);
      for (const std::string& body : {block.on, block.against})
        if (!body.empty()) leaves({1.0, body, "v"});
      if (block.contact == Contact::opposes) leaves({1.0, block.name, "F"});
    }
  }

  std::string svg(const std::string& label) {
    std::string body;
    for (const PlacedBlock& block : placed_) body += drawn(block);
    for (const Block& block : diagram_.blocks) {
      for (std::size_t k = 0; k < block.inputs.size(); ++k)
        for (const Term& term : block.inputs[k])
          body += wire({term.block, output_of(term)}, block.name, port(block, k), words_of(term));
      if (block.contact != Contact::none) body += contact(block);
    }
    const double y = height_of({diagram_.output.block, output_of(diagram_.output)});
    body += arrow({{at(diagram_.output.block).right(), y}, {width_ + 10.0, y}});
    body += words_in(width_ + 14.0, y + 4.0, "y");
    return framed_diagram(body, width_ + 36.0, height_ + margin, label);
  }

 private:
  void place(const std::string& name, BlockWords words) {
    PlacedBlock block = sized(std::move(words));
    block.x = placed_.empty() ? margin : placed_.back().right() + gap_x;
    block.y = placed_.empty() ? margin : placed_.back().bottom() + gap_y;
    number_[name] = placed_.size();
    width_ = block.right();
    height_ = block.bottom();
    placed_.push_back(std::move(block));
  }

  /// An output of a block.
  struct Source {
    std::string block, output;
  };

  static std::string output_of(const Term& term) { return term.output.empty() ? "y" : term.output; }

  /// Notes that an output of a block is used: each leaves the block at a height of its own.
  void leaves(const Term& term) {
    auto& outputs = outputs_[term.block];
    if (std::ranges::find(outputs, output_of(term)) == outputs.end()) outputs.push_back(output_of(term));
  }

  double height_of(const Source& from) const {
    const auto& outputs = outputs_.at(from.block);
    const auto k = static_cast<double>(std::ranges::find(outputs, from.output) - outputs.begin());
    const PlacedBlock& block = at(from.block);
    const double spacing = std::min(12.0, block.height / static_cast<double>(outputs.size() + 1));
    return block.y + 0.5 * block.height + spacing * (k - 0.5 * static_cast<double>(outputs.size() - 1));
  }

  const PlacedBlock& at(const std::string& name) const { return placed_[number_.at(name)]; }

  /// Distance of an input from the middle of its block.
  static double port(const Block& block, std::size_t k) {
    return port_spacing * (static_cast<double>(k) - 0.5 * static_cast<double>(block.inputs.size() - 1));
  }

  static std::string words_of(const Term& term) {
    const std::string factor = factor_words(term.factor);
    const std::string output = term.output.empty() || term.output == "y" ? "" : term.output;
    return factor + (factor.empty() || output.empty() ? "" : " ") + output;
  }

  /// From the side of a block into the column of another, at `shift` from its middle.
  std::string wire(const Source& from, const std::string& to, double shift, const std::string& words) const {
    const PlacedBlock &source = at(from.block), &target = at(to);
    const bool forward = number_.at(from.block) < number_.at(to);
    const double x = target.middle() + shift, y = height_of(from);
    const Spot begin{forward ? source.right() : source.x, y}, end{x, forward ? target.y : target.bottom()};
    if (from.block == to) {
      const double outside = source.bottom() + 12.0;
      return arrow({{source.middle() + 20.0, source.bottom()},
                    {source.middle() + 20.0, outside},
                    {x, outside},
                    {x, source.bottom()}}) +
             words_in(x + 4.0, outside - 2.0, words);
    }
    return arrow({begin, {x, y}, end}) + node_at({x, y}) + words_in(x + 5.0, y - 5.0, words);
  }

  /// The velocity of a body comes to the friction, and its force goes back: two wires, one in each direction.
  std::string contact(const Block& block) const {
    std::string out;
    for (const std::string* name : {&block.on, &block.against}) {
      const std::string& body = *name;
      if (body.empty()) continue;
      const double shift = name == &block.against ? 0.0 : -8.0;
      out += wire({body, "v"}, block.name, shift, "v");
      const std::string sign = name == &block.on ? std::string(minus) : "";
      if (block.contact == Contact::opposes) out += wire({block.name, "F"}, body, 8.0, sign + "F");
    }
    return out;
  }

  const Diagram& diagram_;
  std::vector<PlacedBlock> placed_;
  std::map<std::string, std::size_t> number_;
  std::map<std::string, std::vector<std::string>> outputs_;  ///< of each block, as they leave it from above
  double width_ = 0.0, height_ = 0.0;
};

}  // namespace

std::string sum_in_words(const SignalSum& sum) {
  std::string out;
  for (const Term& term : sum) {
    const double size = std::abs(term.factor);
    out += out.empty() ? (term.factor < 0.0 ? "-" : "") : term.factor < 0.0 ? " - " : " + ";
    if (size != 1.0) out += fmt::format("{} ", size);
    out += term.block + (term.output.empty() ? "" : "." + term.output);
  }
  return out;
}

std::string staircase(const LoopParts& parts, const Units& units, const std::string& label) {
  return Staircase(parts, units).svg(label);
}

}  // namespace limcycle
