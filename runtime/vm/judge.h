// The judge: runs a task's metric program once a control step over measurements. Total,
// allocation-free after construction and bit-identical wherever the measurements are. Knows nothing
// of physics, files or meaning.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/plan/isa.h"
#include "runtime/plan/plan.h"
#include "runtime/vm/sample.h"

namespace probe::vm {

// What a judge remembers of an episode so far. Of no meaning to the judge of another task.
struct JudgeState {
  struct Monitor {
    double value = 0;
    bool started = false;
  };
  std::vector<Monitor> monitors;
  std::vector<double> values;  // by metric
  bool decided = false;        // Judge::decided()
};

class Judge {
 public:
  // `task` indexes plan.tasks(). Keeps no reference to the plan.
  Judge(const plan::Plan& plan, std::uint32_t task);
  // By another program than the task's own, `program` of plan.programs(): what a question about the
  // task's recorded episodes is answered by.
  Judge(const plan::Plan& plan, std::uint32_t task, std::uint32_t program);

  // Starts an episode: clears all monitors; `starts` holds one entry a body of the task, in the
  // plan's order. Bodies that follow are measured and not judged: fixtures that the plan does not
  // know. Fails (kJudge) when bodies are missing or a number is not finite.
  Status begin(std::span<const BodyStart> starts);

  // One control step, after physics. Fails (kJudge) when the sample does not fit the task or
  // holds a number that is not finite: the episode is invalid then, and the values are those of the
  // step before.
  Status step(const StepSample& sample);

  // The episode as it stands, and back to it: `starts` are those it began with. restore() fails
  // (kJudge) as begin() does, and on the state of another task.
  JudgeState save() const { return {states_, values_, decided()}; }
  Status restore(std::span<const BodyStart> starts, const JudgeState& state);

  // By metric index, as last emitted; truths are 0 or 1. Zero before the first step.
  std::span<const double> values() const { return values_; }
  double value(std::uint32_t metric) const { return values_[metric]; }
  bool truth(std::uint32_t metric) const { return values_[metric] != 0.0; }

  // That no further step can change any metric, whatever it measures: a `once` that was true, an
  // `always` that was broken, and what hangs on such alone. False before the first step.
  bool decided() const;

  // That the task's `ends when` holds after this step: the episode is over. False of a task that
  // has none, and before the first step.
  bool ended() const { return ends_ && truth(*ends_); }

  std::size_t metric_count() const { return metrics_.size(); }
  const std::string& metric_name(std::uint32_t metric) const { return metrics_[metric].name; }
  plan::MetricType metric_type(std::uint32_t metric) const { return metrics_[metric].type; }
  std::optional<std::uint32_t> find_metric(std::string_view name) const;

  // What register `index` held after the last step, for explanations: x alone of a number, 0 or 1
  // of a truth.
  Vec3 register_value(std::size_t index) const;

 private:
  // One instruction, resolved: constants and contact pairs by slot.
  struct Step {
    plan::Op op = plan::Op::kEND;
    std::uint16_t dst = 0, a = 0, b = 0;
  };
  struct Metric {
    std::string name;
    plan::MetricType type = plan::MetricType::kBool;
  };
  struct Register {
    double x = 0, y = 0, z = 0;
  };
  // A pair of bodies some instruction asks about, a < b, and at this step what a exerts on b and b
  // on a. Both are kept, because without contact both are +0.
  struct Pair {
    std::uint16_t a = 0, b = 0;
    Vec3 push = Vec3::Zero(), push_back = Vec3::Zero();
  };

  Status check(const StepSample& sample) const;
  void read_contacts(std::span<const ContactSample> contacts);
  // What a body is compared with: where it lay, or where its own motion has it.
  const Vec3& start_of(std::uint16_t body, const StepSample& sample) const;
  void run(std::span<const Step> steps, const StepSample& sample);

  std::string task_name_;
  std::size_t bodies_ = 0;
  std::size_t first_joint_ = 0;        // of fixtures, behind the robot's
  std::size_t joints_ = 0;             // that a sample must have
  std::vector<std::uint16_t> movers_;  // bodies that move by themselves, of which START is asked
  std::vector<double> constants_;
  std::vector<std::uint16_t> hold_;  // per state, HOLD's n
  std::vector<Metric> metrics_;
  std::optional<std::uint32_t> ends_;  // the metric that ends an episode
  std::vector<Step> once_;             // depend on constants and the start alone
  std::vector<Step> each_;
  std::vector<Pair> pairs_;  // ascending
  std::vector<BodyStart> starts_;
  std::vector<Register> registers_;
  std::vector<JudgeState::Monitor> states_;
  std::vector<double> values_, emitted_;
  bool begun_ = false;
  bool stepped_ = false;  // since begin() or restore()
  bool decided_ = false;  // as restored
};

}  // namespace probe::vm
