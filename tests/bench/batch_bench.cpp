// Eight observations in one message beside one alone, and beside eight alone at once, over openpi's
// wire to our own server, whose forward pass takes 100 ms whatever it carries.
#include <benchmark/benchmark.h>

#include <chrono>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "runtime/servers/batch.h"
#include "runtime/servers/protocol.h"
#include "runtime/servers/served.h"
#include "runtime/servers/servers.h"
#include "tests/bench/need.h"

namespace {

using namespace probe::servers;
using probe::bench::need;

constexpr std::chrono::milliseconds kForward{100};
constexpr std::size_t kWorlds = 8;

// One forward pass after the other, as on a GPU.
class Forward final : public ServedPolicy {
 public:
  explicit Forward(std::shared_ptr<std::mutex> gpu) : gpu_(std::move(gpu)) {}
  void reset() override {}
  probe::Result<std::vector<probe::policy::Action>> answer(const Asked&, int count) override {
    pass();
    return still(count);
  }
  probe::Result<std::vector<std::vector<probe::policy::Action>>> answer_all(
      std::span<const Asked> asked, int count) override {
    pass();
    return std::vector<std::vector<probe::policy::Action>>(asked.size(), still(count));
  }

 private:
  static std::vector<probe::policy::Action> still(int count) {
    return std::vector<probe::policy::Action>(static_cast<std::size_t>(count),
                                              probe::policy::Action{0, 0, 0, 0, 0, 0, 1});
  }
  void pass() const {
    const std::lock_guard one_at_a_time(*gpu_);
    std::this_thread::sleep_for(kForward);
  }
  std::shared_ptr<std::mutex> gpu_;
};

Request seen() {
  Request request;
  request.prompt = "put carrot on plate";
  // As openpi's clients send it.
  request.images.push_back(
      {"observation/image",
       probe::wire::array_u8({224, 224, 3}, probe::wire::Bytes(224 * 224 * 3))});
  request.state = std::vector<double>(8, 0.5);
  return request;
}

// `worlds` of them ask once each, at the same time.
void ask(benchmark::State& state, std::size_t worlds, int batch) {
  ServeOptions options;
  options.batch = static_cast<int>(kWorlds);
  const auto gpu = std::make_shared<std::mutex>();
  options.policy = [gpu] { return std::make_unique<Forward>(gpu); };
  const auto listener = need(serve(Protocol::kOpenpi, options));
  const auto choice = need(choose_server(
      Protocol::kOpenpi, "//127.0.0.1:" + listener->port() + "?batch=" + std::to_string(batch)));
  std::shared_ptr<BatchLine> line;
  std::vector<std::unique_ptr<Transport>> transports;
  for (std::size_t i = 0; i < worlds; ++i) {
    auto own = [&] { return need(make_transport(choice)); };
    if (batch > 1 && !line) line = std::make_shared<BatchLine>(own(), choice.batch, nullptr);
    transports.push_back(batch > 1 ? make_batched(line) : own());
    need(transports.back()->open({}));
    need(transports.back()->begin_episode({}, {}));
  }
  const Request request = seen();
  for (auto _ : state) {
    std::vector<std::thread> threads;
    for (const auto& transport : transports)
      threads.emplace_back([&] { need(transport->ask(request, {})); });
    for (std::thread& thread : threads) thread.join();
  }
  state.counters["observations"] =
      benchmark::Counter(static_cast<double>(state.iterations()) * static_cast<double>(worlds),
                         benchmark::Counter::kIsRate);
}

BENCHMARK_CAPTURE(ask, one, 1, 1)
    ->Name("batch/one_alone")
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(ask, eight, kWorlds, 8)
    ->Name("batch/eight_in_one_message")
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(ask, eight_alone, kWorlds, 1)
    ->Name("batch/eight_alone")
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
