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

// e^(i w), w = 2 pi j v / period: the angles of all terms are whole parts of a turn, so that each is
// worked out once.
class Turns {
 public:
  explicit Turns(std::int64_t period) : period_(period) {
    if (period > kMost) return;
    known_.reserve(static_cast<std::size_t>(period));
    for (std::int64_t k = 0; k < period; ++k) known_.push_back(turn(k));
  }
  std::complex<double> at(std::int64_t j, std::int64_t v) const {
    std::int64_t k = j * (v % period_) % period_;
    if (k < 0) k += period_;
    return known_.empty() ? turn(k) : known_[static_cast<std::size_t>(k)];
  }

 private:
  static constexpr std::int64_t kMost = std::int64_t{1} << 20;  // 16 MiB

  std::complex<double> turn(std::int64_t k) const {
    return std::polar(
        1.0, 2 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(period_));
  }

  std::int64_t period_;
  std::vector<std::complex<double>> known_;
};

// As the standard's, without its care for what is not finite, which nothing is here.
std::complex<double> times(std::complex<double> a, std::complex<double> b) {
  return {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
}
double square(std::complex<double> a) { return a.real() * a.real() + a.imag() * a.imag(); }

std::complex<double> times_power(std::complex<double> product, std::complex<double> base,
                                 std::int64_t power) {
  for (; power > 0; power >>= 1) {
    if ((power & 1) != 0) product = times(product, base);
    if (power > 1) base = times(base, base);
  }
  return product;
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
  const std::int64_t far = std::abs(observed);
  const ExactSum other = mirrored();
  // Flipped signs are their own mirror image.
  if (other.times_ == times_) return std::min(1.0, 2 * at_least(far));
  return std::min(1.0, at_least(far) + other.at_least(far));
}

double ExactSum::at_least(std::int64_t least) const {
  return counting_work(least) <= kMostCounting ? at_least_by_counting(least)
                                               : at_least_by_inversion(least);
}

std::int64_t ExactSum::highest() const {
  std::int64_t sum = 0;
  for (const auto& [values, times] : times_) sum += values.back() * times;
  return sum;
}

double ExactSum::counting_work(std::int64_t least) const {
  const double most = static_cast<double>(highest() - least) + 1;
  if (most <= 0) return 0;
  double work = 0, width = 1;
  for (const auto& [values, times] : times_) {
    const double n = static_cast<double>(times);
    const double span = static_cast<double>(values.back() - values.front());
    const double mean = width + span * n / 2;
    work += static_cast<double>(values.size()) * n * std::min(mean, most);
    width += span * n;
  }
  return work;
}

double ExactSum::at_least_by_counting(std::int64_t least) const {
  const std::int64_t high = highest();
  if (least > high) return 0;
  // chance[d]: that the sum of the numbers so far lacks d of the highest it can be. What lacks more
  // than high - least never comes back, so it is not counted.
  const auto most = static_cast<std::size_t>(high - least) + 1;
  std::vector<double> chance = {1}, next;
  for (const auto& [values, times] : times_) {
    const double share = 1 / static_cast<double>(values.size());
    const std::int64_t last = values.back();
    for (std::int64_t i = 0; i < times; ++i) {
      const std::size_t width = chance.size() + static_cast<std::size_t>(last - values.front());
      next.assign(std::min(width, most), 0.0);
      for (const std::int64_t v : values) {
        const auto lack = static_cast<std::size_t>(last - v);
        for (std::size_t d = 0; d < chance.size() && d + lack < next.size(); ++d)
          next[d + lack] += chance[d] * share;
      }
      chance.swap(next);
    }
  }
  double total = 0;
  for (std::size_t d = chance.size(); d-- > 0;) total += chance[d];
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
  const Turns turns(period);
  struct Group {
    std::vector<std::int64_t> value;
    std::vector<double> chance;
    std::int64_t times = 0;
  };
  std::vector<Group> groups;
  for (const auto& [values, times] : times_)
    groups.push_back({values, tilted(values, tilt).chance, times});
  // Smaller than this a product of characteristic functions adds nothing; none grows again.
  const double nothing = std::exp(2 * kNoSize);
  double total = 0;
  for (std::int64_t j = 0; 2 * j <= period; ++j) {
    std::complex<double> product = turns.at(-j, least);
    for (const Group& group : groups) {
      double real = 0, imaginary = 0;
      for (std::size_t i = 0; i < group.value.size(); ++i) {
        const std::complex<double> turn = turns.at(j, group.value[i]);
        real += group.chance[i] * turn.real();
        imaginary += group.chance[i] * turn.imag();
      }
      product = times_power(product, {real, imaginary}, group.times);
      if (square(product) < nothing) break;
    }
    if (square(product) < nothing) continue;
    const std::complex<double> term = product / (1.0 - std::exp(-tilt) * turns.at(-j, 1));
    // The other half are the conjugates.
    total += (j == 0 || 2 * j == period ? 1 : 2) * term.real();
  }
  return std::clamp(scale * total / static_cast<double>(period), 0.0, 1.0);
}

}  // namespace probe::stats
