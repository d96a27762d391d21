// A run's folder: resume, refusal, and what a killed process leaves.
#include "runtime/store/store.h"
#include "runtime/base/json.h"

#include <doctest/doctest.h>
#include <signal.h>
#include <sqlite3.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <fstream>
#include <set>
#include <thread>

#include "runtime/plan/plan.h"
#include "runtime/store/stored_trace.h"
#include "tests/runtime/run/temporary_folder.h"
#include "tests/runtime/store/sample_run.h"
#include "tests/runtime/store/sample_trace.h"

namespace probe::store {
using namespace probe::run;
namespace {

namespace fs = std::filesystem;

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

TEST_CASE("what a policy says of an episode is kept with its row, and goes when it is run again") {
  TemporaryFolder folder;
  const std::string dir = folder / "run";
  const std::string said = "skill 1 `open cabinet.top_drawer`: there is no hold";
  {
    auto store = Store::open(dir, record_of(), plan_bytes());
    REQUIRE(store.ok());
    REQUIRE(store_episode(**store, row_of(0)).ok());
    ResultRow row = row_of(1);
    row.remark = said;
    REQUIRE(store_episode(**store, row).ok());
  }
  const auto rows = read_results(dir);
  REQUIRE(rows.ok());
  CHECK_FALSE(rows->at(0).remark);
  CHECK(rows->at(1).remark == said);
  const Json json = Json::parse(results_to_json(*rows));
  CHECK_FALSE(json[0].contains("remark"));
  CHECK(json[1]["remark"] == said);
  CHECK(results_to_csv(*rows).find(",trace,remark\n") != std::string::npos);
  auto store = Store::open(dir, record_of(), plan_bytes());
  REQUIRE_MESSAGE(store.ok(), to_text(store.failure()));
  REQUIRE(store_episode(**store, row_of(1)).ok());
  CHECK_FALSE(read_results(dir)->at(1).remark);
}

TEST_CASE("a row and its remark are of one moment, while another process writes both anew") {
  TemporaryFolder folder;
  const std::string dir = folder / "run";
  const auto put = [&](Store& store, int turn) {
    ResultRow row = row_of(0);
    row.steps = 1 + turn % 2;
    if (turn % 2 == 1) row.remark = "the second";
    return store_episode(store, row).ok();
  };
  auto store = Store::open(dir, record_of(), plan_bytes());
  REQUIRE(store.ok());
  REQUIRE(put(**store, 0));
  std::atomic<int> read = 0;
  std::atomic<bool> is_over = false, is_written = true;
  std::thread writer([&] {
    for (int turn = 1; turn < 200 || (read <= 10 && turn < 20'000); ++turn)
      is_written = put(**store, turn) && is_written;
    is_over = true;
  });
  int torn = 0;
  while (!is_over || read == 0) {
    const auto rows = read_results(dir);
    if (!rows) continue;  // busy
    ++read;
    torn += (rows->at(0).steps == 2) != rows->at(0).remark.has_value();
  }
  writer.join();
  CHECK(is_written);
  CHECK(read > 10);
  CHECK(torn == 0);
}

TEST_CASE("rows say idle steps, late actions and joints where a task has them") {
  std::vector<ResultRow> rows = {row_of(0), row_of(1)};
  rows[1].idle = 10;
  rows[1].delay = 2;
  rows[1].joints = {{"cabinet.top", 0.125}};
  rows[1].metrics.push_back({"delay", true, 1});
  const Json json = Json::parse(results_to_json(rows));
  for (const char* key : {"idle", "delay", "joints"}) CHECK_FALSE(json[0].contains(key));
  CHECK(json[1]["idle"] == 10);
  CHECK(json[1]["delay"] == 2);
  CHECK(json[1]["joints"]["cabinet.top"] == 0.125);
  CHECK(json[1]["metric.delay"] == true);
  const std::string csv = results_to_csv(rows);
  CHECK(csv.find(",trace,idle,delay,joint.cabinet.top\n") != std::string::npos);
  CHECK(csv.ends_with(",10,2,0.125\n"));
  CHECK(results_to_csv(std::span(rows).first(1)).find("idle") == std::string::npos);
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
  fs::remove(trace_path(dir, {"carrot_on_plate", 2, 42}));
  auto store = Store::open(dir, record_of(), plan_bytes());
  REQUIRE(store.ok());
  const auto episodes = (*store)->episodes();
  REQUIRE(episodes.ok());
  REQUIRE(episodes->size() == 3);
  for (const StoredEpisode& episode : *episodes) CHECK(episode.valid == (episode.key.episode == 0));
  REQUIRE(store_episode(**store, row_of(1)).ok());
  const auto rows = read_results(dir);
  CHECK(rows->size() == 3);
  CHECK_FALSE((*rows)[1].invalid.has_value());
}

TEST_CASE(
    "rows wait to be shown the work of one policy, over calls, and become invalid or are "
    "believed") {
  TemporaryFolder folder;
  const std::string dir = folder / "run";
  const auto key = [](int episode) { return EpisodeKey{"carrot_on_plate", episode, 42}; };
  {
    auto store = Store::open(dir, record_of(), plan_bytes());
    REQUIRE(store.ok());
    REQUIRE(store_episode(**store, row_of(0)).ok());
    CHECK((*store)->unproven().value().empty());
    CHECK((*store)->forget_unproven().ok());
    REQUIRE((*store)->note_unproven().ok());
    REQUIRE(store_episode(**store, row_of(1)).ok());
    REQUIRE(store_episode(**store, row_of(2, "policy: gone")).ok());
    REQUIRE(store_episode(**store, row_of(3)).ok());
  }
  // Of a call that was killed here, say.
  CHECK(read_unproven(dir).value() == std::vector<EpisodeKey>{key(1), key(3)});
  CHECK(read_reading_summary(dir)->findings.back().starts_with(
      "2 episodes were answered in a call that was not shown to have had one policy to its end"));
  auto store = Store::open(dir, record_of(), plan_bytes());
  REQUIRE(store.ok());
  const std::string reason = "policy: gpu:1: " + std::string(Store::kMixedUp);
  REQUIRE((*store)->invalidate({key(1)}, reason).ok());
  CHECK((*store)->unproven().value() == std::vector<EpisodeKey>{key(3)});
  // Rows that came while the policy was asked are not shown by its answer.
  REQUIRE((*store)->note_unproven().ok());
  REQUIRE(store_episode(**store, row_of(4)).ok());
  REQUIRE((*store)->forget_unproven({key(3)}).ok());
  CHECK((*store)->unproven().value() == std::vector<EpisodeKey>{key(4)});
  REQUIRE((*store)->forget_unproven().ok());
  CHECK((*store)->unproven().value().empty());
  const auto rows = read_results(dir);
  REQUIRE(rows.ok());
  CHECK((*rows)[1].invalid == reason);
  CHECK_FALSE((*rows)[3].invalid.has_value());
  // Its trace ended well all the same, and still is its own.
  CHECK(read_stored_trace((*rows)[1]).ok());
  REQUIRE((*store)->doubt({key(0)}).ok());
  CHECK((*store)->unproven().value() == std::vector<EpisodeKey>{key(0)});
}

TEST_CASE("a truncated, swapped or foreign trace does not count as stored") {
  TemporaryFolder folder;
  const std::string dir = folder / "run";
  auto store = Store::open(dir, record_of(), plan_bytes());
  REQUIRE(store.ok());
  for (int episode = 0; episode < 4; ++episode) {
    REQUIRE(store_episode(**store, row_of(episode)).ok());
  }
  const auto path = [&](int episode) { return trace_path(dir, {"carrot_on_plate", episode, 42}); };
  fs::resize_file(path(1), fs::file_size(path(1)) - 20);
  fs::copy_file(path(0), path(2), fs::copy_options::overwrite_existing);
  REQUIRE(write_sample_trace(path(3), 2).ok());  // of the right episode, but other content
  const auto episodes = (*store)->episodes();
  REQUIRE(episodes.ok());
  REQUIRE(episodes->size() == 4);
  CHECK(episodes->at(0).valid);
  CHECK(episodes->at(1).why.find("truncated") != std::string::npos);
  for (const int episode : {1, 2, 3}) {
    CHECK_FALSE(episodes->at(static_cast<std::size_t>(episode)).valid);
    CHECK(episodes->at(static_cast<std::size_t>(episode)).why.starts_with(path(episode)));
  }
  CHECK(episodes->at(2).why.find("of carrot_on_plate episode 0 seed 42") != std::string::npos);
}

TEST_CASE("a row with metrics that cannot be read is invalid, and the others are there") {
  TemporaryFolder folder;
  const std::string dir = folder / "run";
  auto store = Store::open(dir, record_of(), plan_bytes());
  REQUIRE(store.ok());
  REQUIRE(store_episode(**store, row_of(0)).ok());
  REQUIRE(store_episode(**store, row_of(1)).ok());
  change_database(dir, "update episodes set metrics = '[[1,2]' where episode = 1");
  const auto rows = read_results(dir);
  REQUIRE_MESSAGE(rows.ok(), to_text(rows.failure()));
  CHECK_FALSE(rows->at(0).invalid);
  CHECK(rows->at(1).invalid == "store: its metrics in results.sqlite cannot be read");
  CHECK_FALSE((*store)->episodes()->at(1).valid);
}

TEST_CASE("a run record of another form names the file and the key") {
  TemporaryFolder folder;
  const std::string dir = folder / "run";
  REQUIRE(Store::open(dir, record_of(), plan_bytes()).ok());
  for (const auto& [key, json] :
       std::vector<std::pair<std::string, std::string>>{{"plan_root", "5"},
                                                        {"schema", "1"},
                                                        {"policy", "null"},
                                                        {"suite", "[]"},
                                                        {"seeds", "[\"a\"]"},
                                                        {"seeds", "7"},
                                                        {"fingerprint", "{}"},
                                                        {"fingerprint", "\"5\""}}) {
    CAPTURE(key);
    CAPTURE(json);
    auto record = Json{{"schema", "1"}, {"plan_root", "aa"}, {"policy", "null"},
                       {"suite", "s"},  {"seeds", {42}},     {"fingerprint", "{}"}};
    record[key] = Json::parse(json);
    change_database(dir, "update run set value = '" + record.dump() + "'");
    const auto read = read_run_record(dir);
    REQUIRE_FALSE(read.ok());
    CHECK(read.failure().code == Fault::kStore);
    CHECK(read.failure().where == dir + "/results.sqlite");
    CHECK(read.failure().message.find("`" + key + "`") != std::string::npos);
    CHECK_FALSE(Store::open(dir, record_of(), plan_bytes()).ok());
  }
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
  CHECK(policy.failure().code == Fault::kStore);
  CHECK(policy.failure().where == dir);
  CHECK(policy.failure().message.find("policy `null`, not `expert`") != std::string::npos);
  CHECK(Store::open(dir, record_of("null", "bb"), plan_bytes())
            .failure()
            .message.find("another plan") != std::string::npos);
  CHECK(Store::open(dir, record_of(), plan_bytes()).ok());
}

TEST_CASE("a folder of answers is no run's, neither to write into nor to read") {
  TemporaryFolder folder;
  const std::string dir = folder / "answers";
  std::filesystem::create_directories(dir);
  std::ofstream(dir + "/answers.sqlite") << "x";
  std::ofstream(dir + "/suite.plan") << "the plan of the questions";
  const auto store = Store::open(dir, record_of(), plan_bytes());
  REQUIRE_FALSE(store.ok());
  CHECK(store.failure().message == "holds a model's answers; take another folder for a run");
  CHECK(store.failure().where == dir);
  CHECK(std::filesystem::file_size(dir + "/suite.plan") == 25);
  CHECK(read_results(dir).failure().message == "holds a model's answers, not a run");
  CHECK(read_run_record(dir).failure().message == "holds a model's answers, not a run");
}

TEST_CASE("a folder of the first schema is read, and raised when it is written") {
  TemporaryFolder folder;
  const std::string dir = folder / "run";
  {
    auto store = Store::open(dir, record_of(), plan_bytes());
    REQUIRE(store.ok());
    REQUIRE(store_episode(**store, row_of(0)).ok());
  }
  // As a program of that time left it.
  change_database(dir, "alter table episodes drop column sent_prompt_sha256");
  change_database(dir, "alter table episodes drop column sent_image_sha256");
  change_database(dir, "drop table calls");
  const Json old = {{"schema", "1"}, {"plan_root", "aa"}, {"policy", "null"},
                    {"suite", "s"},  {"seeds", {42}},     {"fingerprint", "{}"}};
  change_database(dir, "update run set value = '" + old.dump() + "'");
  REQUIRE_MESSAGE(read_results(dir).ok(), to_text(read_results(dir).failure()));
  CHECK(read_results(dir)->size() == 1);
  CHECK(read_run_calls(dir)->empty());
  CHECK(read_run_record(dir)->schema == 1);

  auto store = Store::open(dir, record_of(), plan_bytes());
  REQUIRE_MESSAGE(store.ok(), to_text(store.failure()));
  ResultRow row = row_of(1);
  row.sent_prompt_sha256 = "p";
  REQUIRE(store_episode(**store, row).ok());
  CHECK(read_run_record(dir)->schema == 2);
  const auto rows = read_results(dir);
  CHECK_FALSE(rows->at(0).sent_prompt_sha256);
  CHECK(rows->at(1).sent_prompt_sha256 == "p");
  CHECK_FALSE(rows->at(1).sent_image_sha256);
}

TEST_CASE("each call leaves its figures, the last state of each") {
  TemporaryFolder folder;
  const std::string dir = folder / "run";
  RunCall call;
  call.fingerprint = {{{"cpu", "test"}}};
  call.worlds = 8;
  for (int i = 0; i < 2; ++i) {
    auto store = Store::open(dir, record_of(), plan_bytes());
    REQUIRE(store.ok());
    call.ended = false;
    REQUIRE((*store)->write_call(call).ok());
    call.ended = true;
    call.observations = 100 + i;
    call.elapsed_s = 10;
    call.queries = {25, 10, 9, 60, 8};
    call.reading = policy::Reading{.server = "gpu:443",
                                   .answers = 3,
                                   .answers_sha256 = "ab",
                                   .questions_sha256 = "cd",
                                   .is_steady = true,
                                   .at_end = i == 1 ? policy::AtEnd::kOther : policy::AtEnd::kSame,
                                   .measured = {{"action.form", "delta"}},
                                   .is_unchecked = i == 1};
    REQUIRE((*store)->write_call(call).ok());
  }
  const auto calls = read_run_calls(dir);
  REQUIRE_MESSAGE(calls.ok(), to_text(calls.failure()));
  REQUIRE(calls->size() == 2);
  CHECK(calls->at(0).observations == 100);
  CHECK(calls->at(1).ended);
  CHECK(calls->at(1).queries.most_at_once == 8);
  CHECK_FALSE(calls->at(0).reading->is_unchecked);
  CHECK(calls->at(0).reading->at_end == policy::AtEnd::kSame);
  CHECK(calls->at(1).reading == call.reading);
  CHECK(to_text(calls->at(0)) ==
        "10.0 observations/s, 2.5 queries/s; server busy 90.0 % of the time, simulators waiting "
        "for it 75.0 % of theirs");
}

TEST_CASE("a folder that cannot be written is named") {
  TemporaryFolder folder;
  std::ofstream(folder / "file") << "x";
  const auto store = Store::open(folder / "file/run", record_of(), plan_bytes());
  REQUIRE_FALSE(store.ok());
  CHECK(store.failure().code == Fault::kStore);
  CHECK(store.failure().where == folder / "file/run");
  CHECK_FALSE(read_results(folder / "nothing").ok());
  std::ofstream(folder / "results.sqlite") << "this is no database, and it is longer than a header";
  CHECK(read_results(folder.path).failure().code == Fault::kStore);
  CHECK(read_results(folder.path).failure().message.find("move this file away and run again") !=
        std::string::npos);
  CHECK(
      read_run_record(folder.path).failure().message.starts_with("results.sqlite cannot be read"));
  CHECK(Store::open(folder.path, record_of(), plan_bytes()).failure().code == Fault::kStore);
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

TEST_CASE("what a kill left of a plan goes with the next opening") {
  TemporaryFolder folder;
  const std::string dir = folder / "run";
  fs::create_directories(dir);
  std::ofstream(dir + "/suite.plan.4711-0.tmp") << "half";
  std::ofstream(dir + "/chosen.4711-1.tmp") << "ha";
  REQUIRE(Store::open(dir, record_of(), plan_bytes()).ok());
  CHECK_FALSE(fs::exists(dir + "/suite.plan.4711-0.tmp"));
  CHECK_FALSE(fs::exists(dir + "/chosen.4711-1.tmp"));
  CHECK(fs::exists(dir + "/suite.plan"));
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

TEST_CASE(
    "a database that brings triggers, views or columns of its own is refused by their names") {
  for (const auto& [sql, what] :
       {std::pair(
            "create trigger t after insert on episodes begin update episodes set steps = 0; end",
            "the trigger `t`"),
        std::pair("create view v as select 1", "the view `v`"),
        std::pair("create index i on episodes (steps)", "the index `i`"),
        std::pair("create table more (a)", "the table `more`"),
        std::pair("alter table episodes add column x", "the column `x` in `episodes`"),
        std::pair("alter table run add column y as (1)", "the column `y` in `run`"),
        std::pair("drop table calls; create view calls as with recursive c(n) as (select 1 union "
                  "all select n + 1 from c) select n as number, '' as value from c",
                  "the view `calls`")}) {
    CAPTURE(sql);
    TemporaryFolder folder;
    const std::string dir = folder / "run";
    {
      auto store = Store::open(dir, record_of(), plan_bytes());
      REQUIRE(store.ok());
      REQUIRE(store_episode(**store, row_of(0)).ok());
    }
    change_database(dir, sql);
    const std::string wanted = std::string("results.sqlite has ") + what +
                               ", which no run makes; the traces are intact: "
                               "move this file away and run again";
    const auto rows = read_results(dir);
    REQUIRE_FALSE(rows.ok());
    CHECK(rows.failure().message == wanted);
    CHECK(read_run_calls(dir).failure().message == wanted);
    const auto store = Store::open(dir, record_of(), plan_bytes());
    REQUIRE_FALSE(store.ok());
    CHECK(store.failure().message == wanted);
  }
}

TEST_CASE("a value of megabytes in a database is refused before it fills the memory") {
  TemporaryFolder folder;
  const std::string dir = folder / "run";
  {
    auto store = Store::open(dir, record_of(), plan_bytes());
    REQUIRE(store.ok());
    REQUIRE(store_episode(**store, row_of(0)).ok());
  }
  change_database(dir, "update episodes set prompt_sha256 = hex(zeroblob(4000000))");
  const auto rows = read_results(dir);
  REQUIRE_FALSE(rows.ok());
  CHECK(rows.failure().message.find("too big") != std::string::npos);
}

TEST_CASE("a database, a plan or a trace that is a pipe is refused and not waited for") {
  TemporaryFolder folder;
  const std::string dir = folder / "run";
  fs::create_directories(dir);
  REQUIRE(::mkfifo((dir + "/results.sqlite").c_str(), 0600) == 0);
  CHECK(read_results(dir).failure().message == "is no file but a folder, a device or a pipe");
  CHECK_FALSE(Store::open(dir, record_of(), plan_bytes()).ok());
  CHECK(read_trace(dir + "/results.sqlite").failure().message ==
        "is no file but a folder, a device or a pipe");
  CHECK_FALSE(plan::Plan::open(dir + "/results.sqlite").ok());
}

TEST_CASE("what a killed process left is removed, but nothing behind a link and no other's file") {
  TemporaryFolder folder;
  const std::string dir = folder / "run", elsewhere = folder / "elsewhere";
  fs::create_directories(dir + "/traces/carrot");
  fs::create_directories(elsewhere + "/carrot");
  for (const std::string& name :
       {dir + "/traces/carrot/3-42.trace.tmp", dir + "/traces/carrot/notes.tmp",
        dir + "/traces/own.tmp", elsewhere + "/carrot/3-42.mp4.77-0.tmp"}) {
    std::ofstream(name) << "x";
  }
  fs::create_symlink(elsewhere, dir + "/videos");
  fs::create_symlink(elsewhere + "/carrot", dir + "/traces/linked");
  REQUIRE(Store::open(dir, record_of(), plan_bytes()).ok());
  CHECK_FALSE(fs::exists(dir + "/traces/carrot/3-42.trace.tmp"));
  CHECK(fs::exists(dir + "/traces/carrot/notes.tmp"));
  CHECK(fs::exists(dir + "/traces/own.tmp"));
  CHECK(fs::exists(elsewhere + "/carrot/3-42.mp4.77-0.tmp"));
}

TEST_CASE("rows print as JSON with the promised keys") {
  std::vector<ResultRow> rows = {row_of(0), row_of(1, "policy: \xff closed, \"late\"")};
  const auto json = Json::parse(results_to_json(rows));
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

TEST_CASE("a metric that is called as a field of its row takes no other's place") {
  const ResultRow plain = row_of(0);
  const Json fields = Json::parse(results_to_json(std::span(&plain, 1)))[0];
  ResultRow row = plain;
  for (const auto& [name, value] : fields.items()) {
    if (name != "success" && name != "height") row.metrics.push_back({name, false, 0.25});
  }
  row.metrics.push_back({"metric.task", false, 0.5});
  const Json json = Json::parse(results_to_json(std::span(&row, 1)))[0];
  for (const auto& [name, value] : fields.items()) {
    CAPTURE(name);
    CHECK(json[name] == value);
    if (name != "success" && name != "height") CHECK(json["metric." + name] == 0.25);
  }
  CHECK(json["metric.metric.task"] == 0.5);
  const std::string csv = results_to_csv(std::span(&row, 1));
  const std::string header = csv.substr(0, csv.find('\n'));
  std::set<std::string> columns;
  std::size_t count = 0;
  for (std::size_t at = 0; at <= header.size(); ++count) {
    const std::size_t end = std::min(header.find(',', at), header.size());
    columns.insert(header.substr(at, end - at));
    at = end + 1;
  }
  CHECK(columns.size() == count);
  CHECK(columns.contains("task"));
  CHECK(columns.contains("metric.task"));
}

TEST_CASE("the order of a run that stops by what it finds is frozen, and goes with its rule") {
  TemporaryFolder folder;
  const std::string dir = folder / "run";
  RunRecord record = record_of();
  record.identity.until = "width 10 % of each task";
  const std::vector<OrderedEpisode> order = {
      {{"carrot_on_plate", 1, 42}, true}, {{"carrot_on_plate", 0, 42}, false}, {{"a; b", 0, -1}, {}}};
  {
    auto store = Store::open(dir, record, plan_bytes());
    REQUIRE(store.ok());
    CHECK((*store)->freeze_order(order).ok());
    CHECK((*store)->freeze_order(order).ok());
    const auto other = (*store)->freeze_order(std::span(order).first(2));
    REQUIRE_FALSE(other.ok());
    CHECK(other.failure().message.find("was begun over 3 episodes") != std::string::npos);
  }
  CHECK(*read_order(dir) == order);
  CHECK(read_run_record(dir)->identity.until == record.identity.until);
  {
    auto store = Store::open(dir, record, plan_bytes());
    REQUIRE((*store)->forget_until().ok());
  }
  CHECK(read_order(dir)->empty());
  CHECK(read_run_record(dir)->identity.until.empty());
  CHECK(Store::open(dir, record_of(), plan_bytes()).ok());
}

}  // namespace
}  // namespace probe::store
