// A solution done with the wrong things: another object, or a part that is among the distractors.
#include "runtime/expert/wrong_skills.h"

#include <doctest/doctest.h>

namespace probe::expert {
namespace {

using policy::Skill;

// A cube and a plate before a cabinet of three drawers and a door.
policy::Privileged a_cabinet() {
  policy::Privileged view;
  view.objects.resize(2);
  view.first_distractor = -1;
  for (std::size_t i = 0; i < 4; ++i) {
    policy::PrivilegedFixture part;
    policy::PrivilegedFixture::Joint joint;
    joint.slides = i < 3;
    joint.number = i;
    part.joint = joint;
    view.fixtures.push_back(part);
  }
  return view;
}

Skill open(int part) {
  Skill skill;
  skill.kind = Skill::Kind::kOpen;
  skill.fixture = part;
  return skill;
}
Skill put_in(int part) {
  Skill skill;
  skill.kind = Skill::Kind::kPut;
  skill.object = 0;
  skill.to_fixture = part;
  return skill;
}

TEST_CASE("the drawer that is named as a distractor is opened, not the next one") {
  policy::Privileged view = a_cabinet();
  view.solution = {open(0)};
  REQUIRE(wrong_skills(view, 2).size() == 1);
  CHECK(wrong_skills(view, 2)[0].fixture == 1);
  view.wrong_fixtures = {3, 2};
  CHECK(wrong_skills(view, 2)[0].fixture == 2);
  view.wrong_fixtures = {3};
  CHECK(wrong_skills(view, 2)[0].fixture == 3);
}

TEST_CASE("a thing is put into the wrong drawer where the wrong thing is a drawer") {
  policy::Privileged view = a_cabinet();
  view.solution = {open(0), put_in(0)};
  CHECK(wrong_skills(view, 2).empty());
  view.wrong_fixtures = {1};
  const auto skills = wrong_skills(view, 2);
  REQUIRE(skills.size() == 2);
  CHECK(skills[0].fixture == 1);
  CHECK(skills[1].object == 0);
  CHECK(skills[1].to_fixture == 1);
}

TEST_CASE("where all that is right are objects, the wrong drawer is opened") {
  policy::Privileged view = a_cabinet();
  view.wrong_fixtures = {2};
  const auto skills = wrong_skills(view, 2);
  REQUIRE(skills.size() == 1);
  CHECK(skills[0].kind == Skill::Kind::kOpen);
  CHECK(skills[0].fixture == 2);
}

TEST_CASE("a wrong object goes before a wrong part") {
  policy::Privileged view = a_cabinet();
  view.objects.resize(3);
  view.first_distractor = 2;
  view.wrong_fixtures = {2};
  view.solution = {put_in(0)};
  CHECK(wrong_skills(view, 2)[0].object == 2);
  CHECK(wrong_skills(view, 2)[0].to_fixture == 0);
  view.solution = {};
  CHECK(wrong_skills(view, 2).empty());
}

}  // namespace
}  // namespace probe::expert
