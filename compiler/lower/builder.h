// Makes straight-line code: shares equal subexpressions, folds constants, gives out state slots.
// Knows the instruction set and nothing of the language.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "compiler/lower/program.h"
#include "compiler/model/model.h"
#include "runtime/plan/isa.h"

namespace probe::lower {

// What an expression is worth while lowering: known now, or in a register.
struct Value {
  enum Kind : std::uint8_t { kTruth, kNumber, kRegister, kBody, kJoint, kRegion };
  Kind kind = kTruth;
  bool truth = false;
  double number = 0;
  std::optional<sema::Quantity> angle;  // a literal angle, for its exact cosine
  std::uint16_t index = 0;              // register, or task-local body, joint, a region's body
  const sema::Fixture::Joint* joint = nullptr;  // kJoint
  const sema::Region* region = nullptr;         // kRegion

  static Value of_truth(bool value) {
    Value result;
    result.truth = value;
    return result;
  }
  static Value of_number(double value) {
    Value result;
    result.kind = kNumber;
    result.number = value;
    return result;
  }
  static Value of_register(std::uint16_t index) {
    Value result;
    result.kind = kRegister;
    result.index = index;
    return result;
  }
  static Value of_body(std::uint16_t index) {
    Value result;
    result.kind = kBody;
    result.index = index;
    return result;
  }
};

class Builder {
 public:
  // Where the instructions that follow come from.
  void at(const Span& span) { span_ = span; }
  const Span& here() const { return span_; }

  // No more instructions than a program may have; the rest is dropped and the program must not be
  // used.
  bool is_full() const { return full_; }

  std::uint16_t emit(plan::Op op, std::uint16_t a = 0, std::uint16_t b = 0);
  std::uint16_t constant(double value);
  std::uint16_t vector(double x, double y, double z);
  // A register for any number or truth.
  std::uint16_t in_register(const Value& value);

  Value logical_not(const Value& a);
  Value logical_and(const Value& a, const Value& b);
  Value logical_or(const Value& a, const Value& b);
  Value less(const Value& a, const Value& b, bool or_equal);
  Value arithmetic(plan::Op op, const Value& a, const Value& b);
  Value negate(const Value& a);
  // ONCE .. MINR; `n` is the length of HOLD.
  Value monitor(plan::Op op, const Value& a, std::uint16_t n = 0);

  // The value of one metric at every step.
  void emit_metric(const Value& value, ProgramMetric metric);
  // Ends the program.
  Program finish();

 private:
  std::uint16_t constant_slot(double value);
  std::uint16_t append(plan::Op op, std::uint16_t a, std::uint16_t b, bool has_result);
  // The metric that is being made asks for a register's instruction here.
  std::uint16_t ask(std::uint16_t result);
  void find_places();

  Program program_;
  Span span_;
  std::uint16_t results_ = 0;
  bool full_ = false;
  std::map<std::tuple<plan::Op, std::uint16_t, std::uint16_t>, std::uint16_t> known_;
  std::map<std::tuple<plan::Op, std::uint16_t, std::uint16_t>, std::uint16_t> monitors_;
  std::map<std::uint64_t, std::uint16_t> constants_;             // by bit pattern
  std::vector<std::uint32_t> makers_;                            // of each register, into the code
  std::map<std::pair<std::uint16_t, std::size_t>, Span> asked_;  // by register and metric
};

}  // namespace probe::lower
