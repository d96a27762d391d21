#include "runtime/stats/exact_sum.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdlib>
#include <numbers>

#include "runtime/stats/tilt.h"

namespace probe::stats {
namespace {

// Additions that counting may take before inversion is quicker.
constexpr double kMostCounting = 1e6;

// One set of values under a tilt: chances in proportion to e^(tilt v), which are returned with the
// logarithm of their mean weight.
struct Tilted {
  std::vector<double> chance;
  double log_weight = 0, mean = 0, variance = 0;
};

Tilted tilted(std::span<const std::int64_t> values, double tilt) {
  Tilted t;
  const double top = tilt * static_cast<double>(tilt < 0 ? values.front() : values.back());
  double total = 0, squares = 0;
  for (const std::int64_t v : values) {
    t.chance.push_back(std::exp(tilt * static_cast<double>(v) - top));
    total += t.chance.back();
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    t.chance[i] /= total;
    t.mean += t.chance[i] * static_cast<double>(values[i]);
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double off = static_cast<double>(values[i]) - t.mean;
    squares += t.chance[i] * off * off;
  }
  t.variance = squares;
  t.log_weight = top + std::log(total / static_cast<double>(values.size()));
  return t;
}

}  // namespace

void ExactSum::add(std::span<const std::int64_t> values) {
  Values sorted(values.begin(), values.end());
  std::sort(sorted.begin(), sorted.end());
  ++times_[std::move(sorted)];
}

ExactSum ExactSum::mirrored() const {
  ExactSum other;
  for (const auto& [values, times] : times_) {
    Values turned;
    for (auto v = values.rbegin(); v != values.rend(); ++v) turned.push_back(-*v);
    other.times_[std::move(turned)] += times;
  }
  return other;
}

double ExactSum::tail(std::int64_t observed) const {
  if (observed == 0) return 1;
  double work = 0, width = 1;
  for (const auto& [values, times] : times_) {
    const double n = static_cast<double>(times);
    const double span = static_cast<double>(values.back() - values.front());
    work += static_cast<double>(values.size()) * n * (width + span * n / 2);
    width += span * n;
  }
  const auto at_least = [&](const ExactSum& sum, std::int64_t least) {
    return work <= kMostCounting ? sum.at_least_by_counting(least)
                                 : sum.at_least_by_inversion(least);
  };
  const std::int64_t far = std::abs(observed);
  const ExactSum other = mirrored();
  // Flipped signs are their own mirror image.
  if (other.times_ == times_) return std::min(1.0, 2 * at_least(*this, far));
  return std::min(1.0, at_least(*this, far) + at_least(other, far));
}

double ExactSum::at_least_by_counting(std::int64_t least) const {
  // chance[s - low]: of the sum s of the numbers so far.
  std::int64_t low = 0;
  std::vector<double> chance = {1}, next;
  for (const auto& [values, times] : times_) {
    const double share = 1 / static_cast<double>(values.size());
    const std::int64_t first = values.front();
    for (std::int64_t i = 0; i < times; ++i) {
      next.assign(chance.size() + static_cast<std::size_t>(values.back() - first), 0.0);
      for (const std::int64_t v : values) {
        double* const to = next.data() + (v - first);
        for (std::size_t s = 0; s < chance.size(); ++s) to[s] += chance[s] * share;
      }
      low += first;
      chance.swap(next);
    }
  }
  double total = 0;
  const auto size = static_cast<std::int64_t>(chance.size());
  for (std::int64_t s = std::max<std::int64_t>(0, least - low); s < size; ++s)
    total += chance[static_cast<std::size_t>(s)];
  return std::min(1.0, total);
}

double ExactSum::at_least_by_inversion(std::int64_t least) const {
  std::int64_t lowest = 0, highest = 0, span = 1;
  for (const auto& [values, times] : times_) {
    lowest += values.front() * times;
    highest += values.back() * times;
    span = std::max(span, values.back() - values.front());
  }
  if (least <= lowest) return 1;
  if (least > highest) return 0;
  const double target = static_cast<double>(least);
  const auto sums = [&](double tilt) {
    Tilted all;
    for (const auto& [values, times] : times_) {
      const Tilted one = tilted(values, tilt);
      const double n = static_cast<double>(times);
      all.log_weight += n * one.log_weight;
      all.mean += n * one.mean;
      all.variance += n * one.variance;
    }
    return all;
  };
  const double least_tilt = smallest_tilt(sums(0).variance);
  const double tilt = std::max(
      least_tilt, rising_root([&](double t) { return sums(t).mean - target; }, 0, kLargestTilt));
  const Tilted all = sums(tilt);
  // No chance is larger than this (Chernoff's bound): where it is nothing, nothing is summed.
  const double scale = std::exp(all.log_weight - tilt * target);
  if (scale == 0) return 0;
  const std::int64_t period = quiet_period(all.variance, static_cast<double>(span), tilt);
  struct Group {
    std::vector<double> value, chance;
    double times = 0;
    // Of two values: |phi|^2 = squares + twice cos(w apart).
    double apart = 0, squares = 0, twice = 0;
  };
  std::vector<Group> groups;
  for (const auto& [values, times] : times_) {
    Group group{{}, tilted(values, tilt).chance, static_cast<double>(times)};
    for (const std::int64_t v : values) group.value.push_back(static_cast<double>(v));
    if (values.size() == 2) {
      const double p = group.chance[0], q = group.chance[1];
      group.apart = group.value[1] - group.value[0];
      group.squares = p * p + q * q;
      group.twice = 2 * p * q;
    }
    groups.push_back(std::move(group));
  }
  // Most terms are nothing, which costs a cosine a group to see and not five functions.
  const auto is_nothing = [&](double w) {
    double size = 0;
    for (const Group& group : groups) {
      if (group.apart == 0) continue;
      const double square = group.squares + group.twice * std::cos(w * group.apart);
      size += 0.5 * group.times * std::log(std::max(square, 1e-300));
      if (size < kNoSize - 1) return true;
    }
    return false;
  };
  double total = 0;
  for (std::int64_t j = 0; 2 * j <= period; ++j) {
    const double w = 2 * std::numbers::pi * static_cast<double>(j) / static_cast<double>(period);
    if (is_nothing(w)) continue;
    double size = 0, angle = -w * target;  // logarithm and argument of the term
    for (const Group& group : groups) {
      std::complex<double> phi = 0;
      for (std::size_t i = 0; i < group.value.size(); ++i)
        phi += std::polar(group.chance[i], w * group.value[i]);
      size += group.times * std::log(std::abs(phi));
      if (size < kNoSize) break;
      angle += group.times * std::arg(phi);
    }
    if (size < kNoSize) continue;
    const std::complex<double> term =
        std::polar(std::exp(size), angle) / (1.0 - std::polar(std::exp(-tilt), -w));
    // The other half are the conjugates.
    total += (j == 0 || 2 * j == period ? 1 : 2) * term.real();
  }
  return std::clamp(scale * total / static_cast<double>(period), 0.0, 1.0);
}

}  // namespace probe::stats
