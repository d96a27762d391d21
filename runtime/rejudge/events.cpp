#include "runtime/rejudge/events.h"

#include <algorithm>
#include <optional>

#include "runtime/plan/readouts.h"
#include "runtime/rejudge/program_view.h"
#include "runtime/rejudge/rescore.h"
#include "runtime/store/not_attempted.h"
#include "runtime/vm/judge.h"

namespace probe::rejudge {
namespace {

struct Watched {
  std::string name;
  std::uint32_t metric = 0;
  std::uint16_t core = 0;  // the condition below its monitor
  plan::Readout readout = plan::Readout::kOnce;
  bool is_subgoal = false;
  double before = 0;  // its value after the step before
  int first = 0;
};

class Watch {
 public:
  Watch(const plan::Plan& plan, std::uint32_t task, const EventMetrics& metrics)
      : plan_(plan), task_(plan.tasks()[task]), view_(plan, task_), judge_(plan, task) {
    for (const std::string& name : metrics.events) add(name, false);
    for (const std::string& name : metrics.subgoals) add(name, true);
  }

  Result<EpisodeEvents> run(const store::Trace& trace, std::size_t steps) {
    EpisodeEvents out;
    PROBE_TRY(judge_.begin(trace.start->starts));
    for (std::size_t i = 0; i < steps; ++i) {
      PROBE_TRY(judge_.step(trace.steps[i].sample));
      for (Watched& watched : watched_) note(watched, static_cast<int>(i) + 1, out.marks);
    }
    for (const Watched& watched : watched_) {
      if (watched.is_subgoal) {
        out.firsts.emplace_back(watched.name, watched.first);
      } else {
        const double value = judge_.value(watched.metric);
        const bool is_never = steps == 0 || plan::info(watched.readout).never == value;
        out.counts.push_back({watched.name, is_never ? std::nullopt : std::optional(value)});
      }
    }
    out.subgoals = static_cast<int>(out.firsts.size());
    for (const auto& [name, step] : out.firsts) {
      if (step == 0) break;
      ++out.reached;
      out.last = name;
    }
    return out;
  }

 private:
  void add(const std::string& name, bool is_subgoal) {
    const auto metric = plan_.find_metric(task_, name);
    if (!metric) return;
    Watched watched;
    watched.name = name;
    watched.metric = *metric;
    watched.is_subgoal = is_subgoal;
    watched.readout = static_cast<plan::Readout>(plan_.metrics(task_)[*metric].readout);
    watched.core = view_.emitted(*metric);
    if (plan::readout_of(view_.op(watched.core)) != nullptr)
      watched.core = view_.at(watched.core).a;
    watched.before = plan::info(watched.readout).never.value_or(0);
    watched_.push_back(std::move(watched));
  }

  // Whether it began with this step: one more time, or at all.
  static bool begins(const Watched& watched, double now) {
    const bool is_again =
        watched.readout == plan::Readout::kTimes || watched.readout == plan::Readout::kCount;
    return is_again ? now > watched.before : watched.first == 0 && now != watched.before;
  }

  void note(Watched& watched, int step, std::vector<EventMark>& marks) {
    const double now = judge_.value(watched.metric);
    const bool is_truth = plan::find_op(view_.at(watched.core).op)->result == plan::Kind::kBool;
    if (is_truth && begins(watched, now)) {
      if (watched.first == 0) watched.first = step;
      const std::vector<std::uint16_t> of = bodies(watched.core);
      marks.push_back({watched.name, step, names(of), of, watched.is_subgoal});
    }
    watched.before = now;
  }

  // Whose measurements make the condition true at this step.
  std::vector<std::uint16_t> bodies(std::uint16_t core) const {
    const std::vector<bool> deciding = view_.deciding(core, judge_);
    std::vector<bool> seen(view_.registers());
    std::vector<bool> named(task_.bodies.count);
    std::vector<std::uint16_t> open;
    for (std::size_t r = 0; r < seen.size(); ++r) {
      const plan::OpInfo& info = *plan::find_op(view_.at(static_cast<std::uint16_t>(r)).op);
      const bool joins = info.a == plan::Kind::kBool;
      if (deciding[r] && !joins) open.push_back(static_cast<std::uint16_t>(r));
    }
    while (!open.empty()) {
      const std::uint16_t next = open.back();
      open.pop_back();
      if (seen[next]) continue;
      seen[next] = true;
      const plan::Instruction& in = view_.at(next);
      const plan::OpInfo& info = *plan::find_op(in.op);
      if (plan::is_body(info.a)) named[in.a] = true;
      if (plan::is_body(info.b)) named[in.b] = true;
      if (plan::is_register(info.a)) open.push_back(in.a);
      if (plan::is_register(info.b)) open.push_back(in.b);
    }
    for (const auto kind :
         {plan::BodyKind::kObject, plan::BodyKind::kLink, plan::BodyKind::kPart}) {
      std::vector<std::uint16_t> of;
      for (std::uint16_t i = 0; i < named.size(); ++i) {
        const bool fits = plan_.bodies(task_)[i].kind == static_cast<std::uint32_t>(kind);
        if (named[i] && fits) of.push_back(i);
      }
      if (!of.empty()) return of;
    }
    return {};
  }

  std::string names(const std::vector<std::uint16_t>& of) const {
    std::string text;
    for (const std::uint16_t body : of)
      text += (text.empty() ? "" : ", ") + std::string(plan_.text(plan_.bodies(task_)[body].name));
    return text;
  }

  const plan::Plan& plan_;
  const plan::TaskRecord& task_;
  ProgramView view_;
  vm::Judge judge_;
  std::vector<Watched> watched_;
};

// The step of a subgoal; nothing when the task has it not.
std::optional<int> step_of(const EpisodeEvents& events, std::string_view name) {
  for (const auto& [subgoal, step] : events.firsts) {
    if (subgoal == name) return step;
  }
  return std::nullopt;
}

// The subgoals are those of a task's source and target: what happens to another role is not timed.
void tell_times(EpisodeEvents& events, double hz) {
  const auto grasped = step_of(events, kGraspedSubgoal), placed = step_of(events, kPlacedSubgoal);
  const auto seconds = [&](int steps) { return static_cast<double>(steps) / hz; };
  if (!grasped) {
    events.to_grasp.why_not = "the task has no source, and no other role is timed";
  } else if (*grasped == 0) {
    events.to_grasp.why_not = "never grasped";
  } else {
    events.to_grasp.value = seconds(*grasped);
  }
  if (!grasped) {
    events.hand_over.why_not = events.to_grasp.why_not;
  } else if (!placed) {
    events.hand_over.why_not = "the task has no target to place it on";
  } else if (*grasped == 0) {
    events.hand_over.why_not = "never grasped";
  } else if (*placed == 0) {
    events.hand_over.why_not = "never placed";
  } else if (*placed < *grasped) {
    events.hand_over.why_not = "in place before it was grasped";
  } else {
    events.hand_over.value = seconds(*placed - *grasped);
  }
}

}  // namespace

Result<EpisodeEvents> events_of(const plan::Plan& plan, std::uint32_t task,
                                const store::Trace& trace, const EventMetrics& metrics) {
  PROBE_ASSIGN(const Rescored score, rescore(plan, task, trace));
  EpisodeEvents untold;
  if (score.invalid || !trace.start) {
    const std::string why = score.invalid.value_or("it never began");
    untold.untold = (store::is_not_attempted(why) ? "" : "invalid: ") + why;
    return untold;
  }
  PROBE_ASSIGN(EpisodeEvents out, Watch(plan, task, metrics).run(trace, score.steps.size()));
  std::ranges::stable_sort(out.marks, {}, &EventMark::step);
  std::vector<Vec3> path = {trace.start->sample.tcp};
  for (std::size_t i = 0; i < score.steps.size(); ++i) path.push_back(trace.steps[i].sample.tcp);
  out.motion = motion_of(path, trace.header.control_hz);
  tell_times(out, trace.header.control_hz);
  return out;
}

std::string event_words(std::string_view name) {
  std::string words(name);
  std::ranges::replace(words, '_', ' ');
  return words;
}

}  // namespace probe::rejudge
