// P1513: a horizon counts control steps, so one that is copied into a scene whose robot is
// controlled at another rate is another time: 60 steps are 12 s at 5 Hz and 3 s at 20 Hz.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compiler/check/check.h"
#include "compiler/check/starts.h"

namespace probe::sema {
namespace {

// A time that much longer or shorter is not what was meant.
constexpr double kMostTimes = 1.25;

double rate_of(const Model& model, const Task& task) {
  if (task.scene == SceneId::kNone) return 0;
  const RobotId robot = model.scenes[task.scene].robot;
  return robot == RobotId::kNone ? 0 : model.robots[robot].control_hz;
}

// The task that says the horizon of this one; null where it says it itself.
const Task* sayer_of(const Model& model, const Task& task) {
  const Task* at = &task;
  while (!is_within(at->horizon_span, at->decl_span) && at->like != TaskId::kNone)
    at = &model.tasks[at->like];
  return at == &task ? nullptr : at;
}

// Whether a task that this one copies has as many steps at this one's rate: it is told there, or an
// @allow there holds here as well.
bool is_told_above(const Model& model, const Task& task, const Task& sayer) {
  for (const Task* at = &task; at != &sayer && at->like != TaskId::kNone;) {
    at = &model.tasks[at->like];
    if (at == &sayer) return false;
    const bool is_looked_at = at->complete && !at->abstract && at->horizon != 0;
    if (is_looked_at && rate_of(model, *at) == rate_of(model, task)) return true;
  }
  return false;
}

}  // namespace

void check_horizons(const Model& model, Reporter& reporter) {
  for (const Task& task : model.tasks) {
    if (!task.complete || task.abstract || task.horizon == 0) continue;
    if (task.horizon_time) continue;  // of any robot the same
    const Task* const sayer = sayer_of(model, task);
    if (sayer == nullptr) continue;
    const double here = rate_of(model, task), there = rate_of(model, *sayer);
    if (here <= 0 || there <= 0 || std::max(here / there, there / here) < kMostTimes) continue;
    if (is_told_above(model, task, *sayer)) continue;
    const About about(reporter, task.decl_span);
    const double steps = static_cast<double>(task.horizon);
    const double meant = std::max(1.0, std::round(steps * here / there));
    Diagnostic& said = reporter.report(
        Code::P1513, task.span,
        fmt::format(
            "`{}` has the {:g} steps of `{}`: {:.3g}s at {:g}Hz there, {:.3g}s at {:g}Hz here",
            task.name, steps, sayer->name, steps / there, there, steps / here, here));
    said.label(task.horizon_span, "said here");
    // Rounded down, so that the time has no step more.
    const double time = std::floor(steps / there * 1e4) / 1e4;
    const bool is_kept = std::ceil(time * there - 1e-9) == steps;
    said.help(fmt::format("write `horizon {:g} steps`, the same time, or what `{}` needs{}", meant,
                          model.robots[model.scenes[task.scene].robot].name,
                          is_kept
                              ? fmt::format("; `horizon {:.10g}s` is the same at any rate", time)
                              : std::string()));
    said.cause = cause_of(task.horizon_span, {model.scenes[task.scene].name});
  }
}

}  // namespace probe::sema
