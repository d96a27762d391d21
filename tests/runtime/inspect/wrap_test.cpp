#include "runtime/inspect/wrap.h"

#include <doctest/doctest.h>

using namespace probe::inspect;

TEST_CASE("lines break at blanks, and a word that is too long has a line of its own") {
  using Lines = std::vector<std::string>;
  CHECK(lines_of("", 10) == Lines{""});
  CHECK(lines_of("one two", 10) == Lines{"one two"});
  CHECK(lines_of("one two three", 7) == Lines{"one two", "three"});
  CHECK(lines_of("a incomprehensible b", 5) == Lines{"a", "incomprehensible", "b"});
  CHECK(wrapped("one two three", 9) == "one two\n  three");
}
