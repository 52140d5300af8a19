#include <catch2/catch.hpp>

#include "limcycle/tests/cli/program.hpp"
#include "limcycle/tests/setting.hpp"

using limcycle::test::quoted;
using limcycle::test::run;
using limcycle::test::Scratch;
using limcycle::test::shipped;

namespace {

constexpr auto* bold = "\x1b[1m";
constexpr auto* red = "\x1b[31m";
constexpr auto* green = "\x1b[32m";
constexpr auto* yellow = "\x1b[33m";

/// Output of the program on a terminal; `before` ("NO_COLOR=1") precedes the command.
std::string on_terminal(const std::string& arguments, const std::string& before = "TERM=xterm") {
  const Scratch scratch;
  const std::string inner =
      "env -u NO_COLOR " + before + " " + quoted(limcycle::test::tested_program) + " " + arguments;
  const std::string command = "script -qec " + quoted(inner) + " " + quoted(scratch.file("typescript")) + " > " +
                              quoted(scratch.file("out")) + " < /dev/null";
  CHECK(std::system(command.c_str()) != -1);
  return scratch.get("out");
}

bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

std::string without_escapes(const std::string& text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '\x1b')
      i = text.find('m', i);
    else if (text[i] != '\r')
      out += text[i];
  }
  return out;
}

}  // namespace

TEST_CASE("colour: on a terminal, and nowhere else") {
  const std::string file = quoted(shipped("pid-lugre.toml"));
  const std::string seen = on_terminal("predict " + file + " --quiet");
  CHECK(holds(seen, bold + std::string("Limit cycles\x1b[0m")));
  CHECK(holds(seen, yellow + std::string("biased\x1b[0m")));
  CHECK(holds(seen, green + std::string("yes\x1b[0m")));
  CHECK_FALSE(holds(seen, green + std::string("stable")));  // a heading is no verdict
  const std::string plain = run({"predict", shipped("pid-lugre.toml"), "--quiet"}).out;
  CHECK_FALSE(holds(plain, "\x1b"));
  CHECK(without_escapes(seen) == plain);

  const std::string quick = "predict " + quoted(shipped("relay-integrator.toml")) + " --quiet";
  CHECK(holds(on_terminal(quick), green));
  CHECK_FALSE(holds(on_terminal(quick, "TERM=xterm NO_COLOR=1"), "\x1b"));
  CHECK(holds(on_terminal(quick, "TERM=xterm NO_COLOR="), green));  // empty counts as not set
  CHECK_FALSE(holds(on_terminal(quick, "TERM=dumb"), "\x1b"));
  CHECK_FALSE(holds(on_terminal(quick, "-u TERM"), "\x1b"));
  CHECK_FALSE(holds(on_terminal(quick + " --color never"), "\x1b"));
  CHECK(holds(on_terminal(quick + " --color always", "TERM=dumb NO_COLOR=1"), green));
  CHECK_FALSE(holds(on_terminal(quick + " --json -"), "\x1b"));
  CHECK_FALSE(holds(on_terminal(quick + " --csv -"), "\x1b"));
}

TEST_CASE("colour: files and pipes get none, unless it is asked for") {
  const Scratch scratch;
  const std::string file = shipped("relay-integrator.toml");
  CHECK(holds(run({"predict", file, "--color", "always"}).out, green + std::string("confirmed\x1b[0m")));
  CHECK(run({"predict", file, "--color", "always", "-o", scratch.file("text")}).code == 0);
  CHECK_FALSE(holds(scratch.get("text"), "\x1b"));
  CHECK_FALSE(holds(run({"predict", file}).out, "\x1b"));
  for (const auto* made : {"manual", "new"}) CHECK_FALSE(holds(run({made, "--color", "always"}).out, "\x1b"));
  CHECK_FALSE(holds(run({"completion", "bash", "--color=always"}).out, "\x1b"));
  CHECK(run({"predict", file, "--color", "sometimes"}).code == 2);
}

TEST_CASE("colour: headings of help, and complaints") {
  CHECK(holds(on_terminal("--help"), bold + std::string("Prediction and simulation\x1b[0m")));
  CHECK(holds(on_terminal("predict --help"), bold + std::string("Examples\x1b[0m")));
  CHECK(holds(on_terminal("predict no-such-file.toml"), red + std::string("limcycle:\x1b[0m no-such-file.toml")));
  CHECK_FALSE(holds(run({"predict", "no-such-file.toml"}).err, "\x1b"));
  CHECK(holds(run({"predict", "no-such-file.toml", "--color=always"}).err, red));
}
