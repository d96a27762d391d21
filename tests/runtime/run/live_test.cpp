// Runs whose world does not wait: what is stored of delays repeats them bit for bit, in one go or
// after a kill, and never mixes with runs that wait.
#include <doctest/doctest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <mutex>
#include <thread>

#include "runtime/run/episode.h"
#include "runtime/run/recorded.h"
#include "runtime/run/replay.h"
#include "runtime/run/run.h"
#include "runtime/servers/known_observations.h"
#include "runtime/servers/protocol.h"
#include "runtime/servers/served.h"
#include "runtime/show/frame_sink.h"
#include "runtime/stage/stage.h"
#include "runtime/store/merge.h"
#include "runtime/store/proof.h"
#include "runtime/store/store.h"
#include "runtime/store/trace.h"
#include "tests/runtime/run/run_checks.h"
#include "tests/runtime/run/table_plan.h"
#include "tests/runtime/run/temporary_folder.h"
#include "tests/runtime/store/sample_run.h"

namespace probe::run {
using namespace probe::servers;
namespace {

RunOptions live_options(const std::string& out, const std::string& policy,
                        std::optional<double> delay_s, double most_held = 1) {
  RunOptions options = options_for(out, policy);
  options.seeds = {42};
  options.live = policy::LiveTerms{delay_s, most_held};
  return options;
}

Trace trace_of(const std::string& dir, int episode) {
  const auto rows = read_results(dir);
  REQUIRE(rows.ok());
  REQUIRE(rows->size() > static_cast<std::size_t>(episode));
  const ResultRow& row = rows->at(static_cast<std::size_t>(episode));
  REQUIRE_MESSAGE(!row.invalid, row.invalid.value_or(""));
  auto trace = read_trace(row.trace);
  REQUIRE_MESSAGE(trace.ok(), to_text(trace.failure()));
  return std::move(*trace);
}

void check_replays(const std::string& dir, int episodes) {
  for (int episode = 0; episode < episodes; ++episode) {
    ReplayOptions options;
    options.verify = true;
    options.assets = VLAPROBE_SOURCE_DIR "/assets";
    const auto replayed = replay(dir, "carrot_on_plate", episode, 42, options);
    REQUIRE_MESSAGE(replayed.ok(), to_text(replayed.failure()));
    CHECK_MESSAGE(replayed->identical, replayed->difference);
  }
}

std::vector<int> delays_of(const Trace& trace) { return live_figures(trace).delays; }

// The served expert, whose answers take a time on the wall clock.
class Late final : public ServedPolicy {
 public:
  Late(std::unique_ptr<ServedPolicy> inner, std::chrono::milliseconds time)
      : inner_(std::move(inner)), time_(time) {}
  void reset() override { inner_->reset(); }
  Result<std::vector<policy::Action>> answer(const Asked& asked, int count) override {
    std::this_thread::sleep_for(time_);
    return inner_->answer(asked, count);
  }

 private:
  std::unique_ptr<ServedPolicy> inner_;
  std::chrono::milliseconds time_;
};

}  // namespace

TEST_CASE("a given delay of nothing is the run that waits, and others repeat bit for bit") {
  TemporaryFolder folder;
  const plan::Plan plan = table_plan(2, 12);
  RunOptions waits = options_for(folder / "waits", "expert");
  waits.seeds = {42};
  must_run(plan, waits);
  const Trace still = trace_of(folder / "waits", 0);
  CHECK_FALSE(still.header.live.has_value());
  for (const int late : {0, 1, 3}) {
    CAPTURE(late);
    const std::string dir = folder / ("late" + std::to_string(late));
    RunOptions options = live_options(dir, "expert", 0.2 * late);
    options.jobs = 2;
    must_run(plan, options);
    const Trace trace = trace_of(dir, 0);
    REQUIRE(trace.header.live.has_value());
    CHECK(trace.header.live->delay_s == 0.2 * late);
    REQUIRE(trace.steps.size() == 12);
    for (const int delay : delays_of(trace)) CHECK(delay == late);
    for (std::size_t i = 0; i < trace.steps.size(); ++i) {
      REQUIRE(trace.steps[i].live.has_value());
      if (late == 0) CHECK(trace.steps[i].state_hash == still.steps[i].state_hash);
    }
    // Nothing is done before the first answer, and then what it saw then.
    for (int i = 0; i < late; ++i) {
      const TraceStep& step = trace.steps[static_cast<std::size_t>(i)];
      CHECK(step.live->source == policy::LiveSource::kHeld);
      CHECK(step.action == policy::Action{0, 0, 0, 0, 0, 0, 1});
    }
    CHECK(trace.steps[static_cast<std::size_t>(late)].action == still.steps[0].action);
    check_replays(dir, 2);
    // The same once more has the same traces.
    RunOptions again =
        live_options(folder / ("again" + std::to_string(late)), "expert", 0.2 * late);
    must_run(plan, again);
    CHECK(hashes(again.out) == hashes(dir));
  }
}

TEST_CASE("a given delay is counted again: a trace whose answers had another does not repeat") {
  TemporaryFolder folder;
  const plan::Plan plan = table_plan(1, 8);
  const std::string dir = folder / "late";
  must_run(plan, live_options(dir, "expert", 0.4));
  const auto forged = [&](auto&& change) {
    Trace trace = trace_of(dir, 0);
    const std::string path = read_results(dir)->front().trace;
    change(trace);
    auto writer = TraceWriter::create(path, trace.header);
    REQUIRE(writer.ok());
    REQUIRE((*writer)->start(*trace.start).ok());
    for (const TraceStep& step : trace.steps) REQUIRE((*writer)->step(step).ok());
    const auto hash = (*writer)->finish(*trace.end);
    REQUIRE(hash.ok());
    change_database(dir, "update episodes set trace_sha256 = '" + to_hex(*hash) + "'");
    ReplayOptions options;
    options.assets = VLAPROBE_SOURCE_DIR "/assets";
    const auto replayed = replay(dir, "carrot_on_plate", 0, 42, options);
    REQUIRE_MESSAGE(replayed.ok(), to_text(replayed.failure()));
    CHECK(replayed->identical == replayed->difference.empty());
    return replayed->difference;
  };
  CHECK(forged([](Trace&) {}).empty());
  CHECK(forged([](Trace& trace) { trace.header.live->delay_s = 0.2; }) ==
        "step 2: a late action, the answer to step 0, recorded no action");
  CHECK(forged([](Trace& trace) { trace.header.live->delay_s = 0.6; }) ==
        "step 3: no action, recorded a late action, a question, the answer to step 0");
  // Back to what it was, but for a delay in seconds.
  CHECK(forged([](Trace& trace) {
          trace.header.live->delay_s = 0.4;
          trace.steps[2].live->answers[0].answer_s = 0.45;
        }) ==
        "step 3: the delay of the answer to step 0 is 0.40000000000000002, recorded "
        "0.45000000000000001");
}

TEST_CASE("a question under way at an episode's end holds nobody up, and its answer is nobody's") {
  // Asks a second apart; the last question of each episode is answered late, or not while we wait.
  class Hanging final : public ServedPolicy {
   public:
    struct Door {
      std::mutex mutex;
      std::condition_variable opens;
      bool is_open = false;
      std::atomic<int> asked = 0;
    };
    Hanging(Door& door, std::chrono::milliseconds time) : door_(door), time_(time) {}
    void reset() override {}
    Result<std::vector<policy::Action>> answer(const Asked& asked, int count) override {
      auto actions = inner_->answer(asked, count);
      if (is_known_observation(asked.picture.bytes, asked.words) || ++door_.asked % 3 != 0)
        return actions;
      std::unique_lock lock(door_.mutex);
      door_.opens.wait_for(lock, time_, [this] { return door_.is_open; });
      return actions;
    }

   private:
    Door& door_;
    std::chrono::milliseconds time_;
    std::unique_ptr<ServedPolicy> inner_ = serve_digest().value()();
  };
  TemporaryFolder folder;
  auto bytes = TablePlan(VLAPROBE_SOURCE_DIR "/assets").write(2, 3, [](plan::Records& records) {
    records.robots[0].control_hz = 1;
  });
  REQUIRE_MESSAGE(bytes.ok(), to_text(bytes.failure()));
  const plan::Plan plan = plan::Plan::from_bytes(std::move(*bytes)).value();
  for (const auto time : {std::chrono::milliseconds(1500), std::chrono::milliseconds(50'000)}) {
    CAPTURE(time.count());
    Hanging::Door door;
    ServeOptions options;
    options.policy = [&] { return std::make_unique<Hanging>(door, time); };
    const auto listener = serve(Protocol::kOpenpi, options);
    REQUIRE_MESSAGE(listener.ok(), to_text(listener.failure()));
    const std::string address = "openpi://127.0.0.1:" + (*listener)->port() + "?" +
                                options_for_served(Protocol::kOpenpi, options) +
                                "&timeout.connect_s=2";
    const auto begun = std::chrono::steady_clock::now();
    const std::string dir = folder / std::to_string(time.count());
    must_run(plan, live_options(dir, address, std::nullopt));
    const double took =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
    CHECK(took < 40);
    CHECK(door.asked == 6);
    // Each episode's first action is what its own first picture is answered.
    const Trace first = trace_of(dir, 0), second = trace_of(dir, 1);
    CHECK(delays_of(first) == std::vector<int>{0, 0});
    CHECK(delays_of(second) == std::vector<int>{0, 0});
    CHECK(first.steps[0].action != second.steps[0].action);
    check_replays(dir, 2);
    {
      const std::lock_guard lock(door.mutex);
      door.is_open = true;
    }
    door.opens.notify_all();
    RunOptions waits = options_for(folder / (std::to_string(time.count()) + "w"), address);
    waits.seeds = {42};
    must_run(plan, waits);
    CHECK(trace_of(waits.out, 0).steps[0].action == first.steps[0].action);
    CHECK(trace_of(waits.out, 1).steps[0].action == second.steps[0].action);
  }
}

TEST_CASE("a served expert's delays on the wall clock are stored and repeat bit for bit") {
  TemporaryFolder folder;
  // A second a step, so that a busy machine keeps up with it.
  auto bytes = TablePlan(VLAPROBE_SOURCE_DIR "/assets").write(1, 6, [](plan::Records& records) {
    records.robots[0].control_hz = 1;
  });
  REQUIRE_MESSAGE(bytes.ok(), to_text(bytes.failure()));
  const plan::Plan plan = plan::Plan::from_bytes(std::move(*bytes)).value();
  RunOptions waits = options_for(folder / "waits", "expert");
  waits.seeds = {42};
  must_run(plan, waits);
  const auto episodes = recorded_episodes(folder / "waits");
  REQUIRE_MESSAGE(episodes.ok(), to_text(episodes.failure()));
  struct Case {
    int late;
    std::chrono::milliseconds time;
  };
  for (const Case& now :
       {Case{0, std::chrono::milliseconds(0)}, Case{1, std::chrono::milliseconds(1400)},
        Case{3, std::chrono::milliseconds(3400)}}) {
    CAPTURE(now.late);
    ServeOptions options;
    const auto inner = serve_recorded(*episodes, false);
    options.policy = [inner, now] { return std::make_unique<Late>(inner(), now.time); };
    const auto listener = serve(Protocol::kOpenpi, options);
    REQUIRE_MESSAGE(listener.ok(), to_text(listener.failure()));
    const std::string dir = folder / ("late" + std::to_string(now.late));
    const auto begun = std::chrono::steady_clock::now();
    must_run(plan, live_options(dir,
                                "openpi://127.0.0.1:" + (*listener)->port() +
                                    "?image=first -> observation/image&" +
                                    options_for_served(Protocol::kOpenpi, options),
                                std::nullopt));
    const double took =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
    CHECK(took >= 5);
    const Trace trace = trace_of(dir, 0);
    REQUIRE_FALSE(delays_of(trace).empty());
    CHECK(delays_of(trace).front() == now.late);
    const auto figures = live_figures(trace);
    for (std::size_t i = 0; i < figures.delays.size(); ++i) {
      CHECK(figures.answer_s[i] >= 0.001 * static_cast<double>(now.time.count()));
      // The recorded delay is that of the control step in whose period it came.
      CHECK(figures.delays[i] >= static_cast<int>(figures.answer_s[i]));
    }
    check_replays(dir, 1);
    const auto proven = read_proven_results(dir);
    REQUIRE(proven.ok());
    CHECK(proven->live_terms == "live, as measured, at most 100 % held");
    CHECK(proven->live.steps == 6);
  }
}

TEST_CASE(
    "LeRobot's server answers a world that does not wait, and its delays repeat bit for bit") {
  TemporaryFolder folder;
  auto bytes = TablePlan(VLAPROBE_SOURCE_DIR "/assets").write(1, 5, [](plan::Records& records) {
    records.robots[0].control_hz = 1;
  });
  REQUIRE_MESSAGE(bytes.ok(), to_text(bytes.failure()));
  const plan::Plan plan = plan::Plan::from_bytes(std::move(*bytes)).value();
  ServeOptions options;
  options.policy = [] {
    return std::make_unique<Late>(serve_digest().value()(), std::chrono::milliseconds(1400));
  };
  const auto listener = serve(Protocol::kLeRobot, options);
  REQUIRE_MESSAGE(listener.ok(), to_text(listener.failure()));
  const std::string dir = folder / "lerobot";
  must_run(plan, live_options(dir,
                              "lerobot://127.0.0.1:" + (*listener)->port() + "?" +
                                  options_for_served(Protocol::kLeRobot, options),
                              std::nullopt));
  const Trace trace = trace_of(dir, 0);
  REQUIRE_FALSE(delays_of(trace).empty());
  CHECK(delays_of(trace).front() == 1);
  check_replays(dir, 1);
  // It was busy, and nobody stood and waited for it.
  const auto calls = read_run_calls(dir);
  REQUIRE(calls.ok());
  CHECK(calls->back().queries.queries >= 2);
  CHECK(calls->back().queries.busy_s > 1);
  CHECK(calls->back().queries.waiting_s == 0);
}

TEST_CASE("a live run that was killed goes on, with the traces of one that was not") {
  TemporaryFolder folder;
  const plan::Plan plan = table_plan(4, 6);
  must_run(plan, live_options(folder / "whole", "expert", 0.25));
  const std::string dir = folder / "killed";
  const pid_t child = fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    RunOptions options = live_options(dir, "expert", 0.25);
    options.progress = [](const RunProgress& progress) {
      if (progress.done == 2) kill(getpid(), SIGKILL);
    };
    const auto ran = run::run(plan, options);
    _exit(ran.ok() ? 0 : 1);
  }
  int status = 0;
  REQUIRE(waitpid(child, &status, 0) == child);
  CHECK(WIFSIGNALED(status));
  const RunSummary summary = must_run(plan, live_options(dir, "expert", 0.25));
  CHECK(summary.skipped == 2);
  CHECK(summary.done == 2);
  CHECK(hashes(dir) == hashes(folder / "whole"));
  check_replays(dir, 4);
}

TEST_CASE("live rows never stand beside rows of a world that waits") {
  TemporaryFolder folder;
  const plan::Plan plan = table_plan(1, 3);
  RunOptions waits = options_for(folder / "waits", "null");
  must_run(plan, waits);
  must_run(plan, live_options(folder / "live", "null", 0.2));
  const auto refusal = [&](RunOptions options, const std::string& out) {
    options.out = out;
    const auto ran = run::run(plan, options);
    return ran.ok() ? std::string() : ran.failure().message;
  };
  CHECK(refusal(waits, folder / "live")
            .find("holds a run that is live, 200 ms, at most 100 % held, "
                  "not a run whose world waits for its policy") == 0);
  const RunOptions live = live_options("", "null", 0.2);
  CHECK(refusal(live, folder / "waits").find("holds a run whose world waits for its policy") == 0);
  CHECK(refusal(live_options("", "null", 0.4), folder / "live")
            .find("holds a run that is live, 200") == 0);
  RunOptions forced = waits;
  forced.if_changed = IfChanged::kContinue;
  CHECK(refusal(forced, folder / "live").find("holds a run that is live") == 0);

  MergeOptions merging;
  merging.dirs = {folder / "waits", folder / "live"};
  merging.out = folder / "merged";
  const auto merged = merge(merging);
  REQUIRE_FALSE(merged.ok());
  CHECK(merged.failure().message.find("holds a run that is live") == 0);
  CHECK_FALSE(std::filesystem::exists(folder / "merged/results.sqlite"));

  // Nor does a trace pass for one of the other kind.
  const auto rows = read_results(folder / "live");
  REQUIRE(rows.ok());
  CHECK(rows->size() == 1);
}

TEST_CASE("what cannot be live, or not measured so, is refused before anything runs") {
  TemporaryFolder folder;
  const plan::Plan plan = table_plan(1, 3);
  const auto refusal = [&](RunOptions options) {
    const auto ran = run::run(plan, options);
    REQUIRE_FALSE(ran.ok());
    CHECK(ran.failure().code == Fault::kUsage);
    return ran.failure().message;
  };
  RunOptions many = live_options(folder / "a", "expert", std::nullopt);
  many.jobs = 2;
  CHECK(refusal(many).find("run with --jobs 1, or give every answer a delay with --live-delay") !=
        std::string::npos);
  CHECK(refusal(live_options(folder / "b", "openpi://localhost:1?batch=8", std::nullopt)) ==
        "questions of a live run do not wait for others: ask without `batch`");
  CHECK(refusal(live_options(folder / "c", "replay:" + (folder / "x"), 0.1))
            .find("nothing of it is late") != std::string::npos);
  CHECK_FALSE(std::filesystem::exists(folder / "a"));
}

TEST_CASE("a policy that is hardly ever in time is named, and its episode does not count") {
  TemporaryFolder folder;
  const plan::Plan plan = table_plan(1, 10);
  must_run(plan, live_options(folder / "slow", "expert", 0.6, 0.5));
  const auto rows = read_results(folder / "slow");
  REQUIRE(rows.ok());
  REQUIRE(rows->size() == 1);
  REQUIRE(rows->front().invalid.has_value());
  CHECK(*rows->front().invalid ==
        "policy: slower than its rate: 70.0 % of 10 control steps had no action of the policy, 3 "
        "steps one that came after its time; 3 answers took effect after 3 control steps (600 ms) "
        "at the median, 3 control steps (600 ms) at the 99th percentile, and the limit is 50.0 % "
        "(--live-most-held)");
}

TEST_CASE("an episode whose simulation is slower than its clock is invalid, and not the policy's") {
  // A server that answers at once, beside pictures that take two control steps to look at.
  class Prompt final : public policy::Policy, public policy::Answerer {
   public:
    Status begin(const policy::EpisodeStart&) override { return {}; }
    Result<policy::Action> act(const policy::Observation&) override {
      return policy::Action{0, 0, 0, 0, 0, 0, 1};
    }
    policy::Answerer* answerer() override { return this; }
    Status ask(const policy::Observation&, policy::LiveClock::time_point) override { return {}; }
    Result<std::optional<Answer>> wait(policy::LiveClock::time_point) override {
      return std::optional(Answer{{Said{0, 0, 0, 0, 0, 0, 1}}, policy::LiveClock::now()});
    }
    Result<policy::Action> convert(const Said&, const policy::Observation& now) override {
      return act(now);
    }
    void done(const policy::Action&, const policy::Observation&) override {}
    int steps_between(int) const override { return 1; }
  };
  class SlowSink final : public show::FrameSink {
   public:
    Status frame(std::span<const stage::CameraFrame>, int, std::span<const MetricValue>) override {
      std::this_thread::sleep_for(std::chrono::milliseconds(400));
      return {};
    }
  };
  TemporaryFolder folder;
  const plan::Plan plan = table_plan(1, 4);
  const std::uint32_t tasks[] = {0};
  auto assets = stage::SharedAssets::load(plan, VLAPROBE_SOURCE_DIR "/assets", tasks);
  REQUIRE_MESSAGE(assets.ok(), to_text(assets.failure()));
  auto stage = stage::Stage::create(plan, 0, *assets);
  REQUIRE_MESSAGE(stage.ok(), to_text(stage.failure()));
  const EpisodeJob job{0, 0, 42};
  const policy::LiveTerms terms;
  auto trace = TraceWriter::create(folder / "a.trace",
                                   make_trace_header(plan, job, **stage, "prompt", "{}", terms));
  REQUIRE(trace.ok());
  const auto policy = policy::make_live(std::make_unique<Prompt>(), terms);
  SlowSink sink;
  const auto played =
      run_episode(**stage, plan, job, "prompt", *policy, **trace, &sink, -1, terms.most_held);
  REQUIRE_MESSAGE(played.ok(), to_text(played.failure()));
  REQUIRE(played->row.invalid.has_value());
  CHECK(played->row.invalid->find(
            "world: the simulation is slower than the clock: control step 1 began ") == 0);
  CHECK_FALSE(played->policy_fault.has_value());
  CHECK(played->row.steps == 1);
  CHECK(read_trace(folder / "a.trace").ok());
}

}  // namespace probe::run
