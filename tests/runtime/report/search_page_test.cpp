#include "runtime/report/search_page.h"

#include <doctest/doctest.h>

#include "tests/runtime/report/fake_searches.h"

using namespace probe;
using namespace probe::report;
using namespace probe::test;

namespace {

bool has(const std::string& text, const std::string& part) { return text.find(part) != text.npos; }

Json minimal_json(const std::string& policy) {
  Json json = search_json("minimal", policy);
  json["case"] = {{"light.power", 0.7}, {"clutter", 3.0}};
  json["smallest"] = {{"clutter", 3.0}};
  json["sentence"] = "the smallest change that still fails: clutter 3";
  json["tried"] = Json::array(
      {Json{{"changes", {{"clutter", 3.0}}},
            {"text", "clutter 3"},
            {"failures", {9, 9}},
            {"verdict", "fails"}},
       // As folders had it before sets had a text.
       Json{{"changes", {{"light.power", 0.7}}}, {"failures", {0, 8}}, {"verdict", "passes"}}});
  return json;
}

SearchPage page_of(const std::vector<std::string>& dirs) {
  const auto searches = load_searches(dirs);
  REQUIRE_MESSAGE(searches.ok(), to_text(searches.failure()));
  return search_page(*searches, {.command = "vlaprobe report", .program = "vlaprobe"});
}

}  // namespace

TEST_CASE("searches of every method are one page without script and without network") {
  const FakeSearches box;
  const std::string w =
      box.add("w", worst_json("pi0", Json::array({case_json("p1", "clutter 2", true),
                                                  case_json("p2", "light.power x 0.5", false)})));
  box.add_round(w, "001", "task,clutter,starts,left_out\np9,1,0,P0402: denotes 2\n");
  const SearchPage page =
      page_of({box.add("b", boundary_json("pi0", 0.121)), w, box.add("m", minimal_json("pi0")),
               box.add("x", axes_json("pi0"))});
  const std::string& html = page.html;
  for (const char* id : {"boundary", "worst", "minimal", "axes", "searched"})
    CHECK(has(html, "<section id=\"" + std::string(id) + "\""));
  CHECK_FALSE(has(html, "<script"));
  CHECK_FALSE(has(html, "src=\"http"));
  CHECK(has(html, "default-src 'none'"));
  CHECK(has(html, "fails in <b>40 of 40</b> fresh trials, in <b>88 %</b> or more of all"));
  CHECK(has(html, "not confirmed by fresh trials"));
  CHECK(has(html, "1 point, as: P0402: denotes 2"));
  CHECK(has(html, "1 start that the expert does not solve"));
  CHECK(has(html, "the smallest change that still fails: clutter 3"));
  // Without the round's plan there is no picture, and that is said.
  REQUIRE(page.notes.size() == 1);
  CHECK(has(page.notes[0], "no round has the point `p1`"));
  CHECK(has(html, "no pictures"));
}

TEST_CASE("names that are markup, and texts that hide or turn around, stay text") {
  const FakeSearches box;
  const std::string evil = "\"'><script>alert(1)</script><img src=x onerror=1>\xE2\x80\xAE& \xFF";
  const auto spoil = [&](Json json) {
    for (const char* key : {"space", "task", "text_sha256", "policy", "policy_content"})
      json["asked"][key] = evil;
    json["file"] = evil;
    json["lines"] = Json::array({evil});
    return json;
  };
  Json boundary = boundary_json(evil, 0.121);
  for (const char* key : {"axis", "side", "status", "unit", "sentence"})
    boundary["axes"][1][key] = evil;
  Json worst =
      worst_json(evil, Json::array({case_json(evil, evil, true), case_json(evil, evil, false)}));
  Json minimal = minimal_json(evil);
  minimal["sentence"] = evil;
  minimal["tried"][0]["text"] = evil;
  minimal["tried"][0]["verdict"] = evil;
  Json axes = axes_json(evil);
  for (const char* key : {"axis", "side"}) axes["effects"][0][key] = evil;
  for (const char* key : {"a", "b", "side_a", "side_b"}) axes["pairs"][0][key] = evil;
  const std::string w = box.add("w", spoil(worst));
  box.add_round(w, "001", "task,clutter,starts,left_out\np9,1,0,<script>alert(2)</script>\n");
  const SearchPage page = page_of(
      {box.add("b", spoil(boundary)), w, box.add("m", spoil(minimal)), box.add("x", spoil(axes))});
  CHECK_FALSE(has(page.html, "<script"));
  CHECK_FALSE(has(page.html, "<img src=x"));
  CHECK_FALSE(has(page.html, "\xE2\x80\xAE"));
  CHECK(has(page.html, "&lt;script&gt;alert(1)"));
}

TEST_CASE("runs and searches in one call are refused by the name of both") {
  const FakeSearches box;
  const std::string search = box.add("b", boundary_json("pi0", 0.1));
  const auto mixed = are_searches({search, box / "run"});
  REQUIRE_FALSE(mixed.ok());
  CHECK(has(mixed.failure().message, search));
  CHECK(has(mixed.failure().message, box / "run"));
  CHECK(*are_searches({search}));
  CHECK_FALSE(*are_searches({box / "run"}));
}

TEST_CASE("a folder that is named twice counts once, and one that is damaged is refused by name") {
  const FakeSearches box;
  const std::string dir = box.add("b", boundary_json("pi0", 0.1));
  CHECK(load_searches({dir, dir + "/"})->size() == 1);
  const auto bad = load_searches({dir, box.add("bad", Json{{"format", "x"}})});
  REQUIRE_FALSE(bad.ok());
  CHECK(has(bad.failure().where, "bad/search.json"));
}

TEST_CASE("a search that is not done, or found nothing, says so") {
  const FakeSearches box;
  Json begun = search_json("boundary", "pi0");
  begun["done"] = false;
  const SearchPage page =
      page_of({box.add("b", begun), box.add("w", worst_json("pi0", Json::array()))});
  CHECK(has(page.html, "This search is not done"));
  CHECK(has(page.html, "nothing that breaks it was found"));
}

TEST_CASE("the page's data are there as JSON, with the reasons of what was left out") {
  const FakeSearches box;
  const std::string w = box.add("w", worst_json("pi0", Json::array()));
  box.add_round(w, "001", "task,clutter,starts,left_out\np9,1,0,P0402: denotes 2\n");
  const auto searches = load_searches({w});
  REQUIRE(searches.ok());
  const Json json = search_page_json(*searches, {.title = "t"});
  CHECK(json["format"] == "vlaprobe-search-report");
  CHECK(json["searches"][0]["left_out_because"][0]["points"] == 1);
  CHECK(json["searches"][0]["search"]["asked"]["policy"] == "pi0");
}
