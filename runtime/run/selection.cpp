// From options to jobs.
#include "runtime/run/selection.h"

#include <algorithm>
#include <numeric>
#include <set>

#include "runtime/base/glob.h"
#include "runtime/base/hash_number.h"
#include "runtime/base/spelling.h"
#include "runtime/store/episode_key.h"

namespace probe::run {
namespace {

Failure usage(const std::string& message, const char* where) {
  return {Fault::kUsage, message, where};
}

// The suite to run: the named one, else the first, else none.
Result<const plan::SuiteRecord*> choose_suite(const plan::Plan& plan, const std::string& name) {
  const auto suites = plan.suites();
  if (name.empty()) return suites.empty() ? nullptr : suites.data();
  if (const auto index = plan.find_suite(name)) return &suites[*index];
  std::string known;
  std::vector<std::string> names;
  for (const plan::SuiteRecord& suite : suites) {
    names.emplace_back(plan.text(suite.name));
    known += (known.empty() ? "" : ", ") + names.back();
  }
  const std::string near = did_you_mean(name, names);
  return usage("no suite `" + name + "`" +
                   (near.empty() ? "; the plan has " + (known.empty() ? "none" : known) : near),
               "--suite");
}

// The nearest name of a task, or all of them, each on its line.
Failure no_task(const std::string& glob, const std::vector<std::string>& names) {
  std::string message = "no task is called `" + glob + "`";
  const std::string near = did_you_mean(glob, names);
  if (!near.empty()) return usage(message + near, "--tasks");
  message += "; the tasks are:";
  for (const std::string& name : names) message += "\n  " + name;
  return usage(message, "--tasks");
}

// All of a task's, or those that a suite drew.
std::vector<std::uint32_t> episodes_of(const plan::Plan& plan, const plan::SuiteRecord* suite,
                                       std::uint32_t task) {
  if (suite != nullptr) return plan.episodes(*suite, task);
  std::vector<std::uint32_t> all(plan.tasks()[task].episodes.count);
  std::iota(all.begin(), all.end(), 0u);
  return all;
}

using store::EpisodeKey;

std::set<EpisodeKey> keys_of(const std::vector<store::ResultRow>* rows) {
  std::set<EpisodeKey> keys;
  if (rows != nullptr) {
    for (const store::ResultRow& row : *rows) keys.insert(store::key_of(row));
  }
  return keys;
}

}  // namespace

int shard_of(const Sha256& episode_id, int seed, int shards) {
  const Sha256 hash = Hasher()
                          .text("shard")
                          .hash(episode_id)
                          .u64(static_cast<std::uint64_t>(static_cast<std::int64_t>(seed)))
                          .finish();
  return 1 + static_cast<int>(little_endian_number(hash) % static_cast<std::uint64_t>(shards));
}

namespace {

// Where each task stops by itself, its episodes stay together.
int shard_of_task(std::string_view task, int shards) {
  const Sha256 hash = Hasher().text("shard of tasks").text(task).finish();
  return 1 + static_cast<int>(little_endian_number(hash) % static_cast<std::uint64_t>(shards));
}

}  // namespace

Result<Selection> select_jobs(const plan::Plan& plan, const RunOptions& options, bool draws,
                              const std::vector<store::ResultRow>* recorded) {
  if (options.shards < 1 || options.shard < 1 || options.shard > options.shards) {
    return usage("shard " + std::to_string(options.shard) + "/" + std::to_string(options.shards) +
                     " is not one of 1/N .. N/N",
                 "--shard");
  }
  PROBE_ASSIGN(const plan::SuiteRecord* suite, choose_suite(plan, options.suite));

  Selection selection;
  std::vector<std::uint32_t> tasks;
  if (suite != nullptr) {
    selection.suite = std::string(plan.text(suite->name));
    if (options.suite.empty() && plan.suites().size() > 1) {
      selection.notes.push_back("suite `" + selection.suite + "`, the first of " +
                                std::to_string(plan.suites().size()) + "; --suite names another");
    }
    const auto members = plan.members(*suite);
    tasks.assign(members.begin(), members.end());
  } else {
    tasks.resize(plan.tasks().size());
    std::iota(tasks.begin(), tasks.end(), 0u);
  }
  const std::string prefix(suite == nullptr ? "" : plan.text(suite->prefix));
  std::vector<std::string> names;
  std::erase_if(tasks, [&](std::uint32_t task) {
    const std::string name(plan.text(plan.tasks()[task].name));
    names.push_back(name);
    return !matches_glob(options.tasks, name) && !matches_glob(options.tasks, prefix + name);
  });
  if (options.originals) {
    if (tasks.empty()) return no_task(options.tasks, names);
    std::erase_if(tasks,
                  [&](std::uint32_t task) { return plan.tasks()[task].baseline != plan::kNone; });
    if (tasks.empty()) {
      return usage("every chosen task is a variant of another, none is an original", "--tasks");
    }
  }
  std::sort(tasks.begin(), tasks.end());
  tasks.erase(std::unique(tasks.begin(), tasks.end()), tasks.end());
  if (tasks.empty()) return no_task(options.tasks, names);

  const std::set<EpisodeKey> held = keys_of(recorded);
  selection.seeds = options.seeds;
  if (selection.seeds.empty()) {
    for (const EpisodeKey& key : held) selection.seeds.push_back(key.seed);
  }
  if (selection.seeds.empty()) {
    if (suite != nullptr) {
      for (const std::uint32_t seed : plan.seeds(*suite))
        selection.seeds.push_back(static_cast<int>(seed));
    }
    if (selection.seeds.empty()) selection.seeds.push_back(0);
    if (!draws && selection.seeds.size() > 1) {
      selection.seeds.erase(selection.seeds.begin() + 1, selection.seeds.end());
      selection.notes.push_back("policy `" + options.policy +
                                "` draws nothing, so every start runs once, with seed " +
                                std::to_string(selection.seeds[0]) + "; --seeds runs more");
    }
  }
  std::sort(selection.seeds.begin(), selection.seeds.end());
  selection.seeds.erase(std::unique(selection.seeds.begin(), selection.seeds.end()),
                        selection.seeds.end());

  const bool keeps_tasks = options.until && options.until->kind == adaptive::Rule::Kind::kEachTask;
  bool any = false, any_held = recorded == nullptr;
  for (const std::uint32_t task : tasks) {
    for (const std::uint32_t index : episodes_of(plan, suite, task)) {
      if (options.episodes && (static_cast<int>(index) < options.episodes->first ||
                               static_cast<int>(index) > options.episodes->second)) {
        continue;
      }
      any = true;
      for (const int seed : selection.seeds) {
        if (recorded != nullptr) {
          if (!held.contains(key_of(plan, {task, index, seed}))) continue;
          any_held = true;
        }
        const Sha256 id{plan.episodes(plan.tasks()[task])[index].episode_id};
        const int shard = keeps_tasks ? shard_of_task(plan.text(plan.tasks()[task].name), options.shards)
                                      : shard_of(id, seed, options.shards);
        if (shard == options.shard) {
          selection.jobs.push_back({task, index, seed});
        }
      }
    }
  }
  if (!any) {
    return usage("no chosen task has an episode from " + std::to_string(options.episodes->first) +
                     " to " + std::to_string(options.episodes->second),
                 "--episodes");
  }
  if (!any_held) {
    return usage("the run to replay holds none of the chosen tasks, episodes and seeds",
                 "--policy");
  }
  return selection;
}

}  // namespace probe::run
