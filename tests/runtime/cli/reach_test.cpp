// tests/reach/reach.py counts what Probe can say of other benchmarks' tasks; dsl/reach.md is what
// it wrote.
#include <doctest/doctest.h>

#include "tests/runtime/cli/program.h"

namespace {

using namespace probe::test;

constexpr const char* kReach = "/usr/bin/python3 '" VLAPROBE_SOURCE_DIR
                               "/tests/reach/reach.py' '" VLAPROBE_BINARY_DIR "/vlaprobe' ";

const std::string kDrawer = R"((define (problem p)
  (:fixtures cabinet - wooden_cabinet)
  (:objects bowl_1 - bowl plate_1 - plate)
  (:init (On bowl_1 table_left) (Open cabinet_top))
  (:goal (And (In bowl_1 cabinet_top) (Close cabinet_top)))
))";
// `Melt` is nothing that Probe or anybody here knows.
const std::string kUnknown = R"((define (problem p)
  (:objects bowl_1 - bowl)
  (:init (On bowl_1 table_left))
  (:goal (And (Melt bowl_1)))
))";

std::string row_of(const std::string& table, const std::string& name) {
  const std::size_t at = table.find("\n| " + name + " |");
  if (at == std::string::npos) return "";
  return table.substr(at + 1, table.find('\n', at + 1) - at - 1);
}

}  // namespace

TEST_CASE(
    "a task counts as sayable when all that its file mentions compiles, else what lacks is told") {
  const Sandbox box;
  write_file(box / "tasks/drawer.bddl", kDrawer);
  write_file(box / "tasks/unknown.bddl", kUnknown);
  const Outcome told = box.run(std::string(kReach) + "--libero tasks");
  REQUIRE_MESSAGE(told.exit == 0, told.err);
  CHECK(row_of(told.out, "LIBERO") == "| LIBERO | 2 | 1 | 1: unknown: Melt |");
  // How many tasks want it, and that its text compiles.
  CHECK(row_of(told.out, "an object lies in a drawer, an oven, a rack") ==
        "| an object lies in a drawer, an oven, a rack | 1 | yes |");
  CHECK(row_of(told.out, "a drawer begins open, a knob turned") ==
        "| a drawer begins open, a knob turned | 1 | yes |");
  CHECK(row_of(told.out, "ropes, dirt that is wiped off") ==
        "| ropes, dirt that is wiped off | 0 | no |");
}

TEST_CASE("the page of the language's reach says of LIBERO what its files and the compiler say") {
  const std::string files = VLAPROBE_SOURCE_DIR "/../shared/reference/libero/bddl_files";
  if (!std::filesystem::exists(files)) {
    MESSAGE("SKIPPED: LIBERO's files are not there");
    return;
  }
  const Sandbox box;
  const Outcome told = box.run(std::string(kReach) + "--libero '" + files + "'");
  REQUIRE_MESSAGE(told.exit == 0, told.err);
  const std::string page = read_file(VLAPROBE_SOURCE_DIR "/dsl/reach.md");
  CHECK(!row_of(page, "LIBERO").empty());
  CHECK(row_of(page, "LIBERO") == row_of(told.out, "LIBERO"));
}
