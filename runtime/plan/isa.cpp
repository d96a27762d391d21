#include "runtime/plan/isa.h"

#include <array>

namespace probe::plan {
namespace {

// The columns of isa.def are bare letters; `-` is a token of its own, so they are read as text.
constexpr Kind kind_of(const char* letter) { return static_cast<Kind>(letter[0]); }

constexpr std::array kOps = {
#define PROBE_OP(code, name, result, a, b, limit, dimension, known, meaning) \
  OpInfo{Op::k##name, #name, kind_of(#result),       kind_of(#a),            \
         kind_of(#b), limit, Measures::k##dimension, Known::k##known,        \
         meaning},
#include "runtime/plan/isa.def"
};

// Index into kOps by code, -1 for none.
constexpr std::array<std::int16_t, 256> kByCode = [] {
  std::array<std::int16_t, 256> table{};
  table.fill(-1);
  for (std::size_t i = 0; i < kOps.size(); ++i) {
    table[static_cast<std::uint8_t>(kOps[i].op)] = static_cast<std::int16_t>(i);
  }
  return table;
}();

constexpr bool ascending_codes() {
  for (std::size_t i = 1; i < kOps.size(); ++i) {
    if (kOps[i - 1].op >= kOps[i].op) return false;
  }
  return true;
}
static_assert(ascending_codes(), "isa.def ascends by code and repeats none");

constexpr bool known_letters() {
  for (const OpInfo& op : kOps) {
    const std::string_view results = "-brv", operands = "-brvkKiBFSHMJ";
    if (results.find(static_cast<char>(op.result)) == std::string_view::npos) return false;
    if (operands.find(static_cast<char>(op.a)) == std::string_view::npos) return false;
    if (operands.find(static_cast<char>(op.b)) == std::string_view::npos) return false;
  }
  return true;
}
static_assert(known_letters(), "isa.def uses the letters that its header names");

constexpr bool fitting_columns() {
  for (const OpInfo& op : kOps) {
    const bool has_result = op.result != Kind::kUnused;
    const bool has_immediate = op.a == Kind::kImmediate || op.b == Kind::kImmediate;
    if (has_immediate != (op.limit > 0)) return false;
    if (has_result == (op.dimension == Measures::kNothing)) return false;
    if ((op.result == Kind::kBool) != (op.dimension == Measures::kTruth)) return false;
    // What follows from registers alone is known with them.
    const bool follows = has_result && is_register(op.a) && !is_state(op.b);
    if (follows != (op.known == Known::kOperands)) return false;
    const bool of_operands = op.dimension == Measures::kSame || op.dimension == Measures::kProduct;
    if (of_operands && !is_register(op.a)) return false;
  }
  return true;
}
static_assert(fitting_columns(), "the columns of a line of isa.def agree with one another");

}  // namespace

std::span<const OpInfo> all_ops() { return kOps; }

const OpInfo* find_op(std::uint8_t code) {
  return kByCode[code] < 0 ? nullptr : &kOps[static_cast<std::size_t>(kByCode[code])];
}

}  // namespace probe::plan
