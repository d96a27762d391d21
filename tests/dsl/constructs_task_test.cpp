// Tasks, variants, derives, what moved, and the identities. Each case begins with the productions
// it holds.
#include <doctest/doctest.h>

#include "tests/dsl/built.h"

using namespace probe;
using namespace probe::test;

namespace {

// Which identities of `v` are those of `red_on_tray`, at every episode.
std::string equal_ids(const Built& built, const char* task = "v") {
  const plan::Plan& plan = built.plan();
  const plan::TaskRecord& a = built.task("red_on_tray");
  const plan::TaskRecord& b = built.task(task);
  const auto ours = plan.episodes(a), theirs = plan.episodes(b);
  bool start = ours.size() == theirs.size(), episode = start;
  for (std::size_t e = 0; e < std::min(ours.size(), theirs.size()); ++e) {
    start = start && ours[e].start_id == theirs[e].start_id;
    episode = episode && ours[e].episode_id == theirs[e].episode_id;
  }
  std::string text;
  if (start) text += "start ";
  if (plan.text(a.prompt) == plan.text(b.prompt)) text += "prompt ";
  if (a.judge_id == b.judge_id) text += "judge ";
  if (episode) text += "episode ";
  return text;
}

std::string equal_ids(const std::string& change, const std::string& more = "") {
  return equal_ids(
      Built(more + "@allow(confounded, \"test\")\nvariant v of red_on_tray { " + change + " }\n"));
}

std::string moved(const std::string& change, const std::string& more = "") {
  const auto a = analyze_with_suite(
      more + "@allow(confounded, \"test\")\nvariant v of red_on_tray { " + change + " }\n");
  CHECK_MESSAGE(!a->diagnostics.has_errors(), a->said());
  return axes_text(*a, "v");
}

}  // namespace

TEST_CASE("task: `like` copies fields, a new role drops what was said of the old one") {
  const auto a = clean(
      "task both like base { source red; target tray_two; refer source as by_color; refer target "
      "as "
      "by_look; distractors blue }\n"
      "object tray_two like tray { name \"second tray\"\n"
      "  phrase by_look appearance \"gray thing\" means color gray }\n"
      "object novel like red { name \"novel block\" }\n"
      "task copied like both { horizon 10 steps }\n"
      "task other_source like both { source novel }\n"
      "task same_again like both { source red }\n");
  CHECK(a->task("copied").prompt == "put red thing on the gray thing");
  CHECK(a->task("copied").distractors == a->task("both").distractors);
  CHECK(a->task("other_source").prompt == "put novel block on the gray thing");
  // Also when it names the same object: the statement says the role anew.
  CHECK(a->task("same_again").prompt == "put red block on the gray thing");
}

TEST_CASE("task: abstract ones may lack fields and are in no set; others may not") {
  const auto a = clean(
      "abstract task half { scene bench; horizon 10 steps }\n"
      "abstract task more like half { layout pairs; metrics plain; say put }\n"
      "task whole like more { source blue; target tray }\nset all = tasks\n");
  CHECK(a->task("whole").horizon == 10);
  CHECK(names_text(*a, named(a->model.sets, "all").members) == "red_on_tray whole");
  CHECK(analyze_with_suite("task t { scene bench }")->codes() == "P0206");
  CHECK(analyze_with_suite("task a like b {}\ntask b like a {}")->codes().starts_with("P0207"));
}

TEST_CASE("task, variant: `against` names the baseline, `variant of` copies and compares") {
  const auto a = clean(
      "task alone like red_on_tray { light night }\n"
      "task compared like red_on_tray against red_on_tray { light night }\n"
      "variant v of red_on_tray { light night }\n"
      "variant w of v against red_on_tray { light day; say take }\n"
      "variant x of v { say take }\n");
  CHECK(a->task("alone").baseline == sema::TaskId::kNone);
  CHECK(axes_text(*a, "compared") == "light");
  CHECK(axes_text(*a, "v") == "light");
  CHECK(a->model.tasks[a->task("w").baseline].name == "red_on_tray");
  CHECK(axes_text(*a, "w") == "language.action");
  CHECK(a->model.tasks[a->task("x").baseline].name == "v");
  CHECK(analyze_with_suite("variant v of red_on_tray {}")->codes() == "P0702");
  CHECK(analyze_with_suite("task a like red_on_tray against b { light night }\n"
                           "task b like red_on_tray against a { say take }")
            ->codes() == "P0703");
}

TEST_CASE("variants: each name is a variant of the one task") {
  const auto a = clean(
      "variants of red_on_tray {\n  a { say take }; b { light night }\n\n c { horizon 61 steps "
      "}\n}\n");
  for (const char* name : {"a", "b", "c"}) {
    CHECK(a->model.tasks[a->task(name).baseline].name == "red_on_tray");
  }
  CHECK(axes_text(*a, "c") == "goal");
}

TEST_CASE("task_st: what each statement moves") {
  CHECK(moved("source blue") == "object.source");
  CHECK(moved("target pale") == "object.target");
  CHECK(moved("distractors pale") == "distractors");
  CHECK(moved("say take") == "language.action");
  CHECK(moved("refer source as by_color") == "language.appearance");
  CHECK(moved("refer source as loved") == "language.commonsense");
  CHECK(moved("pose red yaw 0deg, yaw 45deg") == "layout");
  CHECK(moved("layout l", "layout l like pairs { drop 11cm }\n") == "layout");
  CHECK(moved("scene s", "scene s like bench { physics 250Hz friction 1 }\n") == "scene");
  CHECK(moved("light night") == "light");
  CHECK(moved("camera c", "camera c like eye { lens 31px, 30px, 32px, 24px }\n") == "camera");
  CHECK(moved("horizon 61 steps") == "goal");
  CHECK(moved("metrics m", "metrics m { success = once height(source) > height(target) }\n") ==
        "goal");
  CHECK(moved("set success = once height(source) > height(target)") == "goal");
  CHECK(moved("source blue; distractors red") == "object.source distractors");
  // Another name of the same content moves nothing; neither does the order of distractors.
  CHECK(analyze_with_suite(
            "layout l like pairs {}\nlight noon { ambient 0.3; sun (0, 0, -1) power 2 }\n"
            "variant v of red_on_tray { layout l; light noon }")
            ->codes() == "P0702");
  CHECK(analyze_with_suite("variant d of red_on_tray { distractors pale, blue }\n"
                           "variant v of d { distractors blue, pale }")
            ->codes() == "P0702");
  CHECK(
      clean("variant d of red_on_tray { distractors pale }\nvariant v of d { distractors none }\n")
          ->task("v")
          .distractors.empty());
}

TEST_CASE("skill, thing: how a task can be solved moves nothing, is inherited and replaced whole") {
  const auto a = clean(
      "task t like red_on_tray { solution { pick source; put source on target; put source on "
      "surface } }\n"
      "variant u of t { source blue }\n"
      "variant v of t { solution none; say take }\n");
  const auto& solution = a->task("t").solution;
  REQUIRE(solution.size() == 3);
  CHECK(solution[0].skill == plan::Skill::kPick);
  CHECK(solution[1].relation == plan::SkillRelation::kOn);
  CHECK(solution[2].to.owner.text == "surface");
  CHECK(a->task("u").solution.size() == 3);
  CHECK(a->task("v").solution.empty());
  CHECK(analyze_with_suite("variant v of red_on_tray { solution { push target } }")->codes() ==
        "P0702");
  CHECK(analyze_with_suite("task v like red_on_tray { solution { put source beside source } }")
            ->codes() == "P1401");
  CHECK(
      analyze_with_suite("task v like red_on_tray { solution { turn source to 3cm } }")->codes() ==
      "P0302");
  CHECK(analyze_with_suite("task v like red_on_tray { solution { put source } }")->codes() ==
        "P0101");
}

TEST_CASE("role, task_st: `refer` chooses a phrase of the object in that role") {
  const auto a = clean("variant v of red_on_tray { refer source as toy }\n");
  CHECK(a->task("v").prompt == "put toy on the tray");
  const auto wrong = analyze_with_suite("variant v of red_on_tray { refer target as toy }\n");
  CHECK(wrong->codes() == "P0201");
  CHECK(wrong->underlined() == "toy");
}

TEST_CASE("task_st: `pose` replaces an object's rest poses in this task") {
  const auto a = clean("variant v of red_on_tray { pose red yaw 30deg, yaw 60deg }\n");
  CHECK(starts_text(*a, "v")[0] == "red -10,-10@30 tray -10,10@0");
  CHECK(starts_text(*a, "v")[1] == "red -10,-10@60 tray -10,10@0");
}

TEST_CASE("task: identities, which change moves which") {
  // Words: the prompt alone. The start and the judge are the baseline's, episode by episode.
  CHECK(equal_ids("say take") == "start judge ");
  CHECK(equal_ids("refer source as by_color") == "start judge ");
  // The world: the start alone.
  CHECK(equal_ids("distractors pale") == "prompt judge ");
  CHECK(equal_ids("light night") == "prompt judge ");
  CHECK(equal_ids("pose red yaw 1deg, yaw 2deg") == "prompt judge ");
  CHECK(equal_ids("layout l", "layout l like pairs { drop 11cm }\n") == "prompt judge ");
  CHECK(equal_ids("scene s", "scene s like bench { physics 250Hz friction 1 }\n") ==
        "prompt judge ");
  CHECK(equal_ids("source heavy", "object heavy like red { density 501kg/m3 }\n") ==
        "prompt judge ");
  // The judgement: the judge alone.
  CHECK(equal_ids("horizon 61 steps") == "start prompt ");
  CHECK(equal_ids("set success = once height(source) > height(target)") == "start prompt ");
  CHECK(equal_ids("set success = at end height(source) > height(target) + 1mm") == "start prompt ");
  // What it is called, where it stands and what is said about it: nothing.
  CHECK(equal_ids(Built(
            "# a comment\n@allow(confounded, \"why\")\ntask v like red_on_tray {}\n"
            "suite s trained on lab { tasks { v, red_on_tray }; seeds 1, 2; prefix \"p_\" }\n")) ==
        "start prompt judge episode ");
  CHECK(equal_ids(
            "source same; distractors pale",
            "object same like red { unseen; phrase extra appearance \"x\" means color red }\n") ==
        "prompt judge ");
  CHECK(equal_ids(Built("predicate over(a: object, b: object) = height(a) > height(b)\n"
                        "metrics again { success = at end over(source, target) }\n"
                        "task v like red_on_tray { metrics again }\n")) ==
        "start prompt judge episode ");
}

TEST_CASE("derive, binder: one variant for each choice, the first binder slowest") {
  const auto a = clean(
      "object rose like red { name \"rose block\"; color red }\n"
      "task rose_on_tray like base { source rose; target tray }\n"
      "derive \"{t}_{p}\" for t in { red_on_tray, rose_on_tray }, p in phrases appearance of "
      "source { refer source as p }\n"
      "derive \"dark_{t}\" for t in { red_on_tray } | variants of { red_on_tray } where uses "
      "appearance { light night }\n"
      "set derived = tasks where has baseline\n");
  CHECK(names_text(*a, named(a->model.sets, "derived").members) ==
        "red_on_tray_by_color red_on_tray_toy rose_on_tray_by_color rose_on_tray_toy "
        "dark_red_on_tray_by_color dark_red_on_tray_toy");
  CHECK(a->task("red_on_tray_toy").prompt == "put toy on the tray");
  CHECK(a->model.tasks[a->task("dark_red_on_tray_toy").baseline].name == "red_on_tray_toy");
  CHECK(axes_text(*a, "dark_red_on_tray_toy") == "light");
  // Phrases of the target, and of the other axis.
  const auto b = clean(
      "object dish like tray { name \"dish\"; phrase gray_one commonsense \"gray one\" means color "
      "gray }\n"
      "task on_dish like base { source red; target dish }\n"
      "derive \"{t}_{p}\" for t in { on_dish }, p in phrases commonsense of target { refer target "
      "as p }\n");
  CHECK(b->task("on_dish_gray_one").prompt == "put red block on the gray one");
}

TEST_CASE(
    "binder: objects, templates of a frame, distractors, and phrases that mean one thing alone") {
  const auto a = clean(
      "template put_it frame put \"put {the source} onto {the target}\"\n"
      "variant crowd of red_on_tray { distractors blue }\n"
      "derive \"{t}_with_{o}\" for t in { red_on_tray }, o in objects (red, blue, tray) { source o "
      "}\n"
      "derive \"{t}_in_{w}\" for t in { red_on_tray }, w in templates of put { say w }\n"
      "derive \"{t}_not_{o}\" for t in { crowd }, o in distractors of t {\n"
      "  say \"put {source} on {the target}, not {avoid the o}\"\n}\n"
      "derive \"{t}_{p}\" for t in { crowd }, p in clear phrases appearance of source { refer "
      "source "
      "as p }\n"
      "set derived = tasks where has baseline\n");
  // What the task has already is left out: the red block itself, the template `put`, the phrase
  // "toy", which means the blue block too.
  CHECK(names_text(*a, named(a->model.sets, "derived").members) ==
        "crowd red_on_tray_with_blue red_on_tray_in_put_it crowd_not_blue crowd_by_color");
  CHECK(a->task("crowd_not_blue").prompt == "put red block on the tray, not the blue block");
  CHECK(axes_text(*a, "red_on_tray_in_put_it") == "language.paraphrase");
}

TEST_CASE("derive: an @allow above it stands for each of its variants") {
  const Built built(
      "@allow(confounded, \"both\")\nderive \"{t}_late\" for t in { red_on_tray } { light night; "
      "say take }\n");
  CHECK(built.plan().text(built.task("red_on_tray_late").allow) == "both");
}

TEST_CASE("task: out-of-distribution tags come from the catalogue") {
  const auto a = clean(
      "object novel like red { unseen; name \"novel block\" }\n"
      "object dish like tray { unseen; name \"dish\" }\n"
      "variants of red_on_tray { s { source novel }; t { target dish }; r { source blue } }\n"
      "variant both of s { target dish }\nvariant reworded of r { say take }\n");
  CHECK(a->task("red_on_tray").ood == 0);  // red on tray was seen
  CHECK(a->task("s").ood == 1);
  CHECK(a->task("t").ood == 2);
  CHECK(a->task("both").ood == 3);
  CHECK(a->task("r").ood == 4);  // both were seen, but never one on the other
  CHECK(a->task("reworded").ood == 4);
}
