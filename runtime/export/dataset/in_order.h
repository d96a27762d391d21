// What many threads make, taken one at a time in the order of its numbers. So that memory does not
// grow when one is slow, nobody begins what lies more than `window` before the next to be taken.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <functional>
#include <map>
#include <mutex>
#include <utility>

#include "runtime/base/result.h"

namespace probe::dataset {

template <typename Item>
class InOrder {
 public:
  InOrder(std::size_t window, std::function<Status(Item)> take)
      : window_(window), take_(std::move(take)) {}

  // Waits until `index` may be begun; false when nothing more is taken.
  bool wait_for(std::size_t index) {
    std::unique_lock lock(mutex_);
    moved_.wait(lock, [&] { return stopped_ || index < next_ + window_; });
    return !stopped_;
  }
  // Takes the item when it is its turn, by this thread or another. The failure of what is taken
  // here stops everything.
  Status give(std::size_t index, Item item) {
    const std::lock_guard lock(mutex_);
    if (stopped_) return {};
    waiting_.emplace(index, std::move(item));
    for (auto first = waiting_.find(next_); first != waiting_.end(); first = waiting_.find(next_)) {
      Item taken = std::move(first->second);
      waiting_.erase(first);
      if (auto done = take_(std::move(taken)); !done) {
        stopped_ = true;
        moved_.notify_all();
        return done;
      }
      ++next_;
    }
    moved_.notify_all();
    return {};
  }
  void stop() {
    const std::lock_guard lock(mutex_);
    stopped_ = true;
    moved_.notify_all();
  }

 private:
  std::size_t window_, next_ = 0;
  std::function<Status(Item)> take_;
  std::map<std::size_t, Item> waiting_;
  bool stopped_ = false;
  std::mutex mutex_;
  std::condition_variable moved_;
};

}  // namespace probe::dataset
