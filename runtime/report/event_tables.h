// Sums of events: how often what std/events.probe tells of began in the episodes of each policy and
// task, with the intervals and comparisons that verdicts have.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "runtime/base/json.h"
#include "runtime/rejudge/events.h"
#include "runtime/report/benchmark.h"

namespace probe::report {

// Of the episodes of a benchmark, in their order; `told` is empty where nothing was read.
struct ToldEvents {
  rejudge::EventMetrics metrics;
  std::vector<std::optional<rejudge::EpisodeEvents>> told;
};

// The same experiment, where an episode's truths are whether each event began in it, and whether it
// came as far as each subgoal; episodes of which nothing is told are invalid. A task has the events
// that its episodes have. Without plan files.
Benchmark benchmark_of_events(const Benchmark& benchmark, const ToldEvents& events);

// `tables.events` of the page's document (PAGE_DATA.md); null when nothing was told of any episode
// or nothing happened in any.
Json events_json(const Benchmark& benchmark, const ToldEvents& events);

}  // namespace probe::report
