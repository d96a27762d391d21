// verify, dis and diff on plan files as users have them.
#include <doctest/doctest.h>

#include "runtime/base/json.h"
#include "tests/runtime/cli/program.h"

using namespace probe::test;
using json = probe::Json;

TEST_CASE("verify says the root on standard output and what was checked on the other") {
  Sandbox box;
  const Outcome built = box.vlaprobe("build $SUITE -o x.plan --assets $ASSETS");
  REQUIRE_MESSAGE(built.exit == 0, built.err);
  const Outcome whole = box.vlaprobe("verify x.plan");
  CHECK(whole.exit == 0);
  CHECK(whole.out == built.out);
  CHECK(contains(whole.err, "51 tasks, 1224 episodes"));
  CHECK(contains(whole.err, "1224 episode ids"));
  const Outcome fast = box.vlaprobe("verify x.plan --fast");
  CHECK(fast.out == whole.out);
  CHECK(contains(fast.err, "left out"));
  const Outcome told = box.vlaprobe("verify x.plan --json");
  const json object = json::parse(told.out);
  REQUIRE(object.is_object());
  CHECK(object["root"].get<std::string>() + "\n" == whole.out);
  CHECK(object["sections"][0]["name"] == "STRS");
  CHECK(object["judges"].get<int>() >= 7);
  std::size_t size = 0;
  for (const json& section : object["sections"]) size += section["size"].get<std::size_t>();
  CHECK(size < object["bytes"].get<std::size_t>());
}

TEST_CASE("a plan of one suite says how many of its tasks are only there to be compared with") {
  Sandbox box;
  const std::string example = VLAPROBE_SOURCE_DIR "/examples/negation.probe";
  const Outcome built =
      box.vlaprobe("build " + example + " -o x.plan --suite negated --assets $ASSETS");
  CHECK(built.exit == 0);
  CHECK_MESSAGE(contains(built.err, "3 tasks, 1 of them only baselines of the others"), built.err);
  const Outcome told =
      box.vlaprobe("build " + example + " -o y.plan --suite negated --json --assets $ASSETS");
  CHECK(json::parse(told.out)["only_baselines"] == 1);
  CHECK_FALSE(contains(box.vlaprobe("build $SUITE -o z.plan --assets $ASSETS").err, "baselines"));
}

TEST_CASE(
    "a plan of another major version, cut short, or of something else says so in every verb") {
  Sandbox box;
  REQUIRE(box.vlaprobe("build $SUITE -o x.plan --suite language --assets $ASSETS").exit == 0);
  const std::string good = read_file(box / "x.plan");
  const auto refused = [&](std::string bytes, const char* reason) {
    write_file(box / "bad.plan", bytes);
    for (const char* verb :
         {"verify bad.plan", "dis bad.plan", "list bad.plan", "diff x.plan bad.plan",
          "run bad.plan --policy null -o out --assets $ASSETS"}) {
      CAPTURE(verb);
      const Outcome outcome = box.vlaprobe(verb);
      CHECK(outcome.exit == 2);
      CHECK_MESSAGE(contains(outcome.err, reason), outcome.err);
      CHECK(contains(outcome.err, "bad.plan"));
    }
    CHECK_FALSE(std::filesystem::exists(box / "out"));
  };
  std::string bytes = good;
  bytes[8] = 2;
  refused(bytes, "this program reads format 1, the plan has format 2 [major]");
  refused(good.substr(0, good.size() - 1), "[file-size]");
  refused(good.substr(0, 40), "[short]");
  refused(std::string(100, 'x'), "[magic]");
  refused("", "empty");
  std::string text_mode = good;
  text_mode.erase(5, 1);
  refused(text_mode, "text mode");
}
