#include <catch2/catch.hpp>

#include "limcycle/cases/loader/case.hpp"
#include "limcycle/reports/case_files/catalogue.hpp"
#include "limcycle/tests/cli/columns.hpp"
#include "limcycle/tests/cli/program.hpp"
#include "limcycle/tests/share.hpp"

using limcycle::test::Ran;
using limcycle::test::run;
using limcycle::test::Scratch;
using limcycle::test::shipped;
using limcycle::test::some_of;
using Names = std::vector<std::string>;

namespace {

/// Checks every line of a command's output; an error is one line.
void check_page(const std::vector<std::string>& arguments) {
  const Ran ran = run(arguments);
  CAPTURE(arguments, ran.err);
  CHECK(ran.code <= 3);
  limcycle::test::check_columns(ran.out);
  if (ran.code == 2) CHECK(std::count(ran.err.begin(), ran.err.end(), '\n') == 1);
}

std::vector<std::string> cases() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(std::string(LIMCYCLE_SOURCE_DIR) + "/cases"))
    if (entry.path().extension() == ".toml") names.push_back(entry.path().filename());
  std::ranges::sort(names);
  return some_of(names);
}

}  // namespace

TEST_CASE("columns: what is told of cases, laws, experiments and claims") {
  for (const auto& name : cases()) check_page({"check", shipped(name)});
  check_page({"laws"});
  for (const auto& entry : limcycle::catalogue()) check_page({"laws", entry.kind});
  check_page({"experiment"});
  check_page({"claims", "--list"});
  check_page({"claims", "A1"});
  check_page({"claims", "A8", "--verbose"});
}

// The answer on every case with a loop: with the pages of `report`.
TEST_CASE("columns: predict with the work done, and on cases without a loop") {
  for (const auto& name : cases())
    if (!limcycle::load_case(shipped(name)).loop) check_page({"predict", shipped(name)});
  for (const auto& name :
       some_of(Names{"pid-lugre.toml", "relay-delay.toml", "two-mass-drive.toml", "belt-coulomb.toml"}))
    check_page({"predict", shipped(name), "--set", "predict.starts=2", "--verbose"});
}

TEST_CASE("columns: every other question, on cases that are answered soon") {
  const Scratch scratch;
  check_page({"tune", shipped("over-compensated.toml"), "--vary", "kp=20:40,kd=9:11,lag=0.04:0.05", "--samples", "4"});
  check_page({"tune", shipped("pid-lugre.toml"), "--vary", "ki=2:8", "--samples", "2"});
  for (const auto& name : some_of(Names{"relay-integrator.toml", "relay-third-order.toml", "backlash.toml"})) {
    check_page({"margin", shipped(name)});
    check_page({"remedy", shipped(name), "--only", "gain-kp", "--only", "error-dead-zone"});
    check_page({"sensitivity", shipped(name), "--local"});
    check_page({"precision", shipped(name), "--no-stiffness"});
  }
  for (const auto& name : some_of(Names{"df-lugre.toml", "relay-third-order.toml", "pid-lugre.toml"}))
    check_page({"df", shipped(name)});
  for (const auto& name : some_of(Names{"pid-lugre.toml", "saturated-servo.toml", "two-mass-drive.toml"}))
    check_page({"simulate", shipped(name)});
  for (const auto& name : some_of(Names{"pid-lugre.toml", "belt-coulomb.toml", "valve-stiction.toml", "backlash.toml"}))
    check_page({"dissipativity", shipped(name)});
  check_page({"adequate", shipped("belt-coulomb.toml"), "--spread", "0"});
  const std::string relay = shipped("relay-third-order.toml"), store = scratch.file("s.db");
  check_page({"continue", relay, "--parameter", "loop.element.dead_zone=0.05:0.1"});
  check_page({"map", relay, "--x", "loop.element.dead_zone=0.05:0.1:4", "--y", "loop.element.level=0.5:2:3", "--store",
              store});
  check_page({"status", store});
  check_page({"sensitivity", relay, "--samples", "16", "--trajectories", "4"});
  check_page({"experiment", "pre-sliding", "--law", "lugre"});
}
