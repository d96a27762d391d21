// `vlaprobe ask`: every chosen question about every chosen start, once, into a folder that a later
// call with the same arguments continues. Rows do not depend on the number of jobs, on order or on
// interruptions, but for what a server answers. What cannot work is refused before the folder is
// made; a shard without a question makes none.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "runtime/ask/reading/answer_row.h"
#include "runtime/ask/ask_record.h"
#include "runtime/ask/models.h"
#include "runtime/ask/queries.h"
#include "runtime/base/asset_root.h"
#include "runtime/base/result.h"
#include "runtime/run/run.h"

namespace probe::plan {
class Plan;
}

namespace probe::ask {

// A model that is not in the table: a caller's.
struct OwnModel {
  ModelTraits traits;
  std::function<Result<std::unique_ptr<Model>>()> make;  // one for each asking thread
  // Whether the traits' content says which one it is. Else a name is all that is known, and it has
  // to show that it is the one that a folder was begun with.
  bool is_vouched_for = false;
};

struct AskProgress {
  std::int64_t done = 0;           // answered by this call
  std::int64_t skipped = 0;        // found valid in the folder, or left out
  std::int64_t total = 0;          // chosen
  const AnswerRow* row = nullptr;  // the one that just came; null for the first report
};

struct AskOptions {
  std::string model;   // "truth", "openai://HOST:PORT?model=NAME", ...
  std::string name;    // what folder and rows call it; empty: the model's own
  std::string out;     // folder, made if absent
  QueryChoice choice;  // but for `recorded`, which comes from `frames`
  std::string frames;  // folder of the run whose ends are asked about; empty: none
  int jobs = 1;        // questions at the server at a time, one thread each
  // A server's failures: a question they spoil is asked that often again in this call, and the call
  // stops when that many questions in a row were lost all the same (0: never).
  int retries = 2;
  int give_up_after = 5;
  bool accepts_any_certificate = false;  // of a server over TLS; stored and reported
  run::IfChanged if_changed = run::IfChanged::kRefuse;
  AssetRoot assets;  // empty: found by itself
  // Called from asking threads, one call at a time.
  std::function<void(const AskProgress&)> progress;
  // Asked now and then, from a thread of the call's: true ends it once the questions that are at
  // the model are answered, which is stored.
  std::function<bool()> stopped;
  std::optional<OwnModel> own_model;  // answers in place of `model`, which then is only a name
};

struct AskSummary {
  std::int64_t total = 0, done = 0, skipped = 0, invalid = 0;
  std::int64_t right = 0;     // of those done
  std::int64_t left_out = 0;  // queries that were not asked of their picture, in the folder's scope
  std::vector<std::string> notes;  // sentences for stderr
  std::string out;                 // the folder that was written
  AskCall call;
};

// The recorded episodes of the run in `dir` that `plan` has, for QueryChoice::recorded. Fails as
// store::read_proven_results does.
Result<std::vector<RecordedEnd>> recorded_ends(const plan::Plan& plan, const std::string& dir);

// In: a verified plan and what to do with it. Out: the folder, and what to tell of it. The order:
// all that can be refused before there is a folder (model, selection, run, assets); the folder and
// its record; which questions are answered; the proof that a server reads; then looks by threads
// that draw and queries by threads that ask. Fails with kPolicy when it gave up on a server or was
// stopped; what was answered until then is stored.
Result<AskSummary> ask(const plan::Plan& plan, const AskOptions& options);

}  // namespace probe::ask
