// What is left of a key in words that others read.
#include "runtime/servers/api_key.h"

#include <doctest/doctest.h>

#include <cstdlib>

namespace probe::servers {
namespace {

constexpr std::string_view kKey = "sk-proj-0123456789abcdefABCDEF-tail";

struct Key {
  explicit Key(const char* value) { ::setenv("VLAPROBE_API_KEY", value, 1); }
  ~Key() { ::unsetenv("VLAPROBE_API_KEY"); }
};

TEST_CASE("a key is not shown, whole or cut at either end") {
  CHECK(without_key("bad key sk-proj-0123456789abcdefABCDEF-tail!", kKey) == "bad key *!");
  for (std::size_t cut = 6; cut <= kKey.size(); ++cut) {
    CAPTURE(cut);
    CHECK(without_key("no: " + std::string(kKey.substr(0, cut)) + "...", kKey) == "no: *...");
    CHECK(without_key(std::string(kKey.substr(kKey.size() - cut)) + " no", kKey) == "* no");
  }
  CHECK(without_key("twice sk-proj-0123456789abcdefABCDEF-tail, sk-proj-0123456789", kKey) ==
        "twice *, *");
}

TEST_CASE("a key is not shown escaped, in base64 or in another case") {
  CHECK(without_key("no SK-PROJ-0123456789ABCDEFABCDEF-TAIL.", kKey) == "no *.");
  CHECK(without_key("?k=sk%2Dproj%2d0123456789abcdefABCDEF%2Dtail&a", kKey) == "?k=*&a");
  CHECK(without_key("?k=%73%6b%2d%70%72%6f%6a", kKey) == "?k=*");
  // "", "x" and "xy" before it and "!" behind it; the letters of its neighbours stay.
  CHECK(without_key("c2stcHJvai0wMTIzNDU2Nzg5YWJjZGVmQUJDREVGLXRhaWwh", kKey) == "*wh");
  CHECK(without_key("eHNrLXByb2otMDEyMzQ1Njc4OWFiY2RlZkFCQ0RFRi10YWlsIQ==", kKey) == "eH*IQ==");
  CHECK(without_key("eHlzay1wcm9qLTAxMjM0NTY3ODlhYmNkZWZBQkNERUYtdGFpbCE=", kKey) == "eHl*CE=");
  CHECK(without_key("cut c2stcHJvai0wMTIz.", kKey) == "cut *.");
  CHECK(without_key("user 50% of pro%zz", kKey) == "user 50% of pro%zz");
  // As URLs have it: `-` and `_` for `+` and `/`.
  CHECK(without_key("a fn5-fj8_P35-", "~~~~???~~") == "a *");
}

TEST_CASE("in bytes a key becomes as many stars, and so does a part of it") {
  const auto masked = [](std::string bytes) {
    mask_key({reinterpret_cast<std::uint8_t*>(bytes.data()), bytes.size()}, kKey);
    return bytes;
  };
  CHECK(masked("\x83" + std::string(kKey) + "\xff") ==
        "\x83" + std::string(kKey.size(), '*') + "\xff");
  CHECK(masked("cut: " + std::string(kKey.substr(0, 9))) == "cut: *********");
  CHECK(masked("the project's tail") == "the project's tail");
}

TEST_CASE("other words stay, and a short key is only taken out whole") {
  CHECK(without_key("the project's tail", kKey) == "the project's tail");
  CHECK(without_key("abc abcd", "abcd") == "abc *");
  CHECK(without_key("anything", "") == "anything");
}

TEST_CASE("a key that could end a header's line is refused by the variable's name") {
  for (const char* key : {"abc\r\nX-Admin: 1", "abc\n", "a\x01z", "\x7f"}) {
    const Key set(key);
    const Status status = check_api_key();
    REQUIRE_FALSE(status.ok());
    CHECK(status.failure().code == Fault::kUsage);
    CHECK(to_text(status.failure()) ==
          "VLAPROBE_API_KEY: holds a line break or another control character, which no key has");
  }
  const Key set("sk-1 with blanks");
  CHECK(check_api_key().ok());
  CHECK(without_key("sk-1 with blanks") == "*");
}

}  // namespace
}  // namespace probe::servers
