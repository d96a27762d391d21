#include "runtime/search/merge_searches.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <span>

#include "runtime/base/file.h"
#include "runtime/base/paths.h"
#include "runtime/search/search.h"

namespace probe::search {
namespace {

namespace fs = std::filesystem;

std::string in(const std::string& folder, const std::string& name) {
  return (fs::path(folder) / name).string();
}

// Where the text of the space lies is said as seen from each folder.
std::string without_use(const std::string& text) {
  const std::size_t begin = text.find("\nuse \"");
  if (begin == text.npos) return text;
  return text.substr(0, begin) + text.substr(std::min(text.find('\n', begin + 1), text.size()));
}

// The files of a round that say what its points are: the same in every shard.
Status copy_texts(const std::string& from, const std::string& to) {
  PROBE_TRY(make_lasting_folders(to));
  PROBE_ASSIGN(const auto names, list_folder(from));
  for (const std::string& name : names) {
    const std::string file = in(from, name), there = in(to, name);
    if (!is_file(file)) continue;
    if (!is_there(there)) {
      PROBE_TRY(copy_to_disk(file, there));
      continue;
    }
    PROBE_ASSIGN(const std::string a, read_file(file));
    PROBE_ASSIGN(const std::string b, read_file(there));
    if (without_use(a) != without_use(b)) return Failure{Fault::kUsage, "the round has other points than " + there, file};
  }
  return {};
}

}  // namespace

Result<store::MergeSummary> merge_searches(const store::MergeOptions& options) {
  PROBE_ASSIGN(const SearchSummary first, read_search(options.dirs.front()));
  for (const std::string& dir : options.dirs) {
    PROBE_ASSIGN(const SearchSummary other, read_search(dir));
    for (const auto& [key, value] : first.findings.at("asked").items()) {
      const Json* const theirs = other.findings.at("asked").find(key);
      if (theirs != nullptr && *theirs == value) continue;
      return Failure{Fault::kUsage,
                     "it was begun with another " + key + " than " + options.dirs.front(), dir};
    }
  }
  if (is_search(options.out)) {
    PROBE_ASSIGN(const SearchSummary there, read_search(options.out));
    if (there.findings.at("asked") != first.findings.at("asked"))
      return Failure{Fault::kUsage, "it holds another search", options.out};
  }
  std::map<std::string, std::vector<std::string>> rounds;  // name to folders of shards
  for (const std::string& dir : options.dirs) {
    const std::string of = in(dir, "rounds");
    if (!is_folder(of)) continue;
    PROBE_ASSIGN(const auto names, list_folder(of));
    for (const std::string& name : names) rounds[name].push_back(in(of, name));
  }
  store::MergeSummary all;
  for (const auto& [name, folders] : rounds) {
    const std::string to = in(in(options.out, "rounds"), name);
    for (const std::string& folder : folders) PROBE_TRY(copy_texts(folder, to));
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
  if (!is_search(options.out)) {
    PROBE_TRY(
        copy_to_disk(in(options.dirs.front(), "search.json"), in(options.out, "search.json")));
  }
  all.notes.push_back("the same `search` command with -o " + options.out +
                      " tells what was found, and runs what is missing");
  return all;
}

}  // namespace probe::search
