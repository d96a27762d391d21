#include "runtime/inspect/coverage.h"

#include "runtime/inspect/graph.h"
#include "runtime/inspect/task_json.h"
#include "tests/runtime/inspect/small_plan.h"

using namespace probe;
using namespace probe::inspect;

TEST_CASE("coverage counts the variants of every base by axis and shows what is empty") {
  const plan::Plan& plan = test::small_plan();
  const auto found = coverage(plan, all_tasks(plan));
  CHECK(found["bases"].size() == 2);
  CHECK(found["bases"][0]["task"] == "base");
  CHECK(found["bases"][0]["axes"]["language.action"] == 2);
  CHECK(found["bases"][0]["axes"]["layout"] == 0);
  CHECK(found["objects"]["never_target"].dump() == R"(["carrot","twig"])");
  CHECK(
      coverage_text(found) ==
      R"(       object                       language                                                                       
base   source  target  distractors    action  negation  appearance  commonsense  layout  scene  light  camera  goal  variants  confounded
base        .       .            2         2         .           1            .       .      .      1       .     1         6           1
other       .       .            .         .         .           .            .       .      .      .       .     .         0           0
total       .       .            2         2         .           1            .       .      .      1       .     1         6           1

19 of 24 cells are empty
objects never a source: plate
objects never a target: carrot, twig
objects never a distractor: carrot, plate
)");
}

TEST_CASE("coverage of some tasks counts only those") {
  const plan::Plan& plan = test::small_plan();
  const auto found = coverage(plan, members(plan, *plan.find_suite("few")));
  CHECK(found["total"]["variants"] == 1);
  CHECK(found["objects"]["never_source"].dump() == R"(["plate","twig"])");
}

TEST_CASE("the graph has an edge from each baseline, dashed when more than one axis moves") {
  const plan::Plan& plan = test::small_plan();
  CHECK(graph_dot(graph(plan, all_tasks(plan))) == R"(digraph tasks {
  rankdir=LR;
  node [shape=box, fontname="Helvetica"];
  edge [fontname="Helvetica", fontsize=10];
  "base";
  "worded";
  "colored";
  "crowded";
  "longer";
  "dim";
  "both";
  "other";
  "base" -> "worded" [label="language.action"];
  "base" -> "colored" [label="language.appearance"];
  "base" -> "crowded" [label="distractors"];
  "base" -> "longer" [label="goal"];
  "base" -> "dim" [label="light"];
  "base" -> "both" [label="distractors\nlanguage.action", style=dashed, tooltip="published \"so\""];
}
)");
}
