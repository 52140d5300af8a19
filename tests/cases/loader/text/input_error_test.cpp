#include <catch2/catch.hpp>

#include "limcycle/cases/loader/text/input_error.hpp"

using namespace limcycle;

TEST_CASE("an error is one line: place, key, value, rule, suggestion") {
  CHECK(std::string(
            InputError(
                {.file = "f", .line = 3, .override = {}, .key = "a.b", .value = "1", .rule = "r", .suggestion = "s"})
                .what()) == "f:3: a.b = 1: r; s");
  CHECK(std::string(
            InputError({.file = "f", .line = 0, .override = {}, .key = {}, .value = {}, .rule = "r", .suggestion = {}})
                .what()) == "f: r");
  CHECK(
      std::string(
          InputError(
              {.file = "f", .line = 3, .override = "a.b=1", .key = "a.b", .value = "1", .rule = "r", .suggestion = {}})
              .what()) == "--set a.b=1: r");
  CHECK(std::string(
            InputError({.file = {}, .line = 0, .override = {}, .key = "k", .value = {}, .rule = "r", .suggestion = {}})
                .what()) == "k: r");
  CHECK(std::string(
            InputError(
                {.file = {}, .line = 0, .override = {}, .key = "--flag", .value = "v", .rule = "r", .suggestion = {}})
                .what()) == "--flag v: r");
  const InputError odd({.file = "a\nb",
                        .line = 1,
                        .override = {},
                        .key = "k\t",
                        .value = std::string("\x01\xFF"),
                        .rule = "r\n",
                        .suggestion = {}});
  CHECK(std::string(odd.what()) == "a\\x0Ab:1: k\\x09 = \\x01\\xFF: r\\x0A");
  CHECK(odd.fault().line == 1);
}

TEST_CASE("nearest name") {
  const std::vector<std::string> names = {"sigma0", "sigma1", "Fs", "Fc", "dead_zone", "kp"};
  CHECK(nearest_name("sigm0", names) == "sigma0");
  CHECK(nearest_name("sgima1", names) == "sigma1");
  CHECK(nearest_name("SIGMA0", names) == "sigma0");
  CHECK(nearest_name("dead-zone", names) == "dead_zone");
  CHECK(nearest_name("fs", names) == "Fs");
  CHECK(nearest_name("pk", names) == "kp");
  CHECK(nearest_name("mass", names).empty());
  CHECK(nearest_name("x", names).empty());
  CHECK(nearest_name("", names).empty());
  CHECK(nearest_name(std::string(100000, 's'), names).empty());
  CHECK(suggest("mass", names) == "known: sigma0, sigma1, Fs, Fc, dead_zone, kp");
  CHECK(suggest("sigma00", names) == "did you mean sigma0?");
}

TEST_CASE("text for one line") {
  CHECK(one_line("a\r\nb") == "a\\x0D\\x0Ab");
  CHECK(one_line("\xC3\xA9t\xC3\xA9") == "\xC3\xA9t\xC3\xA9");
  CHECK(one_line("\xC3") == "\\xC3");
  CHECK(one_line("a\xC2\x9B"
                 "31mb\xC2\xA0") == "a\\x9B31mb\xC2\xA0");  // C1, and a space that is no control
  CHECK(one_line("\xE2\x80\xAE"
                 "abc\xE2\x81\xA9\xD8\x9C") == "\\u202Eabc\\u2069\\u061C");  // directions
  CHECK(one_line("a\xE2\x80\xA8"
                 "b\xE2\x80\x94") == "a\\u2028b\xE2\x80\x94");  // a separator of lines, a dash
  CHECK(printable("a\n\tb\x1B[2J\r") == "a\n\tb\\x1B[2J\\x0D");
  CHECK(one_line("abcdef", 3) == "abc...");
  CHECK(one_line("\xC3\xA9\xC3\xA9\xC3\xA9", 2) == "\xC3\xA9\xC3\xA9...");
}

TEST_CASE("UTF-8") {
  std::size_t valid = 0;
  CHECK(is_utf8("plain \xE2\x82\xAC \xF0\x9F\x98\x80", valid));
  for (const auto* bad :
       {"\xC0\x80", "\xED\xA0\x80", "\xF4\x90\x80\x80", "\xE2\x82", "\x80", "\xF5\x80\x80\x80", "\xE0\x80\x80"}) {
    CHECK_FALSE(is_utf8(std::string("ab") + bad, valid));
    CHECK(valid == 2);
  }
}
