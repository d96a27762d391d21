// Folders joined: each episode once, the better row, and refusal of what does not belong together.
#include "runtime/store/merge.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>

#include "runtime/base/check.h"
#include "runtime/base/file.h"
#include "runtime/policy/scripted.h"
#include "runtime/run/run.h"
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

MergeSummary must_merge(const MergeOptions& options) {
  const auto summary = merge(options);
  REQUIRE_MESSAGE(summary.ok(), to_text(summary.failure()));
  return *summary;
}

// All of a row but the place of its trace.
std::vector<ResultRow> rows_of(const std::string& dir) {
  const auto rows = read_results(dir);
  REQUIRE_MESSAGE(rows.ok(), to_text(rows.failure()));
  std::vector<ResultRow> all = *rows;
  for (ResultRow& row : all) {
    CHECK(fs::exists(row.trace));
    row.trace = "";
  }
  return all;
}

void make_invalid(const std::string& dir, const ResultRow& row) {
  PROBE_CHECK(fs::exists(row.trace), "a stored row has its trace");
  auto record = read_run_record(dir);
  auto store = Store::open(dir, *record, {});
  REQUIRE(store.ok());
  const auto trace = read_trace(row.trace);
  REQUIRE(trace.ok());
  auto writer = TraceWriter::create((*store)->temporary_trace(key_of(row)).value(), trace->header);
  REQUIRE((*writer)->start(*trace->start).ok());
  for (const TraceStep& step : trace->steps) REQUIRE((*writer)->step(step).ok());
  TraceEnd end = *trace->end;
  end.invalid = "policy: gone";
  ResultRow changed = row;
  changed.invalid = end.invalid;
  changed.trace_sha256 = to_hex((*writer)->finish(end).value());
  REQUIRE((*store)->commit(changed, 0).ok());
}

TEST_CASE("merged shards are a single run, in any order, once or twice") {
  TemporaryFolder folder;
  const plan::Plan plan = table_plan(4, 2);
  must_run(plan, options_for(folder / "single"));
  std::vector<std::string> shards;
  for (int shard = 1; shard <= 3; ++shard) {
    RunOptions options = options_for(folder / std::to_string(shard));
    options.shard = shard;
    options.shards = 3;
    options.video = shard == 1 ? VideoChoice::kAll : VideoChoice::kNone;
    must_run(plan, options);
    if (fs::exists(options.out)) shards.push_back(options.out);
  }
  REQUIRE(shards.size() > 1);
  const std::vector<ResultRow> expected = rows_of(folder / "single");
  REQUIRE(expected.size() == 8);

  std::vector<std::string> twice = shards;
  twice.push_back(shards[0] + "/");
  CHECK(must_merge({twice, folder / "merged"}).added == 8);
  CHECK(rows_of(folder / "merged") == expected);
  CHECK(read_run_record(folder / "merged")->seeds == read_run_record(folder / "single")->seeds);
  CHECK(fs::exists(folder / "merged/videos") == fs::exists(folder / "1/videos"));
  std::reverse(shards.begin(), shards.end());
  const MergeSummary again = must_merge({shards, folder / "merged"});
  CHECK(again.added == 0);
  CHECK(again.duplicates == 8);
  CHECK(rows_of(folder / "merged") == expected);
  // The single run overlaps all of them.
  shards.push_back(folder / "single");
  CHECK(must_merge({shards, folder / "all"}).duplicates == 8);
  CHECK(rows_of(folder / "all") == expected);
  // And the merged folder is a run that can be continued.
  RunOptions more = options_for(folder / "merged");
  const auto continued = run::run(plan, more);
  REQUIRE_MESSAGE(continued.ok(), to_text(continued.failure()));
  CHECK(continued->done == 0);
}

TEST_CASE(
    "rows that traces do not bear are left out by name, and a folder of nothing else is refused") {
  TemporaryFolder folder;
  const plan::Plan plan = table_plan(2, 2);
  for (const char* name : {"a", "b"}) must_run(plan, options_for(folder / name, "null"));
  const std::vector<ResultRow> rows = *read_results(folder / "a");
  fs::remove(rows[0].trace);
  change_database(folder / "b", "update episodes set metrics = replace(metrics, ',0', ',1')");
  const MergeSummary summary = must_merge({{folder / "a", folder / "b"}, folder / "ab"});
  CHECK(summary.rows == 1);
  CHECK(summary.left_out == 3);
  REQUIRE(summary.notes.size() == 3);
  CHECK(summary.notes[0].starts_with(to_text(key_of(rows[0])) + " is left out: "));
  const auto none = merge({{folder / "b"}, folder / "none"});
  REQUIRE_FALSE(none.ok());
  CHECK(none.failure().message.starts_with("no row of these folders is shown by its trace: "));
  CHECK_FALSE(fs::exists(folder / "none"));
}

TEST_CASE(
    "a folder whose plan is not that of its record is not merged, and run puts the plan back") {
  TemporaryFolder folder;
  const plan::Plan plan = table_plan(2, 2), other = table_plan(2, 3);
  for (const char* name : {"a", "b"}) must_run(plan, options_for(folder / name, "null"));
  const auto swap = [&](std::span<const std::byte> bytes) {
    REQUIRE(write_file(plan_path(folder / "b"), bytes).ok());
  };
  const auto refusal = [&] {
    const auto merged = merge({{folder / "a", folder / "b"}, folder / "ab"});
    REQUIRE_FALSE(merged.ok());
    CHECK(merged.failure().where == plan_path(folder / "b"));
    CHECK_FALSE(fs::exists(folder / "ab"));
    return merged.failure().message;
  };
  swap(other.bytes());
  CHECK(refusal().starts_with("is not the plan of this run (root "));
  swap({});
  CHECK(refusal().starts_with("the plan of this run cannot be read: "));
  fs::remove(plan_path(folder / "b"));
  CHECK(refusal().starts_with("the plan of this run cannot be read: "));
  must_run(plan, options_for(folder / "b", "null"));
  CHECK(must_merge({{folder / "a", folder / "b"}, folder / "ab"}).rows == 2);
}

TEST_CASE(
    "a shard that was cut off as it began is left out with a note, and all of them are no run") {
  TemporaryFolder folder;
  RunOptions options = options_for(folder / "begun");
  options.policy = "null";
  REQUIRE(run::run(table_plan(2, 3), options).ok());
  const std::string empty = folder / "empty";
  fs::create_directories(empty);
  std::ofstream(empty + "/results.sqlite").flush();
  const MergeSummary merged = must_merge({{empty, options.out}, folder / "all"});
  CHECK(merged.added == 2);
  CHECK(merged.notes ==
        std::vector<std::string>{empty + " has no rows: its run was cut off as it began"});
  const auto none = merge({{empty}, folder / "none"});
  REQUIRE_FALSE(none.ok());
  CHECK(none.failure().message == "none of these folders has a run that began");
  const auto absent = merge({{options.out, folder / "absent"}, folder / "none"});
  CHECK_FALSE(absent.ok());
}

TEST_CASE("a valid row wins over an invalid one wherever it stands, and damage counts as absent") {
  TemporaryFolder folder;
  const plan::Plan plan = table_plan(2, 2);
  for (const char* name : {"a", "b"}) must_run(plan, options_for(folder / name, "null"));
  const std::vector<ResultRow> expected = rows_of(folder / "a");
  make_invalid(folder / "a", read_results(folder / "a")->at(0));
  make_invalid(folder / "b", read_results(folder / "b")->at(1));
  must_merge({{folder / "a", folder / "b"}, folder / "ab"});
  CHECK(rows_of(folder / "ab") == expected);
  // Into a folder that is one of them.
  must_merge({{folder / "a", folder / "b"}, folder / "a"});
  CHECK(rows_of(folder / "a") == expected);

  fs::resize_file(read_results(folder / "b")->at(0).trace, 100);
  const MergeSummary half = must_merge({{folder / "b"}, folder / "half"});
  CHECK(half.rows == 1);
  CHECK(half.invalid == 1);
  REQUIRE(half.notes.size() == 1);
  CHECK(half.notes[0].starts_with("carrot_on_plate episode 0 seed 42 is left out: "));
}

TEST_CASE("what was shown of a server goes with its rows, once, and must be the same everywhere") {
  TemporaryFolder folder;
  const plan::Plan plan = table_plan(2, 2);
  const auto part = [&](const std::string& name, int start, const policy::Reading& reading) {
    RunOptions options = options_for(folder / name, "null");
    options.episodes = {start, start};
    must_run(plan, options);
    const RunRecord record = *read_run_record(folder / name);
    auto store = Store::open(folder / name, record, plan.bytes());
    REQUIRE(store.ok());
    RunCall call;
    call.fingerprint = record.fingerprint;
    call.reading = reading;
    REQUIRE((*store)->add_call(call).ok());
  };
  policy::Reading shown{.server = "gpu:443", .answers = 3, .answers_sha256 = "ab"};
  shown.measured = {{"action.form", "delta"}};
  policy::Reading unchecked = shown;
  unchecked.is_unchecked = true;
  part("a", 0, unchecked);
  part("b", 1, shown);
  for (int times = 0; times < 2; ++times) {
    must_merge({{folder / "a", folder / "b"}, folder / "ab"});
    const auto calls = read_run_calls(folder / "ab");
    REQUIRE(calls.ok());
    const auto readings =
        std::ranges::count_if(*calls, [](const RunCall& call) { return call.reading.has_value(); });
    CHECK(readings == 2);
    CHECK(std::ranges::any_of(
        *calls, [](const RunCall& call) { return call.reading && call.reading->is_unchecked; }));
  }
  // Another policy is refused, as a run refuses to go on with it; only the user knows that another
  // machine rounds otherwise.
  policy::Reading steady = shown;
  steady.questions_sha256 = "cd";
  steady.is_steady = true;
  part("d", 0, steady);
  steady.answers_sha256 = "ef";
  part("e", 1, steady);
  const auto exchanged = merge({{folder / "d", folder / "e"}, folder / "de"});
  REQUIRE_FALSE(exchanged.ok());
  CHECK(exchanged.failure().where == folder / "e");
  CHECK(exchanged.failure().message.find("answered the first questions otherwise") !=
        std::string::npos);
  MergeOptions mixed{{folder / "d", folder / "e"}, folder / "de"};
  mixed.mixed_builds = true;
  must_merge(mixed);
  const auto summary = summarize_readings(*read_run_calls(folder / "de"));
  CHECK(summary.good == "");
  REQUIRE(summary.findings.size() == 1);
  CHECK(summary.findings[0].find("more than one policy, or machines that round otherwise") !=
        std::string::npos);
  shown.measured = {{"action.form", "absolute"}};
  part("c", 1, shown);
  const auto other = merge({{folder / "a", folder / "c"}, folder / "ac"});
  REQUIRE_FALSE(other.ok());
  CHECK(other.failure().where == folder / "c");
  CHECK(other.failure().message.find("showed other units, forms or rotations") !=
        std::string::npos);
}

TEST_CASE(
    "rows of a shard that wait to be shown the work of one policy wait in the merged folder, too") {
  TemporaryFolder folder;
  const plan::Plan plan = table_plan(2, 2);
  for (const int start : {0, 1}) {
    RunOptions options = options_for(folder / std::to_string(start), "null");
    options.episodes = {start, start};
    must_run(plan, options);
  }
  const std::vector<ResultRow> rows = rows_of(folder / "1");
  REQUIRE_FALSE(rows.empty());
  {
    auto store = Store::open(folder / "1", *read_run_record(folder / "1"), plan.bytes());
    REQUIRE(store.ok());
    REQUIRE((*store)->doubt({key_of(rows.front())}).ok());
  }
  must_merge({{folder / "0", folder / "1"}, folder / "all"});
  CHECK(read_unproven(folder / "all").value() == std::vector{key_of(rows.front())});
}

TEST_CASE("what does not belong together is refused before anything is written") {
  TemporaryFolder folder;
  const plan::Plan plan = table_plan(1, 2);
  const auto named = [&](const std::string& name, const std::string& policy) {
    RunOptions options = options_for(folder / name, policy);
    options.name = "mine";
    return options;
  };
  must_run(plan, named("a", "null"));
  must_run(table_plan(1, 3), named("plan", "null"));
  // The same policy by all that the record says, with other actions.
  RunOptions other_actions = named("trace", "null");
  PolicyTraits same;
  same.content = "policy null";
  other_actions.own_policy =
      OwnPolicy{same, [](const PolicyContext&) -> Result<std::unique_ptr<policy::Policy>> {
                  return policy::make_random();
                }};
  must_run(plan, other_actions);
  must_run(plan, named("content", "reach"));
  must_run(plan, options_for(folder / "policy", "reach"));
  const auto refusal = [&](const std::string& other, const std::string& first = "a") {
    const auto merged = merge({{folder / first, folder / other}, folder / "out"});
    REQUIRE_FALSE(merged.ok());
    CHECK_FALSE(fs::exists(folder / "out"));
    CHECK(merged.failure().where == folder / other);
    return merged.failure().message;
  };
  CHECK(refusal("plan").starts_with("holds a run of another plan (root "));
  CHECK(refusal("policy").starts_with("holds a run of policy `reach`, not `mine`, as " +
                                      (folder / "a") + " does"));
  CHECK(refusal("content").starts_with(
      "was begun with another policy (recorded policy reach, now policy null) than "));
  CHECK(refusal("trace").starts_with("carrot_on_plate episode 0 seed 42 has the trace "));
  CHECK(refusal("nothing").starts_with("cannot be merged: no run here"));

  RunRecord record = *read_run_record(folder / "a");
  record.fingerprint = {{{"program", "another"}}};
  REQUIRE(Store::open(folder / "build", record, plan.bytes()).ok());
  CHECK(refusal("build").find("; their bits may differ; --mixed-builds joins them all the same") !=
        std::string::npos);
  const MergeSummary mixed = must_merge({{folder / "a", folder / "build"}, folder / "mixed", true});
  CHECK(mixed.rows == 1);
  REQUIRE(mixed.notes.size() == 1);
  CHECK(mixed.notes[0].starts_with((folder / "build") + " was begun by another build"));
  must_run(plan, options_for(folder / "served", "null"));
  record = *read_run_record(folder / "served");
  record.identity.policy_content = "profile b";
  REQUIRE(Store::open(folder / "profile", record, plan.bytes()).ok());
  CHECK(refusal("profile", "served")
            .starts_with("was begun with another profile (recorded profile b, "));
}

}  // namespace
}  // namespace probe::store
