// Runs whose worlds ask in batches are the runs whose worlds ask alone.
#include <set>

#include "runtime/run/recorded.h"
#include "runtime/servers/protocol.h"
#include "runtime/servers/served.h"
#include "tests/runtime/run/served.h"

namespace probe::run {
using namespace probe::store;
using namespace probe::servers;

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
