// A benchmark with known truth: two policies on the tasks of eleven categories, variants that share
// the starts of their baselines. What the simulation draws from.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "runtime/stats/intervals.h"
#include "runtime/stats/paired.h"

namespace probe::stats {

inline constexpr std::size_t kPolicies = 2;

// How often something was so.
struct Share {
  double hits = 0, n = 0;
  void add(bool hit) {
    hits += hit ? 1 : 0;
    n += 1;
  }
  double value() const { return hits / n; }
  // The share and twice its standard error if the truth is `p`.
  double less_noise(double p) const { return value() - 2 * std::sqrt(p * (1 - p) / n); }
};

struct FakeTask {
  std::size_t category = 0;
  std::size_t baseline = 0;               // itself for an original
  std::array<double, kPolicies> mean{};   // log-odds in the middle of the starts
  std::array<double, kPolicies> truth{};  // success rate over all starts there could be
};

struct FakeRun {
  std::size_t starts = 24;
  std::int64_t seeds = 1;
  std::vector<FakeTask> tasks;
  // By policy and task * starts + start: bit i is the success with seed i.
  std::array<std::vector<unsigned>, kPolicies> successes;
  // The chance of a success, in the same order.
  std::array<std::vector<double>, kPolicies> rates;

  unsigned bits(std::size_t policy, std::size_t task, std::size_t start) const {
    return successes[policy][task * starts + start];
  }
  double rate(std::size_t policy, std::size_t task, std::size_t start) const {
    return rates[policy][task * starts + start];
  }
  Count count(std::size_t policy, std::size_t task, std::size_t start) const {
    return {std::popcount(bits(policy, task, start)), seeds};
  }
  // Of (policy a, task a) and (policy b, task b) on the same start and seeds.
  PairTable pairs(std::size_t policy_a, std::size_t task_a, std::size_t policy_b,
                  std::size_t task_b, std::size_t start) const {
    const unsigned a = bits(policy_a, task_a, start);
    const unsigned b = bits(policy_b, task_b, start);
    return {std::popcount(a & b), std::popcount(a & ~b), std::popcount(b & ~a),
            seeds - std::popcount(a | b)};
  }
};

struct FakeDesign {
  std::int64_t seeds = 1;
  std::size_t starts = 24;
  double task_sd = 1.2;        // log-odds
  double start_sd = 1.0;       // shared by the variants of a baseline and by both policies
  double place_sd = 0;         // of a place under one policy, shared by the tasks that lie there
  double own_sd = 0.6;         // of a start in one task under one policy
  double null_variants = 0.5;  // share of categories whose variants are as their baselines
  double null_policies = 0.5;  // share of categories in which both policies are alike
};

inline constexpr std::array<std::size_t, 11> kCategorySizes = {4, 4, 5, 4, 4, 4, 4, 4, 6, 7, 5};

// The rate of a logistic of mean `mean` over starts whose log-odds scatter by `sd`: midpoints of
// 200 equally likely strips, by the normal distribution's quantile through erf's inverse by Newton.
inline double mean_logistic(double mean, double sd) {
  static const std::array<double, 201> kQuantiles = [] {
    std::array<double, 201> q{};
    for (std::size_t i = 0; i < q.size(); ++i) {
      const double p = (static_cast<double>(i) + 0.5) / static_cast<double>(q.size());
      double x = 0;
      for (int step = 0; step < 60; ++step) {
        const double cdf = 0.5 * std::erfc(-x / std::sqrt(2.0));
        const double pdf = std::exp(-x * x / 2) / std::sqrt(2 * std::acos(-1.0));
        x -= std::fmax(-1.0, std::fmin(1.0, (cdf - p) / pdf));
      }
      q[i] = x;
    }
    return q;
  }();
  double total = 0;
  for (const double q : kQuantiles) total += 1 / (1 + std::exp(-(mean + sd * q)));
  return total / static_cast<double>(kQuantiles.size());
}

inline FakeRun draw_run(const FakeDesign& design, std::mt19937_64& bits) {
  std::normal_distribution<> normal;
  std::uniform_real_distribution<> uniform;
  FakeRun run;
  run.seeds = design.seeds;
  run.starts = design.starts;
  const double spread = std::hypot(design.start_sd, design.place_sd, design.own_sd);
  for (std::size_t category = 0; category < kCategorySizes.size(); ++category) {
    const bool same_as_baseline = uniform(bits) < design.null_variants;
    const bool same_policies = uniform(bits) < design.null_policies;
    for (std::size_t i = 0; i < kCategorySizes[category]; ++i) {
      FakeTask task;
      task.category = category;
      task.baseline = category == 0 ? run.tasks.size() : bits() % kCategorySizes[0];
      for (std::size_t p = 0; p < kPolicies; ++p) {
        if (category == 0) {
          task.mean[p] =
              p == 1 && same_policies ? task.mean[0] : 0.5 + design.task_sd * normal(bits);
        } else {
          const FakeTask& baseline = run.tasks[task.baseline];
          task.mean[p] = baseline.mean[p] + (same_as_baseline ? 0.0 : -0.8 + 0.7 * normal(bits));
          if (p == 1 && same_policies) task.mean[p] = task.mean[0];
        }
        task.truth[p] = mean_logistic(task.mean[p], spread);
      }
      run.tasks.push_back(task);
    }
  }
  std::vector<double> shared(kCategorySizes[0] * run.starts);
  for (double& effect : shared) effect = design.start_sd * normal(bits);
  for (std::size_t p = 0; p < kPolicies; ++p) {
    std::vector<double> place = shared;
    if (design.place_sd > 0) {
      for (double& effect : place) effect += design.place_sd * normal(bits);
    }
    for (const FakeTask& task : run.tasks) {
      for (std::size_t s = 0; s < run.starts; ++s) {
        const double odds =
            task.mean[p] + place[task.baseline * run.starts + s] + design.own_sd * normal(bits);
        const double rate = 1 / (1 + std::exp(-odds));
        unsigned successes = 0;
        for (std::int64_t seed = 0; seed < run.seeds; ++seed) {
          successes |= (uniform(bits) < rate ? 1U : 0U) << seed;
        }
        run.successes[p].push_back(successes);
        run.rates[p].push_back(rate);
      }
    }
  }
  return run;
}

}  // namespace probe::stats
