#include "compiler/diag/json.h"
#include "runtime/base/json.h"

#include <doctest/doctest.h>

using namespace probe;

TEST_CASE("json carries place, labels and the fix with bytes and lines") {
  SourceSet sources;
  const FileId id = sources.add("a.probe", "set\ncells 2x2 \xc3\xa9\n");
  Diagnostics diagnostics;
  diagnostics.report(Code::P0301, {id, 10, 13}, "unknown unit `x`")
      .point("a unit touches its number")
      .label({id, 0, 3}, "here")
      .fix_by("write `2 x 2`", {id, 10, 13}, "2 x 2");
  const auto json = Json::parse(render_json(diagnostics, sources));
  REQUIRE(json.size() == 1);
  const auto& item = json[0];
  CHECK(item["code"] == "P0301");
  CHECK(item["severity"] == "error");
  CHECK(item["message"] == "unknown unit `x`");
  CHECK(item["file"] == "a.probe");
  CHECK(item["line"] == 2);
  CHECK(item["column"] == 7);
  CHECK(item["end_line"] == 2);
  CHECK(item["end_column"] == 10);
  CHECK(item["labels"][0]["message"] == "here");
  CHECK(item["labels"][0]["line"] == 1);
  CHECK(item["fix"]["message"] == "write `2 x 2`");
  const auto& replacement = item["fix"]["replacements"][0];
  CHECK(replacement["begin"] == 10);
  CHECK(replacement["end"] == 13);
  CHECK(replacement["end_column"] == 10);
  CHECK(replacement["text"] == "2 x 2");
}

TEST_CASE("json has a null fix, a null file for no place, and survives bytes that are not UTF-8") {
  SourceSet sources;
  const FileId id = sources.add("b\xff.probe", "\xff");
  Diagnostics diagnostics;
  diagnostics.report(Code::P0102, {id, 0, 1}, "found `\xff`");
  diagnostics.report(Code::P0202, {}, "no place");
  const auto json = Json::parse(render_json(diagnostics, sources));
  CHECK(json[0]["fix"].is_null());
  CHECK(json[0]["labels"].empty());
  CHECK(json[1]["file"].is_null());
  CHECK(json[1]["line"].is_null());
}

TEST_CASE("no diagnostics are an empty array") {
  CHECK(Json::parse(render_json({}, {})) == Json::array());
}
