// What an explanation cites, on programs that the compiler made: metrics share their conditions.
#include "runtime/rejudge/explain.h"

#include "compiler/emit/emit.h"
#include "tests/compiler/small_suite.h"
#include "tests/runtime/rejudge/made_trace.h"

namespace probe::rejudge {
namespace {

plan::Plan judged_by(const std::string& more) {
  auto a = test::analyze_with_suite(more);
  REQUIRE_MESSAGE(!a->diagnostics.has_errors(), a->said());
  emit::EmitOptions options{test::asset_root(), "", "", true};
  auto bytes = emit::emit(a->model, a->sources, {a->files[0].file.id}, options, a->diagnostics);
  REQUIRE_MESSAGE(bytes.ok(), to_text(bytes.failure()));
  auto plan = plan::Plan::from_bytes(std::move(*bytes));
  REQUIRE(plan.ok());
  return std::move(plan).value();
}

const Condition& only_condition(const std::vector<MetricWhy>& all, const std::string& metric) {
  for (const MetricWhy& why : all) {
    if (why.name != metric) continue;
    REQUIRE(why.conditions.size() == 1);
    return why.conditions.front();
  }
  FAIL("no metric " << metric);
  return all.front().conditions.front();
}

TEST_CASE("each metric cites its own words for a condition that it shares with another") {
  const plan::Plan plan = judged_by(R"(predicate under(a: object, b: object) = height(b) > height(a)
metrics m like plain {
  written_out = once height(source) > height(target)
  called = once under(target, source)
  held = once (height(source) > height(target) for 5 steps)
}
task t like red_on_tray { metrics m }
)");
  const std::uint32_t t = *plan.find_task("t");
  const auto why = explain(plan, t, made_trace(plan, t));
  REQUIRE_MESSAGE(why.ok(), to_text(why.failure()));
  CHECK(only_condition(*why, "success").text == "height(source) > height(target)");
  const Condition& called = only_condition(*why, "called");
  CHECK(called.text == "height(b) > height(a)");
  CHECK(called.bodies == "red, tray");
  const Condition& out = only_condition(*why, "written_out");
  CHECK(out.text == "height(source) > height(target)");
  // Each in the line where that metric has it.
  CHECK(only_condition(*why, "success").line < called.line);
  CHECK(out.line == called.line + 2);
  for (const MetricWhy& metric : *why) {
    if (metric.name == "held") CHECK(metric.conditions.front().line == out.line + 2);
  }
}

TEST_CASE("a condition says whose measurements it compares, in the order of its words") {
  const plan::Plan plan = judged_by(R"(predicate above(a: object, b: body) = height(a) > height(b)
predicate below(a: object, b: body) = height(a) < height(b)
metrics m like plain {
  up = once above(source, target)
  down = once above(target, source)
  lower = once below(target, surface)
}
task t like red_on_tray { metrics m }
)");
  const std::uint32_t t = *plan.find_task("t");
  const auto why = explain(plan, t, made_trace(plan, t));
  REQUIRE_MESSAGE(why.ok(), to_text(why.failure()));
  CHECK(only_condition(*why, "up").bodies == "red, tray");
  CHECK(only_condition(*why, "down").bodies == "tray, red");
  CHECK(only_condition(*why, "lower").bodies == "tray, surface");
}

TEST_CASE("tasks that are judged alike by two texts each cite their own") {
  const plan::Plan plan =
      judged_by(R"(metrics one { success = at end (height(source) > height(target)) }
metrics two { success = at end (height(source) > height(target)) }
task t like red_on_tray { metrics one }
task u like red_on_tray { metrics two; say take }
)");
  for (const char* name : {"t", "u"}) {
    const std::uint32_t task = *plan.find_task(name);
    const auto why = explain(plan, task, made_trace(plan, task));
    REQUIRE_MESSAGE(why.ok(), to_text(why.failure()));
    CHECK(why->front().statement.starts_with("success"));
    CHECK(why->front().line == only_condition(*why, "success").line);
  }
  const auto line = [&](const char* name) {
    const std::uint32_t task = *plan.find_task(name);
    return explain(plan, task, made_trace(plan, task))->front().line;
  };
  CHECK(line("u") == line("t") + 1);
}

}  // namespace
}  // namespace probe::rejudge
