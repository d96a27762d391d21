#include "runtime/base/printable.h"

#include <doctest/doctest.h>

namespace probe {

TEST_CASE("text stays, controls are blanks and what is no UTF-8 question marks") {
  CHECK(printable("put it \xe2\x86\x92 there, \xc3\xa4\xf0\x9f\xa5\x95", 100) ==
        "put it \xe2\x86\x92 there, \xc3\xa4\xf0\x9f\xa5\x95");
  CHECK(printable("a\x1b[2J\nb\x7f\xc2\x9b", 100) == "a [2J b  ");
  CHECK(printable("\xff\xc0\xaf\xed\xa0\x80\xf4\x90\x80\x80\xc3", 100) == "???????????");
}

TEST_CASE("a long text is cut between characters and says so") {
  CHECK(printable("abcdef", 6) == "abcdef");
  CHECK(printable("abcdefg", 6) == "abcdef...");
  CHECK(printable("abcde\xc3\xa4", 6) == "abcde...");
}

TEST_CASE("a text is printable or it is not") {
  CHECK(is_printable(""));
  CHECK(is_printable("pi0 \xc3\xa4?"));
  CHECK(!is_printable("a\nb"));
  CHECK(!is_printable("a\x1b[2J"));
  CHECK(!is_printable("\xff"));
}

}  // namespace probe
