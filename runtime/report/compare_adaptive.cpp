#include "runtime/report/compare_adaptive.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <tuple>

#include "runtime/adaptive/decision.h"
#include "runtime/report/tables.h"
#include "runtime/stats/multiplicity.h"

namespace probe::report {
namespace {

using adaptive::Rule;
using Key = std::tuple<int, int, int>;  // task, start, seed

const AdaptivePolicy& adaptive_of(const Benchmark& benchmark, int policy) {
  return *benchmark.policies[static_cast<std::size_t>(policy)].adaptive;
}

std::map<Key, const Episode*> episodes_of(const Benchmark& benchmark, int policy) {
  std::map<Key, const Episode*> episodes;
  for (const int task : benchmark.all_tasks()) {
    for (const Episode& e : benchmark.of(policy, task)) episodes[{task, e.start, e.seed}] = &e;
  }
  return episodes;
}

// Why no comparison of `policy`, whose order it is in, holds at any time; empty: it does.
std::string why_not(const Benchmark& benchmark, int policy, int other) {
  const AdaptivePolicy& of = adaptive_of(benchmark, policy);
  if (of.seeds.size() > 1 && of.rule.kind != Rule::Kind::kDecided)
    return "its order takes the seeds of a start apart, so it stops with starts half done; run with "
           "--until \"decided-against DIR\", or with one seed";
  if (of.rule.kind == Rule::Kind::kEachTask && of.drawing != stats::Drawing::kInTurn)
    return "calls of it were cut off, so nobody can say by what the next task was chosen";
  if (!benchmark.is_adaptive(other)) return "";
  const AdaptivePolicy& theirs = adaptive_of(benchmark, other);
  if (of.rule.kind == Rule::Kind::kEachTask || theirs.rule.kind == Rule::Kind::kEachTask ||
      of.order != theirs.order) {
    return "the other one stops by what it finds, too, in another order: which starts both have "
           "depends on both";
  }
  return "";
}

}  // namespace

Result<std::vector<AnytimeRow>> compare_at_any_time(const Benchmark& benchmark, int a, int b,
                                                    const std::vector<int>& metrics) {
  const bool is_mirrored = !benchmark.is_adaptive(a);
  const int first = is_mirrored ? b : a, second = is_mirrored ? a : b;
  const AdaptivePolicy& of = adaptive_of(benchmark, first);
  if (const std::string why = why_not(benchmark, first, second); !why.empty()) {
    return Failure{
        Fault::kUsage,
        fmt::format("`{}` and `{}` are not compared: {} of the first, and {}; `run --until none` "
                    "runs the others",
                    benchmark.policies[static_cast<std::size_t>(first)].label,
                    benchmark.policies[static_cast<std::size_t>(second)].label,
                    adaptive::why_not_fixed(to_text(of.rule)), why),
        ""};
  }
  const auto ours = episodes_of(benchmark, first), theirs = episodes_of(benchmark, second);
  std::vector<AnytimeRow> rows;
  for (const int metric : metrics) {
    AnytimeRow row{.metric = metric};
    adaptive::Decision decision;
    std::vector<std::pair<adaptive::Outcome, bool>> start;
    bool has_ended = false;  // the other one, which stops by what it finds as well
    for (std::size_t place = 0; place < of.order.size();) {
      const AdaptivePolicy::Place& at = of.order[place];
      bool is_whole = true, is_shared = true;
      start.clear();
      std::size_t end = place;
      for (; end < of.order.size() && of.order[end].task == at.task &&
             of.order[end].start == at.start;
           ++end) {
        const Key key{at.task, at.start, of.order[end].seed};
        const auto our = ours.find(key), their = theirs.find(key);
        is_whole = is_whole && our != ours.end();
        is_shared = is_shared && their != theirs.end();
        if (our == ours.end() || their == theirs.end()) continue;
        const auto outcome = outcome_of(*our->second, metric);
        const auto other = outcome_of(*their->second, metric);
        const bool is_known = other == adaptive::Outcome::kSuccess || other == adaptive::Outcome::kFailure;
        // What nobody knows counts against whatever is to be decided: of the other one, as won and
        // as lost.
        if (!is_known) start.emplace_back(adaptive::Outcome::kUnknown, true);
        start.emplace_back(is_known ? outcome : adaptive::Outcome::kUnknown,
                           other == adaptive::Outcome::kSuccess);
      }
      place = end;
      // Behind a gap the next task's starts may count, where each stops by itself.
      has_ended = has_ended || (!is_shared && benchmark.is_adaptive(second));
      if (!is_whole || !is_shared || has_ended) {
        if (is_whole) ++row.left_out;
        if (!is_whole && of.rule.kind != Rule::Kind::kEachTask) break;
        continue;
      }
      for (const auto& [outcome, other] : start) {
        if (outcome != adaptive::Outcome::kSuccess && outcome != adaptive::Outcome::kFailure) continue;
        ++row.first.n;
        ++row.second.n;
        row.first.k += outcome == adaptive::Outcome::kSuccess ? 1 : 0;
        row.second.k += other ? 1 : 0;
      }
      decision.add(start);
    }
    row.starts = decision.starts();
    row.won = decision.won();
    row.lost = decision.lost();
    const adaptive::Decision::Claim claim =
        of.rule.kind == Rule::Kind::kEachTask ? decision.now() : decision.ever();
    row.p = claim.p;
    row.leads = claim.side;
    if (is_mirrored) {
      std::swap(row.first, row.second);
      std::swap(row.won, row.lost);
      row.leads = -row.leads;
    }
    if (row.starts > 0) rows.push_back(row);
  }
  if (rows.empty())
    return Failure{Fault::kUsage, "the two runs share no start that counts: other tasks, starts or seeds",
                   ""};
  std::vector<double> p;
  for (const AnytimeRow& row : rows) p.push_back(row.p);
  const std::vector<double> adjusted = stats::holm(p);
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i].adjusted = adjusted[i];
  return rows;
}

}  // namespace probe::report
