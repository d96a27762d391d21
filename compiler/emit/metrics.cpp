// Lowered metrics as programs, and what is known of them without running: P0602, P0603.
#include <fmt/format.h>
#include <algorithm>

#include "compiler/define/telling.h"
#include "compiler/define/views.h"
#include "compiler/emit/emitter.h"
#include "compiler/lower/intervals.h"

namespace probe::emit {

std::optional<std::uint32_t> Emitter::add_program(const sema::Task& task,
                                                  std::span<const sema::Metric> metrics,
                                                  const std::vector<lower::Body>& bodies,
                                                  std::uint64_t steps) {
  std::vector<std::uint32_t> shape = lower::shape_of(model_, metrics, bodies);
  const sema::CameraId camera = sema::views_of(model_, task).front().camera;
  // What is seen from elsewhere is another number.
  if (model_.exprs.needs_frame)
    shape.insert(shape.end(),
                 {static_cast<std::uint32_t>(task.scene), static_cast<std::uint32_t>(camera)});
  auto known = programs_by_shape_.find(shape);
  if (known == programs_by_shape_.end()) {
    const std::size_t before = diagnostics_.size();
    auto program = lower::lower_metrics(
        model_, metrics, bodies,
        sema::frame_of(model_, model_.scenes[task.scene], model_.cameras[camera]), diagnostics_);
    // What is amiss may be what fills a role of this task.
    for (std::size_t i = before; i < diagnostics_.size(); ++i) {
      if (diagnostics_[i].severity == Severity::kError)
        diagnostics_[i].label(task.span, "`" + task.name + "` is judged by it");
    }
    if (!program) return std::nullopt;
    known = programs_by_shape_.emplace(std::move(shape), keep_program(std::move(*program))).first;
  }
  // What is constant depends on how long an episode is.
  note_constants(task, known->second, steps,
                 model_.robots[model_.scenes[task.scene].robot].control_hz,
                 lower::room_of(model_, task));
  return known->second;
}

// Shapes that differ may still say the same.
std::uint32_t Emitter::keep_program(lower::Program program) {
  for (std::size_t i = 0; i < programs_.size(); ++i) {
    if (programs_[i].same_as(program)) return static_cast<std::uint32_t>(i);
  }
  plan::ProgramRecord record;
  record.constants = plan::append(records().constants, std::span<const double>(program.constants));
  record.states =
      plan::append(records().states, std::span<const plan::StateRecord>(program.states));
  for (std::size_t i = 0; i < program.code.size(); ++i) {
    const std::uint32_t index = size32(records().code) + static_cast<std::uint32_t>(i);
    const auto places = program.places.find(static_cast<std::uint32_t>(i));
    if (places == program.places.end()) {
      add_span(plan::SpanKind::kCode, index, program.spans[i]);
      continue;
    }
    for (const Span& place : places->second) add_span(plan::SpanKind::kCode, index, place);
  }
  record.code = plan::append(records().code, std::span<const plan::Instruction>(program.code));
  record.metrics = {size32(records().metrics), size32(program.metrics)};
  for (const lower::ProgramMetric& metric : program.metrics) {
    add_span(plan::SpanKind::kMetrics, size32(records().metrics), metric.span);
    records().metrics.push_back({writer_.text(metric.name), static_cast<std::uint32_t>(metric.type),
                                 static_cast<std::uint32_t>(metric.readout)});
  }
  records().programs.push_back(record);
  programs_.push_back(std::move(program));
  return size32(programs_) - 1;
}

void Emitter::note_constants(const sema::Task& task, std::uint32_t index, std::uint64_t horizon, double control_hz,
                             const lower::Room& room) {
  if (!noted_.insert({index, horizon, control_hz, room}).second) return;
  const lower::Program& program = programs_[index];
  const lower::Findings findings = lower::find_constants(program, horizon, control_hz, room);
  for (const std::size_t at : findings.contradictions) {
    const Span& span = program.spans[at];
    if (!contradictions_.insert({span.file.value, span.begin}).second) continue;
    diagnostics_.report(Code::P0603, span, "these conditions exclude one another");
  }
  for (std::size_t i = 0; i < program.metrics.size(); ++i) {
    const auto known =
        std::find_if(findings.constants.begin(), findings.constants.end(),
                     [&](const lower::ConstantMetric& found) { return found.metric == i; });
    const Span& span = program.metrics[i].span;
    Constant& constant = constants_[{span.file.value, span.begin}];
    // What nothing is in wherever the metric is used.
    if (constant.values.empty() && !constant.varies) {
      constant.metric = program.metrics[i];
      constant.task = &task;
    } else {
      std::erase_if(constant.metric.empty,
                    [&](const Span& set) { return !program.metrics[i].empty.contains(set); });
    }
    if (known == findings.constants.end()) {
      constant.varies = true;
    } else {
      const auto& number = known->number;
      constant.values.insert(number         ? fmt::format("{:.6g}", *number)
                             : known->value ? "true"
                                            : "false");
    }
  }
}

void Emitter::report_constants() {
  for (const auto& [place, constant] : constants_) {
    if (constant.varies || constant.values.size() != 1) continue;
    const std::string& value = *constant.values.begin();
    const bool brings = constant.metric.name == sema::kWhenMetric;
    Diagnostic& said =
        diagnostics_.report(Code::P0602, constant.metric.span,
                            (brings ? std::string("what brings the next sentence")
                                    : "metric `" + constant.metric.name + "`") +
                                " is always " + value);
    if (brings)
      said.point(value == "true" ? "it comes after the first step" : "it never comes in time");
    for (const Span& set : constant.metric.empty) said.label(set, "nothing is in it");
    if (brings || constant.metric.empty.empty()) continue;
    // Another file's metric, which measures nothing here, says nothing wrong.
    const std::string& task = constant.task->name;
    if (!(constant.task->file == constant.metric.span.file) && constant.metric.name != "success")
      said.severity = Severity::kWarning;
    said.help("`" + task + "` is judged by it: give it what is asked about (`distractors spoon`), say " +
              "what it measures instead (`set " + constant.metric.name +
              " = ..`), or take metrics that do not ask");
  }
}

}  // namespace probe::emit
