#include "runtime/stats/rank_agreement.h"

#include <algorithm>
#include <boost/math/distributions/beta.hpp>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <vector>

namespace probe::stats {
namespace {

constexpr std::size_t kDraws = 4000;

std::vector<double> rates_of(std::span<const MeasuredRate> measured) {
  std::vector<double> rates;
  for (const MeasuredRate& one : measured) rates.push_back(one.rate);
  return rates;
}

// splitmix64 (S. Vigna): enough to put strata into an order.
class Order {
 public:
  explicit Order(std::uint64_t seed) : state_(seed) {}
  std::uint64_t next() {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }

 private:
  std::uint64_t state_;
};

// What one rate could be, a value from each of kDraws equal shares of its distribution.
std::vector<double> draws_of(const MeasuredRate& measured, std::uint64_t seed) {
  const double k = measured.rate * measured.trials;
  const boost::math::beta_distribution<> posterior(k + 0.5, measured.trials - k + 0.5);
  std::vector<double> draws(kDraws);
  for (std::size_t i = 0; i < kDraws; ++i)
    draws[i] = quantile(posterior, (static_cast<double>(i) + 0.5) / static_cast<double>(kDraws));
  Order order(seed);
  for (std::size_t i = kDraws - 1; i > 0; --i)
    std::swap(draws[i], draws[static_cast<std::size_t>(order.next() % (i + 1))]);
  return draws;
}

Interval middle(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const auto at = [&](double share) {
    const double place = share * static_cast<double>(values.size() - 1);
    return values[static_cast<std::size_t>(std::lround(place))];
  };
  return {at(0.025), at(0.975)};
}

void by_trials(std::span<const MeasuredRate> real, std::span<const MeasuredRate> simulated,
               Agreement& agreement) {
  const std::size_t n = real.size();
  std::vector<std::vector<double>> draws;
  for (std::size_t i = 0; i < n; ++i) draws.push_back(draws_of(real[i], 2 * i + 1));
  for (std::size_t i = 0; i < n; ++i) draws.push_back(draws_of(simulated[i], 2 * i + 2));
  std::vector<double> violations, correlations, r(n), s(n);
  for (std::size_t draw = 0; draw < kDraws; ++draw) {
    for (std::size_t i = 0; i < n; ++i) r[i] = draws[i][draw], s[i] = draws[n + i][draw];
    violations.push_back(mean_max_rank_violation(r, s));
    if (const auto one = pearson(r, s)) correlations.push_back(*one);
  }
  agreement.violation_by_trials = middle(std::move(violations));
  if (!correlations.empty()) agreement.correlation_by_trials = middle(std::move(correlations));
}

void widen(std::optional<Interval>& interval, double value) {
  if (!interval) interval = Interval{value, value};
  interval->low = std::min(interval->low, value);
  interval->high = std::max(interval->high, value);
}

}  // namespace

double mean_max_rank_violation(std::span<const double> real, std::span<const double> simulated) {
  if (real.empty()) return 0;
  double sum = 0;
  for (std::size_t i = 0; i < real.size(); ++i) {
    double most = 0;
    for (std::size_t j = 0; j < real.size(); ++j) {
      if ((simulated[i] > simulated[j]) != (real[i] > real[j]))
        most = std::max(most, std::abs(real[i] - real[j]));
    }
    sum += most;
  }
  return sum / static_cast<double>(real.size());
}

std::optional<double> pearson(std::span<const double> real, std::span<const double> simulated) {
  const auto n = static_cast<double>(real.size());
  if (real.size() < 2) return std::nullopt;
  const double r = std::accumulate(real.begin(), real.end(), 0.0) / n;
  const double s = std::accumulate(simulated.begin(), simulated.end(), 0.0) / n;
  double rr = 0, ss = 0, rs = 0;
  for (std::size_t i = 0; i < real.size(); ++i) {
    rr += (real[i] - r) * (real[i] - r);
    ss += (simulated[i] - s) * (simulated[i] - s);
    rs += (real[i] - r) * (simulated[i] - s);
  }
  constexpr double kNone = 1e-24;  // the mean of equal rates is not exact
  if (rr <= kNone || ss <= kNone) return std::nullopt;
  return rs / std::sqrt(rr * ss);
}

Agreement rank_agreement(std::span<const MeasuredRate> real,
                         std::span<const MeasuredRate> simulated) {
  Agreement agreement;
  const std::vector<double> r = rates_of(real), s = rates_of(simulated);
  agreement.violation = mean_max_rank_violation(r, s);
  agreement.correlation = pearson(r, s);
  const auto has_trials = [](const MeasuredRate& one) { return one.trials > 0; };
  if (!real.empty() && std::ranges::all_of(real, has_trials) &&
      std::ranges::all_of(simulated, has_trials))
    by_trials(real, simulated, agreement);
  if (real.size() < 4) return agreement;
  for (std::size_t out = 0; out < r.size(); ++out) {
    std::vector<double> fewer_r = r, fewer_s = s;
    fewer_r.erase(fewer_r.begin() + static_cast<std::ptrdiff_t>(out));
    fewer_s.erase(fewer_s.begin() + static_cast<std::ptrdiff_t>(out));
    widen(agreement.violation_by_policies, mean_max_rank_violation(fewer_r, fewer_s));
    if (const auto one = pearson(fewer_r, fewer_s)) widen(agreement.correlation_by_policies, *one);
  }
  return agreement;
}

}  // namespace probe::stats
