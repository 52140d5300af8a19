#include <catch2/catch.hpp>

#include "limcycle/tests/cli/program.hpp"

// Bad input, as seen by the user: exit code 2, one line on stderr that names file, line, key, value and rule, and
// nothing on stdout.

using limcycle::test::Ran;
using limcycle::test::run;
using limcycle::test::Scratch;
using limcycle::test::shipped;

namespace {

const std::string servo = R"(title = "t"
[loop.plant]
kind = "mass"
mass = 1.0
[loop.controller]
kind = "pid"
kp = 3.0
[loop.friction]
kind = "lugre"
Fs = 1.5
Fc = 1.0
vs = 0.001
sigma0 = 1e5
[search]
amplitude = [1e-6, 1.0]
frequency = [0.01, 1000.0]
)";

void check_refused(const Ran& ran, const std::string& message) {
  CHECK(ran.code == 2);
  CHECK(ran.out.empty());
  CHECK(ran.err == "limcycle: " + message + "\n");
}

struct Bad {
  const char *name, *from, *to, *message;
};

const Bad bad_values[] = {
    {"misspelt key", "sigma0", "sigm0", ":13: loop.friction.sigm0: unknown key; did you mean sigma0?"},
    {"unknown key", "kp = 3.0", "kp = 3.0\nspeed = 1",
     ":8: loop.controller.speed: unknown key; known: kind, kp, ki, kd, tf, leak, integral_limit, integral_band, "
     "integral_dead_zone, integral_hysteresis, integral_reset, reset_interval, reset_speed, impulse, impulse_width, "
     "impulse_pause, impulse_band, "
     "impulse_speed, "
     "sample_time, computation_delay, input_step, output_step, velocity_window, hold, "
     "friction_compensation, "
     "saturation, lag"},
    {"unknown section", "[search]", "[nonsense]",
     ":14: nonsense: unknown key; known: title, loop, diagram, units, search, df, simulate, predict, sensitivity, "
     "dissipativity, "
     "claim, identify"},
    {"misspelt kind", "\"lugre\"", "\"lugree\"",
     ":9: loop.friction.kind = \"lugree\": unknown friction law; did you mean \"lugre\"?"},
    {"a key of another kind", "\"lugre\"", "\"karnopp\"",
     ":13: loop.friction.sigma0: unknown key; did you mean sigma2?"},
    {"wrong type", "mass = 1.0", "mass = \"abc\"", ":4: loop.plant.mass = \"abc\": must be a number, found a string"},
    {"list for a number", "mass = 1.0", "mass = [1.0]", ":4: loop.plant.mass = [1]: must be a number, found a list"},
    {"missing parameter", "vs = 0.001\n", "", ":8: loop.friction.vs: is required: Stribeck velocity, m/s"},
    {"missing kind", "kind = \"pid\"\n", "",
     ":5: loop.controller.kind: is required: which controller (none, pid, transfer-function, state-space, cascade)"},
    {"NaN", "mass = 1.0", "mass = nan", ":4: loop.plant.mass = nan: must be a finite number"},
    {"infinity", "kp = 3.0", "kp = inf", ":7: loop.controller.kp = inf: must be a finite number"},
    {"negative mass", "mass = 1.0", "mass = -1.0", ":4: loop.plant.mass = -1: must be > 0 kg"},
    {"zero mass", "mass = 1.0", "mass = 0", ":4: loop.plant.mass = 0: must be > 0 kg"},
    {"Fs < Fc", "Fs = 1.5", "Fs = 0.5", ":10: loop.friction.Fs = 0.5: must be at least Fc = 1 N"},
    {"vs = 0", "vs = 0.001", "vs = 0.0", ":12: loop.friction.vs = 0: must be > 0 m/s"},
    {"reversed search range", "[1e-6, 1.0]", "[1.0, 1e-6]",
     ":15: search.amplitude = [1, 1e-06]: must be two numbers [from, to] with 0 < from < to"},
    {"empty search range", "[0.01, 1000.0]", "[]",
     ":16: search.frequency = []: must be two numbers [from, to] with 0 < from < to, rad/s"},
    {"mixed list", "[0.01, 1000.0]", "[0.01, \"x\"]",
     ":16: search.frequency[1] = \"x\": must be a number, found a string"},
    {"large integer", "mass = 1.0", "mass = 9007199254740993",
     ":4: loop.plant.mass = 9007199254740993: is too large for an exact integer; write it with a decimal point or an "
     "exponent"},
    {"friction on a plant of relative degree 1", "kind = \"mass\"\nmass = 1.0",
     "kind = \"transfer-function\"\nnumerator = [1]\ndenominator = [1, 1]",
     ":2: loop.plant: needs relative degree 2 or more from force to position when there is friction"},
    {"improper transfer function", "kind = \"mass\"\nmass = 1.0",
     "kind = \"transfer-function\"\nnumerator = [1, 0, 0]\ndenominator = [1, 1]",
     ":4: loop.plant.numerator = [1, 0, 0]: the numerator has a higher degree than the denominator"},
    {"improper controller", "kind = \"pid\"\nkp = 3.0",
     "kind = \"transfer-function\"\nnumerator = [1, 0, 0]\ndenominator = [1, 1]",
     ":7: loop.controller.numerator = [1, 0, 0]: the numerator has a higher degree than the denominator"},
    {"non-causal delay", "kind = \"mass\"\nmass = 1.0",
     "kind = \"transfer-function\"\nnumerator = [1]\ndenominator = [1, 1, 1]\ndelay = -1",
     ":6: loop.plant.delay = -1: must be >= 0 s"},
    {"ragged matrix", "kind = \"mass\"\nmass = 1.0",
     "kind = \"state-space\"\nA = [[0, 1], [2]]\nB = [[0], [1]]\nC = [[1, 0]]",
     ":4: loop.plant.A[1] = [2]: must have 2 entries like the first row, found 1"},
};

}  // namespace

TEST_CASE("bad values in a case file") {
  const Scratch scratch;
  REQUIRE(run({"check", scratch.put("a.toml", servo)}).code == 0);
  for (const auto& bad : bad_values) {
    INFO(bad.name);
    std::string text = servo;
    text.replace(text.find(bad.from), std::string(bad.from).size(), bad.to);
    const std::string file = scratch.put("a.toml", text);
    check_refused(run({"check", file}), file + bad.message);
  }
}

TEST_CASE("the commands that compute refuse the same") {
  const Scratch scratch;
  std::string text = servo;
  const std::string file = scratch.put("a.toml", text.replace(text.find("mass = 1.0"), 10, "mass = -1"));
  for (const auto* command : {"predict", "df", "simulate"})
    check_refused(run({command, file}), file + ":4: loop.plant.mass = -1: must be > 0 kg");
  const std::string lone = scratch.put("b.toml", "[loop.element]\nkind = \"relay\"\nlevel = 1\n");
  check_refused(run({"predict", lone}),
                lone + ": loop.plant: is required by this command: the case holds a lone element");
  check_refused(run({"df", lone}), lone + ": df: is required by this command: add [df] with amplitude and frequency");
}

TEST_CASE("absurd sizes") {
  const Scratch scratch;
  const auto df = [&](const std::string& body) {
    return scratch.put("a.toml", "[loop.friction]\nkind = \"coulomb\"\nFc = 1.0\n[df]\n" + body);
  };
  std::string file =
      df("amplitude = {from = 1, to = 2, points = 100000}\nfrequency = {from = 1, to = 2, points = 100000}\n");
  check_refused(run({"df", file}), file + ":4: df: must have at most 5000000 points, found 100000 x 100000 x 1");
  file = df("amplitude = {from = 1, to = 2, points = 1000000000000}\nfrequency = [1]\n");
  check_refused(run({"df", file}), file + ":5: df.amplitude.points = 1000000000000: must be in 1 .. 1000000");
  std::string list = "1";
  for (int i = 0; i < 1000; ++i) list += ",1";
  file = scratch.put("a.toml",
                     "[loop.plant]\nkind = \"transfer-function\"\nnumerator = [1]\ndenominator = [" + list + "]\n");
  check_refused(run({"check", file}), file + ":4: loop.plant.denominator: must have at most 201 entries, found 1001");
}

TEST_CASE("files that are no case files") {
  const Scratch scratch;
  const auto refused = [&](std::string_view bytes, const std::string& message) {
    const std::string file = scratch.put("a.toml", bytes);
    check_refused(run({"check", file}), file + message);
  };
  refused("", ":1: the file is empty: a case needs at least [loop]");
  refused(std::string_view("\x7F"
                           "ELF\x02\0\0\n",
                           8),
          ":1: not a text file (it holds a zero byte): a case file is TOML in UTF-8");
  refused("# fine\n\xFF\xFE\n", ":2: not a text file in UTF-8: a case file is TOML");
  refused(std::string(2 << 20, '#'), ": is larger than 1 MiB, the limit for a case file");
  refused("x = " + std::string(100000, '['), ":1: nested too deeply for a case");
  refused("x = 3\n",
          ":1: x: unknown key; known: title, loop, diagram, units, search, df, simulate, predict, sensitivity, "
          "dissipativity, claim, identify");
  check_refused(run({"check", scratch.file("")}), scratch.file("") + ": is a directory, not a case file");
  check_refused(run({"check", scratch.file("none.toml")}), scratch.file("none.toml") + ": no such file");
  check_refused(run({"check", "a\nb"}), "a\\x0Ab: no such file");
  check_refused(run({"check", ""}), "'': the name of the case file is empty");
  check_refused(run({"check", "/dev/zero"}), "/dev/zero: is larger than 1 MiB, the limit for a case file");
}

TEST_CASE("a file that may not be read") {
  const Scratch scratch;
  const std::string file = scratch.put("a.toml", servo);
  std::filesystem::permissions(file, std::filesystem::perms::none);
  if (std::ifstream(file)) {  // the superuser can read everything: a broken link then serves as the unreadable file
    std::filesystem::create_symlink(scratch.file("gone"), scratch.file("link"));
    check_refused(run({"check", scratch.file("link")}), scratch.file("link") + ": no such file");
  } else {
    check_refused(run({"check", file}), file + ": cannot be read: Permission denied");
  }
}

TEST_CASE("text that is not TOML: line, column, one message") {
  const Scratch scratch;
  for (const auto& [text, place] :
       std::vector<std::pair<std::string, std::string>>{{servo + "x = = 1\n", ":17: not valid TOML at column 5: "},
                                                        {servo + "[search]\n", ":17: not valid TOML at column "},
                                                        {servo + "amplitude = 1\n", ":17: not valid TOML at column "},
                                                        {"[loop\n", ":1: not valid TOML at column 6: "}}) {
    const std::string file = scratch.put("a.toml", text);
    const Ran ran = run({"check", file});
    CHECK(ran.code == 2);
    CHECK(ran.out.empty());
    CHECK(ran.err.starts_with("limcycle: " + file + place));
    CHECK(ran.err.find('\n') == ran.err.size() - 1);
  }
}

TEST_CASE("override --set is refused by its own name") {
  const std::string file = shipped("pid-lugre.toml");
  check_refused(
      run({"check", file, "--set", "loop.controller.kd=x y"}).code == 2 ? Ran{2, "", "limcycle: ok\n"} : Ran{}, "ok");
  check_refused(run({"check", file, "--set", "loop.plant.mass=-1"}), "--set loop.plant.mass=-1: must be > 0 kg");
  check_refused(run({"check", file, "--set", "loop.plant.mas=1"}),
                "--set loop.plant.mas=1: unknown key; did you mean mass?");
  check_refused(run({"check", file, "--set", "loop.plant.mass"}),
                "--set loop.plant.mass: must be PATH=VALUE, such as loop.controller.kd=6.0");
  check_refused(run({"check", file, "--set", "search.amplitude=[2, 1]"}),
                "--set search.amplitude=[2, 1]: must be two numbers [from, to] with 0 < from < to");
  const Ran word = run({"check", file, "--set", "loop.controller.kind=pid"});
  CHECK(word.code == 2);
  CHECK(word.err.ends_with("a string needs quotes: 'loop.controller.kind=\"pid\"'\n"));
}

TEST_CASE("wrong usage") {
  const std::string file = shipped("pid-lugre.toml");
  check_refused(run({}), "a command is needed; 'limcycle --help' lists them");
  check_refused(run({"chekc", file}), "unknown command 'chekc'; did you mean check?");
  check_refused(run({"check"}), "check: CASE is required");
  check_refused(run({"check", file, file}), "check: unexpected argument '" + file + "'");
  check_refused(run({"check", file, "--jsn", "-"}), "check: unknown option '--jsn'; did you mean --json?");
  check_refused(run({"check", file, "--isa", "sse9"}), "check: --isa: sse9 not in {auto,x86-64,x86-64-v3,x86-64-v4}");
  CHECK(run({"check", file, "--threads", "many"}).code == 2);
  CHECK(run({"check", file, "--seed", "-1"}).code == 2);
  CHECK(run({"check", file, "--json"}).code == 2);
  CHECK(run({"--nonsense"}).code == 2);
  check_refused(run({"laws", "lugree"}), "laws: unknown kind 'lugree'; did you mean lugre?");
}

TEST_CASE("results that cannot be written") {
  const std::string file = shipped("pid-lugre.toml");
  check_refused(run({"check", file, "--json", "/nonexistent/x"}),
                "--json /nonexistent/x: cannot be written: No such file or directory");
  check_refused(run({"check", file, "-o", "/tmp"}), "--output /tmp: cannot be written: Is a directory");
  check_refused(run({"check", file, "--json", "-", "--csv", "-"}), "--csv -: is where --json goes already");

  const Ran full = run({"check", file, "--json", "/dev/full"});
  CHECK(full.code == 3);
  CHECK(full.err == "limcycle: cannot write to /dev/full: No space left on device\n");
  CHECK(full.out == run({"check", file}).out);

  const Ran stdout_full = run({"check", file}, "> /dev/full");
  CHECK(stdout_full.code == 3);
  CHECK(stdout_full.err == "limcycle: cannot write to stdout: No space left on device\n");
}

TEST_CASE("a refused case leaves no empty result file behind, and an old one as it was") {
  const Scratch scratch;
  CHECK(run({"check", shipped("pid-lugre.toml"), "--set", "loop.plant.mass=0", "--json", scratch.file("new")}).code ==
        2);
  CHECK_FALSE(std::filesystem::exists(scratch.file("new")));
  scratch.put("old", "before");
  CHECK(run({"check", shipped("pid-lugre.toml"), "--json", scratch.file("old"), "--csv", "/nonexistent/x"}).code == 2);
  CHECK(scratch.get("old") == "before");
}

TEST_CASE("a case that check accepts is no wrong input to predict, whatever its numbers: what failed is a note") {
  const Scratch scratch;
  const std::string stages = scratch.file("quantized.toml");
  run({"new", "--plant", "two-mass", "--controller", "state-space", "--error", "quantizer", "-o", stages});
  const std::vector<std::vector<std::string>> cases{
      {shipped("two-mass-drive.toml"), "--set", "loop.friction.Fs=1.7e308"},
      {stages, "--set", "loop.plant.load_mass=292.6", "--set", "loop.controller.lag=0.005"}};
  for (auto words : cases) {
    INFO(words[0] << ' ' << words[2]);
    words.insert(words.begin(), "check");
    REQUIRE(run(words).code == 0);
    words.front() = "predict";
    words.insert(words.end(), {"--time-limit", "3", "--json", "-"});
    const Ran ran = run(words);
    CHECK((ran.code == 0 || ran.code == 3));
    CHECK(ran.out.starts_with("{\n  \"schema\": \"limcycle/1\""));
  }
}
