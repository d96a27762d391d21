// A run's folder: resume, refusal, and what a killed process leaves.
#include "runtime/run/store.h"

#include <doctest/doctest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/runtime/run/sample_trace.h"
#include "tests/runtime/run/temporary_folder.h"

namespace probe::run {
namespace {

namespace fs = std::filesystem;

RunRecord record_of(const std::string& policy = "null", const std::string& root = "aa") {
  return {{root, policy}, "smoke", {42}, {{{"cpu", "test"}}}};
}

std::span<const std::byte> plan_bytes() {
  static constexpr std::byte kBytes[] = {std::byte{1}, std::byte{2}};
  return kBytes;
}

ResultRow row_of(int episode, std::optional<std::string> invalid = std::nullopt) {
  ResultRow row;
  row.task = "carrot_on_plate";
  row.episode = episode;
  row.seed = 42;
  row.policy = "null";
  row.metrics = {{"success", true, 1}, {"height", false, 0.1}};
  row.steps = 60;
  row.invalid = std::move(invalid);
  row.prompt_sha256 = to_hex(sha256(std::string_view("put carrot on plate")));
  row.trace_sha256 = "t" + std::to_string(episode);
  return row;
}

Status store_episode(Store& store, const ResultRow& row) {
  PROBE_TRY([&]() -> Status {
    auto written = write_sample_trace(store.temporary_trace(row.task, row.episode, row.seed), 1);
    return written.ok() ? Status() : Status(written.failure());
  }());
  return store.commit(row, 0);
}

TEST_CASE("rows come back in order, with an absolute trace path") {
  TemporaryFolder folder;
  const std::string dir = folder / "run";
  {
    auto store = Store::open(dir, record_of(), plan_bytes());
    REQUIRE_MESSAGE(store.ok(), to_text(store.failure()));
    for (const int episode : {2, 0, 1}) REQUIRE(store_episode(**store, row_of(episode)).ok());
  }
  const auto rows = read_results(dir);
  REQUIRE(rows.ok());
  REQUIRE(rows->size() == 3);
  for (int i = 0; i < 3; ++i) {
    const ResultRow& row = (*rows)[static_cast<std::size_t>(i)];
    CHECK(row.episode == i);
    CHECK(fs::path(row.trace).is_absolute());
    CHECK(fs::exists(row.trace));
    CHECK(row.metrics == row_of(i).metrics);
  }
  CHECK(fs::file_size(plan_path(dir)) == 2);
  CHECK(read_run_record(dir)->identity == record_of().identity);
}

TEST_CASE("valid rows are kept, invalid ones and lost traces are run again") {
  TemporaryFolder folder;
  const std::string dir = folder / "run";
  {
    auto store = Store::open(dir, record_of(), plan_bytes());
    REQUIRE(store.ok());
    REQUIRE(store_episode(**store, row_of(0)).ok());
    REQUIRE(store_episode(**store, row_of(1, "policy: gone")).ok());
    REQUIRE(store_episode(**store, row_of(2)).ok());
  }
  fs::remove(trace_path(dir, "carrot_on_plate", 2, 42));
  auto store = Store::open(dir, record_of(), plan_bytes());
  REQUIRE(store.ok());
  const auto episodes = (*store)->episodes();
  REQUIRE(episodes.ok());
  REQUIRE(episodes->size() == 3);
  for (const StoredEpisode& episode : *episodes) CHECK(episode.valid == (episode.episode == 0));
  REQUIRE(store_episode(**store, row_of(1)).ok());
  const auto rows = read_results(dir);
  CHECK(rows->size() == 3);
  CHECK_FALSE((*rows)[1].invalid.has_value());
}

TEST_CASE("another plan or policy is refused, and so is a second writer") {
  TemporaryFolder folder;
  const std::string dir = folder / "run";
  {
    auto store = Store::open(dir, record_of(), plan_bytes());
    REQUIRE(store.ok());
    const auto second = Store::open(dir, record_of(), plan_bytes());
    REQUIRE_FALSE(second.ok());
    CHECK(second.failure().message == "another run is writing into this folder");
  }
  const auto policy = Store::open(dir, record_of("expert"), plan_bytes());
  REQUIRE_FALSE(policy.ok());
  CHECK(policy.failure().code == "store");
  CHECK(policy.failure().where == dir);
  CHECK(policy.failure().message.find("policy `null`, not `expert`") != std::string::npos);
  CHECK(Store::open(dir, record_of("null", "bb"), plan_bytes())
            .failure()
            .message.find("another plan") != std::string::npos);
  CHECK(Store::open(dir, record_of(), plan_bytes()).ok());
}

TEST_CASE("a folder that cannot be written is named") {
  TemporaryFolder folder;
  std::ofstream(folder / "file") << "x";
  const auto store = Store::open(folder / "file/run", record_of(), plan_bytes());
  REQUIRE_FALSE(store.ok());
  CHECK(store.failure().code == "store");
  CHECK(store.failure().where == folder / "file/run");
  CHECK_FALSE(read_results(folder / "nothing").ok());
  std::ofstream(folder / "results.sqlite") << "this is no database, and it is longer than a header";
  CHECK(read_results(folder.path).failure().code == "store");
  CHECK(Store::open(folder.path, record_of(), plan_bytes()).failure().code == "store");
}

// What a worker does until it is killed: episode after episode.
[[noreturn]] void write_until_killed(const std::string& dir) {
  auto store = Store::open(dir, record_of(), plan_bytes());
  if (!store) ::_exit(1);
  const auto stored = (*store)->episodes();
  for (int episode = static_cast<int>(stored->size());; ++episode) {
    if (!store_episode(**store, row_of(episode)).ok()) ::_exit(2);
  }
}

TEST_CASE("kill -9 at any time leaves whole rows with whole traces, each once") {
  TemporaryFolder folder;
  const std::string dir = folder / "run";
  std::size_t before = 0;
  for (int round = 0; round < 6; ++round) {
    const pid_t child = ::fork();
    REQUIRE(child >= 0);
    if (child == 0) write_until_killed(dir);
    ::usleep(static_cast<useconds_t>(20000 + 9000 * round));
    ::kill(child, SIGKILL);
    int status = 0;
    ::waitpid(child, &status, 0);
    REQUIRE(WIFSIGNALED(status));
    const auto rows = read_results(dir);
    if (!rows.ok()) continue;  // killed before the folder had a run
    CHECK(rows->size() >= before);
    before = rows->size();
    for (std::size_t i = 0; i < rows->size(); ++i) {
      CHECK((*rows)[i].episode == static_cast<int>(i));
      CHECK(read_trace((*rows)[i].trace).ok());
    }
  }
  auto store = Store::open(dir, record_of(), plan_bytes());
  REQUIRE(store.ok());
  for (const auto& entry : fs::recursive_directory_iterator(dir)) {
    CHECK(entry.path().extension() != ".tmp");
  }
}

TEST_CASE("rows print as JSON with the promised keys") {
  std::vector<ResultRow> rows = {row_of(0), row_of(1, "policy: \xff closed, \"late\"")};
  const auto json = nlohmann::json::parse(results_to_json(rows));
  REQUIRE(json.size() == 2);
  CHECK(json[0]["success"] == true);
  CHECK(json[0]["height"] == 0.1);
  CHECK(json[0]["invalid"].is_null());
  CHECK(json[1]["success"].is_null());
  CHECK(json[1]["invalid"].is_string());
  for (const char* key : {"task", "episode", "seed", "policy", "steps", "prompt_sha256",
                          "image_sha256", "trace_sha256", "episode_id", "trace"}) {
    CHECK(json[0].contains(key));
  }
  CHECK(results_to_json({}) == "[]\n");
  rows[1].invalid = "a, \"b\"";
  const std::string csv = results_to_csv(rows);
  CHECK(csv.starts_with("task,episode,seed,policy,success,height,steps,invalid,"));
  CHECK(csv.find("carrot_on_plate,0,42,null,true,0.10000000000000001,60,,") != std::string::npos);
  CHECK(csv.find("\"a, \"\"b\"\"\"") != std::string::npos);
}

}  // namespace
}  // namespace probe::run
