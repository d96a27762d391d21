#include "runtime/lsp/background.h"

namespace probe::lsp {

Background::~Background() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
    next_ = nullptr;
    stop_ = true;
  }
  wakes_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void Background::let_go(std::shared_ptr<void> old) {
  {
    const std::lock_guard lock(mutex_);
    old_.push_back(std::move(old));
    if (!thread_.joinable()) thread_ = std::thread([this] { run(); });
  }
  wakes_.notify_all();
}

void Background::ask(Work work) {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
    next_ = std::move(work);
    due_ = std::chrono::steady_clock::now() + pause_;
    if (!thread_.joinable()) thread_ = std::thread([this] { run(); });
  }
  wakes_.notify_all();
}

void Background::cancel() {
  const std::lock_guard lock(mutex_);
  stop_ = true;
  next_ = nullptr;
}

void Background::run() {
  std::unique_lock lock(mutex_);
  while (!ends_) {
    if (!old_.empty()) {
      auto old = std::move(old_);
      old_.clear();
      lock.unlock();
      old.clear();
      lock.lock();
      continue;
    }
    if (next_ == nullptr) {
      wakes_.wait(lock);
      continue;
    }
    if (std::chrono::steady_clock::now() < due_) {
      wakes_.wait_until(lock, due_);
      continue;
    }
    const Work work = std::move(next_);
    next_ = nullptr;
    stop_ = false;
    lock.unlock();
    work(stop_);
    lock.lock();
  }
}

}  // namespace probe::lsp
