// Roles beside source and target, words that count them, objects by their own names. Each case
// begins with the productions it holds.
#include <doctest/doctest.h>

#include "runtime/plan/roles.h"
#include "tests/dsl/built.h"

using namespace probe;
using namespace probe::test;

namespace {

// A set of blocks is put on the tray; a helper stands beside the source.
const std::string kRoles =
    "role helper\n"
    "role goods: set\n"
    "object green like red { color gray; paint gray; name \"green block\" }\n"
    "layout three like pairs { place source, helper, target in distinct spots }\n"
    "layout heap {\n"
    "  cells spots = grid 2 x 2 at (0cm, 0cm) spread (10cm, 10cm)\n"
    "  place target, goods in distinct spots\n"
    "  place distractors in remaining spots\n"
    "  orient by rest; drop 10cm settle 0.5s\n"
    "}\n"
    "metrics pair_up { success = at end (height(source) > height(target) and height(helper) > "
    "height(target)) }\n"
    "metrics all_up { success = at end (all g in goods: height(g) > height(target)) }\n"
    "abstract task pair like base { layout three; metrics pair_up\n"
    "  say \"put {the source} and {the helper} on {the target}\" }\n"
    "abstract task pile like base { layout heap; metrics all_up; target tray\n"
    "  say \"put {the goods} on {the target}\" }\n";

// The roles of a task's objects in the order of its bodies.
std::string roles_text(const Built& built, const char* task) {
  const plan::Plan& plan = built.plan();
  const plan::TaskRoles roles = plan::roles_of(plan.tables(), built.task(task));
  std::string text;
  for (std::uint32_t i = 0; i < roles.objects; ++i) {
    text += (i == 0 ? "" : ", ") + plan::label_of_body(plan.tables(), roles, i) + " " +
            std::string(plan.text(plan.bodies(built.task(task))[i].name));
  }
  return text;
}

std::string said_of(const std::string& more) { return analyze_with_suite(kRoles + more)->codes(); }

}  // namespace

TEST_CASE("role, task_st: what fills a role stands behind source and target, as it is declared") {
  const Built built(
      kRoles +
      "layout all like pairs { place source, goods, target, helper in distinct spots }\n"
      "task both like pair { source red; helper blue; target tray }\n"
      "task some like pile { goods red, blue; distractors pale }\n");
  CHECK(roles_text(built, "red_on_tray") == "source red, target tray");
  CHECK(roles_text(built, "both") == "source red, target tray, helper blue");
  CHECK(roles_text(built, "some") == "target tray, goods 1 red, goods 2 blue, distractor 1 pale");
  CHECK(built.task("red_on_tray").roles.count == 0);
  CHECK(built.task("some").source == plan::kNone);
  CHECK(built.task("some").distractors == 1);
  CHECK(built.prompt("both") == "put the red block and the blue block on the tray");
}

TEST_CASE("task, task_st: a task needs the roles that are spoken of and no others") {
  const auto a = clean(
      "layout alone { cells spots = grid 2 x 2 at (0cm, 0cm) spread (10cm, 10cm)\n"
      "  place source in distinct spots; orient by rest; drop 10cm settle 0.5s }\n"
      "metrics high { success = at end (height(source) > height(start(source)) + 10cm) }\n"
      "abstract task lift like base { layout alone; metrics high; say \"lift {the source}\" }\n"
      "task lift_red like lift { source red }\n"
      "variant lift_blue of lift_red { source blue }\n");
  CHECK(a->task("lift_red").prompt == "lift the red block");
  CHECK(a->task("lift_red").starts.size() == 8);
  CHECK(a->task("lift_red").ood == 0);
  CHECK(axes_text(*a, "lift_blue") == "object.source");
  CHECK(analyze_with_suite("task t like red_on_tray { target none }")->codes() == "P0206");
  CHECK(analyze_with_suite("task t like base { source red }")->codes() == "P0206");
}

TEST_CASE("role: spoken of and not filled, filled and not spoken of, and names that are taken") {
  CHECK(said_of("task t like pair { source red; target tray }") == "P1102");
  CHECK(said_of("task t like red_on_tray { helper blue\n"
                "  layout three }") == "P1103");
  CHECK(said_of("role red") == "P1101");
  CHECK(said_of("role scene") == "P1101");
  CHECK(said_of("role others: set") == "P1101");
  CHECK(said_of("role goods") == "P0203");
  CHECK(said_of("task t like pair { source red; target tray; helper red }") == "P0203");
  CHECK(said_of("task t like pair { source red; target tray; helper blue, green }") == "P1105");
  CHECK(said_of("metrics m like plain { high = once (height(goods) > 1cm) }") == "P1105");
  CHECK(said_of("task t like pair { source red; target tray; helpr blue }") == "P0201");
}

TEST_CASE("role, set1, metrics: a set is gone through, one by one") {
  const Built built(
      kRoles +
      "metrics named { success = at end (height(red) > height(target) and height(blue) > "
      "height(target)) }\n"
      "task some like pile { goods red, blue }\n"
      "task spelt like some { metrics named }\n");
  const plan::Plan& plan = built.plan();
  CHECK(built.task("some").judge_id == built.task("spelt").judge_id);
  CHECK(plan.programs()[built.task("some").program].hash ==
        plan.programs()[built.task("spelt").program].hash);
}

TEST_CASE("task_st, slot: a role is called by a phrase of what fills it") {
  const auto a = clean(kRoles +
                       "task t like pair { source blue; helper red; target tray\n"
                       "  refer helper as by_color }\n"
                       "variant t_named of t { helper red }\n"
                       "derive \"{t}_{p}\" for t in { t_named }, p in clear phrases appearance "
                       "of helper {\n"
                       "  refer helper as p }\n");
  CHECK(a->task("t").prompt == "put the blue block and the red thing on the tray");
  CHECK(a->task("t_named_by_color").complete);
  CHECK(axes_text(*a, "t_named") == "language.appearance");
}

TEST_CASE("slot: words that count know how many there are") {
  const auto prompt = [](const std::string& goods, const std::string& words) {
    const auto a = analyze_with_suite(kRoles + "task t like pile { goods " + goods + "; say \"" +
                                      words + "\" }\n");
    return a->diagnostics.has_errors() ? a->codes() : a->task("t").prompt;
  };
  CHECK(prompt("red, blue", "take {both goods}") == "take both blocks");
  CHECK(prompt("red, blue, green", "take {all goods}") == "take all blocks");
  CHECK(prompt("red, blue, green", "take {all three goods}") == "take all three blocks");
  CHECK(prompt("red, blue, green", "take {the goods}") ==
        "take the red block, the blue block and the green block");
  CHECK(prompt("red, blue", "take {goods}") == "take red block and blue block");
  CHECK(prompt("red, blue", "take {the red}, then {the other goods}") ==
        "take the red block, then the other block");
  CHECK(prompt("red, blue, green", "take {both goods}") == "P1104");
  CHECK(prompt("red, blue", "take {all goods}") == "P1104");
  CHECK(prompt("red, blue", "take {all three goods}") == "P1104");
  CHECK(prompt("red, blue", "take {the other goods}") == "P1104");
  CHECK(prompt("red, blue; distractors green", "take {both goods}") == "P1104");
  CHECK(prompt("red, blue", "take {both target}") == "P1104");
}

TEST_CASE(
    "binder: templates that speak of roles a task has not, or count otherwise, are no choice") {
  const auto a = clean(kRoles +
                       "template heap frame pack \"pack {the goods} onto {the target}\"\n"
                       "template three frame pack \"pack {all three goods} onto {the target}\"\n"
                       "template helped frame pack \"pack {the helper} onto {the target}\"\n"
                       "task t like pile { goods red, blue }\n"
                       "derive \"{t}_{w}\" for t in { t }, w in templates of pack { say w }\n");
  CHECK(a->task("t_heap").prompt == "pack the red block and the blue block onto the tray");
  CHECK(a->task("t_three").name.empty());
  CHECK(a->task("t_helped").name.empty());
}

TEST_CASE("layout_st: what a layout places by name is in the scene") {
  const Built built(
      "layout with_pale like pairs { place pale at (0cm, 0cm) }\n"
      "metrics off_pale like plain { clear = at end (distance(source, pale) > 10cm) }\n"
      "task t like red_on_tray { layout with_pale; metrics off_pale; distractors blue }\n");
  CHECK(roles_text(built, "t") == "source red, target tray, distractor 1 blue, placed 1 pale");
  CHECK(built.task("t").distractors == 1);
  CHECK(analyze_with_suite(
            "metrics off_pale like plain { clear = at end (distance(source, pale) > 10cm) }\n"
            "task t like red_on_tray { metrics off_pale }")
            ->codes() == "P0201");
  // A parameter of that name is the parameter.
  CHECK(analyze_with_suite("predicate low(pale: object) = height(pale) < 10cm\n"
                           "metrics m like plain { low = once low(source) }\n"
                           "task t like red_on_tray { metrics m }")
            ->codes()
            .empty());
}

TEST_CASE("binder: a role of the task, object by object; cond: an axis of its own") {
  const auto a = clean(kRoles +
                       "task t like pile { goods red, blue }\n"
                       "derive \"{t}_not_{o}\" for t in { t }, o in goods of t {\n"
                       "  say \"put {the goods} on {the target}, never {avoid the o} alone\" }\n"
                       "task both like pair { source red; helper blue; target tray }\n"
                       "variants of both { v { helper green }; w { source pale } }\n"
                       "set helped = variants of { both } where axis object.helper\n"
                       "set others = variants of { both } where axis object.other\n");
  CHECK(a->task("t_not_blue").complete);
  CHECK(axes_text(*a, "v") == "object.other");
  CHECK(names_text(*a, named(a->model.sets, "helped").members) == "v");
  CHECK(names_text(*a, named(a->model.sets, "others").members) == "v");
  CHECK(analyze_with_suite("set s = tasks where axis object.helper")->codes() == "P0201");
}
