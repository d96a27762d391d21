// What a folder of ours holds is known by one file in it, its mark; and which files are its own.
// One table. A run, a model's answers and a search are never in one folder: each has a plan or
// rounds of its own. Header only.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/base/paths.h"
#include "runtime/base/result.h"

namespace probe {

inline constexpr const char* kRunDatabase = "results.sqlite";
inline constexpr const char* kAnswersDatabase = "answers.sqlite";
inline constexpr const char* kSearchFile = "search.json";

enum class FolderKind { kRun, kAnswers, kSearch, kArray, kSweep };

struct FolderRow {
  FolderKind kind;
  const char* mark;                     // a file
  const char* word;                     // "belongs to the `word` in DIR"
  const char* holds;                    // "holds `holds`"; null where it may hold others as well
  std::vector<std::string_view> names;  // beside the mark, with all that is below them
};

inline const std::vector<FolderRow>& folder_table() {
  static const std::vector<FolderRow> table = {
      {FolderKind::kRun,
       kRunDatabase,
       "run",
       "a run",
       {"suite.plan", "lock", "chosen", "traces", "videos"}},
      {FolderKind::kAnswers,
       kAnswersDatabase,
       "answers",
       "a model's answers",
       {"suite.plan", "lock"}},
      {FolderKind::kSearch, kSearchFile, "search", "a search", {"rounds", "found.probe"}},
      {FolderKind::kArray, "slurm/job.sh", "array", nullptr, {"slurm"}},
      {FolderKind::kSweep, "sweep.json", "sweep", nullptr, {}},
  };
  return table;
}
inline const FolderRow& folder_row(FolderKind kind) {
  return folder_table()[static_cast<std::size_t>(kind)];
}

inline std::string path_in(const std::string& dir, const char* name) {
  return (std::filesystem::path(dir) / name).string();
}
inline bool holds(const std::string& dir, FolderKind kind) {
  return is_there(path_in(dir, folder_row(kind).mark));
}
inline bool holds_run(const std::string& dir) { return holds(dir, FolderKind::kRun); }
inline bool holds_answers(const std::string& dir) { return holds(dir, FolderKind::kAnswers); }
inline bool holds_search(const std::string& dir) { return holds(dir, FolderKind::kSearch); }

// Whether a name in a folder of that kind is one of its own: the mark, what SQLite has beside a
// database, and the names of the table. Nothing else: what of a folder is not its own is kept when
// the rest is removed, such as a copy that the user made of the database.
inline bool is_own_name(const FolderRow& row, std::string_view name) {
  for (const std::string_view own : row.names) {
    if (name == own) return true;
  }
  if (!name.starts_with(row.mark)) return false;
  name.remove_prefix(std::string_view(row.mark).size());
  return name.empty() || name == "-journal" || name == "-wal" || name == "-shm";
}

// Before a folder is begun with, or gone on with, as of that kind. Fails (kStore, where = dir)
// where it holds another; one that may be beside a run or answers, as a sweep's own folders are, is
// in no search's.
inline Status check_holds_no_other(const std::string& dir, FolderKind kind) {
  const std::string wanted =
      (kind == FolderKind::kAnswers ? "" : "a ") + std::string(folder_row(kind).word);
  for (const FolderRow& row : folder_table()) {
    if (row.kind == kind || row.holds == nullptr || !holds(dir, row.kind)) continue;
    if (folder_row(kind).holds == nullptr && row.kind != FolderKind::kSearch) continue;
    return Failure{Fault::kStore,
                   std::string("holds ") + row.holds + "; take another folder for " + wanted, dir};
  }
  return {};
}

}  // namespace probe
