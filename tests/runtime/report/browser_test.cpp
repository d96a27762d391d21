// The page in headless Chromium; what is looked at stands in runtime/report/page/test/browser.mjs.
// Pages and screenshots are left in the build folder.
#include <doctest/doctest.h>

#include <filesystem>

#include "tests/node_program.h"

namespace {

void check(const std::string& what) {
  if (!std::filesystem::exists("/usr/bin/chromium")) {
    MESSAGE("SKIPPED: the report page was not opened, chromium is not installed");
    return;
  }
  const std::string build = VLAPROBE_BINARY_DIR "/report_page";
  const auto outcome = probe::test::run_node("runtime/report/page/test/browser.mjs",
                                             "'" + build + "' '" + build + "/shots' " + what);
  INFO(outcome.words);
  CHECK(outcome.status == 0);
  // Times, for whoever reads the log.
  if (outcome.words.find("complete after") != std::string::npos) MESSAGE(outcome.words);
}

}  // namespace

TEST_CASE("the page of six policies with 3,600 episodes each opens, prints and has every panel") {
  check("large");
}
TEST_CASE("every panel is reached with the keyboard and every text has contrast, light") {
  check("light");
}
TEST_CASE("every text has contrast, dark") { check("dark"); }
TEST_CASE("names that are markup or script stay text") { check("hostile"); }
TEST_CASE(
    "no policies, no episodes, invalid ones, partial runs and one policy make sensible pages") {
  check("few");
}
TEST_CASE("fifty policies make a page that opens") { check("many"); }
TEST_CASE("halves are rounded away from zero and an interval with width shows it") {
  check("numbers");
}
TEST_CASE("the page says what holds on these starts and what for starts never tried") {
  check("questions");
}
TEST_CASE("what is said of every model and question is said once") { check("knowing"); }
TEST_CASE("each of 75 truths is shown as it was") { check("truths"); }
TEST_CASE("the page fits a narrow window") { check("narrow"); }

TEST_CASE("the page's sources have the types they claim") {
  CHECK(probe::test::check_types("runtime/report/page") == "");
}
