// The instruction set as data, made from isa.def. Verifier, disassembler, judge and the compiler's
// lowering all ask here; none has a table of its own.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace probe::plan {

enum class Op : std::uint8_t {
#define PROBE_OP(code, name, result, a, b, meaning) k##name = code,
#include "runtime/plan/isa.def"
#undef PROBE_OP
};

// The columns `result`, `a`, `b` of isa.def, by their letters.
enum class Kind : char {
  kUnused = '-',
  kBool = 'b',
  kReal = 'r',
  kVector = 'v',
  kConstant = 'k',
  kImmediate = 'i',
  kBody = 'B',
  kState = 'S',
  kMetric = 'M'
};

struct OpInfo {
  Op op;
  std::string_view name;
  Kind result;
  Kind a, b;
  std::string_view meaning;

  bool is_monitor() const { return b == Kind::kState; }
};

// All operations in the order of isa.def.
std::span<const OpInfo> all_ops();
// Null when the code is not an operation.
const OpInfo* find_op(std::uint8_t code);

}  // namespace probe::plan
