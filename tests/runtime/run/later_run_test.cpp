// An instruction that changes in the course of the episode: from its text to what a policy is told in
// each step, the trace, results, replay, judging again and stages that are restored.
#include <doctest/doctest.h>

#include <string>

#include "runtime/base/sha256.h"
#include "runtime/rejudge/rejudge.h"
#include "runtime/run/delivery.h"
#include "runtime/run/policies.h"
#include "runtime/run/replay.h"
#include "runtime/stage/stage.h"
#include "runtime/store/proof.h"
#include "runtime/store/stored_trace.h"
#include "tests/runtime/run/plan_of_text.h"
#include "tests/runtime/run/run_checks.h"
#include "tests/runtime/run/temporary_folder.h"

namespace probe::run {
namespace {

constexpr const char* kFirst = "put carrot on plate";

const plan::Plan& changing_plan() {
  static const plan::Plan plan = plan_of_text(R"(use "suite/intact.probe"
task changing like carrot_on_plate {
  horizon 12 steps
  then say "put down {the source}" when step >= 3
  then say "put carrot on plate" when step >= 2
}
suite mine trained on bridge_v2 { tasks { changing }; seeds 42 }
)");
  return plan;
}

RunOptions one_start(const std::string& out, const std::string& policy = "null") {
  RunOptions options = options_for(out, policy);
  options.episodes = {0, 0};
  return options;
}

TEST_CASE("each step is told the sentence in force, the trace and results say which") {
  TemporaryFolder folder;
  must_run(changing_plan(), one_start(folder / "run"));
  const auto proven = store::read_proven_results(folder / "run");
  REQUIRE_MESSAGE(proven.ok(), to_text(proven.failure()));
  REQUIRE_MESSAGE(proven->refused.empty(), proven->refused.front());
  REQUIRE(proven->rows.size() == 1);
  const ResultRow& row = proven->rows.front();
  // Held from the third step on: said with the fourth. The next holds at once and waits for its turn.
  REQUIRE(row.told_at.has_value());
  CHECK(*row.told_at == std::vector<int>{4, 5});
  CHECK(results_to_json(std::span(&row, 1)).find("\"told_at\"") != std::string::npos);
  CHECK(results_to_csv(std::span(&row, 1)).find(",told_at") != std::string::npos);
  CHECK(results_to_csv(std::span(&row, 1)).find(",4 5") != std::string::npos);
  CHECK(row.prompt_sha256 == to_hex(sha256(kFirst)));

  const auto trace = store::read_stored_trace(row);
  REQUIRE_MESSAGE(trace.ok(), to_text(trace.failure()));
  CHECK(trace->header.prompt == kFirst);
  CHECK(trace->header.later == std::vector<std::string>{"put down the carrot", kFirst});
  const auto said = store::sentences_said(*trace);
  REQUIRE(said.has_value());
  CHECK(*said == std::vector<std::uint32_t>{0, 0, 0, 1, 2, 2, 2, 2, 2, 2, 2, 2});
  CHECK(trace->steps[3].prompt_hash == sha256("put down the carrot"));

  ReplayOptions replaying;
  replaying.verify = true;
  replaying.assets = one_start("").assets;
  const auto again = replay(folder / "run", "changing", 0, std::nullopt, replaying);
  REQUIRE_MESSAGE(again.ok(), to_text(again.failure()));
  CHECK_MESSAGE(again->identical, again->difference);
  const auto judged = rejudge::rejudge(folder / "run", changing_plan());
  REQUIRE_MESSAGE(judged.ok(), to_text(judged.failure()));
  CHECK(judged->valid == 1);
}

TEST_CASE("a sentence that no episode came to is told of with what reached the policy") {
  TemporaryFolder folder;
  const plan::Plan plan = plan_of_text(R"(use "suite/intact.probe"
task waiting like carrot_on_plate {
  horizon 6 steps
  then say "put down {the source}" when step >= 3
  then say "put carrot on plate" when grasped(source)
}
suite mine trained on bridge_v2 { tasks { waiting }; seeds 42 }
)");
  must_run(plan, one_start(folder / "run"));
  const auto proven = store::read_proven_results(folder / "run");
  REQUIRE(proven.ok());
  const auto findings = check_delivery(plan, proven->rows);
  REQUIRE(findings.size() == 1);
  CHECK(findings[0].kind == DeliveryFinding::Kind::kNeverSaid);
  CHECK(findings[0].sentence ==
        "task `waiting`: its later sentence \"put carrot on plate\" was said in none of 1 episode, "
        "because its condition never held");
  CHECK(to_json(findings).find("never_said") != std::string::npos);
}

TEST_CASE("a trace whose steps were told otherwise than the plan says is refused") {
  TemporaryFolder folder;
  must_run(changing_plan(), one_start(folder / "run"));
  const plan::Plan other = plan_of_text(R"(use "suite/intact.probe"
task changing like carrot_on_plate { horizon 12 steps; then say "put it down" when step >= 3 }
suite mine trained on bridge_v2 { tasks { changing }; seeds 42 }
)");
  const auto judged = rejudge::rejudge(folder / "run", other);
  const bool refused = !judged.ok() || judged->valid == 0;
  CHECK(refused);
}

TEST_CASE("a stage is restored with the sentence that it was saved in") {
  const plan::Plan& plan = changing_plan();
  const std::uint32_t task = plan.find_task("changing").value();
  const std::uint32_t tasks[] = {task};
  const auto assets = stage::SharedAssets::load(plan, one_start("").assets, tasks);
  REQUIRE_MESSAGE(assets.ok(), to_text(assets.failure()));
  const auto make = [&] {
    auto made = stage::Stage::create(plan, task, *assets, {.image = {}, .pictures = false});
    REQUIRE_MESSAGE(made.ok(), to_text(made.failure()));
    return std::move(made).value();
  };
  const auto first = make(), second = make();
  REQUIRE(first->reset(0).ok());
  policy::Action still = policy::Action::zeros(robot::kActionSize);
  still[6] = 1;
  for (int i = 0; i < 3; ++i) REQUIRE(first->step(still).ok());
  CHECK(first->observe()->prompt == "put down the carrot");
  const auto bytes = first->save().to_bytes();
  const auto state = stage::StageState::from_bytes(bytes);
  REQUIRE_MESSAGE(state.ok(), to_text(state.failure()));
  CHECK(state->to_bytes() == bytes);
  REQUIRE(second->restore(*state).ok());
  CHECK(second->observe()->prompt == "put down the carrot");
  REQUIRE(second->step(still).ok());
  CHECK(second->observe()->prompt == kFirst);
  REQUIRE(second->reset(0).ok());
  CHECK(second->observe()->prompt == kFirst);
  CHECK(second->told().sentence() == 0);
}

}  // namespace
}  // namespace probe::run
