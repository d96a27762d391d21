// A small run for tests of the store: its record, its rows, and traces to go with them.
#pragma once

#include <doctest/doctest.h>
#include <sqlite3.h>

#include <optional>
#include <string>

#include "runtime/store/store.h"
#include "runtime/store/trace.h"
#include "tests/runtime/store/sample_trace.h"

namespace probe::store {

inline RunRecord record_of(const std::string& policy = "null", const std::string& root = "aa") {
  return {{root, policy}, "smoke", {42}, {{{"cpu", "test"}}}};
}

inline std::span<const std::byte> plan_bytes() {
  static constexpr std::byte kBytes[] = {std::byte{1}, std::byte{2}};
  return kBytes;
}

inline ResultRow row_of(int episode, std::optional<std::string> invalid = std::nullopt) {
  ResultRow row;
  row.task = "carrot_on_plate";
  row.episode = episode;
  row.seed = 42;
  row.policy = "null";
  row.metrics = {{"success", true, 1}, {"height", false, 0.1}};
  row.steps = 60;
  row.invalid = std::move(invalid);
  row.prompt_sha256 = to_hex(sha256(std::string_view("put carrot on plate")));
  return row;
}

inline Status store_episode(Store& store, ResultRow row) {
  TraceHeader header = sample_header();
  header.task = row.task;
  header.episode = row.episode;
  header.seed = row.seed;
  row.start_id = to_hex(header.start_id);
  row.episode_id = to_hex(header.episode_id);
  PROBE_ASSIGN(const std::string path, store.temporary_trace(key_of(row)));
  PROBE_ASSIGN(auto trace, TraceWriter::create(path, header));
  PROBE_TRY(trace->start(sample_start()));
  PROBE_TRY(trace->step(sample_step(1)));
  PROBE_ASSIGN(const Sha256 hash, trace->finish({1, row.metrics, row.invalid}));
  row.trace_sha256 = to_hex(hash);
  return store.commit(row, 0);
}

// What a stranger's hand does to results.sqlite.
inline void change_database(const std::string& dir, const std::string& sql) {
  sqlite3* database = nullptr;
  REQUIRE(sqlite3_open((dir + "/results.sqlite").c_str(), &database) == SQLITE_OK);
  CHECK(sqlite3_exec(database, sql.c_str(), nullptr, nullptr, nullptr) == SQLITE_OK);
  sqlite3_close(database);
}

}  // namespace probe::store
