// Random well-typed programs and random measurements, to hold the judge to its naive reference.
#pragma once

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "runtime/plan/isa.h"
#include "runtime/plan/plan.h"
#include "runtime/vm/sample.h"
#include "tests/runtime/plan/fixture_plan.h"

namespace probe::vm {

using plan::all_ops;
using plan::fixture_writer;
using plan::Kind;
using plan::kMaxMetrics;
using plan::make_instruction;
using plan::MetricType;
using plan::Op;
using plan::OpInfo;
using plan::Plan;
using plan::Records;
using plan::Writer;

inline constexpr std::uint32_t kBodies =
    8;  // of the plan's tasks: carrot, plate, surface, two fingers, wrist, two parts

// A random well-typed program over the small plan: every operation of isa.def can occur.
class RandomProgram {
 public:
  explicit RandomProgram(std::uint64_t seed) : draw_(seed) {}

  Plan make(std::size_t instructions) {
    Writer w = fixture_writer();
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
    // The carrot of every other second task goes to and fro.
    if (pick(2) == 0) {
      r.moves.push_back({0, 0, {0.1, 0}, 0.05});
      r.tasks[1].moves = {0, 1};
    }
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
        case Kind::kThreeConstants:
          value = pick(5);
          break;
        case Kind::kImmediate:
          value = pick(op.limit + 1u);
          break;
        case Kind::kBody:
          value = pick(kBodies);
          break;
        case Kind::kJoint:  // the first slides, the second turns
          value = op.op == Op::kSLIDE || op.op == Op::kSLIDING ? 0 : 1;
          break;
        case Kind::kFinger:
          value = 3 + pick(2);
          break;
        case Kind::kState:
        case Kind::kTimedState: {
          // Monitors of monitors cost the reference a power of the steps each.
          if (depth_[operands[0]] > 3) return;
          value = static_cast<std::uint32_t>(r.states.size());
          const auto n = static_cast<std::uint16_t>(op.b == Kind::kTimedState ? 1 + pick(4) : 0);
          r.states.push_back({static_cast<std::uint16_t>(op.op), n});
          depth += 2;
          break;
        }
        case Kind::kUnused:
        case Kind::kMetric:
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
  explicit RandomWorld(std::uint64_t seed, std::uint32_t bodies = kBodies, double scale = 1)
      : draw_(seed), bodies_(bodies), scale_(scale) {}

  std::vector<BodyStart> starts() {
    std::vector<BodyStart> out(bodies_);
    for (BodyStart& b : out) b = {vector(), vector(), vector().normalized()};
    return out;
  }

  StepSample step(double number) {
    StepSample s;
    for (std::uint32_t i = 0; i < bodies_; ++i) {
      s.bodies.push_back({vector(), vector(), vector(), vector(), rotation()});
    }
    for (std::uint16_t a = 0; a < bodies_; ++a) {
      for (auto b = static_cast<std::uint16_t>(a + 1); b < bodies_; ++b) {
        if (draw_() % 3 == 0) s.contacts.push_back({a, b, vector()});
      }
    }
    std::uniform_real_distribution<double> joint(-2, 2);
    for (int i = 0; i < kJoints; ++i) s.joints.push_back({joint(joints_), joint(joints_)});
    // Said of what does not move, too: nobody asks for it then.
    const double x = joint(joints_), y = joint(joints_);
    s.own = {{0, {x, y, joint(joints_)}}};
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
    return {scale_ * x, scale_ * y, scale_ * z};
  }
  Quat rotation() {
    const Quat q(number_() + 2, number_(), number_(), number_());
    return q.normalized();
  }

  static constexpr int kJoints = 16;  // as many as any plan of the tests has

  std::mt19937_64 draw_;
  std::mt19937_64 joints_{7};  // of their own: what else is drawn is older than they are
  std::uint32_t bodies_;
  double scale_;
};

}  // namespace probe::vm
