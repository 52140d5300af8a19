#include "limcycle/models/measured/plants_of_loop.hpp"

namespace limcycle {

std::vector<MeasuredPlantAt> measured_plants(const LoopParts& parts) {
  std::vector<MeasuredPlantAt> found;
  const auto add = [&](const Plant& plant, const std::string& path) {
    if (const auto* measured = std::get_if<MeasuredPlant>(&plant)) found.push_back({path, measured->measured()});
  };
  if (!parts.diagram) {
    add(parts.plant, "loop.plant");
    return found;
  }
  for (const Block& block : parts.diagram->blocks)
    if (const auto* plant = std::get_if<Plant>(&block.what)) add(*plant, block.path);
  return found;
}

std::string basis_in_words(const MeasuredPlantAt& plant) {
  return plant.path + " is measured (" + plant.response->data_in_words() +
         "): describing functions read the data; simulation, shooting and harmonic balance rest on " +
         plant.response->fit_in_words();
}

Loop with_fits(Loop loop) {
  loop.measured.clear();
  return loop;
}

}  // namespace limcycle
