// A task's metric program as a graph with its source lines: what explanations walk over. Private to
// this folder.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "runtime/plan/isa.h"
#include "runtime/plan/plan.h"
#include "runtime/rejudge/explain.h"
#include "runtime/vm/judge.h"

namespace probe::rejudge {

class ProgramView {
 public:
  ProgramView(const plan::Plan& plan, const plan::TaskRecord& task);

  // The instruction that writes a register.
  const plan::Instruction& at(std::uint16_t reg) const { return code_[index_[reg]]; }
  plan::Op op(std::uint16_t reg) const { return static_cast<plan::Op>(at(reg).op); }
  std::size_t registers() const { return index_.size(); }
  // What a metric is emitted from.
  std::uint16_t emitted(std::uint32_t metric) const;
  std::uint16_t hold(std::uint16_t reg) const;  // HOLD's n

  // Fills file, line and text of the words by which a metric asks for a register's instruction.
  // Metrics share equal conditions; each has its own words for them.
  void locate(std::uint16_t reg, std::uint32_t metric, Condition& condition) const;
  // Whose measurements a register depends on, in the order of its operands: what is pushed after
  // what pushes. `swapped`: the right operand was written first.
  std::string bodies(std::uint16_t reg, bool swapped) const;

  // Whether a register remembers: `once` or `always` within a condition.
  bool is_kept(std::uint16_t reg) const;
  // Conditions below a truth: comparisons, HOLD and what is kept, in the order of the code, each
  // once. What something kept is made of is not looked at: it may be otherwise by now.
  std::vector<std::uint16_t> conditions(std::uint16_t reg) const;

  // How many conditions must change until each truth is `true`, after the judge's last step: 0 for
  // those that are. A HOLD also lacks the steps that it has not been held: `held` says by register
  // for how many its operand has been true. An infinite distance is never less.
  std::vector<std::uint32_t> distances(const vm::Judge& judge, const std::vector<int>& held) const;
  // The conditions below a truth that make it what it is.
  std::vector<bool> deciding(std::uint16_t reg, const vm::Judge& judge) const;

 private:
  bool is_condition(std::uint16_t reg) const;
  std::vector<bool> below(std::uint16_t reg) const;  // the registers that it depends on, and itself

  const plan::Plan& plan_;
  const plan::TaskRecord& task_;
  const plan::ProgramRecord& program_;
  std::span<const plan::Instruction> code_;
  std::vector<std::uint32_t> index_;     // into code_, by register
  std::vector<std::vector<bool>> uses_;  // by metric and register
};

}  // namespace probe::rejudge
