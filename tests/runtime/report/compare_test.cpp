#include "runtime/report/compare.h"

#include "tests/runtime/report/fake_runs.h"

namespace probe::report {
namespace {

constexpr char kTask[] = "carrot_on_plate";

struct Two {
  RunsFolder folder;
  std::optional<Benchmark> benchmark;
  Two(const FakeRunOptions& of_a, const Script& a, const FakeRunOptions& of_b, const Script& b,
      const char* plan_of_b = "intact.probe") {
    fake_run(folder / "a", suite_plan(), "first", of_a, a);
    fake_run(folder / "b", suite_plan(plan_of_b), "second", of_b, b);
    const std::vector<std::string> dirs = {folder / "a", folder / "b"};
    auto loaded = load(dirs, {.sets = {}, .join = false});
    REQUIRE(loaded.ok());
    benchmark = std::move(loaded).value();
  }
  Comparison compared(const CompareOptions& options = {}) const {
    auto result = compare(*benchmark, 0, 1, options);
    REQUIRE_MESSAGE(result.ok(), to_text(result.failure()));
    return std::move(result).value();
  }
};

Script below(int limit) {
  return
      [limit](const std::string&, int episode, int) { return Outcome{.success = episode < limit}; };
}

}  // namespace

TEST_CASE("a clear difference is said first, with who is better and by how much") {
  const Two two({.tasks = {kTask}}, below(24), {.tasks = {kTask}}, below(6));
  const Comparison c = two.compared();
  REQUIRE(!c.words.empty());
  CHECK(c.words[0].find("success: first is better (24 of 24 (100.0 %) against 6 of 24 (25.0 %)") ==
        0);
  CHECK(c.rows[0].is_real());
  CHECK(c.common_starts == 24);
  CHECK(to_text(*two.benchmark, c).find("first (A) against second (B), the same 24 episodes") == 0);
}

TEST_CASE("where fewer is better, the one with fewer is better") {
  const Two two(
      {.tasks = {kTask}}, [](const std::string&, int, int) { return Outcome{.wrong = true}; },
      {.tasks = {kTask}}, [](const std::string&, int, int) { return Outcome{.wrong = false}; });
  const Comparison c = two.compared({.metrics = {"wrong"}});
  CHECK(c.words[0].find("wrong: second is better") == 0);
}

TEST_CASE("when the data cannot tell, it says what they could have shown and how much is missing") {
  const Two two({.tasks = {kTask}}, below(12), {.tasks = {kTask}}, below(9));
  const Comparison c = two.compared({.metrics = {"success"}});
  CHECK(c.words[0].find("success: the data cannot tell them apart") == 0);
  CHECK(c.words[0].find("more starts would show it") != std::string::npos);
  REQUIRE(c.rows[0].more_starts);
  CHECK(*c.rows[0].more_starts > 10);
}

TEST_CASE("equal outcomes are said to be equal, with what they exclude") {
  const Two two({.tasks = {kTask}}, below(12), {.tasks = {kTask}}, below(12));
  const Comparison c = two.compared({.metrics = {"success"}});
  CHECK(c.words.size() == 1);
  CHECK(c.words[0].find("no difference was seen in any of 24 episodes") != std::string::npos);
}

TEST_CASE("only common starts are compared, and the others are counted") {
  const Two two({.tasks = {kTask}, .last = 15}, below(24),
                {.tasks = {kTask, "spoon_on_towel"}, .first = 8}, below(0));
  const Comparison c = two.compared({.metrics = {"success"}});
  CHECK(c.common_starts == 8);
  CHECK(c.only_a == 8);
  CHECK(c.only_b == 24);
  CHECK(c.notes[0].find("8 episodes are common to both; 8 that only first has") == 0);
}

TEST_CASE("runs without a common start are refused, with the reason") {
  const Two tasks({.tasks = {kTask}}, below(1), {.tasks = {"spoon_on_towel"}}, below(1));
  CHECK(compare(*tasks.benchmark, 0, 1).failure().message.find("other tasks, starts or seeds") !=
        std::string::npos);
  const Two invalid({.tasks = {kTask}, .last = 1}, below(1), {.tasks = {kTask}, .last = 1},
                    [](const std::string&, int, int) {
                      return Outcome{false, false, false, false, "gone"};
                    });
  CHECK(compare(*invalid.benchmark, 0, 1).failure().message.find("`second` has no valid episode") !=
        std::string::npos);
  const Two plans({.tasks = {"spoon_on_towel_distract"}, .last = 1}, below(1),
                  {.tasks = {"spoon_on_towel_distract"}, .last = 1}, below(1),
                  "intact_clean.probe");
  CHECK(compare(*plans.benchmark, 0, 1).failure().message.find("their plans have no task") !=
        std::string::npos);
  CHECK(compare(*tasks.benchmark, 0, 1, {.metrics = {"sucess"}})
            .failure()
            .message.find("no metric is called `sucess`") == 0);
}

TEST_CASE("JSON says the same words and all numbers") {
  const Two two({.tasks = {kTask}}, below(24), {.tasks = {kTask}}, below(6));
  const Comparison c = two.compared();
  const auto json = to_json(*two.benchmark, c);
  CHECK(json["words"].size() == c.words.size());
  CHECK(json["rows"][0]["a"]["k"] == 24);
  CHECK(json["rows"][0]["real"] == true);
}

TEST_CASE("the number of starts needed has about the power it promises") {
  const auto n = starts_needed(0.1, 0.3);
  REQUIRE(n);
  Contrast contrast;
  contrast.pairs.only_a = *n * 3 / 10;
  contrast.pairs.neither = *n - contrast.pairs.only_a;
  contrast.starts = *n;
  const auto found = detectable(contrast);
  REQUIRE(found);
  CHECK(*found == doctest::Approx(0.1).epsilon(0.08));
  CHECK(!starts_needed(0, 0.3));
  CHECK(!starts_needed(0.4, 0.3));
}

}  // namespace probe::report
