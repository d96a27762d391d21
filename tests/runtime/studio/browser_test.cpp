// The page in headless Chromium; what is done and looked at stands in runtime/studio/page/test/browser.mjs. Texts and
// screenshots are left in the build folder.
#include <doctest/doctest.h>

#include <filesystem>

#include "tests/node_program.h"

namespace {

void check(const std::string& what) {
  if (!std::filesystem::exists("/usr/bin/chromium")) {
    MESSAGE("SKIPPED: the studio was not opened, chromium is not installed");
    return;
  }
  const std::string build = VLAPROBE_BINARY_DIR;
  const auto outcome =
      probe::test::run_node("runtime/studio/page/test/browser.mjs",
                            "'" + build + "' '" VLAPROBE_SOURCE_DIR "' '" + build +
                                "/studio_page/shots' " + what);
  INFO(outcome.words);
  CHECK(outcome.status == 0);
}

}  // namespace

TEST_CASE("a task is authored from an empty file to a judged episode") { check("author"); }
TEST_CASE(
    "a second page, another origin, a changed and a deleted file and the program's end are told") {
  check("bad");
}
TEST_CASE("light and dark, 1280 and 1920 wide: nothing is cut, all has contrast and is reached by keys") {
  check("looks");
}
TEST_CASE("several cameras and a policy behind a server, without a mouse; one that never answers") { check("served"); }
TEST_CASE("the studio's sources have the types they claim") {
  CHECK(probe::test::check_types("runtime/studio/page") == "");
}
