// Folders of runs and of answers, one after the other, into one benchmark.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <tuple>

#include "runtime/ask/answers.h"
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

Role role_of(std::string_view policy) {
  const std::string_view name = policy.substr(0, std::min(policy.find(':'), policy.find(kLive)));
  if (name == "expert") return Role::kCeiling;
  if (name == "null" || name == "idle") return Role::kFloor;
  if (name == "random") return Role::kRandom;
  if (name == "reach" || name == "wrong" || name == "noisy") return Role::kProbe;
  return Role::kModel;
}

class FolderLoader {
 public:
  explicit FolderLoader(const LoadOptions& options) : options_(options) {}

  Result<Benchmark> load(std::span<const std::string> dirs) {
    if (dirs.empty()) return Failure{Fault::kUsage, "no results folder is named", "DIR"};
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

  Status add_folder(const std::string& dir) {
    PROBE_ASSIGN(const store::RunRecord record, store::read_run_record(dir));
    if (record.identity.only_success)
      return Failure{Fault::kUsage, std::string(store::kSuccessesAlone), dir};
    RunInfo info;
    PROBE_ASSIGN(std::vector<store::ResultRow> rows, rows_of(dir, &info.live));
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
    add_rows(dir, record, plan, std::move(rows), info);
    return {};
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

  // `live`: of a run whose world does not wait, how its policy answered.
  Result<std::vector<store::ResultRow>> rows_of(const std::string& dir, std::string* live) {
    constexpr std::size_t kTold = 5;
    if (!options_.prove) return store::read_results(dir);
    PROBE_ASSIGN(store::ProvenResults proven, store::read_proven_results(dir));
    const auto& refused = proven.refused;
    for (std::size_t i = 0; i < refused.size() && i < kTold; ++i) {
      note("bad", printable(refused[i], kLongestText));
    }
    if (refused.size() > kTold) {
      note("bad", fmt::format("{} more rows of `{}` are left out, because their traces do not bear "
                              "them",
                              refused.size() - kTold, dir));
    }
    if (!proven.live_terms.empty()) *live = to_text(proven.live);
    return std::move(proven.rows);
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

  void add_rows(const std::string& dir, const store::RunRecord& record, int plan,
                std::vector<store::ResultRow> rows, RunInfo& info) {
    const plan::Plan& file = benchmark_.plan_files[static_cast<std::size_t>(plan)];
    const PlanTasks& map = plans_.map(plan);
    note_delivery(dir, file, rows);
    note_reading(dir, info);
    std::vector<Episode> episodes;
    std::set<int> tasks;
    std::size_t unknown = 0;
    for (store::ResultRow& row : rows) {
      const auto task = file.find_task(row.task);
      if (!task || row.episode < 0 ||
          static_cast<std::size_t>(row.episode) >= map.start[*task].size()) {
        ++unknown;
        continue;
      }
      Episode episode;
      episode.task = map.task[*task];
      episode.start = map.start[*task][static_cast<std::size_t>(row.episode)];
      episode.plan = plan;
      if (row.invalid) {
        episode.reason = index_in(benchmark_.reasons, printable(*row.invalid, kLongestText));
        info.not_attempted.add(row);
        if (store::is_open(row)) ++info.invalid;
      } else {
        for (const store::MetricValue& value : row.metrics) {
          const int m = plans_.metric(value.name, value.is_bool);
          if (value.is_bool && value.value != 0) set_true(episode.truths, m);
        }
      }
      episode.prompt = prompt_of(row.sent_prompt_sha256.value_or(row.prompt_sha256));
      const fs::path video =
          fs::path(dir) / "videos" / row.task / fmt::format("{}-{}.mp4", row.episode, row.seed);
      if (std::error_code ignored; fs::exists(video, ignored)) {
        episode.video = video.string();
        ++info.videos;
      }
      tasks.insert(episode.task);
      episode.row = std::move(row);
      episodes.push_back(std::move(episode));
    }
    if (unknown > 0) {
      note("warn", fmt::format("{} rows of `{}` name tasks or starts that its plan does not have; "
                               "they are left out",
                               unknown, dir));
    }
    info.done = static_cast<int>(episodes.size());
    info.tasks = static_cast<int>(tasks.size());
    const PlanInfo& of_plan = benchmark_.plans[static_cast<std::size_t>(plan)];
    info.expected =
        of_plan.starts * static_cast<int>(std::max<std::size_t>(1, record.seeds.size()));
    std::string name = printable(record.identity.policy, kLongestText);
    if (!record.identity.live.empty())
      name += " (" + printable(record.identity.live, kLongestText) + ")";
    place_run(name, std::move(info), std::move(episodes));
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
  void place_run(const std::string& name, RunInfo info, std::vector<Episode> episodes) {
    using Key = std::tuple<int, int, int>;
    std::set<Key> keys;
    for (const Episode& e : episodes) keys.emplace(e.task, e.start, e.row.seed);
    std::size_t policy = options_.join ? 0 : benchmark_.policies.size();
    for (; policy < benchmark_.policies.size(); ++policy) {
      if (benchmark_.policies[policy].name != name) continue;
      const auto& held = held_[policy];
      if (std::none_of(keys.begin(), keys.end(), [&](const Key& k) { return held.contains(k); }))
        break;
    }
    if (policy == benchmark_.policies.size()) {
      benchmark_.policies.push_back({name, name, role_of(name), {}});
      held_.emplace_back();
    }
    held_[policy].insert(keys.begin(), keys.end());
    for (Episode& e : episodes) {
      e.policy = static_cast<int>(policy);
      benchmark_.episodes.push_back(std::move(e));
    }
    benchmark_.policies[policy].runs.push_back(std::move(info));
  }

  // What was meant to differ and reached the policy equal.
  void note_delivery(const std::string& dir, const plan::Plan& plan,
                     std::span<const store::ResultRow> rows) {
    const auto findings = run::check_delivery(plan, rows);
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
  Benchmark benchmark_;
  JoinedPlans plans_{benchmark_};
  std::map<std::string, int> prompt_hashes_;
  std::size_t hashed_ = 0;
  std::vector<std::set<std::tuple<int, int, int>>> held_;  // by policy
};

}  // namespace

Result<Benchmark> load(std::span<const std::string> dirs, const LoadOptions& options) {
  return FolderLoader(options).load(dirs);
}

}  // namespace probe::report
