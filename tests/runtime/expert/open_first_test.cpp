// What begins in a closed drawer is taken out of an open one.
#include "runtime/expert/open_first.h"

#include <doctest/doctest.h>

namespace probe::expert {
namespace {

using policy::Skill;

// A cube at x in a drawer that slides by 20 cm, and a plate beside it.
policy::Privileged a_drawer(double cube_x, double open) {
  policy::Privileged view;
  view.objects.resize(2);
  view.objects[0].name = "cube";
  view.objects[0].pose.position = {cube_x, 0, 0};
  view.objects[1].name = "plate";
  view.objects[1].pose.position = {0.5, 0.5, 0};
  view.first_distractor = -1;
  policy::PrivilegedFixture drawer;
  drawer.name = "cabinet.top_drawer";
  drawer.parts = {{{-0.1, -0.1, -0.05}, {0.1, 0.1, 0.05}}};
  policy::PrivilegedFixture::Joint joint;
  joint.slides = true;
  joint.upper = 0.2;
  joint.position = open;
  drawer.joint = joint;
  view.fixtures = {drawer};
  return view;
}

Skill skill(Skill::Kind kind, int object, int fixture) {
  Skill one;
  one.kind = kind;
  one.object = object;
  one.fixture = fixture;
  return one;
}

TEST_CASE("a closed drawer is opened before what begins in it is taken") {
  const auto put = skill(Skill::Kind::kPut, 0, -1);
  const auto skills = opened_first(a_drawer(0.02, 0), {put});
  REQUIRE(skills.size() == 2);
  CHECK(skills[0].kind == Skill::Kind::kOpen);
  CHECK(skills[0].fixture == 0);
  CHECK(skills[0].name == "opening `cabinet.top_drawer`, in which `cube` begins");
  CHECK(skills[1].object == 0);
}

TEST_CASE("without skills it is what the goal asks of the source") {
  policy::Privileged view = a_drawer(0.02, 0);
  view.goal = policy::Goal::kOnTarget;
  const auto put = opened_first(view, {});
  REQUIRE(put.size() == 2);
  CHECK(put[1].kind == Skill::Kind::kPut);
  CHECK(put[1].to_object == 1);
  CHECK(put[1].name == "putting `cube` on `plate`");
  view.goal = policy::Goal::kLifted;
  const auto lifted = opened_first(view, {});
  REQUIRE(lifted.size() == 2);
  CHECK(lifted[1].kind == Skill::Kind::kPick);
  view.goal = policy::Goal::kAway;
  CHECK(opened_first(view, {}).empty());
}

TEST_CASE("nothing is opened for what lies elsewhere, in an open drawer, or is opened by a skill") {
  const auto put = skill(Skill::Kind::kPut, 0, -1), open = skill(Skill::Kind::kOpen, -1, 0);
  CHECK(opened_first(a_drawer(0.3, 0), {put}).size() == 1);
  CHECK(opened_first(a_drawer(0.02, 0.15), {put}).size() == 1);
  CHECK(opened_first(a_drawer(0.02, 0), {open, put}).size() == 2);
  CHECK(opened_first(a_drawer(0.02, 0), {open}).size() == 1);
  CHECK(opened_first(a_drawer(0.3, 0), {}).empty());
}

}  // namespace
}  // namespace probe::expert
