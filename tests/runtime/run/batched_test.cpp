// Runs whose worlds ask in batches are the runs whose worlds ask alone.
#include <algorithm>
#include <atomic>
#include <memory>
#include <set>

#include "runtime/run/recorded.h"
#include "runtime/run/run.h"
#include "runtime/servers/protocol.h"
#include "runtime/servers/served.h"
#include "tests/runtime/run/served.h"
#include "tests/runtime/run/table_plan.h"
#include "tests/runtime/run/temporary_folder.h"

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

// Takes the questions of a message for one another, from its fourth message on.
class Reversing final : public ServedPolicy {
 public:
  Reversing(std::unique_ptr<ServedPolicy> inner, std::atomic<int>& messages)
      : inner_(std::move(inner)), messages_(messages) {}
  void reset() override { inner_->reset(); }
  Result<std::vector<policy::Action>> answer(const Asked& asked, int count) override {
    return inner_->answer(asked, count);
  }
  Result<std::vector<std::vector<policy::Action>>> answer_all(std::span<const Asked> asked,
                                                              int count) override {
    PROBE_ASSIGN(auto answers, inner_->answer_all(asked, count));
    if (++messages_ > 3) std::reverse(answers.begin(), answers.end());
    return answers;
  }

 private:
  std::unique_ptr<ServedPolicy> inner_;
  std::atomic<int>& messages_;
};

}  // namespace

TEST_CASE("batches that are mixed up after they were proved spoil what they may have answered") {
  TemporaryFolder folder;
  const plan::Plan plan = table_plan(4, 4);
  std::atomic<int> messages = 0;
  ServeOptions options;
  options.policy = [inner = serve_digest().value(), &messages] {
    return std::make_unique<Reversing>(inner(), messages);
  };
  options.batch = 4;
  const auto listener = serve(Protocol::kOpenpi, options);
  REQUIRE_MESSAGE(listener.ok(), to_text(listener.failure()));
  RunOptions asked;
  asked.policy = "openpi://127.0.0.1:" + (*listener)->port() + "?" +
                 options_for_served(Protocol::kOpenpi, options) + "&batch_wait_ms=2000";
  asked.name = "mine";
  asked.out = folder / "run";
  asked.seeds = {42};
  asked.jobs = 4;
  asked.assets = std::string(VLAPROBE_SOURCE_DIR) + "/assets";
  const auto ran = run::run(plan, asked);
  REQUIRE_FALSE(ran.ok());
  CHECK(ran.failure().message.find("took the questions of a batch for one another") !=
        std::string::npos);
  const auto rows = read_results(asked.out);
  REQUIRE(rows.ok());
  for (const ResultRow& row : *rows) {
    REQUIRE(row.invalid.has_value());
    CHECK(row.invalid->ends_with(Store::kMixedUp));
  }
}

TEST_CASE("24 episodes that vla-eval's side gathers by 8 are those in process, bit for bit") {
  ServedRun run(ServedRun::Pictures::kSmall);
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
  ServedRun run(ServedRun::Pictures::kSmall);
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
