#include "runtime/search/merge_searches.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <span>

#include "runtime/base/file.h"
#include "runtime/base/folder_kind.h"
#include "runtime/base/inside.h"
#include "runtime/base/paths.h"
#include "runtime/search/hunt.h"
#include "runtime/search/merge_worst.h"
#include "runtime/search/search.h"
#include "runtime/search/stored_points.h"

namespace probe::search {
namespace {

namespace fs = std::filesystem;

std::string in(const std::string& folder, const std::string& name) {
  return (fs::path(folder) / name).string();
}

// Where the text of the space lies is said as seen from each folder: the text with that line
// replaced.
std::string with_use(const std::string& text, const std::string& use) {
  const std::size_t begin = text.find("\nuse \"");
  if (begin == text.npos) return text;
  return text.substr(0, begin) + use +
         text.substr(std::min(text.find('\n', begin + 1), text.size()));
}

// The files of a round that say what its points are: the same in every shard. `file`: the text of
// the space.
Status copy_texts(const std::string& from, const std::string& to,
                  const std::string& file_of_space) {
  PROBE_TRY(make_lasting_folders(to));
  PROBE_ASSIGN(const auto names, list_folder(from));
  for (const std::string& name : names) {
    const std::string file = in(from, name), there = in(to, name);
    // What a round was compiled to is of one program and one place: the next call compiles it
    // again.
    if (!is_file(file) || is_stored_point_file(name)) continue;
    if (!is_there(there)) {
      PROBE_TRY(copy_to_disk(file, there));
      if (!name.ends_with(".probe") || file_of_space.empty()) continue;
      PROBE_ASSIGN(const std::string text, read_file(there));
      const std::string own = with_use(text, "\nuse \"" + use_of(file_of_space, to) + "\"");
      PROBE_TRY(write_file(there, std::as_bytes(std::span(own))));
      continue;
    }
    PROBE_ASSIGN(const std::string a, read_file(file));
    PROBE_ASSIGN(const std::string b, read_file(there));
    if (with_use(a, "") != with_use(b, ""))
      return Failure{Fault::kUsage, "the round has other points than " + there, file};
  }
  return {};
}

// Folders of each round of the joined search, by its name there.
using Rounds = std::map<std::string, std::vector<std::string>>;

Status add_rounds(const std::string& dir, const std::string& prefix, Rounds& rounds) {
  const std::string of = in(dir, "rounds");
  if (!is_folder(of)) return {};
  PROBE_ASSIGN(const auto names, list_folder(of));
  for (const std::string& name : names) rounds[prefix + name].push_back(in(of, name));
  return {};
}

Result<store::MergeSummary> merge_rounds(const Rounds& rounds, const std::string& file,
                                         const store::MergeOptions& options) {
  store::MergeSummary all;
  for (const auto& [name, folders] : rounds) {
    const std::string to = in(in(options.out, "rounds"), name);
    for (const std::string& folder : folders) PROBE_TRY(copy_texts(folder, to, file));
    // Runs of the round by the name that they have in it: the policy's, and the expert's together.
    std::map<std::string, std::vector<std::string>> runs;
    for (const std::string& folder : folders) {
      PROBE_ASSIGN(const auto names, list_folder(folder));
      for (const std::string& run : names) {
        if (!is_folder(in(folder, run))) continue;
        runs[run.starts_with("expert-") ? "expert-merged" : run].push_back(in(folder, run));
      }
    }
    for (const auto& [run, dirs] : runs) {
      store::MergeOptions merging = options;
      merging.dirs = dirs;
      merging.out = in(to, run);
      PROBE_ASSIGN(const store::MergeSummary merged, store::merge(merging));
      if (run == "expert-merged") continue;
      all.rows += merged.rows;
      all.added += merged.added;
      all.duplicates += merged.duplicates;
      all.invalid += merged.invalid;
      all.left_out += merged.left_out;
      all.not_attempted.add(merged.not_attempted);
      all.notes.insert(all.notes.end(), merged.notes.begin(), merged.notes.end());
    }
  }
  return all;
}

// What two folders of one search were begun with alike; a shard's number may differ.
Status check_alike(const std::string& first_dir, const Json& first, const std::string& dir,
                   const Json& other) {
  for (const auto& [a, b] : {std::pair(&first, &other), std::pair(&other, &first)}) {
    for (const auto& [key, value] : a->items()) {
      if (key == kShardKey) continue;
      const Json* const theirs = b->find(key);
      if (theirs != nullptr && *theirs == value) continue;
      return Failure{Fault::kUsage, "it was begun with another " + key + " than " + first_dir, dir};
    }
  }
  return {};
}

// Found by shards that are searches of their own, each finished. found.probe needs the text.
Result<store::MergeSummary> merge_worst(const store::MergeOptions& options) {
  std::vector<WorstShard> shards;
  for (const std::string& dir : options.dirs) {
    if (std::ranges::any_of(shards, [&](const auto& one) { return is_same(one.folder, dir); }))
      continue;
    PROBE_ASSIGN(SearchSummary read, read_search(dir));
    PROBE_ASSIGN(WorstShard shard, worst_shard(dir, std::move(read.findings)));
    for (const WorstShard& other : shards) {
      if (other.number == shard.number)
        return Failure{Fault::kUsage, "it is the same shard as " + other.folder, dir};
      if (other.of != shard.of)
        return Failure{Fault::kUsage,
                       "it is one of " + std::to_string(shard.of) + " shards, " + other.folder +
                           " one of " + std::to_string(other.of),
                       dir};
    }
    shards.push_back(std::move(shard));
  }
  std::ranges::sort(shards, {}, &WorstShard::number);
  const Json joined = joined_worst(shards);
  if (is_search(options.out)) {
    PROBE_ASSIGN(const SearchSummary there, read_search(options.out));
    if (there.findings.at("asked") != joined.at("asked"))
      return Failure{Fault::kUsage, "it holds another search", options.out};
    for (const Json& number : there.findings.value("shards", Json::array())) {
      const bool is_named = std::ranges::any_of(
          shards, [&](const WorstShard& shard) { return number == Json(shard.number); });
      if (!is_named)
        return Failure{Fault::kUsage,
                       "it holds shard " + number.dump() + ", too: name its folder as well",
                       options.out};
    }
  }
  Rounds rounds;
  for (const WorstShard& shard : shards)
    PROBE_TRY(add_rounds(shard.folder, shard.prefix(), rounds));
  PROBE_ASSIGN(store::MergeSummary all, merge_rounds(rounds, joined.value("file", ""), options));
  PROBE_TRY(write_search(options.out, joined));
  if (static_cast<int>(shards.size()) < shards.front().of)
    all.notes.push_back(std::to_string(shards.size()) + " of " + std::to_string(shards.front().of) +
                        " shards: what they found holds without the others");
  if (const Status kept = keep_found(joined, options.out); !kept)
    all.notes.push_back("found.probe is not written (" + to_text(kept.failure()) +
                        "); that of each shard stands beside it");
  all.notes.push_back("`vlaprobe search show " + options.out + "` tells what was found");
  return all;
}

}  // namespace

Result<store::MergeSummary> merge_searches(const store::MergeOptions& options) {
  PROBE_TRY(check_search_folder(options.out));
  PROBE_ASSIGN(const SearchSummary first, read_search(options.dirs.front()));
  const Json& asked = first.findings.at("asked");
  for (const std::string& dir : options.dirs) {
    PROBE_ASSIGN(const SearchSummary other, read_search(dir));
    PROBE_TRY(check_alike(options.dirs.front(), asked, dir, other.findings.at("asked")));
  }
  if (asked.value("method", "") == to_text(Method::kWorst)) return merge_worst(options);
  if (is_search(options.out)) {
    PROBE_ASSIGN(const SearchSummary there, read_search(options.out));
    if (there.findings.at("asked") != first.findings.at("asked"))
      return Failure{Fault::kUsage, "it holds another search", options.out};
  }
  Rounds rounds;
  for (const std::string& dir : options.dirs) PROBE_TRY(add_rounds(dir, "", rounds));
  PROBE_ASSIGN(store::MergeSummary all,
               merge_rounds(rounds, first.findings.value("file", ""), options));
  if (!is_search(options.out)) {
    PROBE_ASSIGN(const std::string file, file_inside(options.out, kSearchFile));
    PROBE_TRY(copy_to_disk(in(options.dirs.front(), kSearchFile), file));
  }
  all.notes.push_back("the same `search` command with -o " + options.out +
                      " tells what was found, and runs what is missing");
  return all;
}

}  // namespace probe::search
