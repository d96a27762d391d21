// Runs whose worlds ask in batches are the runs whose worlds ask alone.
#include <algorithm>
#include <atomic>
#include <memory>
#include <set>

#include "runtime/run/recorded.h"
#include "runtime/servers/protocol.h"
#include "runtime/servers/served.h"
#include "tests/runtime/run/served.h"

namespace probe::run {
using namespace probe::store;
using namespace probe::servers;

namespace {

// How many questions were answered at once, of a policy that does as another.
class Counting final : public ServedPolicy {
 public:
  Counting(std::unique_ptr<ServedPolicy> inner, std::atomic<std::size_t>& most)
      : inner_(std::move(inner)), most_(most) {}
  void reset() override { inner_->reset(); }
  Result<std::vector<policy::Action>> answer(const Asked& asked, int count) override {
    return inner_->answer(asked, count);
  }
  Result<std::vector<std::vector<policy::Action>>> answer_all(std::span<const Asked> asked,
                                                              int count) override {
    most_ = std::max(most_.load(), asked.size());  // of one thread
    return inner_->answer_all(asked, count);
  }

 private:
  std::unique_ptr<ServedPolicy> inner_;
  std::atomic<std::size_t>& most_;
};

}  // namespace

TEST_CASE("24 episodes that vla-eval's side gathers by 8 are those in process, bit for bit") {
  ServedRun run;
  const auto steps = recorded_steps(run.in_process_folder(), 1);
  REQUIRE_MESSAGE(steps.ok(), to_text(steps.failure()));
  std::atomic<std::size_t> most = 0;
  ServeOptions options;
  options.policy = [inner = serve_steps(*steps), &most] {
    return std::make_unique<Counting>(inner(), most);
  };
  options.batch = 8;
  const auto listener = serve(Protocol::kVlaEval, options);
  REQUIRE_MESSAGE(listener.ok(), to_text(listener.failure()));
  run.check_equal("vlaeval://127.0.0.1:" + (*listener)->port() + "?" +
                      options_for_served(Protocol::kVlaEval, options) + "&batch_wait_ms=100",
                  8);
  CHECK(most > 1);
  CHECK(most <= 8);
}

TEST_CASE("24 episodes in batches of 8 are those in process, bit for bit, on openpi and starVLA") {
  ServedRun run;
  const auto steps = recorded_steps(run.in_process_folder(), 4);
  REQUIRE_MESSAGE(steps.ok(), to_text(steps.failure()));
  for (const Protocol protocol : {Protocol::kOpenpi, Protocol::kStarVla}) {
    ServeOptions options;
    options.policy = serve_steps(*steps);
    options.batch = 8;
    options.chunk = 4;
    const auto listener = serve(protocol, options);
    REQUIRE_MESSAGE(listener.ok(), to_text(listener.failure()));
    std::string address = std::string(to_word(protocol)) + "://127.0.0.1:" + (*listener)->port() +
                          "?" + options_for_served(protocol, options);
    if (protocol == Protocol::kOpenpi) address += "&image=first -> observation/image";
    // Long enough for eight worlds on a busy machine to come together.
    run.check_equal(address + "&batch_wait_ms=20000", 8);
    const auto calls = read_run_calls(run.served_folder());
    REQUIRE(calls.ok());
    REQUIRE(calls->size() == 1);
    const auto& queries = calls->front().queries;
    // 24 episodes of 60 steps, four actions an answer.
    CHECK(queries.queries == 24 * 15);
    CHECK(queries.batches >= 24 * 15 / 8);
    CHECK(queries.batches < 24 * 15);
    CHECK(queries.most_in_batch == 8);
    CHECK(to_text(calls->front()).find(" batches of ") != std::string::npos);
  }
}

}  // namespace probe::run
