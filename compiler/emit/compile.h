// The compiler as one call: .probe files to diagnostics and the bytes of a plan.
#pragma once

#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "compiler/diag/diagnostic.h"
#include "compiler/source/source.h"
#include "runtime/base/result.h"

namespace probe {

struct CompileOptions {
  std::string asset_root;
  std::string suite;  // the one suite to compile; "" = all
  // Where a `use` is looked up when the file is not beside its user: folders that hold `std/`.
  std::vector<std::string> library_folders = {};
};

struct Compilation {
  SourceSet sources;
  Diagnostics diagnostics;
  bool ok = false;              // no errors
  std::vector<std::byte> plan;  // empty unless ok and built
  // What the objects are called when no phrase is chosen, by name.
  std::map<std::string, std::string> called;
};

// Diagnoses the files and everything they use. Assets are looked for, not read. A Failure is only
// for the outside: a root file that cannot be read (code "io"), a suite that no file declares (code
// "usage").
Result<Compilation> check(std::span<const std::string> files, const CompileOptions& options);

// The same, and when nothing is wrong the verified plan. Same text and assets, same bytes, from any
// directory.
Result<Compilation> build(std::span<const std::string> files, const CompileOptions& options);

// How large a suite is, without lowering or writing anything.
  // Suites that the named files declare themselves, in the order of the text; those of used files
  // stand behind them in the plan.
  std::vector<std::string> own_suites;
  // "object.phrase" of the objects of some task by which no concrete task refers.
  std::vector<std::string> unused_phrases;
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
