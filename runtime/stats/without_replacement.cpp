#include "runtime/stats/without_replacement.h"

#include <algorithm>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <queue>
#include <vector>

namespace probe::stats {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

// The logarithm of the gamma function of halves / 2. An interval asks for some hundred of them, and
// is made after every episode: those of lists up to some thousand are made once.
double log_gamma(std::int64_t halves) {
  static const std::vector<double> kKnown = [] {
    std::vector<double> known = {kInfinite};
    for (int i = 1; i < (1 << 14); ++i) known.push_back(boost::math::lgamma(i / 2.0));
    return known;
  }();
  if (static_cast<std::size_t>(halves) < kKnown.size())
    return kKnown[static_cast<std::size_t>(halves)];
  return boost::math::lgamma(static_cast<double>(halves) / 2);
}

// The logarithm of n (n - 1) .. (n - k + 1).
double log_falling(std::int64_t n, std::int64_t k) {
  return log_gamma(2 * n + 2) - log_gamma(2 * (n - k) + 2);
}

// The evidence against each number of successes of one list, with what is unknown filled in.
class Evidence {
 public:
  Evidence(std::int64_t total, std::int64_t successes, std::int64_t failures)
      : total_(total), successes_(successes), failures_(failures) {}

  std::int64_t least() const { return successes_; }
  std::int64_t most() const { return total_ - failures_; }
  double at(std::int64_t all) const {
    return log_evidence_against(total_, all, successes_, failures_);
  }
  // The number that least speaks against; the evidence is convex in it.
  std::int64_t best() const {
    std::int64_t low = least(), high = most();
    while (low < high) {
      const std::int64_t middle = low + (high - low) / 2;
      if (at(middle + 1) < at(middle)) {
        low = middle + 1;
      } else {
        high = middle;
      }
    }
    return low;
  }
  // The farthest number from the best one, up or down, that has less evidence than `limit`.
  std::int64_t end(double limit, bool up) const {
    std::int64_t in = best(), out = up ? most() + 1 : least() - 1;
    while (std::abs(out - in) > 1) {
      const std::int64_t middle = in + (out - in) / 2;
      (at(middle) < limit ? in : out) = middle;
    }
    return in;
  }

 private:
  std::int64_t total_, successes_, failures_;
};

// What is unknown as failures, or as successes.
Evidence evidence_of(const Drawn& list, bool unknown_succeed) {
  return unknown_succeed ? Evidence(list.total, list.successes + list.unknown, list.failures)
                         : Evidence(list.total, list.successes, list.failures + list.unknown);
}

// By how much more than some other way to fill in the unknown this one speaks against even its best
// number. The evidence against that is no monotone function of the filling: bets on nearly certain
// outcomes have paid worse at the edges.
double slack_of(const Drawn& list, const Evidence& filled) {
  const double own = filled.at(filled.best());
  double least = own;
  for (std::int64_t k = 0; k <= list.unknown; ++k) {
    const Evidence other(list.total, list.successes + k, list.failures + list.unknown - k);
    least = std::min(least, other.at(other.best()));
  }
  return own - least;
}

// The largest, or smallest, sum of successes whose product of evidence is below the limit, however
// the unknown is filled in: with all of it as successes, or failures, the evidence against a number
// beyond the best one is at most slack_of() above that of any other way, since their ratio falls (or
// rises) in the number.
std::int64_t farthest_sum(std::span<const Drawn> lists, double limit, bool up) {
  struct Step {
    double cost;
    std::size_t list;
    std::int64_t to;
    bool operator>(const Step& other) const {
      return cost != other.cost ? cost > other.cost : list > other.list;
    }
  };
  std::vector<Evidence> evidence;
  std::priority_queue<Step, std::vector<Step>, std::greater<>> steps;
  double spent = 0;
  std::int64_t sum = 0;
  const auto offer = [&](std::size_t list, std::int64_t from) {
    const Evidence& of = evidence[list];
    const std::int64_t to = up ? from + 1 : from - 1;
    if (to <= of.most() && to >= of.least()) steps.push({of.at(to) - of.at(from), list, to});
  };
  for (std::size_t i = 0; i < lists.size(); ++i) {
    evidence.push_back(evidence_of(lists[i], up));
    const std::int64_t best = evidence[i].best();
    spent += evidence[i].at(best);
    if (lists[i].unknown > 0) limit += slack_of(lists[i], evidence[i]);
    sum += best;
    offer(i, best);
  }
  while (!steps.empty()) {
    const Step next = steps.top();
    steps.pop();
    if (spent + next.cost >= limit) break;
    spent += next.cost;
    sum += up ? 1 : -1;
    offer(next.list, next.to);
  }
  return sum;
}

double share(std::int64_t part, std::int64_t whole) {
  return static_cast<double>(part) / static_cast<double>(whole);
}

}  // namespace

double log_evidence_against(std::int64_t total, std::int64_t all, std::int64_t successes,
                            std::int64_t failures) {
  if (all < successes || total - all < failures) return kInfinite;
  // B(1/2, 1/2) is pi.
  const double betted = log_gamma(2 * successes + 1) + log_gamma(2 * failures + 1) -
                        log_gamma(2 * (successes + failures) + 2) - std::log(std::numbers::pi);
  const double likely = log_falling(all, successes) + log_falling(total - all, failures) -
                        log_falling(total, successes + failures);
  return betted - likely;
}

Interval rate_of_drawn(const Drawn& list, double confidence) {
  if (list.total == 0) return {0, 1};
  const double limit = -std::log(1 - confidence);
  return {share(evidence_of(list, false).end(limit, false), list.total),
          share(evidence_of(list, true).end(limit, true), list.total)};
}

Interval rate_of_lists(std::span<const Drawn> lists, Drawing drawing, double confidence) {
  std::int64_t total = 0;
  for (const Drawn& list : lists) total += list.total;
  if (total == 0) return {0, 1};
  if (lists.size() == 1) return rate_of_drawn(lists[0], confidence);
  if (drawing == Drawing::kInTurn) {
    const double limit = -std::log(1 - confidence);
    return {share(farthest_sum(lists, limit, false), total),
            share(farthest_sum(lists, limit, true), total)};
  }
  // A list that is known has no error to spend.
  const auto open = std::count_if(lists.begin(), lists.end(), [](const Drawn& list) {
    return list.successes + list.failures < list.total;
  });
  const double part = (1 - confidence) / static_cast<double>(std::max<std::ptrdiff_t>(1, open));
  double low = 0, high = 0;
  for (const Drawn& list : lists) {
    if (list.total == 0) continue;
    const Interval one = rate_of_drawn(list, 1 - part);
    low += one.low * share(list.total, total);
    high += one.high * share(list.total, total);
  }
  return {std::max(0.0, low), std::min(1.0, high)};
}

}  // namespace probe::stats
