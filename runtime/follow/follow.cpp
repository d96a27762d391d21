#include "runtime/follow/follow.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <ctime>
#include <unordered_set>

#include "runtime/adaptive/rule.h"
#include "runtime/base/digit_groups.h"
#include "runtime/base/hash_number.h"
#include "runtime/base/paths.h"
#include "runtime/base/percent.h"
#include "runtime/base/printable.h"
#include "runtime/base/sha256.h"
#include "runtime/base/shell_word.h"
#include "runtime/store/chosen.h"
#include "runtime/store/folder_lock.h"
#include "runtime/store/not_attempted.h"
#include "runtime/store/results.h"
#include "runtime/store/store.h"
#include "runtime/store/until_words.h"

namespace probe::follow {
namespace {

constexpr std::size_t kNewest = 8;      // failures that are told
constexpr std::size_t kMostRates = 64;  // metrics that are counted
constexpr double kPaceOver = 600;       // s
constexpr std::size_t kLongestWhy = 160;  // characters

// Time and size of a database; empty: it is not there.
std::string stamp_of(const std::string& path) {
  struct stat file {};
  if (::stat(path.c_str(), &file) != 0) return "";
  return fmt::format("{}.{} {}", file.st_mtim.tv_sec, file.st_mtim.tv_nsec, file.st_size);
}

// "3-of-64": 64; 0: it is no shard's name.
int shards_of(const std::string& name) {
  const auto at = name.find("-of-");
  int shards = 0;
  if (at == name.npos) return 0;
  const char* end = name.data() + name.size();
  const auto read = std::from_chars(name.data() + at + 4, end, shards);
  return read.ec == std::errc() && read.ptr == end ? shards : 0;
}

void add_newest(std::vector<Failure>& newest, Failure failure) {
  const auto at = std::ranges::find_if(
      newest, [&](const Failure& other) { return other.ended_s < failure.ended_s; });
  if (at == newest.end() && newest.size() >= kNewest) return;
  newest.insert(at, std::move(failure));
  if (newest.size() > kNewest) newest.pop_back();
}

}  // namespace

std::optional<double> Seen::left_s() const {
  if (!chosen || per_s <= 0 || !until.empty()) return std::nullopt;
  return static_cast<double>(std::max<std::int64_t>(0, *chosen - rows)) / per_s;
}

// What is told of failures is of the rows as they are: one that was run again and came out well is
// none any more.
Status Following::read(const std::string& dir, Folder& folder) {
  Folder now{folder.stamp, folder.until, {}, {}, {}};
  const auto add_failure = [&](const store::ResultRow& row, std::string why) {
    const std::string trace = row.trace + " " + row.trace_sha256;
    double& ended = now.written[trace];
    if (const auto known = folder.written.find(trace); known != folder.written.end()) {
      ended = known->second;
    } else if (struct stat file {}; ::stat(row.trace.c_str(), &file) == 0) {
      ended = static_cast<double>(file.st_mtim.tv_sec) +
              static_cast<double>(file.st_mtim.tv_nsec) * 1e-9;
    }
    add_newest(now.newest, {dir, store::key_of(row), std::move(why), ended});
  };
  PROBE_TRY(store::for_each_row(dir, [&](store::ResultRow&& row) -> Status {
    Row& one = now.rows.emplace_back();
    one.episode = little_endian_number(sha256(store::file_stem(store::key_of(row))));
    if (store::is_not_attempted(row)) {
      one.is = Row::Is::kNotAttempted;
      return {};
    }
    if (row.invalid) {
      one.is = Row::Is::kInvalid;
      add_failure(row, "invalid: " + *row.invalid);
      return {};
    }
    for (const store::MetricValue& metric : row.metrics) {
      if (!metric.is_bool) continue;
      const auto at = static_cast<std::size_t>(
          std::ranges::find(names_, metric.name) - names_.begin());
      if (at >= kMostRates) continue;
      if (at == names_.size()) names_.push_back(metric.name);
      one.known |= std::uint64_t{1} << at;
      one.true_ |= std::uint64_t{metric.value != 0} << at;
      if (metric.name == "success" && metric.value == 0)
        add_failure(row, fmt::format("no success in {} steps", row.steps));
    }
    return {};
  }));
  folder = std::move(now);
  return {};
}

void Following::count(const Row& row, Seen& seen) const {
  ++seen.rows;
  if (row.is == Row::Is::kInvalid) ++seen.invalid;
  if (row.is == Row::Is::kNotAttempted) ++seen.not_attempted;
  for (std::size_t at = 0; at < names_.size(); ++at) {
    if ((row.known >> at & 1) == 0) continue;
    if (seen.rates.size() <= at) seen.rates.resize(at + 1);
    ++seen.rates[at].second.n;
    seen.rates[at].second.k += static_cast<std::int64_t>(row.true_ >> at & 1);
  }
}

Result<Seen> Following::look(double now) {
  Seen seen;
  seen.dir = dir_;
  std::vector<std::string> dirs;
  if (const auto shards = list_folder(dir_ + "/shards")) {
    for (const std::string& name : *shards) {
      if (shards_of(name) == 0) continue;
      seen.shards = std::max(seen.shards, shards_of(name));
      dirs.push_back(dir_ + "/shards/" + name);
    }
  }
  const std::size_t present = dirs.size();
  // Last, since a shard that goes on has the newer rows.
  const bool is_merged = is_there(dir_ + "/results.sqlite");
  if (dirs.empty() || is_merged) dirs.push_back(dir_);
  std::int64_t chosen = 0, alone = 0;  // alone: rows that the merged run has and no shard
  bool knows_all = true;
  std::unordered_set<std::uint64_t> counted;
  for (std::size_t i = 0; i < dirs.size(); ++i) {
    const std::string& dir = dirs[i];
    const bool is_shard = i < present;
    Folder& folder = folders_[dir];
    const std::string stamp = stamp_of(dir + "/results.sqlite");
    seen.is_written = seen.is_written || store::FolderLock::is_taken(dir);
    if (stamp.empty()) continue;
    if (present == 0 || is_shard) ++seen.begun;
    if (stamp != folder.stamp) {
      PROBE_ASSIGN(const auto record, store::find_run_record(dir));
      if (!record) continue;  // just being made
      folder.until = record->identity.until;
      PROBE_TRY(read(dir, folder));
      folder.stamp = stamp;
    }
    if (seen.until.empty()) seen.until = folder.until;
    for (const Row& row : folder.rows) {
      if (present > 0 && is_merged && !counted.insert(row.episode).second) continue;
      if (present > 0 && !is_shard) ++alone;
      count(row, seen);
    }
    for (const Failure& failure : folder.newest) {
      const auto same = [&](const Failure& other) { return other.key == failure.key; };
      if (!std::ranges::any_of(seen.newest, same)) add_newest(seen.newest, failure);
    }
    if (present > 0 && !is_shard) continue;
    const auto of_folder = store::read_chosen(dir);
    knows_all = knows_all && of_folder;
    chosen += of_folder.value_or(0);
  }
  for (std::size_t at = 0; at < seen.rates.size(); ++at) seen.rates[at].first = names_[at];
  std::erase_if(seen.rates, [](const auto& rate) { return rate.second.n == 0; });
  // What stands in the merged run alone is of shards that `gc` removed: they are done.
  if (alone > 0 && seen.begun < seen.shards) {
    seen.merged = seen.shards - seen.begun;
    seen.begun = seen.shards;
    chosen += alone;
  }
  if (knows_all && seen.begun > 0) {
    seen.is_about = seen.begun < seen.shards;
    seen.chosen = seen.is_about ? chosen * seen.shards / seen.begun : chosen;
  }
  if (seen.shards == 0) seen.begun = 0;
  pace_.push_back({now, seen.rows});
  while (pace_.size() > 2 && now - pace_[1].first > kPaceOver) pace_.pop_front();
  const auto& [first, before] = pace_.front();
  if (now > first && seen.rows > before)
    seen.per_s = static_cast<double>(seen.rows - before) / (now - first);
  return seen;
}

std::string duration_text(double seconds) {
  const auto whole = static_cast<long long>(std::llround(std::max(0.0, seconds)));
  if (whole < 100) return fmt::format("{} s", whole);
  const long long minutes = (whole + 30) / 60;
  if (minutes < 100) return fmt::format("{} min", minutes);
  return fmt::format("{} h {:02} min", minutes / 60, minutes % 60);
}

namespace {

// To be copied into a shell: names come from a folder that may be somebody else's.
std::string why_command(const Failure& failure) {
  return fmt::format("vlaprobe why {} {} {} {}", shell_word(printable(failure.dir, kLongestWhy)),
                     shell_word(printable(failure.key.task, kLongestWhy)), failure.key.episode,
                     failure.key.seed);
}

}  // namespace

std::vector<std::string> to_lines(const Seen& seen) {
  const auto groups = [](std::int64_t n) { return digit_groups(static_cast<std::size_t>(n)); };
  std::string line = printable(seen.dir, kLongestWhy) + ": " + groups(seen.rows);
  if (seen.chosen && seen.until.empty())
    line += fmt::format(" of {}{}", seen.is_about ? "about " : "", groups(*seen.chosen));
  // How many there will be depends on how they end; at its end a run says how many there are.
  if (seen.chosen && !seen.until.empty() && !seen.is_done())
    line += fmt::format(" of at most {}", groups(*seen.chosen));
  line += " episodes";
  if (seen.shards > 0 && seen.begun < seen.shards)
    line += fmt::format(", {} of {} shards begun", seen.begun, seen.shards);
  if (seen.merged > 0)
    line += fmt::format(", {} of {} shards merged and removed", seen.merged, seen.shards);
  if (seen.not_attempted > 0) line += fmt::format(", {} not attempted", groups(seen.not_attempted));
  if (seen.invalid > 0) line += fmt::format(", {} invalid", groups(seen.invalid));
  if (seen.is_done()) {
    line += ", done";
  } else if (seen.per_s > 0) {
    line += fmt::format(", {} a minute", decimal_text(60 * seen.per_s, 1));
    if (const auto left = seen.left_s()) line += fmt::format(", {} left", duration_text(*left));
  }
  std::vector<std::string> lines = {line};
  const std::string dir = shell_word(printable(seen.dir, kLongestWhy));
  if (store::is_by_search(seen.until)) {
    lines.push_back("  " + store::what_chose(seen.until) + "; `vlaprobe search show " + dir +
                    "` says what was found");
  } else if (!seen.until.empty()) {
    lines.push_back(fmt::format("  until {}; `vlaprobe results {}` has its rates",
                                printable(adaptive::in_words(seen.until), kLongestWhy), dir));
  }
  for (const auto& [name, count] : seen.rates) {
    if (!seen.until.empty()) {
      lines.push_back(fmt::format("  {:<12} {:>9} of {:<9}", printable(name, kLongestWhy),
                                  groups(count.k), groups(count.n)));
      continue;
    }
    const stats::Interval interval = stats::wilson(count);
    lines.push_back(fmt::format("  {:<12} {:>9} of {:<9} {:>5} %  [{}]",
                                printable(name, kLongestWhy), groups(count.k),
                                groups(count.n), decimal_text(100 * count.rate(), 1),
                                percent_range(interval.low, interval.high, "-")));
  }
  for (const Failure& failure : seen.newest) {
    const auto ended = static_cast<std::time_t>(failure.ended_s);
    lines.push_back(fmt::format("  {:%H:%M:%S} {}: {}", fmt::localtime(ended),
                                printable(store::to_text(failure.key), kLongestWhy),
                                printable(failure.why, kLongestWhy)));
    lines.push_back("           " + why_command(failure));
  }
  return lines;
}

Json to_json(const Seen& seen) {
  Json rates = Json::array(), newest = Json::array();
  for (const auto& [name, count] : seen.rates) {
    Json rate = {{"name", name}, {"k", count.k}, {"n", count.n}};
    if (seen.until.empty()) {
      const stats::Interval interval = stats::wilson(count);
      rate["low"] = interval.low;
      rate["high"] = interval.high;
    }
    rates.push_back(std::move(rate));
  }
  for (const Failure& failure : seen.newest) {
    newest.push_back({{"dir", failure.dir},
                      {"task", failure.key.task},
                      {"episode", failure.key.episode},
                      {"seed", failure.key.seed},
                      {"why", printable(failure.why, kLongestWhy)},
                      {"command", why_command(failure)},
                      {"ended", failure.ended_s}});
  }
  const auto left = seen.left_s();
  return {{"dir", seen.dir},
          {"episodes", seen.rows},
          {"invalid", seen.invalid},
          {"not_attempted", seen.not_attempted},
          {"chosen", seen.chosen ? Json(*seen.chosen) : Json()},
          {"is_about", seen.is_about},
          {"is_done", seen.is_done()},
          {"is_written", seen.is_written},
          {"until", seen.until},
          {"shards", seen.shards},
          {"begun", seen.begun},
          {"merged", seen.merged},
          {"per_minute", 60 * seen.per_s},
          {"left_s", left ? Json(*left) : Json()},
          {"left", left ? Json(duration_text(*left)) : Json()},
          {"rates", std::move(rates)},
          {"newest_failures", std::move(newest)}};
}

}  // namespace probe::follow
