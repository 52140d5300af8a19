#include <algorithm>
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "limcycle/reports/format/table.hpp"
#include "limcycle/tests/cli/program.hpp"
#include "limcycle/tests/lines.hpp"
#include "limcycle/tests/setting.hpp"
#include "limcycle/tests/share.hpp"

using limcycle::test::lines_of;
using limcycle::test::quoted;
using limcycle::test::run;
using limcycle::test::Scratch;

namespace {

/// Commands listed by `limcycle --help`: the first word of lines indented by two columns, before the exit codes.
std::vector<std::string> listed_commands() {
  std::vector<std::string> names;
  for (const auto& line : lines_of(run({"--help"}).out)) {
    if (line == "Exit codes") break;
    if (line.starts_with("  ") && line.size() > 2 && line[2] != ' ')
      names.push_back(line.substr(2, line.find(' ', 2) - 2));
  }
  return names;
}

/// The example lines of a help text; lines broken by a backslash are joined.
std::vector<std::string> examples_in(const std::string& help) {
  std::vector<std::string> examples;
  bool within = false, goes_on = false;
  for (auto line : lines_of(help)) {
    if (line == "Examples") within = true;
    if (!within) continue;
    const bool begins = line.starts_with("  limcycle ");
    if (!begins && !goes_on) continue;
    const bool more = line.ends_with(" \\");
    if (more) line.resize(line.size() - 2);
    const std::string words = line.substr(line.find_first_not_of(' '));
    if (begins)
      examples.push_back(words);
    else
      examples.back() += ' ' + words;
    goes_on = more;
  }
  return examples;
}

int shell(const Scratch& scratch, const std::string& line) {
  const std::string command = "cd " + quoted(scratch.file("work")) + " && PATH=" + quoted(scratch.file("bin")) +
                              ":$PATH && { " + line + "; } > " + quoted(scratch.file("out")) + " 2> " +
                              quoted(scratch.file("err")) + " < /dev/null";
  const int status = std::system(command.c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : 1000;
}

}  // namespace

TEST_CASE("help: every command is listed, and has help in 80 columns with examples") {
  const auto commands = listed_commands();
  for (const auto* name :
       {"predict",     "df",        "simulate", "continue", "margin",     "remedy",        "tune",   "map",
        "sensitivity", "precision", "adequate", "identify", "synthesize", "dissipativity", "claims", "experiment",
        "status",      "check",     "laws",     "new",      "manual",     "completion"})
    CHECK(std::ranges::find(commands, name) != commands.end());
  for (const auto& line : lines_of(run({"--help"}).out)) CHECK(limcycle::display_width(line) <= 80);
  for (const auto& name : commands) {
    INFO(name);
    const auto ran = run({name, "--help"});
    CHECK(ran.code == 0);
    CHECK(ran.out.starts_with("Usage: limcycle " + name));
    CHECK_FALSE(examples_in(ran.out).empty());
    for (const auto* option : {"--help", "--output FILE", "--quiet", "--verbose", "--color WHEN"})
      CHECK(ran.out.find(option) != std::string::npos);
    for (const auto& line : lines_of(ran.out)) {
      INFO(line);
      CHECK(limcycle::display_width(line) <= 80);
      CHECK_FALSE(line.ends_with(' '));
    }
  }
}

TEST_CASE("help: what it says of options") {
  const std::string map = run({"map", "--help"}).out;
  CHECK(map.find("Usage: limcycle map CASE --x PATH=FROM:TO:N[:log] --y") == 0);
  CHECK(map.find("-o, --output FILE") != std::string::npos);
  CHECK(map.find("Colours; auto: on a terminal") != std::string::npos);
  CHECK(map.find("always, never (default auto)") != std::string::npos);
  CHECK(map.find("(0 to 1024; default 0)") != std::string::npos);  // a map uses all cores
  CHECK(run({"predict", "--help"}).out.find("(0 to 1024; default 1)") != std::string::npos);
  const std::string all = run({"--help"}).out;
  for (const auto* text :
       {"Getting started\n", "Exit codes\n  0   done", "\n  2   wrong usage", "limcycle new -o servo.toml"})
    CHECK(all.find(text) != std::string::npos);
}

// One scratch folder for all, in the order of the help: `status` reads the store that `map` wrote.
TEST_CASE("help: every example works") {
  const Scratch scratch;
  std::filesystem::create_directories(scratch.file("bin"));
  std::filesystem::create_directories(scratch.file("work"));
  std::filesystem::create_symlink(limcycle::test::tested_program, scratch.file("bin/limcycle"));
  std::filesystem::create_directory_symlink(std::string(LIMCYCLE_SOURCE_DIR) + "/cases", scratch.file("work/cases"));
  int examples = 0;
  // Where everything is watched, the long commands are left to tests of their own.
  const std::set<std::string> long_ones{"sensitivity", "precision", "adequate", "report", "remedy", "tune", "margin"};
  for (const auto& name : listed_commands()) {
    if (limcycle::test::one_in() > 1 && long_ones.contains(name)) continue;
    for (const auto& line : examples_in(run({name, "--help"}).out)) {
      INFO(line);
      CHECK(line.starts_with("limcycle " + name));
      const int code = shell(scratch, line);
      INFO(scratch.get("err"));
      CHECK((code == 0 || (line.find("--require-agreement") != std::string::npos && code == 1)));
      ++examples;
    }
  }
  CHECK(examples > (limcycle::test::one_in() == 1 ? 25 : 15));
  std::vector<std::string> files{"servo.toml", "run.csv", "plane.db", "plane.svg", "limcycle.1", "result.json"};
  if (limcycle::test::one_in() == 1) files.emplace_back("servo.html");
  for (const auto& file : files) CHECK(std::filesystem::file_size(scratch.file("work/" + file)) > 100);
}

TEST_CASE("help: what was computed is told with verbose, the same bytes however many threads") {
  const std::string file = limcycle::test::shipped("relay-third-order.toml");
  const auto plain = run({"predict", file});
  const auto told = run({"predict", file, "--verbose"});
  CHECK(told.code == 0);
  REQUIRE(told.out.starts_with(plain.out));
  const std::string more = told.out.substr(plain.out.size());
  CHECK(more.starts_with("\nWork done\ndescribing-function            1 root, residual at most "));
  for (const auto* text : {"\nsimulation ", " runs, ", " steps, from ", "\nshooting ", " return maps\n", "\nstatus  ",
                           "\ncomposite-describing-function  does not apply to this loop\n"})
    CHECK(more.find(text) != std::string::npos);
  CHECK(run({"predict", file, "--verbose", "--threads", "3"}).out == told.out);
  CHECK(plain.err.empty());
  CHECK(told.err.find(" s  simulation\n") != std::string::npos);
  CHECK(told.err.find(" s  in all; ") != std::string::npos);
  CHECK(run({"predict", file, "--verbose", "--quiet"}).err.empty());
  // The text of other commands is unchanged.
  const auto checked = run({"check", file, "--verbose"});
  CHECK(checked.out == run({"check", file}).out);
  CHECK(checked.err.find(" s  in all; ") != std::string::npos);
}
