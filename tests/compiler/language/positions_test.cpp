#include "compiler/language/positions.h"

#include <doctest/doctest.h>

#include <string>

using namespace probe::language;

TEST_CASE("positions count UTF-16 units: two of what lies beyond the first plane") {
  const std::string text = "a\xc3\xa9\xf0\x9f\x99\x82z\nb";  // a, e acute, a smiling face, z
  const Lines lines(text);
  CHECK(lines.position(3) == Position{0, 2});
  CHECK(lines.position(7) == Position{0, 4});
  CHECK(lines.offset({0, 4}) == 7);
  CHECK(lines.offset({0, 3}) == 3);  // between its two units
  CHECK(lines.position(5) == Position{0, 2});
  CHECK(lines.position(9) == Position{1, 0});
}

TEST_CASE("what lies behind a line or the text is its end") {
  const Lines lines("ab\r\ncd\re");
  CHECK(lines.offset({0, 99}) == 2);
  CHECK(lines.offset({1, 0}) == 4);
  CHECK(lines.offset({2, 0}) == 7);
  CHECK(lines.offset({9, 0}) == 8);
  CHECK(lines.position(99) == Position{2, 1});
}

TEST_CASE("a byte order mark is no character, and no bytes are too strange") {
  CHECK(Lines("\xef\xbb\xbfuse").position(3) == Position{0, 0});
  CHECK(Lines("\xef\xbb\xbfuse").offset({0, 0}) == 3);
  const std::string torn = "\xf0\x9f\n\xff\xc3";
  const Lines lines(torn);
  for (std::uint32_t i = 0; i <= torn.size(); ++i) CHECK(lines.offset(lines.position(i)) <= i);
}
