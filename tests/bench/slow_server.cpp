#include "tests/bench/slow_server.h"

#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <thread>

#include "runtime/servers/protocol.h"
#include "runtime/servers/served.h"
#include "tests/bench/need.h"

namespace probe::bench {
namespace {

// One at a time, in the order of their asking, as a server's queue has them: a mutex would let one
// world starve, which then ends the run alone.
class Gpu {
 public:
  void work(std::chrono::milliseconds time) {
    std::unique_lock lock(mutex_);
    const std::uint64_t mine = next_++;
    turn_.wait(lock, [&] { return mine == now_; });
    lock.unlock();
    std::this_thread::sleep_for(time);
    lock.lock();
    ++now_;
    turn_.notify_all();
  }

 private:
  std::mutex mutex_;
  std::condition_variable turn_;
  std::uint64_t next_ = 0, now_ = 0;
};

class SlowPolicy final : public servers::ServedPolicy {
 public:
  SlowPolicy(std::shared_ptr<Gpu> gpu, std::chrono::milliseconds answer_time)
      : gpu_(std::move(gpu)), answer_time_(answer_time), still_(servers::serve_null().value()()) {}

  void reset() override {}
  Result<std::vector<policy::Action>> answer(const servers::Asked& asked, int count) override {
    if (answer_time_.count() > 0) gpu_->work(answer_time_);
    return still_->answer(asked, count);
  }

 private:
  std::shared_ptr<Gpu> gpu_;
  std::chrono::milliseconds answer_time_;
  std::unique_ptr<servers::ServedPolicy> still_;
};

}  // namespace

SlowServer::SlowServer(servers::Protocol protocol, std::chrono::milliseconds answer_time) {
  servers::ServeOptions options;
  options.chunk = 4;
  options.policy = [gpu = std::make_shared<Gpu>(), answer_time] {
    return std::make_unique<SlowPolicy>(gpu, answer_time);
  };
  listener_ = need(servers::serve(protocol, options));
  policy_ = std::string(servers::to_word(protocol)) + "://127.0.0.1:" + listener_->port() + "?" +
            servers::options_for_served(protocol, options);
}

}  // namespace probe::bench
