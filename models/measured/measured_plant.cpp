#include "limcycle/models/measured/measured_plant.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "limcycle/models/linear/plants.hpp"

namespace limcycle {

FitWish MeasuredPlant::wish() const {
  FitWish wish;
  if (order > 0.0) wish.order = static_cast<int>(order);
  if (poles_at_zero.index > 0) wish.poles_at_zero = poles_at_zero.index - 1;
  if (relative_degree.index > 0) wish.relative_degree = relative_degree.index;
  return wish;
}

std::shared_ptr<const MeasuredResponse> MeasuredPlant::measured() const {
  if (response && response->wish() == wish() && response->delay() == delay) return response;
  if (!data) throw std::invalid_argument("has not been read");
  return std::make_shared<const MeasuredResponse>(data, wish(), delay);
}

std::optional<BrokenRule> MeasuredPlant::validate() const {
  const bool rows = points.size() > 0;
  if (file.empty() && !rows && !data)
    return BrokenRule{"file", "is required: a CSV file of the data, or their rows as points"};
  if (!file.empty() && rows) return BrokenRule{"points", "stands beside `file`: leave one of them out"};
  if (rows && !columns.empty()) return BrokenRule{"columns", "belongs to a file: order the numbers of each row"};
  if (rows && points.cols() != (uncertainty.index > 0 ? 4 : 3))
    return BrokenRule{"points", uncertainty.index > 0
                                    ? "must have 4 numbers a row, the last its uncertainty"
                                    : "must have 3 numbers a row: frequency, and two of the response"};
  if (order != std::floor(order)) return BrokenRule{"order", "must be a whole number"};
  if (gain == 0.0) return BrokenRule{"gain", "must not be zero"};
  if (uncertainty.index == 2 && averages < 1.0)
    return BrokenRule{"averages", "must be at least 1: a coherence alone does not say how uncertain the data are"};
  const FitWish asked = wish();
  const int least = std::max(asked.poles_at_zero.value_or(0), asked.relative_degree.value_or(1));
  if (asked.order && *asked.order < least)
    return BrokenRule{"order", "must be at least " + std::to_string(least) +
                                   ", the number of poles at zero and the relative degree asked for"};
  if (!data) return std::nullopt;
  try {
    measured();
  } catch (const std::invalid_argument& refused) {
    return BrokenRule{rows ? "points" : "file", refused.what()};
  }
  return std::nullopt;
}

PlantModel MeasuredPlant::model() const {
  PlantModel plant = input_output_plant(measured()->fit().model, delay);
  plant.B_u *= gain;
  plant.B_F *= gain;
  plant.measured = measured();
  return plant;
}

}  // namespace limcycle
