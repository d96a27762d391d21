// How long an episode takes, as runs measured it.
#pragma once

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

}  // namespace probe::cluster
