// The exact distribution of a sum of independent whole numbers, each one of a few equally likely
// values: what permutation tests of starts add up. Knows nothing of tests.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <vector>

namespace probe::stats {

class ExactSum {
 public:
  // `reach`: the sum over all terms of each one's largest distance from 0.
  explicit ExactSum(std::int64_t reach)
      : reach_(reach), chance_(static_cast<std::size_t>(2 * reach + 1), 0.0), next_(chance_) {
    chance_[static_cast<std::size_t>(reach)] = 1;
  }

  void add(std::span<const std::int64_t> values) {
    const double share = 1 / static_cast<double>(values.size());
    std::int64_t widest = 0;
    for (const std::int64_t v : values) widest = std::max(widest, std::abs(v));
    const std::int64_t wider = so_far_ + widest;
    std::fill(next_.begin() + (reach_ - wider), next_.begin() + (reach_ + wider + 1), 0.0);
    for (const std::int64_t v : values) {
      for (std::int64_t s = -so_far_; s <= so_far_; ++s) at(next_, s + v) += at(chance_, s) * share;
    }
    so_far_ = wider;
    chance_.swap(next_);
  }

  // The chance of a sum at least as far from 0 as `observed`.
  double tail(std::int64_t observed) const {
    double total = 0;
    for (std::int64_t s = std::abs(observed); s <= so_far_; ++s) {
      total += at(chance_, s) + (s == 0 ? 0 : at(chance_, -s));
    }
    return observed == 0 ? 1 : std::min(1.0, total);
  }

 private:
  double& at(std::vector<double>& of, std::int64_t s) const {
    return of[static_cast<std::size_t>(s + reach_)];
  }
  double at(const std::vector<double>& of, std::int64_t s) const {
    return of[static_cast<std::size_t>(s + reach_)];
  }

  std::int64_t reach_, so_far_ = 0;
  std::vector<double> chance_, next_;
};

}  // namespace probe::stats
