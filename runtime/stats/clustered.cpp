#include "runtime/stats/clustered.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>

#include "runtime/stats/deal.h"
#include "runtime/stats/exact_sum.h"

namespace probe::stats {
namespace {

// How many episodes of the pooled rate a task's rate is mixed with before tasks are compared.
constexpr double kShrink = 2;

// However unlike the tasks, some variance is within them.
constexpr double kMostBetween = 0.99;

// Sums of one stratum or cluster: of x, and how many.
struct Sum {
  double total = 0, n = 0;
};

template <typename Rows, typename Id>
std::size_t ids(const Rows& rows, Id id) {
  std::size_t count = 0;
  for (const auto& row : rows) count = std::max(count, std::size_t{id(row)} + 1);
  return count;
}

// The share of the variance `variance` of one observation that lies between strata.
double between_share(const std::vector<Sum>& strata, double mean, double variance) {
  double between = 0, n = 0;
  for (const Sum& s : strata) {
    if (s.n == 0) continue;
    const double shrunk = (s.total + kShrink * mean) / (s.n + kShrink);
    between += s.n * (shrunk - mean) * (shrunk - mean);
    n += s.n;
  }
  return variance <= 0 ? 0 : std::clamp(between / (n * variance), 0.0, kMostBetween);
}

// What one row adds: its count, its sum and the sum of squares of its observations.
struct Row {
  double n = 0, total = 0, squares = 0;
  std::uint32_t task = 0, cluster = 0;
};

// What counts once where all observations are alike, so that no variance says what they are worth.
enum class Unit : std::uint8_t { kRow, kCluster };

// By what factor the rows' observations are worth less than as many independent ones.
double design_effect(const std::vector<Row>& rows, double confidence, Unit unit) {
  std::vector<Sum> tasks(ids(rows, [](const Row& r) { return r.task; }));
  std::vector<Sum> clusters(ids(rows, [](const Row& r) { return r.cluster; }));
  Sum all;
  double squares = 0, starts = 0;
  for (const Row& row : rows) {
    starts += row.n > 0 ? 1 : 0;
    for (Sum* sum : {&tasks[row.task], &all}) {
      sum->total += row.total;
      sum->n += row.n;
    }
    squares += row.squares;
  }
  for (const Row& row : rows) {
    if (row.n == 0) continue;
    const Sum& task = tasks[row.task];
    clusters[row.cluster].total += row.total - row.n * task.total / task.n;
    clusters[row.cluster].n += row.n;
  }
  double within = squares, by_clusters = 0, used = 0, used_tasks = 0;
  for (const Sum& t : tasks) {
    if (t.n == 0) continue;
    within -= t.total * t.total / t.n;
    ++used_tasks;
  }
  for (const Sum& c : clusters) {
    by_clusters += c.total * c.total;
    used += c.n > 0 ? 1 : 0;
  }
  const double mean_size = all.n / used;
  const double mean = all.total / all.n;
  double effect = unit == Unit::kCluster ? mean_size : all.n / starts;
  if (mean_size > 1 && used > 1 && within > 1e-9) {
    by_clusters *= used / (used - 1);
    const double quantile = student_two_sided(confidence, used - 1) / normal_two_sided(confidence);
    effect = std::clamp(by_clusters / within, 1.0, mean_size) * quantile * quantile;
  }
  // A mean is estimated for every task, not for all together.
  if (within > 1e-9 && all.n > used_tasks) effect *= (all.n - 1) / (all.n - used_tasks);
  return effect * (1 - between_share(tasks, mean, squares / all.n - mean * mean));
}

// A number that every count's n divides, so that rates become whole numbers; past 420 seeds a
// start, rates are rounded to that grid.
std::int64_t common_size(std::int64_t so_far, Count count) {
  constexpr std::int64_t kFinest = 420;
  return std::min(kFinest, count.n > 0 ? std::lcm(so_far, count.n) : so_far);
}

std::int64_t scaled(Count count, std::int64_t size) {
  return std::llround(static_cast<double>(count.k * size) / static_cast<double>(count.n));
}

Count pooled(std::span<const StartCount> starts) {
  Count all;
  for (const StartCount& start : starts) {
    all.k += start.count.k;
    all.n += start.count.n;
  }
  return all;
}

}  // namespace

Interval clustered_rate(std::span<const StartCount> starts, double confidence) {
  const Count all = pooled(starts);
  if (all.n == 0) return wilson(all, confidence);
  std::vector<Row> rows;
  for (const StartCount& s : starts) {
    const double k = static_cast<double>(s.count.k);
    rows.push_back({static_cast<double>(s.count.n), k, k, s.task, s.cluster});
  }
  const double n = static_cast<double>(all.n);
  return wilson_effective(all.rate(), n / design_effect(rows, confidence, Unit::kRow), confidence);
}

Difference clustered_difference(std::span<const StartPairs> pairs, double confidence) {
  PairTable all;
  std::vector<Row> rows;
  for (const StartPairs& p : pairs) {
    all = all + p.pairs;
    rows.push_back({static_cast<double>(p.pairs.pairs()), static_cast<double>(p.pairs.net()),
                    static_cast<double>(p.pairs.only_a + p.pairs.only_b), p.task, p.cluster});
  }
  const double n = static_cast<double>(all.pairs());
  if (all.pairs() == 0) return newcombe_paired(all, n, confidence);
  return newcombe_paired(all, n / design_effect(rows, confidence, Unit::kCluster), confidence);
}

Difference unpaired_difference(std::span<const StartCount> a, std::span<const StartCount> b,
                               double confidence) {
  const Count of_a = pooled(a);
  const Count of_b = pooled(b);
  if (of_a.n == 0 || of_b.n == 0) return {0, {-1, 1}};
  return unpaired_from(of_a.rate(), clustered_rate(a, confidence), of_b.rate(),
                       clustered_rate(b, confidence));
}

double shared_baseline_exact(std::span<const StartArms> starts) {
  std::int64_t size = 1;
  for (const StartArms& arms : starts) {
    for (const Count& arm : arms) size = common_size(size, arm);
  }
  ExactSum sum;
  std::int64_t observed = 0;
  for (const StartArms& arms : starts) {
    std::int64_t total = 0;
    std::vector<std::int64_t> values;
    for (const Count& arm : arms) {
      if (arm.n == 0) continue;
      values.push_back(scaled(arm, size));
      total += values.back();
    }
    if (values.size() < 2 || arms[0].n == 0) continue;
    const auto count = static_cast<std::int64_t>(values.size());
    // Were arm v the baseline, the others would exceed it by total - count v together.
    for (std::int64_t& v : values) v = total - count * v;
    observed += values[0];
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    if (*low != *high) sum.add(values);
  }
  return sum.tail(observed);
}

double unpaired_exact(std::span<const Count> a, std::span<const Count> b) {
  std::int64_t size = 1;
  for (const auto& sample : {a, b}) {
    for (const Count& count : sample) size = common_size(size, count);
  }
  // What a start of each sample adds, as whole numbers without a common divisor, the least of them
  // 0.
  std::vector<std::int64_t> values;
  std::int64_t in_a = 0;
  for (const auto& sample : {a, b}) {
    for (const Count& count : sample) {
      if (count.n > 0) values.push_back(scaled(count, size));
    }
    if (in_a == 0) in_a = static_cast<std::int64_t>(values.size());
  }
  const auto m = static_cast<std::int64_t>(values.size());
  if (in_a == 0 || in_a == m) return 1;
  const std::int64_t least = *std::min_element(values.begin(), values.end());
  std::int64_t divisor = 0;
  for (std::int64_t& v : values) divisor = std::gcd(divisor, v -= least);
  if (divisor == 0) return 1;  // all alike
  Deck deck, turned;
  std::int64_t total = 0, total_a = 0, most = 0;
  for (std::int64_t i = 0; i < m; ++i) {
    const std::int64_t v = values[static_cast<std::size_t>(i)] / divisor;
    ++deck[v];
    total += v;
    total_a += i < in_a ? v : 0;
    most = std::max(most, v);
  }
  for (const auto& [v, count] : deck) turned[most - v] = count;
  // m (sum of a) - in_a total is the difference of means, times what does not change. Which of the
  // samples is dealt makes no difference; the smaller one is less work.
  const std::int64_t observed = std::abs(m * total_a - in_a * total);
  if (observed == 0) return 1;
  const std::int64_t hand = std::min(in_a, m - in_a);
  const std::int64_t far = (hand * total + observed + m - 1) / m;  // at least: the upper tail
  const std::int64_t near = (hand * total - observed) / m;         // at most: the lower one
  double p = deal_at_least(deck, hand, far);
  if (hand * total >= observed) p += deal_at_least(turned, hand, hand * most - near);
  return std::min(1.0, p);
}

}  // namespace probe::stats
