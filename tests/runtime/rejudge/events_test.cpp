// The library's events, put behind the small plan's metrics, over a trace made by hand.
#include "runtime/rejudge/events.h"

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "compiler/diag/text.h"
#include "compiler/emit/graft.h"
#include "runtime/base/json.h"
#include "runtime/rejudge/event_table.h"
#include "runtime/rejudge/explain.h"
#include "tests/runtime/rejudge/made_trace.h"

using namespace probe;
using namespace probe::rejudge;

namespace {

constexpr std::uint16_t kCarrot = 0, kPlate = 1, kSurface = 2, kLeft = 3, kRight = 4, kWrist = 5;
const std::string kLibrary = VLAPROBE_SOURCE_DIR "/dsl/std/events.probe";

AnalyzedText analyzed(const std::string& file) {
  auto text = analyze_text(std::span(&file, 1),
                           {.asset_root = "", .library_folders = {VLAPROBE_SOURCE_DIR "/dsl"}});
  REQUIRE_MESSAGE(text.ok(), to_text(text.failure()));
  REQUIRE_MESSAGE(text->compilation.ok,
                  render_text(text->compilation.diagnostics, text->compilation.sources));
  return std::move(text).value();
}

struct Judging {
  plan::Plan plan;
  EventMetrics metrics;
  std::vector<MetricLeftOut> left_out;
};

Judging grafted(const plan::Plan& stored, const std::string& file = kLibrary) {
  AnalyzedText text = analyzed(file);
  EventMetrics metrics;
  for (const DeclaredMetrics& set : declared_metrics(text))
    (set.name == "progress" ? metrics.subgoals : metrics.events) = set.metrics;
  auto made = graft_metrics(stored, std::move(text));
  REQUIRE_MESSAGE(made.ok(), to_text(made.failure()));
  auto plan = plan::Plan::from_bytes(std::move(made->plan));
  REQUIRE_MESSAGE(plan.ok(), to_text(plan.failure()));
  return {std::move(plan).value(), std::move(metrics), std::move(made->left_out)};
}

void touch(store::TraceStep& step, std::uint16_t a, std::uint16_t b, const Vec3& push) {
  step.sample.contacts.push_back({a, b, push});
  std::ranges::sort(step.sample.contacts, {},
                    [](const vm::ContactSample& c) { return std::pair(c.a, c.b); });
}

// Sixty steps: the carrot lies, is grasped at step 10 and lifted 20 cm, dropped at 20; the wrist
// meets the surface at 30, 31 and 40; the left finger shoves the plate at 50; the carrot rolls over
// at 55.
store::Trace eventful(const plan::Plan& plan) {
  store::Trace trace = made_trace(plan, 0);
  trace.start->starts[kCarrot].position = {0, 0, 0.89};
  trace.start->starts[kCarrot].half = {0.02, 0.02, 0.02};
  trace.start->starts[kPlate].half = {0.1, 0.1, 0.01};
  trace.start->starts[kLeft].opening = {0, 1, 0};
  trace.start->starts[kRight].opening = {0, -1, 0};
  for (int i = 1; i <= 60; ++i) {
    store::TraceStep& step = trace.steps[static_cast<std::size_t>(i) - 1];
    vm::StepSample& s = step.sample;
    s.contacts.clear();
    const bool is_held = i >= 10 && i < 20;
    s.bodies[kCarrot].position = {0, 0, is_held ? 0.89 + 0.02 * (i - 9) : 0.89};
    s.bodies[kPlate].position = {0.3, 0, 0.88};
    s.bodies[kSurface].position = {0, 0, 0.87};
    s.tcp = {0, 0, i < 10 ? 1.385 - 0.05 * i : s.bodies[kCarrot].position.z()};
    if (is_held) {
      touch(step, kCarrot, kLeft, {0, 0.5, 0});
      touch(step, kCarrot, kRight, {0, -0.5, 0});
    } else {
      touch(step, kCarrot, kSurface, {0, 0, -0.1});
    }
    if (i == 30 || i == 31 || i == 40) touch(step, kSurface, kWrist, {0, 0, 0.1});
    if (i == 50) {
      touch(step, kPlate, kLeft, {-0.1, 0, 0});
      s.bodies[kPlate].velocity = {0.1, 0, 0};
    }
    if (i >= 55)
      s.bodies[kCarrot].rotation = Quat(Eigen::AngleAxisd(1.5707963267948966, Vec3::UnitX()));
  }
  return trace;
}

std::string to_text(const std::vector<EventMark>& marks) {
  std::string text;
  for (const EventMark& mark : marks)
    text += fmt::format("{} {} {}; ", mark.step, mark.name, mark.bodies);
  return text;
}

struct TextFile {
  std::filesystem::path path;
  explicit TextFile(const std::string& text)
      : path(std::filesystem::temp_directory_path() /
             fmt::format("probe_events_{}.probe", getpid())) {
    std::ofstream(path) << text;
  }
  ~TextFile() { std::filesystem::remove(path); }
};

}  // namespace

TEST_CASE("events are told with their steps and whose they are, subgoals in their order") {
  const plan::Plan stored = small();
  const Judging judging = grafted(stored);
  const auto events = events_of(judging.plan, 0, eventful(stored), judging.metrics);
  REQUIRE_MESSAGE(events.ok(), probe::to_text(events.failure()));
  CHECK(events->untold.empty());
  CHECK(to_text(events->marks) ==
        "9 reached_it carrot; 10 grasped_it carrot; 10 lifted_it carrot; 20 dropped carrot; "
        "30 touched_table wrist; 30 arm_on_table wrist; 40 touched_table wrist; "
        "40 arm_on_table wrist; 50 bumped plate; 55 tipped carrot; ");
  CHECK(events->reached == 3);
  CHECK(events->subgoals == 6);
  CHECK(events->last == "lifted_it");
  CHECK(*events->to_grasp.value == 2.0);  // 10 steps at 5 Hz
  CHECK(!events->hand_over.value);
  CHECK(events->hand_over.why_not == "never placed");
  for (const EventCount& count : events->counts) {
    CAPTURE(count.name);
    const bool is_twice = count.name == "touched_table" || count.name == "arm_on_table";
    CHECK(*count.value == (is_twice ? 2 : count.name == "left_table" ? 0 : 1));
  }
}

TEST_CASE("what is taken down from where it began is over the goal while it is held above that") {
  const plan::Plan stored = small();
  const Judging judging = grafted(stored);
  store::Trace trace = eventful(stored);
  trace.start->starts[kCarrot].position = {0, 0, 1.2};
  for (std::size_t i = 0; i < trace.steps.size(); ++i) {
    vm::StepSample& s = trace.steps[i].sample;
    if (i < 11) s.bodies[kCarrot].position = {0, 0, i < 9 ? 1.2 : 1.22};
    if (i >= 11 && i < 19) s.bodies[kCarrot].position = {0.3, 0, 1.0};
    s.tcp = s.bodies[kCarrot].position;
  }
  const auto events = events_of(judging.plan, 0, trace, judging.metrics);
  REQUIRE_MESSAGE(events.ok(), probe::to_text(events.failure()));
  CHECK_MESSAGE(events->last == "over_goal", to_text(events->marks));
  CHECK(events->reached == 4);
}

TEST_CASE("a time that a task cannot have says that it is of a source and a target alone") {
  const plan::Plan stored = small();
  Judging judging = grafted(stored);
  const auto hand_over = [&] {
    const auto events = events_of(judging.plan, 0, eventful(stored), judging.metrics);
    REQUIRE_MESSAGE(events.ok(), probe::to_text(events.failure()));
    return events->hand_over.why_not;
  };
  std::erase(judging.metrics.subgoals, "placed_it");
  CHECK(hand_over() == "the task has no target to place it on");
  std::erase(judging.metrics.subgoals, "grasped_it");
  CHECK(hand_over() == "the task has no source, and no other role is timed");
}

TEST_CASE("nothing is told of an invalid episode, and why stands in every form") {
  const plan::Plan stored = small();
  const Judging judging = grafted(stored);
  store::Trace trace = eventful(stored);
  trace.end.emplace();
  trace.end->invalid = "the server, \"gone\"";
  const auto events = events_of(judging.plan, 0, trace, judging.metrics);
  REQUIRE(events.ok());
  CHECK(events->untold == "invalid: the server, \"gone\"");
  CHECK(events->counts.empty());
  CHECK(events->motion.empty());
  EventRow row;
  row.row.task = "pick";
  row.events = *events;
  CHECK(event_tally(std::span(&row, 1)) ==
        "pick: 1 episodes, nothing told of 1 (episode 0 seed 0: invalid: the server, \"gone\")\n");
  CHECK(events_to_csv(std::span(&row, 1)) ==
        "task,episode,seed,policy,steps,reached,subgoals,why_not\n"
        "pick,0,0,,,,,\"invalid: the server, \"\"gone\"\"\"\n");
  const Json json = Json::parse(events_to_json(std::span(&row, 1)));
  CHECK(json[0]["untold"] == events->untold);
  CHECK(!json[0].contains("events"));
}

TEST_CASE("a number that is not there is null or empty, with its reason, never 0") {
  const plan::Plan stored = small();
  const Judging judging = grafted(stored);
  EventRow row;
  row.row.task = "pick";
  row.row.steps = 60;
  row.events = *events_of(judging.plan, 0, eventful(stored), judging.metrics);
  const Json json = Json::parse(events_to_json(std::span(&row, 1)))[0];
  CHECK(json["motion"]["hand_over"].is_null());
  CHECK(json["why_not"]["hand_over"] == "never placed");
  CHECK(json["subgoals"][4]["step"].is_null());
  const std::string csv = events_to_csv(std::span(&row, 1));
  CHECK(csv.find(",2,,") != std::string::npos);  // to_grasp, then hand_over
  CHECK(csv.find("hand_over: never placed") != std::string::npos);
}

TEST_CASE("metrics are put behind those of the plan, or in the place of one of their name") {
  const plan::Plan stored = small();
  const TextFile file(
      "metrics mine { spread = max height(source); low = min height(source); steps = final step "
      "}\n");
  const Judging judging = grafted(stored, file.path);
  std::vector<std::string> names;
  for (const auto& metric : judging.plan.metrics(judging.plan.tasks()[0]))
    names.emplace_back(judging.plan.text(metric.name));
  CHECK(names == std::vector<std::string>{"near", "steady", "spread", "low", "steps"});
  const auto why = explain(judging.plan, 0, eventful(stored));
  REQUIRE_MESSAGE(why.ok(), probe::to_text(why.failure()));
  CHECK((*why)[2].shown == "1.09m");
  CHECK((*why)[2].statement == "spread = max height(source)");
  CHECK((*why)[4].value == 60);
  // What is not judged is as it was.
  CHECK(judging.plan.episodes()[0].start_id == stored.episodes()[0].start_id);
  CHECK(judging.plan.episodes()[0].episode_id != stored.episodes()[0].episode_id);
}

TEST_CASE("a metric that no task can be measured by is refused, one that some lack is left out") {
  const plan::Plan stored = small();
  const TextFile some(
      "role helper\nmetrics mine { high = max height(source); helped = max height(helper) }\n");
  const Judging judging = grafted(stored, some.path);
  REQUIRE(judging.left_out.size() == 1);
  CHECK(judging.left_out[0].metric == "helped");
  REQUIRE(judging.left_out[0].tasks.size() == stored.tasks().size());
  CHECK(judging.left_out[0].tasks[0].why == "this is not in the scene (`helper`)");
  CHECK(judging.left_out[0].tasks[0].name == stored.text(stored.tasks()[0].name));
  const TextFile none("role helper\nmetrics mine { helped = max height(helper) }\n");
  const auto refused = graft_metrics(stored, analyzed(none.path));
  REQUIRE(!refused.ok());
  CHECK(refused.failure().message ==
        "metric `helped` fits no task of the plan: this is not in the scene (`helper`)");
  // As in a suite, an episode is not scored by a number.
  const TextFile number("metrics mine { low = min height(source); success = max time }\n");
  const auto scored = graft_metrics(stored, analyzed(number.path));
  REQUIRE(!scored.ok());
  CHECK(scored.failure().message.find("`success` has to be true or false") != std::string::npos);
  CHECK(scored.failure().message.find("P0601") != std::string::npos);
  const TextFile seen("metrics mine { left = min view_x(source) }\n");
  CHECK(!graft_metrics(stored, analyzed(seen.path)).ok());
}
