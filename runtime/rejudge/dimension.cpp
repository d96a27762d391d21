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

// Of the result of `in`, whose registers have the dimensions of `known`.
Dimension measured(const plan::OpInfo& info, const plan::Instruction& in,
                   const std::vector<Dimension>& known) {
  const bool has_two = plan::is_register(info.b);
  switch (info.dimension) {
    case plan::Measures::kNothing:
    case plan::Measures::kTruth:
    case plan::Measures::kNumber:
      return Dimension::kNumber;
    case plan::Measures::kAny:
      return Dimension::kAny;
    case plan::Measures::kLength:
      return Dimension::kLength;
    case plan::Measures::kAngle:
      return Dimension::kAngle;
    case plan::Measures::kImpulse:
      return Dimension::kImpulse;
    case plan::Measures::kSpeed:
      return Dimension::kSpeed;
    case plan::Measures::kSpin:
      return Dimension::kSpin;
    case plan::Measures::kTime:
      return Dimension::kTime;
    case plan::Measures::kSteps:
      return Dimension::kSteps;
    case plan::Measures::kSame:
      return has_two ? joined(known[in.a], known[in.b]) : known[in.a];
    case plan::Measures::kProduct:
      return has_two ? product(known[in.a], known[in.b]) : known[in.a];
  }
  return Dimension::kOther;
}

}  // namespace

std::vector<Dimension> dimensions_of(const plan::Plan& plan, const plan::ProgramRecord& program) {
  std::vector<Dimension> out;
  for (const plan::Instruction& in : plan.code(program)) {
    const plan::OpInfo& info = *plan::find_op(in.op);
    if (info.result == plan::Kind::kUnused) continue;
    out.push_back(measured(info, in, out));
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
    case Dimension::kAngle:
      return angle_text(value, digits);
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
