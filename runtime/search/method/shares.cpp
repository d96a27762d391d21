#include "runtime/search/method/shares.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "runtime/search/method/outcome.h"

namespace probe::search {
namespace {

// May lie a little outside of 0..1.
struct Estimates {
  std::vector<double> first;  // an axis
  std::vector<std::optional<double>> pair;

  double total(std::size_t axis, const std::vector<AxisPair>& pairs) const {
    double sum = first[axis];
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      if (pairs[i].first == axis || pairs[i].second == axis) sum += pair[i].value_or(0);
    }
    return sum;
  }
};

// Between-group sum of squares of `failed` in groups, and how many groups have trials.
struct Between {
  double squares = 0;
  double groups = 0;
};

Between between(const std::vector<double>& k, const std::vector<double>& n, double rate) {
  Between result;
  for (std::size_t g = 0; g < n.size(); ++g) {
    if (n[g] == 0) continue;
    const double off = k[g] / n[g] - rate;
    result.squares += n[g] * off * off;
    result.groups += 1;
  }
  return result;
}

// Of `trials`, with repetition where they are resampled.
Estimates estimate(const std::vector<Parts>& parts, const std::vector<AxisPair>& pairs,
                   const std::vector<std::uint8_t>& failed,
                   const std::vector<std::size_t>& trials) {
  const double n = static_cast<double>(trials.size());
  double k = 0;
  for (const std::size_t i : trials) k += failed[i];
  const double rate = k / n, total = n * rate * (1 - rate);
  Estimates shares;
  std::vector<Between> firsts;
  std::vector<double> in_k, in_n;
  for (const Parts& axis : parts) {
    in_k.assign(static_cast<std::size_t>(axis.count), 0);
    in_n = in_k;
    for (const std::size_t i : trials) {
      in_k[axis.of[i]] += failed[i];
      in_n[axis.of[i]] += 1;
    }
    firsts.push_back(between(in_k, in_n, rate));
    const Between& b = firsts.back();
    const double within = (total - b.squares) / std::max(n - b.groups, 1.0);
    shares.first.push_back(total > 0 ? (b.squares - (b.groups - 1) * within) / total : 0);
  }
  for (const auto& [a, b] : pairs) {
    const auto width = static_cast<std::size_t>(parts[b].count);
    in_k.assign(static_cast<std::size_t>(parts[a].count) * width, 0);
    in_n = in_k;
    for (const std::size_t i : trials) {
      const std::size_t cell = parts[a].of[i] * width + parts[b].of[i];
      in_k[cell] += failed[i];
      in_n[cell] += 1;
    }
    const Between both = between(in_k, in_n, rate);
    // Cells of a trial each explain everything.
    if (2 * both.groups > n) {
      shares.pair.emplace_back();
      continue;
    }
    const double within = (total - both.squares) / std::max(n - both.groups, 1.0);
    const double joint = (both.squares - (both.groups - 1) * within) / std::max(total, 1e-300);
    shares.pair.push_back(total > 0 ? joint - shares.first[a] - shares.first[b] : 0);
  }
  return shares;
}

double in_unit(double share) { return std::clamp(share, 0.0, 1.0); }

// The 95 % interval of resampled shares, moved so that their mean is the estimate: resampling adds
// chance of its own to what lies between groups.
stats::Interval interval_of(std::vector<double> resampled, double estimate) {
  if (resampled.empty()) return {0, 1};
  std::sort(resampled.begin(), resampled.end());
  double mean = 0;
  for (const double share : resampled) mean += share / static_cast<double>(resampled.size());
  const auto at = [&](double q) {
    const double place = q * static_cast<double>(resampled.size() - 1);
    return resampled[static_cast<std::size_t>(std::round(place))];
  };
  const double tail = (1 - kConfidence) / 2;
  return {in_unit(estimate + at(tail) - mean), in_unit(estimate + at(1 - tail) - mean)};
}

}  // namespace

Shares shares_of(const std::vector<Parts>& parts, const std::vector<AxisPair>& pairs,
                 const std::vector<std::uint8_t>& failed, int resamples, Draws draws) {
  std::vector<std::size_t> trials(failed.size());
  std::iota(trials.begin(), trials.end(), std::size_t{0});
  const Estimates found = estimate(parts, pairs, failed, trials);
  std::vector<std::vector<double>> first(parts.size()), total(parts.size());
  for (int r = 0; r < resamples; ++r) {
    for (std::size_t& i : trials) i = draws.below(static_cast<std::uint32_t>(trials.size()));
    const Estimates again = estimate(parts, pairs, failed, trials);
    for (std::size_t a = 0; a < parts.size(); ++a) {
      first[a].push_back(again.first[a]);
      total[a].push_back(again.total(a, pairs));
    }
  }
  Shares shares;
  for (std::size_t a = 0; a < parts.size(); ++a) {
    const double of_both = found.total(a, pairs);
    shares.axes.push_back({.first = in_unit(found.first[a]),
                           .total = in_unit(of_both),
                           .first_interval = interval_of(std::move(first[a]), found.first[a]),
                           .total_interval = interval_of(std::move(total[a]), of_both)});
  }
  for (const std::optional<double>& share : found.pair)
    shares.pairs.push_back(share ? std::optional(in_unit(*share)) : std::nullopt);
  return shares;
}

}  // namespace probe::search
