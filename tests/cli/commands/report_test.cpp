#include <sys/wait.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <regex>

#include "limcycle/cases/loader/case.hpp"
#include "limcycle/reports/page/case_in_page.hpp"
#include "limcycle/tests/cli/columns.hpp"
#include "limcycle/tests/cli/started.hpp"
#include "limcycle/tests/reports/markup.hpp"
#include "limcycle/tests/setting.hpp"
#include "limcycle/tests/share.hpp"

using namespace limcycle::test;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;
using Json = nlohmann::ordered_json;

namespace {

constexpr std::uintmax_t largest_report = 3'000'000;

std::string page_part(const std::string& page, const std::string& id) {
  const auto from = page.find("<section id=\"part-" + id + "\">");
  REQUIRE(from != std::string::npos);
  return page.substr(from, page.find("</section>", from) - from);
}

/// The page without the library, which may contain anything.
std::string without_scripts(std::string page) {
  for (auto at = page.find("<script>"); at != std::string::npos; at = page.find("<script>", at))
    page.erase(at, page.find("</script>", at) + 9 - at);
  return page;
}

std::string replaced(std::string text, const std::string& what, const std::string& with) {
  const auto at = text.find(what);
  REQUIRE(at != std::string::npos);
  return text.replace(at, what.size(), with);
}

const std::string third_order = shipped("relay-third-order.toml");

}  // namespace

TEST_CASE("report: one page with all parts, and the answer on stdout") {
  const Scratch scratch;
  const std::string file = scratch.file("r.html");
  std::vector<std::string> command{"report", shipped("pid-lugre.toml"), "-o", file};
  const bool whole = limcycle::test::one_in() == 1;  // where everything is watched, without the parts of other commands
  if (!whole) command.emplace_back("--quick");
  if (whole) command.emplace_back("--benchmarks");
  const auto ran = run(command);
  REQUIRE(ran.code == 0);
  CHECK(ran.err.empty());
  CHECK_THAT(ran.out, Contains("This loop hunts: it settles into a limit cycle of period 24.44 s"));
  CHECK_THAT(ran.out, Contains("\nreport: " + file + "\n"));
  const std::string page = scratch.get("r.html");
  CHECK(page.size() < largest_report);
  const std::string markup = without_scripts(page);
  CHECK(markup_fault(markup) == "");
  CHECK_FALSE(std::regex_search(markup, std::regex("(src|href)\\s*=\\s*\"(?!data:|#)")));
  std::vector<std::string> figures{"nyquist", "time", "phase", "loop", "harmonics", "multipliers"};
  if (whole) figures.insert(figures.end(), {"work-cycle", "work-df"});
  for (const auto& figure : figures) CHECK(markup.find("data-figure=\"" + figure + "\"") != std::string::npos);
  CHECK_THAT(page_part(page, "loop"), Contains("class=\"diagram\"") && Contains("sigma1 = 316.228 N s/m"));
  CHECK_THAT(page_part(page, "predictions"), Contains("biased"));
  CHECK(markup.find("id=\"part-map\"") == std::string::npos);
  CHECK_THAT(markup, Contains("a hunting map (--x, --y)"));
  CHECK_THAT(page_part(page, "energy"), Contains("The energy balances to") && Contains("by friction"));
  if (!whole) return;
  CHECK_THAT(page_part(page, "sensitivity"), Contains("<svg") && Contains("friction.sigma0"));
  CHECK_THAT(page_part(page, "dissipativity"), Contains("The lugre law is not passive") && Contains("<svg"));
  CHECK_THAT(page_part(page, "cure"),
             Contains("<h2>What would end it</h2>") && Contains("<h3>Friction</h3>") && Contains("1.00940 (x 0.6729)"));
}

TEST_CASE(
    "report: each case gives its answer in 80 columns, and a page of less than 3 MB, complete and self-contained") {
  const Scratch scratch;
  int loops = 0;
  for (const auto& entry : std::filesystem::directory_iterator(std::string(LIMCYCLE_SOURCE_DIR) + "/cases")) {
    if (entry.path().extension() != ".toml" || !limcycle::load_case(entry.path().string()).loop) continue;
    if (!limcycle::test::is_done(loops++)) continue;
    INFO(entry.path().string());
    const auto ran = run({"report", entry.path().string(), "--quick", "-o", scratch.file("r.html"), "--quiet"});
    REQUIRE(ran.code == 0);
    CHECK(ran.err.empty());
    CHECK(std::ranges::count(ran.out, '\n') > 5);
    limcycle::test::check_columns(ran.out);
    const std::string page = scratch.get("r.html");
    CHECK(page.size() < largest_report);
    const std::string markup = without_scripts(page);
    CHECK(markup_fault(markup) == "");
    CHECK_FALSE(std::regex_search(markup, std::regex("(src|href)\\s*=\\s*\"(?!data:|#)")));
    CHECK(page.find("could not be computed") == std::string::npos);
  }
  CHECK(loops > 20);
}

TEST_CASE("report: the page alone makes the same answer again") {
  const Scratch scratch;
  const std::string file = scratch.file("r.html");
  const std::vector<std::string> how{"--set", "loop.element.dead_zone=0.05", "--quick"};
  REQUIRE(run({"report", third_order, how[0], how[1], how[2], "-o", file}).code == 0);
  const auto direct = run({"predict", third_order, how[0], how[1]});
  const auto again = run({"predict", "--from", file});
  CHECK(again.code == 0);
  CHECK(again.out == direct.out);
  CHECK(again.err.empty());
  const auto documents = std::pair(run({"predict", third_order, how[0], how[1], "--json", "-"}).out,
                                   run({"predict", "--from", file, "--json", "-"}).out);
  CHECK(documents.first == documents.second);
  // A further change is added to those in the page.
  const auto changed = run({"predict", "--from", file, "--set", "loop.element.level=2.0"});
  CHECK(changed.out == run({"predict", third_order, how[0], how[1], "--set", "loop.element.level=2.0"}).out);
  CHECK(changed.out != direct.out);
  // A report made from the page reproduces it, with its flags.
  REQUIRE(run({"report", "--from", file, "-o", scratch.file("r2.html")}).code == 0);
  CHECK(scratch.get("r2.html") == scratch.get("r.html"));
}

TEST_CASE("report: the short page of predict holds its case too") {
  const Scratch scratch;
  const std::string file = scratch.file("p.html");
  REQUIRE(run({"predict", third_order, "-o", file}).code == 0);
  CHECK(run({"predict", "--from", file}).out == run({"predict", third_order}).out);
}

TEST_CASE("report: every byte of a case survives the page") {
  const Scratch scratch;
  std::ifstream in(third_order, std::ios::binary);
  const std::string original(std::istreambuf_iterator<char>(in), {});
  int n = 0;
  for (const std::string& end : {std::string("# < & </script> <!-- \" ' \\"), std::string("# ω ≤ 日本\r\n# CRLF\r\n"),
                                 std::string("\n\n\t# tab")}) {
    const std::string text = original + "\n" + end;
    const std::string file = scratch.put("case" + std::to_string(n++) + ".toml", text), page = file + ".html";
    REQUIRE(run({"predict", file, "-o", page}).code == 0);
    std::ifstream written(page, std::ios::binary);
    const std::string markup(std::istreambuf_iterator<char>(written), {});
    CHECK(limcycle::case_in_page(markup).text == text);
    std::filesystem::remove(file);  // only the page remains
    const auto again = run({"predict", "--from", page});
    CHECK(again.code == 0);
    CHECK(again.err.empty());
  }
}

TEST_CASE("report: a page that was altered, is none, or is from a newer program is refused") {
  const Scratch scratch;
  REQUIRE(run({"predict", third_order, "-o", scratch.file("p.html")}).code == 0);
  const std::string page = scratch.get("p.html");
  const auto refused = [&](const std::string& text, const std::string& why) {
    const std::string file = scratch.put("bad.html", text);
    const auto ran = run({"predict", "--from", file});
    CHECK(ran.code == 2);
    CHECK(ran.out.empty());
    CHECK_THAT(ran.err, StartsWith("limcycle: " + file) && Contains(why));
    CHECK(std::count(ran.err.begin(), ran.err.end(), '\n') == 1);
  };
  const auto data = page.find("id=\"case\">");
  refused(page.substr(0, data) + replaced(page.substr(data), "level = 1", "level = 2"),
          "was altered: the case in it does not have the SHA-256 that the page states");
  refused("<html></html>", "is not a limcycle page with an embedded case");
  refused("", "is not a limcycle page");
  refused(replaced(page, "id=\"case\">{\"schema\":\"limcycle/1\"", "id=\"case\">{\"schema\":\"limcycle/9\""),
          "was written by a newer limcycle");
  refused(page.substr(0, page.find("id=\"case\">") + 40), "is cut off");
  CHECK_THAT(run({"predict", "--from", scratch.file("none.html")}).err, Contains("no such file"));
  CHECK_THAT(run({"predict", "--from", std::filesystem::temp_directory_path().string()}).err,
             Contains("is a directory"));
}

TEST_CASE("report: one case, from one place") {
  const auto none = run({"predict"});
  CHECK(none.code == 2);
  CHECK_THAT(none.err, Contains("a case is needed: CASE, or --from"));
  const auto both = run({"report", third_order, "--from", "p.html"});
  CHECK(both.code == 2);
  CHECK_THAT(both.err, Contains("takes the place of CASE"));
}

TEST_CASE("report: a page from another version is told so, and an answer that it does not state") {
  const Scratch scratch;
  REQUIRE(run({"predict", third_order, "-o", scratch.file("p.html")}).code == 0);
  std::string page = scratch.get("p.html");
  const auto at = page.find("\"version\":\"", page.find("id=\"case\">"));
  page.replace(at, std::string("\"version\":\"").size(), "\"version\":\"0.0.0-");
  const auto older = run({"predict", "--from", scratch.put("old.html", page)});
  CHECK(older.code == 0);
  CHECK_THAT(older.err, Contains("the page was written by version 0.0.0-"));
  CHECK(run({"predict", "--from", scratch.file("old.html"), "--quiet"}).err.empty());
  const auto result = page.find("\"verdict\":\"confirmed\"", page.find("id=\"result\">"));
  REQUIRE(result != std::string::npos);
  page.replace(result, std::string("\"verdict\":\"confirmed\"").size(), "\"verdict\":\"biased\"");
  CHECK_THAT(run({"predict", "--from", scratch.put("other.html", page)}).err,
             Contains("the answer differs from the one on the page"));
}

TEST_CASE("report: with a map, which the page draws and makes again") {
  const Scratch scratch;
  const auto ran = run({"report", third_order, "--quick", "--x", "loop.element.level=1:2:3", "--y",
                        "loop.element.dead_zone=0:0.2:4", "-o", scratch.file("m.html"), "--quiet"});
  REQUIRE(ran.code == 0);
  const std::string page = scratch.get("m.html");
  CHECK_THAT(page_part(page, "map"), Contains("<svg") && Contains("loop.element.dead_zone over loop.element.level"));
  CHECK_THAT(without_scripts(page),
             Contains("Left out: margins, sensitivity and dissipativity (by --quick), remedies") &&
                 !Contains("a hunting map (--x") && !Contains("id=\"part-sensitivity\""));
  CHECK(limcycle::case_in_page(page).flags ==
        "--quick --x loop.element.level=1:2:3 --y loop.element.dead_zone=0:0.2:4");
  for (const auto& wrong : std::vector<std::vector<std::string>>{
           {"--x", "loop.element.level=1:2:3"},
           {"--x", "loop.element.level=1:2:3", "--y", "loop.element.level=1:2:3"},
           {"--x", "loop.element.nothing=1:2:3", "--y", "loop.element.level=1:2:3"}}) {
    std::vector<std::string> arguments{"report", third_order, "-o", scratch.file("x.html")};
    arguments.insert(arguments.end(), wrong.begin(), wrong.end());
    CHECK(run(arguments).code == 2);
    CHECK_FALSE(std::filesystem::exists(scratch.file("x.html")));
  }
}

TEST_CASE("report: where the page goes") {
  const Scratch scratch;
  const auto piped = run({"report", third_order, "--quick", "-o", "-"});
  CHECK(piped.code == 0);
  CHECK_THAT(piped.out, StartsWith("<!DOCTYPE html>"));
  CHECK(piped.out.ends_with("</html>\n"));
  const std::string own = scratch.put("own.toml",
                                      "[loop.plant]\nkind = \"mass\"\nmass = 1.0\nstiffness = 1.0\n"
                                      "[loop.friction]\nkind = \"coulomb\"\nFc = 1.0\n");
  CHECK(run({"report", own, "-o", own}).code == 2);
  CHECK_THAT(scratch.get("own.toml"), StartsWith("[loop.plant]"));
  const std::string command = "cd " + quoted(std::filesystem::path(own).parent_path().string()) + " && " +
                              quoted(tested_program) + " report own.toml --quick > out";
  const int status = std::system(command.c_str());
  CHECK(WEXITSTATUS(status) == 0);
  CHECK_THAT(scratch.get("out"), Contains("report: own.html"));
  CHECK_THAT(scratch.get("own.html"), StartsWith("<!DOCTYPE html>"));
}

TEST_CASE("report: a loop that rests and one with a dead time say what does not apply") {
  const Scratch scratch;
  REQUIRE(run({"report", shipped("saturation.toml"), "--set", "loop.plant.numerator=[1.0]", "-o",
               scratch.file("a.html"), "--quiet"})
              .code == 0);
  const std::string rests = scratch.get("a.html");
  CHECK_THAT(page_part(rests, "sensitivity"), Contains("There is no stable limit cycle"));
  CHECK_THAT(page_part(rests, "cycles"), Contains("None was found."));
  CHECK_THAT(page_part(rests, "energy"), Contains("neither friction nor a mechanical plant"));
  REQUIRE(run({"report", shipped("relay-delay.toml"), "-o", scratch.file("b.html"), "--quiet"}).code == 0);
  CHECK_THAT(page_part(scratch.get("b.html"), "sensitivity"), Contains("derivatives of a cycle are not computed"));
  const auto lone = run({"report", shipped("df-lugre.toml"), "-o", scratch.file("c.html")});
  CHECK(lone.code == 2);
  CHECK_THAT(lone.err, Contains("the case holds a lone element"));
}

TEST_CASE("report: interrupted, it writes what is there and says so") {
  const Scratch scratch;
  const auto ran = run_interrupted({"report", shipped("two-mass-drive.toml"), "-o", scratch.file("i.html"), "--x",
                                    "loop.controller.kp=1:5:200", "--y", "loop.controller.kd=1:9:200"},
                                   1.0);
  CHECK(ran.code == 3);
  CHECK_THAT(ran.err, Contains("interrupted; the page holds the results computed so far"));
  const std::string page = scratch.get("i.html");
  CHECK_THAT(page, StartsWith("<!DOCTYPE html>") && Contains("Interrupted: this page shows"));
  CHECK(markup_fault(without_scripts(page)) == "");
}
