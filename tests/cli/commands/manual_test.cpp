#include <catch2/catch.hpp>
#include <sstream>

#include "limcycle/reports/case_files/catalogue.hpp"
#include "limcycle/tests/cli/program.hpp"

using limcycle::test::quoted;
using limcycle::test::run;
using limcycle::test::Scratch;
using limcycle::test::squeezed;

namespace {

const std::vector<std::string> commands{"new",    "check",      "laws",     "predict",       "simulate", "df",
                                        "report", "margin",     "remedy",   "continue",      "map",      "sensitivity",
                                        "status", "precision",  "adequate", "dissipativity", "claims",   "experiment",
                                        "manual", "completion", "identify", "synthesize",    "tune"};

std::string page(const std::string& name) {
  const auto ran = run(name.empty() ? std::vector<std::string>{"manual"} : std::vector<std::string>{"manual", name});
  INFO(name << ran.err);
  CHECK(ran.code == 0);
  return ran.out;
}

/// Warnings of groff about a page, all enabled, and its output in `printed`, without bold and underlined.
std::string warnings(const std::string& text, std::string& printed) {
  const Scratch scratch;
  scratch.put("page", text);
  const std::string command = "groff -man -Tascii -P-cbou -ww -rLL=72n " + quoted(scratch.file("page")) + " > " +
                              quoted(scratch.file("printed")) + " 2> " + quoted(scratch.file("warnings"));
  CHECK(std::system(command.c_str()) == 0);
  printed = scratch.get("printed");
  return scratch.get("warnings");
}

}  // namespace

TEST_CASE("manual: groff has no warning about any page") {
  auto names = commands;
  names.emplace_back();
  names.emplace_back("case");
  for (const auto& name : names) {
    INFO(name);
    std::string printed;
    const std::string text = page(name);
    CHECK(warnings(text, printed) == "");
    CHECK(printed.find("NAME") != std::string::npos);
    CHECK(text.find(" \\- ") != std::string::npos);  // whatis(1) needs it
    for (const char c : text) CHECK(static_cast<unsigned char>(c) < 0x80);
  }
}

TEST_CASE("manual: a page tells what the help tells") {
  std::string printed;
  warnings(page("map"), printed);
  const std::string text = squeezed(printed);
  for (const auto* part : {"SYNOPSIS limcycle map CASE --x PATH=FROM:TO:N[:log]", "DESCRIPTION Computes the outcome",
                           "-o, --output FILE", "(0 to 1024; default 0)", "EXAMPLES", "EXIT STATUS 0 done",
                           "limcycle-case(5)", "limcycle map cases/relay-third-order.toml --x"})
    CHECK(text.find(part) != std::string::npos);
  warnings(page(""), printed);
  for (const auto& command : commands)
    CHECK(squeezed(printed).find("limcycle-" + command + "(1)") != std::string::npos);
  CHECK(run({"manual", "predikt"}).err.find("did you mean predict?") != std::string::npos);
  CHECK(run({"manual", "predikt"}).code == 2);
}

TEST_CASE("manual: the page of case files tells every kind and key") {
  const std::string text = page("case");
  const auto escaped = [](std::string word) {
    for (std::size_t i = 0; (i = word.find('-', i)) != std::string::npos; i += 2) word.replace(i, 1, "\\-");
    return word;
  };
  for (const auto& entry : limcycle::catalogue()) {
    INFO(entry.kind);
    const auto from = text.find("kind = \\(dq" + escaped(entry.kind) + "\\(dq");
    REQUIRE(from != std::string::npos);
    for (const auto& parameter : entry.parameters)
      CHECK(text.find("\\fB" + escaped(parameter.key) + "\\fR\n", from) != std::string::npos);
  }
}

// The reader of cases rejects unknown keys, each section by its own list; the page has lists of its own.
TEST_CASE("manual: the page of case files tells the keys that the reader of each section allows") {
  const std::string text = page("case");
  const auto keys_between = [&](const std::string& section) {
    const auto from = text.find(".SS " + section + "\n");
    REQUIRE(from != std::string::npos);
    std::string body = text.substr(from, text.find(".S", from + 4) - from);
    std::vector<std::string> keys;
    for (std::size_t at = 0; (at = body.find(".TP\n\\fB", at)) != std::string::npos; at += 7)
      keys.push_back(body.substr(at + 7, body.find(' ', at + 7) - at - 7));
    std::ranges::sort(keys);
    return keys;
  };
  // The error for an unknown key lists the known ones.
  const auto known_to_reader = [&](const std::string& path) {
    const std::string base = path == "claim" ? "relay-claims.toml" : "pid-lugre.toml";
    const Scratch scratch;
    std::ifstream in(limcycle::test::shipped(base));
    std::string file(std::istreambuf_iterator<char>(in), {});
    if (path == "claim")
      file += "\n[[claim]]\nzzzzzzzzzzzz = 1\n";
    else if (path.empty())
      file = "zzzzzzzzzzzz = 1\n" + file;
    else if (file.find("[" + path + "]") != std::string::npos)
      file.replace(file.find("[" + path + "]"), path.size() + 2, "[" + path + "]\nzzzzzzzzzzzz = 1");
    else
      file += "\n[" + path + "]\nzzzzzzzzzzzz = 1\n";
    const auto ran = run({"check", scratch.put("case.toml", file)});
    INFO(ran.err);
    CHECK(ran.code == 2);
    const auto at = ran.err.find("known: ");
    REQUIRE(at != std::string::npos);
    std::vector<std::string> keys;
    std::istringstream words(ran.err.substr(at + 7));
    for (std::string word; words >> word;) keys.push_back(word.ends_with(',') ? word.substr(0, word.size() - 1) : word);
    std::ranges::sort(keys);
    return keys;
  };
  for (const auto* section : {"search", "predict", "simulate", "df", "dissipativity", "sensitivity"}) {
    INFO(section);
    CHECK(keys_between("[" + std::string(section) + "]") == known_to_reader(section));
  }
  CHECK(keys_between("[[claim]]") == known_to_reader("claim"));
}
