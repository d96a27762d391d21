// A run that is killed again and again, and one whose disk is full; tests/campaigns/kills.sh does the same
// with a server, 200 times.
#include <doctest/doctest.h>
#include <signal.h>
#include <sys/mount.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>

#include "compiler/emit/compile.h"
#include "runtime/policy/policy.h"
#include "runtime/run/run.h"
#include "runtime/servers/known_observations.h"
#include "runtime/servers/protocol.h"
#include "runtime/servers/served.h"
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
    if (child == 0) ::_exit(run::run(plan, options).ok() ? 0 : 1);
    ::usleep(static_cast<useconds_t>(100'000 + 300'000 * draws.uniform()));
    ::kill(child, SIGKILL);
    int status = 0;
    ::waitpid(child, &status, 0);
    if (WIFSIGNALED(status)) ++killed;
  }
  CHECK(killed > 0);
  const auto summary = run::run(plan, options);
  REQUIRE_MESSAGE(summary.ok(), to_text(summary.failure()));
  CHECK(summary->total == 24);
  const auto undisturbed = run::run(plan, options_for(folder / "calm"));
  REQUIRE_MESSAGE(undisturbed.ok(), to_text(undisturbed.failure()));
  CHECK(rows_of(folder / "killed") == rows_of(folder / "calm"));
  for (const auto& entry : fs::recursive_directory_iterator(folder / "killed")) {
    CHECK_MESSAGE(entry.path().extension() != ".tmp", entry.path().string());
  }
}

// INT-ACT's wrapper: the words of the first question since a reset, whoever's, are those of all
// others. Its question number `kills_at`, of those that a run's episodes ask, is `child`'s last.
struct Wrapper {
  std::mutex mutex;
  std::optional<std::string> kept = std::nullopt;
  int asked = 0, kills_at = 0;
  pid_t child = 0;
};

class Keeping final : public servers::ServedPolicy {
 public:
  explicit Keeping(Wrapper& wrapper) : wrapper_(wrapper) {}
  void reset() override {
    const std::lock_guard lock(wrapper_.mutex);
    wrapper_.kept.reset();
  }
  Result<std::vector<policy::Action>> answer(const servers::Asked& asked, int count) override {
    const std::lock_guard lock(wrapper_.mutex);
    if (!wrapper_.kept) wrapper_.kept = asked.words;
    const bool is_known = servers::is_known_observation(asked.picture.bytes, asked.words);
    if (!is_known && ++wrapper_.asked == wrapper_.kills_at) ::kill(wrapper_.child, SIGKILL);
    return digest_->answer({asked.picture, *wrapper_.kept}, count);
  }

 private:
  Wrapper& wrapper_;
  std::unique_ptr<servers::ServedPolicy> digest_ = servers::serve_digest().value()();
};

TEST_CASE("who was killed in an episode leaves no words to the next one at a server that keeps") {
  TemporaryFolder folder;
  const std::string files[] = {VLAPROBE_SOURCE_DIR "/suite/intact.probe"};
  auto compiled = build(files, {.asset_root = VLAPROBE_SOURCE_DIR "/assets",
                                .suite = "",
                                .library_folders = {VLAPROBE_SOURCE_DIR "/dsl"}});
  REQUIRE_MESSAGE(compiled.ok(), to_text(compiled.failure()));
  const plan::Plan plan = plan::Plan::from_bytes(std::move(compiled->plan)).value();
  servers::ServeOptions serving;
  serving.chunk = 4;
  const auto options_at = [&](const std::string& port, const std::string& out, const char* task) {
    RunOptions options = options_for(folder / out);
    options.policy = "intact://127.0.0.1:" + port + "?" +
                     servers::options_for_served(servers::Protocol::kIntact, serving);
    options.name = "keeping";
    options.tasks = task;
    options.episodes = {0, 0};
    options.seeds = {42};
    options.jobs = 1;
    return options;
  };
  const auto must = [&](const RunOptions& options) {
    const auto ran = run::run(plan, options);
    REQUIRE_MESSAGE(ran.ok(), to_text(ran.failure()));
    const auto rows = rows_of(options.out);
    REQUIRE(rows.size() == 1);
    REQUIRE_MESSAGE(!rows[0].invalid, rows[0].invalid.value_or(""));
    return rows[0].trace_sha256;
  };
  Wrapper wrapper;
  wrapper.kills_at = 8;
  int pipe[2];
  REQUIRE(::pipe(pipe) == 0);
  // Before there are threads; it hears the port when there is a server.
  wrapper.child = ::fork();
  REQUIRE(wrapper.child >= 0);
  if (wrapper.child == 0) {
    char port[8] = {};
    if (::read(pipe[0], port, sizeof port - 1) <= 0) ::_exit(2);
    ::_exit(run::run(plan, options_at(port, "carrot", "carrot_on_plate")).ok() ? 0 : 1);
  }
  serving.policy = [&] { return std::make_unique<Keeping>(wrapper); };
  const auto server = servers::serve(servers::Protocol::kIntact, serving);
  REQUIRE_MESSAGE(server.ok(), to_text(server.failure()));
  const std::string port = (*server)->port();
  REQUIRE(::write(pipe[1], port.data(), port.size()) == static_cast<ssize_t>(port.size()));
  int status = 0;
  REQUIRE(::waitpid(wrapper.child, &status, 0) == wrapper.child);
  REQUIRE(WIFSIGNALED(status));
  ::close(pipe[0]);
  ::close(pipe[1]);
  wrapper.kills_at = 0;
  CHECK(wrapper.kept.has_value());  // what the killed one had asked with
  const std::string spoon = must(options_at(port, "spoon", "spoon_on_towel"));
  const std::string carrot = must(options_at(port, "carrot", "carrot_on_plate"));

  Wrapper calm;
  serving.policy = [&] { return std::make_unique<Keeping>(calm); };
  const auto fresh = servers::serve(servers::Protocol::kIntact, serving);
  REQUIRE_MESSAGE(fresh.ok(), to_text(fresh.failure()));
  CHECK(must(options_at((*fresh)->port(), "calm_spoon", "spoon_on_towel")) == spoon);
  CHECK(must(options_at((*fresh)->port(), "calm_carrot", "carrot_on_plate")) == carrot);
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
    const auto full = run::run(plan, options);
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
  const auto summary = run::run(plan, options);
  REQUIRE_MESSAGE(summary.ok(), to_text(summary.failure()));
  CHECK(summary->skipped == static_cast<int>(stored));
  const auto undisturbed = run::run(plan, options_for(folder / "calm"));
  REQUIRE_MESSAGE(undisturbed.ok(), to_text(undisturbed.failure()));
  CHECK(rows_of(options.out) == rows_of(folder / "calm"));
}

}  // namespace
}  // namespace probe::run
