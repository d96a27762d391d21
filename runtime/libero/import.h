// A lab's own LIBERO folder as suites of ours: texts, tables of starts and assets, in a folder that
// every verb takes with `--assets`.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "runtime/base/result.h"

namespace probe::libero {

struct ImportOptions {
  std::string from;       // with bddl_files, init_files and assets, or above
  std::string robosuite;  // with models/assets/base.xml, or below; empty: beside `from`
  std::string to;         // folder to make
  std::string poses;      // table of where fixtures stand; empty: in the middle of their regions
  std::string own;        // our asset folder, which has the robots
};

struct ImportLine {
  std::string word;  // "suite", "object", "fixture", "room", "robot", "odd", "missing", "broken"
  std::string text;
};

struct ImportReport {
  std::vector<ImportLine> lines;
  std::size_t tasks = 0, starts = 0, files = 0;
  std::size_t broken = 0;  // things for which a text that was written does not check
  std::uint64_t bytes = 0;
  std::vector<std::string> suites;  // that have a text, at least one: "libero_goal"
};

// OUT appears whole or not at all. A task whose problem, starts or models cannot be read is a line
// and left out; nothing is filled in. So is one whose things are called as another task calls
// others, or by a word that means something else in a text. Fails (kUsage, kIo) where no such
// folder is, where no task can be read, and where `to` is there already.
Result<ImportReport> import_libero(const ImportOptions& options);

}  // namespace probe::libero
