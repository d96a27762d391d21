#include "runtime/rejudge/tally.h"

#include <doctest/doctest.h>

#include "runtime/store/not_attempted.h"

using namespace probe;

namespace {

store::ResultRow row(const char* task, int episode, double success, double top) {
  store::ResultRow row;
  row.task = task;
  row.episode = episode;
  row.metrics = {{"success", true, success}, {"top", false, top}};
  return row;
}

}  // namespace

TEST_CASE(
    "conditions are counted, numbers have mean and extremes, invalid episodes count nowhere") {
  std::vector<store::ResultRow> rows = {row("a", 0, 1, 0.5), row("a", 1, 0, 1.5),
                                        row("b", 0, 1, 2)};
  rows.push_back(row("a", 2, 1, 100));
  rows.back().invalid = "the policy went away";
  rows.back().seed = 7;
  CHECK(rejudge::tally_text(rows, nullptr) ==
        "a: 3 episodes, 1 invalid (episode 2 seed 7: the policy went away)\n"
        "  success         1 of 2\n"
        "  top          mean 1, 0.5 .. 1.5\n"
        "b: 1 episodes\n"
        "  success         1 of 1\n"
        "  top          mean 2, 2 .. 2\n");
}

TEST_CASE("of many tasks each is one line of a table, and what was not judged stands below") {
  std::vector<store::ResultRow> rows;
  for (const char* task : {"carrot_on_plate", "b", "c", "d", "e", "f"}) {
    for (int episode = 0; episode < 2; ++episode) rows.push_back(row(task, episode, episode, 2));
  }
  rows[3].metrics.pop_back();
  rows[2].metrics.pop_back();
  rows[4].invalid = "the policy went away";
  rows[6].remark = rows[8].remark = rows[9].remark = "slipped in the hand";
  CHECK(rejudge::tally_text(rows, nullptr) ==
        "task             episodes  success  top\n"
        "carrot_on_plate         2      1/2    2\n"
        "b                       2      1/2    -\n"
        "c                       2      1/1    2\n"
        "d                       2      1/2    2\n"
        "e                       2      1/2    2\n"
        "f                       2      1/2    2\n"
        "c: 1 invalid (episode 0 seed 0: the policy went away)\n"
        "3 of 11: slipped in the hand\n"
        "numbers are means; `results DIR --long` has each task's remarks and the least and most of "
        "each number\n");
  rejudge::TallyText tally;
  for (const store::ResultRow& one : rows) tally.add(one);
  CHECK(tally.text(nullptr, true).find("carrot_on_plate: 2 episodes\n  success         1 of 2\n") == 0);
}

TEST_CASE("what was not attempted is told with all its reasons, the most frequent first") {
  std::vector<store::ResultRow> rows;
  const char* const reasons[] = {"too late", "skill 1: far", "skill 1: far", "a", "b", "b"};
  for (const char* reason : reasons) {
    rows.push_back(row("a", static_cast<int>(rows.size()), 0, 0));
    rows.back().invalid = std::string(store::kNotAttempted) + reason;
  }
  CHECK(rejudge::tally_text(std::span(rows).first(1), nullptr) ==
        "a: 1 episodes, 1 not attempted (too late)\n");
  CHECK(rejudge::tally_text(rows, nullptr) ==
        "a: 6 episodes, 6 not attempted (2: skill 1: far; 2: b; 1: too late; 1 for other ones)\n");
}

TEST_CASE("a run without a valid episode says only that") {
  store::ResultRow only = row("a", 0, 1, 1);
  only.invalid = "no";
  CHECK(rejudge::tally_text(std::span(&only, 1), nullptr) ==
        "a: 1 episodes, 1 invalid (episode 0 seed 0: no)\n");
}
