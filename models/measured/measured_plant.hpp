#pragma once
#include <memory>
#include <string>

#include "limcycle/models/linear/plant_signals.hpp"
#include "limcycle/models/measured/measured_response.hpp"
#include "limcycle/models/parameter.hpp"

namespace limcycle {

struct PlantModel;

/// A plant known by its measured frequency response from u (force) to y (position), friction acting as a negative u. In
/// the frequency domain the data are used as they are, in time a stable fit of them: see MeasuredResponse.
struct MeasuredPlant {
  std::string file{};
  Eigen::MatrixXd points{};  ///< in the place of the file: its rows
  Choice frequency{}, format{}, poles_at_zero{}, relative_degree{}, uncertainty{};
  double order{0.0}, delay{0.0}, gain{1.0}, averages{0.0};
  std::vector<double> columns{};
  std::shared_ptr<const FrequencyData> data{};         ///< of `file` or `points`, read by whoever makes the plant
  std::shared_ptr<const MeasuredResponse> response{};  ///< made for the parameters by measured()

  static constexpr std::string_view kind = "frf";
  static constexpr PlantSignals signals = PlantSignals::unknown;
  static constexpr std::string_view equation = "y(jw) = gain data(jw) (u - F); in time a stable fit of the data";
  static constexpr std::string_view frequencies[] = {"rad/s", "Hz"};
  static constexpr std::string_view formats[] = {"re-im", "magnitude-degrees", "decibel-degrees"};
  static constexpr std::string_view counts[] = {"chosen", "none", "one", "two"};
  static constexpr std::string_view degrees[] = {"chosen", "one", "two"};
  static constexpr std::string_view uncertainties[] = {"none", "standard-deviation", "coherence"};
  static std::vector<Parameter<MeasuredPlant, double>> parameters() {
    using P = MeasuredPlant;
    return {{"file", "1", "CSV file of the data, beside the case", &P::file, any_number, false},
            {"points", "1", "rows of the data in the place of the file", &P::points, any_number, false},
            {"frequency", "1", "unit of its first column", &P::frequency, any_number, true, "", frequencies},
            {"format", "1", "of the two columns after it", &P::format, any_number, true, "", formats},
            {"order", "1", "of the fit, 1 to 40; 0: chosen", &P::order, {0.0, most_fitted_order}, false},
            {"poles_at_zero", "1", "of the fit: a free body has two", &P::poles_at_zero, any_number, false, "", counts},
            {"relative_degree", "1", "of the fit, at least: friction needs two", &P::relative_degree, any_number, false,
             "", degrees},
            {"delay", "s", "dead time in the data that is kept out of the fit", &P::delay, not_negative, false},
            {"gain", "1", "factor on the data, such as 0.001 for y in mm", &P::gain, any_number, false},
            {"uncertainty", "1", "what a fourth column holds", &P::uncertainty, any_number, false, "", uncertainties},
            {"averages", "1", "number of averages behind a coherence", &P::averages, not_negative, false},
            {"columns", "1", "numbers of the columns from 1, by default 1, 2, 3 and 4", &P::columns, positive, false}};
  }
  std::optional<BrokenRule> validate() const;
  PlantModel model() const;

  FitWish wish() const;
  /// The response for these parameters: `response` if it was made for them, else a new one. Throws
  /// std::invalid_argument where there is none (see MeasuredResponse).
  std::shared_ptr<const MeasuredResponse> measured() const;
};

}  // namespace limcycle
