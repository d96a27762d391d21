// In which order files, names and rows reach the disk: a power cut at any moment must not leave a
// row without its trace. Every call that forces something to the disk or renames goes through here,
// also SQLite's.
#include <doctest/doctest.h>
#include <fcntl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <mutex>
#include <string>
#include <vector>

#include "runtime/store/merge.h"
#include "runtime/store/store.h"
#include "tests/runtime/run/run_checks.h"
#include "tests/runtime/run/table_plan.h"
#include "tests/runtime/run/temporary_folder.h"
#include "tests/runtime/store/sample_run.h"

namespace {

struct Events {
  std::mutex mutex;
  bool recording = false;
  std::vector<std::string> list;

  void add(std::string event) {
    const std::lock_guard lock(mutex);
    if (recording) list.push_back(std::move(event));
  }
};
Events events;

std::string path_of(int file) {
  char path[4096] = "";
  const std::string link = "/proc/self/fd/" + std::to_string(file);
  const ssize_t size = ::readlink(link.c_str(), path, sizeof path - 1);
  return {path, size > 0 ? static_cast<std::size_t>(size) : 0};
}

}  // namespace

// The linker takes these for the C library's.
extern "C" {
int fsync(int file) {
  events.add("sync " + path_of(file));
  return static_cast<int>(::syscall(SYS_fsync, file));
}
int fdatasync(int file) {
  events.add("sync " + path_of(file));
  return static_cast<int>(::syscall(SYS_fdatasync, file));
}
int rename(const char* from, const char* to) noexcept {
  events.add(std::string("rename ") + to);
  return static_cast<int>(::syscall(SYS_renameat2, AT_FDCWD, from, AT_FDCWD, to, 0));
}
}

namespace probe::store {
namespace {

namespace fs = std::filesystem;

class Recording {
 public:
  Recording() {
    const std::lock_guard lock(events.mutex);
    events.list.clear();
    events.recording = true;
  }
  ~Recording() { events.recording = false; }

  // Of the first such event after `from`; the list's size if there is none.
  std::size_t find(const std::string& event, std::size_t from = 0) const {
    return static_cast<std::size_t>(
        std::find(events.list.begin() + static_cast<std::ptrdiff_t>(from), events.list.end(),
                  event) -
        events.list.begin());
  }
  std::size_t find_start(const std::string& start, std::size_t from) const {
    return static_cast<std::size_t>(
        std::find_if(events.list.begin() + static_cast<std::ptrdiff_t>(from), events.list.end(),
                     [&](const std::string& event) { return event.starts_with(start); }) -
        events.list.begin());
  }
  std::size_t count() const { return events.list.size(); }
};

void check_order(const Recording& recorded, const std::string& dir, const EpisodeKey& key) {
  const std::string trace = trace_path(dir, key);
  CAPTURE(trace);
  const std::size_t bytes = recorded.find("sync " + trace + ".tmp");
  const std::size_t renamed = recorded.find("rename " + trace, bytes);
  const std::size_t name = recorded.find("sync " + fs::path(trace).parent_path().string(), renamed);
  const std::size_t row = recorded.find_start("sync " + dir + "/results.sqlite", name);
  CHECK(bytes < renamed);
  CHECK(renamed < name);
  CHECK(name < row);
  CHECK(row < recorded.count());
}

TEST_CASE("a stored row follows its trace to the disk") {
  const run::TemporaryFolder folder;
  const std::string dir = fs::canonical(folder.path).string() + "/run";
  const Recording recorded;
  auto store = Store::open(dir, record_of(), plan_bytes());
  REQUIRE(store.ok());
  for (int episode = 0; episode < 2; ++episode) {
    REQUIRE(store_episode(**store, row_of(episode)).ok());
    check_order(recorded, dir, {"carrot_on_plate", episode, 42});
  }
  // The folders' own names too, before any row.
  const std::size_t first_row =
      recorded.find_start("sync " + dir + "/results.sqlite",
                          recorded.find("rename " + trace_path(dir, {"carrot_on_plate", 0, 42})));
  CHECK(recorded.find("sync " + dir + "/traces") < first_row);
  CHECK(recorded.find("sync " + dir) < first_row);
}

TEST_CASE("a merged row follows its copied trace to the disk") {
  const run::TemporaryFolder folder;
  const std::string place = fs::canonical(folder.path).string();
  const std::string a = place + "/a", b = place + "/b", out = place + "/out";
  const plan::Plan plan = run::table_plan(2, 2);
  for (const auto& [dir, episode] : {std::pair(a, 0), std::pair(b, 1)}) {
    run::RunOptions options = run::options_for(dir);
    options.episodes = {episode, episode};
    run::must_run(plan, options);
  }
  const Recording recorded;
  const auto merged = merge({.dirs = {a, b}, .out = out});
  REQUIRE_MESSAGE(merged.ok(), to_text(merged.failure()));
  const auto rows = read_results(out);
  REQUIRE(rows.ok());
  CHECK(rows->size() == 4);  // an episode of each of two tasks from each folder
  for (const ResultRow& row : *rows) check_order(recorded, out, key_of(row));
}

}  // namespace
}  // namespace probe::store
