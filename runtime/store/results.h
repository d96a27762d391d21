// Rows of results: one object per episode, as `vlaprobe results` prints them and the store keeps
// them.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/base/result.h"

namespace probe::store {

struct MetricValue {
  std::string name;
  bool is_bool = true;
  double value = 0;  // a truth is 0 or 1
  bool operator==(const MetricValue&) const = default;
};

struct JointValue {
  std::string name;  // "cabinet.top"
  double position = 0;
  bool operator==(const JointValue&) const = default;
};

struct ResultRow {
  std::string task;  // the plan's name, without a suite's prefix
  int episode = 0;
  int seed = 0;
  std::string policy;
  std::vector<MetricValue> metrics;    // in the plan's order; of no meaning when invalid
  int steps = 0;                       // control steps done
  std::optional<std::string> invalid;  // why the episode counts neither as success nor as failure
  std::string prompt_sha256;           // of the instruction's bytes
  std::string image_sha256;            // of the first picture's RGB bytes
  std::string frames_sha256;  // of the concatenated hashes of all pictures shown to the policy
  // Of what the first request to a policy server carried; none for a policy in this process.
  std::optional<std::string> sent_prompt_sha256, sent_image_sha256;
  std::string trace_sha256;  // of the trace's content without timing
  std::string episode_id, start_id;
  std::string trace;  // path of the trace; read_results gives an absolute one
  // What the policy, one of ours, says kept it from doing what it meant to: "skill 1 `open
  // cabinet.top_drawer`: ...". None of what it did, and of other policies.
  std::optional<std::string> remark = {};
  // Of read_proven_results, control steps: before the policy's first, and until an action acts.
  int idle = 0, delay = 0;
  // Of read_proven_results: where the joints of the scene's fixtures were at the end, m or rad.
  std::vector<JointValue> joints = {};
  // Of read_proven_results, of a task whose instruction changes: the steps, from 1, in which each
  // later sentence was said first; as many as came.
  std::optional<std::vector<int>> told_at = {};
  // RunIdentity::live of its run; empty in one whose world waits. Of read_results.
  std::string live = {};
  // RunIdentity::only_success of its run. Of read_results.
  bool only_success = false;
  // RunIdentity::until of its run. Of read_results.
  std::string until = "";
  bool operator==(const ResultRow&) const = default;
};

// The rows stored in `dir`, ascending by the plan's task order, episode and seed. Fails
// (kStore) if there is no run in `dir`.
Result<std::vector<ResultRow>> read_results(const std::string& dir);

// The same rows one by one, so that a million of them need no memory. What `visit` fails with ends
// it.
using RowVisitor = std::function<Status(ResultRow&&)>;
Status for_each_row(const std::string& dir, const RowVisitor& visit);
// Those of one episode, ascending by seed; nobody reads the others for them.
Result<std::vector<ResultRow>> read_episode(const std::string& dir, const std::string& task,
                                            int episode);
// The tasks that have rows, in the plan's order.
Result<std::vector<std::string>> read_stored_tasks(const std::string& dir);
// How many there are.
Result<std::size_t> count_rows(const std::string& dir);

// A JSON array of objects with exactly the documented keys; metrics of an invalid episode are null.
// Behind `trace` stand, where there is something to say, `live`, `only_success` (true where the run
// stored no other episodes), `until` (what a run stops by, so that how many rows there are depends on
// them), `remark`, `idle` and `delay`
// (control steps), `told_at` (steps, from 1, in which the instruction changed) and `joints`, an object.
std::string results_to_json(std::span<const ResultRow> rows);
// The same as comma-separated values with a header line; truths as true/false. What some rows have
// to say has a column, and each joint one: `joint.cabinet.top`.
std::string results_to_csv(std::span<const ResultRow> rows);

// The same texts in pieces, of rows that are not all there at once: what stands in them has to be
// known before the first.
class RowTexts {
 public:
  void know(const ResultRow& row);  // of every row, before the first piece
  // Before the rows, each row with what divides it from the one before, and behind them.
  std::string json_begin() const;
  std::string json(const ResultRow& row);
  std::string json_end() const;
  std::string csv_begin() const;
  std::string csv(const ResultRow& row) const;

 private:
  std::vector<std::string> metrics_, joints_;  // in order of first use
  std::vector<bool> rare_;                     // some row has something to say
  bool is_first_ = true;
};

}  // namespace probe::store
