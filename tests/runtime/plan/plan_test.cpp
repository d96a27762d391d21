#include "runtime/plan/plan.h"

#include <doctest/doctest.h>

#include <cstdio>
#include <filesystem>

#include "tests/plan/strip_sources.h"
#include "tests/runtime/plan/small_plan.h"

using namespace probe;
using namespace probe::plan;

TEST_CASE("what is written is read back") {
  Writer w = small_writer();
  const auto bytes = w.finish();
  REQUIRE_MESSAGE(bytes.ok(), to_text(bytes.failure()));
  const auto opened = Plan::from_bytes(*bytes);
  REQUIRE(opened.ok());
  const Plan& plan = *opened;
  REQUIRE(plan.tasks().size() == 2);
  const TaskRecord& task = plan.tasks()[1];
  CHECK(plan.text(task.prompt) == "drop carrot on plate");
  CHECK(plan.episodes(task).size() == 2);
  CHECK(plan.placements(plan.episodes(task)[1])[0].position[0] == 0.02);
  CHECK(plan.text(plan.bodies(task)[5].name) == "wrist");
  CHECK(plan.metrics(task).size() == 3);
  CHECK(plan.text(plan.drives(plan.robots()[0])[1].joint) == "elbow");
  CHECK(plan.joints(plan.scenes()[0])[1] == -0.2);
  CHECK(plan.seeds(plan.suites()[0])[0] == 42);
  CHECK(plan.members(plan.suites()[0]).size() == 2);
  CHECK(plan.suns(plan.lights()[0])[0].power == 2.2);
  CHECK(plan.has_sources());
  REQUIRE(plan.span_of(SpanKind::kCode, 0) != nullptr);
  CHECK(plan.span_of(SpanKind::kCode, 0)->begin == 25);
  CHECK(plan.span_of(SpanKind::kCode, 1) == nullptr);
}

TEST_CASE("the places of one thing keep the order in which they were added") {
  Writer w = small_writer();
  const std::uint32_t text = w.records.spans.front().text;
  w.records.spans.insert(w.records.spans.begin(), {{1, 3, text, 9, 10}, {1, 3, text, 2, 4}});
  auto bytes = w.finish();
  REQUIRE(bytes.ok());
  const auto plan = Plan::from_bytes(std::move(*bytes));
  REQUIRE(plan.ok());
  const auto places = plan->spans_of(SpanKind::kCode, 3);
  REQUIRE(places.size() == 2);
  CHECK(places[0].begin == 9);
  CHECK(places[1].begin == 2);
  CHECK(plan->span_of(SpanKind::kCode, 3) == places.data());
  CHECK(plan->spans_of(SpanKind::kCode, 2).empty());
}

TEST_CASE("the same calls give the same bytes") { CHECK(small_plan() == small_plan()); }

TEST_CASE("a task is found by its name and by a suite's prefix and name") {
  const auto plan = Plan::from_bytes(small_plan());
  REQUIRE(plan.ok());
  CHECK(plan->find_task("carrot_on_plate_drop") == 1);
  CHECK(plan->find_task("widowx_carrot_on_plate") == 0);
  CHECK(!plan->find_task("widowx_"));
  CHECK(!plan->find_task("spoon"));
  CHECK(plan->find_suite("smoke") == 0);
  CHECK(plan->find_set("core") == 0);
  CHECK(plan->find_metric(plan->tasks()[0], "steady") == 2);
}

TEST_CASE("views survive a move of the plan") {
  auto first = Plan::from_bytes(small_plan());
  REQUIRE(first.ok());
  const std::string_view prompt = first->text(first->tasks()[0].prompt);
  const Plan second = std::move(*first);
  CHECK(prompt == "put carrot on plate");
  CHECK(second.text(second.tasks()[0].prompt).data() == prompt.data());
}

TEST_CASE("a plan is mapped from its file, and failures name the file") {
  const auto folder = std::filesystem::temp_directory_path() / "vlaprobe_plan_test";
  std::filesystem::create_directories(folder);
  const std::string path = (folder / "small.plan").string();
  auto bytes = small_plan();
  REQUIRE(write_file(path, bytes).ok());
  const auto plan = Plan::open(path);
  REQUIRE(plan.ok());
  CHECK(std::ranges::equal(plan->bytes(), bytes));

  bytes[100] ^= std::byte{1};
  REQUIRE(write_file(path, bytes).ok());
  const auto damaged = Plan::open(path);
  REQUIRE(!damaged.ok());
  CHECK(damaged.failure().code == Fault::kPlan);
  CHECK(damaged.failure().where.starts_with(path));

  REQUIRE(write_file(path, {}).ok());
  CHECK(Plan::open(path).failure().code == Fault::kPlan);
  CHECK(Plan::open(path + ".absent").failure().code == Fault::kIo);
  CHECK(Plan::open(folder.string()).failure().code == Fault::kIo);
  CHECK(write_file((folder / "absent" / "x.plan").string(), bytes).failure().code == Fault::kIo);
  std::filesystem::remove_all(folder);
}

TEST_CASE("stripping the sources changes no id and no root") {
  const auto bytes = small_plan();
  const auto whole = Plan::from_bytes(bytes);
  const auto stripped = Plan::from_bytes(strip_sources(bytes));
  REQUIRE(whole.ok());
  REQUIRE_MESSAGE(stripped.ok(), to_text(stripped.failure()));
  CHECK(!stripped->has_sources());
  CHECK(stripped->bytes().size() < whole->bytes().size());
  CHECK(stripped->root() == whole->root());
  CHECK(stripped->episodes()[3].episode_id == whole->episodes()[3].episode_id);

  Writer without = small_writer();
  without.records.spans.clear();
  without.records.texts.clear();
  without.records.text_bytes.clear();
  const auto never = without.finish();
  REQUIRE(never.ok());
  CHECK(*never == std::vector<std::byte>(stripped->bytes().begin(), stripped->bytes().end()));
}
