#include "runtime/studio/player.h"

#include <fmt/format.h>
#include <stdlib.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <mutex>

#include "runtime/base/clock.h"
#include "runtime/plan/later.h"
#include "runtime/rejudge/explain.h"
#include "runtime/rejudge/explain_json.h"
#include "runtime/run/episode.h"
#include "runtime/run/policies.h"
#include "runtime/studio/message.h"

namespace probe::studio {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostUnread = std::size_t{4} << 20;  // bytes; about three pictures

// A folder for the trace, gone with this.
class ScratchFolder {
 public:
  static Result<std::unique_ptr<ScratchFolder>> make() {
    std::error_code error;
    std::string path = (fs::temp_directory_path(error) / "vlaprobe-studio-XXXXXX").string();
    if (error || ::mkdtemp(path.data()) == nullptr)
      return Failure{Fault::kIo, "cannot be made", path};
    return std::make_unique<ScratchFolder>(path);
  }
  explicit ScratchFolder(std::string path) : path_(std::move(path)) {}
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  ~ScratchFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  std::string file(const char* name) const { return path_ + "/" + name; }

 private:
  std::string path_;
};

constexpr std::chrono::milliseconds kLetGo{300};

}  // namespace

// One episode while it is played and looked at. Its thread owns it, too, and may outlive the player.
struct Player::Run {
  Tell tell;
  Unread unread;
  std::atomic<bool> stop = false;
  std::mutex mutex;  // of what follows
  std::condition_variable ends;
  bool is_over = false, is_let_go = false;
  std::unique_ptr<Episode> seen;  // that can be looked at

  // Whoever was let go says no more.
  void say_frame(wire::Frame frame) {
    const std::lock_guard lock(mutex);
    if (!is_let_go) tell(std::move(frame));
  }
  void say(Json json) { say_frame(message(json)); }

  void play(std::shared_ptr<const Shown> shown, const PlayWish& wish);
  // What is to be said of it, which is {kind: "played", ...}.
  Result<Json> play_whole(const PlayWish& wish, Episode& episode);
};

// Tells the page of each step and keeps the state that it can be drawn from again.
class Player::Watcher final : public show::FrameSink {
 public:
  Watcher(Run& run, Episode& episode) : run_(run), episode_(episode) {}

  Status frame(std::span<const stage::CameraFrame> frames, int step,
               std::span<const store::MetricValue> metrics) override {
    if (run_.stop) return Failure{Fault::kUsage, "stopped", ""};
    episode_.states.push_back(episode_.stage->save());
    Json values = Json::array();
    for (const store::MetricValue& metric : metrics) values.push_back(metric.value);
    Json json = {{"kind", "step"}, {"step", step}, {"values", std::move(values)}};
    if (run_.unread() > kMostUnread) {
      run_.say(std::move(json));
    } else {
      run_.say_frame(picture_message(std::move(json), frames));
    }
    return {};
  }

 private:
  Run& run_;
  Episode& episode_;
};

Player::~Player() { let_go(false); }

void Player::stop() { let_go(true); }

void Player::let_go(bool is_told) {
  if (!thread_.joinable()) return;
  run_->stop = true;
  std::unique_lock lock(run_->mutex);
  if (run_->ends.wait_for(lock, kLetGo, [&] { return run_->is_over; })) {
    lock.unlock();
    return thread_.join();
  }
  run_->is_let_go = true;
  lock.unlock();
  thread_.detach();
  run_.reset();
  if (is_told)
    say({{"kind", "stopped"}, {"message", "stopped"}});
}

void Player::say(Json json) const { tell_(message(json)); }

void Player::play(std::shared_ptr<const Shown> shown, PlayWish wish) {
  let_go(false);
  run_ = std::make_shared<Run>();
  run_->tell = tell_;
  run_->unread = unread_;
  thread_ = std::thread([run = run_, shown = std::move(shown), wish = std::move(wish)]() mutable {
    run->play(std::move(shown), wish);
    {
      const std::lock_guard lock(run->mutex);
      run->is_over = true;
    }
    run->ends.notify_all();
  });
}

void Player::Run::play(std::shared_ptr<const Shown> shown, const PlayWish& wish) {
  auto episode = std::make_unique<Episode>();
  episode->shown = std::move(shown);
  auto played = play_whole(wish, *episode);
  if (!played) return say({{"kind", "stopped"}, {"message", to_text(played.failure())}});
  {
    const std::lock_guard lock(mutex);
    seen = std::move(episode);
  }
  say(std::move(*played));  // from now on it can be looked at
}

Result<Json> Player::Run::play_whole(const PlayWish& wish, Episode& episode) {
  const plan::Plan& plan = episode.shown->plan;
  const auto task = plan.find_task(wish.task);
  if (!task) return Failure{Fault::kUsage, "is not in the text any more", wish.task};
  const plan::TaskRecord& record = plan.tasks()[*task];
  if (wish.start >= record.episodes.count)
    return Failure{Fault::kUsage, "has no start " + std::to_string(wish.start), wish.task};
  episode.task = *task;
  episode.wish = wish;
  PROBE_ASSIGN(const auto choice, run::choose_policy(wish.policy));
  if (choice.traits.recorded)
    return Failure{Fault::kUsage, "has the actions of a run, which is of another plan",
                   wish.policy};
  PROBE_ASSIGN(const auto policy, run::make_policy(choice));
  const std::uint32_t tasks[] = {*task};
  PROBE_ASSIGN(const auto assets,
               stage::SharedAssets::load(plan, episode.shown->asset_root, tasks));
  PROBE_ASSIGN(episode.stage, stage::Stage::create(plan, *task, assets));
  const run::EpisodeJob job{*task, wish.start, wish.seed};
  const store::TraceHeader header =
      run::make_trace_header(plan, job, *episode.stage, wish.policy, "");
  Json names = Json::array();
  for (const store::TraceHeader::Metric& metric : header.metrics)
    names.push_back({{"name", metric.name}, {"truth", metric.is_bool}});
  say({{"kind", "playing"},
       {"task", header.task},
       {"start", wish.start},
       {"policy", wish.policy},
       {"prompt", plan::whole_instruction(header.prompt, header.later)},
       {"horizon", header.horizon},
       {"hz", header.control_hz},
       {"metrics", std::move(names)}});
  PROBE_ASSIGN(const auto scratch, ScratchFolder::make());
  const std::string path = scratch->file("episode.trace");
  PROBE_ASSIGN(const auto trace, store::TraceWriter::create(path, header));
  Watcher watcher(*this, episode);
  const auto begun = std::chrono::steady_clock::now();
  PROBE_ASSIGN(const run::Played played,
               run::run_episode(*episode.stage, plan, job, wish.policy, *policy, *trace, &watcher));
  PROBE_ASSIGN(episode.trace, store::read_trace(path));
  Json said = {{"kind", "played"},
               {"steps", played.row.steps},
               {"invalid", played.row.invalid ? Json(*played.row.invalid) : Json()},
               {"remark", played.row.remark ? Json(*played.row.remark) : Json()},
               {"seconds", seconds_since(begun)}};
  Json values = Json::array();
  for (const store::MetricValue& metric : played.row.metrics) values.push_back(metric.value);
  said["values"] = std::move(values);
  if (played.row.remark) episode.remark = *played.row.remark;
  return said;
}

void Player::look(int step) {
  if (run_ == nullptr) return;
  const std::lock_guard lock(run_->mutex);
  Episode* const episode = run_->seen.get();
  if (episode == nullptr || step < 0 || static_cast<std::size_t>(step) >= episode->states.size())
    return;
  stage::Stage& stage = *episode->stage;
  auto restored = stage.restore(episode->states[static_cast<std::size_t>(step)]);
  if (!restored) return say({{"kind", "stopped"}, {"message", to_text(restored.failure())}});
  const auto seen = stage.observe();
  if (!seen) return say({{"kind", "stopped"}, {"message", to_text(seen.failure())}});
  tell_(picture_message({{"kind", "moment"}, {"step", step}}, stage.frames()));
}

std::optional<Player::Start> Player::start_at(int step) {
  if (run_ == nullptr) return std::nullopt;
  const std::lock_guard lock(run_->mutex);
  Episode* const episode = run_->seen.get();
  if (episode == nullptr || step < 0 || static_cast<std::size_t>(step) >= episode->states.size())
    return std::nullopt;
  stage::Stage& stage = *episode->stage;
  if (!stage.restore(episode->states[static_cast<std::size_t>(step)])) return std::nullopt;
  const plan::Plan& plan = episode->shown->plan;
  const plan::TaskRecord& task = plan.tasks()[episode->task];
  const plan::RobotRecord& robot = plan.robots()[plan.scenes()[task.scene].robot];
  std::string table = "start,object,x_m,y_m,z_m,qw,qx,qy,qz,value\n";
  const auto objects = stage.objects();
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const Vec3& at = objects[i].position;
    const Quat turn = objects[i].rotation.normalized();
    table += fmt::format("0,{},{},{},{},{},{},{},{},\n", plan.text(plan.bodies(task)[i].name),
                         at.x(), at.y(), at.z(), turn.w(), turn.x(), turn.y(), turn.z());
  }
  const std::vector<std::string> names = stage.joint_names();
  const auto q = stage.q();
  for (std::size_t i = 0; i < names.size(); ++i) {
    const bool is_robots = i < plan.drives(robot).size();
    table += fmt::format("0,{}{}{},,,,,,,,{}\n", is_robots ? plan.text(robot.name) : "",
                         is_robots ? "." : "", names[i], q[i]);
  }
  return Start{std::string(plan.text(task.name)), std::move(table)};
}

void Player::why(const std::string& metric) {
  const std::shared_ptr<Run> run = run_;
  const Episode* episode = nullptr;
  std::unique_lock<std::mutex> lock;
  if (run != nullptr) {
    lock = std::unique_lock(run->mutex);
    episode = run->seen.get();
  }
  if (episode == nullptr) return say({{"kind", "why"}, {"message", "no episode was played"}});
  auto metrics = rejudge::explain(episode->shown->plan, episode->task, episode->trace, metric);
  if (!metrics) return say({{"kind", "why"}, {"message", to_text(metrics.failure())}});
  rejudge::EpisodeWhy why;
  why.task = episode->trace.header.task;
  why.episode = episode->trace.header.episode;
  why.seed = episode->trace.header.seed;
  why.steps = static_cast<int>(episode->trace.steps.size());
  if (!episode->remark.empty()) why.remark = episode->remark;
  why.metrics = std::move(*metrics);
  Json json = rejudge::to_json(why);
  json["kind"] = "why";
  say(std::move(json));
}

}  // namespace probe::studio
