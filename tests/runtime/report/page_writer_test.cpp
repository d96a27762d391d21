#include "runtime/report/page_writer.h"
#include "runtime/base/json.h"

#include <doctest/doctest.h>

using namespace probe::report;
using json = probe::Json;

TEST_CASE("nothing inside a result can end the script element it stands in") {
  const std::string hostile = "</script><script>alert(1)</script><!-- & \xE2\x80\xA8\xE2\x80\xA9";
  const std::string text = embeddable(json{{"name", hostile}}.dump());
  for (const char* part : {"<", ">", "&", "\xE2\x80\xA8", "\xE2\x80\xA9"})
    CHECK(text.find(part) == std::string::npos);
  CHECK(json::parse(text)["name"] == hostile);
}

TEST_CASE("bytes that are no UTF-8 become the replacement character, and good text stays") {
  CHECK(embeddable("\"a\xFFz\"") == "\"a\\ufffdz\"");
  CHECK(embeddable("\"\xC0\xAF\"") == "\"\\ufffd\\ufffd\"");             // overlong
  CHECK(embeddable("\"\xED\xA0\x80\"") == "\"\\ufffd\\ufffd\\ufffd\"");  // a surrogate
  CHECK(embeddable("\"\xF4\x90\x80\x80\"").find("\\ufffd") == 1);        // past U+10FFFF
  CHECK(embeddable("\"\xE2\x80\"") == "\"\\ufffd\\ufffd\"");             // cut off
  const std::string good = "\"gr\xC3\xBC\xC3\x9F \xE2\x82\xAC \xF0\x9F\xA4\x96\"";
  CHECK(embeddable(good) == good);
  CHECK(embeddable("").empty());
}

TEST_CASE("a page holds its three documents before the one script that reads them") {
  const std::string page =
      write_page({.data = R"({"title":"<b>"})", .timelines = "{}", .whys = "{}"});
  CHECK(page.starts_with("<!doctype html>"));
  const auto data = page.find(R"(id="data">{"title":"\u003cb\u003e"}</script>)");
  const auto timelines = page.find(R"(id="timelines">{}</script>)");
  const auto whys = page.find(R"(id="whys">{}</script>)");
  const auto script = page.find("<script>");
  REQUIRE(data != std::string::npos);
  CHECK(data < timelines);
  CHECK(timelines < whys);
  CHECK(whys < script);
  CHECK(script != std::string::npos);
  CHECK(page.find("<script>", script + 1) == std::string::npos);
  CHECK(page.find("http://") == page.find("http://www.w3.org/"));  // no other address
  CHECK(page.find("Content-Security-Policy") < data);
}
