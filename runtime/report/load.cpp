// Folders of runs and of answers, one after the other, into one benchmark.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <tuple>

#include "runtime/ask/answers.h"
#include "runtime/base/hash_number.h"
#include "runtime/base/paths.h"
#include "runtime/base/printable.h"
#include "runtime/report/arrange.h"
#include "runtime/run/delivery.h"
#include "runtime/store/not_attempted.h"
#include "runtime/store/proof.h"
#include "runtime/store/run_plan.h"
#include "runtime/store/store.h"

namespace probe::report {
namespace {

namespace fs = std::filesystem;

// Begins what stands behind the name of a policy whose world did not wait for it: it is compared
// with the same policy in a world that does, and never joined to it.
constexpr std::string_view kLive = " (live, ";
// The same of one that stops by what it finds.
constexpr std::string_view kUntil = " (until ";

Role role_of(std::string_view policy) {
  const std::string_view name = policy.substr(0, std::min({policy.find(':'), policy.find(kLive), policy.find(kUntil)}));
  if (name == "expert") return Role::kCeiling;
  if (name == "null" || name == "idle") return Role::kFloor;
  if (name == "random") return Role::kRandom;
  if (name == "reach" || name == "wrong" || name == "noisy") return Role::kProbe;
  return Role::kModel;
}

// Of many episodes so many failures, and as many successes, of a task are kept as they are stored.
constexpr int kKept = 6;

// Two pictures are equal where these numbers of their hashes are; 0 is for none.
std::uint64_t picture_of(std::string_view hash) {
  if (hash.empty()) return 0;
  return std::max<std::uint64_t>(1, little_endian_number(sha256(hash)));
}

// The first 12 hexadecimal digits of a hash; 0 where it has none.
std::uint64_t trace_of(std::string_view hash) {
  std::uint64_t number = 0;
  const std::string_view digits = hash.substr(0, 12);
  const auto read = std::from_chars(digits.data(), digits.data() + digits.size(), number, 16);
  return read.ptr == digits.data() + 12 ? number : 0;
}

class FolderLoader {
  using Key = std::tuple<int, int, int>;  // task, start, seed

 public:
  explicit FolderLoader(const LoadOptions& options) : options_(options) {}

  Result<Benchmark> load(std::span<const std::string> dirs) {
    if (dirs.empty()) return Failure{Fault::kUsage, "no results folder is named", "DIR"};
    PROBE_TRY(count(dirs));
    std::set<std::string> seen;
    for (const std::string& dir : dirs) {
      std::error_code error;
      const std::string same = fs::weakly_canonical(dir, error).string();
      if (!seen.insert(error ? dir : same).second) {
        note("note", fmt::format("`{}` is named twice and counts once", dir));
        continue;
      }
      PROBE_TRY(ask::holds_answers(dir) ? add_answers(dir) : add_folder(dir));
    }
    PROBE_TRY(all_empty(dirs));
    arrange(benchmark_, plans_, options_.sets);
    return std::move(benchmark_);
  }

 private:
  void note(std::string level, std::string text) {
    benchmark_.notes.push_back({std::move(level), std::move(text)});
  }

  Status all_empty(std::span<const std::string> dirs) const {
    if (!benchmark_.episodes.empty() || !benchmark_.models.empty()) return {};
    std::string names;
    for (const std::string& dir : dirs) names += (names.empty() ? "" : ", ") + dir;
    return Failure{Fault::kUsage, "no episode has been run yet: there is nothing to report", names};
  }

  // Whether all rows are kept. What cannot be counted is told of when it is read.
  Status count(std::span<const std::string> dirs) {
    std::size_t rows = 0;
    for (const std::string& dir : dirs) {
      if (ask::holds_answers(dir)) continue;
      const auto here = store::count_rows(dir);
      if (here) rows += counts_[dir] = *here;
    }
    keeps_all_ = rows <= options_.most_rows;
    return {};
  }

  Status add_folder(const std::string& dir) {
    PROBE_ASSIGN(const store::RunRecord record, store::read_run_record(dir));
    if (record.identity.only_success)
      return Failure{Fault::kUsage, std::string(store::kSuccessesAlone), dir};
    RunInfo info;
    PROBE_ASSIGN(const int plan, plan_of(dir, record));
    info.dir = dir;
    info.plan = plan;
    info.content = record.identity.policy_content;
    info.fingerprint = index_in(benchmark_.fingerprints, record.fingerprint.entries);
    info.seeds = record.seeds;
    if (info.fingerprint > 0) {
      const store::Fingerprint first{benchmark_.fingerprints[0]};
      for (const std::string& line : store::differences(first, record.fingerprint)) {
        index_in(benchmark_.fingerprint_differences, line);
      }
    }
    return add_rows(dir, record, plan, info);
  }

  Status add_answers(const std::string& dir) {
    PROBE_ASSIGN(const ask::AskRecord record, ask::read_ask_record(dir));
    PROBE_ASSIGN(plan::Plan asked, ask::open_asked_plan(dir));
    const int index = plans_.add(std::move(asked), record.suite);
    PROBE_ASSIGN(AskedModel model,
                 read_asked_model(dir, benchmark_.plan_files[static_cast<std::size_t>(index)]));
    model.plan = index;
    model.name = printable(model.name, kLongestText);
    const PlanTasks& map = plans_.map(index);
    for (AskedModel::Known& known : model.known) {
      const auto task = static_cast<std::size_t>(known.task);
      known.start = map.start[task][static_cast<std::size_t>(known.start)];
      known.task = map.task[task];
    }
    for (const std::string& finding : model.findings)
      note("bad", fmt::format("`{}`: {}", dir, finding));
    for (const std::string& doubt : model.doubts)
      note("bad", printable(fmt::format("`{}`: {}", dir, doubt), kLongestText));
    benchmark_.models.push_back(std::move(model));
    return {};
  }

  // The rows that count. `live`: of a run whose world does not wait, how its policy answered.
  Status each_row(const std::string& dir, std::string* live, const store::RowVisitor& visit) {
    constexpr std::size_t kTold = 5;
    if (!options_.prove) return store::for_each_row(dir, visit);
    PROBE_ASSIGN(const store::ProvenRun proven, store::for_each_proven_row(dir, visit));
    const auto& refused = proven.refused;
    benchmark_.unborne += refused.size();
    for (std::size_t i = 0; i < refused.size() && i < kTold; ++i) {
      note("bad", printable(refused[i], kLongestText));
    }
    if (refused.size() > kTold) {
      note("bad", fmt::format("{} more rows of `{}` are left out, because their traces do not bear "
                              "them",
                              refused.size() - kTold, dir));
    }
    if (!proven.live_terms.empty()) *live = to_text(proven.live);
    return {};
  }

  // Opens the folder's plan, or finds the one with the same root.
  Result<int> plan_of(const std::string& dir, const store::RunRecord& record) {
    auto plan = store::open_run_plan(dir);
    if (!plan) return plan.failure();
    const std::string root = to_hex(plan->root());
    if (root != record.identity.plan_root) {
      return Failure{Fault::kStore, "the folder's plan is not the one its results were made with",
                     store::plan_path(dir)};
    }
    return plans_.add(std::move(plan).value(), record.suite);
  }

  Status add_rows(const std::string& dir, const store::RunRecord& record, int plan,
                  RunInfo& info) {
    const plan::Plan& file = benchmark_.plan_files[static_cast<std::size_t>(plan)];
    const PlanTasks& map = plans_.map(plan);
    run::Delivery delivery(file);
    std::vector<Episode> episodes;
    episodes.reserve(counts_[dir]);
    std::vector<char> has_task(benchmark_.tasks.size(), 0);
    std::map<int, std::array<int, 2>> kept;  // failures and successes, by task
    std::size_t unknown = 0;
    std::string last;  // task
    std::optional<std::uint32_t> task;
    const bool has_videos = is_folder(dir + "/videos");
    PROBE_ASSIGN(const auto adaptive, adaptive::read_adaptive(dir));
    std::map<store::EpisodeKey, std::size_t> places;
    for (std::size_t i = 0; adaptive && i < adaptive->order.size(); ++i)
      places.emplace(adaptive->order[i].key, i);
    std::vector<bool> has_row(places.size());
    std::vector<std::size_t> place_of;  // by episode
    PROBE_TRY(each_row(dir, &info.live, [&](store::ResultRow&& row) -> Status {
      delivery.add(row);
      // A task's rows stand together.
      if (row.task != last || last.empty()) task = file.find_task(last = row.task);
      if (!task || row.episode < 0 ||
          static_cast<std::size_t>(row.episode) >= map.start[*task].size()) {
        ++unknown;
        return {};
      }
      Episode episode;
      episode.task = map.task[*task];
      episode.start = map.start[*task][static_cast<std::size_t>(row.episode)];
      episode.seed = row.seed;
      episode.plan = plan;
      episode.steps = row.steps;
      episode.is_open = store::is_open(row);
      episode.is_prompted = !row.prompt_sha256.empty();
      episode.picture = picture_of(row.image_sha256);
      episode.trace = trace_of(row.trace_sha256);
      bool succeeded = false;
      if (row.invalid) {
        episode.reason = number_of(benchmark_.reasons, reasons_, printable(*row.invalid, kLongestText));
        info.not_attempted.add(row);
        if (episode.is_open) ++info.invalid;
      } else {
        for (const store::MetricValue& value : row.metrics) {
          const auto m = static_cast<std::size_t>(plans_.metric(value.name, value.is_bool));
          if (!value.is_bool) {
            if (episode.numbers.size() <= m) episode.numbers.resize(m + 1, std::nan(""));
            episode.numbers[m] = value.value;
          } else if (value.value != 0) {
            episode.truths.set(m);
            succeeded = succeeded || value.name == "success";
          }
        }
      }
      if (row.remark) episode.remark = number_of(benchmark_.remarks, remarks_, *row.remark);
      episode.prompt = prompt_of(row.sent_prompt_sha256.value_or(row.prompt_sha256));
      if (has_videos) {
        std::string video =
            fmt::format("{}/videos/{}/{}-{}.mp4", dir, row.task, row.episode, row.seed);
        if (is_there(video)) {
          episode.video = std::move(video);
          ++info.videos;
        }
      }
      if (adaptive) {
        const auto place = places.find(store::key_of(row));
        if (place == places.end()) return {};
        has_row[place->second] = true;
        place_of.push_back(place->second);
      }
      has_task.resize(std::max(has_task.size(), benchmark_.tasks.size()), 0);
      has_task[static_cast<std::size_t>(episode.task)] = 1;
      if (keeps_all_ || (!row.invalid && kept[episode.task][succeeded ? 1 : 0]++ < kKept)) {
        episode.row = static_cast<int>(benchmark_.rows.size());
        benchmark_.rows.push_back(std::move(row));
      }
      episodes.push_back(std::move(episode));
      return {};
    }));
    const auto findings = delivery.findings();
    note_delivery(dir, findings);
    note_reading(dir, info);
    if (unknown > 0) {
      note("warn", fmt::format("{} rows of `{}` name tasks or starts that its plan does not have; "
                               "they are left out",
                               unknown, dir));
    }
    info.done = static_cast<int>(episodes.size());
    info.tasks = static_cast<int>(std::count(has_task.begin(), has_task.end(), 1));
    const PlanInfo& of_plan = benchmark_.plans[static_cast<std::size_t>(plan)];
    info.expected =
        of_plan.starts * static_cast<int>(std::max<std::size_t>(1, record.seeds.size()));
    std::optional<AdaptivePolicy> of_policy;
    if (adaptive) of_policy = leave_counted(dir, *adaptive, file, map, has_row, place_of, info, episodes);
    std::string name = printable(record.identity.policy, kLongestText);
    if (!record.identity.live.empty())
      name += " (" + printable(record.identity.live, kLongestText) + ")";
    if (adaptive)
      name += std::string(kUntil) +
              printable(adaptive::in_words(to_text(adaptive->rule)), kLongestText) + ")";
    place_run(name, std::move(info), std::move(episodes), std::move(of_policy));
    return {};
  }

  // Of a run that stops by what it finds, the episodes that count; and what its policy is told by.
  AdaptivePolicy leave_counted(const std::string& dir, const adaptive::AdaptiveRun& run,
                               const plan::Plan& file, const PlanTasks& map,
                               const std::vector<bool>& has_row,
                               const std::vector<std::size_t>& place_of, RunInfo& info,
                               std::vector<Episode>& episodes) {
    AdaptivePolicy out{run.rule, run.drawing};
    out.seeds = adaptive::seeds_of(run.order);
    for (const store::OrderedEpisode& one : run.order) {
      const auto task = file.find_task(one.key.task);
      const auto start = static_cast<std::size_t>(one.key.episode);
      // A place that nobody can have is a gap for good.
      if (!task || one.key.episode < 0 || start >= map.start[*task].size()) {
        out.order.push_back({kAbsent, kAbsent, one.key.seed});
      } else {
        out.order.push_back({map.task[*task], map.start[*task][start], one.key.seed});
      }
    }
    const std::vector<bool> counted = adaptive::counted_places(run, has_row);
    std::vector<Episode> left;
    for (std::size_t i = 0; i < episodes.size(); ++i)
      if (counted[place_of[i]]) left.push_back(std::move(episodes[i]));
    note("note", fmt::format("`{}`, until {}: {} of {} episodes count; its rates have intervals "
                             "that hold whenever it stopped, of what all {} would have. Left out are "
                             "its differences, rankings and models: {}",
                             dir, printable(adaptive::in_words(to_text(run.rule)), kLongestText),
                             left.size(), run.order.size(),
                             run.order.size(), adaptive::why_not_fixed(to_text(run.rule))));
    if (left.size() < episodes.size())
      note("warn", fmt::format("`{}`: {} rows do not count yet, since episodes before them in its "
                               "order are missing",
                               dir, episodes.size() - left.size()));
    episodes = std::move(left);
    // It is not meant to have the others.
    info.expected = static_cast<int>(episodes.size());
    info.done = info.expected;
    return out;
  }

  // Of a text in a list that has each once; `known` has their numbers.
  static int number_of(std::vector<std::string>& list, std::map<std::string, int>& known,
                       std::string text) {
    const auto [at, is_new] = known.try_emplace(text, static_cast<int>(list.size()));
    if (is_new) list.push_back(std::move(text));
    return at->second;
  }

  int prompt_of(const std::string& hash) {
    while (hashed_ < benchmark_.prompts.size()) {
      prompt_hashes_.emplace(to_hex(probe::sha256(benchmark_.prompts[hashed_])),
                             static_cast<int>(hashed_));
      ++hashed_;
    }
    const auto found = prompt_hashes_.find(hash);
    return found == prompt_hashes_.end() ? kAbsent : found->second;
  }

  // Joins a run to a policy of its name whose episodes are others, as shards' are.
  void place_run(const std::string& name, RunInfo info, std::vector<Episode> episodes,
                 std::optional<AdaptivePolicy> of_policy) {
    std::vector<Key> keys;
    keys.reserve(episodes.size());
    for (const Episode& e : episodes) keys.emplace_back(e.task, e.start, e.seed);
    std::sort(keys.begin(), keys.end());
    // Two orders are no order: shards of such a run are joined by `merge`.
    const bool joins = options_.join && !of_policy;
    std::size_t policy = joins ? 0 : benchmark_.policies.size();
    for (; policy < benchmark_.policies.size(); ++policy) {
      if (benchmark_.policies[policy].name == name && !benchmark_.policies[policy].adaptive &&
          !meets(held_[policy], keys))
        break;
    }
    if (policy == benchmark_.policies.size()) {
      benchmark_.policies.push_back({name, name, role_of(name), {}, std::move(of_policy)});
      held_.emplace_back();
    }
    const auto middle = static_cast<std::ptrdiff_t>(held_[policy].size());
    held_[policy].insert(held_[policy].end(), keys.begin(), keys.end());
    std::inplace_merge(held_[policy].begin(), held_[policy].begin() + middle, held_[policy].end());
    for (Episode& e : episodes) e.policy = static_cast<int>(policy);
    if (benchmark_.episodes.empty()) {
      benchmark_.episodes = std::move(episodes);
    } else {
      benchmark_.episodes.insert(benchmark_.episodes.end(),
                                 std::make_move_iterator(episodes.begin()),
                                 std::make_move_iterator(episodes.end()));
    }
    benchmark_.policies[policy].runs.push_back(std::move(info));
  }

  static bool meets(const std::vector<Key>& a, const std::vector<Key>& b) {
    for (auto i = a.begin(), j = b.begin(); i != a.end() && j != b.end();) {
      if (*i == *j) return true;
      *i < *j ? ++i : ++j;
    }
    return false;
  }

  // What was meant to differ and reached the policy equal.
  void note_delivery(const std::string& dir, std::span<const run::DeliveryFinding> findings) {
    for (std::size_t i = 0; i < findings.size() && i < kNamed; ++i)
      note("bad", fmt::format("`{}`: {}", dir, findings[i].sentence));
    if (findings.size() > kNamed) {
      note("bad",
           fmt::format("`{}`: {} more findings of that kind; `vlaprobe results {} --delivery` "
                       "lists them",
                       dir, findings.size() - kNamed, dir));
    }
  }

  // What the questions at the beginning of its calls showed. A folder whose calls cannot be read
  // has been told of with its rows.
  void note_reading(const std::string& dir, RunInfo& info) {
    auto reading = store::read_reading_summary(dir);
    if (!reading) return;
    info.reading = std::move(*reading);
    for (const std::string& finding : info.reading.findings)
      note("bad", fmt::format("`{}`: {}", dir, finding));
  }

  const LoadOptions& options_;
  bool keeps_all_ = true;
  std::map<std::string, std::size_t> counts_;  // of rows, by folder
  Benchmark benchmark_;
  JoinedPlans plans_{benchmark_};
  std::map<std::string, int> reasons_, remarks_;
  std::map<std::string, int> prompt_hashes_;
  std::size_t hashed_ = 0;
  std::vector<std::vector<Key>> held_;  // by policy, ascending
};

}  // namespace

Result<Benchmark> load(std::span<const std::string> dirs, const LoadOptions& options) {
  return FolderLoader(options).load(dirs);
}

}  // namespace probe::report
