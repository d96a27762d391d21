#include "runtime/base/utf8.h"

#include <doctest/doctest.h>

#include <string>

namespace probe {

TEST_CASE("a character is its code point and its bytes, whatever follows it") {
  CHECK(first_utf8("a\xff").code == U'a');
  CHECK(first_utf8("\xc3\xa9t\xc3\xa9").code == U'\u00e9');
  CHECK(first_utf8("\xe6\x9d\xaf").bytes == 3);
  CHECK(first_utf8("\xf0\x9f\xa5\x95!").code == U'\U0001f955');
  CHECK(first_utf8(std::string_view("\0", 1)).bytes == 1);
}

TEST_CASE("long forms, surrogates, code points past the last and cut sequences are no characters") {
  for (const std::string_view bad :
       {"\x80", "\xc0\xaf", "\xc1\xbf", "\xe0\x9f\xbf", "\xed\xa0\x80", "\xf0\x8f\xbf\xbf",
        "\xf4\x90\x80\x80", "\xf5\x80\x80\x80", "\xff", "\xe6\x9d", "\xf0\x9f\xa5", "\xc3("}) {
    CAPTURE(bad);
    CHECK(first_utf8(bad).bytes == 0);
    CHECK(first_utf8(bad).code == 0xfffd);
    CHECK(find_bad_utf8("ok" + std::string(bad)) == 2);
  }
  for (const std::string_view good : {"", "\xed\x9f\xbf", "\xee\x80\x80", "\xf4\x8f\xbf\xbf"}) {
    CHECK(find_bad_utf8(good) == good.size());
  }
}

TEST_CASE("terminals obey the controls below a blank, DEL and those from 80 to 9f") {
  for (const char32_t code : {0x00, 0x0a, 0x1b, 0x7f, 0x80, 0x9f}) CHECK(is_control(code));
  for (const char32_t code : {0x20, 0x7e, 0xa0, 0x9d6f}) CHECK_FALSE(is_control(code));
}

}  // namespace probe
