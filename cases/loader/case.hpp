#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "limcycle/analysis/frequency/describing_function/describing_function.hpp"
#include "limcycle/analysis/orbit/simulate/simulate.hpp"
#include "limcycle/analysis/study/claims/user_claim.hpp"
#include "limcycle/analysis/study/identify/identify.hpp"
#include "limcycle/analysis/study/predict/predict.hpp"
#include "limcycle/analysis/study/sensitivity/parameter_spread.hpp"
#include "limcycle/cases/loader/data/csv_reader.hpp"
#include "limcycle/cases/loader/text/input_error.hpp"
#include "limcycle/models/loop.hpp"
#include "limcycle/models/measured/curve_file.hpp"
#include "limcycle/models/measured/matrix_file.hpp"

namespace limcycle {

/// [df]: points and options of describing functions. Lists are expanded.
struct DfSection {
  std::vector<double> amplitude, frequency, bias{0.0};
  DfOptions options;

  std::size_t size() const { return amplitude.size() * frequency.size() * bias.size(); }

  /// The whole product, amplitude slowest, then frequency, then bias.
  std::vector<DfPoint> points() const;
};

/// [dissipativity]: speeds for questions of energy.
struct DissipativitySection {
  double speed = 1.0;           ///< |v| up to which the force is bounded, m/s
  double top_speed = infinite;  ///< largest |v| of the motions from which energy may be extracted, m/s
};

/// [units]: the unit in which texts, pages and pictures show y; documents stay in the units of the case.
struct OutputUnit {
  std::string symbol;
  double per_si = 1.0;  ///< y in this unit over y in the unit of the case
};

/// [[identify.record]]: a file of measured friction, and which of its columns hold what.
struct RecordFile {
  RecordKind kind = RecordKind::steady_velocity;
  std::string path;                                   ///< from the working folder
  std::array<std::optional<CsvColumn>, 4> columns{};  ///< time, position, velocity, force; empty: by these names
  std::array<double, 4> scale{1.0, 1.0, 1.0, 1.0};    ///< factors of the columns
  double skip = 0.0;                                  ///< s
  double force_limit = infinite;                      ///< N
  bool holds_force = false;                           ///< the applied force keeps its value from row to row
  std::optional<CsvColumn> weight{};                  ///< of the rows
  bool huber = false;                                 ///< see FrictionRecord
};

/// [identify]: laws to be fitted to records.
struct IdentifySection {
  std::vector<Element> laws;
  std::vector<RecordFile> records;
  FreeChoice choice;
};

/// A file of measurements or matrices on which the loop of a case rests.
struct CaseData {
  std::string path;    ///< of the plant or law that it belongs to, such as loop.plant
  std::string file;    ///< as the case names it, from the folder of the case
  std::string sha256;  ///< of its bytes
};

/// A case file, read and validated.
struct Case {
  std::string title;                   ///< default: name of the file without folder and extension
  std::string file;                    ///< as named on the command line
  std::string text;                    ///< bytes of the file
  std::string sha256;                  ///< of these bytes, 64 hexadecimal digits; empty with a law that no file holds
  std::vector<std::string> overrides;  ///< "PATH=VALUE" in the order in which they were applied

  std::optional<Element> own;  ///< the friction law that `kind = "own"` stands for

  std::optional<LoopParts> loop;     ///< empty: a case for a lone element, or for records only
  std::optional<Element> element;    ///< the lone element; empty if there is a loop, or records only
  std::string element_path;          ///< "loop.friction", "loop.element" or "loop.error": the subject of `df`
  std::vector<CurveFile> curves;     ///< of the friction laws
  std::vector<MatrixFile> matrices;  ///< of plants and controllers

  std::optional<OutputUnit> y_unit;
  std::optional<DfSection> df;
  std::optional<SimulateOptions> simulate;  ///< duration, initial, force, reference, stepper, rtol, sample are set
  std::optional<ParameterSpread> sensitivity;
  DissipativitySection dissipativity;
  std::optional<IdentifySection> identify;
  std::vector<UserClaim> claims;
  PredictOptions predict;  ///< search (from [search]), starts and accuracy are set
};

/// Largest size of a case file, bytes.
inline constexpr std::size_t largest_case_file = std::size_t{1} << 20;

/// Reads and validates a case file, with `overrides` ("PATH=VALUE", VALUE in TOML syntax) applied in order. All of it
/// is checked before this returns, against the parameter tables of the models, their own rules and those of the loop.
/// Throws InputError for anything wrong with the file, its contents or an override.
Case load_case(const std::string& file, const std::vector<std::string>& overrides = {});

/// The same from text; `file` is used in messages, and its folder for the files that the case names. `own`: the
/// friction law that [loop.friction] kind = "own" stands for (see own_law()); without, that kind is refused.
Case read_case(std::string_view text, const std::string& file, const std::vector<std::string>& overrides = {},
               const std::optional<Element>& own = {});

/// The case with these overrides in the place of its own ones, read again. Throws InputError.
Case read_again(const Case& from, const std::vector<std::string>& overrides);

/// Parts of a case that a command needs; each throws an InputError that names the missing section.
const LoopParts& need_loop(const Case& from);
const Element& need_element(const Case& from);  ///< the lone element
const DfSection& need_df(const Case& from);
const SimulateOptions& need_simulate(const Case& from);

/// The element whose describing function `df` computes: the lone element, else the friction, else the forward element,
/// else the one on the error.
const Element& df_element(const Case& from);

/// Files of measured plants, then of measured friction curves, of the loop.
std::vector<CaseData> data_of(const Case& from);

/// The laws and records of [identify], the files read now. Throws InputError for a missing section or a bad file.
IdentifyRequest identify_request(const Case& from);

/// The plant that moves in free motions, and the load. Throws InputError if there is none, or it is not fitted for
/// them.
FreeRig rig_of(const Case& from);

/// The case's own claims, ready to be tested.
std::vector<Claim> claims_of(const Case& from);

/// Kind of a law, element, plant or controller as written in a case file.
template <class... Kinds>
std::string_view kind_of(const std::variant<Kinds...>& any) {
  return std::visit([]<class K>(const K&) { return K::kind; }, any);
}

/// SHA-256 of some bytes (FIPS 180-4), 64 lower-case hexadecimal digits.
std::string sha256(std::string_view bytes);

}  // namespace limcycle
