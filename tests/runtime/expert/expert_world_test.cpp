#include <cstdio>
#include <cstdlib>

#include "runtime/expert/expert.h"
#include "runtime/expert/footprint.h"
#include "tests/runtime/expert/world_table.h"

namespace probe::expert {
namespace {

using test::need;

const std::vector<Vec2> kCells = {
    {-0.235, -0.075}, {-0.235, 0.075}, {-0.085, -0.075}, {-0.085, 0.075}};

Pose dropped(const Vec2& xy, double yaw_deg) {
  constexpr double kDegree = 0.017453292519943295;
  return {Vec3(xy.x(), xy.y(), test::kTable + 0.5),
          robot::from_rotation_vector({0, 0, yaw_deg * kDegree})};
}

struct Episode {
  bool intention = false, grasp = false, success = false;
  int first_success = -1;
};

Episode play(test::WorldTable& table, policy::Policy& policy, bool trace = false) {
  Episode out;
  const Status begun = policy.begin(table.start());
  REQUIRE(begun.ok());
  for (int step = 0; step < test::kHorizon; ++step) {
    const auto observation = table.observe(step);
    const policy::Action action = need(policy.act(observation));
    if (trace) {
      const Pose tcp = table.view().base * observation.proprioception.tcp_in_base;
      const auto& source = table.view().objects[0];
      const auto& target = table.view().objects[1];
      std::printf(
          "%2d tcp %.3f %.3f %.3f open %.2f src %.3f %.3f %.3f %d%d tgt %.3f %.3f %.3f "
          "act %.3f %.3f %.3f %.2f %.2f %.2f %.2f ik %d ok %d\n",
          step, tcp.position.x(), tcp.position.y(), tcp.position.z(),
          observation.proprioception.openness, source.pose.position.x(), source.pose.position.y(),
          source.pose.position.z(), source.finger_contact[0], source.finger_contact[1],
          target.pose.position.x(), target.pose.position.y(), target.pose.position.z(), action[0],
          action[1], action[2], action[3], action[4], action[5], action[6], table.reached(),
          table.success());
    }
    table.apply(action);
    if (table.success() && out.first_success < 0) out.first_success = step + 1;
  }
  out.intention = table.intention();
  out.grasp = table.grasp();
  out.success = table.success();
  return out;
}

TEST_CASE("the expert solves carrot_on_plate from the suite's starts") {
  const test::Robot robot = test::load_robot();
  const std::vector<test::Thing> things = {test::load_thing("carrot", 700, {0.0575, 0.016, 0.019}),
                                           test::load_thing("plate", 1000, {0.055, 0.055, 0.003})};
  auto policy = need(make_expert({}));
  int episode = 0, intention = 0, grasp = 0, success = 0, latest = 0;
  const char* traced = std::getenv("PROBE_TRACE_EPISODE");
  for (std::size_t from = 0; from < 4; ++from) {
    for (std::size_t to = 0; to < 4; ++to) {
      if (from == to) continue;
      for (const double yaw : {180.0, -90.0}) {
        CAPTURE(episode);
        test::WorldTable table(robot, things, {dropped(kCells[from], yaw), dropped(kCells[to], 0)});
        const Episode e = play(table, *policy, traced && std::atoi(traced) == episode);
        intention += e.intention;
        grasp += e.grasp;
        success += e.success;
        latest = std::max(latest, e.first_success);
        if (!e.success || !e.grasp) {
          MESSAGE("episode ", episode, ": grasp ", e.grasp, " success ", e.success,
                  " first success after step ", e.first_success);
        }
        ++episode;
      }
    }
  }
  MESSAGE("intention ", intention, " grasp ", grasp, " success ", success,
          " of 24, the slowest after ", latest, " steps");
  CHECK(intention == 24);
  CHECK(grasp == 24);
  CHECK(success >= 22);
}

}  // namespace
}  // namespace probe::expert
