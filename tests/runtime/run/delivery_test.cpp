// What reached the policy against what the plan says should differ, on rows made by hand.
#include "runtime/run/delivery.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <fstream>

#include "compiler/emit/compile.h"
#include "runtime/plan/axes.h"
#include "runtime/plan/plan.h"
#include "runtime/store/not_attempted.h"
#include "tests/runtime/run/temporary_folder.h"

namespace probe::run {
using namespace probe::store;
namespace {

plan::Plan suite(const char* file = "suite/intact.probe") {
  const std::string files[] = {std::string(VLAPROBE_SOURCE_DIR "/") + file};
  auto compiled = build(files, {.asset_root = VLAPROBE_SOURCE_DIR "/assets",
                                .suite = "",
                                .library_folders = {VLAPROBE_SOURCE_DIR "/dsl"}});
  REQUIRE_MESSAGE(compiled.ok(), to_text(compiled.failure()));
  REQUIRE_FALSE(compiled->plan.empty());
  return std::move(plan::Plan::from_bytes(std::move(compiled->plan))).value();
}

// A row as an honest run has it: own hashes for own prompts and starts.
ResultRow honest(const plan::Plan& plan, const std::string& task, int episode) {
  for (const plan::TaskRecord& record : plan.tasks()) {
    if (plan.text(record.name) != task) continue;
    ResultRow row;
    row.task = task;
    row.episode = episode;
    row.seed = 42;
    const auto& start = plan.episodes(record)[static_cast<std::size_t>(episode)];
    row.start_id = to_hex(Sha256{start.start_id});
    row.prompt_sha256 = to_hex(sha256(plan.text(record.prompt)));
    row.image_sha256 = row.start_id;
    row.sent_prompt_sha256 = row.prompt_sha256;
    row.sent_image_sha256 = row.image_sha256;
    return row;
  }
  FAIL("the suite has no task " << task);
  return {};
}

std::vector<ResultRow> rows_of(const plan::Plan& plan) {
  std::vector<ResultRow> rows;
  for (const char* task :
       {"carrot_on_plate", "carrot_on_plate_lang_action", "carrot_on_plate_distract"}) {
    for (int episode = 0; episode < 3; ++episode) rows.push_back(honest(plan, task, episode));
  }
  return rows;
}

}  // namespace

TEST_CASE("an honest run has no findings") {
  const plan::Plan plan = suite();
  CHECK(check_delivery(plan, rows_of(plan)).empty());
  std::vector<ResultRow> in_process = rows_of(plan);
  for (ResultRow& row : in_process) row.sent_prompt_sha256 = row.sent_image_sha256 = std::nullopt;
  CHECK(check_delivery(plan, in_process).empty());
}

TEST_CASE("two instructions that reached the policy as one text are found") {
  const plan::Plan plan = suite();
  std::vector<ResultRow> rows = rows_of(plan);
  for (ResultRow& row : rows) row.sent_prompt_sha256 = rows[0].prompt_sha256;
  const auto findings = check_delivery(plan, rows);
  REQUIRE(findings.size() == 1);
  CHECK(findings[0].kind == DeliveryFinding::Kind::kSamePrompt);
  CHECK(findings[0].task == "carrot_on_plate_lang_action");
  CHECK(findings[0].other == "carrot_on_plate");
  CHECK(findings[0].sentence.find("but the policy was sent the same text") != std::string::npos);
}

TEST_CASE("one instruction that reached the policy as several texts is found") {
  const plan::Plan plan = suite();
  std::vector<ResultRow> rows = rows_of(plan);
  rows[1].sent_prompt_sha256 = std::string(64, '0');
  const auto findings = check_delivery(plan, rows);
  REQUIRE(findings.size() == 1);
  CHECK(findings[0].kind == DeliveryFinding::Kind::kManyPrompts);
  CHECK(findings[0].episodes == 2);
}

TEST_CASE("distractors that the policy's picture does not show are found, start by start") {
  const plan::Plan plan = suite();
  std::vector<ResultRow> rows = rows_of(plan);
  rows[6].sent_image_sha256 = rows[0].sent_image_sha256;
  rows[8].sent_image_sha256 = rows[2].sent_image_sha256;
  const auto findings = check_delivery(plan, rows);
  REQUIRE(findings.size() == 1);
  CHECK(findings[0].kind == DeliveryFinding::Kind::kSamePicture);
  CHECK(findings[0].task == "carrot_on_plate_distract");
  CHECK(findings[0].axes == "distractors");
  CHECK(findings[0].episodes == 2);
  CHECK(findings[0].compared == 3);
  CHECK(to_json(findings).find("\"kind\": \"same_picture\"") != std::string::npos);
}

TEST_CASE("what moves by itself has not moved yet in the policy's first picture") {
  const plan::Plan plan = suite("examples/moving.probe");
  const auto compared = [&](const plan::TaskRecord& task) {
    return task.baseline != plan::kNone && task.axes == plan::bit(plan::Axis::kMotion);
  };
  const auto tasks = plan.tasks();
  const auto moving = std::ranges::find_if(tasks, compared);
  REQUIRE(moving != tasks.end());
  std::vector<ResultRow> rows = {
      honest(plan, std::string(plan.text(tasks[moving->baseline].name)), 0),
      honest(plan, std::string(plan.text(moving->name)), 0)};
  rows[1].sent_image_sha256 = rows[0].sent_image_sha256;
  CHECK(check_delivery(plan, rows).empty());
}

TEST_CASE("with no valid episode nothing is said of what reached the policy") {
  const plan::Plan plan = suite();
  const auto none = check_delivery(plan, {});
  REQUIRE(none.size() == 1);
  CHECK(none[0].kind == DeliveryFinding::Kind::kNothing);
  CHECK(none[0].sentence == "no episode is valid: what reached the policy cannot be said");
  std::vector<ResultRow> rows = rows_of(plan);
  for (ResultRow& row : rows) row.invalid = "policy: gone";
  const auto invalid = check_delivery(plan, rows);
  REQUIRE(invalid.size() == 1);
  CHECK(invalid[0].sentence ==
        "no episode is valid, 9 episodes invalid: what reached the policy cannot be said");
  CHECK(to_json(invalid).find("\"kind\": \"nothing\"") != std::string::npos);
  for (std::size_t i = 0; i < 6; ++i)
    rows[i].invalid = std::string(store::kNotAttempted) + "no solution in skills for this goal";
  CHECK(check_delivery(plan, rows)[0].sentence ==
        "no episode is valid, 3 episodes invalid, 6 episodes not attempted: what reached the "
        "policy cannot be said");
  rows[4].invalid.reset();
  CHECK(check_delivery(plan, rows).empty());
}

}  // namespace probe::run
