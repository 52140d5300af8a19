#include "limcycle/reports/frame.hpp"

#include "limcycle/reports/json_values.hpp"

namespace limcycle {
namespace {

Json head(const std::string& command, const Provenance& provenance) {
  const auto text_or_null = [](const std::string& text) { return text.empty() ? Json(nullptr) : Json(text); };
  return {{"schema", "limcycle/1"},
          {"command", command},
          {"case",
           {{"title", text_or_null(provenance.title)},
            {"file", text_or_null(provenance.file)},
            {"sha256", text_or_null(provenance.sha256)}}},
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

/// The members, one a line; of a list of structures one structure a line. The closing brace is left to the caller.
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

}  // namespace

std::string json_document(const std::string& command, const Provenance& provenance, const std::string& body) {
  Json top = head(command, provenance);
  const Json members = Json::parse(body);
  for (const auto& [key, value] : members.items()) top[key] = value;
  return framed(top) + "\n}\n";
}

std::string json_beginning(const std::string& command, const Provenance& provenance) {
  return framed(head(command, provenance));
}

std::string csv_line(const std::vector<std::string>& fields) {
  std::string line;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (i > 0) line += ',';
    if (fields[i].find_first_of(",\"\r\n") == std::string::npos) {
      line += fields[i];
      continue;
    }
    line += '"';
    for (const char c : fields[i]) line += c == '"' ? std::string("\"\"") : std::string(1, c);
    line += '"';
  }
  return line + '\n';
}

}  // namespace limcycle
