#include "runtime/base/printable.h"

#include <doctest/doctest.h>

#include "runtime/base/invisible.h"

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

TEST_CASE("a terminal gets no escape, no control and nothing that turns text around") {
  CHECK(shown("one\n\ttwo \xc3\xa4 \xd7\x90\xd7\x91") == "one\n\ttwo \xc3\xa4 \xd7\x90\xd7\x91");
  const std::string mark = "\xef\xbf\xbd";
  CHECK(shown("a\x1b[2Jb\rc\xc2\x9b"
              "d\xff") == "a" + mark + "[2Jb" + mark + "c" + mark + "d" + mark);
  // Overrides, isolates, marks of direction, separators, tags, a byte order mark.
  for (const char* turned : {"\xe2\x80\xae", "\xe2\x81\xa6", "\xe2\x80\x8f", "\xd8\x9c",
                             "\xe2\x80\xa8", "\xf3\xa0\x81\xa1", "\xef\xbb\xbf"}) {
    CHECK(shown(std::string("x") + turned + "y") == "x" + mark + "y");
    CHECK(printable(std::string("x") + turned + "y", 9) == "x y");
    CHECK_FALSE(is_printable(turned));
  }
}

TEST_CASE(
    "what nobody sees is unsafe wherever it hides, but selectors and joiners mean something") {
  for (const char32_t code :
       {0xad, 0x34f, 0x61c, 0x200b, 0x200e, 0x2028, 0x2029, 0x202e, 0x2060, 0x2065, 0x206f, 0x3164,
        0xfeff, 0xfff9, 0xfffb, 0xe0000, 0xe0041, 0xe007f}) {
    CAPTURE(static_cast<unsigned>(code));
    CHECK(is_invisible(code));
    CHECK(is_unsafe(code));
  }
  CHECK(is_invisible(0xfe0f));
  for (const char32_t code : {0xfe0f, 0x200c, 0x200d, 0x20, 0xe4, 0x65e5, 0x1f955})
    CHECK_FALSE(is_unsafe(code));
}

TEST_CASE("a text is printable or it is not") {
  CHECK(is_printable(""));
  CHECK(is_printable("pi0 \xc3\xa4?"));
  CHECK(!is_printable("a\nb"));
  CHECK(!is_printable("a\x1b[2J"));
  CHECK(!is_printable("\xff"));
}

}  // namespace probe
