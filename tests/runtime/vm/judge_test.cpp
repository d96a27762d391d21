#include "runtime/vm/judge.h"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <set>

#include "tests/runtime/vm/random_judge.h"
#include "tests/runtime/vm/reference.h"

using namespace probe;
using namespace probe::plan;
using namespace probe::vm;

namespace {

constexpr std::size_t kSmallBodies = 6;  // of the small plan: no fixture with joints

Plan open_small() {
  auto plan = Plan::from_bytes(small_plan());
  REQUIRE(plan.ok());
  return std::move(plan).value();
}

StepSample resting(double step, std::size_t bodies = kSmallBodies) {
  StepSample s;
  s.bodies.resize(bodies);
  s.step = step;
  s.tcp = {1, 0, 0};
  return s;
}

}  // namespace

TEST_CASE(
    "an episode is over with the step at which what ends it holds, and not before the first") {
  Writer w = small_writer();
  w.records.metrics[0].readout = static_cast<std::uint32_t>(Readout::kEnds);
  auto bytes = w.finish();
  REQUIRE(bytes.ok());
  auto plan = Plan::from_bytes(std::move(*bytes));
  REQUIRE(plan.ok());
  CHECK(plan->ends_metric(plan->tasks()[0]) == 0);
  CHECK(!open_small().ends_metric(open_small().tasks()[0]));
  Judge judge(*plan, 0);
  CHECK(!judge.ended());
  REQUIRE(judge.begin(std::vector<BodyStart>(kBodies)).ok());
  StepSample far = resting(1), near = resting(2);
  near.tcp = Vec3::Zero();
  REQUIRE(judge.step(far).ok());
  CHECK(!judge.ended());
  REQUIRE(judge.step(near).ok());
  CHECK(judge.truth(0));
  CHECK(judge.ended());
  REQUIRE(judge.begin(std::vector<BodyStart>(kBodies)).ok());
  CHECK(!judge.ended());
}

TEST_CASE("the judge and the naive evaluator agree bit for bit on random programs and worlds") {
  std::set<std::uint8_t> ops_seen;
  std::size_t compared = 0;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    const Plan plan = RandomProgram(seed).make(20 + seed % 60);
    for (const Instruction& in : plan.code(plan.programs()[0])) ops_seen.insert(in.op);
    RandomWorld world(seed + 1000);
    Judge judge(plan, 1);
    for (int episode = 0; episode < 2; ++episode) {
      const auto starts = world.starts();
      std::vector<StepSample> history;
      REQUIRE(judge.begin(starts).ok());
      for (int step = 1; step <= 6; ++step) {
        history.push_back(world.step(step));
        REQUIRE(judge.step(history.back()).ok());
        const Reference reference(plan, plan.tasks()[1], starts, history);
        for (std::uint16_t m = 0; m < judge.metric_count(); ++m) {
          const double want = reference.metric(m, history.size() - 1);
          if (std::bit_cast<std::uint64_t>(judge.value(m)) != std::bit_cast<std::uint64_t>(want)) {
            FAIL("seed " << seed << " step " << step << " metric " << m << ": " << judge.value(m)
                         << " and " << want);
          }
          ++compared;
        }
      }
    }
  }
  CHECK(compared > 10000);
  CHECK(ops_seen.size() == all_ops().size());
}

TEST_CASE("the judge and the naive evaluator agree on a million pairs of a program and a world") {
  constexpr std::uint64_t kPrograms = 2000;
  constexpr int kWorlds = 500;
  std::size_t pairs = 0, values = 0, different = 0;
  for (std::uint64_t seed = 0; seed < kPrograms; ++seed) {
    const Plan plan = RandomProgram(seed + 5000).make(6 + seed % 20);
    const auto task = static_cast<std::uint32_t>(seed % 2);
    RandomWorld world(seed + 77);
    const auto starts = world.starts();
    Judge judge(plan, task);
    for (int w = 0; w < kWorlds; ++w) {
      const std::vector<StepSample> history = {world.step(1)};
      if (!judge.begin(starts).ok() || !judge.step(history[0]).ok()) ++different;
      const Reference reference(plan, plan.tasks()[task], starts, history);
      for (std::uint16_t m = 0; m < judge.metric_count(); ++m) {
        const double want = reference.metric(m, 0);
        ++values;
        different +=
            std::bit_cast<std::uint64_t>(judge.value(m)) != std::bit_cast<std::uint64_t>(want);
      }
      ++pairs;
    }
  }
  MESSAGE(pairs << " pairs, " << values << " values, " << different << " different");
  CHECK(pairs == 1'000'000);
  CHECK(different == 0);
}

TEST_CASE("a metric keeps the value last emitted, and monitors start again with each episode") {
  const Plan plan = open_small();
  Judge judge(plan, 0);
  REQUIRE(judge.find_metric("near") == 0);
  CHECK(!judge.find_metric("far"));
  const std::vector<BodyStart> starts(kSmallBodies);
  REQUIRE(judge.begin(starts).ok());
  CHECK(!judge.truth(0));
  StepSample near = resting(1);
  near.tcp = {0.04, 0, 0};
  REQUIRE(judge.step(near).ok());
  CHECK(judge.truth(0));
  REQUIRE(judge.step(resting(2)).ok());
  CHECK(judge.truth(0));  // once
  CHECK(judge.register_value(3).x() == 1.0);
  REQUIRE(judge.begin(starts).ok());
  REQUIRE(judge.step(resting(1)).ok());
  CHECK(!judge.truth(0));
}

TEST_CASE("a judge restored in mid-episode says what the one that went on says, bit for bit") {
  std::size_t compared = 0;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    const Plan plan = RandomProgram(seed + 9000).make(20 + seed % 60);
    RandomWorld world(seed + 10);
    const auto starts = world.starts();
    Judge judge(plan, 1), other(plan, 1);
    REQUIRE(judge.begin(starts).ok());
    for (int step = 1; step <= 4; ++step) REQUIRE(judge.step(world.step(step)).ok());
    const JudgeState saved = judge.save();
    REQUIRE(other.begin(world.starts()).ok());  // another episode leaves no trace
    REQUIRE(other.step(world.step(1)).ok());
    REQUIRE(other.restore(starts, saved).ok());
    for (int step = 4; step <= 8; ++step) {
      if (step > 4) {
        const StepSample sample = world.step(step);
        REQUIRE(judge.step(sample).ok());
        REQUIRE(other.step(sample).ok());
      }
      for (std::uint32_t m = 0; m < judge.metric_count(); ++m, ++compared) {
        CHECK(std::bit_cast<std::uint64_t>(judge.value(m)) ==
              std::bit_cast<std::uint64_t>(other.value(m)));
      }
    }
  }
  CHECK(compared > 1000);
}

TEST_CASE("what is decided stays so, whatever is measured then, and a restored judge knows it") {
  std::size_t decided = 0, open = 0, early = 0;
  for (std::uint64_t seed = 0; seed < 3000; ++seed) {
    const Plan plan = RandomProgram(seed + 500).make(2 + seed % 8);
    RandomWorld world(seed + 77);
    Judge judge(plan, 1), other(plan, 1);
    const auto starts = world.starts();
    REQUIRE(judge.begin(starts).ok());
    CHECK(!judge.decided());
    std::optional<std::vector<double>> then;
    for (int step = 1; step <= 12; ++step) {
      REQUIRE(judge.step(world.step(step)).ok());
      if (then) CHECK(std::ranges::equal(judge.values(), *then));
      if (!judge.decided()) {
        CHECK(!then);
        ++open;
        continue;
      }
      REQUIRE(other.restore(starts, judge.save()).ok());
      CHECK(other.decided());
      early += step > 1 && !then && judge.metric_count() > 0 ? 1 : 0;
      then.emplace(judge.values().begin(), judge.values().end());
      decided += judge.metric_count() > 0 ? 1 : 0;
    }
    REQUIRE(judge.begin(starts).ok());
    CHECK(!judge.decided());
  }
  MESSAGE(decided, " decided, ", open, " open, ", early, " after the first step");
  CHECK(decided > 100);
  CHECK(open > 100);
  CHECK(early > 0);
}

TEST_CASE("a `once` is decided when it was true, an `always` when it was broken, a count never") {
  // One metric: `op` over "the tool is within 5 cm of the origin", of 5 steps where it takes any.
  const auto decided_at = [](Op op) {
    Writer w = small_writer();
    Records& r = w.records;
    r.spans.clear();
    r.constants = {0.05};
    const bool counts = op == Op::kCOUNT || op == Op::kFIRST || op == Op::kRISES;
    r.states = {{static_cast<std::uint16_t>(op), std::uint16_t(op == Op::kHOLD ? 5 : 0)}};
    r.metrics = {{w.text("m"),
                  static_cast<std::uint32_t>(counts ? MetricType::kReal : MetricType::kBool), 1}};
    r.code = {make_instruction(Op::kKR, 0, 0),
              make_instruction(Op::kTCP, 1),
              make_instruction(Op::kVLEN, 2, 1),
              make_instruction(Op::kLT, 3, 2, 0),
              make_instruction(op, 4, 3, 0),
              make_instruction(counts ? Op::kEMITR : Op::kEMITB, 5, 4, 0),
              make_instruction(Op::kEND, 5)};
    r.programs[0].constants = r.programs[0].states = r.programs[0].metrics = {0, 1};
    r.programs[0].code = {0, static_cast<std::uint32_t>(r.code.size())};
    auto bytes = w.finish();
    REQUIRE_MESSAGE(bytes.ok(), to_text(bytes.failure()));
    const Plan plan = Plan::from_bytes(std::move(*bytes)).value();
    Judge judge(plan, 0);
    REQUIRE(judge.begin(std::vector<BodyStart>(kSmallBodies)).ok());
    for (int step = 1; step <= 12; ++step) {
      StepSample sample = resting(step);
      sample.tcp = {step == 3 || step > 5 ? 0.01 : 1.0, 0, 0};
      REQUIRE(judge.step(sample).ok());
      if (judge.decided()) return step;
    }
    return 0;
  };
  CHECK(decided_at(Op::kONCE) == 3);
  CHECK(decided_at(Op::kALWAYS) == 1);
  CHECK(decided_at(Op::kFIRST) == 3);
  CHECK(decided_at(Op::kHOLD) == 0);
  CHECK(decided_at(Op::kCOUNT) == 0);
  CHECK(decided_at(Op::kRISES) == 0);
}

TEST_CASE("how often a condition began, and a number as it was when it last held") {
  // "The tool is within 5 cm of the origin", and how far it was then.
  Writer w = small_writer();
  Records& r = w.records;
  r.spans.clear();
  r.constants = {0.05};
  r.states = {{static_cast<std::uint16_t>(Op::kRISES), 0},
              {static_cast<std::uint16_t>(Op::kKEPT), 0}};
  const auto real = static_cast<std::uint32_t>(MetricType::kReal);
  r.metrics = {{w.text("times"), real, 10}, {w.text("then"), real, 6}};
  r.code = {make_instruction(Op::kKR, 0, 0),       make_instruction(Op::kTCP, 1),
            make_instruction(Op::kVLEN, 2, 1),     make_instruction(Op::kLT, 3, 2, 0),
            make_instruction(Op::kRISES, 4, 3, 0), make_instruction(Op::kEMITR, 5, 4, 0),
            make_instruction(Op::kGATED, 5, 2, 3), make_instruction(Op::kKEPT, 6, 5, 1),
            make_instruction(Op::kEMITR, 7, 6, 1), make_instruction(Op::kEND, 7)};
  r.programs[0].constants = {0, 1};
  r.programs[0].states = r.programs[0].metrics = {0, 2};
  r.programs[0].code = {0, static_cast<std::uint32_t>(r.code.size())};
  auto bytes = w.finish();
  REQUIRE_MESSAGE(bytes.ok(), to_text(bytes.failure()));
  const Plan plan = Plan::from_bytes(std::move(*bytes)).value();
  Judge judge(plan, 0);
  const std::vector<BodyStart> starts(kSmallBodies);
  REQUIRE(judge.begin(starts).ok());
  const std::vector<double> far = {0.3, 0.01, 0.02, 0.5, 0.6, 0.04, 0.2};
  const std::vector<double> times = {0, 1, 1, 1, 1, 2, 2};
  const std::vector<double> then = {0.3, 0.01, 0.02, 0.02, 0.02, 0.04, 0.04};
  for (std::size_t i = 0; i < far.size(); ++i) {
    CAPTURE(i);
    // Kept and put back between any two steps, it goes on as it would have.
    const JudgeState state = judge.save();
    REQUIRE(judge.begin(starts).ok());
    REQUIRE(judge.restore(starts, state).ok());
    StepSample sample = resting(static_cast<int>(i) + 1);
    sample.tcp = {far[i], 0, 0};
    REQUIRE(judge.step(sample).ok());
    CHECK(judge.value(0) == times[i]);
    CHECK(judge.value(1) == then[i]);
  }
}

TEST_CASE("the state of a judge of other metrics is refused, and no step may follow") {
  const Plan plan = open_small();
  Judge judge(plan, 0);
  const std::vector<BodyStart> starts(kSmallBodies);
  REQUIRE(judge.begin(starts).ok());
  JudgeState state = judge.save();
  state.values.pop_back();
  const Status refused = judge.restore(starts, state);
  REQUIRE(!refused.ok());
  CHECK(refused.failure().code == Fault::kJudge);
  CHECK(refused.failure().message == "the saved state is of a task with other metrics");
  CHECK(!judge.step(resting(1)).ok());
}

TEST_CASE("a condition that must hold for five steps is true at the fifth and breaks at once") {
  const Plan plan = open_small();
  Judge judge(plan, 0);
  REQUIRE(judge.begin(std::vector<BodyStart>(kSmallBodies)).ok());
  StepSample touching = resting(1);
  touching.contacts = {{0, 3, Vec3(0, 0.2, 0)}};
  for (int i = 1; i <= 6; ++i) {
    REQUIRE(judge.step(touching).ok());
    CHECK(judge.truth(2) == (i >= 5));
  }
  REQUIRE(judge.step(resting(7)).ok());
  CHECK(!judge.truth(2));
}

TEST_CASE("a measurement that is not finite makes the episode invalid and changes no value") {
  const Plan plan = open_small();
  Judge judge(plan, 0);
  std::vector<BodyStart> starts(kSmallBodies);
  REQUIRE(judge.begin(starts).ok());
  StepSample near = resting(1);
  near.tcp = {0.04, 0, 0};
  REQUIRE(judge.step(near).ok());
  const auto broken = [&](auto&& change) {
    StepSample s = resting(2);
    s.contacts = {{0, 3, Vec3(0, 0.2, 0)}};
    change(s);
    const Status status = judge.step(s);
    CHECK(judge.truth(0));
    return !status.ok() && status.failure().code == Fault::kJudge &&
           status.failure().where == "carrot_on_plate";
  };
  const double nan = std::nan("");
  CHECK(broken([&](StepSample& s) { s.bodies[5].position.x() = nan; }));
  CHECK(broken([&](StepSample& s) { s.bodies[1].spin.z() = -INFINITY; }));
  CHECK(broken([&](StepSample& s) { s.bodies[2].rotation.w() = nan; }));
  CHECK(broken([&](StepSample& s) { s.contacts[0].push.y() = nan; }));
  CHECK(broken([&](StepSample& s) { s.tcp.y() = nan; }));
  CHECK(broken([&](StepSample& s) { s.grip = nan; }));
  CHECK(broken([&](StepSample& s) { s.joints = {{0.5, 0}, {nan, 0}}; }));
  CHECK(broken([&](StepSample& s) { s.joints = {{0.5, INFINITY}}; }));
  CHECK(broken([&](StepSample& s) { s.time = INFINITY; }));
  CHECK(broken([&](StepSample& s) { s.bodies.pop_back(); }));
  CHECK(broken([&](StepSample& s) { s.contacts.push_back(s.contacts[0]); }));
  CHECK(broken([&](StepSample& s) { s.contacts[0].b = 6; }));
  CHECK(broken([&](StepSample& s) { s.contacts[0].a = 3; }));
  CHECK(!broken([](StepSample&) {}));
  CHECK(!broken([](StepSample& s) { s.joints = {{0.5, 0}}; }));

  starts[1].half.x() = nan;
  CHECK(!judge.begin(starts).ok());
  CHECK(!judge.step(resting(1)).ok());  // not begun
  CHECK(!judge.begin(std::vector<BodyStart>(3)).ok());
}

TEST_CASE("bodies after the plan's are measured and not judged") {
  const Plan plan = RandomProgram(3).make(40);
  Judge judge(plan, 0), other(plan, 0);
  std::vector<BodyStart> starts(kBodies);
  REQUIRE(judge.begin(starts).ok());
  starts.resize(kBodies + 2);
  REQUIRE(other.begin(starts).ok());
  StepSample sample = resting(1, kBodies);
  sample.joints.resize(16);
  sample.contacts.clear();
  REQUIRE(judge.step(sample).ok());
  sample.bodies.resize(kBodies + 2);
  sample.bodies.back().position = {1, 2, 3};
  sample.contacts = {{0, kBodies + 1, {0, 0, 1}}};
  REQUIRE(other.step(sample).ok());
  CHECK(std::ranges::equal(judge.values(), other.values()));
  sample.contacts[0].b = kBodies + 2;
  CHECK(!other.step(sample).ok());
  sample.contacts.clear();
  sample.bodies.back().position.x() = std::nan("");
  CHECK(!other.step(sample).ok());
}

TEST_CASE("a step of a hundred instructions costs microseconds at most") {
  const Plan plan = RandomProgram(5).make(100);
  Judge judge(plan, 0);
  RandomWorld world(9);
  REQUIRE(judge.begin(world.starts()).ok());
  const StepSample sample = world.step(1);
  constexpr int kSteps = 20000;
  const auto from = std::chrono::steady_clock::now();
  for (int i = 0; i < kSteps; ++i) REQUIRE(judge.step(sample).ok());
  const std::chrono::duration<double, std::micro> took = std::chrono::steady_clock::now() - from;
  const double us = took.count() / kSteps;
  MESSAGE(us << " us a step");
  CHECK(us < 50);  // far above the budget of 2 us: this machine may be busy
}
