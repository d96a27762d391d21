#include "runtime/search/method/axes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "runtime/base/check.h"
#include "runtime/search/method/draws.h"
#include "runtime/search/method/independence.h"
#include "runtime/search/method/parts.h"
#include "runtime/search/method/shares.h"
#include "runtime/stats/multiplicity.h"

namespace probe::search {
namespace {

// Two axes whose counted points are tied to one another at this p are not tested as a pair.
constexpr double kTied = 0.01;

constexpr double kMostPermutations = 1e7;

constexpr int kTrialsOfPart = 5;

// Of each of `tests` tests. The smallest p value of n permutations is 1 / (n + 1), which Holm takes
// `tests` times; tests that are null end long before (Besag and Clifford), so many cost little.
int permutations_of(std::size_t tests, const AxesOptions& options) {
  const double needed = std::ceil(2 * static_cast<double>(tests) / options.error);
  return std::max(options.permutations, static_cast<int>(std::min(needed, kMostPermutations)));
}

// What was told, as the tests need it.
class Analysis {
 public:
  Analysis(const Space& space, const AxesOptions& options, std::span<const Point> points,
           std::span<const Outcome> outcomes)
      : options_(options), axis_count_(space.size()), least_(Axes::least_trials(space)) {
    for (std::size_t i = 0; i < outcomes.size(); ++i) {
      if (outcomes[i] == Outcome::kLeftOut) {
        ++left_out_;
        continue;
      }
      all_.push_back(counted_.size());
      if (outcomes[i] == Outcome::kSucceeded) successes_.push_back(counted_.size());
      failed_.push_back(outcomes[i] == Outcome::kFailed ? 1 : 0);
      counted_.push_back(points[i]);
    }
    for (std::size_t a = 0; a < axis_count_; ++a) parts_.push_back(parts_of(space[a], counted_, a));
    is_tied_.assign(axis_count_, std::vector<bool>(axis_count_));
    if (left_out_ > 0) find_ties();
  }

  AxesFinding finding() const {
    AxesFinding found;
    found.left_out = left_out_;
    found.failures = {static_cast<std::int64_t>(all_.size() - successes_.size()),
                      static_cast<std::int64_t>(all_.size())};
    found.too_few = found.failures.n < least_;
    if (found.too_few) return found;
    test_axes(found);
    test_pairs(found);
    if (!all_.empty()) share_out(found);
    return found;
  }

 private:
  // Points that were left out may tie axes to one another. What such an axis does is then looked at
  // where the axes that it is tied to are in one part.
  void find_ties() {
    for (std::size_t a = 0; a < axis_count_; ++a) {
      for (std::size_t b = a + 1; b < axis_count_; ++b) {
        const double p =
            independence(parts_[a], parts_[b], all_, {}, options_.permutations, draws("tied", a, b))
                .p;
        is_tied_[a][b] = is_tied_[b][a] = p <= kTied;
      }
    }
  }

  // To a or b, and neither of them.
  std::vector<const Parts*> tied_to(std::size_t a, std::size_t b) const {
    std::vector<const Parts*> tied;
    for (std::size_t c = 0; c < axis_count_; ++c) {
      if (c != a && c != b && (is_tied_[a][c] || is_tied_[b][c])) tied.push_back(&parts_[c]);
    }
    return tied;
  }

  Draws draws(const std::string& what, std::size_t a, std::size_t b) const {
    return Draws(options_.seed, what + " " + std::to_string(a) + " " + std::to_string(b));
  }

  void test_axes(AxesFinding& found) const {
    const Parts outcome{.count = 2, .of = failed_, .sides = {{}}};
    const int permutations = permutations_of(axis_count_, options_);
    std::vector<double> p;
    for (std::size_t a = 0; a < axis_count_; ++a) {
      const IndependenceTest test =
          independence(parts_[a], outcome, all_, tied_to(a, a), permutations,
                       Draws(options_.seed, "axis " + std::to_string(a)));
      AxisEffect effect;
      if (!parts_[a].sides.empty()) {
        effect.side = parts_[a].sides[test.best.cut_a];
        if (test.best.is_less) effect.side = other_side(effect.side);
      }
      for (std::size_t i = 0; i < counted_.size(); ++i) {
        add(effect.side.holds(counted_[i][a]) ? effect.there : effect.elsewhere, i);
      }
      p.push_back(test.p);
      found.axes.push_back(effect);
    }
    const std::vector<double> adjusted = stats::holm(p);
    for (std::size_t a = 0; a < axis_count_; ++a) {
      found.axes[a].p = adjusted[a];
      found.axes[a].matters = adjusted[a] <= options_.error;
    }
  }

  void test_pairs(AxesFinding& found) const {
    const std::size_t pairs = axis_count_ * (axis_count_ - 1) / 2;
    const int permutations = permutations_of(pairs, options_);
    std::vector<double> p;
    for (std::size_t a = 0; a < axis_count_; ++a) {
      for (std::size_t b = a + 1; b < axis_count_; ++b) {
        PairEffect effect;
        effect.a = a;
        effect.b = b;
        effect.tested = !is_tied_[a][b];
        const IndependenceTest test = independence(parts_[a], parts_[b], successes_, tied_to(a, b),
                                                   permutations, draws("pair", a, b));
        if (!parts_[a].sides.empty() && !parts_[b].sides.empty()) tell_corner(test.best, effect);
        p.push_back(effect.tested ? test.p : 1);
        found.pairs.push_back(effect);
      }
    }
    const std::vector<double> adjusted = stats::holm(p);
    for (std::size_t i = 0; i < found.pairs.size(); ++i) {
      found.pairs[i].p = adjusted[i];
      found.pairs[i].named = adjusted[i] <= options_.error;
    }
  }

  // Which of the four corners of the best cuts fails most.
  void tell_corner(const BestCuts& best, PairEffect& effect) const {
    const Side far_a = parts_[effect.a].sides[best.cut_a];
    const Side far_b = parts_[effect.b].sides[best.cut_b];
    std::array<stats::Count, 4> corner{};  // bit 0: on the further side of a, bit 1: of b
    for (std::size_t i = 0; i < counted_.size(); ++i) {
      add(corner[(far_a.holds(counted_[i][effect.a]) ? 1U : 0U) +
                 (far_b.holds(counted_[i][effect.b]) ? 2U : 0U)],
          i);
    }
    std::size_t worst = 3;
    for (std::size_t which = 3; which-- > 0;) {
      if (corner[which].n == 0 || corner[worst].n == 0) continue;
      if (corner[which].rate() > corner[worst].rate()) worst = which;
    }
    effect.side_a = (worst & 1U) != 0 ? far_a : other_side(far_a);
    effect.side_b = (worst & 2U) != 0 ? far_b : other_side(far_b);
    effect.both = corner[worst];
    effect.only_a = corner[worst ^ 2U];
    effect.only_b = corner[worst ^ 1U];
    effect.neither = corner[worst ^ 3U];
    // Fewer successes in the corners on the diagonal of the worst than independence gives.
    const bool is_diagonal = worst == 0 || worst == 3;
    effect.synergy = best.is_less == is_diagonal;
  }

  void share_out(AxesFinding& found) const {
    std::vector<AxisPair> named;
    for (const PairEffect& pair : found.pairs) {
      if (pair.named) named.emplace_back(pair.a, pair.b);
    }
    const Shares shares =
        shares_of(parts_, named, failed_, options_.resamples, Draws(options_.seed, "resamples"));
    for (std::size_t a = 0; a < axis_count_; ++a) {
      found.axes[a].first = shares.axes[a].first;
      found.axes[a].total = shares.axes[a].total;
      found.axes[a].first_interval = shares.axes[a].first_interval;
      found.axes[a].total_interval = shares.axes[a].total_interval;
    }
    std::size_t at = 0;
    for (PairEffect& pair : found.pairs) {
      if (pair.named) pair.share = shares.pairs[at++];
    }
  }

  void add(stats::Count& failures, std::size_t trial) const {
    ++failures.n;
    failures.k += failed_[trial];
  }

  const AxesOptions& options_;
  std::size_t axis_count_;
  int least_;
  int left_out_ = 0;
  std::vector<Point> counted_;
  std::vector<std::uint8_t> failed_;          // a counted point
  std::vector<std::size_t> all_, successes_;  // counted points
  std::vector<Parts> parts_;                  // an axis
  std::vector<std::vector<bool>> is_tied_;    // axis x axis
};

}  // namespace

Axes::Axes(Space space, const AxesOptions& options) : space_(std::move(space)), options_(options) {
  PROBE_CHECK(
      options.points >= 0 && options.round > 0 && options.permutations > 0 && options.error > 0,
      "points are drawn, and asked in rounds");
  for (const Axis& axis : space_) {
    PROBE_CHECK(axis.kind == AxisKind::kContinuous || (axis.size >= 1 && axis.size <= 255),
                "a count or a choice has 1 to 255 values");
  }
  points_ = latin_hypercube(space_, static_cast<std::size_t>(options.points), options.seed, "axes");
}

int Axes::least_trials(const Space& space) {
  int most = 0;
  for (const Axis& axis : space) most = std::max(most, part_count(axis));
  return kTrialsOfPart * most;
}

std::span<const Point> Axes::ask() const {
  const std::size_t size =
      std::min(static_cast<std::size_t>(options_.round), points_.size() - told_);
  return std::span(points_).subspan(told_, size);
}

void Axes::tell(std::span<const Outcome> outcomes) {
  PROBE_CHECK(outcomes.size() == ask().size(), "every trial that was asked has its outcome");
  outcomes_.insert(outcomes_.end(), outcomes.begin(), outcomes.end());
  told_ += outcomes.size();
}

AxesFinding Axes::finding() const {
  return Analysis(space_, options_, points_, outcomes_).finding();
}

}  // namespace probe::search
