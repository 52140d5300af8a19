#include "limcycle/reports/page/case_in_page.hpp"

#include <catch2/catch.hpp>

#include "limcycle/reports/html.hpp"
#include "limcycle/reports/json.hpp"
#include "limcycle/tests/reports/sample_report.hpp"

using namespace limcycle;
using Catch::Matchers::Contains;

namespace {

Provenance with_overrides() {
  Provenance from;
  from.version = "1.2.3";
  from.title = "title";
  from.file = "a \"case\".toml";
  from.sha256 = "0123";
  from.overrides = {"loop.plant.kind=\"mass\"", "a=</script>"};
  return from;
}

std::string replaced(std::string text, const std::string& what, const std::string& with) {
  const auto at = text.find(what);
  REQUIRE(at != std::string::npos);
  return text.replace(at, what.size(), with);
}

}  // namespace

TEST_CASE("case in a page: every byte of it comes back") {
  const std::vector<std::string> texts{"a = 1\n",
                                       "no newline at the end",
                                       "a\r\nb\rc\n\r",
                                       "</script><!-- & &lt; \" ' \\ ]]>",
                                       "\xEF\xBB\xBFω ≤ 日本 \xF0\x9F\x98\x80",
                                       "\t\x01\x7F\x1B \n\n",
                                       "<script type=\"application/json\" id=\"case\">"};
  for (const auto& text : texts) {
    const std::string page = predict_page(sample::relay(), with_overrides(), text, {});
    const CaseInPage found = case_in_page(page);
    CHECK(found.text == text);
    CHECK(found.file == with_overrides().file);
    CHECK(found.sha256 == "0123");
    CHECK(found.overrides == with_overrides().overrides);
    CHECK(found.command == "predict");
    CHECK(found.version == "1.2.3");
    CHECK(same_result(result_in_page(page), predict_json(with_overrides(), sample::relay())));
  }
}

TEST_CASE("case in a page: a page without a case, cut off, or with two of them is refused") {
  CHECK_THROWS_WITH(case_in_page("<html></html>"), "is not a limcycle page with an embedded case");
  CHECK_THROWS_WITH(case_in_page(""), Contains("is not a limcycle page"));
  CHECK_THROWS_AS(case_in_page(predict_page(sample::relay(), with_overrides(), "", {})), PageError);
  const std::string element = case_element(with_overrides(), "a = 1", "predict", "");
  CHECK_THROWS_WITH(case_in_page(element + element), Contains("was altered: it holds more than one"));
  CHECK_THROWS_WITH(case_in_page(element.substr(0, element.find("</script>"))), Contains("is cut off"));
}

TEST_CASE("case in a page: what was altered is refused with a reason") {
  const std::string page = predict_page(sample::relay(), with_overrides(), "a = 1", {});
  CHECK_NOTHROW(case_in_page(page));
  CHECK_THROWS_WITH(
      case_in_page(replaced(page, "\"overrides\":[\"loop.plant.kind=\\\"mass\\\"\"", "\"overrides\":[\"b=2\"")),
      "was altered: its case is not the one of its result");
  CHECK_THROWS_WITH(case_in_page(replaced(page, "\"sha256\":\"0123\"", "\"sha256\":\"0124\"")), Contains("its result"));
  CHECK_THROWS_WITH(case_in_page(replaced(page, "\"text\":\"a = 1\"", "\"text\":\"a")), Contains("not the JSON"));
  CHECK_THROWS_WITH(case_in_page(replaced(page, "\"text\":\"a = 1\"", "\"text\":7")), Contains("not complete"));
  CHECK_THROWS_WITH(case_in_page(replaced(page, "\"text\":\"a = 1\"", "\"words\":\"a\"")), Contains("not complete"));
  CHECK_THROWS_WITH(case_in_page(replaced(page, "{\"schema\":\"limcycle/1\"", "{\"schema\":\"other/1\"")),
                    Contains("no schema"));
}

TEST_CASE("case in a page: a newer schema is named") {
  const std::string element = case_element(with_overrides(), "a = 1", "report", "--quick");
  CHECK(case_in_page(element).flags == "--quick");
  CHECK_THROWS_WITH(case_in_page(replaced(element, "limcycle/1", "limcycle/2")),
                    "was written by a newer limcycle (1.2.3, schema limcycle/2): use that version or a later one");
}

TEST_CASE("results are the same but for rounding") {
  const auto document = [](const PredictReport& report) { return predict_json(with_overrides(), report); };
  auto report = sample::relay();
  const std::string original = document(report);
  CHECK(same_result(original, original));
  report.cycles[0].period *= 1.0 + 1e-8;
  CHECK(same_result(original, document(report)));
  report.cycles[0].period *= 1.01;
  CHECK_FALSE(same_result(original, document(report)));
  report = sample::relay();
  report.cycles[0].stable = false;
  CHECK_FALSE(same_result(original, document(report)));
  report = sample::relay();
  report.predictions[0].verdict = Verdict::biased;
  CHECK_FALSE(same_result(original, document(report)));
  report = sample::relay();
  report.outcomes.pop_back();
  CHECK_FALSE(same_result(original, document(report)));
  CHECK_FALSE(same_result(original, "{"));
}
