// Starts of a task that are one start, and what would make them differ.
#include <doctest/doctest.h>

#include <string>

#include "tests/compiler/small_suite.h"

using namespace probe;

namespace {

std::string repeated_of(const std::string& text) { return test::analyze_with_suite(text)->said(); }
bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

const std::string kCup = "object cup like blue { rest yaw 0deg; name \"cup\" }\n";

}  // namespace

TEST_CASE("the turns that are advised keep how the thing lies") {
  const std::string upright = repeated_of(kCup + "task t like red_on_tray { source cup }\n");
  CHECK_MESSAGE(has(upright, "write `rest yaw 0deg, yaw 90deg` into `cup`"), upright);
  const std::string lying =
      repeated_of(kCup + "object lying like cup { rest roll 90deg yaw 30deg; name \"lying cup\" }\n"
                         "task t like red_on_tray { source lying }\n");
  CHECK_MESSAGE(
      has(lying, "write `rest roll 90deg yaw 30deg, roll 90deg yaw 120deg` into `lying`"), lying);
  const std::string nose =
      repeated_of(kCup + "object nose like cup { rest pitch 90deg; name \"nose\" }\n"
                         "task t like red_on_tray { source nose }\n");
  CHECK_MESSAGE(has(nose, "write a `rest` of 2 turns that differ into `nose`"), nose);
}

TEST_CASE("where a pose of the task gives the one turn, the pose is what to change") {
  const std::string said = repeated_of("task t like red_on_tray { pose red yaw 0deg }\n");
  CHECK_MESSAGE(has(said, "give this `pose` 2 turns that differ"), said);
  CHECK_MESSAGE(!has(said, "into `red`"), said);
}

TEST_CASE("one task that is allowed to repeat starts does not hide another") {
  const std::string said =
      repeated_of(kCup +
                  "@allow(repeated, \"as published\")\ntask t like red_on_tray { source cup }\n"
                  "task u like red_on_tray { source cup; say take }\n");
  CHECK_MESSAGE(has(said, "starts of `u` repeat an earlier one"), said);
  CHECK_MESSAGE(!has(said, "starts of `t`"), said);
}
