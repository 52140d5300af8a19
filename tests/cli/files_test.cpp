#include <unistd.h>

#include <catch2/catch.hpp>

#include "limcycle/tests/cli/program.hpp"
#include "limcycle/tests/setting.hpp"

// Flags for files and numbers: no input is overwritten, no result is lost, no value is guessed.

using Catch::Matchers::Contains;
using limcycle::test::Ran;
using limcycle::test::run;
using limcycle::test::Scratch;
using limcycle::test::shipped;

namespace {

void check_refused_with(const Ran& ran, const std::string& part) {
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
      check_refused_with(run({"check", mine, flag, name}), "is the case file");
  check_refused_with(run({"predict", mine, "-o", scratch.file("a.html"), "--json", mine}), "is the case file");
  check_refused_with(run({"check", mine, "--json", scratch.file("a.out"), "--csv", scratch.file("./a.out")}),
                     "is where --json goes already");
  const std::string store = scratch.file("s.db");
  check_refused_with(run({"map", mine, "--x", "loop.controller.kp=1:5:2", "--y", "loop.controller.kd=1:9:2", "--store",
                          store, "--json", store}),
                     "is the store");
  check_refused_with(run({"report", mine, "-o", there}), "is the case file");
  CHECK(scratch.get("my.toml") == before);
  CHECK_FALSE(std::filesystem::exists(scratch.file("a.out")));
  CHECK(run({"check", mine, "--json", "/dev/null", "--csv", "/dev/null"}).code == 0);
}

TEST_CASE("files: no document takes the place of the data of a case, whatever the command") {
  const Scratch scratch;
  const std::string mine = scratch.put("cv.toml", R"(
[loop.plant]
kind = "mass"
mass = 1.0
[loop.controller]
kind = "pid"
kp = 3.0
ki = 4.0
kd = 6.0
[loop.friction]
kind = "stribeck"
curve = "table"
file = "sweep.csv"
Fs = 1.5
[df]
amplitude = [1e-3]
frequency = [1.0]
[[claim]]
id = "x"
quantity = "period"
formula = "1.0"
)"),
                    data = "velocity,force\n0.01,1.2\n0.1,1.0\n1.0,1.4\n", there = scratch.put("sweep.csv", data);
  std::filesystem::create_symlink("sweep.csv", scratch.file("link.csv"));
  for (const std::vector<std::string>& command : {std::vector<std::string>{"df", mine},
                                                  {"check", mine},
                                                  {"predict", mine},
                                                  {"claims", mine, "--list"},
                                                  {"margin", mine}})
    for (const std::string& name : {there, scratch.file("link.csv")}) {
      auto arguments = command;
      arguments.insert(arguments.end(), {"--json", name});
      INFO(command.front());
      check_refused_with(run(arguments), "is the data of loop.friction");
    }
  std::filesystem::create_directory(scratch.file("rig"));
  std::filesystem::copy_file(shipped("measured-axis.toml"), scratch.file("rig/my.toml"));
  std::filesystem::copy_file(shipped("measured-axis.csv"), scratch.file("rig/measured-axis.csv"));
  std::filesystem::create_symlink("measured-axis.csv", scratch.file("rig/lag.csv"));
  check_refused_with(run({"synthesize", scratch.file("rig/my.toml"), "-o", scratch.file("rig"), "--force"}),
                     "is the data of loop.plant");
  CHECK(scratch.get("sweep.csv") == data);
}

TEST_CASE("files: no document takes the place of what SQLite keeps beside a store") {
  const Scratch scratch;
  const std::string store = scratch.file("s.db"), servo = shipped("pid-lugre.toml");
  for (const char* ending : {"-wal", "-shm", "-journal", "-lock"})
    check_refused_with(run({"map", servo, "--x", "loop.controller.kp=1:5:2", "--y", "loop.controller.kd=1:9:2",
                            "--store", store, "--json", store + ending}),
                       "is a file of the store");
}

TEST_CASE("files: stdout by its other names is stdout, and holds one document") {
  const std::string relay = shipped("saturation.toml");
  check_refused_with(run({"check", relay, "--json", "/dev/stdout", "--csv", "-"}), "is where --json goes already");
  const Ran json = run({"check", relay, "--json", "/dev/stdout"});
  CHECK(json.out.substr(0, 1) == "{");
  const Ran page = run({"predict", relay, "--html", "-"});
  CHECK(page.code == 0);
  CHECK(page.out.substr(0, 9) == "<!DOCTYPE");
  CHECK(page.out.substr(page.out.size() - 8) == "</html>\n");
}

TEST_CASE("files: a page is not written under the name of another document") {
  const Scratch scratch;
  for (const char* name : {"x.pdf", "x.tex", "x.svg", "x.csv", "x.json", "x.h5"}) {
    check_refused_with(run({"report", shipped("pid-lugre.toml"), "-o", scratch.file(name)}), "would hold a page");
    check_refused_with(run({"predict", shipped("pid-lugre.toml"), "--html", scratch.file(name)}), "would hold a page");
  }
}

TEST_CASE("files: an existing file with a long name is replaced, and one that is too long is refused") {
  const Scratch scratch;
  const std::string longest = scratch.put(std::string(252, 'n'), "old");
  CHECK(run({"check", shipped("pid-lugre.toml"), "--json", longest}).code == 0);
  CHECK_THAT(scratch.get(std::string(252, 'n')), Contains("\"command\": \"check\""));
  check_refused_with(run({"check", shipped("pid-lugre.toml"), "--json", scratch.file(std::string(300, 'n'))}),
                     "File name too long");
}

TEST_CASE("files: synthesize refuses before it computes, and leaves no empty folder") {
  const Scratch scratch;
  const std::string servo = shipped("pid-lugre.toml"), folder = scratch.file("new/rig");
  check_refused_with(run({"synthesize", servo, "-o", folder, "--json", scratch.file("none/x")}), "cannot be written");
  CHECK_FALSE(std::filesystem::exists(folder));
  check_refused_with(run({"synthesize", servo, "-o", scratch.put("file", "") + "/rig"}),
                     "cannot be made: Not a directory");
  // A motion that cannot be computed costs the other records nothing.
  const Ran ran = run({"synthesize", servo, "-o", folder, "--free", "--set", "loop.friction.sigma1=1e20"});
  CHECK(ran.code == 3);
  CHECK_THAT(ran.err, Contains("no free motion is written: the free motion of the rig could not be computed"));
  CHECK_THAT(ran.out, Contains("steady-velocity"));
  CHECK(std::filesystem::exists(scratch.file("new/rig/lag.csv")));
  CHECK(run({"check", scratch.file("new/rig/identify.toml")}).code == 0);
}

TEST_CASE("files: a name that promises another document than is written is refused") {
  const Scratch scratch;
  const std::string servo = shipped("pid-lugre.toml");
  for (const char* command : {"check", "predict", "report", "simulate", "remedy", "df"})
    for (const char* name : {"x.eps", "x.png"}) {
      check_refused_with(run({command, servo, "-o", scratch.file(name)}),
                         "no command writes ." + std::string(name + 2));
      CHECK_FALSE(std::filesystem::exists(scratch.file(name)));
    }
  check_refused_with(run({"margin", servo, "-o", scratch.file("x.svg")}), "this command writes no .svg");
  check_refused_with(run({"check", servo, "-o", scratch.file("x.html")}), "this command writes no .html");
  check_refused_with(run({"laws", "-o", scratch.file("x.pdf")}), "this command writes no .pdf");
  check_refused_with(run({"check", servo, "-o", scratch.file("x.tex")}), "this command writes no .tex");
  check_refused_with(run({"check", servo, "--tex", scratch.file("x.tex")}), "unknown option '--tex'");
  check_refused_with(run({"claims", "--list", "--tex", scratch.file("x.tex")}), "this question has no tables");
  check_refused_with(run({"check", servo, "--hdf5", "-"}), "HDF5 goes to a file");
  check_refused_with(run({"check", servo, "--json", scratch.file("x"), "--hdf5", scratch.file("x")}), "goes already");
  CHECK(run({"check", servo, "-o", scratch.file("x.txt")}).code == 0);
}

TEST_CASE("files: HDF5 and tables of LaTeX, by a flag or by the ending of -o") {
  const Scratch scratch;
  const auto df = [&](const std::vector<std::string>& flags) {
    std::vector<std::string> words{"df",    shipped("df-lugre.toml"),  "--set", "df.amplitude=[1e-5, 1e-3]",
                                   "--set", "df.frequency=[1.0, 10.0]"};
    words.insert(words.end(), flags.begin(), flags.end());
    return run(words).code;
  };
  CHECK(df({"--hdf5", scratch.file("a.h5"), "--tex", scratch.file("a.tex")}) == 0);
  CHECK(df({"-o", scratch.file("b.h5")}) == 0);
  CHECK(df({"-o", scratch.file("b.tex")}) == 0);
  CHECK(scratch.get("a.h5").substr(0, 8) == "\x89HDF\r\n\x1a\n");
  CHECK(scratch.get("a.h5") == scratch.get("b.h5"));
  CHECK_THAT(scratch.get("a.tex"), Contains("\\begin{tabular}") && Contains("df-lugre.toml"));
  CHECK(scratch.get("a.tex") == scratch.get("b.tex"));
}

TEST_CASE("files: PDF is refused at once where nothing makes it") {
  const Scratch scratch;
  const std::string path = std::getenv("PATH");
  setenv("PATH", scratch.file("no-programs").c_str(), 1);
  check_refused_with(run({"check", shipped("pid-lugre.toml"), "-o", scratch.file("x.pdf")}), "install librsvg2-bin");
  setenv("PATH", path.c_str(), 1);
}

TEST_CASE("files: a name that is empty is refused") {
  const std::string servo = shipped("pid-lugre.toml");
  for (const char* flag : {"--json", "--csv", "-o"})
    check_refused_with(run({"check", servo, flag, ""}), "needs the name of a file");
  check_refused_with(
      run({"map", servo, "--x", "loop.controller.kp=1:5:2", "--y", "loop.controller.kd=1:9:2", "--store", ""}),
      "needs the name of a file");
  check_refused_with(run({"predict", servo, "--html", ""}), "needs the name of a file");
  CHECK(run({"check", ""}).code == 2);
  check_refused_with(run({"status", ""}), "STORE: needs the name of a file");
  check_refused_with(run({"check", servo, "--fit", ""}), "--fit: needs the name of a file");
  check_refused_with(run({"remedy", servo, "--apply", "", "-o", "fixed.toml"}), "--apply: needs a value");
  check_refused_with(run({"new", "--plant", ""}), "--plant: needs a value");
}

TEST_CASE("flags: a number is finite, a whole number is decimal and fits") {
  const std::string servo = shipped("pid-lugre.toml");
  check_refused_with(run({"dissipativity", servo, "--speed", "nan"}), "--speed: 'nan' is not a finite number");
  check_refused_with(run({"dissipativity", servo, "--top-speed", "inf"}), "'inf' is not a finite number");
  check_refused_with(run({"adequate", servo, "--spread", "nan"}), "'nan' is not a finite number");
  check_refused_with(run({"adequate", servo, "--tolerance", "-nan"}), "is not a finite number");
  check_refused_with(run({"check", servo, "--seed", "18446744073709551616"}), "too large");
  check_refused_with(run({"check", servo, "--seed", "0x10"}), "is not a whole number");
  check_refused_with(run({"check", servo, "--threads", "99999999999"}), "--threads");
  CHECK_THAT(run({"check", servo, "--seed", "010", "--json", "-"}).out, Contains("\"seed\":10,"));
  CHECK_THAT(run({"check", servo, "--seed", "18446744073709551615", "--json", "-"}).out,
             Contains("\"seed\":18446744073709551615,"));
}

TEST_CASE("flags: what is out of range is told with short numbers") {
  const std::string servo = shipped("pid-lugre.toml");
  check_refused_with(run({"dissipativity", servo, "--speed", "-1"}), "--speed: must be > 0, got '-1'");
  check_refused_with(run({"adequate", servo, "--tolerance", "2"}), "--tolerance: must lie in 1e-06 to 1, got '2'");
  check_refused_with(run({"check", servo, "--threads", "2000"}), "--threads: must lie in 0 to 1024, got '2000'");
  check_refused_with(run({"check", servo, "--time-limit", "1e300"}), "must lie in 0 to 1e+09, got '1e300'");
  check_refused_with(run({"check", servo, "--seed", "-1"}), "--seed: must be >= 0, got '-1'");
  check_refused_with(run({"check", servo, "--threads", std::string(5000, '9')}), "99999...'");
  for (const char* flag : {"--speed", "--top-speed"}) CHECK(run({"dissipativity", servo, flag, "0"}).err.size() < 120);
}

TEST_CASE("files: what could not be kept is refused before anything is computed") {
  // The superuser may write everywhere, without this capability only where its files say so.
  const std::string by = geteuid() == 0 ? "setpriv --bounding-set -dac_override " : "";
  REQUIRE(std::system((by + "true").c_str()) == 0);
  const Scratch scratch;
  const std::string folder = scratch.file("locked");
  std::filesystem::create_directory(folder);
  std::filesystem::permissions(folder, std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec);
  for (const char* flag : {"--json", "--csv", "-o", "--html", "--svg"})
    check_refused_with(run({"predict", shipped("pid-lugre.toml"), flag, folder + "/a"}, {}, by), "cannot be written");
  std::filesystem::permissions(folder, std::filesystem::perms::owner_all);
}

TEST_CASE("files: a name in a folder that does not exist, and a folder, are refused before anything is computed") {
  const Scratch scratch;
  for (const char* flag : {"--json", "--csv", "-o", "--html", "--svg"}) {
    check_refused_with(run({"predict", shipped("pid-lugre.toml"), flag, scratch.file("none/a")}), "cannot be written");
    check_refused_with(run({"predict", shipped("pid-lugre.toml"), flag, scratch.file("")}), "cannot be written");
  }
}

TEST_CASE("files: a document keeps link and permissions of the file in whose place it comes, and leaves no draft") {
  const Scratch scratch;
  const std::string file = scratch.put("a.json", "old"), link = scratch.file("link.json");
  std::filesystem::permissions(file, std::filesystem::perms::owner_read | std::filesystem::perms::owner_write);
  std::filesystem::create_symlink("a.json", link);
  CHECK(run({"check", shipped("pid-lugre.toml"), "--json", link}).code == 0);
  CHECK(std::filesystem::is_symlink(link));
  CHECK_THAT(scratch.get("a.json"), Contains("\"command\": \"check\""));
  CHECK(std::filesystem::status(file).permissions() ==
        (std::filesystem::perms::owner_read | std::filesystem::perms::owner_write));
  CHECK(std::distance(std::filesystem::directory_iterator(std::filesystem::path(file).parent_path()), {}) == 2);
}

TEST_CASE("files: help and version that cannot be written are a failed write") {
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"--help"}, {"predict", "--help"}, {"--version"}}) {
    const Ran ran = run(words, "> /dev/full");
    CHECK(ran.code == 3);
    CHECK_THAT(ran.err, Contains("cannot write to stdout: No space left on device"));
  }
}

TEST_CASE("files: a title that a spreadsheet would compute is kept a text in CSV, numbers stay numbers") {
  const Scratch scratch;
  for (const std::string title : {"=1+1", "+cmd", "-2 x", "@SUM(A1)"}) {
    const Ran ran = run({"check", shipped("pid-lugre.toml"), "--set", "title='" + title + "'", "--csv", "-"});
    CHECK_THAT(ran.out, Contains("\n'" + title + ",mass,pid"));
  }
  CHECK_THAT(run({"check", shipped("pid-lugre.toml"), "--set", "title='-2'", "--csv", "-"}).out, Contains("\n-2,mass"));
}

TEST_CASE("memory: what does not fit is refused with the number, before anything is computed") {
  // As on a machine with 2 GB of memory, of which AddressSanitizer itself takes more.
  if (limcycle::test::sanitized()) return;
  const auto refused = [](std::vector<std::string> words, const std::string& part) {
    std::string line = "ulimit -v 2000000; exec";
    for (const auto& word : words) line += " " + limcycle::test::quoted(word);
    const Scratch scratch;
    const int status = std::system(
        ("sh -c " + limcycle::test::quoted(line) + " > " + scratch.file("out") + " 2> " + scratch.file("err")).c_str());
    INFO(scratch.get("err"));
    CHECK(WEXITSTATUS(status) == 2);
    CHECK_THAT(scratch.get("err"), Contains(part) && Contains(" GB of memory; 2.05 GB are there; fewer "));
  };
  const std::string program = limcycle::test::tested_program, servo = shipped("pid-lugre.toml");
  refused({program, "df", shipped("df-lugre.toml"), "--set", "df.amplitude={from = 1e-6, to = 1.0, points = 1000000}",
           "--set", "df.frequency=[1.0, 2.0, 3.0]", "--set", "df.bias=[0.0]", "--set", "df.harmonics=1000"},
          "df: needs ");
  refused({program, "map", servo, "--x", "loop.controller.kp=1:5:10000", "--y", "loop.controller.kd=1:9:10000"},
          "--x, --y: needs ");
  refused({program, "map", servo, "--x", "loop.controller.kp=1:5:1300", "--y", "loop.controller.kd=1:9:1300", "--json",
           "-"},
          "--x, --y: needs ");
  refused({program, "sensitivity", servo, "--samples", "16777216"}, "--samples: needs ");
  refused({program, "simulate", shipped("tutorial-servo.toml"), "--set", "simulate.sample=1e-5", "--set",
           "simulate.duration=40.0", "--json", "-"},
          "simulate.sample: needs ");
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
  for (const char* command : {"predict", "margin", "dissipativity", "precision"}) {
    const Ran ran = run({command, file, "--time-limit", "0.05", "--json", scratch.file(odd + ".json")});
    harmless(ran.out + ran.err);
  }
  harmless(run({"map", file, "--x", "loop.controller.kp=1:5:2", "--y", "loop.controller.kd=1:9:2", "--time-limit",
                "0.05", "--store", scratch.file(odd + ".store")})
               .err);
  harmless(run({"status", scratch.file(odd + ".store")}).out);
  harmless(run({"predict", file, "--json", scratch.file("none/" + odd)}).err);
  harmless(run({"new", "-o", scratch.file(odd + ".new")}).err);
  harmless(run({"new", "--plant", odd}).err);
  harmless(run({odd}).err);
}
