#include "runtime/report/left_out.h"

#include <doctest/doctest.h>

#include "tests/runtime/report/fake_searches.h"

using namespace probe::report;
using namespace probe::test;

TEST_CASE("points that were left out are counted by reason, each once, the commonest first") {
  const FakeSearches box;
  const std::string dir = box.add("w", search_json("worst", "pi0"));
  const std::string head = "task,clutter,starts,left_out\n";
  box.add_round(dir, "001",
                head +
                    "p1,0,23,P0501: `a` and `b` overlap in 1 of 24 starts\n"
                    "p2,1,0,\"P0402: \"\"yellow object\"\" denotes 2,\nobjects\"\n"
                    "p3,1,0,\"P0402: \"\"round\"\" denotes 3\"\n"
                    "p3_placed,1,0,P0402: proves p3\n"
                    "p4,1,24,\n");
  box.add_round(dir, "002", head + "p2,1,0,P0402: again\np5,1,0,no room\n");
  std::vector<LeftOutReason> reasons;
  std::vector<std::string> notes;
  read_left_out(dir, reasons, notes);
  CHECK(notes.empty());
  REQUIRE(reasons.size() == 3);
  CHECK(reasons[0].code == "P0402");
  CHECK(reasons[0].points == 2);
  CHECK(reasons[0].example == "P0402: \"yellow object\" denotes 2,\nobjects");
  CHECK(reasons[1].code == "P0501");
  CHECK(reasons[1].points == 0);
  CHECK(reasons[1].in_part == 1);
  CHECK(reasons[2].code.empty());
  CHECK(round_with(dir, "p2").ends_with("rounds/002"));
  CHECK(round_with(dir, "p4").ends_with("rounds/001"));
  CHECK(round_with(dir, "p9").empty());
}

TEST_CASE("a round's table of another kind is a note, and none is no failure") {
  const FakeSearches box;
  const std::string dir = box.add("w", search_json("worst", "pi0"));
  std::vector<LeftOutReason> reasons;
  std::vector<std::string> notes;
  read_left_out(dir, reasons, notes);
  CHECK(reasons.empty());
  CHECK(notes.empty());
  box.add_round(dir, "001", "a,b\n1,2\n");
  read_left_out(dir, reasons, notes);
  REQUIRE(notes.size() == 1);
  CHECK(notes[0].find("points.csv: it is no table of points") != std::string::npos);
}
