#include "limcycle/reports/figures/drawing/plotly.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cctype>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>

namespace {

std::string read_source(const std::string& name) {
  std::ifstream stream(std::string(LIMCYCLE_SOURCE_DIR) + "/" + name);
  REQUIRE(stream);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

std::string lower_case(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return result;
}

}  // namespace

TEST_CASE("the embedded script is the whole of the pinned file") {
  const std::string script(limcycle::plotly_script());
  // Compared outside the assertion: on failure Catch would print both texts.
  const bool same = script == read_source("node_modules/plotly.js-cartesian-dist-min/plotly-cartesian.min.js");
  CHECK(same);

  std::smatch pinned;
  const std::string package = read_source("package.json");
  REQUIRE(std::regex_search(package, pinned, std::regex(R"re("plotly\.js-cartesian-dist-min": "([0-9.]+)")re")));
  const std::string banner = script.substr(0, 200);
  CHECK_THAT(banner, Catch::Contains("plotly.js (cartesian - minified) v" + pinned[1].str() + "\n"));
  CHECK_THAT(banner, Catch::Contains("MIT license"));
}

TEST_CASE("the embedded script cannot end the element it stands in") {
  const std::string script = lower_case(limcycle::plotly_script());
  REQUIRE(script.size() > 1'000'000);
  CHECK(script.find("</script") == std::string::npos);
  // `<!--` followed by `<script` would make the browser ignore the closing tag.
  CHECK(script.find("<!--") == std::string::npos);
  CHECK(script.find('\0') == std::string::npos);
}
