// `report` and `compare` of searches, on a small real one.
#include <doctest/doctest.h>

#include <filesystem>

#include "runtime/base/json.h"
#include "tests/runtime/cli/program.h"

using namespace probe::test;
using json = probe::Json;

namespace {

// A real search of one side of one axis; and what it wrote as that of another policy, and of
// another space.
struct SearchOnce {
  Sandbox box;
  Outcome weak;
  SearchOnce() {
    write_file(box / "mine.probe", "use \"" VLAPROBE_SOURCE_DIR
                                   "/suite/intact_clean.probe\"\n"
                                   "space dark of carrot_on_plate { light ambient 0.05 .. 0.3 }\n");
    weak = box.vlaprobe(
        "search boundary mine.probe --policy 'weak:ambient<0.12' --levels 5 --error 30% --unproved "
        "--assets $ASSETS -o weak");
    json found = json::parse(read_file(box / "weak/search.json"));
    if (found.is_discarded() || !found.contains("axes")) return;
    found["asked"]["policy"] = "weaker";
    json& side = found["axes"][0];
    for (const auto& [key, value] : {std::pair("low", 0.27), {"tolerance", 0.26}, {"high", 0.25}})
      side[key] = value;
    write_file(box / "weaker/search.json", found.dump());
    found["asked"]["space"] = "bright";
    write_file(box / "other/search.json", found.dump());
  }
};

const Sandbox& sandbox() {
  static const SearchOnce once;
  REQUIRE_MESSAGE(once.weak.exit == 0, once.weak.err);
  return once.box;
}

}  // namespace

TEST_CASE("a report of searches is one page, and says what it wrote") {
  const Outcome report = sandbox().vlaprobe("report weak weaker -o page.html");
  REQUIRE_MESSAGE(report.exit == 0, report.err);
  CHECK(report.out.empty());
  CHECK(contains(report.err, "page.html: 2 searches"));
  const std::string page = read_file(sandbox() / "page.html");
  CHECK(contains(page, "falls to half at"));
  CHECK(contains(page, "weak:ambient&lt;0.12"));
  CHECK_FALSE(contains(page, "<script"));
  const Outcome data = sandbox().vlaprobe("report weak --json");
  REQUIRE(data.exit == 0);
  CHECK(json::parse(data.out)["format"] == "vlaprobe-search-report");
}

TEST_CASE("two searches compare side by side, in words and as JSON") {
  const Outcome compared = sandbox().vlaprobe("compare weak weaker");
  REQUIRE_MESSAGE(compared.exit == 0, compared.err);
  CHECK(contains(compared.out, "light.ambient: intervals do not overlap"));
  const Outcome data = sandbox().vlaprobe("compare weak weaker --json");
  REQUIRE(data.exit == 0);
  CHECK(json::parse(data.out)["sides"].size() == 1);
}

TEST_CASE("what does not belong together is refused by name") {
  const Outcome space = sandbox().vlaprobe("compare weak other");
  CHECK(space.exit == 1);
  CHECK(contains(space.err, "another space (`dark`, `bright`)"));
  const Outcome mixed = sandbox().vlaprobe("report weak weak/rounds/001/policy -o mixed.html");
  CHECK(mixed.exit == 1);
  CHECK(contains(mixed.err, "`weak` is a search's folder, `weak/rounds/001/policy` is not"));
  CHECK_FALSE(std::filesystem::exists(sandbox() / "mixed.html"));
  const Outcome compared = sandbox().vlaprobe("compare weak weak/rounds/001/policy");
  CHECK(compared.exit == 1);
  const Outcome tables = sandbox().vlaprobe("report weak --format csv");
  CHECK(tables.exit == 1);
  CHECK(contains(tables.err, "--format is of runs"));
  const Outcome floors = sandbox().vlaprobe("compare weak weaker --metrics success");
  CHECK(floors.exit == 1);
}
