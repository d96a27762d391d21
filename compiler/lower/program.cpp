#include "compiler/lower/program.h"

#include <algorithm>
#include <cstdio>
#include <cstring>

#include "runtime/plan/isa.h"

namespace probe::lower {
namespace {

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.17g", value);
  char shorter[32];
  std::snprintf(shorter, sizeof shorter, "%.15g", value);
  double back = 0;
  std::sscanf(shorter, "%lf", &back);
  return back == value ? shorter : text;
}

struct Printer {
  const Program& program;
  const std::vector<std::string>& body_names;

  std::string operand(plan::Kind kind, std::uint16_t value) const {
    switch (kind) {
      case plan::Kind::kUnused:
        return {};
      case plan::Kind::kConstant:
        return number(program.constants[value]);
      case plan::Kind::kThreeConstants:
        return "(" + number(program.constants[value]) + ", " +
               number(program.constants[value + 1u]) + ", " +
               number(program.constants[value + 2u]) + ")";
      case plan::Kind::kImmediate:
        return std::to_string(value);
      case plan::Kind::kBody:
      case plan::Kind::kFinger:
        return value < body_names.size() ? body_names[value] : "b" + std::to_string(value);
      case plan::Kind::kJoint:
        return "j" + std::to_string(value);
      case plan::Kind::kState:
        return "s" + std::to_string(value);
      case plan::Kind::kTimedState:
        return "s" + std::to_string(value) + "(" + std::to_string(program.states[value].n) + ")";
      case plan::Kind::kMetric:
        return "-> " + program.metrics[value].name;
      case plan::Kind::kBool:
      case plan::Kind::kReal:
      case plan::Kind::kVector:
        return "r" + std::to_string(value);
    }
    return {};
  }
};

}  // namespace

bool Program::same_as(const Program& other) const {
  const auto same_bytes = [](const auto& a, const auto& b) {
    return a.size() == b.size() &&
           (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])) == 0);
  };
  return same_bytes(constants, other.constants) && same_bytes(states, other.states) &&
         same_bytes(code, other.code) && spans == other.spans && places == other.places &&
         std::equal(metrics.begin(), metrics.end(), other.metrics.begin(), other.metrics.end(),
                    [](const ProgramMetric& a, const ProgramMetric& b) {
                      return a.name == b.name && a.type == b.type && a.readout == b.readout &&
                             a.span == b.span;
                    });
}

std::string to_text(const Program& program, const std::vector<std::string>& body_names) {
  const Printer printer{program, body_names};
  std::string text;
  for (std::size_t i = 0; i < program.code.size(); ++i) {
    const plan::Instruction& instruction = program.code[i];
    const plan::OpInfo* op = plan::find_op(instruction.op);
    if (op == nullptr) continue;
    char head[64];
    const std::string dst =
        op->result == plan::Kind::kUnused ? "" : "r" + std::to_string(instruction.dst);
    std::snprintf(head, sizeof head, "%4zu  %-6.*s %-5s", i, static_cast<int>(op->name.size()),
                  op->name.data(), dst.c_str());
    std::string line = head;
    const std::string a = printer.operand(op->a, instruction.a);
    const std::string b = printer.operand(op->b, instruction.b);
    if (!a.empty()) line += " " + a;
    if (!b.empty()) line += " " + b;
    while (line.ends_with(' ')) line.pop_back();
    text += line + "\n";
  }
  return text;
}

}  // namespace probe::lower
