#include "limcycle/reports/format/table.hpp"

#include <catch2/catch.hpp>
#include <sstream>

#include "limcycle/tests/lines.hpp"

using namespace limcycle;
using namespace limcycle::test;

TEST_CASE("display width counts characters, not bytes") {
  CHECK(display_width("") == 0);
  CHECK(display_width("abc") == 3);
  CHECK(display_width("ω = 1") == 5);
  CHECK(display_width("e\xCC\x81") == 1);                 // e with a combining accent
  CHECK(display_width("\xE6\x91\xA9\xE6\x93\xA6") == 4);  // two wide characters
  CHECK(display_width("\xFF\xFE") == 2);                  // not UTF-8
  CHECK(display_width("\xE6\x91") == 2);                  // cut short
}

TEST_CASE("a table is aligned, with units and without trailing spaces") {
  const Table table{{{"name", "", Align::left}, {"period", "s"}, {"ω", "rad/s"}},
                    {{"a", "24.4", "0.25"}, {"Ångström", "7", "1234.5"}}};
  CHECK(table.text() ==
        "name      period        ω\n"
        "             [s]  [rad/s]\n"
        "-------------------------\n"
        "a           24.4     0.25\n"
        "Ångström       7   1234.5\n");
}

TEST_CASE("a per cent sign stays with its number at the end of a line") {
  CHECK(wrapped("errors of about 72 % of it", 18) == "errors of about\n72 % of it\n");
  CHECK(wrapped("errors of about 72 %", 18) == "errors of about\n72 %\n");
  CHECK(wrapped("72 %, or more", 5) == "72 %,\nor\nmore\n");
  CHECK(wrapped("% of it", 4) == "% of\nit\n");
}

TEST_CASE("notes are listed under their heading, each under its own mark") {
  CHECK(notes_text({}) == "");
  CHECK(notes_text({"one", "two"}) == "\nNotes\n-  one\n-  two\n");
  CHECK(item("a", 3, "b") == "a    b\n");
}

TEST_CASE("a table that is too wide is turned") {
  Table table{{{"first one", "s"}, {"second", ""}}, {{"1", "x"}, {"22", "y"}, {"333", "z"}}};
  CHECK(table.text(80).substr(0, 9) == "first one");
  table.columns[1].heading = std::string(70, 'h');
  const auto lines = lines_of(table.text(80));
  REQUIRE(lines.size() == 5);  // two rows fit next to the labels, the third follows after an empty line
  CHECK(lines[0] == "first one [s]" + std::string(57, ' ') + "  1  22");
  CHECK(lines[1] == table.columns[1].heading + "  x   y");
  CHECK(lines[2].empty());
  CHECK(lines[3] == "first one [s]" + std::string(57, ' ') + "  333");
}

TEST_CASE("cells cannot break the table") {
  const Table table{{{"a", ""}}, {{"x\ny\tz\x1b[31m"}}};
  CHECK(table.text() == "         a\n----------\nx y z [31m\n");
  const Table wrong{{{"a", ""}, {"b", ""}}, {{"only one"}}};
  CHECK_THROWS_AS(wrong.text(), std::invalid_argument);
}

TEST_CASE("text is wrapped at spaces") {
  CHECK(wrapped("one two three", 7) == "one two\nthree\n");
  CHECK(wrapped("one two three", 9, 2) == "  one two\n  three\n");
  CHECK(wrapped("incomprehensibilities", 5) == "incomprehensibilities\n");
  CHECK(wrapped("") == "\n");
}
