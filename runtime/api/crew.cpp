#include "runtime/api/crew.h"

#include <system_error>

namespace probe::api {

Crew::Crew(int threads) {
  for (int i = 1; i < threads; ++i) {
    try {
      threads_.emplace_back([this] { serve(); });
    } catch (const std::system_error&) {
      break;  // those that there are do all the work
    }
  }
}

Crew::~Crew() {
  {
    const std::lock_guard lock(mutex_);
    is_over_ = true;
  }
  called_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

void Crew::each(std::size_t count, const std::function<void(std::size_t)>& work) {
  {
    const std::lock_guard lock(mutex_);
    work_ = &work;
    count_ = count;
    next_ = 0;
    busy_ = threads_.size();
    ++turn_;
  }
  called_.notify_all();
  take_all();
  std::unique_lock lock(mutex_);
  done_.wait(lock, [this] { return busy_ == 0; });
}

void Crew::take_all() {
  for (;;) {
    const std::size_t i = next_.fetch_add(1);
    if (i >= count_) return;
    (*work_)(i);
  }
}

void Crew::serve() {
  std::size_t seen = 0;
  std::unique_lock lock(mutex_);
  for (;;) {
    called_.wait(lock, [&] { return is_over_ || turn_ != seen; });
    if (is_over_) return;
    seen = turn_;
    lock.unlock();
    take_all();
    lock.lock();
    if (--busy_ == 0) done_.notify_one();
  }
}

}  // namespace probe::api
