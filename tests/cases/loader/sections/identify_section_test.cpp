#include <catch2/catch.hpp>

#include "limcycle/tests/cases/message.hpp"

using namespace limcycle;
using namespace limcycle::test;
using Catch::Matchers::Contains;

namespace {

const std::string one_record = "[[identify.record]]\nkind = \"lag\"\nfile = \"lag.csv\"\n";

std::string identify_message(const std::string& keys, const std::string& records = one_record) {
  return message("[identify]\n" + keys + "\n" + records);
}

}  // namespace

TEST_CASE("identify section: a case may hold records only") {
  const Case from = read_case("[identify]\nlaw = \"lugre\"\n" + one_record, "folder/a.toml");
  REQUIRE(from.identify);
  CHECK_FALSE(from.loop);
  CHECK_FALSE(from.element);
  CHECK(from.identify->laws.size() == 1);
  CHECK(from.identify->records.front().path == "folder/lag.csv");
  CHECK_THROWS_AS(need_loop(from), InputError);
  CHECK_THROWS_AS(df_element(from), InputError);
  CHECK(read_case("[identify]\n" + one_record, "a.toml").identify->laws.size() == 6);
}

TEST_CASE("identify section: columns, scales and choices are read") {
  const Case from = read_case(
      "[identify]\nlaw = [\"lugre\", \"gms\"]\nfree = [\"delta\"]\nfixed = {sigma2 = 0.0}\nelements = 3\n"
      "[[identify.record]]\nkind = \"pre-sliding\"\nfile = \"a.csv\"\ntime = 1\nposition = \"x\"\nforce = 4\n"
      "scale = {position = 1e-3}\nskip = 0.5\nforce_limit = 9\nweight = \"w\"\nloss = \"huber\"\n",
      "a.toml");
  const auto& section = *from.identify;
  CHECK(section.laws.size() == 2);
  CHECK(section.choice.free == std::vector<std::string>{"delta"});
  CHECK(section.choice.fixed.front().first == "sigma2");
  CHECK(section.choice.elements == 3);
  const auto& record = section.records.front();
  CHECK(std::get<std::size_t>(*record.columns[0]) == 1);
  CHECK(std::get<std::string>(*record.columns[1]) == "x");
  CHECK_FALSE(record.columns[2]);
  CHECK(record.scale[1] == 1e-3);
  CHECK(record.skip == 0.5);
  CHECK(record.force_limit == 9.0);
  CHECK(std::get<std::string>(*record.weight) == "w");
  CHECK(record.huber);
  // A key of one law only.
  CHECK(
      read_case("[identify]\nfree = [\"vd\"]\nfixed = {sigma1 = 3.0}\n" + one_record, "a.toml").identify->laws.size() ==
      6);
}

TEST_CASE("identify section: free motions need the plant that moves") {
  const std::string record =
      "[identify]\nlaw = \"coulomb\"\n[[identify.record]]\nkind = \"free\"\nhold = \"zero-order\"\n";
  const auto said = [&](const std::string& loop) {
    try {
      rig_of(read_case(loop + record + "file = \"a.csv\"\n", "a.toml"));
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("fine");
  };
  const std::string friction = "[loop.friction]\nkind = \"coulomb\"\nFc = 1.0\n";
  CHECK_THAT(said(""), Contains("loop.plant") && Contains("is required by records of kind free"));
  CHECK_THAT(said("[loop.plant]\nkind = \"two-mass\"\nmotor_mass = 1.0\nload_mass = 1.0\nstiffness = 9.0\n" + friction),
             Contains("loop.plant") && Contains("has 4 states"));
  CHECK(said("[loop.plant]\nkind = \"mass\"\nmass = 1.0\n" + friction) == "fine");
  CHECK(read_case(record + "file = \"a.csv\"\n", "a.toml").identify->records.front().holds_force);
}

TEST_CASE("identify section: what is wrong is said") {
  CHECK_THAT(identify_message("law = \"lugr\""), Contains("identify.law") && Contains("did you mean lugre?"));
  CHECK_THAT(identify_message("law = \"bouc-wen\""),
             Contains("cannot be identified yet") && Contains("elasto-plastic"));
  CHECK_THAT(identify_message("law = [\"lugre\", \"lugre\"]"), Contains("stands twice"));
  CHECK_THAT(identify_message("law = []"), Contains("must not be empty"));
  CHECK_THAT(identify_message("lows = 1"), Contains("unknown key") && Contains("law, record"));
  CHECK_THAT(identify_message("fixed = {sigma9 = 1.0}"),
             Contains("identify.fixed.sigma9") && Contains("none of the laws") && Contains("did you mean sigma"));
  CHECK_THAT(identify_message("law = \"coulomb\"\nfree = [\"vs\"]"), Contains("none of the laws"));
  CHECK_THAT(identify_message("law = \"gms\"\nfixed = {k = 1.0}"), Contains("is no single number of gms"));
  CHECK_THAT(identify_message("fixed = {Fc = -1.0}"), Contains("identify.fixed.Fc") && Contains("must be > 0 N"));
  CHECK_THAT(identify_message("free = [\"delta\"]\nfixed = {delta = 1.0}"), Contains("is in `free` too"));
  CHECK_THAT(message("[identify]\nlaw = \"lugre\"\n"), Contains("identify.record") && Contains("required"));
  const auto with_record = [](const std::string& keys) { return identify_message("", "[[identify.record]]\n" + keys); };
  CHECK_THAT(with_record("kind = \"free-decay\"\nfile = \"a.csv\"\nforce = 2\n"),
             Contains("record[0].force") && Contains("moves without a force"));
  CHECK_THAT(with_record("kind = \"free\"\nfile = \"a.csv\"\nforce_limit = 2.0\n"),
             Contains("record[0].force_limit") && Contains("does not measure"));
  CHECK_THAT(with_record("kind = \"free\"\nfile = \"a.csv\"\nhold = \"first-order\"\n"), Contains("zero-order"));
  CHECK_THAT(with_record("kind = \"free\"\nfile = \"a.csv\"\nloss = \"huber\"\n"),
             Contains("record[0].loss") && Contains("fitted by squares"));
  CHECK_THAT(with_record("kind = \"lag\"\nfile = \"a.csv\"\nloss = \"hubert\"\n"), Contains("did you mean \"huber\"?"));
  CHECK_THAT(with_record("kind = \"lag\"\nfile = \"a.csv\"\nweight = 0\n"), Contains("weight"));
  CHECK_THAT(with_record("kind = \"lag\"\nfile = \"a.csv\"\nhold = \"linear\"\n"), Contains("record[0].hold"));
  CHECK_THAT(with_record("kind = \"leg\"\nfile = \"a.csv\"\n"), Contains("did you mean"));
  CHECK_THAT(with_record("kind = \"lag\"\n"), Contains("file"));
  CHECK_THAT(with_record("kind = \"lag\"\nfile = \"a.csv\"\ntime = 0\n"), Contains("time"));
  CHECK_THAT(with_record("kind = \"lag\"\nfile = \"a.csv\"\ntime = 1.5\n"), Contains("name of a column"));
  CHECK_THAT(with_record("kind = \"lag\"\nfile = \"a.csv\"\nscale = {time = -1.0}\n"), Contains("scale.time"));
  CHECK_THAT(with_record("kind = \"lag\"\nfile = \"a.csv\"\nforce_limit = 0.0\n"), Contains("must be > 0 N"));
  CHECK_THAT(with_record("kind = \"lag\"\nfile = \"a.csv\"\nscale = {weight = 1.0}\n"), Contains("weight"));
}
