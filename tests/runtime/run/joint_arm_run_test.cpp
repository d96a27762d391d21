// Robots that are told their joints, from the example's text to results: traces that say their
// count, replay bit for bit, stored actions acted again, and the same behind a server.
#include <doctest/doctest.h>

#include <fstream>
#include <iterator>
#include <string>

#include "runtime/run/recorded.h"
#include "runtime/run/replay.h"
#include "runtime/servers/protocol.h"
#include "runtime/store/proof.h"
#include "runtime/store/stored_trace.h"
#include "tests/runtime/run/plan_of_text.h"
#include "tests/runtime/run/run_checks.h"
#include "tests/runtime/run/temporary_folder.h"

namespace probe::run {
namespace {

const plan::Plan& example() {
  static const plan::Plan plan =
      plan_of_file(VLAPROBE_SOURCE_DIR "/examples/joint_arm.probe", "joint_arm");
  return plan;
}

RunOptions two_of(const std::string& task, const std::string& out, const std::string& policy) {
  RunOptions options = options_for(out, policy);
  options.tasks = task;
  options.episodes = {0, 1};
  return options;
}

std::string address_of(const wire::Listener& listener, const servers::ServeOptions& options) {
  return "openpi://127.0.0.1:" + listener.port() + "?" +
         servers::options_for_served(servers::Protocol::kOpenpi, options);
}

TEST_CASE("what an arm was told by its joints is stored, proven, repeated and served") {
  for (const auto& [task, law] : {std::pair{"told_carrot_on_plate", "joint_position"},
                                  std::pair{"stepped_carrot_on_plate", "joint_delta"}}) {
    CAPTURE(task);
    const TemporaryFolder folder;
    CHECK(must_run(example(), two_of(task, folder / "expert", "expert")).invalid == 0);
    const auto proven = store::read_proven_results(folder / "expert");
    REQUIRE_MESSAGE(proven.ok(), to_text(proven.failure()));
    CHECK(proven->refused.empty());
    REQUIRE(proven->rows.size() == 2);
    for (const ResultRow& row : proven->rows) {
      CHECK(row.metrics.front().name == "success");
      CHECK(row.metrics.front().value == 1);
      const auto trace = store::read_stored_trace(row);
      REQUIRE(trace.ok());
      REQUIRE(trace->header.joint_actions.has_value());
      CHECK(trace->header.joint_actions->law == law);
      CHECK(trace->header.joint_actions->count == 8);
      CHECK(trace->steps.front().action.size() == 8);
      ReplayOptions replaying;
      replaying.verify = true;
      replaying.assets = options_for("").assets;
      const auto again = replay(folder / "expert", task, row.episode, std::nullopt, replaying);
      REQUIRE_MESSAGE(again.ok(), to_text(again.failure()));
      CHECK_MESSAGE(again->identical, again->difference);
    }
    must_run(example(), two_of(task, folder / "again", "replay:" + folder / "expert"));

    const auto episodes = recorded_episodes(folder / "expert");
    REQUIRE_MESSAGE(episodes.ok(), to_text(episodes.failure()));
    servers::ServeOptions served;
    served.chunk = 4;
    const auto actions = only_actions(folder / "expert");
    REQUIRE(actions.ok());
    CHECK((actions->form == servers::ActionForm::kJoints) ==
          (std::string(law) == "joint_position"));
    CHECK(actions->arm_joints == 7);
    served.actions = *actions;
    CHECK(servers::options_for_served(servers::Protocol::kOpenpi, served).find("&arm.joints=7") !=
          std::string::npos);
    served.policy = servers::serve_recorded(*episodes, false);
    const auto listener = servers::serve(servers::Protocol::kOpenpi, served);
    REQUIRE_MESSAGE(listener.ok(), to_text(listener.failure()));
    must_run(example(), two_of(task, folder / "served", address_of(**listener, served)));
    for (const char* other : {"again", "served"}) {
      CAPTURE(other);
      const auto rows = read_results(folder / other);
      REQUIRE(rows.ok());
      REQUIRE(rows->size() == 2);
      for (std::size_t i = 0; i < 2; ++i) {
        REQUIRE_MESSAGE(!(*rows)[i].invalid, (*rows)[i].invalid.value_or(""));
        const auto here = store::read_stored_trace((*rows)[i]),
                   there = store::read_stored_trace(proven->rows[i]);
        REQUIRE((here.ok() && there.ok()));
        REQUIRE(here->steps.size() == there->steps.size());
        for (std::size_t k = 0; k < here->steps.size(); ++k)
          REQUIRE(here->steps[k].state_hash == there->steps[k].state_hash);
      }
    }
    // A server whose actions are a tool's is refused before the first episode.
    servers::ServeOptions tool;
    tool.policy = servers::serve_null().value();
    const auto other = servers::serve(servers::Protocol::kOpenpi, tool);
    REQUIRE_MESSAGE(other.ok(), to_text(other.failure()));
    const auto refused =
        run::run(example(), two_of(task, folder / "wrong", address_of(**other, tool)));
    REQUIRE_FALSE(refused.ok());
    CHECK_MESSAGE(refused.failure().message.find("are `delta` (`action.form`), and a robot of the "
                                                 "run is controlled by `" +
                                                 std::string(law) + "`") != std::string::npos,
                  refused.failure().message);
  }
}

TEST_CASE(
    "null and digest are served to an arm that is told steps, and refused one told positions") {
  const auto of_task = [](const char* name) {
    const std::uint32_t task[] = {example().find_task(name).value()};
    const auto actions = only_actions(example(), task, options_for("").assets);
    REQUIRE_MESSAGE(actions.ok(), to_text(actions.failure()));
    return *actions;
  };
  const servers::ServedActions steps = of_task("stepped_carrot_on_plate");
  CHECK(steps.form == servers::ActionForm::kJointSteps);
  CHECK(steps.arm_joints == 7);
  for (const bool is_null : {true, false}) {
    const TemporaryFolder folder;
    servers::ServeOptions served;
    served.actions = steps;
    served.policy = (is_null ? servers::serve_null(steps) : servers::serve_digest(steps)).value();
    const auto listener = servers::serve(servers::Protocol::kOpenpi, served);
    REQUIRE_MESSAGE(listener.ok(), to_text(listener.failure()));
    must_run(example(),
             two_of("stepped_carrot_on_plate", folder / "asked", address_of(**listener, served)));
    const auto rows = read_results(folder / "asked");
    REQUIRE(rows.ok());
    REQUIRE(rows->size() == 2);
    const auto trace = store::read_stored_trace(rows->front());
    REQUIRE(trace.ok());
    policy::Action still = policy::Action::zeros(8);
    still.gripper() = 1;
    CHECK((trace->steps.front().action == still) == is_null);
  }
  const servers::ServedActions positions = of_task("told_carrot_on_plate");
  for (const auto& refused : {servers::serve_null(positions), servers::serve_digest(positions)}) {
    REQUIRE_FALSE(refused.ok());
    CHECK(refused.failure().code == Fault::kUsage);
    CHECK(refused.failure().message.find("under `joint_position` no question says where its joints "
                                         "are") != std::string::npos);
  }
  const std::uint32_t both[] = {example().find_task("told_carrot_on_plate").value(),
                                example().find_task("stepped_carrot_on_plate").value()};
  CHECK(only_actions(example(), both, options_for("").assets)
            .failure()
            .message.find("several laws or arms") != std::string::npos);
}

// As somebody else's text has them: the same task, its arm told steps in place of positions.
plan::Plan stepped_instead() {
  std::ifstream file(VLAPROBE_SOURCE_DIR "/examples/joint_arm.probe");
  std::string text((std::istreambuf_iterator<char>(file)), {});
  const auto put = [&](const std::string& from, const std::string& to) {
    REQUIRE(text.find(from) != std::string::npos);
    text.replace(text.find(from), from.size(), to);
  };
  put("../suite/panda.probe", "suite/panda.probe");
  put("control joint_position 5Hz", "control joint_delta 5Hz");
  put("suite joint_arm ", "suite mine ");
  return plan_of_text(text);
}

TEST_CASE("stored positions of joints are not acted as steps of them") {
  const TemporaryFolder folder;
  const std::string task = "told_carrot_on_plate";
  RunOptions recorded = two_of(task, folder / "run", "null");
  recorded.episodes = {0, 0};
  must_run(example(), recorded);
  RunOptions again = two_of(task, folder / "again", "replay:" + folder / "run");
  again.episodes = {0, 0};
  const plan::Plan other = stepped_instead();
  CHECK(must_run(other, again).invalid == 1);
  const auto rows = store::read_results(folder / "again");
  REQUIRE(rows.ok());
  CHECK(rows->front().invalid.value_or("").find(
            "the stored episode's actions are of joints, as `joint_position` takes them, this "
            "robot's of joints, as `joint_delta` takes them") != std::string::npos);
}

TEST_CASE("actions of joints are served by protocols that have them alone, and of one law") {
  servers::ServeOptions options;
  options.actions.form = servers::ActionForm::kJoints;
  options.policy = servers::serve_null().value();
  const auto refused = servers::serve(servers::Protocol::kIntact, options);
  REQUIRE_FALSE(refused.ok());
  CHECK(refused.failure().message == "protocol intact has no actions of joints, as these are");
  const TemporaryFolder folder;
  RunOptions both = options_for(folder / "both", "null");
  both.episodes = {0, 0};
  must_run(example(), both);
  const auto mixed = only_actions(folder / "both");
  REQUIRE_FALSE(mixed.ok());
  CHECK(mixed.failure().message.find("has actions of several laws") == 0);
}

TEST_CASE("policies that draw, and worlds that do not wait, act by joints and repeat") {
  const TemporaryFolder folder;
  for (const char* policy : {"random", "noisy:0.005"}) {
    CAPTURE(policy);
    const std::string out = folder / std::string(policy).substr(0, 5);
    CHECK(must_run(example(), two_of("*", out, policy)).invalid == 0);
  }
  RunOptions live = two_of("told_*", folder / "live", "expert");
  live.live = policy::LiveTerms{.delay_s = 0.3, .most_held = 1};
  CHECK(must_run(example(), live).invalid == 0);
  const auto rows = read_results(folder / "live");
  REQUIRE(rows.ok());
  for (const ResultRow& row : *rows) {
    const auto trace = store::read_stored_trace(row);
    REQUIRE(trace.ok());
    // Without an answer the arm is told to stay where it is.
    REQUIRE(trace->steps.front().live->source == policy::LiveSource::kHeld);
    for (std::size_t k = 0; k < 7; ++k) CHECK(trace->steps.front().action[k] == trace->start->q[k]);
    ReplayOptions replaying;
    replaying.verify = true;
    replaying.assets = options_for("").assets;
    const auto again = replay(folder / "live", row.task, row.episode, std::nullopt, replaying);
    REQUIRE_MESSAGE(again.ok(), to_text(again.failure()));
    CHECK_MESSAGE(again->identical, again->difference);
  }
}

}  // namespace
}  // namespace probe::run
