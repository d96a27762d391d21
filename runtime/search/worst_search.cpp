// The smallest changes that break a policy, over all axes together; what was found is confirmed by
// trials that took no part in finding it.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runtime/base/hash_number.h"
#include "runtime/base/sha256.h"
#include "runtime/search/hunt.h"
#include "runtime/search/method/confirm.h"
#include "runtime/search/method/worst.h"
#include "runtime/search/scale.h"

namespace probe::search {
namespace {

// Seeds of what confirms: none that the search has had.
constexpr int kFreshSeeds = 100'000'000;
// Of a shard: so many that no two have one, as many as are below kFreshSeeds.
constexpr int kSeedsOfShard = 2'000'000;
static_assert(kSeedsOfShard * (kMostWorstShards + 1) < kFreshSeeds);
// Trials behind the rounds: a second look at 15 cases, then 5 of them and the task itself again.
constexpr int kEndTrials = 15 * 8 + 5 * 40 + 60;

// Draws of a shard, which depend on the seed of the search.
std::uint64_t seed_of_shard(std::uint64_t seed, int shard, int shards) {
  if (shards == 1) return seed;
  Hasher hasher;
  hasher.text("worst shard").u64(seed).u64(static_cast<std::uint64_t>(shard));
  return little_endian_number(hasher.finish());
}

}  // namespace

Status search_worst(Hunt& hunt) {
  const int shard = hunt.options.run.shard, shards = hunt.options.run.shards;
  const std::string of_shard = shards > 1 ? fmt::format(" {} of {}", shard, shards) : "";
  const int first_seed = shards > 1 ? shard * kSeedsOfShard : 0;
  const sema::Space& space = hunt.space();
  const Space axes = method_space(space);
  WorstOptions options;
  options.seed = seed_of_shard(hunt.options.seed, shard, shards);
  if (hunt.options.budget) {
    const int round = options.points * options.repeats;
    if (*hunt.options.budget < kEndTrials + 2 * round)
      return Failure{
          Fault::kUsage,
          fmt::format("`worst` takes {} trials at least: two rounds of {}, and {} to look "
                      "again and to confirm",
                      kEndTrials + 2 * round, round, kEndTrials),
          "--budget"};
    options.rounds = (*hunt.options.budget - kEndTrials) / round;
  }
  Worst worst(axes, options);
  PROBE_TRY(hunt.try_points({[&] { return worst.done(); }, [&] { return worst.ask(); },
                             [&](std::span<const Outcome> told) { worst.tell(told); }},
                            "worst" + of_shard, first_seed));
  const std::vector<Candidate> candidates = worst.candidates();
  SearchSummary& summary = hunt.summary;
  Json cases = Json::array();
  stats::Count own;
  if (!candidates.empty()) {
    hunt.tell(fmt::format("{} cases to be confirmed", candidates.size()));
    ConfirmOptions confirming;
    confirming.error /= shards;
    Confirm confirm(axes, points_of(candidates), confirming);
    PROBE_TRY(hunt.try_points({[&] { return confirm.done(); }, [&] { return confirm.ask(); },
                               [&](std::span<const Outcome> told) { confirm.tell(told); }},
                              "confirm" + of_shard, kFreshSeeds + first_seed));
    const Confirmation found = confirm.confirmation();
    own = found.own;
    summary.findings["own_failures"] = json_of(own);
    summary.findings["rate"] = found.rate;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      const ConfirmedCase& one = found.cases[i];
      const std::vector<double> values =
          space::seen_values(space, values_of(space, candidates[i].point));
      const std::string changes = space::point_text(space, values);
      std::string line = fmt::format("case {}: {}: fails in {} fresh trials", i + 1, changes,
                                     k_of_n(one.failures));
      line += one.confirmed ? fmt::format(", in {:.0f} % or more of all (the task itself: {})",
                                          std::floor(100 * one.low), k_of_n(own))
                            : ", which is not confirmed: the best of many is lucky";
      const space::Point point{hunt.point_name(values), values, hunt.draw_of(values), {}};
      cases.push_back({{"name", point.name},
                       {"changes", json_of(space, values)},
                       {"draw", fmt::format("{:016x}", point.draw)},
                       {"text", changes},
                       {"distance", candidates[i].distance},
                       {"search_failures", json_of(candidates[i].failures)},
                       {"failures", json_of(one.failures)},
                       {"at_least", one.low},
                       {"p", one.p},
                       {"confirmed", one.confirmed},
                       {"sentence", line}});
      if (one.confirmed) hunt.kept.push_back({point, line});
    }
  }
  summary.lines = worst_lines(cases, own, worst.trials());
  summary.findings["cases"] = std::move(cases);
  return {};
}

bool is_confirmed(const Json& one) {
  const Json* const confirmed = one.find("confirmed");
  return confirmed != nullptr && confirmed->is_boolean() && confirmed->get<bool>();
}

std::vector<std::string> worst_lines(const Json& cases, const stats::Count& own, int trials) {
  if (cases.empty())
    return {fmt::format(
        "nothing failed in {} trials: no case is claimed, which does not say that there is none",
        trials)};
  if (own.n > 0 && own.k == own.n)
    return {
        fmt::format("the task itself fails in {} trials: there is nothing to break", k_of_n(own))};
  std::vector<std::string> lines;
  for (const Json& one : cases) lines.push_back(one.value("sentence", ""));
  if (std::ranges::none_of(cases, is_confirmed))
    lines.push_back(
        "no case fails more often than the task itself does, as far as fresh trials tell");
  return lines;
}

}  // namespace probe::search
