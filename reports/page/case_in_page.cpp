#include "limcycle/reports/page/case_in_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "limcycle/reports/figures/figures.hpp"
#include "limcycle/reports/format/json_values.hpp"

namespace limcycle {
namespace {

constexpr std::string_view schema_of_case = "limcycle/";
constexpr int newest_schema = 1;

std::string beginning_of(const std::string& id) { return R"(<script type="application/json" id=")" + id + "\">"; }

/// Content of the script element with an id; the page must contain the element at most once.
std::string element_text(std::string_view page, const std::string& id) {
  const std::string begin = beginning_of(id);
  const auto at = page.find(begin);
  if (at == std::string_view::npos) return "";
  if (page.find(begin, at + 1) != std::string_view::npos)
    throw PageError("was altered: it holds more than one element '" + id + "'");
  const auto from = at + begin.size();
  const auto to = page.find("</script>", from);
  if (to == std::string_view::npos) throw PageError("is cut off: the element '" + id + "' has no end");
  return std::string(page.substr(from, to - from));
}

Json parsed(const std::string& text, const std::string& id) {
  Json document = Json::parse(text, nullptr, false);
  if (!document.is_object()) throw PageError("was altered: its element '" + id + "' is not the JSON it was");
  return document;
}

/// Rejects a document whose schema this program does not know.
void check_schema(const Json& document) {
  const std::string schema = document.value("schema", "");
  const std::string number = schema.starts_with(schema_of_case) ? schema.substr(schema_of_case.size()) : "";
  if (number.empty() || number.size() > 6 || number.find_first_not_of("0123456789") != std::string::npos)
    throw PageError("was altered: its case has no schema that limcycle knows");
  if (std::stoi(number) > newest_schema)
    throw PageError(fmt::format("was written by a newer limcycle ({}, schema {}): use that version or a later one",
                                document.value("version", "version unknown"), schema));
}

/// Checks that the result is that of the same case.
void check_result(std::string_view page, const Json& from) {
  const std::string text = element_text(page, "result");
  if (text.empty()) return;
  const Json result = parsed(text, "result");
  const Json named = result.value("case", Json::object()), made = result.value("provenance", Json::object());
  const auto same = [&](const char* key) {  // an empty value is null in a document
    const Json one = named.value(key, Json()), other = from.value(key, Json());
    return one == other || (one.is_null() && other.is_string() && other.get_ref<const std::string&>().empty());
  };
  if (!same("sha256") || !same("file") || made.value("overrides", Json()) != from.value("overrides", Json()))
    throw PageError("was altered: its case is not the one of its result");
}

bool close(const Json& a, const Json& b, double share) {
  if (!a.is_number() || !b.is_number()) return a == b;
  const double x = a.get<double>(), y = b.get<double>();
  return std::abs(x - y) <= share * std::max(std::abs(x), std::abs(y));
}

bool same_words(const Json& a, const Json& b, const char* list, const std::vector<const char*>& keys) {
  const Json one = a.value(list, Json::array()), other = b.value(list, Json::array());
  if (one.size() != other.size()) return false;
  for (std::size_t i = 0; i < one.size(); ++i)
    for (const char* key : keys)
      if (one[i].value(key, Json()) != other[i].value(key, Json())) return false;
  return true;
}

bool same_cycles(const Json& a, const Json& b) {
  const Json one = a.value("cycles", Json::array()), other = b.value("cycles", Json::array());
  if (one.size() != other.size()) return false;
  for (std::size_t i = 0; i < one.size(); ++i) {
    const double share = 1e-6 + 10.0 * std::max(one[i].value("error", 0.0), other[i].value("error", 0.0));
    if (one[i].value("stable", Json()) != other[i].value("stable", Json())) return false;
    for (const char* key : {"period", "amplitude"})
      if (!close(one[i].value(key, Json()), other[i].value(key, Json()), share)) return false;
  }
  return true;
}

}  // namespace

std::string case_element(const Provenance& provenance, const std::string& case_text, const std::string& command,
                         const std::string& flags) {
  const Json data{{"schema", std::string(schema_of_case) + std::to_string(newest_schema)},
                  {"version", provenance.version},
                  {"command", command},
                  {"flags", flags},
                  {"file", provenance.file},
                  {"sha256", provenance.sha256},
                  {"overrides", provenance.overrides},
                  {"text", case_text}};
  return beginning_of("case") + figure_data(json_text(data)) + "</script>\n";
}

std::string result_element(const std::string& document) {
  return beginning_of("result") + figure_data(document) + "</script>\n";
}

CaseInPage case_in_page(std::string_view page) {
  const std::string text = element_text(page, "case");
  if (text.empty()) throw PageError("is not a limcycle page with an embedded case");
  const Json data = parsed(text, "case");
  try {
    check_schema(data);
    check_result(page, data);
    return {data.at("version"), data.at("command"),   data.at("flags"), data.at("file"),
            data.at("sha256"),  data.at("overrides"), data.at("text")};
  } catch (const Json::exception&) {
    throw PageError("was altered: its case is not complete");
  }
}

std::string result_in_page(std::string_view page) { return element_text(page, "result"); }

bool same_result(const std::string& one, const std::string& other) {
  const Json a = Json::parse(one, nullptr, false), b = Json::parse(other, nullptr, false);
  if (!a.is_object() || !b.is_object()) return false;
  try {
    return same_cycles(a, b) && same_words(a, b, "predictions", {"method", "verdict", "cycle"}) &&
           same_words(a, b, "missed", {"method", "cycle"}) && same_words(a, b, "outcomes", {"start", "outcome"});
  } catch (const Json::exception&) {
    return false;
  }
}

}  // namespace limcycle
