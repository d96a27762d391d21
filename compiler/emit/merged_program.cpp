#include "compiler/emit/merged_program.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "runtime/plan/isa.h"
#include "runtime/plan/limits.h"

namespace probe::emit {
namespace {

using plan::Kind;

std::uint32_t size_of(const auto& table) { return static_cast<std::uint32_t>(table.size()); }

// Where the added program's own numbering begins in the merged one.
struct Offsets {
  std::uint32_t registers = 0, constants = 0, states = 0, metrics = 0;

  std::uint16_t moved(Kind kind, std::uint16_t operand) const {
    switch (kind) {
      case Kind::kBool:
      case Kind::kReal:
      case Kind::kVector:
        return static_cast<std::uint16_t>(operand + registers);
      case Kind::kConstant:
      case Kind::kThreeConstants:
        return static_cast<std::uint16_t>(operand + constants);
      case Kind::kState:
      case Kind::kTimedState:
        return static_cast<std::uint16_t>(operand + states);
      case Kind::kMetric:
        return static_cast<std::uint16_t>(operand + metrics);
      case Kind::kUnused:
      case Kind::kImmediate:
      case Kind::kBody:
      case Kind::kFinger:
      case Kind::kJoint:
        break;
    }
    return operand;
  }
};

class Merge {
 public:
  Merge(plan::Writer& writer, const plan::ProgramRecord& stored, const lower::Program& added,
        std::span<const std::uint32_t> source_of)
      : writer_(writer), r_(writer.records), stored_(stored), added_(added), source_of_(source_of) {
    // What is being added to is read while it grows: copies.
    const auto copy = [](const auto& table, plan::Slice slice) {
      const auto first = table.begin() + slice.first;
      return std::vector(first, first + slice.count);
    };
    constants_ = copy(r_.constants, stored.constants);
    states_ = copy(r_.states, stored.states);
    code_ = copy(r_.code, stored.code);
    metrics_ = copy(r_.metrics, stored.metrics);
  }

  Result<std::uint32_t> run(std::string_view task) {
    merged_.metrics.first = size_of(r_.metrics);
    merged_.code.first = size_of(r_.code);
    merged_.states.first = size_of(r_.states);
    merged_.constants.first = size_of(r_.constants);
    add_stored();
    add_new();
    merged_.metrics.count = size_of(r_.metrics) - merged_.metrics.first;
    merged_.code.count = size_of(r_.code) - merged_.code.first;
    merged_.states.count = size_of(r_.states) - merged_.states.first;
    merged_.constants.count = size_of(r_.constants) - merged_.constants.first;
    if (merged_.code.count > plan::kMaxInstructions || merged_.metrics.count > plan::kMaxMetrics) {
      return Failure{Fault::kUsage,
                     fmt::format("with these its metrics need {} instructions of at most {}",
                                 merged_.code.count, plan::kMaxInstructions),
                     std::string(task)};
    }
    r_.programs.push_back(merged_);
    return size_of(r_.programs) - 1;
  }

 private:
  bool is_replaced(const plan::MetricRecord& metric) const {
    const std::string_view name = r_.tables().text(metric.name);
    return std::ranges::find(added_.metrics, name, &lower::ProgramMetric::name) !=
           added_.metrics.end();
  }

  void add_stored() {
    r_.constants.insert(r_.constants.end(), constants_.begin(), constants_.end());
    r_.states.insert(r_.states.end(), states_.begin(), states_.end());
    std::vector<std::uint32_t> place(metrics_.size(), plan::kNone);  // in the merged program
    for (std::size_t m = 0; m < metrics_.size(); ++m) {
      if (is_replaced(metrics_[m])) continue;
      place[m] = size_of(r_.metrics) - merged_.metrics.first;
      copy_spans(plan::SpanKind::kMetrics, stored_.metrics.first + static_cast<std::uint32_t>(m),
                 size_of(r_.metrics));
      r_.metrics.push_back(metrics_[m]);
    }
    for (std::size_t i = 0; i < code_.size(); ++i) {
      plan::Instruction in = code_[i];
      const plan::OpInfo& info = *plan::find_op(in.op);
      if (info.op == plan::Op::kEND) continue;
      if (info.b == Kind::kMetric) {
        if (place[in.b] == plan::kNone) continue;
        in.b = static_cast<std::uint16_t>(place[in.b]);
      }
      if (info.result != Kind::kUnused) ++offsets_.registers;
      copy_spans(plan::SpanKind::kCode, stored_.code.first + static_cast<std::uint32_t>(i),
                 size_of(r_.code));
      r_.code.push_back(in);
    }
    offsets_.constants = size_of(constants_);
    offsets_.states = size_of(states_);
    offsets_.metrics = size_of(r_.metrics) - merged_.metrics.first;
  }

  void add_new() {
    r_.constants.insert(r_.constants.end(), added_.constants.begin(), added_.constants.end());
    r_.states.insert(r_.states.end(), added_.states.begin(), added_.states.end());
    for (const lower::ProgramMetric& metric : added_.metrics) {
      add_span(plan::SpanKind::kMetrics, size_of(r_.metrics), metric.span);
      r_.metrics.push_back({writer_.text(metric.name), static_cast<std::uint32_t>(metric.type),
                            static_cast<std::uint32_t>(metric.readout)});
    }
    for (std::size_t i = 0; i < added_.code.size(); ++i) {
      plan::Instruction in = added_.code[i];
      const plan::OpInfo& info = *plan::find_op(in.op);
      in.dst = static_cast<std::uint16_t>(in.dst + offsets_.registers);
      in.a = offsets_.moved(info.a, in.a);
      in.b = offsets_.moved(info.b, in.b);
      const auto places = added_.places.find(static_cast<std::uint32_t>(i));
      if (places == added_.places.end()) {
        add_span(plan::SpanKind::kCode, size_of(r_.code), added_.spans[i]);
      } else {
        for (const Span& span : places->second)
          add_span(plan::SpanKind::kCode, size_of(r_.code), span);
      }
      r_.code.push_back(in);
    }
  }

  void copy_spans(plan::SpanKind what, std::uint32_t from, std::uint32_t to) {
    const auto before = [](const plan::SpanRecord& a, const plan::SpanRecord& b) {
      return std::pair(a.what, a.index) < std::pair(b.what, b.index);
    };
    // The stored spans stand first, in order; those that are added follow in none.
    if (known_spans_ == 0) {
      known_spans_ =
          std::is_sorted_until(r_.spans.begin(), r_.spans.end(), before) - r_.spans.begin();
    }
    const plan::SpanRecord wanted{static_cast<std::uint32_t>(what), from, 0, 0, 0};
    const auto [first, last] =
        std::equal_range(r_.spans.begin(), r_.spans.begin() + known_spans_, wanted, before);
    const std::vector<plan::SpanRecord> found(first, last);
    for (plan::SpanRecord span : found) {
      span.index = to;
      r_.spans.push_back(span);
    }
  }

  void add_span(plan::SpanKind what, std::uint32_t index, const Span& span) {
    if (span.is_none()) return;
    r_.spans.push_back({static_cast<std::uint32_t>(what), index, source_of_[span.file.value],
                        span.begin, span.end});
  }

  plan::Writer& writer_;
  plan::Records& r_;
  const plan::ProgramRecord& stored_;
  const lower::Program& added_;
  std::span<const std::uint32_t> source_of_;
  std::vector<double> constants_;
  std::vector<plan::StateRecord> states_;
  std::vector<plan::Instruction> code_;
  std::vector<plan::MetricRecord> metrics_;
  plan::ProgramRecord merged_;
  Offsets offsets_;
  std::ptrdiff_t known_spans_ = 0;
};

}  // namespace

Result<std::uint32_t> merge_program(plan::Writer& writer, const plan::ProgramRecord& stored,
                                    const lower::Program& added,
                                    std::span<const std::uint32_t> source_of,
                                    std::string_view task) {
  return Merge(writer, stored, added, source_of).run(task);
}

}  // namespace probe::emit
