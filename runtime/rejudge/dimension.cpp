#include "runtime/rejudge/dimension.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "runtime/plan/isa.h"

namespace probe::rejudge {
namespace {

using plan::Op;

Dimension joined(Dimension a, Dimension b) { return a == Dimension::kAny ? b : a; }

Dimension product(Dimension a, Dimension b) {
  const auto is_plain = [](Dimension d) { return d == Dimension::kAny || d == Dimension::kNumber; };
  if (is_plain(a)) return b;
  if (is_plain(b)) return a;
  return Dimension::kOther;
}

Dimension measured(Op op) {
  switch (op) {
    case Op::kPOS:
    case Op::kSTART:
    case Op::kHALF:
    case Op::kTCP:
    case Op::kORIGIN:
      return Dimension::kLength;
    case Op::kPUSH:
    case Op::kIMP:
      return Dimension::kImpulse;
    case Op::kVEL:
      return Dimension::kSpeed;
    case Op::kSPIN:
      return Dimension::kSpin;
    case Op::kTIME:
      return Dimension::kTime;
    case Op::kSTEP:
    case Op::kCOUNT:
    case Op::kFIRST:
      return Dimension::kSteps;
    case Op::kKR:
    case Op::kKV:
      return Dimension::kAny;
    default:
      return Dimension::kNumber;
  }
}

bool is_register(plan::Kind kind) {
  return kind == plan::Kind::kReal || kind == plan::Kind::kVector;
}

}  // namespace

std::vector<Dimension> dimensions_of(const plan::Plan& plan, const plan::ProgramRecord& program) {
  std::vector<Dimension> out;
  for (const plan::Instruction& in : plan.code(program)) {
    const plan::OpInfo& info = *plan::find_op(in.op);
    if (info.result == plan::Kind::kUnused) continue;
    Dimension d = measured(info.op);
    if (is_register(info.a)) {
      const bool two = is_register(info.b);
      const bool multiplies = info.op == Op::kMUL || info.op == Op::kVSCALE ||
                              info.op == Op::kVDOT || info.op == Op::kVCROSS;
      d = !two         ? out[in.a]
          : multiplies ? product(out[in.a], out[in.b])
                       : joined(out[in.a], out[in.b]);
    }
    out.push_back(d);
  }
  return out;
}

std::vector<Dimension> metric_dimensions(const plan::Plan& plan,
                                         const plan::ProgramRecord& program) {
  const std::vector<Dimension> registers = dimensions_of(plan, program);
  std::vector<Dimension> out(program.metrics.count, Dimension::kNumber);
  for (const plan::Instruction& in : plan.code(program)) {
    if (plan::find_op(in.op)->op == Op::kEMITR) out[in.b] = registers[in.a];
  }
  return out;
}

std::string quantity(double value, Dimension dimension, int digits) {
  const auto with = [&](double number, const char* unit) {
    return fmt::format("{:.{}g}{}", number, digits, unit);
  };
  switch (dimension) {
    case Dimension::kLength:
      return std::fabs(value) < 1 ? with(100 * value, "cm") : with(value, "m");
    case Dimension::kImpulse:
      return with(value, "Ns");
    case Dimension::kSpeed:
      return std::fabs(value) < 1 ? with(100 * value, "cm/s") : with(value, "m/s");
    case Dimension::kSpin:
      return with(value, "rad/s");
    case Dimension::kTime:
      return with(value, "s");
    case Dimension::kSteps:
    case Dimension::kAny:
    case Dimension::kNumber:
    case Dimension::kOther:
      break;
  }
  return with(value, "");
}

std::string angle_text(double radians, int digits) {
  return fmt::format("{:.{}g}deg", radians * 180 / std::numbers::pi, digits);
}

std::pair<std::string, std::string> quantities(double a, double b, Dimension dimension) {
  std::pair<std::string, std::string> out;
  for (int digits = 3; digits <= 17; ++digits) {
    out = {quantity(a, dimension, digits), quantity(b, dimension, digits)};
    if (a == b || out.first != out.second) break;
  }
  return out;
}

}  // namespace probe::rejudge
