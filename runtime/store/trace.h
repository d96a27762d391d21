// One file an episode: what was done and what was measured, step by step. TRACE.md describes the
// bytes. A trace can be judged again without physics and repeated bit for bit. Knows nothing of
// worlds and policies.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/base/sha256.h"
#include "runtime/policy/live.h"
#include "runtime/robot/action.h"
#include "runtime/store/results.h"
#include "runtime/vm/sample.h"

namespace probe::store {

struct TraceHeader {
  Sha256 plan_root;
  Sha256 episode_id, start_id;
  std::string task;
  std::int32_t episode = 0, seed = 0;
  std::string policy;
  std::string prompt;
  std::vector<std::string> later;  // sentences behind it, of a task whose instruction changes
  std::uint32_t horizon = 0;
  double control_hz = 0;
  std::vector<std::string> bodies;  // task-local, in the plan's order, then links of fixtures
  std::vector<std::string> joints;  // the robot's in drive order, then those of fixtures
  struct Metric {
    std::string name;
    bool is_bool = true;
    bool operator==(const Metric&) const = default;
  };
  std::vector<Metric> metrics;
  // Of a world that did not wait for its policy; such a trace has version 2.
  std::optional<policy::LiveTerms> live = {};
  // Where the numbers of actions are joints': the law, and how many they are. Such a trace has
  // version 3 or 4. Else they are a tool's seven.
  struct JointActions {
    std::string law;
    std::uint32_t count = 0;
    bool operator==(const JointActions&) const = default;
  };
  std::optional<JointActions> joint_actions = {};
  std::size_t action_size() const {
    return joint_actions ? joint_actions->count : robot::kActionSize;
  }
  std::string fingerprint;  // JSON; not part of the trace's hash
};

// After settling, before the first action.
struct TraceStart {
  std::vector<double> q;
  std::vector<vm::BodyStart> starts;  // one per body
  vm::StepSample sample;              // step 0
  Sha256 state_hash;
};

struct TraceStep {
  // What the policy saw and answered.
  Sha256 prompt_hash, image_hash;
  robot::Action action{};
  // After the control step.
  std::vector<double> q, u;
  vm::StepSample sample;
  std::vector<double> metrics;  // values so far; a truth is 0 or 1
  Sha256 state_hash;
  // In every step of a trace whose header has the terms, and in no other.
  std::optional<policy::LiveStep> live = {};
  // Seconds of wall clock; not part of the trace's hash.
  double render_s = 0, policy_s = 0, physics_s = 0;
};

struct TraceEnd {
  std::uint32_t steps = 0;
  std::vector<MetricValue> metrics;
  std::optional<std::string> invalid;
};

// Appends to `path`; every call ends with the bytes handed to the system, so that a killed process
// leaves a file that is readable up to its last whole step.
class TraceWriter {
 public:
  static Result<std::unique_ptr<TraceWriter>> create(const std::string& path,
                                                     const TraceHeader& header);
  virtual ~TraceWriter() = default;
  virtual Status start(const TraceStart& start) = 0;
  virtual Status step(const TraceStep& step) = 0;
  // Writes the end and the hash, and waits until the disk has the file. Returns the trace's hash.
  virtual Result<Sha256> finish(const TraceEnd& end) = 0;
};

struct Trace {
  TraceHeader header;
  std::optional<TraceStart> start;
  std::vector<TraceStep> steps;
  std::optional<TraceEnd> end;
  Sha256 hash;             // of what was read; equal to the recorded one if complete
  std::string incomplete;  // why the reader stopped early; empty for a whole trace
};

// Which sentence of the instruction was said in each step, 0 being the first; read off the prompt
// hashes. Nothing where they are not the header's sentences in their order.
std::optional<std::vector<std::uint32_t>> sentences_said(const Trace& trace);
// The steps, from 0, in which each later sentence was said first; as many as came.
std::vector<int> turns_of(const Trace& trace);

// The whole trace; fails (kTrace) on a truncated or damaged one, saying where and after which
// step.
Result<Trace> read_trace(const std::string& path);
// As far as whole steps go: `incomplete` says why it ended. Fails only if not even the header is
// readable.
Result<Trace> read_trace_prefix(const std::string& path);

}  // namespace probe::store
