// `vlaprobe search`: where a policy breaks, within a space of variants that are fair.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "runtime/base/json.h"
#include "runtime/base/result.h"
#include "runtime/run/run.h"
#include "runtime/search/base_task.h"

namespace probe::search {

enum class Method : std::uint8_t { kBoundary, kWorst, kMinimal, kAxes };
std::string_view to_text(Method method);
std::optional<Method> method_of(std::string_view word);

struct SearchOptions {
  Method method = Method::kBoundary;
  TextOptions text;
  run::RunOptions
      run;  // policy, name, jobs, retries, ... of every run; `out` is the search's folder
  std::uint64_t seed = 0;
  std::optional<int> budget;  // trials at most: of a boundary each side's
  double error = 0.05;        // of a boundary: half the interval's width, as a share of its side
  int levels = 41;            // of a boundary
  bool proves = true;         // the expert solves what is tried, or it is left out
  // Of `minimal`: the case that fails. Either of a folder of `worst` its case, from 1, ...
  std::string from;
  int number = 1;
  std::string at;  // ... or "light.power 0.3, clutter 2", as axes are called and units are read
  std::function<void(const std::string&)> tell;  // what it is about to do; may be null
};

struct SearchSummary {
  Json findings;                   // as DIR/search.json has them
  std::vector<std::string> lines;  // the same in words
  std::vector<std::string> notes;
  int trials = 0, episodes = 0, ran = 0, left_out = 0;
  // Of those left out: whose episodes came to no end that counts, and of the first which and why.
  int invalid = 0;
  std::string first_invalid;
  bool is_done = true;  // else something is open that more budget would tell
};

// In: a text with a space, and a policy. Out: DIR with search.json (what was asked, what was
// found), rounds/NN (points.probe with its tables, points.csv, policy/ and expert-N/: ordinary runs
// of its frozen plan) and found.probe (what was found, as variants to keep). The order: the text
// and the folder are looked at, and refused where they differ from what the folder was begun with;
// then round by round points are written and compiled, those that the compiler refuses or the
// expert does not solve are left out, the others run and told to the method. The same call goes on
// where another ended, with what is stored.
Result<SearchSummary> search(const SearchOptions& options, std::string& said);

// What is asked of one shard of a search for the worst: "2/4".
inline constexpr std::string_view kShardKey = "shard";

// Whether the folder is one of a search.
bool is_search(const std::string& folder);

// Before rounds are written into it: it holds no run and no answers (kStore), and no link is where
// rounds write (kIo), so that nothing lands outside of it.
Status check_search_folder(const std::string& folder);
// What a folder's search has found so far. Fails (kStore) where there is none.
Result<SearchSummary> read_search(const std::string& folder);
// DIR/search.json. Fails (kIo).
Status write_search(const std::string& folder, const Json& findings);

}  // namespace probe::search
