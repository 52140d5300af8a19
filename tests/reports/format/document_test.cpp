#include "limcycle/reports/format/document.hpp"

#include <catch2/catch.hpp>

using namespace limcycle;
using Catch::Matchers::Contains;

TEST_CASE("document: text and tables in their order", "[document]") {
  const Table table{{{"name", "", Align::left}, {"value", "m"}}, {{"a", "1"}}};
  Document first("Words\n"), all;
  first.add("Numbers", table);
  first += "more\n";
  all += "before\n";
  all += first;
  all.add_untitled("Again", table);
  CHECK(all.text() == "before\nWords\n\nNumbers\n" + table.text() + "more\n" + table.text());
  const std::string latex = all.latex("origin");
  CHECK_THAT(latex, Contains("% origin\n") && Contains("\\caption{Numbers}") && Contains("\\caption{Again}"));
  CHECK_THAT(latex, !Contains("before") && !Contains("Words"));
}

TEST_CASE("document: numbers, units and signs in LaTeX", "[document]") {
  Document document;
  document.add("100 % of a_b & c",
               {{{"#", "", Align::left}, {"slope", "m/s^2"}, {"why", "", Align::left}},
                {{"0", "-1.5e-08", "N > 5, 2 below 1e-06 (+3 %)"}, {"x^{2}\\", "", "-0.5..+1.5, e-mail, 1e5x, ~$"}}});
  const std::string latex = document.latex("");
  CHECK_THAT(latex, Contains("\\caption{100 \\% of a\\_b \\& c}"));
  CHECK_THAT(latex, Contains("\\begin{tabular}{lrl}\n\\toprule\n\\# & slope & why \\\\\n{} & (m/s$^{2}$) & {} \\\\\n"));
  CHECK_THAT(latex,
             Contains("0 & $-1.5 \\cdot 10^{-8}$ & N \\textgreater{} 5, 2 below $1 \\cdot 10^{-6}$ ($+3$ \\%) \\\\"));
  CHECK_THAT(latex, Contains("x\\textasciicircum{}\\{2\\}\\textbackslash{} & {} & "));
  CHECK_THAT(latex, Contains("-0.5..+1.5, e-mail, 1e5x, \\textasciitilde{}\\$ \\\\"));
}

TEST_CASE("document: what a reader wrote is no LaTeX and no number too large") {
  Document document;
  document.add("t", {{{"a", "", Align::left}}, {{"1e99999999999999999999"}, {"2e-000"}, {"3e+07"}}});
  const std::string latex = document.latex("a title\n\\input{secret}\r\\end");
  CHECK_THAT(latex, Contains("% a title \\input{secret} \\end\n% \\usepackage"));
  CHECK_THAT(latex, Contains("$1 \\cdot 10^{99999999999999999999}$") && Contains("$2 \\cdot 10^{-0}$"));
  CHECK_THAT(latex, Contains("$3 \\cdot 10^{7}$"));
}

TEST_CASE("document: without tables LaTeX has none", "[document]") {
  CHECK(Document("words").latex("x") == "% x\n% \\usepackage{booktabs}\n");
}
