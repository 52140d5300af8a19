#pragma once
#include "limcycle/models/loop.hpp"

namespace limcycle {

/// The plants of a loop that are known by measured data: their paths, "loop.plant" or "diagram.NAME", and the data with
/// their fits.
struct MeasuredPlantAt {
  std::string path;
  std::shared_ptr<const MeasuredResponse> response;
};
std::vector<MeasuredPlantAt> measured_plants(const LoopParts& parts);

/// What results in frequency and in time rest on: data and fit, in one sentence.
std::string basis_in_words(const MeasuredPlantAt& plant);

/// The loop in which the fits stand for the data, at all frequencies.
Loop with_fits(Loop loop);

}  // namespace limcycle
