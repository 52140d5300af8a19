#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

#include "limcycle/analysis/study/identify/record/friction_response.hpp"
#include "limcycle/cases/loader/data/data_file.hpp"
#include "limcycle/cases/loader/sections/sections.hpp"
#include "limcycle/models/catalogue.hpp"

namespace limcycle::case_file {
namespace {

constexpr std::size_t most_records = 100;
constexpr std::string_view quantities[] = {"time", "position", "velocity", "force"};
constexpr std::string_view force_holds[] = {"linear", "zero-order"};
constexpr std::string_view losses[] = {"squares", "huber"};

Element read_law(const Place& place) {
  const std::string name = read_string(place);
  const auto& known = identified_kinds();
  if (std::ranges::find(known, name) == known.end()) {
    const bool exists = find_kind(catalogue_of_elements().friction_laws, name) != nullptr;
    throw place.error(exists ? "cannot be identified yet" : "unknown friction law",
                      exists ? "known: " + joined(known) : suggest(name, known));
  }
  return *find_kind(catalogue_of_elements().friction_laws, name);
}

std::vector<Element> read_laws(const std::optional<Place>& place) {
  std::vector<Element> laws;
  if (!place) {
    for (const auto& kind : identified_kinds()) laws.push_back(*find_kind(catalogue_of_elements().friction_laws, kind));
    return laws;
  }
  const auto* list = place->value.as<Value::List>();
  if (list == nullptr) return {read_law(*place)};
  if (list->empty()) throw place->error("must not be empty");
  for (std::size_t i = 0; i < list->size(); ++i) {
    laws.push_back(read_law(place->item(i)));
    for (std::size_t k = 0; k < i; ++k)
      if (laws[k].kind() == laws[i].kind()) throw place->item(i).error("stands twice in the list");
  }
  return laws;
}

std::vector<std::string> kind_names() { return {std::begin(record_kinds), std::end(record_kinds)}; }

RecordFile read_record(const Section& section) {
  section.allow({"kind", "file", "time", "position", "velocity", "force", "weight", "scale", "skip", "force_limit",
                 "hold", "loss"});
  RecordFile record;
  const Place kind = section.at("kind", "which experiment: " + joined(kind_names()));
  record.kind = static_cast<RecordKind>(read_choice(kind, record_kinds));
  record.path = section.document().beside(read_string(section.at("file", "with the columns of the record")));
  for (std::size_t k = 0; k < std::size(quantities); ++k)
    if (const auto key = section.find(quantities[k])) record.columns[k] = read_column(*key);
  if (const auto scale = section.section("scale")) {
    scale->allow({"time", "position", "velocity", "force"});
    for (std::size_t k = 0; k < std::size(quantities); ++k) record.scale[k] = read_scale(scale, quantities[k]);
    if (record.scale[0] < 0.0) throw scale->at("time", "").error("must be > 0");
  }
  if (const auto skip = section.find("skip")) record.skip = read_number(*skip, not_negative, "s");
  if (const auto limit = section.find("force_limit")) {
    if (is_free(record.kind))
      throw limit->error("is a limit of a friction force, which a free motion does not measure");
    record.force_limit = read_number(*limit, positive, "N");
  }
  if (const auto force = section.find("force"); force && record.kind == RecordKind::free_decay)
    throw force->error("is not read for free-decay, which moves without a force; the kind for a driven rig is free");
  if (const auto hold = section.find("hold")) {
    if (record.kind != RecordKind::free) throw hold->error("says how the applied force of a free record goes on");
    record.holds_force = read_choice(*hold, force_holds) == 1;
  }
  if (const auto weight = section.find("weight")) record.weight = read_column(*weight);
  if (const auto loss = section.find("loss")) {
    record.huber = read_choice(*loss, losses) == 1;
    if (record.huber && is_free(record.kind))
      throw loss->error("is for a friction force that was measured; a free motion is fitted by squares");
  }
  return record;
}

/// The laws that have a number of this name. Throws if there is none, or it is no number there.
std::vector<const ParameterRow*> rows_named(const std::string& key, const std::vector<Element>& laws,
                                            const Place& place) {
  std::vector<const ParameterRow*> found;
  std::vector<std::string> known;
  std::string list_of;
  for (const auto& law : laws) {
    const auto values = law.values();
    for (std::size_t i = 0; i < values.size(); ++i) {
      const auto& row = law.parameters()[i];
      const bool number = std::holds_alternative<double>(values[i]);
      if (row.key == key && number) found.push_back(&row);
      if (row.key == key && !number) list_of = law.kind();
      if (number && std::ranges::find(known, row.key) == known.end()) known.emplace_back(row.key);
    }
  }
  if (found.empty() && !list_of.empty()) throw place.error("is no single number of " + list_of);
  if (found.empty()) throw place.error("is a number of none of the laws", suggest(key, known));
  return found;
}

FreeChoice read_choice_of_numbers(const Section& section, const std::vector<Element>& laws) {
  FreeChoice choice;
  if (const auto free = section.find("free")) {
    const auto* list = free->value.as<Value::List>();
    if (list == nullptr) throw free->wrong_type("a list of names");
    for (std::size_t i = 0; i < list->size(); ++i) {
      choice.free.push_back(read_string(free->item(i)));
      rows_named(choice.free.back(), laws, free->item(i));
    }
  }
  if (const auto fixed = section.section("fixed"))
    for (const auto& entry : fixed->table()) {
      const Place place = *fixed->find(entry.key);
      for (const auto* row : rows_named(entry.key, laws, place)) read_number(place, row->range, row->unit);
      if (std::ranges::find(choice.free, entry.key) != choice.free.end()) throw place.error("is in `free` too");
      choice.fixed.emplace_back(entry.key, read_number(place));
    }
  if (const auto elements = section.find("elements")) choice.elements = read_integer(*elements, 1, 12);
  return choice;
}

}  // namespace

IdentifySection read_identify(const Section& section) {
  section.allow({"law", "record", "free", "fixed", "elements"});
  IdentifySection result;
  result.laws = read_laws(section.find("law"));
  result.choice = read_choice_of_numbers(section, result.laws);
  const Place records = section.at("record", "at least one [[identify.record]] with kind and file");
  const auto* list = records.value.as<Value::List>();
  if (list == nullptr) throw records.wrong_type("a list of tables, [[identify.record]]");
  if (list->empty() || list->size() > most_records)
    throw records.error("must have 1 to " + std::to_string(most_records) + " records");
  for (std::size_t i = 0; i < list->size(); ++i) {
    const Place one = records.item(i);
    result.records.push_back(read_record(Section(one.document, one.value, one.path)));
  }
  return result;
}

}  // namespace limcycle::case_file

namespace limcycle {
namespace {

constexpr std::size_t most_rows = 2'000'000;

/// True for a column that a record of this kind cannot do without.
bool needs(RecordKind kind, std::size_t quantity) {
  switch (quantity) {
    case 0:
      return kind != RecordKind::steady_velocity;
    case 2:
      return kind == RecordKind::steady_velocity;
    case 3:
      return kind != RecordKind::free_decay;
    default:
      return false;
  }
}

/// "mm/s" of a column called "velocity [mm/s]"; empty without one.
std::string_view unit_in(std::string_view header) {
  const auto open = header.find_first_of("[("), close = header.find_last_of("])");
  if (open == std::string_view::npos || close == std::string_view::npos || close < open) return {};
  return header.substr(open + 1, close - open - 1);
}

/// A unit of thousandths or the like needs a scale.
void check_unit(const CsvReader& csv, std::size_t column, std::string_view quantity, double scale) {
  static const std::map<std::string_view, double> in_si{
      {"mm", 1e-3}, {"um", 1e-6}, {"\u00b5m", 1e-6}, {"\u03bcm", 1e-6}, {"nm", 1e-9},   {"cm", 1e-2},
      {"ms", 1e-3}, {"us", 1e-6}, {"min", 60.0},     {"mm/s", 1e-3},    {"um/s", 1e-6}, {"cm/s", 1e-2},
      {"mN", 1e-3}, {"kN", 1e3},  {"uN", 1e-6},      {"mN m", 1e-3},    {"mNm", 1e-3},  {"deg", 0.017453292519943295}};
  if (column >= csv.header().size() || scale != 1.0) return;
  const auto unit = in_si.find(unit_in(csv.header()[column]));
  if (unit == in_si.end()) return;
  throw csv.error(fmt::format("the column \"{}\" is in {}: state scale = {{{} = {}}} beside the file",
                              csv.header()[column], unit->first, quantity, unit->second));
}

/// `before`: rows of other records.
FrictionRecord read_record_file(const RecordFile& from, std::size_t before) {
  CsvReader csv(from.path);
  std::vector<CsvColumn> chosen;
  std::vector<std::size_t> quantity;  // of each column chosen
  for (std::size_t k = 0; k < from.columns.size(); ++k) {
    const CsvColumn column = from.columns[k].value_or(std::string(case_file::quantities[k]));
    const bool read = k != 3 || from.kind != RecordKind::free_decay;
    const bool needed = from.columns[k] || needs(from.kind, k);
    if (!read || (!needed && !csv.has(column))) continue;
    chosen.push_back(column);
    quantity.push_back(k);
  }
  constexpr std::size_t weight = 4;
  if (from.weight) {
    chosen.push_back(*from.weight);
    quantity.push_back(weight);
  }
  csv.choose(chosen);
  for (std::size_t i = 0; i < quantity.size() && quantity[i] != weight; ++i)
    check_unit(csv, csv.chosen()[i], case_file::quantities[quantity[i]], from.scale[quantity[i]]);
  std::array<std::vector<double>, 5> columns;
  const auto& counted = columns[quantity.back()];
  for (std::vector<double> row; csv.next(row);) {
    if (before + counted.size() == most_rows)
      throw csv.error("is beyond the 2 million rows that all records may have: keep every n-th");
    for (std::size_t i = 0; i < row.size(); ++i) {
      const double value = row[i] * (quantity[i] == weight ? 1.0 : from.scale[quantity[i]]);
      if (!std::isfinite(value)) throw csv.error("has a number that is too large with this scale");
      columns[quantity[i]].push_back(value);
    }
  }
  if (counted.empty()) throw csv.error("is the last line, and no row of numbers was met");
  return {from.kind,
          from.path,
          std::move(columns[0]),
          std::move(columns[1]),
          std::move(columns[2]),
          std::move(columns[3]),
          from.skip,
          from.force_limit,
          from.holds_force,
          std::move(columns[weight]),
          from.huber};
}

}  // namespace

FreeRig rig_of(const Case& from) {
  const auto refused = [&](const std::string& key, const std::string& rule) {
    return InputError(
        {.file = from.file, .line = 0, .override = {}, .key = key, .value = {}, .rule = rule, .suggestion = {}});
  };
  if (!from.loop)
    throw refused("loop.plant",
                  "is required by records of kind free and free-decay: the plant that moves, with its "
                  "numbers");
  if (from.loop->diagram)
    throw refused("diagram", "has no single plant; records of kind free and free-decay need [loop.plant]");
  FreeRig rig{model_of(from.loop->plant), from.loop->load};
  if (const auto why = why_no_free_rig(rig.plant)) throw refused("loop.plant", *why);
  return rig;
}

IdentifyRequest identify_request(const Case& from) {
  if (!from.identify)
    throw InputError({.file = from.file,
                      .line = 0,
                      .override = {},
                      .key = "identify",
                      .value = {},
                      .rule = "is required by this command: add [identify] with law and [[identify.record]]",
                      .suggestion = {}});
  IdentifyRequest request{from.identify->laws, {}, from.identify->choice};
  std::size_t rows = 0;
  for (std::size_t i = 0; i < from.identify->records.size(); ++i) {
    const auto& record = from.identify->records[i];
    if (std::error_code failed; !std::filesystem::exists(record.path, failed))
      throw InputError({.file = from.file,
                        .line = 0,
                        .override = {},
                        .key = "identify.record[" + std::to_string(i) + "].file",
                        .value = {},
                        .rule = "no such file: " + record.path,
                        .suggestion = {}});
    request.records.push_back(read_record_file(record, rows));
    rows += std::max(request.records.back().t.size(), request.records.back().F.size());
    if (is_free(record.kind) && !request.rig) request.rig = rig_of(from);
  }
  return request;
}

}  // namespace limcycle
