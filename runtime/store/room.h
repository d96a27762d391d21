// What a run's folder takes of the disk, and which of it nobody needs any more.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "runtime/base/result.h"

namespace probe::store {

struct Room {
  std::string what;  // "traces", "videos", "results", "plan", "shards", "other"
  std::int64_t files = 0, bytes = 0;
};
// Of all files below `dir`, without those behind links; what there is none of is not listed. Fails
// (kStore) where there is no run.
Result<std::vector<Room>> measure_room(const std::string& dir);

// A file, or a shard's folder as a whole, that no row of the run needs.
struct Spare {
  std::string path;
  std::int64_t files = 1, bytes = 0;
  std::string why;
  bool is_folder = false;
};
struct Spares {
  std::vector<Spare> spares;
  std::vector<std::string> notes;  // what was looked at and stays, and why
};
// Files that a killed process left unfinished; traces and videos without a row; shards below
// DIR/shards whose every valid row is in DIR with the same proven trace. Of names that no run makes
// nothing is said. Fails (kStore) where there is no run.
Result<Spares> find_spares(const std::string& dir);
// Removes them while no run writes the folder; fails (kStore) as FolderLock does.
Status remove_spares(const std::string& dir, const Spares& spares);

// "3-42.trace.tmp", "3-42.mp4.1234-0.tmp": what this program writes before it renames.
bool is_leftover(std::string_view name);

// "1.4 GB", "312 kB".
std::string bytes_text(std::int64_t bytes);

}  // namespace probe::store
