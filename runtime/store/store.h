// A run's folder: results.sqlite, traces/, suite.plan, lock. Rows and traces are committed
// together: a trace gets its final name before its row is written, and a row without its own trace
// counts as absent.
#pragma once

#include <algorithm>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/store/episode_key.h"
#include "runtime/store/results.h"
#include "runtime/store/run_record.h"

namespace probe::store {

// What has been stored of an episode.
struct StoredEpisode {
  EpisodeKey key;
  bool valid = false;  // an invalid one is run again, and so is one whose trace is not its own
  std::string why;     // it is not valid
  bool success = false;  // of a valid one: its metric of that name
};

// An episode at its place in the order of a run that stops by what it finds.
struct OrderedEpisode {
  EpisodeKey key;
  // Of a rule that compares with another run: whether that one succeeded.
  std::optional<bool> other = {};
  bool operator==(const OrderedEpisode&) const = default;
};

// One process writes a folder at a time. Any thread may call any method at any time once episodes()
// has been asked.
class Store {
 public:
  // Makes the folder or continues it, whatever the build. Fails (kStore) when the folder
  // cannot be written, another process writes it, or it holds a run of another identity; the
  // message says which part differs.
  static Result<std::unique_ptr<Store>> open(const std::string& dir, const RunRecord& record,
                                             std::span<const std::byte> plan_bytes);
  virtual ~Store() = default;

  // The record that the folder was made with.
  virtual const RunRecord& record() const = 0;
  // Reads every stored trace to see that it is whole and its row's.
  virtual Result<std::vector<StoredEpisode>> episodes() = 0;

  // Where the trace of this episode is to be written before commit(); makes its folder.
  virtual Result<std::string> temporary_trace(const EpisodeKey& key) const = 0;
  // Renames the temporary trace, whose bytes are on the disk, and writes the row, replacing an
  // invalid one. `task_order` sorts rows.
  virtual Status commit(const ResultRow& row, int task_order) = 0;

  // Of several, whose temporary traces need not be on the disk yet: waited for together, the rows in
  // one transaction. A kill leaves all or none of the rows.
  struct Finished {
    ResultRow row;
    int task_order = 0;
  };
  virtual Status commit(std::span<const Finished> finished) = 0;

  // From now on commit() also notes that who answered the row's policy questions was not shown.
  virtual Status note_unproven() = 0;
  // Notes rows so that came from another folder.
  virtual Status doubt(const std::vector<EpisodeKey>& keys) = 0;
  // Valid rows that were noted so, by this call or one before it, since the last forget_unproven().
  virtual Result<std::vector<EpisodeKey>> unproven() = 0;
  // For when one policy was shown to have answered all that is stored, or these rows.
  virtual Status forget_unproven() = 0;
  virtual Status forget_unproven(const std::vector<EpisodeKey>& rows) = 0;

  // How the reasons end with which valid rows are made invalid: no trace holds them, so that
  // read_stored_trace believes these beside a trace that ended well, and no others.
  static constexpr std::string_view kMixedUp =
      "the questions of a batch were taken for one another later";
  static constexpr std::string_view kExchanged =
      "another policy answered when the call ended than when it began";
  static constexpr std::string_view kOutOfStep =
      "an answer that nothing asked for was found when the next episode began";
  static constexpr std::string_view kNeverShown =
      "that one policy answered the call to its end was never shown, and another answers now";
  static constexpr std::string_view kLaterReasons[] = {kMixedUp, kExchanged, kOutOfStep,
                                                       kNeverShown};
  static bool is_later_reason(std::string_view reason) {
    return std::ranges::any_of(kLaterReasons, [&](auto one) { return reason.ends_with(one); });
  }
  // Makes rows that are valid invalid, for one of these reasons, all of them or none; their traces
  // stay, and they are run again as all that are invalid.
  virtual Status invalidate(const std::vector<EpisodeKey>& keys, const std::string& reason) = 0;

  // The order in which the episodes of a run with RunIdentity::until are taken, for good: fails
  // (kStore) where the folder has another.
  virtual Status freeze_order(std::span<const OrderedEpisode> order) = 0;
  // In the place of what is there: what several folders have together.
  virtual Status set_order(std::span<const OrderedEpisode> order) = 0;
  // The run is like any other from now on: for when all of its order has a row.
  virtual Status forget_until() = 0;

  // What this call of `run` has done so far; each write replaces the one before.
  virtual Status write_call(const RunCall& call) = 0;
  // A call of another folder, whose rows come here.
  virtual Status add_call(const RunCall& call) = 0;
};

// Nothing when no run was begun in `dir`; fails (kStore) on one that cannot be read.
Result<std::optional<RunRecord>> find_run_record(const std::string& dir);
// All calls that wrote into `dir`, oldest first.
Result<std::vector<RunCall>> read_run_calls(const std::string& dir);
// Valid rows in `dir` of which it is not shown that one policy gave their answers: the next call of
// `run` asks.
Result<std::vector<EpisodeKey>> read_unproven(const std::string& dir);
// What is shown of the policy server of the run in `dir`.
Result<ReadingSummary> read_reading_summary(const std::string& dir);
// The order of the run in `dir`; none where it is no run that stops by what it finds.
Result<std::vector<OrderedEpisode>> read_order(const std::string& dir);
// The run in `dir`, for readers; fails (kStore) if there is none.
Result<RunRecord> read_run_record(const std::string& dir);
std::string plan_path(const std::string& dir);
std::string trace_path(const std::string& dir, const EpisodeKey& key);
std::string video_path(const std::string& dir, const EpisodeKey& key);

}  // namespace probe::store
