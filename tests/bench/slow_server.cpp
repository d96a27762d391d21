#include "tests/bench/slow_server.h"

#include <mutex>
#include <thread>

#include "runtime/servers/protocol.h"
#include "runtime/servers/served.h"
#include "tests/bench/need.h"

namespace probe::bench {
namespace {

class SlowPolicy final : public servers::ServedPolicy {
 public:
  SlowPolicy(std::shared_ptr<std::mutex> gpu, std::chrono::milliseconds answer_time)
      : gpu_(std::move(gpu)), answer_time_(answer_time), still_(servers::serve_null()()) {}

  void reset() override {}
  Result<std::vector<policy::Action>> answer(const servers::Asked& asked, int count) override {
    if (answer_time_.count() > 0) {
      const std::lock_guard one_at_a_time(*gpu_);
      std::this_thread::sleep_for(answer_time_);
    }
    return still_->answer(asked, count);
  }

 private:
  std::shared_ptr<std::mutex> gpu_;
  std::chrono::milliseconds answer_time_;
  std::unique_ptr<servers::ServedPolicy> still_;
};

}  // namespace

SlowServer::SlowServer(servers::Protocol protocol, std::chrono::milliseconds answer_time) {
  servers::ServeOptions options;
  options.chunk = 4;
  options.policy = [gpu = std::make_shared<std::mutex>(), answer_time] {
    return std::make_unique<SlowPolicy>(gpu, answer_time);
  };
  listener_ = need(servers::serve(protocol, options));
  policy_ = std::string(servers::to_word(protocol)) + "://127.0.0.1:" + listener_->port() + "?" +
            servers::options_for_served(protocol, options);
}

}  // namespace probe::bench
