// Who fills which role, and in which order a goal can be done.
#include "runtime/libero/goal.h"

#include <doctest/doctest.h>
#include <fmt/format.h>

namespace probe::libero {
namespace {

// A kitchen with a chest of one drawer, a plate and two cups; the drawer is open where `init` says.
BddlProblem problem_of(const std::string& goal, const std::string& init = "") {
  const std::string text = fmt::format(R"((define (problem LIBERO_Kitchen_Tabletop_Manipulation)
  (:domain robosuite) (:language do it)
  (:regions
    (side (:target bench) (:ranges ((0 0 0.1 0.1))))
    (inside (:target chest_1)) (top (:target chest_1)) (hollow (:target tray_1)))
  (:fixtures bench - kitchen_table chest_1 - chest)
  (:objects cup_1 cup_2 - cup plate_1 - plate tray_1 - tray)
  (:obj_of_interest cup_1)
  (:init (On cup_1 bench_side) {})
  (:goal (And {}))
))",
                                       init, goal);
  BddlRead read = read_bddl(text, "made.bddl");
  for (const Failure& mistake : read.mistakes) FAIL(to_text(mistake));
  return std::move(read.problem);
}

std::vector<std::string> steps_in(const BddlProblem& problem) {
  std::vector<std::string> skills;
  const auto closable = [](const BddlRegion& region) { return region.own == "inside"; };
  for (const BddlFact& step : steps_of(problem, closable))
    skills.push_back(skill_text(step, step.arguments));
  return skills;
}

using Steps = std::vector<std::string>;

}  // namespace

TEST_CASE("one thing that is put is the source, its place the target, the rest distracts") {
  const GoalRoles roles = roles_of(problem_of("(On cup_1 plate_1)"));
  CHECK(roles.source == "cup_1");
  CHECK(roles.target == "plate_1");
  CHECK(roles.helper.empty());
  CHECK(roles.distractors == std::vector<std::string>{"cup_2", "tray_1"});
  // A region of an object belongs to what is spoken of; a part of the table fills no role.
  const GoalRoles in = roles_of(problem_of("(In cup_1 tray_1_hollow)"));
  CHECK(in.target == "tray_1_hollow");
  CHECK(in.distractors == std::vector<std::string>{"cup_2", "plate_1"});
  CHECK(roles_of(problem_of("(On cup_1 bench_side)")).target.empty());
}

TEST_CASE("a second thing is the helper, with a place of its own where it has one") {
  const GoalRoles both = roles_of(problem_of("(On cup_1 plate_1) (On cup_2 plate_1)"));
  CHECK(both.helper == "cup_2");
  CHECK(both.helper_target.empty());
  const GoalRoles apart = roles_of(problem_of("(On cup_1 plate_1) (In cup_2 tray_1_hollow)"));
  CHECK(apart.helper_target == "tray_1_hollow");
  CHECK(apart.distractors.empty());
  CHECK(roles_of(problem_of("(On cup_1 cup_2) (In cup_2 tray_1_hollow)")).empty());
  CHECK(roles_of(problem_of("(Open chest_1_inside)")).target == "chest_1_inside");
  CHECK(roles_of(problem_of("(Open chest_1_inside) (Close chest_1_top)")).empty());
}

TEST_CASE("what opens comes before what is put, what closes after it") {
  CHECK(steps_in(problem_of("(Close chest_1_inside) (In cup_1 chest_1_inside)",
                            "(Open chest_1_inside)")) ==
        Steps{"put cup_1 in chest_1_inside", "close chest_1_inside"});
  CHECK(steps_in(problem_of("(On cup_1 chest_1_top) (Turnon chest_1)")) ==
        Steps{"turn chest_1 to 45deg", "put cup_1 on chest_1_top"});
  // Joints alone as they are said.
  CHECK(steps_in(problem_of("(Close chest_1_inside) (Open chest_1_top)")) ==
        Steps{"close chest_1_inside", "open chest_1_top"});
}

TEST_CASE("what is closed is opened before something is put into it, said or not") {
  const Steps opened{"open chest_1_inside", "put cup_1 in chest_1_inside"};
  CHECK(steps_in(problem_of("(In cup_1 chest_1_inside)")) == opened);
  CHECK(steps_in(problem_of("(In cup_1 chest_1_inside) (Open chest_1_inside)")) == opened);
  CHECK(steps_in(problem_of("(In cup_1 chest_1_inside)", "(Open chest_1_inside)")) ==
        Steps{"put cup_1 in chest_1_inside"});
  CHECK(steps_in(problem_of("(In cup_1 chest_1_inside) (In cup_2 chest_1_inside)")) ==
        Steps{"open chest_1_inside", "put cup_1 in chest_1_inside", "put cup_2 in chest_1_inside"});
}

TEST_CASE("what carries is put before what it carries, and what holds already is left") {
  CHECK(steps_in(problem_of("(On cup_1 cup_2) (In cup_2 tray_1_hollow)")) ==
        Steps{"put cup_2 in tray_1_hollow", "put cup_1 on cup_2"});
  CHECK(steps_in(problem_of("(On cup_1 cup_2) (On cup_2 cup_1)")).size() == 2);
  CHECK(steps_in(problem_of("(Turnon chest_1) (On cup_1 plate_1)", "(Turnon chest_1)")) ==
        Steps{"put cup_1 on plate_1"});
}

}  // namespace probe::libero
