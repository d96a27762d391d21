// Reads everything, compares, then copies.
#include "runtime/store/merge.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

#include "runtime/base/file.h"
#include "runtime/base/paths.h"
#include "runtime/plan/plan.h"
#include "runtime/store/proof.h"
#include "runtime/store/run_plan.h"
#include "runtime/store/store.h"
#include "runtime/store/video_place.h"

namespace probe::store {
namespace {

namespace fs = std::filesystem;

struct Source {
  std::string dir;
  RunRecord record;
  std::vector<Fingerprint> builds;  // of the folder's first call and of all that are known
  std::vector<RunCall> calls;
  std::set<EpisodeKey> unproven;
  std::vector<OrderedEpisode> order;  // of a run that stops by what it finds
};

// Where the best row of an episode so far is. Rows themselves are read once more when they are
// taken over: those of a million episodes need not be there at once.
struct Chosen {
  const Source* source = nullptr;
  bool is_valid = false;
  std::string trace;  // its hash
};
using AllChosen = std::map<EpisodeKey, Chosen>;

std::string text_of(const ResultRow& row) { return to_text(key_of(row)); }

Result<Source> read_source(const std::string& dir) {
  Source source;
  source.dir = dir;
  auto record = read_run_record(dir);
  if (!record) return Failure{Fault::kUsage, "cannot be merged: " + record.failure().message, dir};
  source.record = std::move(*record);
  source.builds.push_back(source.record.fingerprint);
  PROBE_ASSIGN(source.calls, read_run_calls(dir));
  for (const RunCall& call : source.calls) source.builds.push_back(call.fingerprint);
  PROBE_ASSIGN(const auto unproven, read_unproven(dir));
  source.unproven.insert(unproven.begin(), unproven.end());
  PROBE_ASSIGN(source.order, read_order(dir));
  return source;
}

// Every folder against the first; the first difference is told.
Status check_same_run(const std::vector<Source>& sources, bool mixed_builds,
                      std::vector<std::string>& notes) {
  const Source& first = sources.front();
  const auto differ = [&](const Source& source, const std::string& change) {
    return Failure{Fault::kUsage,
                   change + ", as " + first.dir + " does; they are not parts of one run",
                   source.dir};
  };
  std::set<std::string> told;
  for (const Source& source : sources) {
    RunRecord other = source.record;
    for (const Fingerprint& build : source.builds) {
      other.fingerprint = build;
      const RunChanges changes = changes_between(other, first.record);
      if (!changes.identity.empty()) return differ(source, changes.identity);
      if (!changes.policy_content.empty()) {
        return Failure{Fault::kUsage, changes.policy_content + " than " + first.dir, source.dir};
      }
      if (changes.build.empty()) continue;
      if (!mixed_builds) {
        return Failure{Fault::kUsage,
                       changes.build + " than " + first.dir +
                           "; their bits may differ; --mixed-builds joins them all the same",
                       source.dir};
      }
      const std::string note = source.dir + " " + changes.build + " than " + first.dir;
      if (told.insert(note).second) notes.push_back(note);
    }
  }
  return {};
}

// What answers showed of the server, where the profile left it open, is part of what a run is, and
// so is who answered. Another machine can round otherwise, which only the user knows.
Status check_same_meaning(const std::vector<Source>& sources, bool mixed_builds,
                          std::vector<std::string>& notes) {
  std::vector<RunCall> before;
  std::string whose;
  for (const Source& source : sources) {
    bool is_other = false;
    for (const RunCall& call : source.calls) {
      if (!call.reading) continue;
      const ReadingChanges changes = changes_between(before, *call.reading);
      if (changes.measured) {
        return Failure{
            Fault::kUsage,
            "its server's answers showed other units, forms or rotations than those of " + whose +
                "; they are not parts of one run",
            source.dir};
      }
      is_other = is_other || changes.policy;
      if (whose.empty()) whose = source.dir;
      before.push_back(call);
    }
    if (!is_other) continue;
    const std::string what = "its server answered the first questions otherwise than that of " +
                             whose + ": another policy, or a machine that rounds otherwise";
    if (!mixed_builds) {
      return Failure{Fault::kUsage,
                     what +
                         "; --mixed-builds joins them all the same, and what is shown of the "
                         "folder says so",
                     source.dir};
    }
    notes.push_back(source.dir + ": " + what);
  }
  return {};
}

// The order of all folders together. Where each task has its own, folders may have other tasks; a
// task that two of them have, or an order of all tasks, has to be the same, or it is no beginning of
// an order that stands.
Result<std::vector<OrderedEpisode>> joined_order(const std::vector<Source>& sources) {
  std::vector<OrderedEpisode> joined;
  const bool is_by_task = sources.front().record.identity.until.ends_with(kOfEachTask);
  std::map<std::string, std::vector<OrderedEpisode>> known;  // by task, or all of them
  for (const Source& source : sources) {
    std::map<std::string, std::vector<OrderedEpisode>> here;
    for (const OrderedEpisode& one : source.order)
      here[is_by_task ? one.key.task : std::string()].push_back(one);
    for (auto& [task, order] : here) {
      const auto [at, is_new] = known.try_emplace(task, order);
      if (is_new) {
        joined.insert(joined.end(), order.begin(), order.end());
      } else if (at->second != order) {
        return Failure{Fault::kUsage,
                       (task.empty() ? std::string() : "task `" + task + "`: ") +
                           "stops by what it finds over other episodes than " +
                           sources.front().dir + ": they are not parts of one run",
                       source.dir};
      }
    }
  }
  return joined;
}

// What was shown of the servers goes with the rows; a merge made again adds nothing.
Status take_calls(const std::vector<Source>& sources, Store& store, const std::string& out) {
  PROBE_ASSIGN(const auto there, read_run_calls(out));
  std::set<std::string> known;
  for (const RunCall& call : there) known.insert(call_to_json(call));
  for (const Source& source : sources) {
    for (const RunCall& call : source.calls) {
      if (known.insert(call_to_json(call)).second) PROBE_TRY(store.add_call(call));
    }
  }
  return {};
}

Status choose(const Source& source, const ResultRow& row, AllChosen& chosen,
              MergeSummary& summary) {
  const Chosen here{&source, !row.invalid, row.trace_sha256};
  const auto [at, is_new] = chosen.try_emplace(key_of(row), here);
  if (is_new) return {};
  Chosen& best = at->second;
  ++summary.duplicates;
  if (row.invalid) return {};
  if (!best.is_valid) best = here;
  if (best.trace == here.trace) return {};
  return Failure{Fault::kStore,
                 text_of(row) + " has the trace " + here.trace.substr(0, 12) + " here and " +
                     best.trace.substr(0, 12) + " in " + best.source->dir + "; nothing was merged",
                 source.dir};
}

Status choose_rows(const std::vector<Source>& sources, AllChosen& chosen, MergeSummary& summary) {
  for (const Source& source : sources) {
    PROBE_ASSIGN(const ProvenRun proven, for_each_proven_row(source.dir, [&](ResultRow&& row) {
      return choose(source, row, chosen, summary);
    }));
    summary.left_out += static_cast<int>(proven.refused.size());
    summary.notes.insert(summary.notes.end(), proven.refused.begin(), proven.refused.end());
  }
  return {};
}

Failure not_copied(const Failure& failure, const std::string& from, const std::string& to) {
  return {Fault::kStore, "cannot be copied to " + to + ": " + to_text(failure), from};
}

Status copy_video(const std::string& from, const std::string& out, const EpisodeKey& key) {
  PROBE_ASSIGN(const std::string to, place_for_video(out, key));
  PendingFile pending(to);
  if (auto copied = copy_to_disk(from, pending.temporary()); !copied)
    return not_copied(copied.failure(), from, to);
  return pending.keep();
}

// Takes rows over some hundred at a time: the disk is waited for once for all of them. Traces come
// first, then the rows; a video goes along.
class Taker {
 public:
  Taker(Store& store, const std::string& out) : store_(store), out_(out) {}

  Status add(const Source& source, ResultRow&& row, int task_order) {
    constexpr std::size_t kAtOnce = 1024;
    const EpisodeKey key = key_of(row);
    PROBE_ASSIGN(const std::string temporary, store_.temporary_trace(key));
    if (auto copied = copy_bytes(row.trace, temporary); !copied)
      return not_copied(copied.failure(), row.trace, temporary);
    const std::string video = video_path(source.dir, key);
    if (is_file(video)) PROBE_TRY(copy_video(video, out_, key));
    if (source.unproven.contains(key)) doubted_.push_back(key);
    finished_.push_back({std::move(row), task_order});
    return finished_.size() < kAtOnce ? Status() : end();
  }

  Status end() {
    if (finished_.empty()) return {};
    PROBE_TRY(store_.doubt(doubted_));
    PROBE_TRY(store_.commit(finished_));
    finished_.clear();
    doubted_.clear();
    return {};
  }

 private:
  Store& store_;
  const std::string& out_;
  std::vector<Store::Finished> finished_;
  std::vector<EpisodeKey> doubted_;
};

std::vector<std::string> folders_of(const MergeOptions& options, bool with_out) {
  std::vector<std::string> folders;
  std::set<fs::path> known;
  const auto add = [&](const std::string& dir) {
    std::error_code error;
    const fs::path place = fs::weakly_canonical(dir, error);
    if (known.insert(error ? fs::path(dir) : place).second) folders.push_back(dir);
  };
  if (with_out) add(options.out);
  for (const std::string& dir : options.dirs) add(dir);
  return folders;
}

}  // namespace

Result<MergeSummary> merge(const MergeOptions& options) {
  MergeSummary summary;
  if (options.dirs.empty()) return Failure{Fault::kUsage, "no folder to merge", "DIR"};
  // What is in `out` already goes first, so that it stays as it is wherever it is as good.
  std::vector<Source> sources;
  PROBE_ASSIGN(const auto there, find_run_record(options.out));
  for (const std::string& dir : folders_of(options, there.has_value())) {
    // Its database is made before anything stands in it.
    if (is_there(dir + "/results.sqlite")) {
      PROBE_ASSIGN(const auto record, find_run_record(dir));
      if (!record) {
        summary.notes.push_back(dir + " has no rows: its run was cut off as it began");
        continue;
      }
    }
    PROBE_ASSIGN(Source source, read_source(dir));
    sources.push_back(std::move(source));
  }
  if (sources.empty())
    return Failure{Fault::kUsage, "none of these folders has a run that began",
                   options.dirs.front()};
  PROBE_TRY(check_same_run(sources, options.mixed_builds, summary.notes));
  PROBE_TRY(check_same_meaning(sources, options.mixed_builds, summary.notes));
  PROBE_ASSIGN(const auto order, joined_order(sources));
  AllChosen chosen;
  for (const Source& source : sources) {
    if (auto own = open_run_plan(source.dir); !own) return own.failure();
  }
  PROBE_ASSIGN(const plan::Plan plan, open_run_plan(sources.front().dir));
  PROBE_TRY(choose_rows(sources, chosen, summary));
  if (chosen.empty() && summary.left_out > 0) {
    return Failure{Fault::kStore,
                   "no row of these folders is shown by its trace: " + summary.notes.back(),
                   sources.front().dir};
  }

  RunRecord record = sources.front().record;
  std::set<int> seeds;
  for (const Source& source : sources) {
    seeds.insert(source.record.seeds.begin(), source.record.seeds.end());
    if (source.record.suite != record.suite) {
      summary.notes.push_back(source.dir + " holds episodes of suite `" + source.record.suite +
                              "`, " + sources.front().dir + " of `" + record.suite + "`");
    }
  }
  record.seeds.assign(seeds.begin(), seeds.end());
  PROBE_ASSIGN(auto store, Store::open(options.out, record, plan.bytes()));
  if (!order.empty()) PROBE_TRY(store->set_order(order));
  PROBE_TRY(take_calls(sources, *store, options.out));
  Taker taker(*store, options.out);
  for (const Source& source : sources) {
    PROBE_TRY(for_each_row(source.dir, [&](ResultRow&& row) -> Status {
      const auto best = chosen.find(key_of(row));
      // Not the best one, not proven, or of a run that goes on and has another one now.
      if (best == chosen.end() || best->second.source != &source ||
          best->second.trace != row.trace_sha256 || best->second.is_valid == bool(row.invalid))
        return {};
      ++summary.rows;
      summary.not_attempted.add(row);
      if (is_open(row)) ++summary.invalid;
      if (there && &source == &sources.front()) return {};
      const auto task = plan.find_task(row.task);
      if (!task) {
        return Failure{Fault::kStore, "its plan has no task `" + row.task + "`", source.dir};
      }
      ++summary.added;
      return taker.add(source, std::move(row), static_cast<int>(*task));
    }));
  }
  PROBE_TRY(taker.end());
  return summary;
}

}  // namespace probe::store
