// Jobs to worker threads: each worker takes the next job when it is free. Results must not depend
// on who did what, so nothing but time is shared here.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>

#include "runtime/base/result.h"

namespace probe::run {

// Which job is next. Asked by any worker thread.
class JobSource {
 public:
  virtual ~JobSource() = default;
  // Nothing: there is no more to do. May wait for others.
  virtual std::optional<std::size_t> next() = 0;
  // From now on there is no more to do: a worker failed.
  virtual void stop() = 0;
};

// Does job `index`; called by one worker thread only.
using Worker = std::function<Status(std::size_t index)>;

// Runs `count` jobs on `workers` threads, or as many as the system gives; make_worker runs on the
// worker's own thread. The first failure stops the hand-out of further jobs and is returned when
// the running ones have ended.
Status run_jobs(std::size_t count, int workers, const std::function<Result<Worker>()>& make_worker);
// The same with jobs, at most `count` of them, as `source` has them.
Status run_jobs(JobSource& source, std::size_t count, int workers,
                const std::function<Result<Worker>()>& make_worker);

}  // namespace probe::run
