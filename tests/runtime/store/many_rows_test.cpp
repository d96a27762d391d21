// Folders of many rows: read in pieces, proven once, measured, cleaned.
#include <doctest/doctest.h>
#include <sys/stat.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <limits>
#include <thread>

#include "runtime/base/file.h"
#include "runtime/run/run.h"
#include "runtime/store/merge.h"
#include "runtime/store/proof.h"
#include "runtime/store/proof_book.h"
#include "runtime/store/room.h"
#include "runtime/store/store.h"
#include "runtime/store/stored_trace.h"
#include "tests/runtime/run/run_checks.h"
#include "tests/runtime/run/table_plan.h"
#include "tests/runtime/run/temporary_folder.h"
#include "tests/runtime/store/sample_run.h"

namespace probe::store {
using namespace probe::run;
namespace {

namespace fs = std::filesystem;

TEST_CASE("rows of more than one piece come in the plan's order, each once") {
  TemporaryFolder folder;
  const std::string dir = folder / "run";
  REQUIRE(Store::open(dir, record_of(), plan_bytes()).ok());
  // Two tasks, of which the plan has the second first; 5,000 rows of the one and 9,000 of the other.
  change_database(dir,
                  "with recursive n(i) as (select 0 union all select i + 1 from n where i < 8999) "
                  "insert into episodes select 'b', i / 3, i % 3, 1, '', '', 'p', '[]', 1, null, "
                  "'', '', '', '', '', null, null from n where i < 5000 union all select 'a', i, "
                  "42, 2, '', '', 'p', '[[\"success\",1,1.0]]', 1, null, '', '', '', '', '', null, "
                  "null from n");
  CHECK(count_rows(dir).value() == 14000);
  std::size_t count = 0;
  EpisodeKey last;
  const Status read = for_each_row(dir, [&](ResultRow&& row) -> Status {
    const EpisodeKey key = key_of(row);
    if (count != 0 && count != 5000) CHECK(last < key);
    CHECK(key.task == (count < 5000 ? "b" : "a"));
    CHECK(row.metrics.size() == (count < 5000 ? 0 : 1));
    last = key;
    ++count;
    return {};
  });
  REQUIRE_MESSAGE(read.ok(), to_text(read.failure()));
  CHECK(count == 14000);
  const auto stopped = for_each_row(dir, [&](ResultRow&&) -> Status {
    return Failure{Fault::kUsage, "enough", ""};
  });
  CHECK(stopped.failure().message == "enough");
}

TEST_CASE("remarks go to their rows in every piece that is read") {
  TemporaryFolder folder;
  const std::string dir = folder / "run";
  {
    auto store = Store::open(dir, record_of(), plan_bytes());
    REQUIRE(store.ok());
    ResultRow row = row_of(0);
    row.remark = "makes the table";
    REQUIRE(store_episode(**store, row).ok());
  }
  change_database(dir,
                  "delete from episodes; delete from remarks; "
                  "with recursive n(i) as (select 0 union all select i + 1 from n where i < 2999) "
                  "insert into episodes select 'a', i / 7, i % 7, 1, '', '', 'p', '[]', 1, null, "
                  "'', '', '', '', '', null, null from n; "
                  "insert into remarks select task, episode, seed, 'said of ' || episode || '/' || "
                  "seed from episodes where (episode + seed) % 3 = 0");
  std::size_t count = 0, said = 0;
  REQUIRE(for_each_row(dir, [&](ResultRow&& row) -> Status {
            ++count;
            const bool is_said = (row.episode + row.seed) % 3 == 0;
            said += is_said;
            const std::string wanted =
                "said of " + std::to_string(row.episode) + "/" + std::to_string(row.seed);
            CHECK(row.remark == (is_said ? std::optional(wanted) : std::nullopt));
            return {};
          }).ok());
  CHECK(count == 3000);
  CHECK(said > 900);
}

TEST_CASE("names that are no texts are refused, not read for ever") {
  TemporaryFolder folder;
  const std::string dir = folder / "run";
  REQUIRE(Store::open(dir, record_of(), plan_bytes()).ok());
  change_database(dir,
                  "insert into episodes select x'61', 0, 0, 1, '', '', 'p', '[]', 1, null, '', '', "
                  "'', '', '', null, null");
  const auto rows = read_results(dir);
  REQUIRE(!rows.ok());
  CHECK(rows.failure().message.find("of another type than any run's") != std::string::npos);
}

TEST_CASE("a number beyond any run's is not cut to one that a run could have") {
  TemporaryFolder folder;
  const std::string dir = folder / "run";
  REQUIRE(Store::open(dir, record_of(), plan_bytes()).ok());
  change_database(dir,
                  "insert into episodes select 'a', 0, 42, 1, '', '', 'p', '[]', 4294967356, null, "
                  "'', '', '', '', '', null, null; "
                  "insert into episodes select 'a', 1, 4294967338, 1, '', '', 'p', '[]', "
                  "-9223372036854775807, null, '', '', '', '', '', null, null");
  const auto rows = read_results(dir);
  REQUIRE(rows.ok());
  CHECK(rows->at(0).steps == std::numeric_limits<int>::max());
  CHECK(rows->at(1).seed == std::numeric_limits<int>::max());
  CHECK(rows->at(1).steps == std::numeric_limits<int>::min());
}

TEST_CASE("a proof is of a row and of its file as it is, and of no other") {
  TemporaryFolder folder;
  ResultRow row = row_of(1);
  row.trace = folder / "1-42.trace";
  REQUIRE(write_sample_trace(row.trace, 3).ok());
  // So lately that another change could have the same stamp.
  CHECK(!proof_key(row));
  std::this_thread::sleep_for(std::chrono::milliseconds(3200));
  const auto key = proof_key(row);
  REQUIRE(key);
  CHECK(proof_key(row) == key);
  ResultRow other = row;
  other.metrics[0].value = 0;
  CHECK(proof_key(other) != key);
  other = row;
  other.trace_sha256 = "ff";
  CHECK(proof_key(other) != key);
  // Put back to the times it had, its inode still says that it was changed.
  const auto time = fs::last_write_time(row.trace);
  REQUIRE(write_sample_trace(row.trace, 3).ok());
  fs::last_write_time(row.trace, time);
  CHECK(proof_key(row) != key);

  // Kept for the next reader, if there are enough of them; of another plan or a changed book none.
  const plan::Plan plan = table_plan(4, 6);
  const std::string cache = folder / "cache";
  {
    ProofBook book(folder / "run", plan, cache);
    book.add(*key, {0.25, -1});
    book.keep();
    CHECK(!fs::exists(cache));
    ProofKey many;
    for (std::size_t i = 0; i < ProofBook::kWorthKeeping; ++i) {
      many.bytes[0] = static_cast<std::uint8_t>(i);
      many.bytes[1] = static_cast<std::uint8_t>(i >> 8);
      book.add(many, {});
    }
    book.keep();
  }
  const ProofBook again(folder / "run", plan, cache);
  REQUIRE(again.find(*key) != nullptr);
  CHECK(*again.find(*key) == std::vector<double>{0.25, -1});
  CHECK(again.find(ProofKey{{9, 9, 9}}) == nullptr);
  CHECK(ProofBook(folder / "elsewhere", plan, cache).find(*key) == nullptr);
  CHECK(ProofBook(folder / "run", plan, "").find(*key) == nullptr);
  // A home that takes nothing more costs time alone.
  ProofBook homeless(folder / "run", plan, row.trace + "/proofs");
  for (int i = 0; i < 2 * static_cast<int>(ProofBook::kWorthKeeping); ++i)
    homeless.add(ProofKey{{1, static_cast<std::uint8_t>(i), static_cast<std::uint8_t>(i >> 8)}}, {});
  homeless.keep();
  for (const auto& file : fs::directory_iterator(cache)) {
    std::string bytes = read_file(file.path().string()).value();
    bytes[bytes.size() - 40] = static_cast<char>(bytes[bytes.size() - 40] ^ 1);
    std::ofstream(file.path()) << bytes;
  }
  CHECK(ProofBook(folder / "run", plan, cache).find(*key) == nullptr);
}

// A run of the table's plan in two shards below `out`, merged into it.
void make_merged(const std::string& out, const plan::Plan& plan) {
  for (const int shard : {1, 2}) {
    RunOptions options = options_for(out + "/shards/" + std::to_string(shard) + "-of-2");
    options.shard = shard;
    options.shards = 2;
    REQUIRE(run::run(plan, options).ok());
  }
  const auto merged =
      merge({.dirs = {out + "/shards/1-of-2", out + "/shards/2-of-2"}, .out = out});
  REQUIRE_MESSAGE(merged.ok(), to_text(merged.failure()));
}

TEST_CASE("what no row needs is found, and removed when it is asked for") {
  TemporaryFolder folder;
  const std::string dir = folder / "run";
  const plan::Plan plan = table_plan(4, 6);
  make_merged(dir, plan);
  const auto rows = read_results(dir).value();
  REQUIRE(rows.size() > 1);
  const auto rooms = measure_room(dir);
  REQUIRE(rooms.ok());
  CHECK((*rooms)[0].what == "traces");
  CHECK((*rooms)[0].files == static_cast<std::int64_t>(rows.size()));
  CHECK(rooms->back().what == "other");  // lock, chosen

  const std::string task = dir + "/traces/" + rows[0].task;
  std::ofstream(task + "/999-42.trace") << "x";
  std::ofstream(task + "/3-42.trace.tmp") << "x";
  std::ofstream(task + "/notes.txt") << "mine";
  std::ofstream(dir + "/shards/2-of-2/notes.txt") << "mine";
  const auto found = find_spares(dir);
  REQUIRE_MESSAGE(found.ok(), to_text(found.failure()));
  REQUIRE(found->spares.size() == 3);
  CHECK(found->spares[0].why == "was not finished");
  CHECK(found->spares[1].why == "no row is of it");
  CHECK(found->spares[2].why == "all of it is merged");
  CHECK(found->spares[2].path == dir + "/shards/1-of-2");
  REQUIRE(found->notes.size() == 1);
  CHECK(found->notes[0].find("`notes.txt`, which no run makes") != std::string::npos);
  REQUIRE(remove_spares(dir, *found).ok());
  CHECK(!fs::exists(task + "/999-42.trace"));
  CHECK(!fs::exists(dir + "/shards/1-of-2"));
  CHECK(fs::exists(task + "/notes.txt"));
  CHECK(read_proven_results(dir)->rows.size() == rows.size());
  CHECK(find_spares(dir)->spares.empty());
  // A copy of the database beside it is the user's as well.
  fs::rename(dir + "/shards/2-of-2/notes.txt", dir + "/shards/2-of-2/results.sqlite.bak");
  const auto copied = find_spares(dir);
  REQUIRE(copied.ok());
  CHECK(copied->spares.empty());
  REQUIRE(copied->notes.size() == 1);
  CHECK(copied->notes[0].find("`results.sqlite.bak`, which no run makes") != std::string::npos);
}

TEST_CASE("a merge that was preempted at any point is finished by the same call") {
  TemporaryFolder folder;
  const std::string dir = folder / "run", whole = folder / "whole";
  const plan::Plan plan = table_plan(4, 6);
  make_merged(dir, plan);
  make_merged(whole, plan);
  const auto rows = read_results(dir).value();
  REQUIRE(rows.size() >= 4);
  const auto key = [&](std::size_t i) {
    return " where task = '" + rows[i].task + "' and episode = " + std::to_string(rows[i].episode) +
           " and seed = " + std::to_string(rows[i].seed);
  };
  // Traces with their names and without rows; one half copied; one not begun.
  change_database(dir, "delete from episodes" + key(0));
  change_database(dir, "delete from episodes" + key(1));
  change_database(dir, "delete from episodes" + key(2));
  fs::rename(rows[1].trace, rows[1].trace + ".tmp");
  fs::resize_file(rows[1].trace + ".tmp", 20);
  fs::remove(rows[2].trace);
  const auto merged =
      merge({.dirs = {dir + "/shards/1-of-2", dir + "/shards/2-of-2"}, .out = dir});
  REQUIRE_MESSAGE(merged.ok(), to_text(merged.failure()));
  CHECK(merged->added == 3);
  const auto now = read_proven_results(dir), wanted = read_proven_results(whole);
  REQUIRE(now->refused.empty());
  REQUIRE(now->rows.size() == wanted->rows.size());
  for (std::size_t i = 0; i < now->rows.size(); ++i)
    CHECK(now->rows[i].trace_sha256 == wanted->rows[i].trace_sha256);
  CHECK(!fs::exists(rows[1].trace + ".tmp"));
}

TEST_CASE("a shard with a row that is not merged stays") {
  TemporaryFolder folder;
  const std::string dir = folder / "run";
  make_merged(dir, table_plan(4, 6));
  const auto row = read_results(dir + "/shards/1-of-2").value().at(0);
  change_database(dir, "delete from episodes where task = '" + row.task + "' and episode = " +
                           std::to_string(row.episode));
  const auto found = find_spares(dir);
  REQUIRE(found.ok());
  REQUIRE(!found->notes.empty());
  CHECK(found->notes[0].find("valid rows that are not merged") != std::string::npos);
  // Its trace has no row now.
  CHECK(std::ranges::any_of(found->spares,
                            [](const Spare& spare) { return spare.why == "no row is of it"; }));
}

// Rows that nobody could read stand for those that nobody has to.
TEST_CASE("a trace of one episode is found without reading the rows of others") {
  TemporaryFolder folder;
  const std::string dir = folder / "run";
  make_merged(dir, table_plan(4, 6));
  const ResultRow row = read_results(dir).value().at(2);  // its episode's lowest seed
  const auto refusal = [&](int episode, std::optional<int> seed) {
    const auto found = find_trace(dir, row.task, episode, seed);
    return found.ok() ? std::string() : found.failure().message;
  };
  CHECK(refusal(999, std::nullopt).find("no stored episode 999") != std::string::npos);
  CHECK(refusal(row.episode, 8).find("has no seed 8") != std::string::npos);
  change_database(dir,
                  "insert into episodes select x'61', 0, 0, 1, '', '', 'p', '[]', 1, null, '', '', "
                  "'', '', '', null, null");
  const auto found = find_trace(dir, row.task, row.episode, std::nullopt);
  REQUIRE_MESSAGE(found.ok(), to_text(found.failure()));
  CHECK(found->row.trace_sha256 == row.trace_sha256);
  CHECK(refusal(row.episode, 42).empty());
}

TEST_CASE("sizes are said with two digits or more") {
  CHECK(bytes_text(0) == "0 B");
  CHECK(bytes_text(999) == "999 B");
  CHECK(bytes_text(1500) == "1.5 kB");
  CHECK(bytes_text(999'900) == "1.0 MB");
  CHECK(bytes_text(123'456'789) == "123 MB");
}

}  // namespace
}  // namespace probe::store
