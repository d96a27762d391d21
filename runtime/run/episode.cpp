// One episode from reset to verdict.
#include "runtime/run/episode.h"

#include <chrono>
#include <cmath>
#include <exception>

#include "runtime/base/clock.h"
#include "runtime/base/hash_number.h"
#include "runtime/base/percent.h"
#include "runtime/plan/later.h"
#include "runtime/store/not_attempted.h"
#include "runtime/vm/claims.h"

namespace probe::run {
namespace {

using Clock = std::chrono::steady_clock;

std::string reason(const char* who, const Failure& failure) {
  return who + (": " + to_text(failure));
}

// Why an episode ended early, of two kinds: it is invalid, or the disk failed us.
struct Outcome {
  std::optional<std::string> invalid;
  std::optional<Failure> broken;
  std::optional<Fault> policy_fault = {};
};

Outcome policy_failed(const Failure& failure) {
  // Of a world that does not wait and cannot keep up.
  if (failure.code == Fault::kWorld) return {reason("world", failure), {}};
  if (failure.code == Fault::kNoSkill)
    return {std::string(store::kNotAttempted) + to_text(failure), {}, failure.code};
  return {reason("policy", failure), {}, failure.code};
}

class Loop {
 public:
  Loop(stage::Stage& stage, const plan::Plan& plan, const EpisodeJob& job, policy::Policy& policy,
       store::TraceWriter& trace, show::FrameSink* frames, store::ResultRow& row)
      : stage_(stage),
        plan_(plan),
        task_(plan.tasks()[job.task]),
        episode_(plan.episodes(task_)[job.index]),
        job_(job),
        policy_(policy),
        trace_(trace),
        frames_(frames),
        row_(row) {
    for (std::size_t i = 0; i < stage.told().count(); ++i)
      prompt_hashes_.push_back(sha256(stage.told().text(i)));
    for (std::size_t i = 0; i < stage.judge().metric_count(); ++i) {
      const auto metric = static_cast<std::uint32_t>(i);
      row_.metrics.push_back({stage.judge().metric_name(metric),
                              stage.judge().metric_type(metric) == plan::MetricType::kBool, 0});
    }
  }

  Outcome run(int steps, double most_held) {
    Outcome outcome = begin();
    for (int step = 0; step < steps && !outcome.invalid && !outcome.broken; ++step) {
      if (stage_.judge().ended()) break;
      outcome = this->step(step);
    }
    if (!outcome.invalid && !outcome.broken) outcome = check_held(most_held);
    if (!outcome.invalid && !outcome.broken && frames_ != nullptr) outcome = last_frame(row_.steps);
    if (row_.steps > 0) row_.frames_sha256 = to_hex(frames_hash_.finish());
    return outcome;
  }

  // After run(), however it went: the policy hears of it and says what left for a server.
  void leave(Outcome* outcome) {
    if (!policy_begun_) return;
    policy::EpisodeEnd end{!outcome->invalid && !outcome->broken, false, row_.steps};
    for (const store::MetricValue& metric : row_.metrics) {
      if (metric.name == "success") end.success = end.completed && metric.value != 0;
    }
    policy_.end(end);
    // What failed for another reason keeps it.
    if (const auto spoiled = policy_.spoiled(); spoiled && !outcome->invalid && !outcome->broken)
      *outcome = policy_failed(*spoiled);
    if (!outcome->invalid && !outcome->broken && !end.success) row_.remark = policy_.remark();
    if (const auto delivery = policy_.delivery()) {
      row_.sent_prompt_sha256 = delivery->prompt_sha256;
      row_.sent_image_sha256 = delivery->image_sha256;
    }
  }

 private:
  // The judge is the stage's, but a row says whose failure it was.
  static Outcome stage_failed(const Failure& failure) {
    return {reason(failure.code == Fault::kJudge ? "judge" : "world", failure), {}};
  }

  Outcome begin() {
    if (auto reset = stage_.reset(job_.index); !reset) return stage_failed(reset.failure());
    store::TraceStart start;
    start.q.assign(stage_.q().begin(), stage_.q().end());
    start.starts.assign(stage_.body_starts().begin(), stage_.body_starts().end());
    start.sample = stage_.sample();
    start.state_hash = stage_.state_hash();
    if (auto written = trace_.start(start); !written) return {{}, written.failure()};
    // An instruction that is not so where things have come to rest is never said to a policy.
    if (auto so = vm::check_claims(plan_, job_.task, start.starts, start.sample); !so)
      return {reason("start", so.failure()), {}};

    policy::EpisodeStart first = stage_.introduction();
    first.seed = job_.seed;
    first.draw_seed = draw_seed(job_.seed, Sha256{episode_.episode_id});
    policy_begun_ = true;
    if (auto begun = policy_.begin(first); !begun) return policy_failed(begun.failure());
    return {};
  }

  Outcome step(int number) {
    store::TraceStep record;
    auto clock = Clock::now();
    const auto observation = stage_.observe();
    if (!observation) return {reason("picture", observation.failure()), {}};
    record.image_hash = picture_hash(stage_.frames());
    record.prompt_hash = prompt_hashes_[stage_.told().sentence()];
    record.render_s = seconds_since(clock);
    if (number == 0) row_.image_sha256 = to_hex(record.image_hash);
    if (frames_ != nullptr) {
      if (auto shown = frames_->frame(stage_.frames(), number, row_.metrics); !shown)
        return {{}, shown.failure()};
    }

    clock = Clock::now();
    const auto action = policy_.act(*observation);
    if (!action) return policy_failed(action.failure());
    for (const double value : *action) {
      if (std::isfinite(value)) continue;
      return policy_failed({Fault::kPolicy, "an action with a number that is not finite", ""});
    }
    if (const std::size_t wanted = stage_.action_space().size(); action->size() != wanted) {
      return policy_failed({Fault::kPolicy,
                            "an action of " + std::to_string(action->size()) +
                                " numbers, the robot's have " + std::to_string(wanted),
                            ""});
    }
    record.action = *action;
    if (const policy::LiveStep* live = policy_.live_step()) {
      record.live = *live;
      live_.add(number, *live);
    }
    record.policy_s = seconds_since(clock);

    clock = Clock::now();
    if (auto stepped = stage_.step(*action); !stepped) return stage_failed(stepped.failure());
    record.physics_s = seconds_since(clock);
    const auto values = stage_.judge().values();
    for (std::size_t i = 0; i < values.size(); ++i) row_.metrics[i].value = values[i];
    record.metrics.assign(values.begin(), values.end());
    record.q.assign(stage_.q().begin(), stage_.q().end());
    record.u.assign(stage_.u().begin(), stage_.u().end());
    record.sample = stage_.sample();
    record.state_hash = stage_.state_hash();
    if (auto written = trace_.step(record); !written) return {{}, written.failure()};
    frames_hash_.hash(record.image_hash);
    row_.steps = number + 1;
    return {};
  }

  // A policy that is hardly ever in time was hardly asked for what its row says; asking it once
  // more would not make it faster.
  Outcome check_held(double most_held) const {
    if (live_.held_share() <= most_held) return {};
    return policy_failed({Fault::kUsage,
                          "slower than its rate: " + to_text(live_) + ", and the limit is " +
                              decimal_text(100 * most_held, 1) + " % (--live-most-held)",
                          ""});
  }

  Outcome last_frame(int number) {
    if (const auto seen = stage_.observe(); !seen) return {reason("picture", seen.failure()), {}};
    if (auto shown = frames_->frame(stage_.frames(), number, row_.metrics); !shown)
      return {{}, shown.failure()};
    return {};
  }

  stage::Stage& stage_;
  const plan::Plan& plan_;
  const plan::TaskRecord& task_;
  const plan::EpisodeRecord& episode_;
  const EpisodeJob& job_;
  policy::Policy& policy_;
  store::TraceWriter& trace_;
  show::FrameSink* frames_;
  store::ResultRow& row_;
  bool policy_begun_ = false;
  std::vector<Sha256> prompt_hashes_;  // by sentence of the instruction
  Hasher frames_hash_;
  policy::LiveFigures live_;
};

// Adapters catch what libraries throw; this is for what they missed, so that one episode cannot end
// a run of thousands.
Outcome run_guarded(Loop& loop, int steps, double most_held) {
  Outcome outcome;
  try {
    outcome = loop.run(steps, most_held);
  } catch (const std::exception& error) {
    outcome = {std::string("exception: ") + error.what(), {}};
  } catch (...) {
    outcome = {"exception of unknown type", {}};
  }
  try {
    loop.leave(&outcome);
  } catch (...) {  // the episode is over; the policy's next begin() starts anew
  }
  return outcome;
}

}  // namespace

store::EpisodeKey key_of(const plan::Plan& plan, const EpisodeJob& job) {
  return {std::string(plan.text(plan.tasks()[job.task].name)), static_cast<int>(job.index),
          job.seed};
}

std::uint64_t draw_seed(int seed, const Sha256& episode_id) {
  const Sha256 hash = Hasher()
                          .u64(static_cast<std::uint64_t>(static_cast<std::int64_t>(seed)))
                          .hash(episode_id)
                          .finish();
  return little_endian_number(hash);
}

Sha256 picture_hash(std::span<const stage::CameraFrame> frames) {
  if (frames.size() == 1) return sha256(std::as_bytes(frames[0].frame.rgb));
  Hasher all;
  for (const stage::CameraFrame& seen : frames) all.hash(sha256(std::as_bytes(seen.frame.rgb)));
  return all.finish();
}

store::TraceHeader make_trace_header(const plan::Plan& plan, const EpisodeJob& job,
                                     const stage::Stage& stage, const std::string& policy,
                                     const std::string& fingerprint,
                                     const std::optional<policy::LiveTerms>& live) {
  const plan::TaskRecord& task = plan.tasks()[job.task];
  const plan::EpisodeRecord& episode = plan.episodes(task)[job.index];
  const plan::RobotRecord& robot = plan.robots()[plan.scenes()[task.scene].robot];
  store::TraceHeader header;
  header.plan_root = plan.root();
  header.episode_id = Sha256{episode.episode_id};
  header.start_id = Sha256{episode.start_id};
  header.task = std::string(plan.text(task.name));
  header.episode = static_cast<std::int32_t>(job.index);
  header.seed = job.seed;
  header.policy = policy;
  header.prompt = std::string(plan.text(task.prompt));
  for (const plan::LaterRecord& later : plan::later_of(plan.tables(), job.task))
    header.later.emplace_back(plan.text(later.text));
  header.horizon = task.horizon;
  header.control_hz = robot.control_hz;
  header.bodies = stage.body_names();
  header.joints = stage.joint_names();
  for (const plan::MetricRecord& metric : plan.metrics(task)) {
    header.metrics.push_back({std::string(plan.text(metric.name)),
                              metric.type == static_cast<std::uint32_t>(plan::MetricType::kBool)});
  }
  if (const robot::ActionSpace& space = stage.action_space(); space.is_of_joints()) {
    header.joint_actions = {std::string(robot::row_of(stage.robot().law).word),
                            static_cast<std::uint32_t>(space.size())};
  }
  header.live = live;
  header.fingerprint = fingerprint;
  return header;
}

Result<Played> run_episode(stage::Stage& stage, const plan::Plan& plan, const EpisodeJob& job,
                           const std::string& policy_name, policy::Policy& policy,
                           store::TraceWriter& trace, show::FrameSink* frames, int steps,
                           double most_held) {
  const plan::TaskRecord& task = plan.tasks()[job.task];
  const plan::EpisodeRecord& episode = plan.episodes(task)[job.index];
  store::ResultRow row;
  row.task = std::string(plan.text(task.name));
  row.episode = static_cast<int>(job.index);
  row.seed = job.seed;
  row.policy = policy_name;
  row.prompt_sha256 = to_hex(sha256(plan.text(task.prompt)));
  row.episode_id = to_hex(Sha256{episode.episode_id});
  row.start_id = to_hex(Sha256{episode.start_id});

  Loop loop(stage, plan, job, policy, trace, frames, row);
  const Outcome outcome =
      run_guarded(loop, steps < 0 ? static_cast<int>(task.horizon) : steps, most_held);
  if (outcome.broken) return *outcome.broken;
  row.invalid = outcome.invalid;
  PROBE_ASSIGN(const Sha256 hash,
               trace.finish({static_cast<std::uint32_t>(row.steps), row.metrics, row.invalid}));
  row.trace_sha256 = to_hex(hash);
  return Played{std::move(row), outcome.policy_fault};
}

}  // namespace probe::run
