// What is handled begins under a thing, or in what is closed.
#include <doctest/doctest.h>

#include <string>

#include "tests/compiler/small_suite.h"

using namespace probe;

namespace {

const std::string kUnder =
    "layout under { place source at (0cm, 0cm); place target on source; orient by rest; drop 10cm "
    "settle 0.5s }\n";

std::string buried_of(const std::string& task) {
  const std::string said = test::analyze_with_suite(kUnder + task)->said();
  const auto at = said.find("warning[P0507]");
  return at == std::string::npos ? "" : said.substr(at, said.find('\n', at) - at);
}

}  // namespace

TEST_CASE("words that take the upper thing away are heard") {
  CHECK(buried_of("task t like red_on_tray { layout under }\n") ==
        "warning[P0507]: `red` of `t` begins under `tray`, its target");
  CHECK(buried_of("task t like red_on_tray { layout under; say \"take {the target} off {the "
                  "source}\" }\n") == "");
  CHECK(buried_of("task t like red_on_tray { layout under; say \"put {the target} on the table "
                  "and put {the source} on it\" }\n") == "");
}

TEST_CASE("a thing that success wants elsewhere is handled") {
  CHECK(buried_of("metrics m { success = at end (moved_xy(target) > 5cm and moved_xy(source) > 5cm) "
                  "}\ntask t like red_on_tray { layout under; metrics m }\n") == "");
}

TEST_CASE("what lies on a part of a thing is carried with it") {
  CHECK(buried_of("task t like red_on_tray { layout under; source tray; target pale }\n") == "");
  CHECK(buried_of("task t like red_on_tray { layout under; source pale; target tray }\n") != "");
}

TEST_CASE("a solution that opens what the role means has opened it") {
  const auto of = [](const std::string& solution) {
    return buried_of(std::string(test::kChest) +
                     "layout in_it { place source in chest.inside; orient by rest; drop 10cm settle "
                     "0.5s }\n"
                     "metrics away { success = at end moved_xy(source) > 5cm }\n"
                     "task t like base { scene room; layout in_it; metrics away; source red; target "
                     "chest.drawer; start chest.slide 0cm; say \"put {the source} on the table\"" +
                     solution + " }\n");
  };
  CHECK(of("").find("begins in") != std::string::npos);
  CHECK(of("; solution { open target; put source on surface }") == "");
  CHECK(of("; solution { open chest.drawer; put source on surface }") == "");
}

TEST_CASE("one task that is allowed to begin so does not hide another") {
  CHECK(buried_of("@allow(buried, \"meant\")\ntask t like red_on_tray { layout under }\n"
                  "task u like red_on_tray { layout under; say take }\n") ==
        "warning[P0507]: `red` of `u` begins under `tray`, its target");
}
