// Threads that do the same work on many things, again and again: steps of many worlds.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace probe::api {

class Crew {
 public:
  // As many of `threads` as the system gives; the caller's is one of them.
  explicit Crew(int threads);
  ~Crew();
  Crew(const Crew&) = delete;
  Crew& operator=(const Crew&) = delete;

  // Calls work(i) for each i below `count`, in no order, and returns when all are done. `work` must
  // not throw.
  void each(std::size_t count, const std::function<void(std::size_t)>& work);

 private:
  void serve();
  void take_all();

  std::vector<std::thread> threads_;
  std::mutex mutex_;
  std::condition_variable called_, done_;
  // Of the turn under way; written under the mutex.
  const std::function<void(std::size_t)>* work_ = nullptr;
  std::size_t count_ = 0, turn_ = 0, busy_ = 0;
  std::atomic<std::size_t> next_ = 0;
  bool is_over_ = false;
};

}  // namespace probe::api
