#pragma once
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "limcycle/tests/cli/program.hpp"

namespace limcycle::test {

/// Tolerance for numbers under a key: |a - b| <= relative |b| + absolute.
struct Nearness {
  double relative = 1e-6, absolute = 1e-12;
};

inline Nearness nearness(const std::string& key) {
  if (key == "period" || key == "amplitude" || key == "first_harmonic" || key == "frequency") return {1e-7, 0.0};
  if (key == "multipliers") return {1e-3, 1e-4};
  if (key == "offset") return {1e-6, 1e-7};
  if (key == "sticking_fraction") return {1e-2, 1e-4};
  if (key == "steps") return {0.5, 0.0};                 // costs, not results
  if (key == "rows" || key == "t") return {1e-4, 1e-4};  // of a simulation at its default tolerance
  if (key == "harmonics" || key == "gain" || key == "mean") return {2e-6, 1e-9};
  return {};
}

/// Text that may differ from one machine, commit or folder to the next.
inline bool free_text(const std::string& key) {
  static const std::set<std::string> keys = {"version", "commit", "compiler", "build_type", "file", "sha256", "isa"};
  return keys.contains(key);
}

/// True for error estimates, which may differ, but not be worse by orders of magnitude.
inline bool estimate(const std::string& key) {
  return key == "error" || key == "residual" || key == "phase_drift" || key.ends_with("_difference");
}

/// First difference of a document from its golden one, with its path; empty: none. Keys must be the same, in the same
/// order; numbers must agree within tolerance, other values exactly.
inline std::string difference(const nlohmann::ordered_json& golden, const nlohmann::ordered_json& actual,
                              const std::string& path = "", const std::string& key = "") {
  const auto differ = [&](const std::string& what) {
    return path + ": " + what + "; expected " + golden.dump() + ", got " + actual.dump();
  };
  if (golden.is_number() && actual.is_number()) {
    const double expected = golden, got = actual;
    if (estimate(key)) return got >= 0.0 && got <= 100.0 * std::abs(expected) + 1e-9 ? "" : differ("estimate");
    const Nearness near = nearness(key);
    return std::abs(got - expected) <= near.relative * std::abs(expected) + near.absolute ? "" : differ("number");
  }
  if (golden.type() != actual.type()) return differ("type");
  if (golden.is_string()) return golden == actual || (free_text(key) && !actual.empty()) ? "" : differ("text");
  if (!golden.is_structured()) return golden == actual ? "" : differ("value");
  if (golden.size() != actual.size()) return differ("size");
  auto one = golden.items().begin();
  for (const auto& [name, value] : actual.items()) {
    if (one.key() != name) return differ("key " + one.key() + " against " + name);
    const std::string& inner = golden.is_object() ? name : key;
    if (const auto found = difference(one.value(), value, path + "/" + name, inner); !found.empty()) return found;
    ++one;
  }
  return "";
}

struct Golden {
  std::string name;
  std::vector<std::string> arguments;
  nlohmann::ordered_json document;
};

/// The golden documents of one command, as listed in golden/commands.txt. tools/goldens makes them.
inline std::vector<Golden> goldens_of(const std::string& command) {
  const std::string source = LIMCYCLE_SOURCE_DIR, folder = source + "/tests/cli/golden/";
  std::ifstream list(folder + "commands.txt");
  std::vector<Golden> out;
  for (std::string line; std::getline(list, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream words(line);
    Golden one;
    words >> one.name;
    for (std::string word; words >> word;)
      one.arguments.push_back(word.starts_with("cases/") ? source + "/" + word : word);
    if (one.arguments.empty() || one.arguments[0] != command) continue;
    std::ifstream file(folder + one.name + ".json");
    if (!file) throw std::runtime_error("no golden document " + one.name + ": run tools/goldens");
    one.document = nlohmann::ordered_json::parse(file);
    out.push_back(std::move(one));
  }
  if (out.empty()) throw std::runtime_error("no golden document of " + command);
  return out;
}

/// Runs the commands again, and compares their output with their golden documents.
inline void check_goldens(const std::string& command) {
  for (const auto& golden : goldens_of(command)) {
    auto arguments = golden.arguments;
    arguments.insert(arguments.end(), {"--json", "-"});
    const auto ran = run(arguments);
    INFO(golden.name);
    REQUIRE(ran.code == 0);
    CHECK(ran.err.empty());
    CHECK(difference(golden.document, nlohmann::ordered_json::parse(ran.out)) == "");
  }
}

}  // namespace limcycle::test
