#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <random>

#include "limcycle/models/friction/bristle/lugre.hpp"
#include "limcycle/tests/cases/message.hpp"

using namespace limcycle;
using limcycle::test::lone_law;
using limcycle::test::message;
using limcycle::test::servo;

namespace {

std::string load_message(const std::string& file) {
  try {
    load_case(file);
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

}  // namespace

TEST_CASE("every shipped case file is valid, has a title, and says in a comment what it shows and its source") {
  int files = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(std::string(LIMCYCLE_SOURCE_DIR) + "/cases")) {
    if (entry.path().extension() != ".toml") continue;
    INFO(entry.path());
    ++files;
    const Case from = load_case(entry.path().string());
    CHECK(from.title != entry.path().stem());
    CHECK((from.loop || (from.element && from.df)));
    if (from.loop) CHECK(from.predict.search);
    std::ifstream in(entry.path());
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    CHECK(text.starts_with("# "));
    CHECK(text.find("\n# Source: ") != std::string::npos);
    CHECK(from.sha256 == sha256(text));
  }
  CHECK(files >= 11);
}

TEST_CASE("the default case holds the published numbers") {
  const Case from = load_case(std::string(LIMCYCLE_SOURCE_DIR) + "/cases/pid-lugre.toml");
  const auto& lugre = law_of<LuGre<double>>(*from.loop->friction);
  CHECK(std::get<Mass>(from.loop->plant).mass == 1.0);
  const auto& pid = std::get<Pid>(from.loop->controller);
  CHECK((pid.kp == 3.0 && pid.ki == 4.0 && pid.kd == 6.0 && pid.tf == 0.0));
  CHECK((lugre.Fs == 1.5 && lugre.Fc == 1.0 && lugre.vs == 0.001 && lugre.sigma0 == 1e5 && lugre.sigma2 == 0.4));
  CHECK(lugre.sigma1 == std::sqrt(1e5));
  CHECK(from.predict.search->amplitude_max == 1.0);
}

TEST_CASE("SHA-256: the vectors of FIPS 180-4 and of the empty text") {
  CHECK(sha256("abc") == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  CHECK(sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq") ==
        "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  CHECK(sha256("") == "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  CHECK(sha256(std::string(1000000, 'a')) == "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST_CASE("the digest is of the bytes of the file, whatever is overridden") {
  const Case plain = read_case(lone_law, "a.toml"), changed = read_case(lone_law, "a.toml", {"loop.friction.Fc=2"});
  CHECK(plain.sha256 == sha256(lone_law));
  CHECK(changed.sha256 == plain.sha256);
}

TEST_CASE("files that are no case files") {
  const auto folder =
      std::filesystem::temp_directory_path() / ("limcycle-file-test-" + std::to_string(std::random_device{}()));
  std::filesystem::create_directories(folder);
  const std::string file = (folder / "a.toml").string();
  const auto put = [&](std::string_view bytes) {
    std::ofstream(file, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    return load_message(file);
  };
  CHECK(load_message(folder.string()) == folder.string() + ": is a directory, not a case file");
  CHECK(load_message(file) == file + ": no such file");
  CHECK(load_message(file + "/x") == file + "/x: no such file");
  CHECK(load_message("") == "'': the name of the case file is empty");
  CHECK(put("") == file + ":1: the file is empty: a case needs at least [loop]");
  CHECK(put(" \n\n") == file + ":1: the file is empty: a case needs at least [loop]");
  CHECK(put(std::string_view("a = 1\n\0", 7)) ==
        file + ":2: not a text file (it holds a zero byte): a case file is TOML in UTF-8");
  CHECK(put("a = 1\nb = \"\xC3\x28\"\n") == file + ":2: not a text file in UTF-8: a case file is TOML");
  CHECK(put("\xFF\xFE[\n") == file + ":1: not a text file in UTF-8: a case file is TOML");
  CHECK(put(std::string(largest_case_file + 1, '#')) == file + ": is larger than 1 MiB, the limit for a case file");
  CHECK(put("\xEF\xBB\xBF" + lone_law) == "");  // a byte-order mark is no error
  CHECK(put("# \xC3\xA9\r\n" + lone_law) == "");
  std::filesystem::remove_all(folder);
}

TEST_CASE("TOML mistakes are told with line and column") {
  CHECK(message("[loop\n").starts_with("a.toml:1: not valid TOML at column 6: "));
  CHECK(message(lone_law + "x = \n").starts_with("a.toml:4: not valid TOML at column "));
  CHECK(message(lone_law + "Fc = 2.0\n").starts_with("a.toml:4: not valid TOML at column "));
  CHECK(message(lone_law + "Fc = 2.0\n").find("'Fc'") != std::string::npos);
  CHECK(message(lone_law + "[loop.friction]\n").starts_with("a.toml:4: not valid TOML"));
  CHECK(message(lone_law + "x = 99999999999999999999\n").starts_with("a.toml:4: not valid TOML"));
  CHECK(message(lone_law + "x = abc\n").starts_with("a.toml:4: not valid TOML"));
  CHECK(message(lone_law + "x = \"abc\n").starts_with("a.toml:4: not valid TOML"));
  for (const auto& text : {"[loop\n", "x = [1,\n2", "a.b.c = {x = 1\n"})
    CHECK(message(text).find('\n') == std::string::npos);
}

TEST_CASE("what is nested too deeply for the stack is refused before it is parsed") {
  const auto repeated = [](const std::string& part, int times) {
    std::string text;
    for (int i = 0; i < times; ++i) text += part;
    return text;
  };
  const std::string rule = ": nested too deeply for a case";
  CHECK(message("x = " + repeated("[", 100000)) == "a.toml:1" + rule);
  CHECK(message("\nx = " + repeated("{a=", 100000)) == "a.toml:2" + rule);
  CHECK(message("a" + repeated(".a", 100000) + " = 1\n") == "a.toml:1" + rule);
  CHECK(message("[a" + repeated(".a", 100000) + "]\n") == "a.toml:1" + rule);
  CHECK(message("[a" + repeated(" . \"a\"", 100000) + "]\n") == "a.toml:1" + rule);
  CHECK(message("a = {a" + repeated(".a", 100000) + " = 1}\n") == "a.toml:1" + rule);
  CHECK(message(lone_law, {"a" + repeated(".a", 10000) + "=1"}).ends_with(": PATH has too many parts"));
  CHECK(message(lone_law, {"a={a" + repeated(".a", 10000) + "=1}"}).ends_with(rule));
  // Dots and brackets in comments, strings and long lists are harmless.
  CHECK(message("# " + repeated("[.", 500) + "\ntitle = \"" + repeated("[.", 500) + "\\\"\"\n" + lone_law).empty());
  CHECK(message("title = \"\"\"" + repeated("[.\n", 500) + "\"\"\"\n" + lone_law).empty());
  CHECK(message("title = '" + repeated("{.", 500) + "'\n" + lone_law + "[df]\nfrequency = [1]\namplitude = [1" +
                repeated(", 1.5", 500) + "]\n")
            .empty());
}
