// What a run's folder says of the run as a whole: of which plan and policy it is, by which build,
// and what each call of `run` did. Texts in, texts out; knows no files.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/policy/query_meter.h"
#include "runtime/policy/reading.h"
#include "runtime/store/fingerprint.h"

namespace probe::store {

// Raised when the tables or the record change. Version 1 had neither `policy_content` nor calls nor
// the hashes of what was sent; it is read, and raised to 2 when it is written. A live run's record
// is of version 3, which programs that know no live runs refuse; that of a folder of successes alone
// of version 4, which programs refuse that would take it for a policy that never fails; that of a run
// that stops by what it finds of version 5, which programs refuse whose intervals and tests would be
// wrong for it.
inline constexpr int kSchemaVersion = 2;
inline constexpr int kLiveSchemaVersion = 3;
inline constexpr int kSelectedSchemaVersion = 4;
inline constexpr int kAdaptiveSchemaVersion = 5;

// How the content of a policy in this process begins whose rows call it otherwise.
inline constexpr std::string_view kOwnPolicy = "policy ";

// What must not change between two calls that write into one folder.
// RunIdentity::until of a run whose episodes a search chose while results came in: no rule that
// rates could be told by.
inline constexpr std::string_view kBySearch = "chosen by a search";

struct RunIdentity {
  std::string plan_root;  // hex
  std::string policy;
  // What the name alone does not say: PolicyTraits::content, or, behind kOwnPolicy, which policy
  // goes by another name.
  std::string policy_content = "";
  // Of a world that does not wait for its policy: to_text of its policy::LiveTerms. Empty: it
  // waits.
  std::string live = "";
  // Only episodes that succeeded are stored (`vlaprobe demos`): of what was done nothing can be
  // told from them.
  bool only_success = false;
  // How many episodes are run depends on how they end: to_text of its adaptive::Rule. Empty: all that
  // were chosen are run. Only the beginning of its order (Store::freeze_order) counts.
  std::string until = "";
  bool operator==(const RunIdentity&) const = default;
};

// How `until` ends where each task stops by itself, so that its order is its own.
inline constexpr std::string_view kOfEachTask = "of each task";

struct RunRecord {
  RunIdentity identity;
  std::string suite;
  std::vector<int> seeds;
  Fingerprint fingerprint;  // of the call that made the folder
  int schema = kSchemaVersion;
  // Where that call had its assets from, absolute; none: they were found by themselves. A hint for
  // who reads the run: whether the files are the plan's is seen from their bytes.
  std::vector<std::string> asset_folders = {};
};

// What is said of a folder with `RunIdentity::only_success` in place of a rate.
inline constexpr std::string_view kSuccessesAlone =
    "holds successes alone, as `vlaprobe demos` keeps them: how often its policy succeeds cannot "
    "be told";

std::string record_to_text(const RunRecord& record);
// Fails (kStore, at `where`) naming the key that is missing or of another type, and on a
// schema that this program does not know.
Result<RunRecord> record_from_text(const std::string& text, const std::string& where);

// The kinds of change between the record of a folder and a new call, as sentences without the
// folder's name ("holds a run of policy `a`, not `b`"), empty where equal. A folder cannot be
// continued over `identity`, which is another plan or policy; it can be over the others, if the
// user wants that.
struct RunChanges {
  std::string identity, policy_content, build;
  bool any() const { return !identity.empty() || !policy_content.empty() || !build.empty(); }
};
RunChanges changes_between(const RunRecord& stored, const RunRecord& asked);

// One call of `run`, as far as it got: what it did is known when it `ended` by itself.
struct RunCall {
  Fingerprint fingerprint;
  int worlds = 1;
  bool ended = false;
  int episodes = 0;               // stored
  int retried = 0;                // attempts that a policy's failure spoiled and that were repeated
  std::int64_t observations = 0;  // of all attempts
  double elapsed_s = 0;           // of the episodes, without what comes before the first
  policy::QueryFigures queries;
  std::optional<policy::Reading> reading = {};  // of a policy server; not of older programs' calls
};

// "212.0 observations/s; ..., with shares of busy server and waiting worlds where there was a
// server".
std::string to_text(const RunCall& call);

// What the questions at the beginning of a folder's calls showed of its policy server.
struct ReadingSummary {
  std::vector<std::string> findings;  // each sentence once
  int proven = 0;                     // calls whose policy read pictures and instructions
  // "other words and other pictures had other answers", where that was asked and nothing is wrong.
  std::string good;
  std::vector<std::string> batches;  // what was shown of batches, each sentence once
  bool is_unchecked = false;         // a call had --insecure
};
// `unproven` is how many rows wait to be shown, see Store::unproven().
ReadingSummary summarize_readings(const std::vector<RunCall>& calls, std::size_t unproven = 0);

// What the questions at a call's beginning show that was otherwise in calls before it.
struct ReadingChanges {
  bool measured = false;  // units, forms or rotations, where the profile leaves them open
  bool policy = false;    // another one answers
};
ReadingChanges changes_between(const std::vector<RunCall>& before, const policy::Reading& now);

std::string call_to_json(const RunCall& call);
Result<RunCall> call_from_json(const std::string& text, const std::string& where);

}  // namespace probe::store
