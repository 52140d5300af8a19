#include <algorithm>
#include <catch2/catch.hpp>
#include <sstream>

#include "limcycle/tests/cli/program.hpp"

using limcycle::test::quoted;
using limcycle::test::run;
using limcycle::test::Scratch;
using Words = std::vector<std::string>;

namespace {

/// Completions of bash after the last of `words` (the first is "limcycle"), in a folder with two cases, another file
/// and a folder.
Words offered(const Words& words) {
  const Scratch scratch;
  scratch.put("script", run({"completion", "bash"}).out);
  std::filesystem::create_directories(scratch.file("work/folder"));
  for (const auto* name : {"work/servo.toml", "work/belt.toml", "work/notes.txt"}) scratch.put(name, "");
  std::string array;
  for (const auto& word : words) array += ' ' + quoted(word);
  scratch.put("ask", "source ../script\nCOMP_WORDS=(" + array + ")\nCOMP_CWORD=" + std::to_string(words.size() - 1) +
                         "\n_limcycle\nprintf '%s\\n' \"${COMPREPLY[@]}\"\n");
  const std::string command = "cd " + quoted(scratch.file("work")) + " && bash -u ../ask > ../out 2> ../err";
  CHECK(std::system(command.c_str()) == 0);
  CHECK(scratch.get("err") == "");
  Words out;
  std::istringstream lines(scratch.get("out"));
  for (std::string line; std::getline(lines, line);)
    if (!line.empty()) out.push_back(line);
  std::ranges::sort(out);
  return out;
}

bool has(const Words& words, const std::string& word) { return std::ranges::find(words, word) != words.end(); }

}  // namespace

TEST_CASE("completion: bash reads the script without complaint") {
  const Scratch scratch;
  const std::string script = scratch.put("script", run({"completion", "bash"}).out);
  CHECK(std::system(("bash -n " + quoted(script)).c_str()) == 0);
}

TEST_CASE("completion: bash offers commands, options, values and files") {
  CHECK(has(offered({"limcycle", ""}), "predict"));
  CHECK(has(offered({"limcycle", ""}), "--help"));
  CHECK(offered({"limcycle", "pre"}) == Words{"precision", "predict"});
  CHECK(offered({"limcycle", "predict", ""}) == Words{"belt.toml", "folder", "servo.toml"});
  CHECK(offered({"limcycle", "predict", "s"}) == Words{"servo.toml"});
  CHECK(has(offered({"limcycle", "predict", "--"}), "--require-agreement"));
  CHECK(offered({"limcycle", "predict", "--qu"}) == Words{"--quiet"});
  CHECK(offered({"limcycle", "predict", "servo.toml", "--color", ""}) == Words{"always", "auto", "never"});
  CHECK(offered({"limcycle", "predict", "--color", "=", "al"}) == Words{"always"});  // as bash splits --color=al
  CHECK(offered({"limcycle", "predict", "--color", "="}) == Words{"always", "auto", "never"});
  CHECK(offered({"limcycle", "predict", "--json", "n"}) == Words{"notes.txt"});
  CHECK(offered({"limcycle", "predict", "-o", "n"}) == Words{"notes.txt"});
  CHECK(offered({"limcycle", "predict", "--seed", ""}).empty());
  CHECK(offered({"limcycle", "laws", "lu"}) == Words{"lugre", "lugre-spline", "lugre-table"});
  CHECK(offered({"limcycle", "experiment", "stick-slip-"}) == Words{"stick-slip-transition"});
  CHECK(offered({"limcycle", "experiment", "--law", "da"}) == Words{"dahl"});
  CHECK(offered({"limcycle", "map", "servo.toml", "--methods", "comp"}) == Words{"composite-describing-function"});
  CHECK(offered({"limcycle", "new", "--plant", "b"}) == Words{"belt"});
  CHECK(offered({"limcycle", "completion", ""}) == Words{"bash", "fish", "zsh"});
  const auto claims = offered({"limcycle", "claims", ""});
  CHECK((has(claims, "A1") && has(claims, "servo.toml")));
  CHECK(offered({"limcycle", "nonsense", "--"}).empty());
}

TEST_CASE("completion: every script tells every option of every command") {
  const std::string bash = run({"completion", "bash"}).out, zsh = run({"completion", "zsh"}).out,
                    fish = run({"completion", "fish"}).out;
  for (const auto* command : {"predict", "map", "claims", "laws", "new"}) {
    std::istringstream help(run({command, "--help"}).out);
    for (std::string line; std::getline(help, line);) {
      if (line == "Examples") break;
      const auto at = line.find("--");
      if (!line.starts_with("  -") || at == std::string::npos) continue;
      const std::string option = line.substr(at, line.find_first_of(" \n", at) - at);
      INFO(command << ' ' << option);
      CHECK(bash.find(option) != std::string::npos);
      CHECK(zsh.find("*" + option + "[") != std::string::npos);
      CHECK(fish.find("__fish_seen_subcommand_from " + std::string(command) + "' -l " + option.substr(2)) !=
            std::string::npos);
    }
  }
  CHECK(run({"completion", "bsh"}).err.find("did you mean bash?") != std::string::npos);
  CHECK(run({"completion"}).code == 2);
}
