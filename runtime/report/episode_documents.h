// What happened in each episode, step by step, and why it was judged so: the documents `timelines`
// and `whys` of the page, read from stored traces. Knows nothing of counts and tables.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "runtime/plan/plan.h"
#include "runtime/rejudge/events.h"
#include "runtime/store/results.h"
#include "runtime/store/trace.h"

namespace probe::report {

// One episode of the page's column arrays, in their order.
struct EpisodeTrace {
  const store::ResultRow* row = nullptr;  // null: nothing is told of it
  const plan::Plan* plan = nullptr;  // the one the row was made under
  int task = 0;                      // index into the page's tasks
  // The same plan with metrics that tell of events behind its own; null: none are told.
  const plan::Plan* events = nullptr;
};

struct EpisodeDocumentOptions {
  int jobs = 1;        // threads
  bool traces = true;  // false: no trace is read, both documents are empty
  // Explained verdicts are long: at most so many episodes have one, the same number of each task
  // and policy, those that did not succeed first. The others have the command that explains them.
  std::size_t explained = 600;
  rejudge::EventMetrics events = {};  // of EpisodeTrace::events
};

struct EpisodeDocuments {
  std::string timelines, whys;     // JSON texts
  std::vector<std::string> notes;  // sentences: traces that could not be read
  // By episode; nothing where none were asked for or its trace could not be read.
  std::vector<std::optional<rejudge::EpisodeEvents>> events = {};
};

// `metrics` are the page's metrics by name, `task_count` its tasks.
EpisodeDocuments episode_documents(std::span<const EpisodeTrace> episodes,
                                   std::span<const std::string> metrics, std::size_t task_count,
                                   const EpisodeDocumentOptions& options);

// The record of one trace as PAGE_DATA.md encodes it.
struct Ends {
  std::uint32_t source = 0, target = 1;  // bodies whose distance is told; plan::kNone: it is not
};
// A joint of a fixture, behind the robot's in the trace.
struct TimelineJoint {
  std::string name;             // "cabinet.top"
  bool slides = true;           // told in cm, else in degrees
  double lower = 0, upper = 0;  // m or rad; both 0: without end
};
std::string encode_timeline(const store::Trace& trace, std::span<const std::string> metrics,
                            Ends ends = {}, std::span<const TimelineJoint> joints = {});
// The records of its events; `names` are those that the document lists.
std::string encode_events(const rejudge::EpisodeEvents& events, std::span<const std::string> names);

}  // namespace probe::report
