#include "limcycle/models/diagram/diagram.hpp"

#include <algorithm>

namespace limcycle {

std::size_t inputs_of(const Block& block) {
  if (block.contact != Contact::none) return 0;
  const auto* linear = std::get_if<LinearBlock>(&block.what);
  if (linear == nullptr) return 1;
  if (std::holds_alternative<Constant>(*linear)) return 0;
  const auto* space = std::get_if<StateSpaceBlock>(linear);
  return space != nullptr ? static_cast<std::size_t>(space->B.cols()) : 1;
}

std::vector<const Block*> elements_of(const Diagram& diagram, Contact contact) {
  std::vector<const Block*> found;
  for (const Block& block : diagram.blocks)
    if (block.contact == contact && std::holds_alternative<Element>(block.what)) found.push_back(&block);
  return found;
}

std::optional<std::size_t> find_block(const Diagram& diagram, std::string_view name) {
  const auto found = std::ranges::find(diagram.blocks, name, &Block::name);
  if (found == diagram.blocks.end()) return std::nullopt;
  return static_cast<std::size_t>(found - diagram.blocks.begin());
}

bool end_delay(Block& block) {
  if (auto* plant = std::get_if<Plant>(&block.what)) return end_delay(*plant);
  auto* linear = std::get_if<LinearBlock>(&block.what);
  if (linear == nullptr || !std::holds_alternative<DelayBlock>(*linear)) return false;
  *linear = Gain{1.0};
  return true;
}

}  // namespace limcycle
