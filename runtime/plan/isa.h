// The instruction set as data, made from isa.def. Verifier, disassembler, judge and the compiler's
// lowering all ask here; none has a table of its own.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace probe::plan {

enum class Op : std::uint8_t {
#define PROBE_OP(code, name, result, a, b, limit, dimension, known, meaning) k##name = code,
#include "runtime/plan/isa.def"
};

// The columns `result`, `a`, `b` of isa.def, by their letters.
enum class Kind : char {
  kUnused = '-',
  kBool = 'b',
  kReal = 'r',
  kVector = 'v',
  kConstant = 'k',
  kThreeConstants = 'K',
  kImmediate = 'i',
  kBody = 'B',
  kFinger = 'F',
  kState = 'S',
  kTimedState = 'H',
  kMetric = 'M',
  kJoint = 'J'
};

constexpr bool is_register(Kind kind) {
  return kind == Kind::kBool || kind == Kind::kReal || kind == Kind::kVector;
}
constexpr bool is_body(Kind kind) { return kind == Kind::kBody || kind == Kind::kFinger; }
constexpr bool is_state(Kind kind) { return kind == Kind::kState || kind == Kind::kTimedState; }

// The column `dimension`: what a result measures.
enum class Measures : std::uint8_t {
  kNothing,
  kTruth,
  kAny,
  kNumber,
  kLength,
  kAngle,
  kImpulse,
  kSpeed,
  kSpin,
  kTime,
  kSteps,
  kSame,
  kProduct
};

// The column `known`: when a result is what it stays.
enum class Known : std::uint8_t { kStart, kStep, kOperands };

struct OpInfo {
  Op op;
  std::string_view name;
  Kind result;
  Kind a, b;
  std::uint16_t limit;  // the largest immediate
  Measures dimension;
  Known known;
  std::string_view meaning;

  bool is_monitor() const { return is_state(b); }
};

// All operations in the order of isa.def.
std::span<const OpInfo> all_ops();
// Null when the code is not an operation.
const OpInfo* find_op(std::uint8_t code);

}  // namespace probe::plan
