#include "runtime/rejudge/rescore.h"

#include <fmt/format.h>

#include <algorithm>

#include "runtime/plan/fixtures.h"
#include "runtime/plan/later.h"
#include "runtime/plan/moves.h"
#include "runtime/store/episode_key.h"
#include "runtime/vm/claims.h"

namespace probe::rejudge {
namespace {

// Whether the task's episode is over with the steps that there are.
bool ends_within(const plan::Plan& plan, std::uint32_t task, const store::Trace& trace) {
  if (!trace.start || !plan.ends_metric(plan.tasks()[task])) return false;
  vm::Judge judge(plan, task);
  if (!judge.begin(trace.start->starts)) return false;
  return std::ranges::any_of(trace.steps, [&](const store::TraceStep& step) {
    return judge.step(step.sample).ok() && judge.ended();
  });
}

}  // namespace

Status check_measures(const plan::Plan& plan, std::uint32_t task, const store::Trace& trace) {
  const plan::TaskRecord& record = plan.tasks()[task];
  const store::TraceHeader& header = trace.header;
  const std::string where = to_text(store::key_of(header));
  const auto refuse = [&](std::string message) {
    return Failure{Fault::kUsage, std::move(message), where};
  };
  const auto bodies = plan.bodies(record);
  if (bodies.size() > header.bodies.size()) {
    return refuse(fmt::format("{} bodies were measured, task `{}` judges {}", header.bodies.size(),
                              plan.text(record.name), bodies.size()));
  }
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    // Equal starts have equal objects, whatever a catalogue calls them.
    const auto kind = static_cast<plan::BodyKind>(bodies[i].kind);
    if (kind != plan::BodyKind::kLink && kind != plan::BodyKind::kPart) continue;
    if (plan.text(bodies[i].name) != header.bodies[i]) {
      return refuse(fmt::format("body {} is `{}`, task `{}` judges `{}`", i, header.bodies[i],
                                plan.text(record.name), plan.text(bodies[i].name)));
    }
  }
  const plan::SceneRecord& scene = plan.scenes()[record.scene];
  const auto joints = plan::joint_names_of(plan.tables(), scene);
  const std::size_t drives = plan.robots()[scene.robot].drives.count;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const std::size_t at = drives + i;
    if (at < header.joints.size() && header.joints[at] == joints[i]) continue;
    return refuse(fmt::format("joint `{}` was not measured, task `{}` judges it", joints[i],
                              plan.text(record.name)));
  }
  for (const auto legs : plan::moves_of(plan.tables(), record)) {
    const std::uint32_t body = legs.front().body;
    const auto is_it = [&](const vm::OwnPlace& place) { return place.body == body; };
    if (trace.steps.empty() || std::ranges::any_of(trace.steps.front().sample.own, is_it)) continue;
    return refuse(fmt::format("it does not say where `{}` was let go, which moves by itself",
                              header.bodies[body]));
  }
  const double hz = plan.robots()[plan.scenes()[record.scene].robot].control_hz;
  if (hz != header.control_hz) {
    return refuse(
        fmt::format("it was measured at {} Hz, the plan judges at {} Hz", header.control_hz, hz));
  }
  const std::string told = plan::whole_instruction(header.prompt, header.later);
  if (const std::string says = plan::whole_instruction(plan.tables(), task); says != told) {
    return refuse(fmt::format("the policy was told \"{}\", task `{}` says \"{}\"", told,
                              plan.text(record.name), says));
  }
  const bool is_invalid = trace.end && trace.end->invalid;
  if (trace.steps.size() < record.horizon && !is_invalid && !ends_within(plan, task, trace)) {
    return refuse(fmt::format("it has {} steps, task `{}` judges {}", trace.steps.size(),
                              plan.text(record.name), record.horizon));
  }
  return {};
}

Result<Rescored> rescore(const plan::Plan& plan, std::uint32_t task, const store::Trace& trace) {
  PROBE_TRY(check_measures(plan, task, trace));
  vm::Judge judge(plan, task);
  Rescored out;
  for (std::uint32_t m = 0; m < judge.metric_count(); ++m) {
    out.metrics.push_back(
        {judge.metric_name(m), judge.metric_type(m) == plan::MetricType::kBool, 0});
  }
  if (trace.end) out.invalid = trace.end->invalid;
  if (!trace.start) return out;  // it ended before it began, and its end says why
  const auto fail = [&](const Failure& failure) {
    if (!out.invalid) out.invalid = "judge: " + to_text(failure);
    return out;
  };
  if (auto begun = judge.begin(trace.start->starts); !begun) return fail(begun.failure());
  if (auto so = vm::check_claims(plan, task, trace.start->starts, trace.start->sample); !so) {
    if (!out.invalid) out.invalid = "start: " + to_text(so.failure());
    return out;
  }
  const std::size_t steps = std::min<std::size_t>(trace.steps.size(), plan.tasks()[task].horizon);
  for (std::size_t i = 0; i < steps && !judge.ended(); ++i) {
    if (auto judged = judge.step(trace.steps[i].sample); !judged) return fail(judged.failure());
    const auto values = judge.values();
    out.steps.emplace_back(values.begin(), values.end());
    for (std::size_t m = 0; m < values.size(); ++m) out.metrics[m].value = values[m];
  }
  return out;
}

}  // namespace probe::rejudge
