// Our own reference servers: results of the expert behind each protocol are those in process.
#include "runtime/run/recorded.h"
#include "runtime/servers/protocol.h"
#include "tests/runtime/run/run_checks.h"
#include "tests/runtime/run/served.h"
#include "tests/runtime/run/table_plan.h"

namespace probe::run {
namespace {

struct Form {
  const char* dialect;
  int chunk;
  int jobs;  // servers with one policy for all connections want one world
};

std::vector<Form> forms_of(servers::Protocol protocol) {
  switch (protocol) {
    case servers::Protocol::kGr00t:
      return {{"n1.6", 16, 1}, {"n1.6_nested", 16, 1}, {"n1.5", 16, 1}};
    case servers::Protocol::kOpenVla:
      return {{"plain", 8, 1}, {"encoded", 1, 1}};
    case servers::Protocol::kLeRobot:
      return {{"", 8, 1}};
    default:
      return {{"", 4, 2}};
  }
}

std::string address_of(servers::Protocol protocol, const wire::Listener& listener,
                       const servers::ServeOptions& options) {
  return std::string(servers::to_word(protocol)) + "://127.0.0.1:" + listener.port() + "?" +
         servers::options_for_served(protocol, options);
}

}  // namespace

TEST_CASE("24 episodes of our own servers are those in process, bit for bit, on every protocol") {
  ServedRun run(ServedRun::Pictures::kSmall);
  const auto episodes = recorded_episodes(run.in_process_folder());
  REQUIRE_MESSAGE(episodes.ok(), to_text(episodes.failure()));
  CHECK((*episodes)->size() == 24);
  for (const servers::Protocol protocol : servers::all_protocols()) {
    for (const Form& form : forms_of(protocol)) {
      CAPTURE(std::string(servers::to_word(protocol)));
      CAPTURE(std::string(form.dialect));
      servers::ServeOptions options;
      options.chunk = form.chunk;
      options.dialect = form.dialect;
      options.policy =
          servers::serve_recorded(*episodes, !servers::has_reset(protocol, form.dialect));
      const auto listener = servers::serve(protocol, options);
      REQUIRE_MESSAGE(listener.ok(), to_text(listener.failure()));
      run.check_equal(address_of(protocol, **listener, options), form.jobs);
      // What is asked before and after the episodes changes none of them.
      const auto calls = read_run_calls(run.served_folder());
      REQUIRE(calls.ok());
      REQUIRE(calls->back().reading.has_value());
      CHECK(calls->back().reading->is_steady);
      CHECK(calls->back().reading->at_end == policy::AtEnd::kSame);
    }
  }
}

TEST_CASE("of a policy that draws one seed is served, and runs of others are refused by name") {
  TemporaryFolder folder;
  const plan::Plan plan = table_plan(2, 6);
  RunOptions options = options_for(folder / "noisy", "noisy:0.01");
  options.seeds = {7};
  options.name = "shaken";
  must_run(plan, options);
  CHECK(only_seed(folder / "noisy").value() == 7);
  must_run(plan, options_for(folder / "expert", "expert"));
  CHECK_FALSE(only_seed(folder / "expert").value().has_value());
  const auto episodes = recorded_episodes(folder / "noisy");
  REQUIRE_MESSAGE(episodes.ok(), to_text(episodes.failure()));
  servers::ServeOptions served;
  served.seed = 7;
  served.policy = servers::serve_recorded(*episodes, false);
  const auto listener = servers::serve(servers::Protocol::kIntact, served);
  REQUIRE_MESSAGE(listener.ok(), to_text(listener.failure()));
  RunOptions asked =
      options_for(folder / "asked", address_of(servers::Protocol::kIntact, **listener, served));
  asked.seeds = {7, 8};
  const auto refused = run::run(plan, asked);
  REQUIRE_FALSE(refused.ok());
  CHECK(refused.failure().code == Fault::kUsage);
  CHECK(refused.failure().message ==
        "the server has the episodes of seed 7, not of seed 8: run with --seeds 7");
  asked.seeds = {7};
  must_run(plan, asked);
  // Two seeds begin alike: nobody could tell which is asked for.
  options.seeds = {7, 8};
  must_run(plan, options);
  CHECK_FALSE(only_seed(folder / "noisy").value().has_value());
  const auto both = recorded_episodes(folder / "noisy");
  REQUIRE_FALSE(both.ok());
  CHECK(both.failure().message.find("begins as one of another seed and goes on otherwise") !=
        std::string::npos);
}

}  // namespace probe::run
