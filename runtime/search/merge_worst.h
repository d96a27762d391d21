// Shards of a search for the worst: each a search of its own, with its own draws, joined.
#pragma once

#include <span>
#include <string>

#include "runtime/base/json.h"
#include "runtime/base/result.h"

namespace probe::search {

// A shard as its folder has it.
struct WorstShard {
  std::string folder;
  Json findings;   // of its search.json
  int number = 0;  // from 1
  int of = 0;      // so many
  // What its rounds are called where shards lie together: "2-" before their numbers.
  std::string prefix() const { return std::to_string(number) + "-"; }
};

// "2/4" of what was asked. Fails (kUsage, where = folder) where it is not finished, for what is
// claimed is confirmed at its end.
Result<WorstShard> worst_shard(const std::string& folder, Json findings);

// The findings of all: cases that are confirmed first, the nearer first, a point that several found
// once. Each shard's claims hold with its part of the error, so all of them do with the whole.
// `shards`: in the order of their numbers, at least one.
Json joined_worst(std::span<const WorstShard> shards);

// Writes found.probe in `folder` with the cases that are confirmed, none where there are none.
// Reads the text that `findings` name. Fails where it is gone or another now.
Status keep_found(const Json& findings, const std::string& folder);

}  // namespace probe::search
