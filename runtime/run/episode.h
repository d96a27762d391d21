// The loop of one episode: a stage and a policy in turns, and the trace of both.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "runtime/base/result.h"
#include "runtime/plan/plan.h"
#include "runtime/policy/live.h"
#include "runtime/policy/policy.h"
#include "runtime/show/frame_sink.h"
#include "runtime/stage/stage.h"
#include "runtime/store/episode_key.h"
#include "runtime/store/results.h"
#include "runtime/store/trace.h"

namespace probe::run {

struct EpisodeJob {
  std::uint32_t task = 0;   // index of the plan's tasks
  std::uint32_t index = 0;  // within the task
  int seed = 0;
  bool operator==(const EpisodeJob&) const = default;
};
store::EpisodeKey key_of(const plan::Plan& plan, const EpisodeJob& job);

// First 8 bytes of SHA-256(seed, episode id): what everything that draws in the episode starts
// from.
std::uint64_t draw_seed(int seed, const Sha256& episode_id);

// Of what a policy sees in a step: a picture's RGB bytes; of several cameras' pictures the hash of
// their hashes.
Sha256 picture_hash(std::span<const stage::CameraFrame> frames);

// `stage` is of the job's task: it knows the bodies and joints that are measured.
store::TraceHeader make_trace_header(const plan::Plan& plan, const EpisodeJob& job,
                                     const stage::Stage& stage, const std::string& policy,
                                     const std::string& fingerprint,
                                     const std::optional<policy::LiveTerms>& live = {});

struct Played {
  store::ResultRow row;               // its `trace` is left empty
  std::optional<Fault> policy_fault;  // where the policy's failure made the row invalid
};

// In: a stage of the job's task and a policy. Out: the row, and the trace, closed. The order: the
// stage is reset and the trace begun; the policy hears of the episode; then, step by step, look,
// ask, act, judge, record; a last frame for the video; the policy hears of the end.
// Where a policy with a live_step() (policy/live.h) held a larger share of its steps than
// `most_held`, the row is invalid. Runs the full horizon (`steps` of them if not negative), or to
// the step at which what ends the task holds. What goes wrong with the world, the picture or the
// policy, exceptions included, makes the row invalid; a Failure is only what the trace or the sink
// could not write.
Result<Played> run_episode(stage::Stage& stage, const plan::Plan& plan, const EpisodeJob& job,
                           const std::string& policy_name, policy::Policy& policy,
                           store::TraceWriter& trace, show::FrameSink* frames = nullptr,
                           int steps = -1, double most_held = 1);

}  // namespace probe::run
