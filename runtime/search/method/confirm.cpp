#include "runtime/search/method/confirm.h"

#include <algorithm>
#include <boost/math/special_functions/beta.hpp>
#include <limits>
#include <utility>

#include "runtime/base/check.h"
#include "runtime/stats/multiplicity.h"

namespace probe::search {
namespace {

// Of the error, what the own point's bound may take.
constexpr double kOwnShare = 0.2;

// The chance of as many failures or more if the rate is `rate`.
double upper_tail(stats::Count failures, double rate) {
  if (failures.k == 0 || rate >= 1) return 1;
  if (rate <= 0) return 0;
  return boost::math::ibeta(static_cast<double>(failures.k),
                            static_cast<double>(failures.n - failures.k + 1), rate);
}

}  // namespace

double exact_lower(stats::Count failures, double confidence) {
  if (failures.k == 0) return 0;
  return boost::math::ibeta_inv(static_cast<double>(failures.k),
                                static_cast<double>(failures.n - failures.k + 1), 1 - confidence);
}

double exact_upper(stats::Count failures, double confidence) {
  if (failures.k == failures.n) return 1;
  return boost::math::ibeta_inv(static_cast<double>(failures.k + 1),
                                static_cast<double>(failures.n - failures.k), confidence);
}

Confirm::Confirm(const Space& space, std::vector<Point> points, const ConfirmOptions& options)
    : options_(options) {
  PROBE_CHECK(options.trials > 0 && options.own_trials > 0, "cases are tried");
  if (points.empty()) return;
  if (!options.rate)
    tried_.push_back({.point = own_point(space), .wanted = options.own_trials, .failures = {}});
  for (Point& point : points) {
    tried_.push_back({.point = std::move(point), .wanted = options.trials, .failures = {}});
  }
  next();
}

void Confirm::next() {
  ask_.clear();
  of_.clear();
  for (std::size_t i = 0; i < tried_.size(); ++i) {
    Tried& one = tried_[i];
    const int missing =
        std::min(one.wanted - static_cast<int>(one.failures.n), 2 * one.wanted - one.asked);
    for (int j = 0; j < missing; ++j) {
      ask_.push_back(one.point);
      of_.push_back(i);
      ++one.asked;
    }
  }
}

void Confirm::tell(std::span<const Outcome> outcomes) {
  PROBE_CHECK(outcomes.size() == ask_.size(), "every trial that was asked has its outcome");
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    Tried& one = tried_[of_[i]];
    if (outcomes[i] == Outcome::kLeftOut) {
      ++one.left_out;
      continue;
    }
    ++one.failures.n;
    one.failures.k += outcomes[i] == Outcome::kFailed ? 1 : 0;
  }
  next();
}

Confirmation Confirm::confirmation() const {
  Confirmation result;
  std::size_t first = 0;
  double error = options_.error;
  if (options_.rate) {
    result.rate = *options_.rate;
  } else if (!tried_.empty()) {
    first = 1;
    result.own = tried_[0].failures;
    result.left_out = tried_[0].left_out;
    result.rate = exact_upper(result.own, 1 - kOwnShare * error);
    error *= 1 - kOwnShare;
  }
  // Holm's last step may take all that claims have, and bounds of the other cases theirs as well.
  error /= 2;
  const double cases = static_cast<double>(tried_.size() - first);
  std::vector<double> p;
  for (std::size_t i = first; i < tried_.size(); ++i) {
    const Tried& one = tried_[i];
    result.left_out += one.left_out;
    p.push_back(one.failures.n == 0 ? std::numeric_limits<double>::quiet_NaN()
                                    : upper_tail(one.failures, result.rate));
    result.cases.push_back({.failures = one.failures,
                            .left_out = one.left_out,
                            .low = exact_lower(one.failures, 1 - error / cases)});
  }
  const std::vector<double> adjusted = stats::holm(p);
  for (std::size_t i = 0; i < result.cases.size(); ++i) {
    if (result.cases[i].failures.n == 0) continue;
    result.cases[i].p = adjusted[i];
    result.cases[i].confirmed = adjusted[i] <= error;
  }
  return result;
}

}  // namespace probe::search
