#include <doctest/doctest.h>

#include "tests/compiler/small_suite.h"

using namespace probe;
using test::analyze_with_suite;

namespace {

std::unique_ptr<test::Analysis> with_prefix(const std::string& prefix,
                                            const std::string& more = "") {
  return analyze_with_suite(more + "suite s { tasks { red_on_tray }; prefix \"" + prefix +
                            "\"; seeds 1 }");
}

}  // namespace

TEST_CASE("a prefix is the beginning of a name") {
  for (const char* good : {"widowx_", "google_robot_", "a", "v2_"}) {
    CAPTURE(good);
    CHECK(with_prefix(good)->codes() == "");
  }
  for (const char* bad :
       {"", " ", "my suite ", "a/b_", "..", "2_", "_", "\u00e9_", "a\u200b_", "*"}) {
    CAPTURE(bad);
    const auto a = with_prefix(bad);
    CHECK(a->codes() == "P0304");
    CHECK(a->underlined() == std::string("\"") + bad + "\"");
  }
}

TEST_CASE("a prefix makes no task's name that of another task") {
  const std::string other = "variant dark_red_on_tray of red_on_tray { light night }\n";
  const auto a = with_prefix("dark_", other);
  CHECK(a->codes() == "P0203");
  CHECK_MESSAGE(
      a->said().find("with it, `red_on_tray` is called `dark_red_on_tray` as another task is") !=
          std::string::npos,
      a->said());
  CHECK(with_prefix("darker_", other)->codes() == "");
}
