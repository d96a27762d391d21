// One of a run's worlds: a stage and a policy of its own, and episode after episode on them.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "runtime/adaptive/outcome.h"
#include "runtime/run/episode.h"
#include "runtime/run/run.h"
#include "runtime/stage/assets.h"
#include "runtime/store/store.h"

namespace probe::run {

// What all workers read, and what they write one at a time.
struct WorkersShared {
  const plan::Plan& plan;
  const RunOptions& options;
  const Actor& actor;
  std::shared_ptr<const stage::SharedAssets> assets;
  std::string fingerprint;
  std::vector<EpisodeJob> jobs;
  store::Store& store;
  RunSummary& summary;
  policy::QueryMeter& queries;
  std::shared_ptr<servers::SharedModel> model;  // of all connections to a server
  std::shared_ptr<servers::SharedLine> line;    // of all worlds, where they ask in batches
  std::shared_ptr<servers::Identity> identity;  // whom the call began with; none: no server
  std::vector<std::pair<std::string, std::string>> measured;
  // Hears of every episode that was stored, and again of one that is made invalid later.
  std::function<void(const store::EpisodeKey&, adaptive::Outcome)> ended = {};
  std::mutex mutex = {};  // summary, progress and what follows
  int lost_in_a_row = 0;  // episodes that a policy server's failures spoiled for good
  std::atomic<bool> given_up = false;
};

// Whether a policy that was to act did not do what the task asks.
bool has_failed(const store::ResultRow& row);

// Used by one thread.
class EpisodeWorker {
 public:
  explicit EpisodeWorker(WorkersShared& shared) : shared_(shared) {}

  // Makes the policy.
  Status begin();
  // Runs job `index`, as often as the options allow where a policy server spoils it, and commits
  // its row. Fails where the call is to end: the server is given up, or another policy answers.
  Status run(std::size_t index);

 private:
  Result<Played> write(const EpisodeJob& job, const store::TraceHeader& header,
                       const std::string& path);
  bool is_spoiled(const Played& played) const;
  Status spoil_last();
  bool is_exchanged() const;
  bool is_stopped() const { return shared_.options.stopped && shared_.options.stopped(); }
  Status commit(const Played& played, int task_order);
  Status drop(const Played& played, const std::string& path);
  Failure give_up(const std::string& last) const;

  WorkersShared& shared_;
  std::unique_ptr<policy::Policy> policy_;
  std::unique_ptr<stage::Stage> stage_;
  std::optional<store::EpisodeKey> last_valid_;  // that was stored, where nothing came after it
};

}  // namespace probe::run
