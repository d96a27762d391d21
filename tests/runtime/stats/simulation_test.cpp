// 2,000 made-up benchmark runs whose truth is known: do the intervals cover it as often as they
// say, and do the tests err no more often than they promise?
#include <doctest/doctest.h>

#include <map>
#include <string>

#include "runtime/stats/clustered.h"
#include "runtime/stats/mixed_logistic.h"
#include "runtime/stats/multiplicity.h"
#include "runtime/stats/sequential.h"
#include "tests/runtime/stats/fake_benchmark.h"

namespace probe::stats {
namespace {

constexpr double kAlpha = 0.05;

struct Outcome {
  std::map<std::string, Share> coverage;
  double false_discovery_share = 0;  // mean over runs
  Share any_false_category, sequential_errors;
  int runs = 0;

  void covers(const std::string& what, const Interval& interval, double truth) {
    coverage[what].add(interval.low <= truth && truth <= interval.high);
  }
};

std::uint32_t id(std::size_t i) { return static_cast<std::uint32_t>(i); }

std::uint32_t cluster_of(const FakeRun& run, std::size_t task, std::size_t start) {
  return id(run.tasks[task].baseline * run.starts + start);
}

void check_rates(const FakeRun& run, Outcome& outcome) {
  std::vector<StartCount> all;
  std::array<std::vector<StartCount>, kCategorySizes.size()> by_category;
  std::array<double, kCategorySizes.size()> truth{};
  double truth_of_all = 0;
  for (std::size_t t = 0; t < run.tasks.size(); ++t) {
    const FakeTask& task = run.tasks[t];
    std::vector<StartCount> one;
    for (std::size_t s = 0; s < run.starts; ++s) {
      one.push_back({run.count(0, t, s), 0, id(s)});
      all.push_back({run.count(0, t, s), id(t), cluster_of(run, t, s)});
      by_category[task.category].push_back(all.back());
    }
    outcome.covers("rate of a task", clustered_rate(one), task.truth[0]);
    truth_of_all += task.truth[0] / static_cast<double>(run.tasks.size());
    truth[task.category] += task.truth[0] / static_cast<double>(kCategorySizes[task.category]);
  }
  for (std::size_t c = 0; c < truth.size(); ++c) {
    outcome.covers("rate of a category", clustered_rate(by_category[c]), truth[c]);
  }
  outcome.covers("rate of all tasks", clustered_rate(all), truth_of_all);
}

// Variants against their baselines under policy 0.
void check_variants(const FakeRun& run, Outcome& outcome) {
  struct Category {
    std::vector<StartPairs> pairs;
    std::map<std::uint32_t, StartArms> arms;
    double truth = 0;
    bool is_null = true;
  };
  std::array<Category, kCategorySizes.size()> categories;
  std::vector<double> p;
  std::vector<bool> is_null;
  for (std::size_t t = kCategorySizes[0]; t < run.tasks.size(); ++t) {
    const FakeTask& task = run.tasks[t];
    Category& category = categories[task.category];
    std::vector<StartPairs> one;
    std::vector<Cluster> clusters;
    for (std::size_t s = 0; s < run.starts; ++s) {
      const PairTable pairs = run.pairs(0, t, 0, task.baseline, s);
      const std::uint32_t cluster = cluster_of(run, t, s);
      one.push_back({pairs, 0, id(s)});
      clusters.push_back(pairs);
      category.pairs.push_back({pairs, id(t), cluster});
      StartArms& arms = category.arms[cluster];
      if (arms.empty()) arms.push_back(run.count(0, task.baseline, s));
      arms.push_back(run.count(0, t, s));
    }
    const double truth = task.truth[0] - run.tasks[task.baseline].truth[0];
    outcome.covers("variant against baseline, task", clustered_difference(one).interval, truth);
    p.push_back(clustered_exact(clusters));
    is_null.push_back(task.mean[0] == run.tasks[task.baseline].mean[0]);
    category.truth += truth / static_cast<double>(kCategorySizes[task.category]);
    category.is_null = category.is_null && is_null.back();
  }
  const auto q = benjamini_hochberg(p);
  double found = 0, falsely = 0;
  for (std::size_t i = 0; i < q.size(); ++i) {
    if (q[i] > kAlpha) continue;
    ++found;
    falsely += is_null[i] ? 1 : 0;
  }
  outcome.false_discovery_share += found > 0 ? falsely / found : 0;

  std::vector<double> by_category;
  for (std::size_t c = 1; c < categories.size(); ++c) {
    const Category& category = categories[c];
    outcome.covers("variant against baseline, category",
                   clustered_difference(category.pairs).interval, category.truth);
    std::vector<StartArms> arms;
    for (const auto& [cluster, of_start] : category.arms) arms.push_back(of_start);
    by_category.push_back(shared_baseline_exact(arms));
  }
  const auto adjusted = holm(by_category);
  bool any = false;
  for (std::size_t i = 0; i < adjusted.size(); ++i) {
    any = any || (categories[i + 1].is_null && adjusted[i] <= kAlpha);
  }
  outcome.any_false_category.add(any);
}

// Policy 0 against policy 1.
void check_policies(const FakeRun& run, bool all_alike, Outcome& outcome) {
  std::vector<StartPairs> all;
  std::array<std::vector<StartPairs>, kCategorySizes.size()> by_category;
  std::array<double, kCategorySizes.size()> truth{};
  double truth_of_all = 0;
  for (std::size_t t = 0; t < run.tasks.size(); ++t) {
    const FakeTask& task = run.tasks[t];
    const double difference = task.truth[0] - task.truth[1];
    std::vector<StartPairs> one;
    for (std::size_t s = 0; s < run.starts; ++s) {
      one.push_back({run.pairs(0, t, 1, t, s), 0, id(s)});
      all.push_back({one.back().pairs, id(t), cluster_of(run, t, s)});
      by_category[task.category].push_back(all.back());
    }
    outcome.covers("policy against policy, task", clustered_difference(one).interval, difference);
    truth_of_all += difference / static_cast<double>(run.tasks.size());
    truth[task.category] += difference / static_cast<double>(kCategorySizes[task.category]);
  }
  for (std::size_t c = 0; c < truth.size(); ++c) {
    outcome.covers("policy against policy, category", clustered_difference(by_category[c]).interval,
                   truth[c]);
  }
  outcome.covers("policy against policy, all tasks", clustered_difference(all).interval,
                 truth_of_all);
  if (!all_alike) return;
  SequentialComparison sequential;  // looked at after every start
  for (std::size_t s = 0; s < run.starts; ++s) {
    for (std::size_t t = 0; t < run.tasks.size(); ++t) {
      sequential.add(run.count(0, t, s).k - run.count(1, t, s).k);
    }
  }
  outcome.sequential_errors.add(sequential.p_value() <= kAlpha);
}

Outcome simulate(const FakeDesign& design, int runs, std::uint64_t seed) {
  std::mt19937_64 bits(seed);
  Outcome outcome;
  outcome.runs = runs;
  for (int i = 0; i < runs; ++i) {
    const FakeRun run = draw_run(design, bits);
    check_rates(run, outcome);
    check_variants(run, outcome);
    check_policies(run, design.null_policies == 1, outcome);
  }
  return outcome;
}

void check_promises(const std::string& name, const Outcome& outcome) {
  for (const auto& [what, share] : outcome.coverage) {
    MESSAGE(name << ": " << what << ": covered " << 100 * share.value() << " % of " << share.n);
    CAPTURE(what);
    CHECK(share.value() >= 0.94);
    CHECK(share.value() <= 0.97);
  }
  const double discoveries = outcome.false_discovery_share / outcome.runs;
  MESSAGE(name << ": false among discoveries (Benjamini-Hochberg): " << 100 * discoveries << " %");
  CHECK(discoveries <= kAlpha);
  const double any = outcome.any_false_category.value();
  MESSAGE(name << ": runs with a false category (Holm): " << 100 * any << " %");
  CHECK(any <= kAlpha);
  if (outcome.sequential_errors.n == 0) return;
  const double stopped = outcome.sequential_errors.value();
  MESSAGE(name << ": sequential comparisons stopped in error: " << 100 * stopped << " %");
  CHECK(stopped <= kAlpha);
}

}  // namespace

TEST_CASE("over 2,000 made-up runs the intervals cover and the tests err as promised") {
  check_promises("one seed, half null", simulate({.seeds = 1}, 500, 42));
  check_promises("one seed, all null",
                 simulate({.seeds = 1, .null_variants = 1, .null_policies = 1}, 500, 7));
  check_promises("three seeds, half null", simulate({.seeds = 3}, 500, 314));
  check_promises("three seeds, all null",
                 simulate({.seeds = 3, .null_variants = 1, .null_policies = 1}, 500, 2026));
}

// Two policies with a constant difference of log-odds, crossed random tasks and starts.
TEST_CASE("the mixed model's interval of a policy's effect covers the truth") {
  constexpr std::size_t kTasks = 16, kStarts = 16;
  constexpr double kEffect = -0.8;
  std::mt19937_64 bits(314);
  std::normal_distribution<> normal;
  std::uniform_real_distribution<> uniform;
  Share covered;
  for (int run = 0; run < 150; ++run) {
    MixedData data;
    const auto rows = static_cast<Eigen::Index>(2 * kTasks * kStarts);
    data.fixed = Eigen::MatrixXd::Ones(rows, 2);
    data.successes = data.trials = Eigen::VectorXd::Ones(rows);
    data.groups.resize(2);
    std::array<double, kTasks> task{};
    std::array<double, kTasks * kStarts> start{};
    for (double& effect : task) effect = normal(bits);
    for (double& effect : start) effect = 0.8 * normal(bits);
    Eigen::Index row = 0;
    for (std::size_t policy = 0; policy < 2; ++policy) {
      for (std::size_t i = 0; i < start.size(); ++i, ++row) {
        const double odds = 0.3 + (policy == 1 ? kEffect : 0.0) + task[i / kStarts] + start[i];
        data.fixed(row, 1) = policy == 1 ? 1 : 0;
        data.successes(row) = uniform(bits) < 1 / (1 + std::exp(-odds)) ? 1 : 0;
        data.groups[0].push_back(id(i / kStarts));
        data.groups[1].push_back(id(i));
      }
    }
    const auto fit = fit_mixed_logistic(data);
    REQUIRE(fit);
    const double half = normal_two_sided(0.95) * std::sqrt(fit->covariance(1, 1));
    covered.add(std::abs(fit->fixed(1) - kEffect) <= half);
  }
  MESSAGE("mixed model: effect of a policy: covered " << 100 * covered.value() << " % of "
                                                      << covered.n);
  CHECK(covered.value() >= 0.94 - 0.03);  // 150 fits: two standard errors
}

}  // namespace probe::stats
