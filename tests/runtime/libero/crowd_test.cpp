#include "runtime/libero/crowd.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace probe;
using namespace probe::libero;

namespace {

// A bowl that goes on a plate on a table, things as wide as they are said, upright.
struct Table {
  BddlProblem problem;
  Things things;
  std::array<std::string, 4> turns = {"1", "0", "0", "0"};

  Table() {
    problem.problem_class = "libero_tabletop_manipulation";
    add("akita_black_bowl", 0.05);
    add("plate", 0.07);
    problem.goal.push_back({"on", {"akita_black_bowl_1", "plate_1"}, {}});
    for (const char* const other : {"ketchup", "white_bowl", "butter"}) know(other, 0.03);
  }
  void know(const std::string& category, double half) {
    Thing thing;
    thing.category = category;
    thing.low = {-half, 0, -0.04};
    thing.high = {half, 0, 0.04};
    things[category] = thing;
  }
  void add(const std::string& category, double half) {
    know(category, half);
    problem.objects.push_back({category + "_1", category, {}});
  }
  std::vector<Foreign> crowd(const std::string& rows, const std::vector<std::string>& names,
                             std::size_t turn = 0) const {
    std::vector<Standing> declared;
    for (const std::string& name : names) declared.push_back({name, turns});
    return libero::crowd(problem, things, "start,object,x_m,y_m,z_m,qw,qx,qy,qz,value\n" + rows,
                         declared, turn);
  }
};

double away(const Foreign& one, double x, double y) { return std::hypot(one.x - x, one.y - y); }

constexpr const char* kApart =
    "0,source,-0.2,-0.2,0.94,1,0,0,0,\n0,target,0.2,0.2,0.94,1,0,0,0,\n"
    "0,panda_mounted.joint1,,,,,,,,0.1\n"
    "1,source,-0.2,0.2,0.94,1,0,0,0,\n1,target,0.2,0.2,0.94,1,0,0,0,\n";

}  // namespace

TEST_CASE("what a task does not have stands upright on its table, free in each of its starts") {
  const auto put = Table().crowd(kApart, {"ketchup_1", "butter_1"});
  REQUIRE(put.size() == 2);
  CHECK(put[0].what.object == "ketchup_1");
  CHECK(put[1].what.object == "butter_1");
  for (const Foreign& one : put) {
    CHECK(one.z == doctest::Approx(0.9 + 0.04 + 0.001));  // the table's height, its own foot
    CHECK(away(one, -0.2, -0.2) > 0.03 + 0.05);           // the bowl in start 0, in start 1
    CHECK(away(one, -0.2, 0.2) > 0.03 + 0.05);
    CHECK(away(one, 0.2, 0.2) > 0.03 + 0.07);
  }
  CHECK(std::hypot(put[0].x - put[1].x, put[0].y - put[1].y) > 0.03 + 0.03);
  // As near to the bowl, in the mean of both starts at (-0.2, 0), as there is room.
  CHECK(away(put[0], -0.2, 0) < 0.02);
}

TEST_CASE("nothing is put there that shares a noun with a thing of the task, or is too wide") {
  Table table;
  CHECK(table.crowd(kApart, {"white_bowl_1"}).empty());
  table.know("ketchup", 0.07);
  CHECK(table.crowd(kApart, {"ketchup_1"}).empty());
  CHECK(table.crowd(kApart, {"unheard_of_1"}).empty());
}

TEST_CASE("where there is no room nothing is put") {
  CHECK(Table()
            .crowd("0,source,0,0,0.94,1,0,0,0,\n0,target,0.02,0,0.94,1,0,0,0,\n", {"butter_1"})
            .empty());
}

TEST_CASE("what comes out of a fixture has its room") {
  Table table;
  table.know("wooden_cabinet", 0.1);
  table.problem.fixtures.push_back({"wooden_cabinet_1", "wooden_cabinet", {}});
  BddlRegion region;
  region.name = "main_table_cabinet_region";
  region.own = "cabinet_region";
  region.target = "main_table";
  region.ranges = {{-0.2, -0.01, -0.2, 0.01}};
  table.problem.regions.push_back(region);
  table.problem.init.push_back({"on", {"wooden_cabinet_1", "main_table_cabinet_region"}, {}});
  const auto beside = table.crowd(kApart, {"butter_1"});
  REQUIRE(beside.size() == 1);
  CHECK(away(beside[0], -0.2, 0) < 0.2);
  table.things.at("wooden_cabinet").joints.push_back({"top_level", "cabinet_top"});
  const auto off = table.crowd(kApart, {"butter_1"});
  REQUIRE(off.size() == 1);
  CHECK(away(off[0], -0.2, 0) > 0.1 + 0.16);
}

TEST_CASE("tasks get others by their turn") {
  CHECK(Table().crowd(kApart, {"ketchup_1", "butter_1"}, 1)[0].what.object == "butter_1");
}

TEST_CASE("what is modelled on its side is put there as the benchmark stands it up") {
  Table table;
  table.turns = {"0.7071067811865476", "0.7071067811865475", "0", "0"};  // y of the model is up
  Thing& ketchup = table.things.at("ketchup");
  ketchup.low = {-0.03, -0.1, -0.02};
  ketchup.high = {0.03, 0.06, 0.02};
  const auto put = table.crowd(kApart, {"ketchup_1"});
  REQUIRE(put.size() == 1);
  CHECK(put[0].z == doctest::Approx(0.9 + 0.1 + 0.001));
  CHECK(put[0].what.turn == table.turns);
  const auto standing = standing_in("start,object\n0,milk_1,0,0,0.9,0.5,0.5,0.5,0.5,\n", "milk_1");
  REQUIRE(standing);
  CHECK(standing->turn == std::array<std::string, 4>{"0.5", "0.5", "0.5", "0.5"});
  CHECK_FALSE(standing_in("start,object\n", "milk_1"));
}
