// How long an episode takes, as runs measured it.
#pragma once

#include <cstdint>
#include <string>

#include "runtime/base/result.h"

namespace probe::cluster {

struct MeasuredTime {
  double seconds = 0;  // of one world, an episode
  int episodes = 0;    // that were measured
  int worlds = 1;      // at once, the most of a call
};

// Of the calls of `run` that ended by themselves: in `dir`, or, of an array job whose shards were
// not joined, in its shards. Fails (kUsage) where none of them ran an episode.
Result<MeasuredTime> measured_time(const std::string& dir);

// s that a task is given for so many episodes in so many worlds: as long as they took and half as
// long again. An episode is one world's from its begin to its end.
double time_for(const MeasuredTime& measured, std::int64_t episodes, int worlds);

}  // namespace probe::cluster
