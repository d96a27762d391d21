#include "runtime/cli/full/progress.h"

#include <doctest/doctest.h>

namespace probe::cli {
namespace {

store::ResultRow row(bool success, bool intention) {
  store::ResultRow row;
  row.task = "carrot_on_plate";
  row.metrics = {{"success", true, success ? 1.0 : 0.0},
                 {"intention", true, intention ? 1.0 : 0.0}};
  return row;
}

// 30 of 120 episodes after 60 s, every third a success, one invalid.
Progress quarter_done() {
  Progress progress(1000);
  progress.add({0, 0, 120, nullptr});
  for (int i = 1; i <= 30; ++i) {
    store::ResultRow one = row(i % 3 == 0, true);
    if (i == 30) one.invalid = "the server went away";
    progress.add({i, 0, 120, &one});
  }
  return progress;
}

}  // namespace

TEST_CASE("the line of a terminal has a bar, counts, time left and rates with intervals") {
  const Progress progress = quarter_done();
  CHECK(progress.terminal_line(1060, 200, false) ==
        "[=====               ] 30/120 episodes, 1 invalid  3 min left  "
        "success 9/29 31 % [17-49]  intention 29/29 100 % [88-100]");
}

TEST_CASE("what does not fit a narrow terminal is left out from the right, then the bar") {
  const Progress progress = quarter_done();
  CHECK(progress.terminal_line(1060, 100, false) ==
        "[=====               ] 30/120 episodes, 1 invalid  3 min left  success 9/29 31 % [17-49]");
  CHECK(progress.terminal_line(1060, 50, false) == "30/120 episodes, 1 invalid  3 min left");
  CHECK(progress.terminal_line(1060, 10, false) == "30/120 epi");
}

TEST_CASE("of a run that stops by what it finds there are counts, and no interval or time left") {
  Progress progress(1000);
  progress.add({0, 0, 120, nullptr, true});
  const store::ResultRow one = row(true, true);
  progress.add({1, 0, 120, &one, true});
  CHECK(progress.terminal_line(1060, 200, false) ==
        "[                    ] 1 of at most 120 episodes  success 1/1  intention 1/1");
  CHECK(progress.log_line(1060) == "1 of at most 120 episodes, success 1/1, intention 1/1");
}

TEST_CASE("what a policy does not attempt is not called invalid") {
  Progress progress = quarter_done();
  store::ResultRow one = row(false, false);
  one.invalid = "not attempted: no solution in skills for this goal";
  progress.add({31, 0, 120, &one});
  CHECK(progress.terminal_line(1060, 60, false) ==
        "31/120 episodes, 1 not attempted, 1 invalid  3 min left");
}

TEST_CASE("color is only in the bar and only when asked for") {
  const Progress progress = quarter_done();
  CHECK(progress.terminal_line(1060, 80, true).find("\033[32m=====\033[0m") == 1);
  CHECK(progress.terminal_line(1060, 80, false).find('\033') == std::string::npos);
}

TEST_CASE("a log has a line at once, every ten seconds for two minutes, then one a minute") {
  Progress progress = quarter_done();
  CHECK(progress.log_line(1001).has_value());
  CHECK(!progress.log_line(1010));
  CHECK(progress.log_line(1011).has_value());
  CHECK(progress.log_line(1119).has_value());
  CHECK(!progress.log_line(1130));
  CHECK(!progress.log_line(1178));
  CHECK(progress.log_line(1179).has_value());
  CHECK(!progress.log_line(1238));
  CHECK(progress.log_line(1240).has_value());
}

TEST_CASE("a line of a log has everything but a bar") {
  Progress progress = quarter_done();
  CHECK(progress.log_line(1060) ==
        "30/120 episodes, 1 invalid, success 9/29 31 % [17-49], intention 29/29 100 % [88-100], "
        "3 min left");
}

TEST_CASE("time left goes by this call's pace, not by what was there") {
  Progress progress(0);
  progress.add({0, 90, 100, nullptr});
  CHECK(progress.terminal_line(5, 80, false) ==
        "[==================  ] 90/100 episodes (90 were there)");
  const store::ResultRow one = row(true, true);
  progress.add({5, 90, 100, &one});
  CHECK(progress.terminal_line(50, 60, false) == "95/100 episodes (90 were there)  50 s left");
  progress.add({10, 90, 100, &one});
  CHECK(progress.terminal_line(100, 60, false) ==
        "100/100 episodes (90 were there)  done in 2 min");
}

TEST_CASE("durations have the unit that people would say") {
  CHECK(duration_text(0.4) == "0 s");
  CHECK(duration_text(99.4) == "99 s");
  CHECK(duration_text(600) == "10 min");
  CHECK(duration_text(3 * 3600 + 5 * 60) == "3 h 05 min");
}

}  // namespace probe::cli
