#include "limcycle/reports/figures/blocks/block_diagram.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "limcycle/models/diagram/assemble.hpp"
#include "limcycle/reports/figures/blocks/block_words.hpp"
#include "limcycle/reports/figures/blocks/drawn_blocks.hpp"
#include "limcycle/reports/figures/staircase.hpp"

namespace limcycle {
namespace {

constexpr double block_gap = 40.0, side_margin = 12.0;

/// Lays out and draws the loop from left to right: the path of the command to the plant in a row, additions to the
/// command above it, the friction below the plant, the feedback path at the bottom.
class DiagramOfLoop {
 public:
  DiagramOfLoop(const LoopParts& parts, const Units& units)
      : parts_(parts), units_(units), actuator_(actuator_of(parts.controller)), compared_(uses_error(parts)) {}

  std::string svg(const std::string& label) {
    make_blocks();
    place_row();
    place_others();
    const std::string body = row() + friction() + compensation() + load() + way_back();
    return framed_diagram(body, y_label_ + 24.0, bottom_ + 12.0, label);
  }

 private:
  bool has_command() const { return compared_ || actuator_.friction_compensation > 0.0; }
  bool sums_at_plant() const { return parts_.friction.has_value() || parts_.load != 0.0; }

  void make_blocks() {
    if (compared_ && parts_.error) before_.push_back(sized(element_words("on the error", *parts_.error, units_)));
    if (compared_)
      if (auto words = controller_words(parts_.controller, units_)) before_.push_back(sized(*std::move(words)));
    if (has_command()) {
      if (std::isfinite(actuator_.saturation)) after_.push_back(sized(limit_words(actuator_.saturation, units_)));
      if (actuator_.lag > 0.0) after_.push_back(sized(lag_words(actuator_.lag)));
      if (parts_.element) after_.push_back(sized(element_words("element", *parts_.element, units_)));
    }
    plant_ = sized(plant_words(parts_.plant, units_));
    if (parts_.friction) friction_ = sized(element_words("friction", *parts_.friction, units_));
    if (actuator_.friction_compensation > 0.0)
      compensation_ = sized(compensation_words(actuator_.friction_compensation, units_));
  }

  /// Places the blocks along the row, from left to right; heights follow later.
  void place_row() {
    double x = side_margin;
    const auto sum = [&](std::optional<Spot>& where) {
      x += block_gap;
      where = Spot{x + sum_radius, 0.0};
      x += 2.0 * sum_radius;
    };
    const auto put = [&](PlacedBlock& block) {
      x += block_gap;
      block.x = x;
      x += block.width;
    };
    if (compared_) {
      x = std::max(x, side_margin + width_of(reference_words(parts_, units_)) - block_gap + 8.0);
      sum(compare_);
    }
    for (auto& block : before_) put(block);
    if (compensation_) {
      if (!compared_) x = std::max(x, side_margin + 0.5 * compensation_->width - block_gap);
      sum(add_);
    }
    for (auto& block : after_) put(block);
    if (sums_at_plant()) {
      if (!has_command()) x += 0.5 * width_of(load_words(parts_, units_));
      sum(join_);
    }
    put(plant_);
  }

  void place_others() {
    double tallest = std::max(plant_.height, 2.0 * sum_radius);
    for (const auto* list : {&before_, &after_})
      for (const auto& block : *list) tallest = std::max(tallest, block.height);
    double top = 10.0;
    if (compensation_) {
      compensation_->y = top;
      compensation_->x = std::max(side_margin, add_->x - 0.5 * compensation_->width);
      top += compensation_->height + 14.0;
    }
    if (parts_.load != 0.0) top += 26.0;
    top_of_row_ = top;
    middle_ = top + 0.5 * tallest;
    for (auto* list : {&before_, &after_})
      for (auto& block : *list) block.y = middle_ - 0.5 * block.height;
    plant_.y = middle_ - 0.5 * plant_.height;
    for (auto* spot : {&compare_, &add_, &join_})
      if (*spot) (*spot)->y = middle_;
    node_ = plant_.right() + 30.0;
    bottom_ = middle_ + 0.5 * tallest;
    if (friction_) place_friction();
    if (compared_) bottom_ += 28.0;
    y_label_ = node_ + 34.0;
  }

  void place_friction() {
    friction_->x = std::max(join_->x + 34.0, plant_.middle() - 0.5 * friction_->width);
    friction_->y = std::max(plant_.bottom(), middle_ + 36.0) + 44.0;
    bottom_ = std::max(bottom_, friction_->bottom());
    node_ = std::max(
        {node_, friction_->right() + 24.0, plant_.middle() + 8.0 + width_of(rubbing_velocity(parts_.plant)) + 14.0});
  }

  /// The row of blocks with the arrows between them, from the reference to y.
  std::string row() const {
    std::string out;
    double from = side_margin;  // begin of the next arrow
    const auto lead = [&](double to) { out += arrow({{from, middle_}, {to, middle_}}); };
    const auto through = [&](const PlacedBlock& block) {
      lead(block.x);
      out += drawn(block);
      from = block.right();
    };
    const auto meet = [&](const Spot& spot, bool line) {
      if (line) lead(spot.x - sum_radius);
      out += circle_at(spot);
      from = spot.x + sum_radius;
    };
    if (compare_) {
      out += words_in(side_margin, middle_ - 7.0, reference_words(parts_, units_));
      meet(*compare_, true);
      out += words_in(from + 8.0, middle_ - 7.0, "e");
    }
    for (const auto& block : before_) through(block);
    if (add_) meet(*add_, compared_);
    for (const auto& block : after_) through(block);
    if (has_command()) out += words_in(from + 8.0, middle_ - 7.0, before_.empty() && after_.empty() ? "" : "u");
    if (join_) meet(*join_, has_command());
    if (!join_ && !has_command()) from = plant_.x - block_gap;
    through(plant_);
    out += arrow({{from, middle_}, {y_label_, middle_}});
    return out + words_in(y_label_ + 6.0, middle_ + 4.0, "y");
  }

  std::string friction() const {
    if (!friction_) return "";
    const double across = friction_->y + 0.5 * friction_->height;
    std::string out = drawn(*friction_) + arrow({{plant_.middle(), plant_.bottom()}, {plant_.middle(), friction_->y}});
    out += words_in(plant_.middle() + 8.0, friction_->y - 16.0, rubbing_velocity(parts_.plant));
    out += arrow({{friction_->x, across}, {join_->x, across}, {join_->x, middle_ + sum_radius}});
    out += words_in(join_->x - 8.0, across - 8.0, "F", "diagram-end");
    return out + words_in(join_->x + 6.0, middle_ + 25.0, "\xE2\x88\x92");
  }

  std::string compensation() const {
    if (!compensation_) return "";
    const double across = compensation_->y + 0.5 * compensation_->height;
    std::string out = drawn(*compensation_);
    out += arrow({{plant_.middle(), plant_.y}, {plant_.middle(), across}, {compensation_->right(), across}});
    out += words_in(plant_.middle() + 7.0, across + 4.0, "v");
    return out + arrow({{add_->x, compensation_->bottom()}, {add_->x, middle_ - sum_radius}}) +
           words_in(add_->x + 6.0, middle_ - 16.0, "+");
  }

  std::string load() const {
    if (parts_.load == 0.0) return "";
    const double begin = std::min(top_of_row_ - 4.0, middle_ - sum_radius - 26.0);
    return arrow({{join_->x, begin}, {join_->x, middle_ - sum_radius}}) +
           words_in(join_->x, begin - 5.0, load_words(parts_, units_), "diagram-centred");
  }

  std::string way_back() const {
    if (!compare_) return "";
    return node_at({node_, middle_}) +
           arrow({{node_, middle_}, {node_, bottom_}, {compare_->x, bottom_}, {compare_->x, middle_ + sum_radius}}) +
           words_in(compare_->x + 6.0, middle_ + 25.0, "\xE2\x88\x92");
  }

  const LoopParts& parts_;
  const Units& units_;
  const Actuator& actuator_;
  const bool compared_;                      // r - y is formed and used
  std::vector<PlacedBlock> before_, after_;  // the place where the compensation is added
  PlacedBlock plant_;
  std::optional<PlacedBlock> friction_, compensation_;
  std::optional<Spot> compare_, add_, join_;
  double middle_ = 0.0, top_of_row_ = 0.0, bottom_ = 0.0, node_ = 0.0, y_label_ = 0.0;
};

}  // namespace

std::string block_diagram(const LoopParts& parts, const Units& units) {
  if (parts.diagram) return staircase(parts, units, "Block diagram. " + loop_in_words(parts, units));
  return DiagramOfLoop(parts, units).svg("Block diagram. " + loop_in_words(parts, units));
}

}  // namespace limcycle
