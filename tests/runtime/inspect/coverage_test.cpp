#include "runtime/inspect/coverage.h"

#include <sstream>

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
  CHECK(coverage_text(found) ==
        R"(                      base  other  total
object.source            .      .      .
object.target            .      .      .
object.other             .      .      .
distractors              2      .      2
language.action          2      .      2
language.negation        .      .      .
language.appearance      1      .      1
language.commonsense     .      .      .
language.paraphrase      .      .      .
language.spatial         .      .      .
layout                   .      .      .
motion                   .      .      .
fixture                  .      .      .
scene                    .      .      .
scene.texture            .      .      .
scene.geometry           .      .      .
light                    1      .      1
camera                   .      .      .
sensor                   .      .      .
robot                    .      .      .
latency                  .      .      .
goal                     1      .      1
variants                 6      .      6
confounded               1      .      1
ood source               .      .      .
ood target               .      .      .
ood relation             .      1      1
tasks                    7      1      8

39 of 44 cells are empty
objects never a source: plate
objects never a target: carrot, twig
objects never a distractor: carrot, plate
)");
}

TEST_CASE("a table of many bases goes on below itself, within a screen") {
  auto found = coverage(test::small_plan(), all_tasks(test::small_plan()));
  auto base = found["bases"][0];
  for (int i = 0; i < 8; ++i) {
    base["task"] = "a_base_with_a_name_" + std::to_string(i);
    found["bases"].push_back(base);
  }
  const std::string text = coverage_text(found);
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) CHECK(line.size() <= 100);
  std::size_t tables = 0;
  for (std::size_t at = 0; (at = text.find("object.source ", at)) != std::string::npos; ++at)
    ++tables;
  CHECK(tables == 3);
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
