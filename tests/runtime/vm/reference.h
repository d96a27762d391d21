// The judge once more, as naively as possible: a recursive evaluator over the whole history of
// samples, with no state, no resolved slots and no shared results. It defines what the judge must
// agree with bit for bit.
#pragma once

#include <cmath>
#include <span>
#include <vector>

#include "runtime/plan/isa.h"
#include "runtime/plan/plan.h"
#include "runtime/plan/readouts.h"
#include "runtime/vm/sample.h"

namespace probe::vm {

class Reference {
 public:
  Reference(const plan::Plan& plan, const plan::TaskRecord& task, std::span<const BodyStart> starts,
            std::span<const StepSample> history)
      : plan_(plan),
        task_(task),
        program_(plan.programs()[task.program]),
        drives_(plan.robots()[plan.scenes()[task.scene].robot].drives.count),
        starts_(starts),
        history_(history) {
    for (const plan::Instruction& in : plan.code(program_)) {
      if (plan::find_op(in.op)->result != plan::Kind::kUnused) defining_.push_back(in);
    }
  }

  // Value of a metric after the step with index `now` of the history.
  double metric(std::uint16_t index, std::size_t now) const {
    for (const plan::Instruction& in : plan_.code(program_)) {
      if (plan::find_op(in.op)->b == plan::Kind::kMetric && in.b == index)
        return eval(in.a, now)[0];
    }
    return NAN;
  }

 private:
  using Value = std::array<double, 3>;

  std::size_t drives() const { return drives_; }  // the joints before those of fixtures

  bool moves_by_itself(std::uint16_t body) const {
    for (const plan::MoveRecord& leg : plan::slice_of(plan_.tables().moves, task_.moves)) {
      if (leg.body == body) return true;
    }
    return false;
  }

  static Value vector(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
  static Value truth(bool b) { return {b ? 1.0 : 0.0, 0, 0}; }

  static Value push(const StepSample& s, std::uint16_t a, std::uint16_t b) {
    for (const ContactSample& c : s.contacts) {
      if (c.a == a && c.b == b) return vector(c.push);
      if (c.a == b && c.b == a) return vector(Vec3(-c.push));
    }
    return {0, 0, 0};
  }

  // Rows of the rotation matrix, each entry as textbooks have it.
  static std::array<Value, 3> matrix(const Quat& q) {
    const double w = q.w(), x = q.x(), y = q.y(), z = q.z();
    return {{{1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)},
             {2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)},
             {2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)}}};
  }

  Value eval(std::uint16_t reg, std::size_t now) const {
    using enum plan::Op;
    const plan::Instruction& in = defining_[reg];
    const StepSample& s = history_[now];
    const auto x = [&](std::uint16_t r) { return eval(r, now); };
    const auto constants = plan_.constants(program_);
    switch (static_cast<plan::Op>(in.op)) {
      case kKR:
        return {constants[in.a], 0, 0};
      case kKB:
        return truth(in.a != 0);
      case kKV:
        return {constants[in.a], constants[in.a + 1u], constants[in.a + 2u]};
      case kPOS:
        return vector(s.bodies[in.a].position);
      case kSTART:
        for (const OwnPlace& place : s.own) {
          if (moves_by_itself(in.a) && place.body == in.a) return vector(place.position);
        }
        return vector(starts_[in.a].position);
      case kHALF:
        return vector(starts_[in.a].half);
      case kTCP:
        return vector(s.tcp);
      case kOPEN: {
        const auto m = matrix(s.bodies[in.a].rotation);
        const Value o = vector(starts_[in.a].opening);
        Value out{};
        for (std::size_t i = 0; i < 3; ++i)
          out[i] = m[i][0] * o[0] + m[i][1] * o[1] + m[i][2] * o[2];
        return out;
      }
      case kPUSH:
        return push(s, in.a, in.b);
      case kIMP: {
        const Value p = push(s, in.a, in.b);
        return {std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]), 0, 0};
      }
      case kVEL:
        return vector(s.bodies[in.a].velocity);
      case kSPIN:
        return vector(s.bodies[in.a].spin);
      case kAXIS: {
        const auto m = matrix(s.bodies[in.a].rotation);
        return {m[0][in.b], m[1][in.b], m[2][in.b]};
      }
      case kGRIP:
        return {s.grip, 0, 0};
      case kSTEP:
        return {s.step, 0, 0};
      case kTIME:
        return {s.time, 0, 0};
      case kORIGIN:
        return vector(s.bodies[in.a].origin);
      case kLOCAL: {
        // The transposed rotation matrix times what lies between.
        const auto m = matrix(s.bodies[in.a].rotation);
        const Value p = x(in.b), o = vector(s.bodies[in.a].origin);
        Value out{};
        for (std::size_t i = 0; i < 3; ++i)
          out[i] = m[0][i] * (p[0] - o[0]) + m[1][i] * (p[1] - o[1]) + m[2][i] * (p[2] - o[2]);
        return out;
      }
      case kSLIDE:
      case kTURN:
        return {s.joints[drives() + in.a].position, 0, 0};
      case kSLIDING:
      case kTURNING:
        return {s.joints[drives() + in.a].rate, 0, 0};
      case kVADD: {
        const Value a = x(in.a), b = x(in.b);
        return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
      }
      case kVSUB: {
        const Value a = x(in.a), b = x(in.b);
        return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
      }
      case kVSCALE: {
        const Value a = x(in.a);
        const double k = x(in.b)[0];
        return {a[0] * k, a[1] * k, a[2] * k};
      }
      case kVDOT: {
        const Value a = x(in.a), b = x(in.b);
        return {a[0] * b[0] + a[1] * b[1] + a[2] * b[2], 0, 0};
      }
      case kVCROSS: {
        const Value a = x(in.a), b = x(in.b);
        return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
      }
      case kVLEN: {
        const Value a = x(in.a);
        return {std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]), 0, 0};
      }
      case kVLENXY: {
        const Value a = x(in.a);
        return {std::sqrt(a[0] * a[0] + a[1] * a[1]), 0, 0};
      }
      case kVX:
        return {x(in.a)[0], 0, 0};
      case kVY:
        return {x(in.a)[1], 0, 0};
      case kVZ:
        return {x(in.a)[2], 0, 0};
      case kADD:
        return {x(in.a)[0] + x(in.b)[0], 0, 0};
      case kSUB:
        return {x(in.a)[0] - x(in.b)[0], 0, 0};
      case kMUL:
        return {x(in.a)[0] * x(in.b)[0], 0, 0};
      case kRATIO:
        return {x(in.a)[0] / std::max(x(in.b)[0], 0.001), 0, 0};
      case kNEG:
        return {-x(in.a)[0], 0, 0};
      case kABS:
        return {std::fabs(x(in.a)[0]), 0, 0};
      case kMIN: {
        const double a = x(in.a)[0], b = x(in.b)[0];
        return {b < a ? b : a, 0, 0};
      }
      case kMAX: {
        const double a = x(in.a)[0], b = x(in.b)[0];
        return {b > a ? b : a, 0, 0};
      }
      case kLT:
        return truth(x(in.a)[0] < x(in.b)[0]);
      case kLE:
        return truth(x(in.a)[0] <= x(in.b)[0]);
      case kAND:
        return truth(x(in.a)[0] != 0 && x(in.b)[0] != 0);
      case kOR:
        return truth(x(in.a)[0] != 0 || x(in.b)[0] != 0);
      case kNOT:
        return truth(x(in.a)[0] == 0);
      case kONCE:
      case kALWAYS:
      case kHOLD:
      case kCOUNT:
      case kFIRST:
      case kMAXR:
      case kMINR:
      case kRISES:
        return monitor(in, now);
      case kGATED:
        return {x(in.a)[0], x(in.b)[0] != 0 ? 1.0 : 0.0, 0};
      case kKEPT: {
        for (std::size_t i = now + 1; i-- > 0;) {
          const Value then = eval(in.a, i);
          if (then[1] != 0) return {then[0], 0, 0};
        }
        return {x(in.a)[0], 0, 0};
      }
      case kEND:
      case kEMITB:
      case kEMITR:
        break;  // no results
    }
    return {NAN, NAN, NAN};
  }

  // What the monitor's operand was at every step up to now.
  Value monitor(const plan::Instruction& in, std::size_t now) const {
    using enum plan::Op;
    std::vector<double> past;
    for (std::size_t i = 0; i <= now; ++i) past.push_back(eval(in.a, i)[0]);
    const auto count =
        static_cast<std::size_t>(std::ranges::count_if(past, [](double v) { return v != 0; }));
    if (static_cast<plan::Op>(in.op) == kHOLD) {
      const std::size_t n = plan_.states(program_)[in.b].n;
      if (past.size() < n) return truth(false);
      return truth(std::all_of(past.end() - static_cast<std::ptrdiff_t>(n), past.end(),
                               [](double v) { return v != 0; }));
    }
    // No `default`: whoever adds a read-out is asked for its case.
    switch (plan::readout_of(static_cast<plan::Op>(in.op))->readout) {
      case plan::Readout::kOnce:
        return truth(count > 0);
      case plan::Readout::kAlways:
        return truth(count == past.size());
      case plan::Readout::kCount:
        return {static_cast<double>(count), 0, 0};
      case plan::Readout::kFirst:
        for (std::size_t i = 0; i <= now; ++i) {
          if (past[i] != 0) return {history_[i].step, 0, 0};
        }
        return {-1, 0, 0};
      case plan::Readout::kMax: {
        double best = past[0];
        for (double v : past) best = v > best ? v : best;
        return {best, 0, 0};
      }
      case plan::Readout::kMin: {
        double best = past[0];
        for (double v : past) best = v < best ? v : best;
        return {best, 0, 0};
      }
      case plan::Readout::kTimes: {
        double begun = 0;
        for (std::size_t i = 0; i <= now; ++i) {
          if (past[i] != 0 && (i == 0 || past[i - 1] == 0)) ++begun;
        }
        return {begun, 0, 0};
      }
      case plan::Readout::kAtEnd:
      case plan::Readout::kFinal:
      case plan::Readout::kEnds:
        break;  // nothing remembers for them
    }
    return {NAN, NAN, NAN};
  }

  const plan::Plan& plan_;
  const plan::TaskRecord& task_;
  const plan::ProgramRecord& program_;
  std::size_t drives_;
  std::span<const BodyStart> starts_;
  std::span<const StepSample> history_;
  std::vector<plan::Instruction> defining_;  // by register
};

}  // namespace probe::vm
