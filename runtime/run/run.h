// `vlaprobe run`: every chosen episode of a plan, once, in parallel worlds, into a folder that a
// later call with the same arguments continues. Traces and rows do not depend on the number of
// jobs, on order or on interruptions. What cannot work is refused before the folder is made; a
// shard without an episode makes none.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "runtime/adaptive/rule.h"
#include "runtime/base/asset_root.h"
#include "runtime/base/result.h"
#include "runtime/policy/live.h"
#include "runtime/run/policies.h"
#include "runtime/store/not_attempted.h"
#include "runtime/store/results.h"
#include "runtime/store/run_record.h"

namespace probe::plan {
class Plan;
}

namespace probe::run {

struct EpisodeJob;

enum class VideoChoice { kNone, kFailures, kAll };

// What to do with a folder that was begun with another plan, policy, profile or build.
enum class IfChanged {
  kRefuse,    // fail and say what differs
  kFork,      // write into the folder of the same name with -2, -3, ... that fits or is free
  kContinue,  // mix builds and profiles; another plan or policy is refused all the same
};

// A policy that is not in the factory's table; for tests and benches.
struct OwnPolicy {
  run::PolicyTraits traits;
  std::function<Result<std::unique_ptr<policy::Policy>>(const run::PolicyContext&)> make;
};

struct RunProgress {
  int done = 0;                           // episodes finished by this call
  int skipped = 0;                        // found valid in the folder
  int total = 0;                          // chosen episodes; at most, of a run that stops by itself
  const store::ResultRow* row = nullptr;  // the one just committed; null for the first report
  bool is_at_most = false;                // how many are run depends on how they end
};

struct RunOptions {
  std::string policy;       // "expert", "noisy:0.01", ...
  std::string name;         // what folder and rows call it; empty: as `policy`
  std::string out;          // folder, made if absent
  std::string suite;        // empty: the plan's first suite, or all tasks if it has none
  std::string tasks = "*";  // glob over task names, with or without the suite's prefix: * and ?
  bool originals = false;   // of these only tasks that are no variant of another
  std::optional<std::pair<int, int>> episodes;  // first and last index, both included
  // Empty: the suite's seeds; and if the policy draws nothing (every seed would repeat the same
  // episode), only the first of them. Seeds given here are always run.
  std::vector<int> seeds;
  int jobs = 1;               // worlds in parallel, one thread each
  int shard = 1, shards = 1;  // this call's share, see shard_of()
  // A policy server's failures: an episode they spoil is tried that often again in this call, and
  // the call stops when that many episodes in a row were lost all the same (0: never).
  int retries = 2;
  int give_up_after = 5;
  bool accepts_any_certificate = false;  // of a server over TLS; stored and reported
  IfChanged if_changed = IfChanged::kRefuse;
  // The world does not wait for the policy; see policy/live.h. None: it does.
  std::optional<policy::LiveTerms> live = {};
  // Valid episodes that did not succeed are not stored; a later call does them again.
  bool only_success = false;
  // Stops by what it finds: see runtime/adaptive. Of `decided-against` the folder alone is given.
  std::optional<adaptive::Rule> until = {};
  // The folder's rule is dropped: all that it left is run, and when every episode has a row the
  // folder is like any other.
  bool drops_until = false;
  VideoChoice video = VideoChoice::kNone;  // DIR/videos/TASK/EPISODE-SEED.mp4
  AssetRoot assets;                        // empty: found by itself
  // Called from worker threads, one call at a time.
  std::function<void(const RunProgress&)> progress;
  // Asked before and behind each episode, by any worker: true ends the call (kUsage). The episodes
  // behind which it was true are not stored; the same call continues with them.
  std::function<bool()> stopped = {};
  std::optional<OwnPolicy> own_policy;  // acts in place of `policy`, which then is only a name
  // Who chooses episodes as results come in, in place of suite, tasks, episodes, seeds and shard:
  // asked for the first and, whenever all that it chose have ended, for the next; none ends the
  // call. Episodes that the folder holds already are not run again. Its failure ends the call, too.
  std::function<Result<std::vector<EpisodeJob>>()> next = {};
};

// "width 10%", "width 5% of all", "decided-against DIR", "none": when a run stops early, as
// `until` or `drops_until` of `options`. Fails (kUsage) on other words.
Status set_until(const std::string& words, RunOptions& options);

struct RunSummary {
  int total = 0, done = 0, skipped = 0, invalid = 0;
  int not_kept = 0;                   // no success, where only successes are stored
  store::NotAttempted not_attempted;  // not among the invalid
  std::vector<std::string> notes;     // sentences for stderr, such as why seeds were dropped
  std::vector<std::string> until;     // lines about a run that stops by itself: what is known of it
  std::string out;                    // the folder that was written
  store::RunCall call;                // speed, and how busy server and simulators were
};

// Who acts, in each of a run's worlds.
struct Actor {
  run::PolicyTraits traits;
  std::shared_ptr<const servers::ServerChoice> server;  // none: in this process
  std::function<Result<std::unique_ptr<policy::Policy>>(const run::PolicyContext&)> make;
};

// Of `options.own_policy` or `options.policy`. Fails (kUsage) where no run could be: an unknown
// policy, worlds that a server cannot tell apart, terms of a live world that it cannot keep.
Result<Actor> choose_actor(const RunOptions& options);

// In: a verified plan and what to do with it. Out: the folder, and what to tell of it. The order:
// all that can be refused before there is a folder (policy, selection, assets); the folder and its
// record; which of its episodes are done; the questions of a policy server (servers/reading.h); the
// other episodes, by workers, each committed when it ends; whether what makes tasks different
// reached the policy. Fails with kPolicy when it gave up on a policy server; what was done until
// then is stored.
Result<RunSummary> run(const plan::Plan& plan, const RunOptions& options);

}  // namespace probe::run
