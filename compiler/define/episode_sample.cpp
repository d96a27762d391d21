#include "compiler/define/episode_sample.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "compiler/define/starts.h"
#include "runtime/base/sha256.h"

namespace probe::sema {
namespace {

using Episode = std::pair<TaskId, std::uint32_t>;

class Sampler {
 public:
  Sampler(Context& context, Suite& suite)
      : context_(context), suite_(suite), whole_(suite.members.begin(), suite.members.end()) {}

  void run(const std::vector<EpisodeSample>& samples) {
    std::vector<std::pair<const EpisodeSample*, std::vector<Episode>>> all;
    for (const EpisodeSample& sample : samples) all.emplace_back(&sample, draw(sample));
    for (const auto& [sample, drawn] : all) {
      for (const Episode& episode : drawn) kept_[episode.first].insert(episode.second);
    }
    for (const auto& [sample, drawn] : all) {
      if (!sample->stmt->with_baselines) continue;
      for (const Episode& episode : drawn) keep_compared(episode);
    }
    for (const auto& [sample, drawn] : all) {
      for (const TaskId id : sample->of) add_member(id);
      find_cuts(sample->stmt->span, drawn);
    }
    for (const auto& [id, starts] : kept_)
      suite_.drawn[id] = std::vector<std::uint32_t>(starts.begin(), starts.end());
  }

 private:
  const Task& task(TaskId id) const { return context_.model.tasks[id]; }

  // Nothing where the statement is wrong, or something else was.
  std::vector<Episode> draw(const EpisodeSample& sample) {
    const syntax::SuiteSampleStmt& stmt = *sample.stmt;
    std::vector<std::pair<Sha256, Episode>> draws;
    for (const TaskId id : sample.of) {
      const std::string& name = task(id).name;
      if (whole_.contains(id)) {
        context_.report(Code::P0203, stmt.span, "`" + name + "` is run whole by `tasks`")
            .help("draw from what is not: a set without it, `S - { " + name + " }`");
        return {};
      }
      if (!sampled_.insert(id).second) {
        context_.report(Code::P0203, stmt.span, "`" + name + "` is drawn from by another sample");
        return {};
      }
      if (task(id).starts.empty()) return {};  // reported
      for (std::uint32_t start = 0; start < task(id).starts.size(); ++start) {
        Hasher hasher;
        hasher.text("sample episode").u64(stmt.seed.value).text(name).u64(start);
        draws.emplace_back(hasher.finish(), Episode{id, start});
      }
    }
    const bool torn = stmt.of.value == syntax::TaskSetId::kNone;
    if (stmt.count.value > draws.size() || stmt.count.value == 0) {
      if (torn || sample.of.empty()) return {};  // reported, or a suite without tasks
      context_.report(Situation::kSampleTooLarge, stmt.count.span,
                      "a sample of " + std::to_string(stmt.count.value) + " from a set of " +
                          std::to_string(draws.size()) + " episodes");
      return {};
    }
    std::sort(draws.begin(), draws.end());
    std::vector<Episode> drawn;
    for (std::size_t i = 0; i < stmt.count.value; ++i) drawn.push_back(draws[i].second);
    return drawn;
  }

  // What an episode is compared with is run from the same start, and so is what that is compared
  // with; where starts do not correspond, from all.
  void keep_compared(Episode episode) {
    for (std::size_t depth = 0; depth <= context_.model.tasks.size(); ++depth) {
      const TaskId baseline = task(episode.first).baseline;
      if (baseline == TaskId::kNone || whole_.contains(baseline)) return;
      if (!correspond(episode.first)) {
        std::set<std::uint32_t>& kept = kept_[baseline];
        for (std::uint32_t start = 0; start < task(baseline).starts.size(); ++start)
          kept.insert(kept.end(), start);
      } else {
        kept_[baseline].insert(episode.second);
      }
      episode.first = baseline;
    }
  }

  bool correspond(TaskId variant) {
    const auto [at, is_new] = correspond_.try_emplace(variant, false);
    if (is_new) at->second = starts_correspond(task(variant), task(task(variant).baseline));
    return at->second;
  }

  // Behind what it is compared with.
  void add_member(TaskId id) {
    std::vector<TaskId> chain;
    for (TaskId at = id; at != TaskId::kNone && chain.size() <= context_.model.tasks.size();
         at = task(at).baseline)
      chain.push_back(at);
    for (auto at = chain.rbegin(); at != chain.rend(); ++at) {
      if (kept_.contains(*at) && added_.insert(*at).second) suite_.members.push_back(*at);
    }
  }

  void find_cuts(const Span& span, const std::vector<Episode>& drawn) {
    std::map<TaskId, std::size_t> lacking;
    for (const auto& [id, start] : drawn) {
      const TaskId baseline = task(id).baseline;
      if (baseline == TaskId::kNone || whole_.contains(baseline)) continue;
      const auto kept = kept_.find(baseline);
      if (kept == kept_.end() || (correspond(id) && !kept->second.contains(start))) ++lacking[id];
    }
    for (const auto& [id, episodes] : lacking) suite_.cuts.push_back({id, span, episodes});
  }

  Context& context_;
  Suite& suite_;
  std::set<TaskId> whole_;    // what `tasks` says
  std::set<TaskId> sampled_;  // what samples are of
  std::set<TaskId> added_;
  std::map<TaskId, std::set<std::uint32_t>> kept_;
  std::map<TaskId, bool> correspond_;  // by variant
};

}  // namespace

void sample_episodes(Context& context, const std::vector<EpisodeSample>& samples, Suite& suite) {
  Sampler(context, suite).run(samples);
}

}  // namespace probe::sema
