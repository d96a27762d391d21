// vlaprobe audit through the program.
#include <doctest/doctest.h>

#include "runtime/base/json.h"
#include "tests/runtime/cli/program.h"

using probe::test::contains;
using probe::test::Outcome;
using probe::test::Sandbox;

TEST_CASE("audit says what is irregular in the published suite, with places and reasons") {
  Sandbox box;
  const Outcome text = box.vlaprobe("audit $SUITE");
  REQUIRE_MESSAGE(text.exit == 0, text.err);
  for (const char* part :
       {"comparisons that move more than one axis",
        "suite/intact.probe:", "suite/manipulation.probe:",
        "allowed: published on the distractor scene, compared with the clean one",
        "suite `intact`, 50 tasks, 46 comparisons: "})
    CHECK_MESSAGE(contains(text.out, part), part);
  const auto json = probe::Json::parse(box.vlaprobe("audit $SUITE --json").out);
  REQUIRE_FALSE(json.is_discarded());
  CHECK(json["findings"].size() >= 20);
  // What nothing is held to, with how many tasks are held whole.
  CHECK(contains(text.out, "words that nothing is held to\n"));
  CHECK(contains(text.out, "elsewhere"));
  CHECK(json["held"].get<int>() < json["heard"].get<int>());
  CHECK_FALSE(json["not_held"].empty());
}

TEST_CASE("audit says so when nothing is irregular, and refuses what is no suite") {
  Sandbox box;
  const std::string suites = "'" VLAPROBE_SOURCE_DIR "/suite/";
  CHECK(contains(box.vlaprobe("audit " + suites + "intact_clean.probe'").out, "nothing irregular"));
  const Outcome unknown = box.vlaprobe("audit $SUITE --suite intct");
  CHECK(unknown.exit == 1);
  CHECK(contains(unknown.err, "did you mean `intact`?"));
  const Outcome none = box.vlaprobe("audit " + suites + "layouts.probe'");
  CHECK(none.exit == 1);
  CHECK(contains(none.err, "no suite to audit"));
  CHECK(box.vlaprobe("audit absent.probe").exit == 2);
}

TEST_CASE("audit asks of a published table whether the suite can give its percentages") {
  Sandbox box;
  probe::test::write_file(box / "paper.csv", "policy,avg,ood_target\na,5.0,1.9\nb,5.0,4.7\n");
  const Outcome text = box.vlaprobe("audit $SUITE --table paper.csv");
  REQUIRE_MESSAGE(text.exit == 0, text.err);
  CHECK(contains(text.out, "2 of the 2 percentages of `ood_target` in paper.csv"));
  CHECK(contains(text.out, "no sets, so not checked: avg"));
  CHECK(box.vlaprobe("audit $SUITE --table absent.csv").exit == 2);
}
