// What the tasks of an array job do and how their folders become one: any verb that has shards,
// goes on where it was killed and merges, as `run` does.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "runtime/base/folder_kind.h"
#include "runtime/base/result.h"
#include "runtime/store/merge.h"

namespace probe::cluster {

class ArrayWork {
 public:
  virtual ~ArrayWork() = default;
  virtual FolderKind folder_kind() const = 0;  // of the joined folder and its shards
  virtual std::string verb() const = 0;        // of vlaprobe: "run"
  virtual std::string actor_flag() const = 0;  // says who acts: "--policy"
  virtual std::string actor() const = 0;       // with {port} for a task's own server
  virtual std::string name() const = 0;        // what rows call it
  virtual std::string things() const = 0;      // what is chosen: "episodes"
  // The verb's words for what is chosen, but plan, actor, name, folder, jobs and shard.
  virtual std::vector<std::string> words() const = 0;

  virtual std::int64_t total() const = 0;  // chosen
  // Fails (kStore) where merging into `out` would be refused at the end.
  virtual Status check_same(const std::string& out) const = 0;
  virtual Result<bool> is_begun(const std::string& dir) const = 0;
  // How many of those chosen `dir` has no valid row of, by shard; shards that lack none have no
  // entry.
  virtual Result<std::map<int, std::int64_t>> missing(const std::string& dir, int shards) const = 0;
  virtual Result<store::MergeSummary> merge(const store::MergeOptions& options) const = 0;
};

}  // namespace probe::cluster
