// A counter, a mutex and threads.
#include "runtime/run/workers.h"

#include <algorithm>
#include <atomic>
#include <mutex>
#include <optional>
#include <system_error>
#include <thread>
#include <vector>

namespace probe::run {

namespace {

// One after the other.
class InTurn final : public JobSource {
 public:
  explicit InTurn(std::size_t count) : count_(count) {}
  std::optional<std::size_t> next() override {
    const std::size_t index = next_.fetch_add(1);
    if (index >= count_) return std::nullopt;
    return index;
  }
  void stop() override { next_ = count_; }

 private:
  std::size_t count_;
  std::atomic<std::size_t> next_{0};
};

}  // namespace

Status run_jobs(std::size_t count, int workers,
                const std::function<Result<Worker>()>& make_worker) {
  InTurn source(count);
  return run_jobs(source, count, workers, make_worker);
}

Status run_jobs(JobSource& source, std::size_t count, int workers,
                const std::function<Result<Worker>()>& make_worker) {
  std::mutex mutex;
  std::optional<Failure> first;
  const auto fail = [&](const Failure& failure) {
    const std::lock_guard lock(mutex);
    if (!first) first = failure;
    source.stop();
  };
  const auto work = [&] {
    auto worker = make_worker();
    if (!worker) return fail(worker.failure());
    while (const auto index = source.next()) {
      if (auto done = (*worker)(*index); !done) return fail(done.failure());
    }
  };
  const auto threads = std::min(count, static_cast<std::size_t>(std::max(workers, 1)));
  std::vector<std::thread> pool;
  for (std::size_t i = 1; i < threads; ++i) {
    try {
      pool.emplace_back(work);
    } catch (const std::system_error&) {
      break;  // the system gives no more threads: those that there are do all the jobs
    }
  }
  if (threads > 0) work();
  for (std::thread& thread : pool) thread.join();
  if (first) return *first;
  return {};
}

}  // namespace probe::run
