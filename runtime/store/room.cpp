#include "runtime/store/room.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <unordered_map>
#include <unordered_set>

#include "runtime/base/folder_kind.h"
#include "runtime/base/paths.h"
#include "runtime/store/folder_lock.h"
#include "runtime/store/proof.h"
#include "runtime/store/store.h"

namespace probe::store {
namespace {

namespace fs = std::filesystem;

// Calls `visit` with every regular file below a folder, no link followed.
template <typename Visit>
void each_file(const fs::path& folder, Visit&& visit) {
  std::error_code error;
  fs::recursive_directory_iterator at(folder, error), end;
  for (; !error && at != end; at.increment(error)) {
    if (at->is_symlink(error)) continue;
    if (!at->is_regular_file(error)) continue;
    const auto size = at->file_size(error);
    if (!error) visit(at->path(), static_cast<std::int64_t>(size));
    error.clear();
  }
}

std::int64_t size_of(const fs::path& path) {
  std::error_code error;
  const auto size = fs::file_size(path, error);
  return error ? 0 : static_cast<std::int64_t>(size);
}

// "3-42" of "3-42.trace"; empty: no name of ours.
std::string stem_of(std::string_view name, std::string_view kind) {
  if (!name.ends_with(kind)) return "";
  name.remove_suffix(kind.size());
  const auto dash = name.find('-');
  const bool is_ours = dash != name.npos && dash > 0 && dash + 1 < name.size() &&
                       name.find_first_not_of("0123456789-") == name.npos;
  return is_ours ? std::string(name) : "";
}

// Traces and videos without a row, and what was not finished.
void add_orphans(const fs::path& dir, const std::unordered_set<std::string>& known, Spares& out) {
  for (const auto& [kind, ending] : {std::pair<const char*, const char*>{"traces", ".trace"},
                                     std::pair<const char*, const char*>{"videos", ".mp4"}}) {
    const fs::path all = dir / kind;
    if (is_link(all.string())) continue;
    const auto tasks = list_folder(all.string());
    for (const std::string& task : tasks ? *tasks : std::vector<std::string>{}) {
      const fs::path folder = all / task;
      if (is_link(folder.string())) continue;
      const auto names = list_folder(folder.string());
      for (const std::string& name : names ? *names : std::vector<std::string>{}) {
        const fs::path path = folder / name;
        if (is_link(path.string()) || !is_file(path.string())) continue;
        const std::string stem = stem_of(name, ending);
        if (is_leftover(name)) {
          out.spares.push_back({path.string(), 1, size_of(path), "was not finished"});
        } else if (!stem.empty() && !known.contains(task + "/" + stem)) {
          out.spares.push_back({path.string(), 1, size_of(path), "no row is of it"});
        }
      }
    }
  }
}

std::pair<std::int64_t, std::int64_t> size_below(const fs::path& folder) {  // files, bytes
  std::int64_t files = 0, all = 0;
  each_file(folder, [&](const fs::path&, std::int64_t bytes) {
    ++files;
    all += bytes;
  });
  return {files, all};
}

// Why a shard's folder has to stay; empty: everything of it is in `merged`, hashes by row.
std::string why_needed(const fs::path& shard,
                       const std::unordered_map<std::string, std::string>& merged) {
  const auto names = list_folder(shard.string());
  if (!names) return "cannot be listed";
  for (const std::string& name : *names) {
    if (!is_own_name(folder_row(FolderKind::kRun), name))
      return "has `" + name + "`, which no run makes";
  }
  if (FolderLock::is_taken(shard.string())) return "is being written";
  std::int64_t missing = 0, videos = 0;
  const auto read = for_each_row(shard.string(), [&](ResultRow&& row) -> Status {
    if (row.invalid) return {};
    const auto at = merged.find(file_stem(key_of(row)));
    if (at == merged.end() || at->second != row.trace_sha256) ++missing;
    return {};
  });
  if (!read) return "cannot be read: " + read.failure().message;
  if (missing > 0) return fmt::format("has {} valid rows that are not merged", missing);
  each_file(shard / "videos", [&](const fs::path& path, std::int64_t) {
    const fs::path there = shard.parent_path().parent_path() / "videos" /
                           path.parent_path().filename() / path.filename();
    if (path.extension() == ".mp4" && !is_file(there.string())) ++videos;
  });
  return videos == 0 ? "" : fmt::format("has {} videos that are not merged", videos);
}

}  // namespace

bool is_leftover(std::string_view name) {
  constexpr std::string_view kDigits = "0123456789";
  const std::size_t dash = name.find('-'), dot = name.find('.');
  if (!name.ends_with(".tmp") || dash == name.npos || dot == name.npos || dash > dot) return false;
  const std::string_view kind = name.substr(dot);
  return dash > 0 && name.substr(0, dash).find_first_not_of(kDigits) == name.npos &&
         dot > dash + 1 &&
         name.substr(dash + 1, dot - dash - 1).find_first_not_of("-0123456789") == name.npos &&
         (kind.starts_with(".trace") || kind.starts_with(".mp4"));
}

std::string bytes_text(std::int64_t bytes) {
  constexpr const char* kUnits[] = {"B", "kB", "MB", "GB", "TB"};
  double value = static_cast<double>(bytes);
  std::size_t unit = 0;
  while (value >= 999.5 && unit + 1 < std::size(kUnits)) {
    value /= 1000;
    ++unit;
  }
  return unit == 0 || value >= 9.95 ? fmt::format("{:.0f} {}", value, kUnits[unit])
                                    : fmt::format("{:.1f} {}", value, kUnits[unit]);
}

Result<std::vector<Room>> measure_room(const std::string& dir) {
  PROBE_ASSIGN([[maybe_unused]] const RunRecord record, read_run_record(dir));
  std::vector<Room> rooms = {{"traces"}, {"videos"}, {"results"}, {"plan"}, {"shards"}, {"other"}};
  each_file(dir, [&](const fs::path& path, std::int64_t bytes) {
    const std::string first = path.lexically_relative(dir).begin()->string();
    const std::string what = first.starts_with("results.sqlite") ? "results"
                             : first == "suite.plan"             ? "plan"
                                                                 : first;
    auto at = std::ranges::find(rooms, what, &Room::what);
    if (at == rooms.end()) at = rooms.end() - 1;
    ++at->files;
    at->bytes += bytes;
  });
  std::erase_if(rooms, [](const Room& room) { return room.files == 0; });
  return rooms;
}

Result<Spares> find_spares(const std::string& dir) {
  Spares out;
  std::unordered_set<std::string> known;
  PROBE_TRY(for_each_row(dir, [&](ResultRow&& row) -> Status {
    known.insert(file_stem(key_of(row)));
    return {};
  }));
  add_orphans(dir, known, out);
  const auto shards = list_folder(dir + "/shards");
  if (!shards || is_link(dir + "/shards")) return out;
  std::unordered_map<std::string, std::string> merged;
  // A copy goes: the one that stays is read whole.
  PROBE_ASSIGN([[maybe_unused]] const ProvenRun proven,
               for_each_proven_row(
                   dir,
                   [&](ResultRow&& row) -> Status {
                     if (!row.invalid) merged[file_stem(key_of(row))] = row.trace_sha256;
                     return {};
                   },
                   ""));
  for (const std::string& name : *shards) {
    const fs::path shard = fs::path(dir) / "shards" / name;
    if (is_link(shard.string()) || !is_file((shard / "results.sqlite").string())) continue;
    const std::string why = why_needed(shard, merged);
    if (!why.empty()) {
      out.notes.push_back(shard.string() + " stays: it " + why);
      continue;
    }
    const auto [files, bytes] = size_below(shard);
    out.spares.push_back({shard.string(), files, bytes, "all of it is merged", true});
  }
  return out;
}

Status remove_spares(const std::string& dir, const Spares& spares) {
  PROBE_ASSIGN([[maybe_unused]] const FolderLock lock, FolderLock::take(dir));
  // What was committed since they were found is needed now; from here on nobody writes.
  PROBE_ASSIGN(const Spares now, find_spares(dir));
  for (const Spare& spare : spares.spares) {
    const auto still = std::ranges::find(now.spares, spare.path, &Spare::path);
    if (still == now.spares.end()) continue;
    std::error_code error;
    if (spare.is_folder) {
      PROBE_ASSIGN([[maybe_unused]] const FolderLock own, FolderLock::take(spare.path));
      const auto [files, bytes] = size_below(spare.path);
      if (files != still->files || bytes != still->bytes) continue;
      fs::remove_all(spare.path, error);
    } else {
      fs::remove(spare.path, error);
    }
    if (error) return Failure{Fault::kStore, "cannot be removed: " + error.message(), spare.path};
  }
  return {};
}

}  // namespace probe::store
