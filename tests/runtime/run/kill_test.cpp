// A run that is killed again and again; tests/kills.sh does the same with a server, 200 times.
#include <doctest/doctest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>

#include "runtime/policy/policy.h"
#include "runtime/run/run.h"
#include "runtime/run/store.h"
#include "tests/runtime/run/table_plan.h"
#include "tests/runtime/run/temporary_folder.h"

namespace probe::run {
namespace {

namespace fs = std::filesystem;

RunOptions options_for(const std::string& out) {
  RunOptions options;
  options.policy = "random";
  options.out = out;
  options.assets = VLAPROBE_SOURCE_DIR "/assets";
  options.jobs = 2;
  return options;
}

std::vector<ResultRow> rows_of(const std::string& dir) {
  const auto rows = read_results(dir);
  REQUIRE_MESSAGE(rows.ok(), to_text(rows.failure()));
  std::vector<ResultRow> all = *rows;
  for (ResultRow& row : all) row.trace = "";
  return all;
}

TEST_CASE("ten kills at random moments: each episode once, with the undisturbed run's traces") {
  TemporaryFolder folder;
  const plan::Plan plan = table_plan(24, 6);
  const RunOptions options = options_for(folder / "killed");
  policy::Draws draws(7);
  int killed = 0;
  for (int round = 0; round < 10; ++round) {
    const pid_t child = ::fork();
    REQUIRE(child >= 0);
    if (child == 0) ::_exit(run(plan, options).ok() ? 0 : 1);
    ::usleep(static_cast<useconds_t>(150'000 + 500'000 * draws.uniform()));
    ::kill(child, SIGKILL);
    int status = 0;
    ::waitpid(child, &status, 0);
    if (WIFSIGNALED(status)) ++killed;
  }
  CHECK(killed > 0);
  const auto summary = run(plan, options);
  REQUIRE_MESSAGE(summary.ok(), to_text(summary.failure()));
  CHECK(summary->total == 48);
  const auto undisturbed = run(plan, options_for(folder / "calm"));
  REQUIRE_MESSAGE(undisturbed.ok(), to_text(undisturbed.failure()));
  CHECK(rows_of(folder / "killed") == rows_of(folder / "calm"));
  for (const auto& entry : fs::recursive_directory_iterator(folder / "killed")) {
    CHECK_MESSAGE(entry.path().extension() != ".tmp", entry.path().string());
  }
}

}  // namespace
}  // namespace probe::run
