// Jobs to worker threads: each worker takes the next job when it is free. Results must not depend
// on who did what, so nothing but time is shared here.
#pragma once

#include <cstddef>
#include <functional>

#include "runtime/base/result.h"

namespace probe::run {

// Does job `index`; called by one worker thread only.
using Worker = std::function<Status(std::size_t index)>;

// Runs `count` jobs on `workers` threads, or as many as the system gives; make_worker runs on the
// worker's own thread. The first failure stops the hand-out of further jobs and is returned when
// the running ones have ended.
Status run_jobs(std::size_t count, int workers, const std::function<Result<Worker>()>& make_worker);

}  // namespace probe::run
