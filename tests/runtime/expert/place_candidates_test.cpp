#include "runtime/expert/place_candidates.h"

#include "runtime/expert/path_planner.h"
#include "tests/runtime/expert/fake_table.h"

namespace probe::expert {
namespace {

policy::PrivilegedObject slab(const std::string& name, const Vec3& half, const Vec2& at) {
  return test::object(name, {test::block(-half, half)}, {at.x(), at.y(), test::kSurface + half.z()},
                      0);
}

// The scene, and a tool that holds the source from above by its middle.
struct Held {
  Scene scene;
  Pose tool;
};
Held held(policy::PrivilegedObject source, policy::PrivilegedObject target,
          std::vector<policy::PrivilegedObject> others = {},
          std::vector<std::vector<Vec3>> fixtures = {}) {
  test::FakeTable table(std::move(source), std::move(target), std::move(others));
  policy::Observation seen = table.observe(0);
  policy::Privileged view = *seen.privileged;
  view.fixtures = {{"shelf", std::move(fixtures), {}}};
  seen.privileged = &view;
  Held out;
  out.scene = look(seen, {}, *test::widowx().hand);
  const Vec2& at = out.scene.source.center;
  out.tool = top_down({at.x(), at.y(), out.scene.source.bottom + 0.02}, 0);
  return out;
}

TEST_CASE("a free target is served over its middle, without a turn, just above it") {
  const Held h = held(slab("block", {0.015, 0.015, 0.015}, {-0.2, 0}),
                      slab("plate", {0.05, 0.05, 0.003}, {-0.1, 0.1}));
  const std::vector<Place> places = place_candidates(h.scene, h.tool);
  REQUIRE(!places.empty());
  const Place& best = places.front();
  CHECK(best.turn == 0);
  CHECK(best.lift == 0);
  const Vec2 shift = best.tcp.position.head<2>() - h.tool.position.head<2>();
  CHECK((shift - (h.scene.target.center - h.scene.source.center)).norm() < 1e-12);
  const double bottom = h.scene.source.bottom + best.tcp.position.z() - h.tool.position.z();
  CHECK(bottom > h.scene.target.top);
  CHECK(bottom < h.scene.target.top + 0.006);
}

TEST_CASE("a tall neighbour turns the fingers away from it") {
  // The fingers open along y at yaw 0; a tower stands there beside the target.
  const Held h = held(slab("block", {0.015, 0.015, 0.015}, {-0.2, 0}),
                      slab("plate", {0.02, 0.02, 0.003}, {-0.1, 0.1}),
                      {slab("tower", {0.02, 0.02, 0.06}, {-0.1, 0.165})});
  const Place best = place_candidates(h.scene, h.tool).front();
  CHECK(std::abs(best.turn) > 0.5);
  CHECK(best.clearance > 0.005);
}

TEST_CASE("between walls the source is let go from higher") {
  const double z = test::kSurface;
  std::vector<std::vector<Vec3>> walls;
  // A pit of 8 cm by 8 cm, 6 cm deep: too narrow for the palm, whichever way it is turned.
  for (const double side : {-1.0, 1.0}) {
    walls.push_back(test::block({-0.2, 0.1 + side * 0.05 - 0.01, z},
                                {0.0, 0.1 + side * 0.05 + 0.01, z + 0.06}));
    walls.push_back(test::block({-0.1 + side * 0.05 - 0.01, 0.0, z},
                                {-0.1 + side * 0.05 + 0.01, 0.2, z + 0.06}));
  }
  const Held h = held(slab("block", {0.015, 0.015, 0.015}, {-0.2, -0.1}),
                      slab("plate", {0.03, 0.03, 0.003}, {-0.1, 0.1}), {}, walls);
  CHECK(h.scene.fixtures.size() == 4);
  const std::vector<Place> places = place_candidates(h.scene, h.tool);
  CHECK(places.front().lift > 0.005);
}

TEST_CASE("a long source is laid along a long target if the turn is short") {
  policy::PrivilegedObject stick = test::object(
      "stick", {test::block({-0.05, -0.01, 0}, {0.05, 0.01, 0.02})}, {-0.2, 0, test::kSurface}, 30);
  const Held h = held(stick, slab("rail", {0.06, 0.02, 0.005}, {-0.1, 0.1}));
  const Place best = place_candidates(h.scene, h.tool).front();
  CHECK(best.overhang == 0);
  CHECK(std::abs(best.turn) == doctest::Approx(0.5236).epsilon(0.01));
}

TEST_CASE("what stands on two feet is turned until both are on the target") {
  // A bridge of 12 cm, 5 mm above the ground between its ends, over a rail of 13 cm by 4 cm that
  // lies across.
  const auto bridge = test::object("bridge",
                                   {test::block({-0.06, -0.008, 0}, {-0.05, 0.008, 0.02}),
                                    test::block({-0.05, -0.008, 0.005}, {0.05, 0.008, 0.02}),
                                    test::block({0.05, -0.008, 0}, {0.06, 0.008, 0.02})},
                                   {-0.2, 0, test::kSurface}, 90);
  const Held h = held(bridge, slab("rail", {0.065, 0.02, 0.005}, {-0.1, 0.1}));
  const Place best = place_candidates(h.scene, h.tool).front();
  CHECK(std::abs(best.turn) == doctest::Approx(1.5708).epsilon(0.01));
  CHECK(best.overhang == 0);
}

TEST_CASE("held points turn with the tool and lie on the source") {
  const Held h = held(slab("block", {0.02, 0.015, 0.01}, {-0.2, 0}),
                      slab("plate", {0.05, 0.05, 0.003}, {-0.1, 0.1}));
  const std::vector<Ball> balls = held_balls(h.scene, h.tool);
  CHECK(balls.size() == 8);
  for (const Ball& ball : balls) {
    const Vec3 p = h.tool.apply(ball.center);
    CHECK(std::abs(std::abs(p.x() - h.scene.source.center.x()) - 0.02) < 1e-9);
    CHECK(std::abs(std::abs(p.y() - h.scene.source.center.y()) - 0.015) < 1e-9);
  }
}

}  // namespace
}  // namespace probe::expert
