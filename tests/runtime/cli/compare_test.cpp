// Two runs side by side and the tables of a report, as a user asks for them.
#include <doctest/doctest.h>

#include <filesystem>

#include "runtime/base/json.h"
#include "tests/runtime/cli/program.h"

using probe::test::Outcome;
using probe::test::Sandbox;

namespace {

Outcome run(const Sandbox& box, const std::string& policy, const std::string& rest) {
  const Outcome outcome = box.vlaprobe("run $SUITE --assets $ASSETS --policy " + policy + " -o " +
                                       policy + " --seeds 42 --tasks carrot_on_plate " + rest);
  REQUIRE_MESSAGE(outcome.exit == 0, outcome.err);
  return outcome;
}

}  // namespace

TEST_CASE("compare says in words what differs, report gives the tables, both refuse what is none") {
  const Sandbox box;
  run(box, "reach", "--episodes 0-5");
  run(box, "null", "--episodes 0-3");

  const Outcome words = box.vlaprobe("compare reach null");
  REQUIRE_MESSAGE(words.exit == 0, words.err);
  CHECK(words.out.find("reach (A) against null (B), the same 4 episodes") == 0);
  CHECK(words.out.find("success: no difference was seen") != std::string::npos);
  CHECK(words.out.find("intention: the data cannot tell them apart") != std::string::npos);
  CHECK(words.out.find("note: 4 episodes are common to both; 2 that only reach has") !=
        std::string::npos);
  const Outcome json = box.vlaprobe("compare reach null --json --metrics intention");
  REQUIRE(json.exit == 0);
  CHECK(probe::Json::parse(json.out)["rows"][0]["a"]["k"] == 4);

  // A row that its trace does not bear is in no number, and is named whatever is written.
  std::filesystem::copy(box / "null", box / "edited", std::filesystem::copy_options::recursive);
  std::filesystem::remove(box / "edited/traces/carrot_on_plate/1-42.trace");
  for (const char* form : {"", "--json"}) {
    const Outcome edited = box.vlaprobe(std::string("compare reach edited ") + form);
    REQUIRE_MESSAGE(edited.exit == 2, edited.err);
    CHECK(edited.err.find("carrot_on_plate episode 1 seed 42 is left out") != std::string::npos);
    CHECK(!edited.out.empty());
  }
  // As `results` ends there, whichever verb tells of rows.
  CHECK(box.vlaprobe("results edited").exit == 2);
  CHECK(box.vlaprobe("gate reach --against edited").exit == 2);
  CHECK(box.vlaprobe("report reach edited -o edited.html").exit == 2);
  CHECK(box.vlaprobe("report reach edited --format csv").exit == 2);
  CHECK(std::filesystem::exists(box / "edited.html"));
  CHECK(words.err.find("left out") == std::string::npos);

  const Outcome csv = box.vlaprobe("report reach null --format csv");
  REQUIRE_MESSAGE(csv.exit == 0, csv.err);
  CHECK(csv.out.find("policy,metric,avg,original") == 0);
  CHECK(csv.out.find("reach,intention,100.0") != std::string::npos);
  CHECK(box.vlaprobe("report reach --format latex -o t.tex").exit == 0);
  CHECK(probe::test::read_file(box / "t.tex").find("\\toprule") != std::string::npos);

  CHECK(box.vlaprobe("compare reach reach").exit == 1);
  CHECK(box.vlaprobe("compare reach nowhere").exit == 2);
  CHECK(box.vlaprobe("compare reach null --metrics sucess").exit == 1);
  CHECK(box.vlaprobe("report reach").exit == 1);
}

TEST_CASE("demonstrations are no rate, whoever is asked for one") {
  const Sandbox box;
  const std::string more = " $SUITE --assets $ASSETS --tasks carrot_on_plate --episodes 0-1 ";
  const Outcome demos = box.vlaprobe("demos" + more + "-o demos --noise 0");
  REQUIRE_MESSAGE(demos.exit == 0, demos.err);
  const Outcome results = box.vlaprobe("results demos");
  REQUIRE_MESSAGE(results.exit == 0, results.err);
  CHECK(results.out.find("demos holds successes alone") == 0);
  CHECK(results.out.find("carrot_on_plate: 2 successes kept") != std::string::npos);
  CHECK(results.out.find(" of ") == std::string::npos);
  const Outcome json = box.vlaprobe("results demos --json");
  CHECK(probe::Json::parse(json.out)[0]["only_success"] == true);
  CHECK(box.vlaprobe("results demos --csv").out.find(",only_success") != std::string::npos);
  for (const char* verb : {"compare demos demos", "report demos -o x.html"}) {
    const Outcome refused = box.vlaprobe(verb);
    CHECK(refused.exit == 1);
    CHECK(refused.err.find("holds successes alone") != std::string::npos);
  }
  const Outcome into = box.vlaprobe("run" + more + "--policy pushed:0 --seeds 0 -o demos");
  CHECK(into.exit == 2);
  CHECK(into.err.find("holds successes alone (`vlaprobe demos`), not every episode") !=
        std::string::npos);
}

TEST_CASE("gate ends with 1 for a drop alone: where nothing can be said it is 2") {
  Sandbox box;
  for (const char* wrong : {"gate none --against neither", "gate none --against neither --allow two",
                            "gate none --against none --error 70%"})
    CHECK_MESSAGE(box.vlaprobe(wrong).exit == 2, wrong);
}
