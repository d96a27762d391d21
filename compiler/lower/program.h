// A metric program before it becomes plan records: straight-line code over single-assignment
// registers, with the place in the text that each instruction came from.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "compiler/source/source.h"
#include "runtime/plan/format.h"

namespace probe::lower {

struct ProgramMetric {
  std::string name;
  plan::MetricType type = plan::MetricType::kBool;
  plan::Readout readout = plan::Readout::kAtEnd;
  Span span;
  std::set<Span> empty = {};  // sets of its quantifiers, and of its predicates', that nothing is in
};

struct Program {
  std::vector<double> constants;
  std::vector<plan::StateRecord> states;
  std::vector<plan::Instruction> code;
  std::vector<Span> spans;  // one per instruction: the text that asked for it first
  // Of a truth that metrics share, asked for at other places than `spans` says: its place in each
  // metric that depends on it, in the order of the metrics. By instruction.
  std::map<std::uint32_t, std::vector<Span>> places;
  std::vector<ProgramMetric> metrics;

  // Equal in everything that is judged and read out of the same text: an explanation cites it.
  bool same_as(const Program& other) const;
};

// One instruction a line: "   3  VLENXY r3    r2". Bodies by `body_names` where given.
std::string to_text(const Program& program, const std::vector<std::string>& body_names = {});

}  // namespace probe::lower
