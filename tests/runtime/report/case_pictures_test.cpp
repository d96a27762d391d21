#include "runtime/report/case_pictures.h"

#include <doctest/doctest.h>

#include <span>

#include "runtime/base/file.h"
#include "tests/runtime/report/fake_runs.h"
#include "tests/runtime/report/fake_searches.h"

using namespace probe;
using namespace probe::report;
using namespace probe::test;

TEST_CASE("the task and each confirmed case are drawn from the plan of the case's round") {
  const FakeSearches box;
  const std::string dir = box.add(
      "w", worst_json("pi0", Json::array({case_json("carrot_on_plate_distract", "clutter 1", true),
                                          case_json("elsewhere", "clutter 2", false)})));
  box.add_round(dir, "002", "task,clutter,starts,left_out\ncarrot_on_plate_distract,1,24,\n");
  std::filesystem::create_directories(dir + "/rounds/002/policy");
  const std::string file = VLAPROBE_SOURCE_DIR "/suite/intact.probe";
  const auto compiled =
      build(std::span(&file, 1), {.asset_root = VLAPROBE_SOURCE_DIR "/assets",
                                  .library_folders = {VLAPROBE_SOURCE_DIR "/dsl"}});
  REQUIRE(compiled.ok());
  REQUIRE(compiled->ok);
  REQUIRE(write_file(dir + "/rounds/002/policy/suite.plan", std::span(compiled->plan)).ok());
  const auto found = read_findings(dir);
  REQUIRE(found.ok());
  const CasePictures drawn = pictures_of(*found, VLAPROBE_SOURCE_DIR "/assets", 200);
  REQUIRE_MESSAGE(drawn.note.empty(), drawn.note);
  CHECK(drawn.base.png.starts_with("\x89PNG"));
  CHECK(drawn.base.instruction.find("carrot") != std::string::npos);
  REQUIRE(drawn.cases.size() == 2);
  CHECK(drawn.cases[0].png.starts_with("\x89PNG"));
  CHECK(drawn.cases[0].png != drawn.base.png);
  CHECK(drawn.cases[1].png.empty());

  const CasePictures none = pictures_of(*found, "/no/assets");
  CHECK(none.base.png.empty());
  CHECK(none.cases.size() == 2);
  CHECK(none.note.find("/no/assets") != std::string::npos);
}
