// One thread that does the latest piece of work that was asked for, after a pause in which nothing
// newer was: typing is not disturbed.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

namespace probe::lsp {

class Background {
 public:
  // `stop` becomes true when the answer is not wanted any more.
  using Work = std::function<void(const std::atomic<bool>& stop)>;

  explicit Background(std::chrono::milliseconds pause) : pause_(pause) {}
  // Waits for what is being done, which is told to stop.
  ~Background();
  Background(const Background&) = delete;
  Background& operator=(const Background&) = delete;

  // In place of whatever was asked before.
  void ask(Work work);
  // What is being done is not wanted.
  void cancel();
  // Lets go of something large, at once: an answer does not wait for that.
  void let_go(std::shared_ptr<void> old);

 private:
  void run();

  std::chrono::milliseconds pause_;
  std::mutex mutex_;
  std::condition_variable wakes_;
  Work next_;
  std::chrono::steady_clock::time_point due_;
  std::atomic<bool> stop_ = false;  // of what is being done
  std::vector<std::shared_ptr<void>> old_;
  bool ends_ = false;
  std::thread thread_;
};

}  // namespace probe::lsp
