// Parts and regions of fixtures in roles. Each case begins with the productions it holds.
#include <doctest/doctest.h>

#include "runtime/plan/roles.h"
#include "tests/dsl/built.h"

using namespace probe;
using namespace probe::test;

namespace {

// A chest with a drawer that slides along y, a door and two regions, and layouts of the source
// alone.
const std::string kThings = std::string(R"(
fixture chest {
  urdf "chest/chest.urdf"; at (0cm, 30cm, 85cm) yaw 90deg
  joint slide friction 2N damping 5Ns/m start 4cm
  part drawer link drawer name "lower drawer" { color gray; phrase low spatial "drawer in front" means color gray and ahead }
  part door   link door { color gray }
  region inside of drawer box (-4cm, -4cm, -4cm) .. (4cm, 4cm, 4cm)
  region top of chest box (-5cm, -5cm, 5cm) .. (5cm, 5cm, 15cm) name "chest"
}
relation ahead(a: object) "front" = all o in alike - {a}: y(a) > y(o) + 1cm
scene room like bench { fixture chest }
layout alone { cells spots = grid 2 x 2 at (0cm, -10cm) spread (10cm, 10cm)
  place source in distinct spots; orient by rest; drop 10cm settle 0.5s }
layout empty { place red at (0cm, -10cm); orient by rest; drop 10cm settle 0.5s }
)");

}  // namespace

TEST_CASE("thing, task_st: parts and regions fill roles, by the words of what they belong to") {
  const Built built(kThings + R"(
role helper
metrics opening { success = at end slide(target) > 5cm }
metrics stored  { success = at end (within(position(source), target) and slide(helper) < 1cm) }
abstract task opened like base { scene room; layout empty; metrics opening; say "open {the target}" }
task open_drawer like opened { source none; target chest.drawer }
task put_in like base { scene room; layout alone; metrics stored; source red
  target chest.inside; helper chest.drawer; say "put {the source} in {the target} and close {the helper}" }
variant put_on of put_in { target chest.top }
variant other_helper of put_in { helper chest.door; set success = at end (within(position(source), target) and turn(helper) < 1deg) }
)");
  CHECK(built.prompt("open_drawer") == "open the lower drawer");
  CHECK(built.prompt("put_in") ==
        "put the red block in the lower drawer and close the lower drawer");
  CHECK(built.prompt("put_on") == "put the red block in the chest and close the lower drawer");
  const plan::Plan& plan = built.plan();
  const auto& tables = plan.tables();
  CHECK(plan::thing_in(tables, built.task("open_drawer"), "target") == "chest.drawer");
  CHECK(plan::thing_in(tables, built.task("put_in"), "target") == "chest.inside");
  CHECK(plan::thing_in(tables, built.task("put_on"), "target") == "chest.top");
  CHECK(plan::thing_in(tables, built.task("put_in"), "helper") == "chest.drawer");
  CHECK(plan::thing_in(tables, built.task("put_in"), "source") == "");
  CHECK(built.task("put_in").target == plan::kNone);
  CHECK(plan::roles_of(tables, built.task("put_in")).others.empty());
  CHECK(plan::moved_axes(tables, built.task("put_on")) ==
        std::vector<std::string>{"object.target"});
}

TEST_CASE(
    "part_st: phrases of parts denote among the parts and objects of the scene, by place, too") {
  const std::string task = R"(
metrics opening { success = at end slide(target) > 5cm }
task t like base { scene room; layout empty; metrics opening; say "open {the target}"
  target chest.drawer; refer target as low }
)";
  const Built built(kThings + task);
  CHECK(built.prompt("t") == "open the drawer in front");
  // Judged once more at the settled start: among the part, its rival and no object.
  REQUIRE(built.plan().tables().claims.size() == 1);
  const plan::ClaimRecord& claim = built.plan().tables().claims[0];
  CHECK(built.plan().text(built.plan().bodies(built.task("t"))[claim.body].name) == "chest.drawer");
}

TEST_CASE("thing: a question at the end is asked of a part, and of no task whose target is none") {
  const Built built(kThings + R"(
metrics opening { success = at end slide(target) > 5cm }
questions seen { yesno open "Is {the target} open?" at end answer slide(target) > 5cm }
task open_drawer like base { scene room; layout empty; metrics opening; say "open {the target}"
  target chest.drawer }
suite s { tasks { red_on_tray, open_drawer }; seeds 1; questions seen }
)");
  const auto& questions = built.plan().tables().questions;
  REQUIRE(questions.size() == 1);
  CHECK(questions[0].task == built.index("open_drawer"));
  CHECK(built.plan().text(questions[0].text) == "Is the lower drawer open?");
  CHECK(built.plan().tables().omissions.size() == 1);
}

TEST_CASE("thing: a derive goes over the parts of a fixture that a joint moves") {
  const auto a = clean(kThings + R"(
metrics opening { success = at end travel(target) >= 0.5 * range(target) }
task open_drawer like base { scene room; layout empty; metrics opening; say "open {the target}"
  target chest.drawer }
derive "{t}_{p}" for t in { open_drawer }, p in parts of chest { target p }
)");
  CHECK(a->task("open_drawer_door").prompt == "open the door");
  CHECK(axes_text(*a, "open_drawer_door") == "object.target");
}

TEST_CASE("thing: what does not fit a role is said") {
  const std::string stored =
      "metrics stored { success = at end within(position(source), target) }\n";
  const auto said = [&](const std::string& more) {
    const std::string text = failed_build(kThings + stored + more);
    const std::size_t at = text.find("error[");
    return at == text.npos ? text : text.substr(at + 6, 5);
  };
  CHECK(said("task t like base { scene room; layout alone; metrics stored; source red; target "
             "chest.insid; say \"put {the source} in {the target}\" }\n") == "P0201");
  CHECK(said("task t like base { scene bench; layout alone; metrics stored; source red; target "
             "chest.inside; say \"put {the source} in {the target}\" }\n") == "P0201");
  CHECK(said("task t like base { scene room; layout pairs; metrics stored; source red; target "
             "chest.inside; say \"put {the source} in {the target}\" }\n") == "P1106");
  // A drawer is no region.
  CHECK(said("task t like base { scene room; layout alone; metrics stored; source red; target "
             "chest.drawer; say \"put {the source} in {the target}\" }\n") == "P0601");
  CHECK(said("role goods: set\ntask t like base { scene room; layout alone; metrics stored; source "
             "red; goods chest.top; target chest.inside; say \"put {the source} in {the "
             "target}\" }\n") == "P1105");
}
