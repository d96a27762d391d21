#include <doctest/doctest.h>

#include "tests/runtime/cli/program.h"

namespace probe::test {
namespace {

TEST_CASE("demo shows a task, its episodes, a video, a reason and a report, and again without running anything twice") {
  Sandbox box;
  const Outcome first = box.vlaprobe("demo -o shown");
  REQUIRE(first.exit == 0);
  for (const char* step : {"$ vlaprobe check", "$ vlaprobe run", "$ vlaprobe why", "$ vlaprobe report"})
    CHECK(first.out.find(step) != std::string::npos);
  CHECK(first.out.find("success = false") != std::string::npos);
  CHECK(first.err.find("4 run now") != std::string::npos);
  CHECK(std::filesystem::is_regular_file(box / "shown/report.html"));
  CHECK(!std::filesystem::is_empty(box / "shown/expert/videos"));
  const Outcome again = box.vlaprobe("demo -o shown");
  CHECK(again.exit == 0);
  CHECK(again.err.find("0 run now, 4 were there") != std::string::npos);
}

TEST_CASE("demo ends with the exit code of the step that failed") {
  Sandbox box;
  write_file(box / "shown", "a file");
  const Outcome outcome = box.vlaprobe("demo -o shown");
  CHECK(outcome.exit == 2);
  CHECK(outcome.out.find("$ vlaprobe why") == std::string::npos);
}

TEST_CASE("without a verb the program says where to begin") {
  Sandbox box;
  const Outcome outcome = box.vlaprobe("");
  CHECK(outcome.exit == 1);
  CHECK(outcome.out.find("vlaprobe demo") != std::string::npos);
}

}  // namespace
}  // namespace probe::test
