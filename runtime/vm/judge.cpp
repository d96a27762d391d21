// One switch over straight-line code. The verifier has shown that every operand exists, so nothing
// is checked here but what comes from outside: measurements, and whether values are finite.
#include "runtime/vm/judge.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <tuple>

#include "runtime/base/check.h"
#include "runtime/plan/moves.h"
#include "runtime/plan/readouts.h"

namespace probe::vm {
namespace {

using plan::Kind;
using plan::Op;

constexpr double kNever = *plan::info(plan::Readout::kFirst).never;
constexpr std::uint64_t kExponent = 0x7ff0000000000000u;

// Gathers whether any number seen is infinite or not a number; integer operations only, so it
// vectorises.
class FiniteCheck {
 public:
  void see(double value) { bad_ |= (std::bit_cast<std::uint64_t>(value) & kExponent) == kExponent; }
  void see(const Vec3& v) {
    see(v.x());
    see(v.y());
    see(v.z());
  }
  void see(const Quat& q) {
    see(q.w());
    see(q.x());
    see(q.y());
    see(q.z());
  }
  bool ok() const { return !bad_; }

 private:
  bool bad_ = false;
};

bool is_finite(const BodySample& b) {
  FiniteCheck check;
  check.see(b.position);
  check.see(b.origin);
  check.see(b.velocity);
  check.see(b.spin);
  check.see(b.rotation);
  return check.ok();
}

// Written out, because Eigen's order of operations depends on its vectorisation.
double dot(const auto& a, const auto& b) { return (a.x * b.x + a.y * b.y) + a.z * b.z; }
double length(double x, double y, double z) { return std::sqrt((x * x + y * y) + z * z); }

// Column `axis` of the rotation matrix of a unit quaternion.
Vec3 rotated_axis(const Quat& q, std::uint16_t axis) {
  const double w = q.w(), x = q.x(), y = q.y(), z = q.z();
  switch (axis) {
    case 0:
      return {1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z), 2.0 * (x * z - w * y)};
    case 1:
      return {2.0 * (x * y - w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z + w * x)};
    default:
      return {2.0 * (x * z + w * y), 2.0 * (y * z - w * x), 1.0 - 2.0 * (x * x + y * y)};
  }
}

// In the frame of a body: its model's origin and axes.
Vec3 local(const BodySample& body, double x, double y, double z) {
  const double dx = x - body.origin.x(), dy = y - body.origin.y(), dz = z - body.origin.z();
  const auto along = [&](std::uint16_t axis) {
    const Vec3 a = rotated_axis(body.rotation, axis);
    return (a.x() * dx + a.y() * dy) + a.z() * dz;
  };
  return {along(0), along(1), along(2)};
}

Vec3 rotated(const Quat& q, const Vec3& v) {
  const Vec3 x = rotated_axis(q, 0), y = rotated_axis(q, 1), z = rotated_axis(q, 2);
  return {(x.x() * v.x() + y.x() * v.y()) + z.x() * v.z(),
          (x.y() * v.x() + y.y() * v.y()) + z.y() * v.z(),
          (x.z() * v.x() + y.z() * v.y()) + z.z() * v.z()};
}

}  // namespace

Judge::Judge(const plan::Plan& plan, std::uint32_t task)
    : Judge(plan, task, task < plan.tasks().size() ? plan.tasks()[task].program : 0) {}

Judge::Judge(const plan::Plan& plan, std::uint32_t task, std::uint32_t number) {
  PROBE_CHECK(task < plan.tasks().size(), "the judge's task is one of the plan's");
  const plan::TaskRecord& record = plan.tasks()[task];
  const plan::ProgramRecord& program = plan.programs()[number];
  task_name_ = plan.text(record.name);
  bodies_ = record.bodies.count;
  first_joint_ = plan.robots()[plan.scenes()[record.scene].robot].drives.count;
  const auto constants = plan.constants(program);
  constants_.assign(constants.begin(), constants.end());
  for (const plan::StateRecord& state : plan.states(program)) hold_.push_back(state.n);
  for (const plan::MetricRecord& metric : plan.metrics(program)) {
    if (metric.readout == static_cast<std::uint32_t>(plan::Readout::kEnds))
      ends_ = static_cast<std::uint32_t>(metrics_.size());
    metrics_.push_back(
        {std::string(plan.text(metric.name)), static_cast<plan::MetricType>(metric.type)});
  }
  const auto ways = plan::moves_of(plan.tables(), record);
  const auto moves_by_itself = [&](std::uint16_t body) {
    return std::ranges::any_of(ways, [&](const auto& legs) { return legs.front().body == body; });
  };
  const auto code = plan.code(program);
  for (const plan::Instruction& in : code) {
    const auto op = static_cast<Op>(in.op);
    if (op == Op::kPUSH || op == Op::kIMP) {
      pairs_.push_back({std::min(in.a, in.b), std::max(in.a, in.b), Vec3::Zero(), Vec3::Zero()});
    }
    if (op == Op::kSTART && moves_by_itself(in.a)) movers_.push_back(in.a);
    if (plan::find_op(in.op)->a == Kind::kJoint)
      joints_ = std::max(joints_, first_joint_ + in.a + std::size_t{1});
  }
  std::ranges::sort(movers_);
  movers_.erase(std::unique(movers_.begin(), movers_.end()), movers_.end());
  const auto key = [](const Pair& p) { return std::pair(p.a, p.b); };
  std::ranges::sort(pairs_, {}, key);
  const auto same = [&](const Pair& p, const Pair& q) { return key(p) == key(q); };
  pairs_.erase(std::unique(pairs_.begin(), pairs_.end(), same), pairs_.end());

  // Instructions that hang on constants and the start alone run once an episode instead of once a
  // step.
  std::vector<bool> fixed;
  for (const plan::Instruction& in : code) {
    const plan::OpInfo& info = *plan::find_op(in.op);
    Step step{info.op, in.dst, in.a, in.b};
    if (info.op == Op::kEND) break;
    if (info.op == Op::kPUSH || info.op == Op::kIMP) {
      const auto it = std::ranges::lower_bound(
          pairs_, std::pair(std::min(in.a, in.b), std::max(in.a, in.b)), {}, key);
      step.a = static_cast<std::uint16_t>(it - pairs_.begin());
      step.b = in.a > in.b ? 1 : 0;  // 1: what the greater body exerts on the smaller
    }
    bool is_fixed = info.known == plan::Known::kStart;
    // What moves by itself is compared with where its own motion has it, which every step says.
    if (info.op == Op::kSTART && moves_by_itself(in.a)) is_fixed = false;
    if (info.known == plan::Known::kOperands)
      is_fixed = fixed[in.a] && (!plan::is_register(info.b) || fixed[in.b]);
    if (info.result != Kind::kUnused) fixed.push_back(is_fixed);
    (is_fixed ? once_ : each_).push_back(step);
  }
  registers_.resize(fixed.size());
  states_.resize(hold_.size());
  starts_.resize(bodies_);
  values_.resize(metrics_.size());
  emitted_.resize(metrics_.size());
}

Status Judge::begin(std::span<const BodyStart> starts) {
  begun_ = stepped_ = decided_ = false;
  if (starts.size() < bodies_) {
    return Failure{Fault::kJudge,
                   "the start has " + std::to_string(starts.size()) + " bodies, the task has " +
                       std::to_string(bodies_),
                   task_name_};
  }
  for (std::size_t i = 0; i < starts.size(); ++i) {
    FiniteCheck check;
    check.see(starts[i].position);
    check.see(starts[i].half);
    check.see(starts[i].opening);
    if (!check.ok()) {
      return Failure{Fault::kJudge, "the start of body " + std::to_string(i) + " is not finite",
                     task_name_};
    }
  }
  std::ranges::copy(starts.first(bodies_), starts_.begin());
  std::ranges::fill(states_, JudgeState::Monitor{});
  std::ranges::fill(values_, 0.0);
  std::ranges::fill(emitted_, 0.0);
  run(once_, StepSample{});
  begun_ = true;
  return {};
}

Status Judge::restore(std::span<const BodyStart> starts, const JudgeState& state) {
  PROBE_TRY(begin(starts));
  if (state.monitors.size() != states_.size() || state.values.size() != values_.size()) {
    begun_ = false;
    return Failure{Fault::kJudge, "the saved state is of a task with other metrics", task_name_};
  }
  states_ = state.monitors;
  values_ = state.values;
  decided_ = state.decided;
  return {};
}

Status Judge::check(const StepSample& sample) const {
  if (!begun_) return Failure{Fault::kJudge, "a step before the episode began", task_name_};
  if (sample.bodies.size() < bodies_) {
    return Failure{Fault::kJudge,
                   "a step measures " + std::to_string(sample.bodies.size()) +
                       " bodies, the task has " + std::to_string(bodies_),
                   task_name_};
  }
  if (sample.joints.size() < joints_) {
    return Failure{Fault::kJudge,
                   "a step measures " + std::to_string(sample.joints.size()) +
                       " joints, the task has " + std::to_string(joints_),
                   task_name_};
  }
  for (std::size_t i = 0; i < sample.bodies.size(); ++i) {
    if (!is_finite(sample.bodies[i])) {
      return Failure{Fault::kJudge, "a measurement of body " + std::to_string(i) + " is not finite",
                     task_name_};
    }
  }
  const ContactSample* previous = nullptr;
  for (const ContactSample& c : sample.contacts) {
    FiniteCheck contact;
    contact.see(c.push);
    if (!contact.ok()) {
      return Failure{Fault::kJudge,
                     "the impulse between bodies " + std::to_string(c.a) + " and " +
                         std::to_string(c.b) + " is not finite",
                     task_name_};
    }
    const bool ascends =
        previous == nullptr || std::pair(previous->a, previous->b) < std::pair(c.a, c.b);
    if (c.a >= c.b || c.b >= sample.bodies.size() || !ascends) {
      const std::string behind =
          previous == nullptr
              ? ""
              : " behind " + std::to_string(previous->a) + " and " + std::to_string(previous->b);
      return Failure{Fault::kJudge,
                     "contacts ascend by pair, the smaller body first: " + std::to_string(c.a) +
                         " and " + std::to_string(c.b) + behind,
                     task_name_};
    }
    previous = &c;
  }
  for (std::size_t i = 0; i < sample.joints.size(); ++i) {
    FiniteCheck joint;
    joint.see(sample.joints[i].position);
    joint.see(sample.joints[i].rate);
    if (joint.ok()) continue;
    return Failure{Fault::kJudge, "a measurement of joint " + std::to_string(i) + " is not finite",
                   task_name_};
  }
  for (const std::uint16_t body : movers_) {
    if (std::ranges::find(sample.own, body, &OwnPlace::body) != sample.own.end()) continue;
    return Failure{Fault::kJudge,
                   "a step does not say where its own motion has body " + std::to_string(body),
                   task_name_};
  }
  FiniteCheck rest;
  for (const OwnPlace& place : sample.own) rest.see(place.position);
  rest.see(sample.tcp);
  rest.see(sample.grip);
  rest.see(sample.step);
  rest.see(sample.time);
  if (!rest.ok())
    return Failure{Fault::kJudge, "a measurement of the robot or the clock is not finite",
                   task_name_};
  return {};
}

// Both lists ascend by pair, so one pass fills the slots.
void Judge::read_contacts(std::span<const ContactSample> contacts) {
  auto contact = contacts.begin();
  for (Pair& pair : pairs_) {
    while (contact != contacts.end() &&
           std::pair(contact->a, contact->b) < std::pair(pair.a, pair.b))
      ++contact;
    const bool touches = contact != contacts.end() && contact->a == pair.a && contact->b == pair.b;
    pair.push = touches ? contact->push : Vec3::Zero();
    pair.push_back = touches ? Vec3(-contact->push) : Vec3::Zero();
  }
}

Status Judge::step(const StepSample& sample) {
  PROBE_TRY(check(sample));
  read_contacts(sample.contacts);
  run(each_, sample);
  FiniteCheck check;
  for (double value : emitted_) check.see(value);
  if (!check.ok()) return Failure{Fault::kJudge, "the value of a metric is not finite", task_name_};
  std::ranges::copy(emitted_, values_.begin());
  stepped_ = true;
  return {};
}

const Vec3& Judge::start_of(std::uint16_t body, const StepSample& sample) const {
  if (!std::ranges::binary_search(movers_, body)) return starts_[body].position;
  return std::ranges::find(sample.own, body, &OwnPlace::body)->position;
}

void Judge::run(std::span<const Step> steps, const StepSample& sample) {
  Register* const r = registers_.data();
  const auto put = [](Register& d, const Vec3& v) { d = {v.x(), v.y(), v.z()}; };
  for (const Step& s : steps) {
    // Without a result `dst` names the next register, which may not exist: d is used by operations
    // with one only.
    const Register& a = r[s.a < registers_.size() ? s.a : 0];
    const Register& b = r[s.b < registers_.size() ? s.b : 0];
    Register& d = r[s.dst < registers_.size() ? s.dst : 0];
    switch (s.op) {
      case Op::kEND:
        break;
      case Op::kKR:
        d.x = constants_[s.a];
        break;
      case Op::kKB:
        d.x = s.a;
        break;
      case Op::kKV:
        d = {constants_[s.a], constants_[s.a + 1u], constants_[s.a + 2u]};
        break;
      case Op::kPOS:
        put(d, sample.bodies[s.a].position);
        break;
      case Op::kSTART:
        put(d, start_of(s.a, sample));
        break;
      case Op::kHALF:
        put(d, starts_[s.a].half);
        break;
      case Op::kTCP:
        put(d, sample.tcp);
        break;
      case Op::kOPEN:
        put(d, rotated(sample.bodies[s.a].rotation, starts_[s.a].opening));
        break;
      case Op::kPUSH:
        put(d, s.b == 0 ? pairs_[s.a].push : pairs_[s.a].push_back);
        break;
      case Op::kIMP: {
        const Vec3& push = pairs_[s.a].push;
        d.x = length(push.x(), push.y(), push.z());
        break;
      }
      case Op::kVEL:
        put(d, sample.bodies[s.a].velocity);
        break;
      case Op::kSPIN:
        put(d, sample.bodies[s.a].spin);
        break;
      case Op::kAXIS:
        put(d, rotated_axis(sample.bodies[s.a].rotation, s.b));
        break;
      case Op::kGRIP:
        d.x = sample.grip;
        break;
      case Op::kSTEP:
        d.x = sample.step;
        break;
      case Op::kTIME:
        d.x = sample.time;
        break;
      case Op::kORIGIN:
        put(d, sample.bodies[s.a].origin);
        break;
      case Op::kLOCAL:
        put(d, local(sample.bodies[s.a], b.x, b.y, b.z));
        break;
      case Op::kSLIDE:
      case Op::kTURN:
        d.x = sample.joints[first_joint_ + s.a].position;
        break;
      case Op::kSLIDING:
      case Op::kTURNING:
        d.x = sample.joints[first_joint_ + s.a].rate;
        break;
      case Op::kVADD:
        d = {a.x + b.x, a.y + b.y, a.z + b.z};
        break;
      case Op::kVSUB:
        d = {a.x - b.x, a.y - b.y, a.z - b.z};
        break;
      case Op::kVSCALE:
        d = {a.x * b.x, a.y * b.x, a.z * b.x};
        break;
      case Op::kVDOT:
        d.x = dot(a, b);
        break;
      case Op::kVCROSS:
        d = {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
        break;
      case Op::kVLEN:
        d.x = length(a.x, a.y, a.z);
        break;
      case Op::kVLENXY:
        d.x = std::sqrt(a.x * a.x + a.y * a.y);
        break;
      case Op::kVX:
        d.x = a.x;
        break;
      case Op::kVY:
        d.x = a.y;
        break;
      case Op::kVZ:
        d.x = a.z;
        break;
      case Op::kADD:
        d.x = a.x + b.x;
        break;
      case Op::kSUB:
        d.x = a.x - b.x;
        break;
      case Op::kMUL:
        d.x = a.x * b.x;
        break;
      case Op::kRATIO:
        d.x = a.x / (b.x < 1e-3 ? 1e-3 : b.x);
        break;
      case Op::kNEG:
        d.x = -a.x;
        break;
      case Op::kABS:
        d.x = std::fabs(a.x);
        break;
      case Op::kMIN:
        d.x = b.x < a.x ? b.x : a.x;
        break;
      case Op::kMAX:
        d.x = a.x < b.x ? b.x : a.x;
        break;
      case Op::kLT:
        d.x = a.x < b.x ? 1.0 : 0.0;
        break;
      case Op::kLE:
        d.x = a.x <= b.x ? 1.0 : 0.0;
        break;
      case Op::kAND:
        d.x = a.x * b.x;
        break;  // truths are exactly 0 or 1
      case Op::kOR:
        d.x = a.x < b.x ? b.x : a.x;
        break;
      case Op::kNOT:
        d.x = 1.0 - a.x;
        break;
      case Op::kONCE: {
        double& seen = states_[s.b].value;
        if (a.x != 0.0) seen = 1.0;
        d.x = seen;
        break;
      }
      case Op::kALWAYS: {
        double& broken = states_[s.b].value;
        if (a.x == 0.0) broken = 1.0;
        d.x = 1.0 - broken;
        break;
      }
      case Op::kHOLD: {
        double& run_length = states_[s.b].value;
        run_length = a.x != 0.0 ? run_length + 1.0 : 0.0;
        d.x = run_length >= hold_[s.b] ? 1.0 : 0.0;
        break;
      }
      case Op::kCOUNT: {
        double& count = states_[s.b].value;
        count += a.x;
        d.x = count;
        break;
      }
      case Op::kFIRST: {
        JudgeState::Monitor& first = states_[s.b];
        if (a.x != 0.0 && !first.started) first = {sample.step, true};
        d.x = first.started ? first.value : kNever;
        break;
      }
      case Op::kMAXR:
      case Op::kMINR: {
        JudgeState::Monitor& best = states_[s.b];
        const bool better = s.op == Op::kMAXR ? best.value < a.x : a.x < best.value;
        if (!best.started || better) best = {a.x, true};
        d.x = best.value;
        break;
      }
      case Op::kRISES: {  // `started`: it was true at the step before
        JudgeState::Monitor& rises = states_[s.b];
        if (a.x != 0.0 && !rises.started) rises.value += 1.0;
        rises.started = a.x != 0.0;
        d.x = rises.value;
        break;
      }
      case Op::kGATED:
        d = {a.x, b.x, 0.0};
        break;
      case Op::kKEPT: {
        JudgeState::Monitor& kept = states_[s.b];
        if (a.y != 0.0) kept = {a.x, true};
        d.x = kept.started ? kept.value : a.x;
        break;
      }
      case Op::kEMITB:
      case Op::kEMITR:
        emitted_[s.b] = a.x;
        break;
    }
  }
}

std::optional<std::uint32_t> Judge::find_metric(std::string_view name) const {
  for (std::uint32_t i = 0; i < metrics_.size(); ++i) {
    if (metrics_[i].name == name) return i;
  }
  return std::nullopt;
}

Vec3 Judge::register_value(std::size_t index) const {
  PROBE_CHECK(index < registers_.size(), "the register is one of the program's");
  return {registers_[index].x, registers_[index].y, registers_[index].z};
}

}  // namespace probe::vm
