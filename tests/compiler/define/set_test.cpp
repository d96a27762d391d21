#include <doctest/doctest.h>

#include "tests/compiler/small_suite.h"

using namespace probe;
using test::analyze_with_suite;

namespace {

std::string members(const test::Analysis& a, std::string_view set) {
  std::string text;
  for (const sema::TaskSet& known : a.model.sets) {
    if (known.name != set) continue;
    for (const sema::TaskId id : known.members)
      text += (text.empty() ? "" : " ") + a.model.tasks[id].name;
  }
  return text;
}

}  // namespace

TEST_CASE("sets follow from conditions and name one another in any order") {
  const auto a = analyze_with_suite(R"(
set late = early | { v_dark }
set early = tasks where uses action
set rest = tasks - late - { red_on_tray }
set wordy = tasks where uses appearance and not has distractors
set moved = variants of { red_on_tray } where axis light or axis distractors
set fresh = tasks where ood source
set lenient = tasks where metrics ever
metrics ever { success = once height(source) > height(target) }
variants of red_on_tray {
  v_take { say take }
  v_dark { light night }
  v_color { refer source as by_color }
  v_new { source pale }
  v_ever { metrics ever }
}
variant v_take_dark of v_take { light night }
)");
  CHECK_MESSAGE(a->codes() == "", a->said());
  CHECK(members(*a, "early") == "v_take v_take_dark");
  CHECK(members(*a, "late") == "v_take v_take_dark v_dark");
  CHECK(members(*a, "rest") == "v_color v_new v_ever");
  CHECK(members(*a, "lenient") == "v_ever");
  CHECK(members(*a, "wordy") == "v_color");
  CHECK(members(*a, "moved") == "v_dark");
  CHECK(members(*a, "fresh") == "v_new");
}

TEST_CASE("a sample is a choice that a new task disturbs by at most one") {
  const std::string tasks =
      "variants of red_on_tray { a { horizon 61 steps }\n b { horizon 62 steps }\n c { horizon 63 "
      "steps }\n d { horizon 64 steps }\n e { horizon 65 steps } }\n";
  const std::string set = "set some = sample 3 of variants of { red_on_tray } seed 7\n";
  const auto before = analyze_with_suite(tasks + set);
  CHECK_MESSAGE(before->codes() == "", before->said());
  const auto after =
      analyze_with_suite(tasks + set + "variant f of red_on_tray { horizon 66 steps }");
  const std::string chosen = members(*before, "some");
  CHECK(chosen.size() == 5);
  CHECK(members(*analyze_with_suite(tasks + set), "some") == chosen);
  std::size_t kept = 0;
  for (const char name : chosen) {
    if (name != ' ' && members(*after, "some").find(name) != std::string::npos) ++kept;
  }
  CHECK(kept >= 2);
  CHECK(analyze_with_suite("set some = sample 3 of tasks seed 7")->codes() == "P0304");
}

TEST_CASE("a sample of variants is told of baselines that its suite does not run") {
  const std::string tasks =
      "variants of red_on_tray { a { horizon 61 steps }\n b { horizon 62 steps }\n c { horizon 63 "
      "steps } }\n";
  const auto codes = [&](const std::string& set) {
    return analyze_with_suite(tasks + "suite s { tasks " + set + "; seeds 1 }")->codes();
  };
  CHECK(codes("sample 2 of (variants of { red_on_tray }) seed 7") == "P0706");
  CHECK(codes("sample 2 of { a, b, c } seed 7") == "P0706");
  CHECK(codes("{ red_on_tray } | sample 2 of (variants of { red_on_tray }) seed 7") == "");
  CHECK(codes("variants of { red_on_tray }") == "");
  // What stands behind the baselines may take them away again.
  const std::string drawn = "sample 2 of { a, b, c } seed 7 with baselines";
  CHECK(codes(drawn) == "");
  CHECK(codes("(" + drawn + ") where has baseline") == "P0706");
  CHECK(codes("(" + drawn + ") - { red_on_tray }") == "P0706");
  CHECK(codes("((" + drawn + ") - { red_on_tray }) | { red_on_tray }") == "");
}

TEST_CASE("a task that a set names twice is said, tasks that two sets share are not") {
  const auto a = analyze_with_suite(
      "variant v of red_on_tray { light night }\n"
      "set s = { red_on_tray, v, red_on_tray }");
  CHECK(a->codes() == "P0203");
  CHECK_MESSAGE(a->said().find("`red_on_tray` is listed twice") != std::string::npos, a->said());
  CHECK(analyze_with_suite("variant v of red_on_tray { light night }\n"
                           "suite s { tasks { red_on_tray, v } | { v }; seeds 1 }")
            ->codes() == "");
}
