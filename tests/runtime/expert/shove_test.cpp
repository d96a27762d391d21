#include "runtime/expert/shove.h"

#include "runtime/expert/expert.h"
#include "tests/runtime/expert/world_table.h"

namespace probe::expert {
namespace {

using test::need;

Pose dropped(double x, double y) { return {Vec3(x, y, test::kTable + 0.5), Quat::Identity()}; }

// Too wide for the fingers from every side; the second has walls to put a finger inside.
test::Thing board() {
  const Vec3 half(0.05, 0.05, 0.005);
  return {"board", 330, half,
          std::make_shared<const scene::CollisionShape>(scene::make_box_shape(half))};
}

TEST_CASE("what cannot be gripped is pushed aside, and nothing else moves") {
  const test::Robot robot = test::load_robot();
  for (const bool plate : {false, true}) {
    CAPTURE(plate);
    const std::vector<test::Thing> things{
        plate ? test::load_thing("plate", 1000, {0.055, 0.055, 0.003}) : board(),
        test::load_thing("keyboard", 1000, {0.076, 0.032, 0.005}),
        test::load_thing("carrot", 700, {0.0575, 0.016, 0.019})};
    test::WorldTable table(robot, things,
                           {dropped(-0.085, -0.075), dropped(-0.235, 0.075), dropped(-0.2, -0.09)});
    const auto places = [&] {
      std::vector<Vec3> out;
      for (const auto& object : table.view().objects) out.push_back(object.pose.position);
      return out;
    };
    const std::vector<Vec3> before = places();
    auto policy = need(make_expert({}));
    REQUIRE(policy->begin(table.start()).ok());
    for (int step = 0; step < test::kHorizon; ++step) {
      table.apply(need(policy->act(table.observe(step))));
    }
    const std::vector<Vec3> after = places();
    CHECK((after[0] - before[0]).head<2>().norm() > 0.03);
    const std::string remark = policy->remark().value_or("");
    CHECK_MESSAGE(remark.find(plate ? "cm where it is narrowest, and pushed it"
                                    : ", finds no hold of it, 10.0 cm where it is narrowest, and pushed it") !=
                      std::string::npos,
                  remark);
    CHECK((after[1] - before[1]).norm() < 0.005);
    CHECK((after[2] - before[2]).norm() < 0.005);
  }
}

TEST_CASE("a shove goes where there is room") {
  const test::Robot robot = test::load_robot();
  const Vec3 half(0.03, 0.03, 0.03);
  const auto block = std::make_shared<const scene::CollisionShape>(scene::make_box_shape(half));
  // The source between two blocks along y.
  const std::vector<test::Thing> things{
      board(), {"left", 400, half, block}, {"right", 400, half, block}};
  test::WorldTable table(robot, things,
                         {dropped(-0.16, 0), dropped(-0.16, 0.1), dropped(-0.16, -0.1)});
  const Reach reach = need(Reach::create(test::widowx()));
  const auto shove = plan_shove(look(table.observe(0), {}, reach.hand()), reach);
  REQUIRE(shove.has_value());
  const Vec3 way = shove->end.position - shove->start.grasp.tcp.position;
  CHECK(std::abs(way.x()) > 2 * std::abs(way.y()));
  CHECK(way.head<2>().norm() > 0.06);
}

}  // namespace
}  // namespace probe::expert
