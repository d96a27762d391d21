// A run that is killed again and again, and one whose disk is full; tests/kills.sh does the same
// with a server, 200 times.
#include <doctest/doctest.h>
#include <signal.h>
#include <sys/mount.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>

#include "runtime/policy/policy.h"
#include "runtime/run/run.h"
#include "runtime/store/store.h"
#include "runtime/store/stored_trace.h"
#include "tests/runtime/run/table_plan.h"
#include "tests/runtime/run/temporary_folder.h"

namespace probe::run {
using namespace probe::store;
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
  const plan::Plan plan = table_plan(12, 6);
  const RunOptions options = options_for(folder / "killed");
  policy::Draws draws(7);
  int killed = 0;
  for (int round = 0; round < 10; ++round) {
    const pid_t child = ::fork();
    REQUIRE(child >= 0);
    if (child == 0) ::_exit(run(plan, options).ok() ? 0 : 1);
    ::usleep(static_cast<useconds_t>(100'000 + 300'000 * draws.uniform()));
    ::kill(child, SIGKILL);
    int status = 0;
    ::waitpid(child, &status, 0);
    if (WIFSIGNALED(status)) ++killed;
  }
  CHECK(killed > 0);
  const auto summary = run(plan, options);
  REQUIRE_MESSAGE(summary.ok(), to_text(summary.failure()));
  CHECK(summary->total == 24);
  const auto undisturbed = run(plan, options_for(folder / "calm"));
  REQUIRE_MESSAGE(undisturbed.ok(), to_text(undisturbed.failure()));
  CHECK(rows_of(folder / "killed") == rows_of(folder / "calm"));
  for (const auto& entry : fs::recursive_directory_iterator(folder / "killed")) {
    CHECK_MESSAGE(entry.path().extension() != ".tmp", entry.path().string());
  }
}

// A file system of its own, as small as wanted.
class SmallDisk {
 public:
  SmallDisk(const std::string& path, const std::string& size) : path_(path) {
    fs::create_directories(path);
    mounted_ = ::mount("none", path.c_str(), "tmpfs", 0, ("size=" + size).c_str()) == 0;
  }
  ~SmallDisk() {
    if (mounted_) ::umount(path_.c_str());
  }
  bool mounted() const { return mounted_; }
  void grow(const std::string& size) {
    CHECK(::mount("none", path_.c_str(), "tmpfs", MS_REMOUNT, ("size=" + size).c_str()) == 0);
  }

 private:
  std::string path_;
  bool mounted_ = false;
};

TEST_CASE("a full disk ends the run with its reason and loses nothing that was stored") {
  TemporaryFolder folder;
  const plan::Plan plan = table_plan(8, 20);
  SmallDisk disk(folder / "disk", "140k");
  if (!disk.mounted()) {
    MESSAGE("skipped: only root may mount a small disk");
    return;
  }
  const RunOptions options = options_for(folder / "disk/run");
  std::size_t stored = 0;
  for (const char* size : {"140k", "180k", "220k"}) {
    disk.grow(size);
    const auto full = run(plan, options);
    REQUIRE_FALSE(full.ok());
    CHECK_MESSAGE(full.failure().code == Fault::kStore, to_text(full.failure()));
    const auto rows = read_results(options.out);
    REQUIRE_MESSAGE(rows.ok(), to_text(rows.failure()));
    CHECK(rows->size() >= stored);
    stored = rows->size();
    for (const ResultRow& row : *rows) {
      CHECK(read_stored_trace(row).ok());
      CHECK_FALSE(row.invalid);
    }
  }
  CHECK(stored > 0);
  CHECK(stored < 16);
  disk.grow("64m");
  const auto summary = run(plan, options);
  REQUIRE_MESSAGE(summary.ok(), to_text(summary.failure()));
  CHECK(summary->skipped == static_cast<int>(stored));
  const auto undisturbed = run(plan, options_for(folder / "calm"));
  REQUIRE_MESSAGE(undisturbed.ok(), to_text(undisturbed.failure()));
  CHECK(rows_of(options.out) == rows_of(folder / "calm"));
}

}  // namespace
}  // namespace probe::run
