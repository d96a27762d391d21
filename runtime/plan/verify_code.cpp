// Stage 3, the programs: straight-line code over typed single-assignment registers, one pass each,
// so no fixpoint.
#include <fmt/format.h>

#include <array>
#include <string_view>
#include <tuple>
#include <vector>

#include "runtime/base/check.h"
#include "runtime/plan/fixtures.h"
#include "runtime/plan/isa.h"
#include "runtime/plan/verify.h"
#include "runtime/plan/verify_place.h"

namespace probe::plan {
namespace {

std::string_view type_name(Kind kind) {
  switch (kind) {
    case Kind::kBool:
      return "a truth";
    case Kind::kReal:
      return "a number";
    case Kind::kVector:
      return "a vector";
    case Kind::kUnused:
    case Kind::kConstant:
    case Kind::kThreeConstants:
    case Kind::kImmediate:
    case Kind::kBody:
    case Kind::kFinger:
    case Kind::kState:
    case Kind::kTimedState:
    case Kind::kMetric:
    case Kind::kJoint:
      break;
  }
  return "nothing";
}

struct FingerUse {
  const OpInfo* op;
  const std::uint16_t* operand;
};

// What a program asks of the tasks that run it.
struct Needs {
  const Instruction* highest = nullptr;    // the one that names the body of highest index
  std::uint32_t bodies = 0;                // 1 + that index
  std::vector<FingerUse> fingers;          // one for every body that must be a finger
  std::vector<const Instruction*> joints;  // those that name one
};

class ProgramCheck {
 public:
  ProgramCheck(const Place& place, const Tables& tables, const ProgramRecord& program)
      : place_(place), t_(tables), program_(program) {
    types_.reserve(program.code.count);
    states_used_.resize(program.states.count);
    metrics_emitted_.resize(program.metrics.count);
    finger_seen_.resize(kMaxBodies);
  }

  Status run(Needs& needs) {
    const auto code = slice_of(t_.code, program_.code);
    if (code.empty())
      return place_.fail(Rule::kNoCode, &program_, "a program has at least its END");
    if (code.size() > kMaxInstructions) {
      return place_.fail(Rule::kCodeLength, &program_,
                         fmt::format("a program has at most {} instructions, not {}",
                                     kMaxInstructions, code.size()));
    }
    for (const Instruction& in : code) PROBE_TRY(instruction(in, &in == &code.back(), needs));
    for (std::size_t i = 0; i < states_used_.size(); ++i) {
      if (!states_used_[i]) {
        return place_.fail(Rule::kStateUnused, &slice_of(t_.states, program_.states)[i],
                           "a state slot belongs to one monitor");
      }
    }
    for (std::size_t i = 0; i < metrics_emitted_.size(); ++i) {
      if (!metrics_emitted_[i]) {
        return place_.fail(Rule::kMetricMissing, &slice_of(t_.metrics, program_.metrics)[i],
                           "a metric is emitted exactly once");
      }
    }
    return {};
  }

 private:
  Status instruction(const Instruction& in, bool last, Needs& needs) {
    const OpInfo* info = find_op(in.op);
    if (info == nullptr)
      return place_.fail(Rule::kOperation, &in.op,
                         fmt::format("operation {:#04x} is not known", in.op));
    if (in.zero != 0)
      return place_.fail(Rule::kInstructionZero, &in.zero,
                         "the second byte of an instruction is zero");
    if (in.dst != types_.size()) {
      return place_.fail(Rule::kDestination, &in.dst,
                         fmt::format("{} must say {} results before it, not {}", info->name,
                                     types_.size(), in.dst));
    }
    if ((info->op == Op::kEND) != last) {
      return place_.fail(
          Rule::kEnd, &in.op,
          last ? "a program ends with END" : "END is the last instruction and only there");
    }
    PROBE_TRY(operand(*info, info->a, in, in.a, needs));
    PROBE_TRY(operand(*info, info->b, in, in.b, needs));
    if (info->result != Kind::kUnused) types_.push_back(info->result);
    return {};
  }

  Status operand(const OpInfo& info, Kind kind, const Instruction& in, const std::uint16_t& value,
                 Needs& needs) {
    switch (kind) {
      case Kind::kUnused:
        if (value != 0)
          return place_.fail(Rule::kUnusedOperand, &value,
                             fmt::format("an unused operand of {} is zero", info.name));
        return {};
      case Kind::kBool:
      case Kind::kReal:
      case Kind::kVector:
        return use_register(info, kind, value);
      case Kind::kConstant:
        return use_constants(info, value, 1);
      case Kind::kThreeConstants:
        return use_constants(info, value, 3);
      case Kind::kImmediate:
        if (value > info.limit) {
          return place_.fail(
              Rule::kImmediate, &value,
              fmt::format("{} takes at most {}, not {}", info.name, info.limit, value));
        }
        return {};
      case Kind::kBody:
        return use_body(info, in, value, needs);
      case Kind::kFinger:
        PROBE_TRY(use_body(info, in, value, needs));
        if (!finger_seen_[value]) needs.fingers.push_back({&info, &value});
        finger_seen_[value] = true;
        return {};
      case Kind::kState:
      case Kind::kTimedState:
        return use_state(info, in, value);
      case Kind::kMetric:
        return emit(info, value);
      case Kind::kJoint:
        needs.joints.push_back(&in);
        return {};
    }
    PROBE_CHECK(false, "every kind of operand has a rule");
    return {};
  }

  Status use_register(const OpInfo& info, Kind kind, const std::uint16_t& value) {
    if (value >= types_.size()) {
      return place_.fail(Rule::kReadBeforeWrite, &value,
                         fmt::format("{} reads r{} before it is written", info.name, value));
    }
    if (types_[value] != kind) {
      return place_.fail(Rule::kOperandType, &value,
                         fmt::format("{} wants {} but r{} is {}", info.name, type_name(kind), value,
                                     type_name(types_[value])));
    }
    return {};
  }

  Status use_constants(const OpInfo& info, const std::uint16_t& value, std::uint32_t width) {
    if (value + width <= program_.constants.count) return {};
    return place_.fail(Rule::kConstantRange, &value,
                       fmt::format("{} reads constant {} of {}", info.name, value + width - 1,
                                   program_.constants.count));
  }

  Status use_body(const OpInfo& info, const Instruction& in, const std::uint16_t& value,
                  Needs& needs) {
    if (value >= kMaxBodies) {
      return place_.fail(
          Rule::kBodyLimit, &value,
          fmt::format("{} names body {}, a task has at most {}", info.name, value, kMaxBodies));
    }
    if (value + 1u > needs.bodies) {
      needs.bodies = value + 1u;
      needs.highest = &in;
    }
    return {};
  }

  Status use_state(const OpInfo& info, const Instruction& in, const std::uint16_t& value) {
    if (value >= program_.states.count) {
      return place_.fail(
          Rule::kStateRange, &value,
          fmt::format("{} uses state {} of {}", info.name, value, program_.states.count));
    }
    if (states_used_[value])
      return place_.fail(Rule::kStateTwice, &value,
                         "a state slot belongs to one monitor, not to two");
    states_used_[value] = true;
    if (slice_of(t_.states, program_.states)[value].kind != in.op) {
      return place_.fail(Rule::kStateMismatch, &value,
                         fmt::format("state {} is not of kind {}", value, info.name));
    }
    return {};
  }

  Status emit(const OpInfo& info, const std::uint16_t& value) {
    if (value >= program_.metrics.count) {
      return place_.fail(
          Rule::kMetricRange, &value,
          fmt::format("{} names metric {} of {}", info.name, value, program_.metrics.count));
    }
    if (metrics_emitted_[value])
      return place_.fail(Rule::kMetricTwice, &value, "a metric is emitted exactly once, not twice");
    metrics_emitted_[value] = true;
    const auto type = static_cast<MetricType>(slice_of(t_.metrics, program_.metrics)[value].type);
    if ((type == MetricType::kBool) != (info.a == Kind::kBool)) {
      return place_.fail(Rule::kMetricMismatch, &value,
                         fmt::format("{} does not have the type of metric {}", info.name, value));
    }
    return {};
  }

  const Place& place_;
  const Tables& t_;
  const ProgramRecord& program_;
  std::vector<Kind> types_;  // of the registers written so far
  std::vector<bool> states_used_, metrics_emitted_, finger_seen_;
};

Status check_task(const Place& place, const Tables& t, const TaskRecord& task, const Needs& needs) {
  if (needs.bodies > task.bodies.count) {
    return place.fail(Rule::kTaskBody, needs.highest,
                      fmt::format("names body {}, but task `{}` has {}", needs.bodies - 1,
                                  t.text(task.name), task.bodies.count));
  }
  const std::size_t fingers = finger_count(t.robots[t.scenes[task.scene].robot]);
  for (const auto& [op, operand] : needs.fingers) {
    const BodyRecord& body = slice_of(t.bodies, task.bodies)[*operand];
    if (body.kind != static_cast<std::uint32_t>(BodyKind::kLink) || body.index >= fingers) {
      return place.fail(Rule::kFinger, operand,
                        fmt::format("{} names body {}, which is no finger of task `{}`", op->name,
                                    *operand, t.text(task.name)));
    }
  }
  if (needs.joints.empty()) return {};
  const auto joints = joints_of(t, t.scenes[task.scene]);
  for (const Instruction* in : needs.joints) {
    const OpInfo& info = *find_op(in->op);
    if (in->a >= joints.size()) {
      return place.fail(Rule::kTaskJoint, &in->a,
                        fmt::format("names joint {}, but the fixtures of task `{}` have {}", in->a,
                                    t.text(task.name), joints.size()));
    }
    const bool wants_slide = info.op == Op::kSLIDE || info.op == Op::kSLIDING;
    if (wants_slide == slides(*joints[in->a])) continue;
    return place.fail(Rule::kTaskJoint, &in->a,
                      fmt::format("{} names joint `{}` of task `{}`, which {}", info.name,
                                  t.text(joints[in->a]->joint), t.text(task.name),
                                  wants_slide ? "turns" : "slides"));
  }
  return {};
}

}  // namespace

Status verify_code(std::span<const std::byte> bytes, const Tables& tables) {
  const Place place(bytes);
  std::vector<Needs> needs(tables.programs.size());
  for (std::size_t i = 0; i < needs.size(); ++i) {
    PROBE_TRY(ProgramCheck(place, tables, tables.programs[i]).run(needs[i]));
  }
  for (const TaskRecord& task : tables.tasks) {
    PROBE_TRY(check_task(place, tables, task, needs[task.program]));
  }
  for (const ClaimRecord& claim : tables.claims) {
    PROBE_TRY(check_task(place, tables, tables.tasks[claim.task], needs[claim.program]));
  }
  for (const LaterRecord& later : tables.later) {
    PROBE_TRY(check_task(place, tables, tables.tasks[later.task], needs[later.program]));
  }
  for (const QuestionRecord& question : tables.questions) {
    if (question.program == kNone) continue;
    PROBE_TRY(check_task(place, tables, tables.tasks[question.task], needs[question.program]));
  }
  return {};
}

}  // namespace probe::plan
