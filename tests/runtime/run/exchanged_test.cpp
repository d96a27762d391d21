// A policy server behind whose address another policy is put, between two calls of a run or in the
// middle of one.
#include <doctest/doctest.h>

#include <atomic>
#include <memory>

#include "runtime/run/run.h"
#include "runtime/servers/known_observations.h"
#include "runtime/servers/reading.h"
#include "runtime/servers/served.h"
#include "runtime/servers/servers.h"
#include "runtime/store/store.h"
#include "tests/runtime/run/table_plan.h"
#include "tests/runtime/run/temporary_folder.h"
#include "tests/servers/python_server.h"

namespace probe::run {
using namespace probe::store;
namespace {

RunOptions served_options(const std::string& out, const test::PythonServer& server,
                          const std::string& options) {
  REQUIRE_MESSAGE(!server.port().empty(), "Debian's python3-websockets is installed");
  RunOptions run;
  run.policy = "intact://127.0.0.1:" + server.port() + "?worlds=many&timeout.wait_s=0.05" + options;
  run.name = "mine";
  run.out = out;
  run.seeds = {42};
  run.assets = std::string(VLAPROBE_SOURCE_DIR) + "/assets";
  return run;
}

const RunCall last_call(const std::string& dir) {
  const auto calls = read_run_calls(dir);
  REQUIRE(calls.ok());
  REQUIRE_FALSE(calls->empty());
  REQUIRE(calls->back().reading.has_value());
  return calls->back();
}

int valid_rows(const std::string& dir) {
  const auto rows = read_results(dir);
  REQUIRE_MESSAGE(rows.ok(), to_text(rows.failure()));
  int valid = 0;
  for (const ResultRow& row : *rows) valid += row.invalid ? 0 : 1;
  return valid;
}

// Somebody else has the server load another model.
void load_other(servers::Protocol protocol, const std::string& port, const std::string& options) {
  const auto other = servers::choose_server(protocol, "//127.0.0.1:" + port + "?" + options);
  REQUIRE_MESSAGE(other.ok(), to_text(other.failure()));
  const auto reading = servers::prove_reading(*other);
  REQUIRE_MESSAGE(reading.ok(), to_text(reading.failure()));
  CHECK(reading->failure == "");
}

// A server of actions that follow from what is asked, on a port where another takes its place.
class Exchangeable {
 public:
  explicit Exchangeable(const std::string& habit, const std::string& more = "") {
    begin(habit, more);
    port_ = server_->port();
  }
  void exchange(const std::string& habit) {
    server_.reset();
    begin(habit, "");
  }
  void leave() { server_.reset(); }
  RunOptions options(const std::string& out, const std::string& wait_s = "10") const {
    RunOptions run;
    run.policy = "openpi://127.0.0.1:" + port_ +
                 "?action.form=delta&action.units=m_rad&action.rotation=vector&chunk.length=any"
                 "&chunk.use=all&timeout.wait_s=" +
                 wait_s;
    run.name = "mine";
    run.out = out;
    run.seeds = {42};
    run.assets = std::string(VLAPROBE_SOURCE_DIR) + "/assets";
    return run;
  }

 private:
  void begin(const std::string& habit, const std::string& more) {
    std::vector<std::string> words = {"openpi", "seen=" + habit};
    if (!port_.empty()) words.push_back("port=" + port_);
    if (!more.empty()) words.push_back(more);
    server_ = std::make_unique<test::PythonServer>("openpi_server.py", words);
    REQUIRE_MESSAGE(!server_->port().empty(), "Debian's python3-websockets is installed");
  }
  std::unique_ptr<test::PythonServer> server_;
  std::string port_;
};

// A server whose connections stand whatever becomes of its model, which changes in its place.
class Switched final : public servers::ServedPolicy {
 public:
  struct State {
    std::atomic<int> model = 0;
    std::atomic<int> proofs = 0;  // questions of no episode
  };
  explicit Switched(std::shared_ptr<State> state)
      : state_(std::move(state)), digest_(servers::serve_digest().value()()) {}
  void reset() override {}
  Result<std::vector<policy::Action>> answer(const servers::Asked& asked, int count) override {
    if (servers::is_known_observation(asked.picture.bytes, asked.words)) ++state_->proofs;
    servers::Asked seen = asked;
    seen.words += std::to_string(state_->model);
    return digest_->answer(seen, count);
  }

 private:
  std::shared_ptr<State> state_;
  std::unique_ptr<servers::ServedPolicy> digest_;
};

std::vector<std::string> hashes_of(const std::string& dir) {
  const auto rows = read_results(dir);
  REQUIRE_MESSAGE(rows.ok(), to_text(rows.failure()));
  std::vector<std::string> hashes;
  for (const ResultRow& row : *rows) hashes.push_back(row.invalid ? "" : row.trace_sha256);
  return hashes;
}

}  // namespace

TEST_CASE("who answers is asked again after each lost connection, before an episode counts") {
  TemporaryFolder folder;
  const plan::Plan plan = table_plan(4, 4);
  Exchangeable server("fine");
  RunOptions options = server.options(folder / "run");
  options.progress = [&](const RunProgress& progress) {
    if (progress.done == 2) server.exchange("fine");  // restarted
  };
  const auto restarted = run::run(plan, options);
  REQUIRE_MESSAGE(restarted.ok(), to_text(restarted.failure()));
  CHECK(valid_rows(folder / "run") == 4);
  // Another one that answered in between, and was gone when the call would have ended.
  options.out = folder / "other";
  options.progress = [&](const RunProgress& progress) {
    if (progress.done == 2) server.exchange("numb");
  };
  const auto spoiled = run::run(plan, options);
  REQUIRE_FALSE(spoiled.ok());
  CHECK(spoiled.failure().code == Fault::kPolicy);
  CHECK(spoiled.failure().message.find("another policy answers than at the beginning") !=
        std::string::npos);
  CHECK(valid_rows(folder / "other") == 0);
  CHECK(last_call(folder / "other").reading->at_end == policy::AtEnd::kOther);
  server.exchange("fine");
  options.progress = nullptr;
  REQUIRE(run::run(plan, options).ok());
  CHECK(hashes_of(folder / "other") == hashes_of(folder / "run"));
}

TEST_CASE(
    "rows of a call that was never shown to have had one policy are the next one's to judge") {
  const plan::Plan plan = table_plan(3, 4);
  for (const bool is_other : {false, true}) {
    TemporaryFolder folder;
    Exchangeable server("fine");
    RunOptions options = server.options(folder / "run", "0.05");
    options.retries = 0;
    options.give_up_after = 1;
    options.progress = [&](const RunProgress& progress) {
      if (progress.done == 1) server.leave();
    };
    CHECK_FALSE(run::run(plan, options).ok());
    CHECK(valid_rows(folder / "run") == 1);
    server.exchange(is_other ? "numb" : "fine");
    options.progress = nullptr;
    const auto again = run::run(plan, options);
    CHECK(again.ok() == !is_other);
    CHECK(valid_rows(folder / "run") == (is_other ? 0 : 3));
    if (!is_other) continue;
    CHECK(again.failure().code == Fault::kStore);
    // Not beside those of another, either.
    options.if_changed = IfChanged::kContinue;
    CHECK(run::run(plan, options).ok());
    CHECK(valid_rows(folder / "run") == 3);
  }
}

TEST_CASE("a policy that draws at the end and did not when the call began spoils what it did") {
  TemporaryFolder folder;
  const plan::Plan plan = table_plan(2, 4);
  Exchangeable server("fine");
  RunOptions options = server.options(folder / "run");
  options.progress = [&](const RunProgress& progress) {
    if (progress.done == 2) server.exchange("noise");
  };
  const auto spoiled = run::run(plan, options);
  REQUIRE_FALSE(spoiled.ok());
  CHECK(spoiled.failure().message.find("the 2 episodes of this call are invalid") !=
        std::string::npos);
  CHECK(last_call(folder / "run").reading->at_end == policy::AtEnd::kDrawn);
  CHECK(valid_rows(folder / "run") == 0);
  // Nothing that answers says nothing: the rows wait for whoever answers next.
  options = server.options(folder / "gone", "0.05");
  server.exchange("fine");
  options.progress = [&](const RunProgress& progress) {
    if (progress.done == 2) server.leave();
  };
  const auto gone = run::run(plan, options);
  REQUIRE_MESSAGE(gone.ok(), to_text(gone.failure()));
  CHECK(last_call(folder / "gone").reading->at_end == policy::AtEnd::kUnclear);
  CHECK(valid_rows(folder / "gone") == 2);
  server.exchange("numb");
  options.progress = nullptr;
  CHECK_FALSE(run::run(plan, options).ok());
  CHECK(valid_rows(folder / "gone") == 0);
}

TEST_CASE("first questions that fail are asked again, and of a server that stays so no call is") {
  TemporaryFolder folder;
  const plan::Plan plan = table_plan(1, 4);
  {
    const Exchangeable server("fine", "warm=2");
    const auto ran = run::run(plan, server.options(folder / "warm"));
    REQUIRE_MESSAGE(ran.ok(), to_text(ran.failure()));
    CHECK(last_call(folder / "warm").reading->is_steady);
    CHECK(last_call(folder / "warm").reading->at_end == policy::AtEnd::kSame);
  }
  const Exchangeable server("fine", "warm=1000");
  const auto refused = run::run(plan, server.options(folder / "cold", "0.3"));
  REQUIRE_FALSE(refused.ok());
  CHECK(refused.failure().code == Fault::kPolicy);
  CHECK(refused.failure().message.find("warming up") != std::string::npos);
  CHECK(valid_rows(folder / "cold") == 0);
}

TEST_CASE("of a policy that draws it is said that nothing shows it to be one, or to read") {
  TemporaryFolder folder;
  const plan::Plan plan = table_plan(2, 4);
  Exchangeable server("noise", R"(meta={"checkpoint": "A"})");
  RunOptions options = server.options(folder / "run");
  const auto ran = run::run(plan, options);
  REQUIRE_MESSAGE(ran.ok(), to_text(ran.failure()));
  const auto reading = *last_call(folder / "run").reading;
  CHECK(reading.draws);
  const auto summary = summarize_readings(*read_run_calls(folder / "run"));
  CHECK(summary.good == "");
  REQUIRE_FALSE(summary.findings.empty());
  CHECK(summary.findings.front().find("draws: that it was one policy is not shown") !=
        std::string::npos);
  // What it says of itself is all there is to know it by.
  options.out = folder / "other";
  options.progress = [&](const RunProgress& progress) {
    if (progress.done == 1) server.exchange("noise");
  };
  const auto other = run::run(plan, options);
  REQUIRE_FALSE(other.ok());
  CHECK(valid_rows(folder / "other") == 0);
}

TEST_CASE("answers that are one too old spoil their episode, which is done again") {
  TemporaryFolder folder;
  const plan::Plan plan = table_plan(2, 12);
  const Exchangeable plain("fine");
  const auto meant = run::run(plan, plain.options(folder / "plain"));
  REQUIRE_MESSAGE(meant.ok(), to_text(meant.failure()));
  const Exchangeable lagging("fine", "lag=7");
  const auto ran = run::run(plan, lagging.options(folder / "lag"));
  REQUIRE_MESSAGE(ran.ok(), to_text(ran.failure()));
  CHECK(ran->call.retried >= 1);
  CHECK(hashes_of(folder / "lag") == hashes_of(folder / "plain"));
}

TEST_CASE("a run does not go on at a server whose policy behind the same name is another one") {
  TemporaryFolder folder;
  const plan::Plan plan = table_plan(3, 4);
  const std::string out = folder / "run";
  const auto call = [&](const std::string& habit, int last, IfChanged if_changed) {
    const test::PythonServer server("openpi_server.py", {"intact", "seen=" + habit, "chunk=2"});
    RunOptions options = served_options(out, server, "&model=/m");
    options.episodes = {0, last};
    options.if_changed = if_changed;
    return run::run(plan, options);
  };
  const auto begun = call("fine", 0, IfChanged::kRefuse);
  REQUIRE_MESSAGE(begun.ok(), to_text(begun.failure()));
  CHECK(last_call(out).reading->is_steady);
  CHECK(last_call(out).reading->at_end == policy::AtEnd::kSame);
  CHECK(call("fine", 1, IfChanged::kRefuse).ok());
  const auto other = call("numb", 2, IfChanged::kRefuse);
  REQUIRE_FALSE(other.ok());
  CHECK(other.failure().code == Fault::kStore);
  CHECK(other.failure().where == out);
  CHECK(other.failure().message.find("answered the first questions otherwise than the one at") !=
        std::string::npos);
  CHECK(other.failure().message.find("--if-changed continue") != std::string::npos);
  CHECK(valid_rows(out) == 2);
  const auto mixed = call("numb", 2, IfChanged::kContinue);
  REQUIRE_MESSAGE(mixed.ok(), to_text(mixed.failure()));
  CHECK(valid_rows(out) == 3);
}

TEST_CASE("answers that are drawn say nothing of another policy") {
  TemporaryFolder folder;
  const plan::Plan plan = table_plan(2, 4);
  for (int last = 0; last < 2; ++last) {
    const test::PythonServer server("openpi_server.py", {"intact", "seen=noise"});
    RunOptions options = served_options(folder / "run", server, "&model=/m");
    options.episodes = {0, last};
    const auto ran = run::run(plan, options);
    REQUIRE_MESSAGE(ran.ok(), to_text(ran.failure()));
    CHECK_FALSE(last_call(folder / "run").reading->is_steady);
    CHECK(last_call(folder / "run").reading->at_end == policy::AtEnd::kNotAsked);
  }
}

TEST_CASE(
    "a policy that another run had LeRobot's server load in the middle of one answers none of it") {
  TemporaryFolder folder;
  const plan::Plan plan = table_plan(2, 4);
  const test::PythonServer server("lerobot_server.py", {"seen"});
  REQUIRE_FALSE(server.port().empty());
  const std::string meant =
      "type=smolvla&device=cpu&action.form=delta&action.units=m_rad&action.rotation=vector"
      "&action.gripper=signed&action.threshold=none&timeout.wait_s=0.05&model=";
  RunOptions options = served_options(folder / "run", server, "");
  options.policy = "lerobot://127.0.0.1:" + server.port() + "?" + meant + "/m";
  options.out = folder / "alone";
  const auto alone = run::run(plan, options);
  REQUIRE_MESSAGE(alone.ok(), to_text(alone.failure()));
  CHECK(alone->call.retried == 0);
  options.out = folder / "run";
  options.progress = [&](const RunProgress& progress) {
    if (progress.done == 1)
      load_other(servers::Protocol::kLeRobot, server.port(), meant + "/other");
  };
  const auto ran = run::run(plan, options);
  REQUIRE_MESSAGE(ran.ok(), to_text(ran.failure()));
  CHECK(ran->call.retried >= 1);
  CHECK(last_call(folder / "run").reading->at_end == policy::AtEnd::kSame);
  CHECK(valid_rows(folder / "run") == 2);
  CHECK(hashes_of(folder / "run") == hashes_of(folder / "alone"));
}

TEST_CASE(
    "another model that came and went behind standing connections spoils what it may have "
    "answered") {
  constexpr int kSteps = 30, kEpisodes = 7;
  for (const auto protocol : {servers::Protocol::kOpenVla, servers::Protocol::kIntact}) {
    CAPTURE(std::string(servers::to_word(protocol)));
    TemporaryFolder folder;
    const plan::Plan plan = table_plan(kEpisodes, kSteps);
    const auto state = std::make_shared<Switched::State>();
    servers::ServeOptions serve;
    serve.policy = [state] { return std::make_unique<Switched>(state); };
    const auto listener = servers::serve(protocol, serve);
    REQUIRE(listener.ok());
    RunOptions options;
    options.policy =
        servers::address_of_served(protocol, serve, "127.0.0.1:" + (*listener)->port());
    options.name = "mine";
    options.seeds = {42};
    options.assets = std::string(VLAPROBE_SOURCE_DIR) + "/assets";
    options.out = folder / "plain";
    const auto plain = run::run(plan, options);
    REQUIRE_MESSAGE(plain.ok(), to_text(plain.failure()));
    // Four as the call begins, one over the connection, one behind the second, fourth and sixth
    // episode each, and three as it ends.
    CHECK(state->proofs == 11);

    options.out = folder / "run";
    options.progress = [&](const RunProgress& progress) {
      if (progress.done == 3) state->model = 1;
      if (progress.done == 5) state->model = 0;
    };
    const auto spoiled = run::run(plan, options);
    REQUIRE_FALSE(spoiled.ok());
    CHECK(spoiled.failure().code == Fault::kPolicy);
    CHECK(spoiled.failure().message.find(
              "the 2 episodes of this call since it was last shown to be the same are invalid") !=
          std::string::npos);
    CHECK(last_call(folder / "run").reading->at_end == policy::AtEnd::kOther);
    CHECK(valid_rows(folder / "run") == 2);
    options.progress = nullptr;
    const auto again = run::run(plan, options);
    REQUIRE_MESSAGE(again.ok(), to_text(again.failure()));
    CHECK(hashes_of(folder / "run") == hashes_of(folder / "plain"));
  }
}

TEST_CASE("a policy that is exchanged in the middle of a run spoils what the call did") {
  TemporaryFolder folder;
  const plan::Plan plan = table_plan(3, 4);
  const test::PythonServer server("openpi_digest_server.py");
  RunOptions options = served_options(folder / "run", server, "&model=/m");
  options.episodes = {0, 0};
  REQUIRE(run::run(plan, options).ok());
  options.episodes.reset();
  options.progress = [&](const RunProgress& progress) {
    if (progress.done == 1)
      load_other(servers::Protocol::kIntact, server.port(), "model=/other&worlds=many");
  };
  const auto spoiled = run::run(plan, options);
  REQUIRE_FALSE(spoiled.ok());
  CHECK(spoiled.failure().code == Fault::kPolicy);
  CHECK(spoiled.failure().message.find("the 2 episodes of this call are invalid") !=
        std::string::npos);
  CHECK(last_call(folder / "run").reading->at_end == policy::AtEnd::kOther);
  CHECK(valid_rows(folder / "run") == 1);
  const auto summary = summarize_readings(*read_run_calls(folder / "run"));
  REQUIRE_FALSE(summary.findings.empty());
  CHECK(summary.findings.back().find("another policy was loaded") != std::string::npos);
  // Invalid rows and their whole traces go together, and the same command does them again.
  options.progress = nullptr;
  const auto again = run::run(plan, options);
  REQUIRE_MESSAGE(again.ok(), to_text(again.failure()));
  CHECK(again->done == 2);
  CHECK(valid_rows(folder / "run") == 3);
}

}  // namespace probe::run
