#include <catch2/catch.hpp>

#include "limcycle/tests/cli/program.hpp"

// What the flags say of files and numbers: nothing that is read is overwritten, nothing is lost, nothing is guessed.

using Catch::Matchers::Contains;
using limcycle::test::Ran;
using limcycle::test::run;
using limcycle::test::Scratch;
using limcycle::test::shipped;

namespace {

void check_refused(const Ran& ran, const std::string& part) {
  CHECK(ran.code == 2);
  CHECK(ran.out.empty());
  CHECK_THAT(ran.err, Contains(part));
}

}  // namespace

TEST_CASE("files: no document takes the place of the case, a store or another document, by whatever name") {
  const Scratch scratch;
  std::filesystem::copy_file(shipped("pid-lugre.toml"), scratch.file("my.toml"));
  std::filesystem::create_symlink("my.toml", scratch.file("link.toml"));
  const std::string mine = scratch.file("my.toml"), before = scratch.get("my.toml"), there = scratch.file("./my.toml");
  for (const char* flag : {"-o", "--json", "--csv"})
    for (const std::string& name : {mine, there, scratch.file("link.toml")})
      check_refused(run({"check", mine, flag, name}), "is the case file");
  check_refused(run({"predict", mine, "-o", scratch.file("a.html"), "--json", mine}), "is the case file");
  check_refused(run({"check", mine, "--json", scratch.file("a.out"), "--csv", scratch.file("./a.out")}),
                "is where --json goes already");
  const std::string store = scratch.file("s.db");
  check_refused(run({"map", mine, "--x", "loop.controller.kp=1:5:2", "--y", "loop.controller.kd=1:9:2", "--store",
                     store, "--json", store}),
                "is the store");
  check_refused(run({"report", mine, "-o", there}), "is the case file");
  CHECK(scratch.get("my.toml") == before);
  CHECK_FALSE(std::filesystem::exists(scratch.file("a.out")));
  CHECK(run({"check", mine, "--json", "/dev/null", "--csv", "/dev/null"}).code == 0);
}

TEST_CASE("files: a name that is empty is refused") {
  const std::string servo = shipped("pid-lugre.toml");
  for (const char* flag : {"--json", "--csv", "-o"})
    check_refused(run({"check", servo, flag, ""}), "needs the name of a file");
  check_refused(
      run({"map", servo, "--x", "loop.controller.kp=1:5:2", "--y", "loop.controller.kd=1:9:2", "--store", ""}),
      "needs the name of a file");
  check_refused(run({"predict", servo, "--html", ""}), "needs the name of a file");
  CHECK(run({"check", ""}).code == 2);
}

TEST_CASE("flags: a number is finite, a whole number is decimal and fits") {
  const std::string servo = shipped("pid-lugre.toml");
  check_refused(run({"dissipativity", servo, "--speed", "nan"}), "--speed: 'nan' is not a finite number");
  check_refused(run({"dissipativity", servo, "--top-speed", "inf"}), "'inf' is not a finite number");
  check_refused(run({"adequate", servo, "--spread", "nan"}), "'nan' is not a finite number");
  check_refused(run({"adequate", servo, "--tolerance", "-nan"}), "is not a finite number");
  check_refused(run({"check", servo, "--seed", "18446744073709551616"}), "too large");
  check_refused(run({"check", servo, "--seed", "0x10"}), "is not a whole number");
  check_refused(run({"check", servo, "--threads", "99999999999"}), "--threads");
  CHECK_THAT(run({"check", servo, "--seed", "010", "--json", "-"}).out, Contains("\"seed\":10,"));
  CHECK_THAT(run({"check", servo, "--seed", "18446744073709551615", "--json", "-"}).out,
             Contains("\"seed\":18446744073709551615,"));
}

TEST_CASE("terminal: nothing that a case or a file name holds is obeyed by it") {
  const Scratch scratch;
  const std::string odd =
      "a\x1b[31m\nlimcycle: all is well\xc2\x9b"
      "2J\xe2\x80\xae.toml";
  std::ifstream shipped_case(shipped("pid-lugre.toml"), std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(shipped_case), {}};
  text = "title = \"\\u001b[2J \\u009b31m \\u202e x\"\n" + text.substr(text.find("[loop"));
  const std::string file = scratch.put(odd, text);
  const auto harmless = [](const std::string& what) {
    for (const char* bad : {"\x1b", "\xc2\x9b", "\xe2\x80\xae", "\nlimcycle: all"})
      CHECK(what.find(bad) == std::string::npos);
  };
  const Ran checked = run({"check", file});
  CHECK(checked.code == 0);
  harmless(checked.out);
  harmless(run({"check", file, "--json", "-"}).out);
  const Ran wrong = run({"check", file, "--set", "loop.friction.Fs=-1"});
  CHECK(wrong.code == 2);
  harmless(wrong.err);
  harmless(run({"check", scratch.file("none" + odd)}).err);
}
