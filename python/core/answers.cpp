#include "limcycle/python/core/answers.hpp"

#include <limits>
#include <memory>
#include <mutex>
#include <type_traits>
#include <utility>

#include "limcycle/analysis/study/balance/roots/nyquist.hpp"
#include "limcycle/cases/loader/case_numbers.hpp"
#include "limcycle/cases/loader/text/printable.hpp"
#include "limcycle/questions/asking/answer_of.hpp"
#include "limcycle/questions/asking/provenance_of.hpp"
#include "limcycle/questions/asking/units_of.hpp"
#include "limcycle/questions/asking/words.hpp"
#include "limcycle/questions/continue.hpp"
#include "limcycle/questions/df.hpp"
#include "limcycle/questions/identify.hpp"
#include "limcycle/questions/margin.hpp"
#include "limcycle/questions/predict.hpp"
#include "limcycle/questions/simulate.hpp"
#include "limcycle/questions/threshold.hpp"
#include "limcycle/reports/continuation/continue.hpp"
#include "limcycle/reports/continuation/margin.hpp"
#include "limcycle/reports/csv.hpp"
#include "limcycle/reports/dissipativity/dissipativity.hpp"
#include "limcycle/reports/figures/drawing/picture.hpp"
#include "limcycle/reports/format/document.hpp"
#include "limcycle/reports/html.hpp"
#include "limcycle/reports/identify/identify.hpp"
#include "limcycle/reports/in_units.hpp"
#include "limcycle/reports/json.hpp"
#include "limcycle/reports/largest_swing.hpp"
#include "limcycle/reports/map/map.hpp"
#include "limcycle/reports/remedy/remedy.hpp"
#include "limcycle/reports/sensitivity/sensitivity.hpp"
#include "limcycle/reports/text.hpp"
#include "limcycle/reports/tune/tune.hpp"

namespace limcycle::python {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Result of compute(), shared by the documents.
template <class Compute>
auto computed(const Compute& compute) {
  return std::make_shared<const decltype(compute())>(answer_of(compute));
}

/// What stands around a report in its documents.
struct Sheet {
  std::shared_ptr<const Case> from;
  Provenance made;
  std::string first, last;  ///< lines of the text

  /// The case of a page; with a law of Python the text only holds its place.
  std::string case_text() const { return from->sha256.empty() ? std::string() : from->text; }
};

Sheet sheet_of(const Question& question, Status ended) {
  Sheet sheet{question.from, provenance_of(question.asking.seed, question.asking.threads, question.from.get()),
              first_line(ended, cause_in_words(question.time_limit)), basis_lines(*question.from)};
  sheet.made.time_is_over = question.time_is_over && question.time_is_over();
  return sheet;
}

/// The units that a person reads a report in, and the report in them.
template <class Report>
Units units_of_sheet(const Sheet& sheet, const Report& report) {
  if constexpr (requires { largest_swing(report); })
    return units_of(*sheet.from, largest_swing(report));
  else
    return units_of(*sheet.from);
}
template <class Report>
Report shown(const Report& report, const Units& units) {
  if constexpr (requires { in_units(report, units); })
    return in_units(report, units);
  else
    return report;
}

/// json(provenance, report), csv(report), text(title, report, units) or text(title, report), a Document.
template <class Report, class Json, class Csv, class Text>
Answer documents(const Sheet& sheet, const std::shared_ptr<const Report>& report, Json json, Csv csv, Text text) {
  Answer answer;
  answer.json = [=] { return json(sheet.made, *report); };
  answer.csv = [=] { return csv(*report); };
  const auto in_words = [=] {
    Document words(sheet.first);
    if constexpr (std::is_invocable_v<Text, std::string, Report, Units>) {
      const Units units = units_of_sheet(sheet, *report);
      words += text(sheet.from->title, shown(*report, units), units);
    } else {
      words += text(sheet.from->title, *report);
    }
    words += sheet.last;
    return words;
  };
  answer.text = [=] { return printable(in_words().text()); };
  answer.latex = [=] { return in_words().latex("limcycle " + sheet.made.version + ": " + sheet.from->title); };
  return answer;
}

/// picture(report, units).
template <class Report, class Picture>
std::function<std::string()> drawn(const Sheet& sheet, const std::shared_ptr<const Report>& report, Picture picture) {
  return [=] {
    const Units units = units_of_sheet(sheet, *report);
    return picture(shown(*report, units), units);
  };
}

/// page(report, provenance, case, units, flags...).
template <class Report, class Page, class... Flags>
std::function<std::string()> paged(const Sheet& sheet, const std::shared_ptr<const Report>& report, Page page,
                                   const Flags&... flags) {
  return [=] {
    const Units units = units_of_sheet(sheet, *report);
    return page(shown(*report, units), sheet.made, sheet.case_text(), units, flags...);
  };
}

template <class Number>
Array line(const std::vector<Number>& numbers) {
  return {{numbers.size()}, numbers};
}

std::map<std::string, Array> nyquist_arrays(const NyquistPicture& picture) {
  std::vector<std::complex<double>> family;
  for (const auto& member : picture.minus_inverse_N) family.insert(family.end(), member.begin(), member.end());
  std::vector<std::size_t> shape{picture.minus_inverse_N.size(), picture.family_amplitude.size()};
  if (family.size() != shape[0] * shape[1]) {
    family.clear();
    shape = {0, 0};
  }
  return {{"frequency", line(picture.frequency)},
          {"G", line(picture.G)},
          {"family_amplitude", line(picture.family_amplitude)},
          {"family_frequency", line(picture.family_frequency)},
          {"minus_inverse_N", {shape, std::move(family)}}};
}

/// A prediction with the curves of its Nyquist figure, which are computed when they are first asked for: they may take
/// as long as the prediction itself.
class ReportWithCurves {
 public:
  ReportWithCurves(std::shared_ptr<const Case> from, std::shared_ptr<const PredictReport> report)
      : from_(std::move(from)), report_(std::move(report)) {}

  std::shared_ptr<const PredictReport> get() {
    std::call_once(once_, [this] {
      PredictReport drawn = *report_;
      drawn.nyquist = nyquist_picture(build_loop(*from_->loop), drawn);
      report_ = std::make_shared<const PredictReport>(std::move(drawn));
    });
    return report_;
  }

 private:
  std::shared_ptr<const Case> from_;
  std::shared_ptr<const PredictReport> report_;
  std::once_flag once_;
};

/// One number of each thing, NaN where there is none.
template <class Things, class Number>
std::vector<double> each(const Things& things, std::size_t count, const Number& number) {
  std::vector<double> values(count, nan);
  for (std::size_t k = 0; k < things.size(); ++k) values[k] = number(things[k]);
  return values;
}

/// All in one go over the results, which are larger than a cache.
std::map<std::string, Array> df_arrays(const DfSection& grid, const std::vector<DescribingFunction>& results) {
  const std::vector<std::size_t> shape{grid.amplitude.size(), grid.frequency.size(), grid.bias.size()};
  std::vector<std::complex<double>> gain(grid.size(), {nan, nan});
  std::vector<double> mean(grid.size(), nan), dissipation = mean, error = mean;
  for (std::size_t k = 0; k < results.size(); ++k) {
    const DescribingFunction& one = results[k];
    if (!one.answered()) continue;
    gain[k] = one.gain;
    mean[k] = one.mean;
    dissipation[k] = one.dissipation;
    error[k] = one.error;
  }
  return {{"amplitude", line(grid.amplitude)}, {"frequency", line(grid.frequency)},
          {"bias", line(grid.bias)},           {"gain", {shape, std::move(gain)}},
          {"mean", {shape, std::move(mean)}},  {"dissipation", {shape, std::move(dissipation)}},
          {"error", {shape, std::move(error)}}};
}

Array rows_of(const Simulation& run) {
  std::vector<double> values;
  values.reserve(run.rows.size() * run.columns.size());
  for (const auto& row : run.rows) values.insert(values.end(), row.begin(), row.end());
  return {{run.rows.size(), run.columns.size()}, std::move(values)};
}

std::map<std::string, Array> map_arrays(const HuntingMap& map) {
  const std::vector<std::size_t> shape{static_cast<std::size_t>(map.y.points), static_cast<std::size_t>(map.x.points)};
  const auto over = [&](const auto& member) {
    return Array{shape, each(map.points, map.size(),
                             [&](const auto& point) { return point ? static_cast<double>((*point).*member) : nan; })};
  };
  return {{"amplitude", over(&MapPoint::amplitude)},
          {"period", over(&MapPoint::period)},
          {"cycles", over(&MapPoint::cycles)},
          {"stable", over(&MapPoint::stable)}};
}

}  // namespace

Answer predict_answer(const Question& question) {
  const auto report = computed([&] { return ask_predict(*question.from, question.asking, false); });
  Sheet sheet = sheet_of(question, report->status);
  sheet.last.clear();  // the notes say it
  Answer answer = documents(sheet, report, predict_json, predict_csv, predict_document);
  const auto with_curves = std::make_shared<ReportWithCurves>(question.from, report);
  answer.picture = [=] { return drawn(sheet, with_curves->get(), predict_picture)(); };
  answer.page = [=] { return paged(sheet, with_curves->get(), predict_page)(); };
  answer.arrays = [=] { return nyquist_arrays(with_curves->get()->nyquist); };
  return answer;
}

Answer df_answer(const Question& question) {
  const auto from = question.from;
  need_memory_for(need_df(*from), {});
  const auto results = computed([&] { return ask_df(*from, *from->df, question.asking); });
  Sheet sheet = sheet_of(question, results->size() < from->df->size() ? Status::interrupted : Status::converged);
  sheet.made.isa = to_string(question.asking.isa);
  sheet.last.clear();
  Answer answer = documents(
      sheet, results, [=](const auto& made, const auto& all) { return df_json(made, from->df->points(), all); },
      [=](const auto& all) { return df_csv(from->df->points(), all); },
      [=](const std::string& title, const auto& all) { return df_document(title, from->df->points(), all); });
  answer.arrays = [=] { return df_arrays(*from->df, *results); };
  return answer;
}

Answer simulate_answer(const Question& question, bool check, bool audit) {
  need_memory_for(*question.from, {});
  const auto answered = computed([&] { return ask_simulate(*question.from, check, audit, question.asking); });
  const Sheet sheet = sheet_of(question, answered->run.status);
  Answer answer = documents(
      sheet, answered,
      [](const auto& made, const auto& all) { return simulate_json(made, all.run, all.second, all.energy); },
      [](const auto& all) { return simulate_csv(all.run); },
      [=](const std::string& title, const SimulateAnswer& all) {
        const Units units = units_of_sheet(sheet, all.run);
        return simulate_document(title, in_units(all.run, units), all.second, all.energy, units);
      });
  answer.columns = answered->run.columns;
  answer.arrays = [=] { return std::map<std::string, Array>{{"rows", rows_of(answered->run)}}; };
  return answer;
}

Answer continue_answer(const Question& question, const std::string& path, double low, double high) {
  const CaseNumber number = number_at(*question.from, "parameter", path);
  const auto report = computed([&] {
    return ContinueReport{path, number.unit, ask_continue(*question.from, number, low, high, question.asking)};
  });
  const Sheet sheet = sheet_of(question, report->found.status);
  Answer answer = documents(sheet, report, continue_json, continue_csv, continue_document);
  answer.picture = drawn(sheet, report, continue_picture);
  answer.page = paged(sheet, report, continue_page);
  return answer;
}

Answer margin_answer(const Question& question, const std::vector<std::string>& paths, double factor,
                     const std::vector<Toward>& toward) {
  const MarginWishes wishes{paths, toward, factor};
  const auto report = computed([&] { return ask_margin(*question.from, wishes, question.asking); });
  const Sheet sheet = sheet_of(question, report->status);
  Answer answer = documents(sheet, report, margin_json, margin_csv, margin_document);
  answer.page = paged(sheet, report, margin_page);
  return answer;
}

Answer map_answer(const Question& question, const MapAxis& x, const MapAxis& y, const std::vector<std::string>& methods,
                  bool outcomes, int starts) {
  const Methods chosen = outcomes ? no_methods : map_methods("methods", methods);
  const MapReport empty = map_over(*question.from, x, y, chosen, "");
  Status ended = Status::converged;
  const auto report = computed([&] {
    MapReport made = empty;
    ended = ask_map(*question.from, made.map, chosen, starts, {}, question.asking, sweep_in_memory(question.asking));
    return made;
  });
  Sheet sheet = sheet_of(question, ended);
  if (outcomes) sheet.made.isa = to_string(question.asking.isa);
  Answer answer = documents(
      sheet, report, [=](const auto& made, const auto& all) { return map_json(made, all, ended); }, map_csv,
      map_document);
  answer.picture = drawn(sheet, report, map_picture);
  answer.page = paged(sheet, report, map_page, flags_of(report->map, !methods.empty(), starts));
  answer.arrays = [=] { return map_arrays(report->map); };
  return answer;
}

Answer sensitivity_answer(const Question& question, const SensitivityWishes& wishes) {
  threshold_numbers(*question.from, "thresholds", wishes.thresholds);  // reports errors before anything is computed
  need_memory_for(wishes, spread_of(*question.from, question.asking), "");
  Status ended = Status::converged;
  const auto report = computed([&] {
    return ask_sensitivity(*question.from, wishes, question.asking, sweep_in_memory(question.asking), ended);
  });
  Sheet sheet = sheet_of(question, ended);
  sheet.made.isa = to_string(question.asking.isa);
  Answer answer = documents(
      sheet, report, [=](const auto& made, const auto& all) { return sensitivity_json(made, all, ended); },
      sensitivity_csv, sensitivity_document);
  answer.page = paged(sheet, report, sensitivity_page, flags_of(wishes, question.asking.seed));
  return answer;
}

Answer dissipativity_answer(const Question& question, const DissipativityWishes& wishes) {
  const auto report = computed([&] { return ask_dissipativity(*question.from, wishes, question.asking); });
  const Sheet sheet = sheet_of(question, report->status);
  Answer answer = documents(sheet, report, dissipativity_json, dissipativity_csv, dissipativity_document);
  answer.page = [=] { return dissipativity_page(*report, sheet.made, sheet.case_text(), flags_of(wishes)); };
  return answer;
}

Answer remedy_answer(const Question& question, const RemedyWishes& wishes) {
  chosen_remedies(*question.from, "only", wishes.only);  // reports errors before anything is computed
  const auto report = computed([&] { return ask_remedy(*question.from, wishes, question.asking); });
  const Sheet sheet = sheet_of(question, report->status);
  Answer answer = documents(sheet, report, remedy_json, remedy_csv, remedy_document);
  answer.page = paged(sheet, report, remedy_page);
  answer.applied = [=](const std::string& name) {
    auto overrides = sheet.from->overrides;
    for (const auto& one : overrides_of_remedy(*report, name)) overrides.push_back(one);
    return read_again(*sheet.from, overrides);
  };
  return answer;
}

Answer tune_answer(const Question& question, const TuneWishes& wishes) {
  tune_numbers(*question.from, wishes);  // reports errors before anything is computed
  const auto report = computed([&] { return ask_tune(*question.from, wishes, question.asking); });
  const Sheet sheet = sheet_of(question, report->status);
  Answer answer = documents(sheet, report, tune_json, tune_csv, tune_document);
  answer.picture = drawn(sheet, report, tune_picture);
  answer.page = paged(sheet, report, tune_page, flags_of(wishes, question.asking.seed));
  answer.applied = [=](const std::string&) {
    auto overrides = sheet.from->overrides;
    for (const auto& one : overrides_of_tuning(*report)) overrides.push_back(one);
    return read_again(*sheet.from, overrides);
  };
  return answer;
}

Answer identify_answer(const Question& question, bool plan) {
  const auto report = computed([&] { return ask_identify(*question.from, plan, question.asking); });
  const Sheet sheet = sheet_of(question, report->status);
  Answer answer = documents(sheet, report, identify_json, identify_csv, identify_document);
  answer.picture = [=] { return identify_picture(*report); };
  answer.applied = [=](const std::string&) {
    return read_case(fitted_text(*sheet.from, *report, sheet.from->file), sheet.from->file);
  };
  return answer;
}

}  // namespace limcycle::python
