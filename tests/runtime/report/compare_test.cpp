#include "runtime/report/compare.h"

#include <cmath>

#include "runtime/stats/design.h"
#include "tests/runtime/report/fake_runs.h"

namespace probe::report {
namespace {

constexpr char kTask[] = "carrot_on_plate";
// Their starts lie in the same places.
const std::vector<std::string> kSamePlaces = {kTask, "carrot_on_plate_lang_action",
                                              "carrot_on_plate_lang_color",
                                              "carrot_on_plate_lang_common"};

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
  REQUIRE(c.rows[0].contrast.anew.more);
  CHECK(*c.rows[0].contrast.anew.more > 10);
}

TEST_CASE("equal outcomes are said to be equal, with what they exclude") {
  const Two two({.tasks = {kTask}}, below(12), {.tasks = {kTask}}, below(12));
  const Comparison c = two.compared({.metrics = {"success"}});
  CHECK(c.words.size() == 1);
  CHECK(c.words[0].find("no difference was seen in any of 24 episodes") != std::string::npos);
}

// Four tasks in one place are one place: the test on them says p = 1.
TEST_CASE("an early stop counts places, as the test does") {
  const FakeRunOptions one_place{.tasks = kSamePlaces, .last = 0};
  const Two first(one_place, below(24), one_place, below(0));
  const Comparison nothing = first.compared({.metrics = {"success"}});
  CHECK(nothing.rows[0].contrast.anew.p == 1);
  CHECK(nothing.rows[0].contrast.anew.nets == std::vector<std::int64_t>{4});
  CHECK(nothing.words[0].find("4 starts in 1 place, of which 1 differs, cannot show") !=
        std::string::npos);
  for (const std::string& words : nothing.words) {
    CHECK(words.find("would have been enough") == std::string::npos);
  }
  const FakeRunOptions all{.tasks = kSamePlaces};
  const Two every(all, below(24), all, below(0));
  const Comparison clear = every.compared({.metrics = {"success"}});
  CHECK(clear.words[1].find("after every place, 7 of 24 places would have been enough") !=
        std::string::npos);
  const FakeRunOptions enough{.tasks = kSamePlaces, .last = 6};
  const Two seven(enough, below(24), enough, below(0));
  CHECK(seven.compared({.metrics = {"success"}}).rows[0].is_real());
}

TEST_CASE("what could have been seen counts places, as the test does") {
  const Two one({.tasks = {kTask}}, below(12), {.tasks = {kTask}}, below(9));
  const Two four({.tasks = kSamePlaces}, below(12), {.tasks = kSamePlaces}, below(9));
  const ComparedRow few = one.compared({.metrics = {"success"}}).rows[0];
  const ComparedRow copies = four.compared({.metrics = {"success"}}).rows[0];
  const Answer &of_copies = copies.contrast.anew, &of_few = few.contrast.anew;
  CHECK(of_copies.p == of_few.p);
  CHECK(of_copies.detectable.has_value() == of_few.detectable.has_value());
  REQUIRE(of_copies.more);
  CHECK(*of_copies.more == *of_few.more);
}

TEST_CASE("equal runs exclude no more than their places can") {
  const Two one({.tasks = {kTask}}, below(12), {.tasks = {kTask}}, below(12));
  const Two four({.tasks = kSamePlaces}, below(12), {.tasks = kSamePlaces}, below(12));
  const stats::Interval of_one =
      one.compared({.metrics = {"success"}}).rows[0].contrast.anew.interval;
  const Comparison c = four.compared({.metrics = {"success"}});
  CHECK(c.rows[0].contrast.anew.interval.high == doctest::Approx(of_one.high));
  CHECK(c.words[0].find("96 starts in 24 places exclude a true difference of more than") !=
        std::string::npos);
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

TEST_CASE("the number of places needed has about the power it promises") {
  const auto n = stats::pairs_needed(0.1, 0.3);
  REQUIRE(n);
  Contrast contrast;
  contrast.pairs.only_a = *n * 3 / 10;
  contrast.pairs.neither = *n - contrast.pairs.only_a;
  contrast.anew.nets.assign(static_cast<std::size_t>(*n), 0);
  std::fill_n(contrast.anew.nets.begin(), contrast.pairs.only_a, 1);
  say_what_would_tell(contrast);
  REQUIRE(contrast.anew.detectable);
  CHECK(*contrast.anew.detectable == doctest::Approx(0.1).epsilon(0.08));
}

// Four tasks in six places, all won: 2 / 2^24 and 2 / 2^6, after Holm over four metrics. Two places
// more, 2 / 2^8, are real.
TEST_CASE("a difference that is certain on these starts and not for new ones is said to be so") {
  const FakeRunOptions six{.tasks = kSamePlaces, .last = 5};
  const Two few(six, below(24), six, below(0));
  const Comparison c = few.compared();
  const Contrast& success = c.rows[0].contrast;
  CHECK(success.here.p == doctest::Approx(std::ldexp(1, -23)));
  CHECK(success.anew.p == doctest::Approx(std::ldexp(1, -5)));
  CHECK(success.anew.adjusted == doctest::Approx(4 * std::ldexp(1, -5)));
  CHECK(success.here.is_real());
  CHECK(!success.anew.is_real());
  CHECK(c.words[0].find("success: first is better on these starts (24 of 24 (100.0 %) against 0 of "
                        "24 (0.0 %); +100.0 points, ") == 0);
  CHECK(c.words[0].find("; for starts never tried the data cannot tell (") != std::string::npos);
  CHECK(c.words[0].find("p = 0.12), about 2 more places of start would.") != std::string::npos);
  CHECK(c.words[1].find("  looked at after every start, 7 of 24 starts would have been enough on "
                        "these starts") == 0);

  const FakeRunOptions eight{.tasks = kSamePlaces, .last = 7};
  const Two enough(eight, below(24), eight, below(0));
  const Comparison both = enough.compared();
  CHECK(both.rows[0].contrast.anew.is_real());
  CHECK(both.words[0].find("success: first is better (32 of 32 (100.0 %) against 0 of 32 (0.0 %); "
                           "+100.0 points), on these starts (") == 0);
  CHECK(both.words[0].find(" and for starts never tried (") != std::string::npos);
}

TEST_CASE("JSON answers both questions by name, and the old keys are of starts never tried") {
  const FakeRunOptions six{.tasks = kSamePlaces, .last = 5};
  const Two two(six, below(24), six, below(0));
  const auto row = to_json(*two.benchmark, two.compared())["rows"][0];
  CHECK(row["on_these_starts"]["units"] == 24);
  CHECK(row["on_these_starts"]["real"] == true);
  CHECK(row["for_starts_never_tried"]["units"] == 6);
  CHECK(row["for_starts_never_tried"]["real"] == false);
  CHECK(row["for_starts_never_tried"]["more"] == 2);
  for (const char* key : {"p", "p_adjusted", "low", "high", "real"})
    CHECK(row[key] == row["for_starts_never_tried"][key]);
  CHECK(row["places"] == 6);
  CHECK(row["more_places"] == 2);
}

TEST_CASE("the table of words has a p for each question") {
  const FakeRunOptions six{.tasks = kSamePlaces, .last = 5};
  const Two two(six, below(24), six, below(0));
  const std::string text = to_text(*two.benchmark, two.compared({.metrics = {"success"}}));
  CHECK(text.find("p, these") != std::string::npos);
  CHECK(text.find("p, new\n") != std::string::npos);
  CHECK(text.find("* differs. p, these: on these starts") != std::string::npos);
}

}  // namespace probe::report
