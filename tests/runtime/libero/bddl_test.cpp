// BDDL as the benchmark writes it, and every mistake at its line and column.
#include "runtime/libero/bddl.h"

#include <doctest/doctest.h>

#include <string>

#include "tests/runtime/libero/small.h"

namespace probe::libero {
namespace {

// The small problem with `from` replaced by `to`.
std::string changed(std::string_view from, std::string_view to) {
  std::string text(test::kSmallProblem);
  const std::size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

// All mistakes of a text, a line each.
std::string mistakes_in(const std::string& text) {
  std::string all;
  for (const Failure& failure : read_bddl(text, "t.bddl").mistakes) all += to_text(failure) + "\n";
  return all;
}

}  // namespace

TEST_CASE("a problem is read as it is written") {
  const BddlRead read = read_bddl(test::kSmallProblem, "small.bddl");
  REQUIRE(read.mistakes.empty());
  CHECK(read.oddities.empty());
  const BddlProblem& problem = read.problem;
  CHECK(problem.problem_class == "libero_kitchen_tabletop_manipulation");
  CHECK(problem.language == "Put the cup in the drawer and close it");
  REQUIRE(problem.regions.size() == 3);
  CHECK(problem.regions[0].name == "bench_cup_region");
  CHECK(problem.regions[0].ranges == std::vector<std::array<double, 4>>{{-0.1, 0, -0.05, 0.05}});
  CHECK(problem.regions[1].yaw == std::array<double, 2>{3.141592653589793, 3.141592653589793});
  CHECK(problem.regions[1].ranges[0][1] == -0.30000000000000004);
  CHECK(problem.regions[2].ranges.empty());
  CHECK_FALSE(problem.regions[2].yaw.has_value());
  REQUIRE(problem.objects.size() == 3);
  CHECK(problem.objects[1].name == "cup_2");
  CHECK(problem.objects[1].category == "cup");
  CHECK(problem.objects[2].category == "lid");
  CHECK(problem.find_fixture("chest_1")->category == "chest");
  CHECK(problem.find_object("chest_1") == nullptr);
  CHECK(problem.find_region("chest_1_drawer")->own == "drawer");
  CHECK(problem.interest == std::vector<std::string>{"cup_1", "chest_1"});
  REQUIRE(problem.init.size() == 3);
  CHECK(problem.init[2].predicate == "open");
  REQUIRE(problem.goal.size() == 2);
  CHECK(problem.goal[0].arguments == std::vector<std::string>{"cup_1", "chest_1_drawer"});
  CHECK(problem.goal[1].spot.line == 25);
}

TEST_CASE("a bracket without its other half is told where it stands") {
  CHECK(mistakes_in(changed("(:init", "(:init (")) == "t.bddl:1:1: this `(` is never closed\n");
  CHECK(mistakes_in(changed("(:domain robosuite)", "(:domain robosuite))"))
            .find("t.bddl:3:3: nothing stands behind the list that the file is") == 0);
  CHECK(mistakes_in(") (define)") == "t.bddl:1:1: this `)` closes nothing\n");
  CHECK(mistakes_in("; nothing\n") ==
        "t.bddl:2:1: expected a list in brackets, found an empty file\n");
  CHECK(mistakes_in("define") == "t.bddl:1:1: expected `(`, found a word\n");
  CHECK(mistakes_in(std::string(40, '(')) == "t.bddl:1:33: lists more than 32 deep\n");
}

TEST_CASE("what is not known is told with the nearest word") {
  CHECK(mistakes_in(changed("(:obj_of_interest", "(:obj_of_intrest")) ==
        "t.bddl:1:1: there is no `:obj_of_interest`\n"
        "t.bddl:20:3: unknown section `:obj_of_intrest`, did you mean `:obj_of_interest`?\n");
  CHECK(mistakes_in(changed("(Open chest", "(Opne chest")) ==
        "t.bddl:24:5: unknown predicate `opne`, did you mean `open`?\n");
  CHECK(mistakes_in(changed("(Open chest", "(Melted chest")) ==
        "t.bddl:24:5: unknown predicate `melted`\n");
  CHECK(mistakes_in(changed("(:yaw_rotation ((0 1.5))", "(:pitch ((0 1.5))")) ==
        "t.bddl:8:7: unknown part of a region, `(:pitch ...`\n");
  CHECK(mistakes_in(changed("(:yaw_rotation ((0 1.5))", "(:yaw_rotatoin ((0 1.5))")) ==
        "t.bddl:8:7: unknown part of a region, `(:yaw_rotatoin ...`, did you mean "
        "`:yaw_rotation`?\n");
  CHECK(mistakes_in(changed("(In cup_1 ", "(In cup_3 ")) ==
        "t.bddl:25:15: there is no `cup_3`, did you mean `cup_1`?\n");
}

TEST_CASE("names and sections are there once") {
  CHECK(mistakes_in(changed("lid_1 - lid", "cup_1 - lid")) ==
        "t.bddl:19:5: `cup_1` is declared twice\n");
  CHECK(mistakes_in(changed("(chest_region", "(cup_region"))
            .find("t.bddl:9:5: `bench` has two regions `cup_region`\n") == 0);
  CHECK(mistakes_in(changed("(:domain robosuite)", "(:domain robosuite) (:goal)")) ==
        "t.bddl:2:23: expected one `(And ..)` behind `:goal`\n"
        "t.bddl:25:3: section `:goal` is there twice\n");
  CHECK(mistakes_in("(define)").find("there is no `:regions`") != std::string::npos);
}

TEST_CASE("numbers and lists that are none are told") {
  CHECK(mistakes_in(changed("(-0.1 0 -0.05 0.05)", "(-0.1 zero -0.05 0.05)")) ==
        "t.bddl:7:23: expected a number, found `zero`\n");
  CHECK(mistakes_in(changed("(-0.1 0 -0.05 0.05)", "(-0.1 nan -0.05 0.05)")) ==
        "t.bddl:7:23: expected a number from -1000 to 1000, found `nan`\n");
  CHECK(mistakes_in(changed("(-0.1 0 -0.05 0.05)", "(-0.1 0 -0.05)")) ==
        "t.bddl:7:17: expected 4 numbers in brackets\n");
  CHECK(mistakes_in(changed("(-0.1 0 -0.05 0.05)", "(0.1 0 -0.05 0.05)")) ==
        "t.bddl:7:17: the second corner of a rectangle lies below the first\n");
  CHECK(mistakes_in(changed("(:ranges ((-0.1 0 -0.05 0.05)))", "(:ranges -0.1)")) ==
        "t.bddl:7:7: expected one list of lists of numbers in `(:ranges ...`\n");
  CHECK(mistakes_in(changed("(On cup_1 bench_cup_region)", "(On cup_1)")) ==
        "t.bddl:22:5: `on` takes 2 names, found 1\n");
  CHECK(mistakes_in(changed("lid_1 - lid", "lid_1")) == "t.bddl:19:5: `lid_1` has no category\n");
  CHECK(mistakes_in(changed("lid_1 - lid", "- lid")) ==
        "t.bddl:19:5: expected `name - category`\n");
}

TEST_CASE("what no text of ours could say is told where it stands") {
  CHECK(mistakes_in(changed("lid_1 - lid", "lid-1 - lid")) ==
        "t.bddl:19:5: `lid-1` is no name: letters, digits and `_`, a letter first\n");
  CHECK(mistakes_in(changed("lid_1 - lid", "lid_1 - a,b")) ==
        "t.bddl:19:13: `a,b` is no name: letters, digits and `_`, a letter first\n");
  CHECK(mistakes_in(changed("(-0.1 0 -0.05 0.05)", "(-0.1 0 1e300 1e300)"))
            .find("t.bddl:7:25: expected a number from -1000 to 1000, found `1e300`\n") == 0);
  CHECK(mistakes_in(changed("(On cup_1 bench_cup_region)", "(On cup_1 cup_1)")) ==
        "t.bddl:22:5: `on` says of `cup_1` how it is to itself\n");
  CHECK(mistakes_in(changed("(drawer (:target chest_1))",
                            "(drawer (:target chest_1) (:ranges ((0 0 1 1))))")) ==
        "t.bddl:13:5: `:ranges` are of `chest_1` and of `bench`: a problem has one table or "
        "floor\n");
}

TEST_CASE("several mistakes are told at once, in their order") {
  std::string text = changed("(Open chest", "(Opne chest");
  text.replace(text.find("-0.05 0.05"), 10, "-0.05 what");
  CHECK(mistakes_in(text) ==
        "t.bddl:7:31: expected a number, found `what`\n"
        "t.bddl:24:5: unknown predicate `opne`, did you mean `open`?\n");
}

TEST_CASE("what does no harm is told apart") {
  const BddlRead read =
      read_bddl(changed("(drawer (:target chest_1))",
                        "(drawer (:target chest_1)) (left_region (:target drainer_1))"),
                "t.bddl");
  CHECK(read.mistakes.empty());
  REQUIRE(read.oddities.size() == 1);
  CHECK(to_text(read.oddities[0]) ==
        "t.bddl:13:32: region `left_region` is of `drainer_1`, which the problem does not have");
  const BddlRead twice = read_bddl(
      changed("(Close chest_1_drawer)", "(Close chest_1_drawer) (Close chest_1_drawer)"), "t.bddl");
  CHECK(twice.problem.goal.size() == 2);
  REQUIRE(twice.oddities.size() == 1);
  CHECK(to_text(twice.oddities[0]).find("the goal wants the same twice") != std::string::npos);
}

}  // namespace probe::libero
