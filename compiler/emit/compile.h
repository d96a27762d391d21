// The compiler as one call: .probe files to diagnostics and the bytes of a plan.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/diag/diagnostic.h"
#include "compiler/source/source.h"
#include "runtime/base/asset_root.h"
#include "runtime/base/result.h"
#include "runtime/base/sha256.h"
#include "runtime/plan/format.h"

namespace probe {

// Whether a file of the assets is good: `path` relative to `folder`, and the hash of its bytes.
using AssetInspector = std::function<Status(const std::string& folder, const std::string& path,
                                            plan::AssetKind kind, const Sha256& hash)>;

// Who looks at plans that nobody keeps: of programs without mistakes that have at most so many
// starts. Their ids are computed once, and not once more to be sure of them.
struct PlanTaker {
  std::function<void(std::vector<std::byte>)> take = {};  // none: no plan is made
  std::size_t most_starts = 0;
  // What was taken: called by who compiles all of it again.
  std::function<void()> forget = {};
};

struct CompileOptions {
  // What lies beside the texts is looked for, too.
  AssetRoot asset_root;
  std::string suite = {};  // the one suite to compile; "" = all
  // Where a `use` is looked up when the file is not beside its user: folders that hold `std/`.
  std::vector<std::string> library_folders = {};
  AssetInspector inspect_asset = {};  // none: files are only looked for
  // What an editor holds and has not saved, in place of files: by lexically normal path.
  std::map<std::string, std::string> unsaved = {};
  const std::atomic<bool>* stop = nullptr;  // once it is true, the answer is not wanted any more
  // The tasks to keep, by name; none: all. For assets that do not serve every task.
  std::function<bool(std::string_view)> wants_task = {};
  bool wants_unheld = false;  // Compilation::unheld
  PlanTaker plans = {};       // of check()
};

// Words of a task's instruction and the object that they mean.
struct ReferringWords {
  std::string task, words, object;
  bool is_phrase = false;  // a phrase of the object; else its name
};

// Words of an instruction that are held to nothing that success measures, and why.
struct UnheldWords {
  std::string task, words, why;
};

// A task that takes some of its layout's starts, those in which phrases are clear.
struct ChosenStarts {
  std::string task;
  std::size_t starts = 0, of = 0;
};

struct Compilation {
  SourceSet sources;
  Diagnostics diagnostics;
  bool ok = false;              // no errors
  std::vector<std::byte> plan;  // empty unless ok and built
  // Suites that the named files declare themselves, in the order of the text; those of used files
  // stand behind them in the plan.
  std::vector<std::string> own_suites = {};
  // "object.phrase" of the objects of some task by which no concrete task refers.
  std::vector<std::string> unused_phrases = {};
  std::vector<ReferringWords> referring;  // of every concrete task, source before target
  std::vector<ChosenStarts> chosen;       // of every concrete task with `where clear`
  std::vector<UnheldWords> unheld;        // of every concrete task, where it was asked for
  // What the objects are called when no phrase is chosen, by name.
  std::map<std::string, std::string> called;
  // How much was looked at: tasks that are no pattern and lack nothing, and their starts.
  std::size_t tasks = 0, starts = 0;
  AssetRoot asset_root;  // where its files were looked for: also beside the texts
};

// In: paths. Out: sources, diagnostics and, from build(), the verified bytes of a plan. The order:
// load and parse what the files reach (syntax), analyze() (check/analyze.h), emit() when that found
// no error, then what the judge finds in the plan (emit/early_end.h), which check() drops.
//
// Diagnoses the files and everything they use. Each file that no other named one uses is a program
// of its own, so two of them may declare the same names; of files that use each other, each is one
// too, and what is said of both is said once. What build() refuses it refuses. A Failure is only
// for the outside: a root file that cannot be read (kIo), a suite that no file declares (kUsage).
Result<Compilation> check(std::span<const std::string> files, const CompileOptions& options);

// The same, and when nothing is wrong the verified plan. Same text and assets, same bytes, from any
// directory.
Result<Compilation> build(std::span<const std::string> files, const CompileOptions& options);

// How large a suite is, without lowering or writing anything.
struct Counts {
  std::size_t tasks = 0;  // concrete ones, or the members of the one suite asked for
  std::size_t episodes = 0;
};
struct Counted {
  Compilation compilation;  // no plan; `ok` is false when the text has errors
  Counts counts;
};
Result<Counted> count(std::span<const std::string> files, const CompileOptions& options);

}  // namespace probe
