#include "runtime/vm/judge.h"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <limits>
#include <random>
#include <set>

#include "tests/runtime/plan/small_plan.h"
#include "tests/runtime/vm/reference.h"

using namespace probe;
using namespace probe::plan;
using namespace probe::vm;

namespace {

constexpr std::uint32_t kBodies =
    6;  // of the small plan's tasks: carrot, plate, surface, two fingers, wrist

// A random well-typed program over the small plan: every operation of isa.def can occur.
class RandomProgram {
 public:
  explicit RandomProgram(std::uint64_t seed) : draw_(seed) {}

  Plan make(std::size_t instructions) {
    Writer w = small_writer();
    Records& r = w.records;
    r.spans.clear();
    r.code.clear();
    r.states.clear();
    r.metrics.clear();
    r.constants = {0.0, -0.0, 1.0, 0.05, -2.5, 1e-6, 3.0};
    const OpInfo* const ops = all_ops().data();
    while (r.code.size() < instructions) {
      const OpInfo& op = ops[pick(all_ops().size())];
      if (op.op == Op::kEND || op.b == Kind::kMetric) continue;
      add(r, op);
    }
    // Half of the results become metrics, as far as they are truths or numbers.
    for (std::uint32_t i = 0; i < types_.size() && r.metrics.size() < kMaxMetrics; ++i) {
      if (types_[i] == Kind::kVector || pick(2) == 0) continue;
      const bool is_truth = types_[i] == Kind::kBool;
      const auto metric = static_cast<std::uint32_t>(r.metrics.size());
      const auto type =
          static_cast<std::uint32_t>(is_truth ? MetricType::kBool : MetricType::kReal);
      r.metrics.push_back({w.text(fmt::format("m{}", metric)), type, 1});
      r.code.push_back(make_instruction(is_truth ? Op::kEMITB : Op::kEMITR, count(), i, metric));
    }
    r.code.push_back(make_instruction(Op::kEND, count()));
    r.programs[0].constants = {0, static_cast<std::uint32_t>(r.constants.size())};
    r.programs[0].states = {0, static_cast<std::uint32_t>(r.states.size())};
    r.programs[0].code = {0, static_cast<std::uint32_t>(r.code.size())};
    r.programs[0].metrics = {0, static_cast<std::uint32_t>(r.metrics.size())};
    auto bytes = w.finish();
    REQUIRE_MESSAGE(bytes.ok(), to_text(bytes.failure()));
    auto plan = Plan::from_bytes(std::move(*bytes));
    REQUIRE(plan.ok());
    return std::move(plan).value();
  }

 private:
  std::uint32_t pick(std::size_t n) { return static_cast<std::uint32_t>(draw_() % n); }
  std::uint32_t count() const { return static_cast<std::uint32_t>(types_.size()); }

  // A register of that type, a late one by preference so that expressions get deep; none ->
  // count().
  std::uint32_t find(Kind type) {
    std::vector<std::uint32_t> fitting;
    for (std::uint32_t i = 0; i < types_.size(); ++i) {
      if (types_[i] == type && depth_[i] < 6) fitting.push_back(i);
    }
    return fitting.empty() ? count() : fitting[pick(fitting.size())];
  }

  void add(Records& r, const OpInfo& op) {
    std::uint32_t operands[2] = {0, 0};
    int depth = 0;
    for (int i = 0; i < 2; ++i) {
      std::uint32_t& value = operands[i];
      switch (i == 0 ? op.a : op.b) {
        case Kind::kBool:
        case Kind::kReal:
        case Kind::kVector:
          value = find(i == 0 ? op.a : op.b);
          if (value == count()) return;
          depth = std::max(depth, depth_[value] + 1);
          break;
        case Kind::kConstant:
          value = pick(5);
          break;
        case Kind::kImmediate:
          value = pick(op.op == Op::kAXIS ? 3 : 2);
          break;
        case Kind::kBody:
          value = op.op == Op::kOPEN ? 3 + pick(2) : pick(kBodies);
          break;
        case Kind::kState: {
          // Monitors of monitors cost the reference a power of the steps each.
          if (depth_[operands[0]] > 3) return;
          value = static_cast<std::uint32_t>(r.states.size());
          const auto n = static_cast<std::uint16_t>(op.op == Op::kHOLD ? 1 + pick(4) : 0);
          r.states.push_back({static_cast<std::uint16_t>(op.op), n});
          depth += 2;
          break;
        }
        default:
          break;
      }
    }
    r.code.push_back(make_instruction(op.op, count(), operands[0], operands[1]));
    types_.push_back(op.result);
    depth_.push_back(depth);
  }

  std::mt19937_64 draw_;
  std::vector<Kind> types_;
  std::vector<int> depth_;
};

class RandomWorld {
 public:
  explicit RandomWorld(std::uint64_t seed) : draw_(seed) {}

  std::vector<BodyStart> starts() {
    std::vector<BodyStart> out(kBodies);
    for (BodyStart& b : out) b = {vector(), vector(), vector().normalized()};
    return out;
  }

  StepSample step(double number) {
    StepSample s;
    for (std::uint32_t i = 0; i < kBodies; ++i) {
      s.bodies.push_back({vector(), vector(), vector(), vector(), rotation()});
    }
    for (std::uint16_t a = 0; a < kBodies; ++a) {
      for (auto b = static_cast<std::uint16_t>(a + 1); b < kBodies; ++b) {
        if (draw_() % 3 == 0) s.contacts.push_back({a, b, vector()});
      }
    }
    s.tcp = vector();
    s.grip = number_();
    s.step = number;
    s.time = number / 5;
    return s;
  }

 private:
  // Coarse numbers too, so that equalities and zeros of both signs occur.
  double number_() {
    const double fine = std::uniform_real_distribution<double>(-1, 1)(draw_);
    return draw_() % 3 == 0 ? std::round(fine * 2) / 2 : fine;
  }
  Vec3 vector() {
    const double x = number_(), y = number_(), z = number_();
    return {x, y, z};
  }
  Quat rotation() {
    const Quat q(number_() + 2, number_(), number_(), number_());
    return q.normalized();
  }

  std::mt19937_64 draw_;
};

Plan open_small() {
  auto plan = Plan::from_bytes(small_plan());
  REQUIRE(plan.ok());
  return std::move(plan).value();
}

StepSample resting(double step) {
  StepSample s;
  s.bodies.resize(kBodies);
  s.step = step;
  s.tcp = {1, 0, 0};
  return s;
}

}  // namespace

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

TEST_CASE("a metric keeps the value last emitted, and monitors start again with each episode") {
  const Plan plan = open_small();
  Judge judge(plan, 0);
  REQUIRE(judge.find_metric("near") == 0);
  CHECK(!judge.find_metric("far"));
  const std::vector<BodyStart> starts(kBodies);
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

TEST_CASE("a condition that must hold for five steps is true at the fifth and breaks at once") {
  const Plan plan = open_small();
  Judge judge(plan, 0);
  REQUIRE(judge.begin(std::vector<BodyStart>(kBodies)).ok());
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
  std::vector<BodyStart> starts(kBodies);
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
    return !status.ok() && status.failure().code == "judge" &&
           status.failure().where == "carrot_on_plate";
  };
  const double nan = std::nan("");
  CHECK(broken([&](StepSample& s) { s.bodies[5].position.x() = nan; }));
  CHECK(broken([&](StepSample& s) { s.bodies[1].spin.z() = -INFINITY; }));
  CHECK(broken([&](StepSample& s) { s.bodies[2].rotation.w() = nan; }));
  CHECK(broken([&](StepSample& s) { s.contacts[0].push.y() = nan; }));
  CHECK(broken([&](StepSample& s) { s.tcp.y() = nan; }));
  CHECK(broken([&](StepSample& s) { s.grip = nan; }));
  CHECK(broken([&](StepSample& s) { s.time = INFINITY; }));
  CHECK(broken([&](StepSample& s) { s.bodies.pop_back(); }));
  CHECK(broken([&](StepSample& s) { s.contacts.push_back(s.contacts[0]); }));
  CHECK(broken([&](StepSample& s) { s.contacts[0].b = 6; }));
  CHECK(broken([&](StepSample& s) { s.contacts[0].a = 3; }));
  CHECK(!broken([](StepSample&) {}));

  starts[1].half.x() = nan;
  CHECK(!judge.begin(starts).ok());
  CHECK(!judge.step(resting(1)).ok());  // not begun
  CHECK(!judge.begin(std::vector<BodyStart>(3)).ok());
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
