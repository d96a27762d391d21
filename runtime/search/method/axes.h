// Which axes matter, and which two matter together: from points over the whole space, a trial each.
//
//   Axes method(space, {.points = 600, .seed = 7});
//   while (!method.done()) method.tell(run(method.ask()));  // points in, an outcome each out
//   const AxesFinding found = method.finding();
//   for (const PairEffect& pair : found.pairs) if (pair.named) say(pair.a, pair.b, pair.fails);
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "runtime/search/method/outcome.h"
#include "runtime/search/method/space.h"
#include "runtime/stats/intervals.h"

namespace probe::search {

struct AxesOptions {
  int points = 600;
  std::uint64_t seed = 0;
  int round = 64;  // points a batch
  // That any axis is said to matter wrongly; the same of any pair. Below 5 %, so that the right
  // pair and no other is named in 95 % of searches.
  double error = 0.03;
  int permutations = 2000;  // of a test, at most; of many axes or pairs as many as Holm needs
  int resamples = 400;      // of the intervals
};

// A part of an axis.
enum class SideKind : std::uint8_t { kBelow, kAtLeast, kIs, kIsNot };
struct Side {
  SideKind kind = SideKind::kAtLeast;
  double value = 0;
  bool holds(double x) const;
};

struct AxisEffect {
  double p = 1;          // Holm's over the axes
  bool matters = false;  // p <= error
  // The part of the axis that fails more, best seen, and how often failure is seen there and not.
  Side side;
  stats::Count there, elsewhere;
  // Sobol's index of first order: what this axis, cut into its parts (eight equal ones where it is
  // continuous), explains of the variance of the outcome, 0..1. It is at most the index of the axis
  // itself: where a threshold lies in the middle of a part, about a seventh is missing, and of what
  // two such axes share about a quarter. One trial a point has chance in it, so the indices of a
  // policy that fails by chance add up to less than 1. `total` adds the share of the pairs that are
  // named, and lacks that of a pair that was missed. The 95 % intervals are those of the indices of
  // the parts, not of the axis itself, which they may lie below.
  double first = 0, total = 0;
  stats::Interval first_interval, total_interval;
};

struct PairEffect {
  std::size_t a = 0, b = 0;  // axes, a < b
  double p = 1;              // Holm's over the pairs
  bool named = false;        // p <= error
  // Together they fail more than the two apart would as causes independent of one another; false:
  // less, as where one change undoes the other.
  bool synergy = true;
  // The corner that fails most and failures there, and with one of its sides or none.
  Side side_a, side_b;
  stats::Count both, only_a, only_b, neither;
  // Of the outcome's variance, beyond what the two explain alone; none where there are fewer than
  // two trials to a cell of their parts.
  std::optional<double> share = std::nullopt;
  // Points that were left out tie the two axes to one another, so nothing can be said: not tested.
  bool tested = true;
};

struct AxesFinding {
  stats::Count failures;
  int left_out = 0;
  // Fewer trials count than least_trials, and nothing is said: axes and pairs are empty.
  bool too_few = false;
  std::vector<AxisEffect> axes;   // in the order of the space
  std::vector<PairEffect> pairs;  // (0,1), (0,2), .., (1,2), ..
};

// An interaction is one on the scale of independent causes: without it success is a product,
//   success(x) = g(x without a) h(x without b)
// (Bliss 1939, Annals of Applied Biology 26:585). Two thresholds that each break the policy alone
// are none, "fails exactly where both" is one; chances of failure that add up to more than
// independent causes give are one, too. Points are drawn independently over the axes, so under that
// hypothesis a and b are independent among the successes (the case-only design: Piegorsch,
// Weinberg and Taylor 1994, Statistics in Medicine 13:153), whatever the other axes do and whatever
// other pairs interact. That is tested by permutation, exact at every size and under perfect
// separation: the largest chi-square over all pairs of cuts, sequential Monte Carlo p values (Besag
// and Clifford 1991, Biometrika 78:301). Of main effects the same, of an axis and the outcome.
// Points that are left out may tie axes to one another; then permutations stay within the parts of
// those that an axis is tied to, and shares are only of the points that count.
class Axes {
 public:
  Axes(Space space, const AxesOptions& options);

  // Trials without which nothing is said: five to a part of the axis that has most of them. With
  // one to a part the parts "explain" whatever happened.
  static int least_trials(const Space& space);

  bool done() const { return told_ == points_.size(); }
  std::span<const Point> ask() const;
  void tell(std::span<const Outcome> outcomes);
  AxesFinding finding() const;  // some ten milliseconds; at any time, of what was told so far

 private:
  Space space_;
  AxesOptions options_;
  std::vector<Point> points_;  // all of them, asked in order
  std::vector<Outcome> outcomes_;
  std::size_t told_ = 0;
};

}  // namespace probe::search
