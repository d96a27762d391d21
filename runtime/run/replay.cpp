// Plan and trace from the folder, actions from the trace, everything else computed again.
#include "runtime/run/replay.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <memory>
#include <utility>

#include "runtime/base/paths.h"
#include "runtime/policy/live.h"
#include "runtime/run/episode.h"
#include "runtime/scene/image.h"
#include "runtime/show/episode_video.h"
#include "runtime/show/picture_grid.h"
#include "runtime/store/fingerprint.h"
#include "runtime/store/run_plan.h"
#include "runtime/store/store.h"
#include "runtime/store/stored_trace.h"
#include "runtime/store/trace_compare.h"

namespace probe::run {
namespace {

class TraceActions final : public policy::Policy {
 public:
  explicit TraceActions(const store::Trace& trace) : trace_(trace) {}
  Status begin(const policy::EpisodeStart&) override { return {}; }
  Result<policy::Action> act(const policy::Observation& observation) override {
    return trace_.steps[static_cast<std::size_t>(observation.step)].action;
  }

 private:
  const store::Trace& trace_;
};

// The answers of a live episode, each in the step in which the trace has it take effect, with the
// actions that were done of it: what asks, holds and goes on in between is for the rule of live
// worlds to find again.
class TraceAnswers final : public policy::Answerer {
  using Time = policy::LiveClock::time_point;

 public:
  explicit TraceAnswers(const store::Trace& trace)
      : steps_(trace.steps),
        period_(static_cast<std::int64_t>(std::llround(1e9 / trace.header.control_hz))) {}

  Status ask(const policy::Observation& seen, Time) override {
    const int asked = seen.step;
    const auto is_answer = [&](const store::TraceStep& step) {
      return std::ranges::any_of(step.live->answers, [&](const policy::LiveAnswer& answer) {
        return answer.asked == asked;
      });
    };
    // No answer takes effect before it is asked for.
    const auto begin = std::find_if(steps_.begin() + asked, steps_.end(), is_answer);
    answer_.reset();
    if (begin == steps_.end()) return {};  // the episode ended before it came
    const auto effect = begin - steps_.begin();
    const policy::LiveSource source = begin->live->source;
    Answer answer;
    answer.came = Time{} + effect * period_;
    if (begin->live->answers.back().asked != asked) {
      answer.actions.emplace_back();  // one that came right behind it was done instead
    } else if (source == policy::LiveSource::kLate) {
      answer.actions.push_back(said(begin->action));
    } else if (source == policy::LiveSource::kAnswer) {
      answer.actions.resize(static_cast<std::size_t>(effect - asked));  // their time was past
      auto step = begin;
      do {
        answer.actions.push_back(said((step++)->action));
      } while (step != steps_.end() && step->live->answers.empty() &&
               step->live->source == policy::LiveSource::kAnswer);
    }
    answer_ = std::move(answer);
    return {};
  }
  Result<std::optional<Answer>> wait(Time until) override {
    // Asked without an end, as of an answer whose delay is given: one that came too late is none.
    if (!answer_ && until == Time::max()) return std::optional(Answer{{}, Time{}});
    if (!answer_ || answer_->came >= until) return std::optional<Answer>();
    return std::exchange(answer_, std::nullopt);
  }
  Result<policy::Action> convert(const Said& said, const policy::Observation&) override {
    if (said.empty())
      return Failure{Fault::kStore, "the trace has no action of an answer that it does", ""};
    return policy::Action(std::span<const double>(said));
  }
  void done(const policy::Action&, const policy::Observation&) override {}
  int steps_between(int asked) const override {
    for (std::size_t i = static_cast<std::size_t>(asked) + 1; i < steps_.size(); ++i) {
      if (steps_[i].live->asks) return static_cast<int>(i) - asked;
    }
    return static_cast<int>(steps_.size());
  }

 private:
  static Said said(const policy::Action& action) { return {action.begin(), action.end()}; }

  const std::vector<store::TraceStep>& steps_;
  std::chrono::nanoseconds period_;
  std::optional<Answer> answer_;
};

// The same for a world that gives every answer its delay itself.
class TraceHalves final : public policy::Policy {
 public:
  explicit TraceHalves(const store::Trace& trace) : answers_(trace) {}
  Status begin(const policy::EpisodeStart&) override { return {}; }
  Result<policy::Action> act(const policy::Observation&) override {
    return Failure{Fault::kInternal, "a recorded answer is asked for by halves", ""};
  }
  policy::Answerer* answerer() override { return &answers_; }

 private:
  TraceAnswers answers_;
};

std::unique_ptr<policy::Policy> recorded_policy(const store::Trace& trace) {
  const auto& live = trace.header.live;
  if (!live) return std::make_unique<TraceActions>(trace);
  // When an answer came on the wall clock only the trace knows; a given delay is counted anew.
  if (!live->delay_s) return policy::make_live(std::make_unique<TraceAnswers>(trace));
  return policy::make_live(std::make_unique<TraceHalves>(trace), *live);
}

// Hands frames to the video and keeps the one that was asked for.
class ReplayPictures final : public show::FrameSink {
 public:
  ReplayPictures(const store::TraceHeader& header, const ReplayOptions& options)
      : options_(options) {
    if (!options.video.empty()) video_.emplace(header, options.video, options.camera);
  }
  Status frame(std::span<const stage::CameraFrame> frames, int step,
               std::span<const store::MetricValue> metrics) override {
    if (!options_.png.empty() && step == options_.png_step) {
      PROBE_ASSIGN(const show::Picture picture, show::show_frames(frames, options_.camera));
      PROBE_TRY(scene::write_png(options_.png, picture.width, picture.height, picture.rgb));
    }
    return video_ ? video_->frame(frames, step, metrics) : Status();
  }
  Status finish() { return video_ ? video_->finish() : Status(); }

 private:
  const ReplayOptions& options_;
  std::optional<show::EpisodeVideo> video_;
};

// A picture's folder is not made: a slip of the pen should not leave folders behind.
Status check_folder_of(const std::string& file, const char* option) {
  const auto folder = std::filesystem::path(file).parent_path();
  if (file.empty() || folder.empty() || is_folder(folder.string())) return {};
  return Failure{Fault::kUsage, "there is no folder `" + folder.string() + "` to write into",
                 option};
}

Result<EpisodeJob> find_job(const plan::Plan& plan, const store::Trace& trace,
                            const std::string& dir) {
  const auto task = plan.find_task(trace.header.task);
  const Failure stranger{Fault::kStore, "its plan is not the one of its traces",
                         store::plan_path(dir)};
  if (!task || trace.header.plan_root != plan.root()) return stranger;
  const auto index = static_cast<std::uint32_t>(trace.header.episode);
  if (index >= plan.episodes(plan.tasks()[*task]).size()) return stranger;
  return EpisodeJob{*task, index, trace.header.seed};
}

}  // namespace

Result<ReplayReport> replay(const std::string& dir, const std::string& task, int episode,
                            std::optional<int> seed, const ReplayOptions& options) {
  PROBE_TRY(check_folder_of(options.video, "--video"));
  PROBE_TRY(check_folder_of(options.png, "--png"));
  if (auto record = store::read_run_record(dir); !record) return record.failure();
  PROBE_ASSIGN(const plan::Plan plan, store::open_run_plan(dir));
  // Rows have the plan's name; the suite's prefix is understood too.
  std::string name = task;
  if (const auto found = plan.find_task(task))
    name = std::string(plan.text(plan.tasks()[*found].name));
  PROBE_ASSIGN(const store::StoredTrace stored, store::find_trace(dir, name, episode, seed));
  const store::Trace& trace = stored.trace;
  const int steps = static_cast<int>(trace.steps.size());
  if (!options.png.empty() && (options.png_step < 0 || options.png_step > steps)) {
    return Failure{Fault::kUsage,
                   "the episode has pictures 0 .. " + std::to_string(steps) + ", not " +
                       std::to_string(options.png_step),
                   "--step"};
  }
  PROBE_ASSIGN(const EpisodeJob job, find_job(plan, trace, dir));

  ReplayReport report;
  report.seed = job.seed;
  PROBE_ASSIGN(const store::Fingerprint recorded,
               store::fingerprint_from_json(trace.header.fingerprint));
  report.fingerprint_differences =
      store::differences(recorded, store::take_fingerprint(stage::asset_digest(plan)));

  PROBE_ASSIGN(const AssetRoot root, store::find_run_assets(dir, options.assets));
  const std::uint32_t tasks[] = {job.task};
  PROBE_ASSIGN(auto assets, stage::SharedAssets::load(plan, root, tasks));
  PROBE_ASSIGN(auto stage, stage::Stage::create(plan, job.task, std::move(assets)));

  const std::unique_ptr<policy::Policy> actions = recorded_policy(trace);
  store::TraceComparer comparer(trace);
  ReplayPictures pictures(trace.header, options);
  PROBE_ASSIGN(const Played played, run_episode(*stage, plan, job, trace.header.policy, *actions,
                                                comparer, &pictures, steps));
  const store::ResultRow& row = played.row;
  PROBE_TRY(pictures.finish());
  report.steps = row.steps;
  report.difference = comparer.difference();
  if (report.difference.empty() && row.invalid && steps > row.steps)
    report.difference = *row.invalid;
  report.identical = report.difference.empty();
  return report;
}

}  // namespace probe::run
