#include "runtime/stats/deal.h"

#include <algorithm>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "runtime/stats/tilt.h"

namespace probe::stats {
namespace {

// Additions that counting may take before inversion is quicker.
constexpr double kMostDealt = 2e7;

double log_choose(double n, double k) {
  return boost::math::lgamma(n + 1) - boost::math::lgamma(k + 1) - boost::math::lgamma(n - k + 1);
}

// Cards of one value, each taken with chance `p`.
struct Level {
  double value = 0, cards = 0, p = 0;
};

// Of all cards that are taken: how many, what they show, and the variances of both.
struct Taken {
  double number = 0, sum = 0, number_variance = 0, sum_variance = 0;
  double log_weight = 0;  // logarithm of the product of 1 + odds
};

double log_1p_exp(double x) { return std::max(x, 0.0) + std::log1p(std::exp(-std::abs(x))); }

// Odds e^(lift + tilt v).
Taken take(std::vector<Level>& levels, double lift, double tilt) {
  Taken t;
  for (Level& l : levels) {
    const double x = lift + tilt * l.value;
    l.p = x < 0 ? std::exp(x) / (1 + std::exp(x)) : 1 / (1 + std::exp(-x));
    const double variance = l.cards * l.p * (1 - l.p);
    t.number += l.cards * l.p;
    t.sum += l.cards * l.p * l.value;
    t.number_variance += variance;
    t.sum_variance += variance * l.value * l.value;
    t.log_weight += l.cards * log_1p_exp(x);
  }
  return t;
}

// log |phi| of one level's cards: (1 - p + p e^(i angle)) to the power of their number.
double log_size(const Level& l, double angle) {
  const double half = std::sin(angle / 2);
  return l.cards / 2 * std::log1p(-std::min(4 * l.p * (1 - l.p) * half * half, 1 - 1e-300));
}

double turn(const Level& l, double angle) {
  return l.cards * std::atan2(l.p * std::sin(angle), 1 - l.p + l.p * std::cos(angle));
}

// The angle beyond which the cards of one level alone leave a term without size.
double reach(const Level& l) {
  const double half = -std::expm1(2 * kNoSize / l.cards) / (4 * l.p * (1 - l.p));
  return half >= 1 ? std::numbers::pi : 2 * std::asin(std::sqrt(half));
}

std::int64_t largest_sum(const Deck& deck, std::int64_t hand) {
  std::int64_t sum = 0;
  for (auto level = deck.rbegin(); level != deck.rend() && hand > 0; ++level) {
    const std::int64_t taken = std::min(hand, level->second);
    sum += taken * level->first;
    hand -= taken;
  }
  return sum;
}

double all_cards(const Deck& deck) {
  double cards = 0;
  for (const auto& [value, count] : deck) cards += static_cast<double>(count);
  return cards;
}

}  // namespace

double deal_at_least(const Deck& deck, std::int64_t hand, std::int64_t least) {
  double work = static_cast<double>(hand + 1) * static_cast<double>(largest_sum(deck, hand) + 1);
  double choices = 0;
  for (const auto& [value, count] : deck) choices += static_cast<double>(std::min(count, hand));
  work *= choices;
  return work <= kMostDealt ? deal_by_counting(deck, hand, least)
                            : deal_by_inversion(deck, hand, least);
}

double deal_by_counting(const Deck& deck, std::int64_t hand, std::int64_t least) {
  const auto width = static_cast<std::size_t>(largest_sum(deck, hand) + 1);
  if (least >= static_cast<std::int64_t>(width)) return 0;
  // weight[c][s]: the chance that coins take c cards of the values so far, with sum s. Coins of
  // `share` take `hand` cards on average: given that number every choice is as likely, and the
  // chance of the number itself does not vanish.
  const double cards = all_cards(deck);
  const double share = static_cast<double>(hand) / cards;
  std::vector<double> weight(static_cast<std::size_t>(hand + 1) * width, 0.0), next;
  weight[0] = 1;
  std::int64_t most = 0;
  for (const auto& [value, count] : deck) {
    next.assign(weight.size(), 0.0);
    const std::int64_t before = most;
    most = std::min(hand, most + count);
    for (std::int64_t take = 0; take <= std::min(count, hand); ++take) {
      const double n = static_cast<double>(count), k = static_cast<double>(take);
      const double chance =
          std::exp(log_choose(n, k) + k * std::log(share) + (n - k) * std::log1p(-share));
      const auto shift = static_cast<std::size_t>(take * value);
      if (shift >= width) break;
      for (std::int64_t c = 0; c <= std::min(before, hand - take); ++c) {
        const double* const from = weight.data() + static_cast<std::size_t>(c) * width;
        double* const to = next.data() + static_cast<std::size_t>(c + take) * width + shift;
        for (std::size_t s = 0; s + shift < width; ++s) to[s] += from[s] * chance;
      }
    }
    weight.swap(next);
  }
  const double* const row = weight.data() + static_cast<std::size_t>(hand) * width;
  double tail = 0, all = 0;
  for (std::size_t s = 0; s < width; ++s) {
    all += row[s];
    if (static_cast<std::int64_t>(s) >= least) tail += row[s];
  }
  return tail / all;
}

double deal_by_inversion(const Deck& deck, std::int64_t hand, std::int64_t least) {
  if (least > largest_sum(deck, hand)) return 0;
  std::vector<Level> levels;
  for (const auto& [value, count] : deck)
    levels.push_back({static_cast<double>(value), static_cast<double>(count), 0});
  const double number = static_cast<double>(hand), target = static_cast<double>(least);
  const double span = levels.back().value;
  const auto lift_for = [&](double tilt) {
    const double far = kLargestTilt * (span + 1);
    return rising_root([&](double lift) { return take(levels, lift, tilt).number - number; }, -far,
                       far);
  };
  const double least_tilt = smallest_tilt(take(levels, lift_for(0), 0).sum_variance);
  const double tilt = std::max(
      least_tilt, rising_root([&](double t) { return take(levels, lift_for(t), t).sum - target; },
                              0, kLargestTilt));
  const double lift = lift_for(tilt);
  const Taken taken = take(levels, lift, tilt);
  const std::int64_t sums = quiet_period(taken.sum_variance, span, tilt);
  const std::int64_t numbers = quiet_period(taken.number_variance, 1, kLargestTilt);
  // The level that turns fastest leaves few angles to look at; the others often leave none of them.
  std::stable_sort(levels.begin(), levels.end(), [](const Level& x, const Level& y) {
    return x.cards * x.p * (1 - x.p) > y.cards * y.p * (1 - y.p);
  });
  const double window = reach(levels[0]);
  const double step = 2 * std::numbers::pi / static_cast<double>(numbers);
  double total = 0;
  for (std::int64_t j = 0; 2 * j <= sums; ++j) {
    const double w = 2 * std::numbers::pi * static_cast<double>(j) / static_cast<double>(sums);
    const double middle = -w * levels[0].value;
    auto first = static_cast<std::int64_t>(std::ceil((middle - window) / step));
    auto last = static_cast<std::int64_t>(std::floor((middle + window) / step));
    last = std::min(last, first + numbers - 1);
    std::complex<double> of_sum = 0;
    for (std::int64_t i = first; i <= last; ++i) {
      const double u = static_cast<double>(i) * step;
      double size = 0;
      for (const Level& l : levels) {
        size += log_size(l, u + w * l.value);
        if (size < kNoSize) break;
      }
      if (size < kNoSize) continue;
      double angle = -u * number - w * target;
      for (const Level& l : levels) angle += turn(l, u + w * l.value);
      of_sum += std::polar(std::exp(size), angle);
    }
    of_sum /= 1.0 - std::polar(std::exp(-tilt), -w);
    // The other half are the conjugates.
    total += (j == 0 || 2 * j == sums ? 1 : 2) * of_sum.real();
  }
  const double scale = std::exp(taken.log_weight - lift * number - tilt * target -
                                log_choose(all_cards(deck), number));
  return std::clamp(scale * total / static_cast<double>(sums) / static_cast<double>(numbers), 0.0,
                    1.0);
}

}  // namespace probe::stats
