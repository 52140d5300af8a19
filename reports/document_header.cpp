#include "limcycle/reports/document_header.hpp"

#include <fmt/format.h>

#include <charconv>

#include "limcycle/reports/format/json_values.hpp"

namespace limcycle {
namespace {

/// A plant that is known by measured data, and the fit that stands for it in time.
Json measured_json(const MeasuredPlantAt& plant) {
  const FrequencyData& data = plant.response->data();
  const VectorFit& fit = plant.response->fit();
  return {{"path", plant.path},
          {"file", data.file},
          {"sha256", text_or_null(data.sha256)},
          {"points", data.size()},
          {"frequency", {data.frequency.front(), data.frequency.back()}},
          {"order", fit.shape.order},
          {"poles_at_zero", fit.shape.poles_at_zero},
          {"relative_degree", fit.shape.relative_degree},
          {"delay", plant.response->delay()},
          {"error", {{"rms", fit.error.rms}, {"largest", fit.error.largest}, {"at", fit.error.at}}},
          {"deviations", or_null(fit.error.deviations)}};
}

Json case_json(const Provenance& provenance) {
  Json made{{"title", text_or_null(provenance.title)},
            {"file", text_or_null(provenance.file)},
            {"sha256", text_or_null(provenance.sha256)},
            {"measured", Json::array()},
            {"curves", Json::array()},
            {"matrices", Json::array()}};
  for (const MeasuredPlantAt& plant : provenance.measured) made["measured"].push_back(measured_json(plant));
  for (const CurveFile& curve : provenance.curves)
    made["curves"].push_back(
        {{"path", curve.path}, {"file", curve.file}, {"sha256", curve.sha256}, {"points", curve.points}});
  for (const MatrixFile& one : provenance.matrices)
    made["matrices"].push_back(
        {{"path", one.path}, {"file", one.file}, {"sha256", one.sha256}, {"variables", one.variables}});
  return made;
}

Json head(const std::string& command, const Provenance& provenance) {
  return {{"schema", "limcycle/1"},
          {"command", command},
          {"case", case_json(provenance)},
          {"provenance",
           {{"version", provenance.version},
            {"commit", provenance.commit},
            {"compiler", provenance.compiler},
            {"build_type", provenance.build_type},
            {"seed", provenance.seed},
            {"isa", provenance.isa},
            {"threads", provenance.threads},
            {"overrides", provenance.overrides}}}};
}

/// The members, one a line; of a list of structures, one structure a line. The caller adds the closing brace.
std::string framed(const Json& top) {
  std::string text = "{";
  bool first = true;
  for (const auto& [key, value] : top.items()) {
    text += std::exchange(first, false) ? "\n  " : ",\n  ";
    text += json_text(key) + ": ";
    if (!value.is_array() || value.empty() || !value.front().is_structured()) {
      text += json_text(value);
      continue;
    }
    for (std::size_t i = 0; i < value.size(); ++i) text += (i == 0 ? "[\n    " : ",\n    ") + json_text(value[i]);
    text += "\n  ]";
  }
  return text;
}

/// JSON escape of a character that controls a terminal; empty for any other. `text` begins with a character.
std::string steering_escape(std::string_view text) {
  const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U; };
  const unsigned a = byte(0), b = byte(1), c = byte(2);
  unsigned code = 0;
  if (a == 0x7F) code = a;
  if ((a == 0xC2 && b < 0xA0) || (a == 0xD8 && b == 0x9C)) code = (a & 0x1FU) << 6 | (b & 0x3FU);
  if (a == 0xE2) code = 0x2000U | (b & 0x3FU) << 6 | (c & 0x3FU);
  const bool general = code < 0x2000 || code == 0x200E || code == 0x200F || (code >= 0x2028 && code <= 0x202E) ||
                       (code >= 0x2066 && code <= 0x2069);
  return code != 0 && general ? fmt::format("\\u{:04x}", code) : std::string();
}

}  // namespace

std::string json_text(const Json& document) {
  const std::string plain = document.dump(-1, ' ', false, Json::error_handler_t::replace);
  std::string text;
  text.reserve(plain.size());
  for (std::size_t i = 0; i < plain.size(); ++i) {
    const std::string escape =
        static_cast<unsigned char>(plain[i]) < 0x7F ? "" : steering_escape(std::string_view(plain).substr(i));
    if (escape.empty())
      text += plain[i];
    else
      text += escape, i += plain[i] == '\x7F' ? 0 : plain[i] == '\xE2' ? 2 : 1;
  }
  return text;
}

std::string_view status_word(const Provenance& provenance, Status status) {
  return status == Status::interrupted && provenance.time_is_over ? "time-limit" : to_string(status);
}

std::string json_document(const std::string& command, const Provenance& provenance, const std::string& body) {
  Json top = head(command, provenance);
  const Json members = Json::parse(body);
  for (const auto& [key, value] : members.items()) top[key] = value;
  if (top.contains("status") && top["status"] == to_string(Status::interrupted))
    top["status"] = status_word(provenance, Status::interrupted);
  return framed(top) + "\n}\n";
}

std::string json_beginning(const std::string& command, const Provenance& provenance) {
  return framed(head(command, provenance));
}

namespace {

/// True if a spreadsheet would evaluate the field. Numbers begin with a sign too.
bool looks_like_formula(const std::string& field) {
  if (field.empty() || std::string_view("=+-@\t\r").find(field.front()) == std::string_view::npos) return false;
  double number = 0.0;
  const char* const end = field.data() + field.size();
  const auto read = std::from_chars(field.data() + (field.front() == '+' ? 1 : 0), end, number);
  return read.ptr != end || read.ec == std::errc::invalid_argument;
}

}  // namespace

std::string csv_line(const std::vector<std::string>& fields) {
  std::string line;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (i > 0) line += ',';
    // Spreadsheets use this mark for a field that is to stay a text.
    const std::string field = (looks_like_formula(fields[i]) ? "'" : "") + fields[i];
    if (field.find_first_of(",\"\r\n") == std::string::npos) {
      line += field;
      continue;
    }
    line += '"';
    for (const char c : field) line += c == '"' ? std::string("\"\"") : std::string(1, c);
    line += '"';
  }
  return line + '\n';
}

}  // namespace limcycle
