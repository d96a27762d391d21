// Matching, refusing and explaining, on made-up traces of the small plan.
#include "runtime/rejudge/rejudge.h"

#include <doctest/doctest.h>

#include "runtime/rejudge/dimension.h"
#include "runtime/rejudge/explain.h"
#include "runtime/rejudge/match.h"
#include "runtime/rejudge/program_view.h"
#include "runtime/rejudge/rescore.h"
#include "runtime/store/run_record.h"
#include "runtime/store/store.h"
#include "tests/runtime/rejudge/made_trace.h"
#include "tests/runtime/run/temporary_folder.h"

namespace probe::rejudge {
namespace {

store::ResultRow row_of(const plan::Plan& plan, std::uint32_t task, int episode) {
  const plan::TaskRecord& record = plan.tasks()[task];
  store::ResultRow row;
  row.task = plan.text(record.name);
  row.episode = episode;
  row.start_id = to_hex(Sha256{plan.episodes(record)[static_cast<std::size_t>(episode)].start_id});
  return row;
}

TEST_CASE("a trace is judged to the horizon, and its metrics are those of its steps") {
  const plan::Plan plan = small();
  const auto score = rescore(plan, 0, made_trace(plan, 0));
  REQUIRE_MESSAGE(score.ok(), to_text(score.failure()));
  CHECK(!score->invalid);
  REQUIRE(score->steps.size() == 60);
  CHECK(score->steps[1][0] == 0);
  CHECK(score->steps[2][0] == 1);
  CHECK(score->metrics[0] == store::MetricValue{"near", true, 1});
  CHECK(score->steps[12][2] == 0);  // touched for 4 steps
  CHECK(score->steps[13][2] == 1);
}

TEST_CASE("a search's run is not judged into a folder, and has no others to run") {
  const plan::Plan plan = small();
  run::TemporaryFolder folder;
  store::RunRecord record;
  record.identity.plan_root = to_hex(plan.root());
  record.identity.policy = "pi0";
  record.identity.until = store::kBySearch;
  record.fingerprint.entries = {{"cpu", "test"}};
  REQUIRE(store::Store::open(folder / "run", record, plan.bytes()).ok());
  RejudgeOptions options;
  options.out = folder / "out";
  const auto refused = probe::rejudge::rejudge(folder / "run", plan, options);
  REQUIRE_FALSE(refused.ok());
  CHECK(refused.failure().message.find("is of a search") == 0);
  CHECK(refused.failure().message.find("--until") == std::string::npos);
}

TEST_CASE("measurements that are not the task's are refused with the reason") {
  const plan::Plan plan = small();
  const auto refusal = [&](auto&& change) {
    store::Trace trace = made_trace(plan, 0);
    change(trace);
    const auto score = rescore(plan, 0, trace);
    REQUIRE(!score.ok());
    CHECK(score.failure().code == Fault::kUsage);
    return score.failure().message;
  };
  using store::Trace;
  CHECK(refusal([](Trace& t) { t.header.bodies.pop_back(); }).starts_with("5 bodies were"));
  CHECK(refusal([](Trace& t) { t.header.bodies[4] = "thumb"; }).starts_with("body 4 is `thumb`"));
  CHECK(refusal([](Trace& t) { t.header.control_hz = 10; }).starts_with("it was measured at 10"));
  CHECK(refusal([](Trace& t) { t.header.prompt = "drop it"; }).find("drop it") !=
        std::string::npos);
  CHECK(refusal([](Trace& t) { t.steps.pop_back(); }).starts_with("it has 59 steps"));
  store::Trace renamed = made_trace(plan, 0);
  renamed.header.bodies[0] = "vegetable";
  CHECK(rescore(plan, 0, renamed).ok());
  // Links of fixtures that the plan does not know follow its bodies.
  store::Trace furnished = made_trace(plan, 0);
  furnished.header.bodies.push_back("cabinet.tray");
  furnished.start->starts.resize(furnished.header.bodies.size());
  for (store::TraceStep& step : furnished.steps) {
    step.sample.bodies.resize(furnished.header.bodies.size());
  }
  const auto judged = rescore(plan, 0, furnished);
  REQUIRE(judged.ok());
  CHECK(judged->metrics == rescore(plan, 0, made_trace(plan, 0))->metrics);
}

TEST_CASE("what moves by itself is judged by where it was let go, or not at all") {
  plan::Writer w = plan::small_writer();
  w.records.moves.push_back({0, 0, {0.1, 0}, 0.05});
  w.records.tasks[0].moves = {0, 1};
  const plan::Plan plan = opened(w);
  store::Trace trace = made_trace(plan, 0);
  const auto refused = rescore(plan, 0, trace);
  REQUIRE(!refused.ok());
  CHECK(refused.failure().message ==
        "it does not say where `carrot` was let go, which moves by itself");
  for (store::TraceStep& step : trace.steps)
    step.sample.own = {{0, step.sample.bodies[0].position}};
  const auto score = rescore(plan, 0, trace);
  REQUIRE_MESSAGE(score.ok(), to_text(score.failure()));
  CHECK(!score->invalid);
}

TEST_CASE("an invalid episode stays invalid with its reason, judged as far as it went") {
  const plan::Plan plan = small();
  store::Trace trace = made_trace(plan, 0);
  trace.steps.resize(7);
  trace.end = store::TraceEnd{7, {}, "policy: gone"};
  const auto score = rescore(plan, 0, trace);
  REQUIRE(score.ok());
  CHECK(score->steps.size() == 7);
  CHECK(score->invalid == "policy: gone");
  store::Trace broken = made_trace(plan, 0);
  broken.steps[4].sample.tcp.x() = NAN;
  const auto judged = rescore(plan, 0, broken);
  REQUIRE(judged.ok());
  CHECK(judged->steps.size() == 4);
  CHECK(judged->invalid->starts_with("judge: "));
}

TEST_CASE("a start is matched by its id, and the part that differs is named") {
  const plan::Plan recorded = small();
  CHECK(match_start(recorded, 0, row_of(recorded, 0, 1), recorded)->episode == 1);
  const auto difference = [&](auto&& change) {
    plan::Writer w = plan::small_writer();
    change(w.records);
    const plan::Plan other = opened(w);
    const auto match = match_start(other, 0, row_of(recorded, 0, 1), recorded);
    REQUIRE(!match.ok());
    CHECK(match.failure().where == "carrot_on_plate episode 1 seed 0");
    const std::string& text = match.failure().message;
    return text.substr(text.find("differ in: ") + 11);
  };
  using plan::Records;
  CHECK(difference([](Records& r) { r.scenes[0].surface_z = 0.9; }) == "scene");
  CHECK(difference([](Records& r) { r.robots[0].grip_open = 0.03; }) == "robot");
  CHECK(difference([](Records& r) { r.cameras[0].fx = 500; }) == "camera");
  CHECK(difference([](Records& r) { r.suns[0].power = 1; }) == "light");
  CHECK(difference([](Records& r) { r.tasks[0].settle = 1; }) == "drop");
  CHECK(difference([](Records& r) { r.objects[0].density = 1; }) == "source");
  CHECK(difference([](Records& r) { r.objects[1].friction = 1; }) == "target");
  CHECK(difference([](Records& r) { r.placements[2].position[0] = 0; }) == "pose of the source");
  CHECK(difference([](Records& r) {
          r.lights[0].ambient = 1;
          r.placements[3].position[1] = 0;
        }) == "light, pose of the target");
  store::ResultRow late = row_of(recorded, 0, 1);
  late.episode = 2;
  CHECK(match_start(recorded, 0, late, recorded).failure().message.find("has 2 episodes") !=
        std::string::npos);
}

TEST_CASE("a task is judged by its namesake, or by the variant that differs in the goal alone") {
  plan::Writer w = plan::small_writer();
  w.records.tasks[1].axes = static_cast<std::uint32_t>(plan::Axis::kGoal);
  const plan::Plan goal = opened(w);
  const std::uint32_t all[] = {0, 1}, second[] = {1};
  CHECK(**find_judge(goal, all, "carrot_on_plate") == 0);
  CHECK(**find_judge(goal, second, "carrot_on_plate") == 1);
  CHECK(!find_judge(goal, all, "spoon_on_towel")->has_value());
  const plan::Plan language = small();  // the variant says something else
  CHECK(!find_judge(language, second, "carrot_on_plate")->has_value());
}

TEST_CASE("an explanation names the deciding step and the numbers measured there") {
  const plan::Plan plan = small();
  const auto why = explain(plan, 0, made_trace(plan, 0));
  REQUIRE_MESSAGE(why.ok(), to_text(why.failure()));
  REQUIRE(why->size() == 3);
  const MetricWhy& near = (*why)[0];
  CHECK(near.name == "near");
  CHECK(near.step == 3);
  CHECK(near.when == "since step 3");
  REQUIRE(near.conditions.size() == 1);
  CHECK(near.conditions[0].measured == "4cm < 5cm");
  CHECK(near.conditions[0].truth);
  CHECK(near.conditions[0].decides);
  const MetricWhy& steady = (*why)[2];
  CHECK(steady.when == "at step 60, since step 14");
  REQUIRE(steady.conditions.size() == 2);
  CHECK(steady.conditions[0].measured == "0.05Ns <= 0.2Ns");
  CHECK(steady.conditions[1].measured == "5 of 5 steps");

  store::Trace far = made_trace(plan, 0);
  far.steps[2].sample.tcp.x() = 0.9;
  far.steps[40].sample.tcp.x() = 0.0501;
  const auto never = explain(plan, 0, far, "near");
  REQUIRE(never->size() == 1);
  CHECK((*never)[0].when == "never, nearest at step 41");
  CHECK(!(*never)[0].conditions[0].truth);
  CHECK(explain(plan, 0, far, "nearly").failure().code == Fault::kUsage);
}

TEST_CASE("a number stands at the line that declares its metric, and is neither true nor false") {
  plan::Writer w = plan::small_writer();
  const std::uint32_t text =
      w.source("mine.probe", "metrics m {\n  spread = final y; z = once x }\n");
  w.records.spans.push_back({4, 1, text, 14, 20});
  const plan::Plan plan = opened(w);
  const auto why = explain(plan, 0, made_trace(plan, 0), "spread");
  REQUIRE_MESSAGE(why.ok(), to_text(why.failure()));
  REQUIRE(why->front().conditions.size() == 1);
  const Condition& number = why->front().conditions[0];
  CHECK(number.is_number);
  CHECK(number.file == "mine.probe");
  CHECK(number.line == 2);
  CHECK(number.text == "spread = final y");
}

TEST_CASE("what was once so is told by when it was, not by what it is made of at the end") {
  using plan::make_instruction;
  plan::Writer w = plan::small_writer();
  plan::Records& r = w.records;
  r.spans.clear();
  r.constants = {0.05};
  r.states = {{static_cast<std::uint16_t>(plan::Op::kONCE), 0}};
  r.metrics = {{w.text("kept_away"), static_cast<std::uint32_t>(plan::MetricType::kBool), 1}};
  r.code = {make_instruction(plan::Op::kKR, 0, 0),       make_instruction(plan::Op::kTCP, 1),
            make_instruction(plan::Op::kVLEN, 2, 1),     make_instruction(plan::Op::kLT, 3, 2, 0),
            make_instruction(plan::Op::kONCE, 4, 3, 0),  make_instruction(plan::Op::kNOT, 5, 4),
            make_instruction(plan::Op::kEMITB, 6, 5, 0), make_instruction(plan::Op::kEND, 6)};
  r.programs[0].constants = r.programs[0].states = r.programs[0].metrics = {0, 1};
  r.programs[0].code = {0, static_cast<std::uint32_t>(r.code.size())};
  const plan::Plan plan = opened(w);
  const auto why = explain(plan, 0, made_trace(plan, 0));
  REQUIRE_MESSAGE(why.ok(), to_text(why.failure()));
  REQUIRE(why->size() == 1);
  CHECK((*why)[0].shown == "false");
  REQUIRE((*why)[0].conditions.size() == 1);
  CHECK((*why)[0].conditions[0].measured == "since step 3");
  CHECK((*why)[0].conditions[0].truth);
  CHECK((*why)[0].conditions[0].decides);
}

TEST_CASE("what must be held is nearer to true the longer it has been held") {
  const plan::Plan plan = small();
  const ProgramView view(plan, plan.tasks()[0]);
  std::uint16_t hold = 0;
  while (view.op(hold) != plan::Op::kHOLD) ++hold;
  vm::Judge judge(plan, 0);
  const store::Trace trace = made_trace(plan, 0);  // touched from step 10 on
  REQUIRE(judge.begin(trace.start->starts).ok());
  std::vector<int> held(view.registers());
  std::vector<std::uint32_t> distances;
  for (std::size_t step = 1; step <= 15; ++step) {
    REQUIRE(judge.step(trace.steps[step - 1].sample).ok());
    held[hold] = step < 10 ? 0 : static_cast<int>(step) - 9;
    distances.push_back(view.distances(judge, held)[hold]);
  }
  CHECK(distances == std::vector<std::uint32_t>{6, 6, 6, 6, 6, 6, 6, 6, 6, 4, 3, 2, 1, 0, 0});
}

TEST_CASE("numbers are written in people's units, with the digits that tell them apart") {
  CHECK(quantity(0.031, Dimension::kLength) == "3.1cm");
  CHECK(quantity(1.25, Dimension::kLength) == "1.25m");
  CHECK(quantity(0.004, Dimension::kImpulse) == "0.004Ns");
  CHECK(quantity(14, Dimension::kSteps) == "14");
  CHECK(angle_text(1.0471975511965976) == "60deg");
  CHECK(quantities(0.02, 0.0200001, Dimension::kLength) ==
        std::pair<std::string, std::string>("2cm", "2.00001cm"));
  CHECK(quantities(0.02, 0.02, Dimension::kLength).first == "2cm");
}

}  // namespace
}  // namespace probe::rejudge
