#include "runtime/search/method/axes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "runtime/base/check.h"
#include "runtime/search/method/draws.h"
#include "runtime/stats/multiplicity.h"

namespace probe::search {
namespace {

// A continuous axis is looked at in so many equal parts; a count of more values, too.
constexpr int kParts = 8;
// A side of a cut that holds fewer trials is no side.
constexpr int kFewest = 5;
// Exceedances after which a p value is known well enough (Besag and Clifford's h).
constexpr int kEnough = 10;
// Two axes whose counted points are tied to one another at this p are not tested.
constexpr double kTied = 0.01;

// One axis as the tests see it: a part for each trial, and the ways to cut it in two.
struct Parts {
  int count = 1;
  std::vector<std::uint8_t> of;  // a trial
  // A cut's further side is one part, or of an ordered axis all parts from it on; the first cut is
  // at part first_cut.
  bool is_ordered = true;
  std::size_t first_cut = 1;
  std::vector<Side> sides;  // the further side of each cut
};

Parts parts_of(const Axis& axis, const std::vector<Point>& points, std::size_t at) {
  Parts parts;
  const bool is_choice = axis.kind == AxisKind::kChoice;
  parts.count = axis.kind == AxisKind::kContinuous ? kParts
                : is_choice                        ? axis.size
                                                   : std::min(axis.size, kParts);
  const double width = axis.kind == AxisKind::kContinuous
                           ? 1.0 / kParts
                           : static_cast<double>(axis.size) / parts.count;
  for (const Point& point : points) {
    const int part = std::clamp(static_cast<int>(point[at] / width + 1e-9), 0, parts.count - 1);
    parts.of.push_back(static_cast<std::uint8_t>(part));
  }
  // Of two options the second alone says all.
  parts.is_ordered = !is_choice || parts.count == 2;
  parts.first_cut = parts.is_ordered ? 1 : 0;
  for (int cut = parts.is_ordered ? 1 : 0; cut < parts.count; ++cut) {
    const double value = axis.kind == AxisKind::kContinuous ? cut * width
                         : is_choice                        ? cut
                                                            : std::ceil(cut * width - 1e-9);
    parts.sides.push_back({is_choice ? SideKind::kIs : SideKind::kAtLeast, value});
  }
  return parts;
}

Side other_side(Side side) {
  switch (side.kind) {
    case SideKind::kBelow:
      return {SideKind::kAtLeast, side.value};
    case SideKind::kAtLeast:
      return {SideKind::kBelow, side.value};
    case SideKind::kIs:
      return {SideKind::kIsNot, side.value};
    case SideKind::kIsNot:
      return {SideKind::kIs, side.value};
  }
  return side;
}

// Two axes, or an axis and the outcome, over some trials: how strongly they go together, at the
// best pair of cuts. Permutations leave the sums of rows and columns, so all but one cell of each
// fourfold table is worked out once.
class Together {
 public:
  struct Best {
    double square = 0;  // chi-square of the fourfold table
    std::size_t cut_a = 0, cut_b = 0;
    bool is_less = false;  // fewer on both further sides than expected
  };

  // `of_a` and `of_b`: the part of each trial.
  Together(const Parts& a, const Parts& b, const std::vector<std::uint8_t>& of_a,
           const std::vector<std::uint8_t>& of_b)
      : a_(a), b_(b), table_(static_cast<std::size_t>(a.count * b.count)) {
    const std::vector<double> n_a = further(a, of_a), n_b = further(b, of_b);
    const double n = static_cast<double>(of_a.size());
    for (const double in_a : n_a) {
      for (const double in_b : n_b) {
        const double least = std::min({in_a, n - in_a, in_b, n - in_b});
        expected_.push_back(in_a * in_b / n);
        scale_.push_back(least < kFewest ? 0 : n * n * n / (in_a * (n - in_a) * in_b * (n - in_b)));
      }
    }
  }

  Best best(const std::vector<std::uint8_t>& of_a, const std::vector<std::uint8_t>& of_b) {
    std::fill(table_.begin(), table_.end(), 0);
    const auto width = static_cast<std::size_t>(b_.count);
    for (std::size_t i = 0; i < of_a.size(); ++i) ++table_[of_a[i] * width + of_b[i]];
    // Cells become sums over all parts from one on, where that is how the axis is cut.
    const auto height = static_cast<std::size_t>(a_.count);
    if (a_.is_ordered) {
      for (std::size_t i = (height - 1) * width; i-- > 0;) table_[i] += table_[i + width];
    }
    if (b_.is_ordered) {
      for (std::size_t row = 0; row < height; ++row) {
        for (std::size_t i = width - 1; i-- > 0;)
          table_[row * width + i] += table_[row * width + i + 1];
      }
    }
    Best best;
    const std::size_t cuts_a = a_.sides.size(), cuts_b = b_.sides.size();
    for (std::size_t i = 0; i < cuts_a; ++i) {
      for (std::size_t j = 0; j < cuts_b; ++j) {
        const double more =
            table_[(i + a_.first_cut) * width + j + b_.first_cut] - expected_[i * cuts_b + j];
        const double square = more * more * scale_[i * cuts_b + j];
        if (square > best.square) best = {square, i, j, more < 0};
      }
    }
    return best;
  }

 private:
  // Trials on the further side of each cut.
  static std::vector<double> further(const Parts& parts, const std::vector<std::uint8_t>& of) {
    std::vector<double> n(parts.sides.size());
    for (const std::uint8_t part : of) {
      for (std::size_t cut = 0; cut < n.size(); ++cut) {
        const std::size_t at = cut + parts.first_cut;
        n[cut] += (parts.is_ordered ? part >= at : part == at) ? 1 : 0;
      }
    }
    return n;
  }

  const Parts& a_;
  const Parts& b_;
  std::vector<int> table_;
  std::vector<double> expected_, scale_;  // cut of a x cut of b
};

struct Test {
  double p = 1;
  Together::Best best;
};

// Independence of `a` and `b` over the trials `among`, by permutation of b among trials that have
// the same parts of all of `within`.
Test independence(const Parts& a, const Parts& b, std::vector<std::size_t> among,
                  const std::vector<const Parts*>& within, int permutations, Draws draws) {
  const auto is_before = [&](std::size_t i, std::size_t j) {
    for (const Parts* axis : within) {
      if (axis->of[i] != axis->of[j]) return axis->of[i] < axis->of[j];
    }
    return false;
  };
  std::vector<std::size_t> ends;  // of each run of trials with the same parts
  if (!within.empty()) std::stable_sort(among.begin(), among.end(), is_before);
  std::vector<std::uint8_t> of_a, of_b;
  for (std::size_t i = 0; i < among.size(); ++i) {
    of_a.push_back(a.of[among[i]]);
    of_b.push_back(b.of[among[i]]);
    if (i + 1 == among.size() || is_before(among[i], among[i + 1])) ends.push_back(i + 1);
  }
  Together together(a, b, of_a, of_b);
  Test test{.p = 1, .best = together.best(of_a, of_b)};
  if (test.best.square == 0) return test;
  int exceedances = 0;
  for (int done = 1; done <= permutations; ++done) {
    std::size_t first = 0;
    for (const std::size_t end : ends) {
      for (std::size_t i = end - first; i > 1; --i) {
        std::swap(of_b[first + i - 1], of_b[first + draws.below(static_cast<std::uint32_t>(i))]);
      }
      first = end;
    }
    exceedances += together.best(of_a, of_b).square >= test.best.square * (1 - 1e-9) ? 1 : 0;
    if (exceedances == kEnough) {
      test.p = static_cast<double>(exceedances) / done;
      return test;
    }
  }
  test.p = (exceedances + 1.0) / (permutations + 1.0);
  return test;
}

// The shares of the outcome's variance that an axis explains alone and that two explain beyond
// that, each less what chance alone would give.
struct Shares {
  std::vector<double> first;  // an axis
  std::vector<double> pair;   // a pair of `pairs`
};

// Between-group sum of squares of `failed` in groups, and how many groups have trials.
struct Between {
  double squares = 0;
  double groups = 0;
};

Between between(const std::vector<double>& k, const std::vector<double>& n, double rate) {
  Between result;
  for (std::size_t g = 0; g < n.size(); ++g) {
    if (n[g] == 0) continue;
    const double off = k[g] / n[g] - rate;
    result.squares += n[g] * off * off;
    result.groups += 1;
  }
  return result;
}

// Epsilon squared (Kelley 1935, PNAS 21:554): (between - (groups - 1) within) / total, the share
// that is unbiased but for the ratio. `trials` with repetition where they are resampled.
Shares shares_of(const std::vector<Parts>& parts,
                 const std::vector<std::pair<std::size_t, std::size_t>>& pairs,
                 const std::vector<std::uint8_t>& failed, const std::vector<std::size_t>& trials) {
  const double n = static_cast<double>(trials.size());
  double k = 0;
  for (const std::size_t i : trials) k += failed[i];
  const double rate = k / n, total = n * rate * (1 - rate);
  Shares shares;
  std::vector<Between> firsts;
  std::vector<double> in_k, in_n;
  for (const Parts& axis : parts) {
    in_k.assign(static_cast<std::size_t>(axis.count), 0);
    in_n = in_k;
    for (const std::size_t i : trials) {
      in_k[axis.of[i]] += failed[i];
      in_n[axis.of[i]] += 1;
    }
    firsts.push_back(between(in_k, in_n, rate));
    const Between& b = firsts.back();
    const double within = (total - b.squares) / std::max(n - b.groups, 1.0);
    shares.first.push_back(total > 0 ? (b.squares - (b.groups - 1) * within) / total : 0);
  }
  for (const auto& [a, b] : pairs) {
    const auto width = static_cast<std::size_t>(parts[b].count);
    in_k.assign(static_cast<std::size_t>(parts[a].count) * width, 0);
    in_n = in_k;
    for (const std::size_t i : trials) {
      const std::size_t cell = parts[a].of[i] * width + parts[b].of[i];
      in_k[cell] += failed[i];
      in_n[cell] += 1;
    }
    const Between both = between(in_k, in_n, rate);
    const double within = (total - both.squares) / std::max(n - both.groups, 1.0);
    const double joint = (both.squares - (both.groups - 1) * within) / std::max(total, 1e-300);
    shares.pair.push_back(total > 0 ? joint - shares.first[a] - shares.first[b] : 0);
  }
  return shares;
}

double in_unit(double share) { return std::clamp(share, 0.0, 1.0); }

// The 95 % interval of resampled shares, moved so that their mean is the estimate: resampling adds
// chance of its own to what lies between groups.
stats::Interval interval_of(std::vector<double> resampled, double estimate) {
  if (resampled.empty()) return {0, 1};
  std::sort(resampled.begin(), resampled.end());
  double mean = 0;
  for (const double share : resampled) mean += share / static_cast<double>(resampled.size());
  const auto at = [&](double q) {
    const double place = q * static_cast<double>(resampled.size() - 1);
    return resampled[static_cast<std::size_t>(std::round(place))];
  };
  const double tail = (1 - kConfidence) / 2;
  return {in_unit(estimate + at(tail) - mean), in_unit(estimate + at(1 - tail) - mean)};
}

}  // namespace

bool Side::holds(double x) const {
  switch (kind) {
    case SideKind::kBelow:
      return x < value;
    case SideKind::kAtLeast:
      return x >= value;
    case SideKind::kIs:
      return x == value;
    case SideKind::kIsNot:
      return x != value;
  }
  return false;
}

Axes::Axes(Space space, const AxesOptions& options) : space_(std::move(space)), options_(options) {
  PROBE_CHECK(options.points >= 0 && options.round > 0 && options.permutations > 0,
              "points are drawn, and asked in rounds");
  for (const Axis& axis : space_) {
    PROBE_CHECK(axis.kind == AxisKind::kContinuous || (axis.size >= 1 && axis.size <= 255),
                "a count or a choice has 1 to 255 values");
  }
  points_ = latin_hypercube(space_, static_cast<std::size_t>(options.points), options.seed, "axes");
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
  AxesFinding found;
  std::vector<Point> counted;
  std::vector<std::uint8_t> failed;
  std::vector<std::size_t> all, successes;
  for (std::size_t i = 0; i < told_; ++i) {
    if (outcomes_[i] == Outcome::kLeftOut) {
      ++found.left_out;
      continue;
    }
    all.push_back(counted.size());
    if (outcomes_[i] == Outcome::kSucceeded) successes.push_back(counted.size());
    failed.push_back(outcomes_[i] == Outcome::kFailed ? 1 : 0);
    counted.push_back(points_[i]);
  }
  found.failures = {static_cast<std::int64_t>(all.size() - successes.size()),
                    static_cast<std::int64_t>(all.size())};
  std::vector<Parts> parts;
  for (std::size_t a = 0; a < space_.size(); ++a) parts.push_back(parts_of(space_[a], counted, a));
  Parts outcome{.count = 2, .of = failed, .sides = {{}}};

  // Points that were left out may tie axes to one another. What such an axis does is then looked at
  // where the axes that it is tied to are in one part.
  std::vector<std::vector<bool>> is_tied(space_.size(), std::vector<bool>(space_.size()));
  for (std::size_t a = 0; a < space_.size() && found.left_out > 0; ++a) {
    for (std::size_t b = a + 1; b < space_.size(); ++b) {
      const std::string name = "tied " + std::to_string(a) + " " + std::to_string(b);
      const Test test = independence(parts[a], parts[b], all, {}, options_.permutations,
                                     Draws(options_.seed, name));
      is_tied[a][b] = is_tied[b][a] = test.p <= kTied;
    }
  }
  const auto tied_to = [&](std::size_t a, std::size_t b) {
    std::vector<const Parts*> tied;
    for (std::size_t c = 0; c < space_.size(); ++c) {
      if (c != a && c != b && (is_tied[a][c] || is_tied[b][c])) tied.push_back(&parts[c]);
    }
    return tied;
  };

  std::vector<double> p;
  for (std::size_t a = 0; a < space_.size(); ++a) {
    const Test test = independence(parts[a], outcome, all, tied_to(a, a), options_.permutations,
                                   Draws(options_.seed, "axis " + std::to_string(a)));
    AxisEffect effect;
    if (!parts[a].sides.empty()) {
      effect.side = parts[a].sides[test.best.cut_a];
      if (test.best.is_less) effect.side = other_side(effect.side);
    }
    for (std::size_t i = 0; i < counted.size(); ++i) {
      stats::Count& count = effect.side.holds(counted[i][a]) ? effect.there : effect.elsewhere;
      ++count.n;
      count.k += failed[i];
    }
    p.push_back(test.p);
    found.axes.push_back(effect);
  }
  const std::vector<double> axis_p = stats::holm(p);
  for (std::size_t a = 0; a < space_.size(); ++a) {
    found.axes[a].p = axis_p[a];
    found.axes[a].matters = axis_p[a] <= options_.error;
  }

  p.clear();
  for (std::size_t a = 0; a < space_.size(); ++a) {
    for (std::size_t b = a + 1; b < space_.size(); ++b) {
      const std::string name = "pair " + std::to_string(a) + " " + std::to_string(b);
      const Test test = independence(parts[a], parts[b], successes, tied_to(a, b),
                                     options_.permutations, Draws(options_.seed, name));
      PairEffect effect;
      effect.a = a;
      effect.b = b;
      // Which of the four corners fails most.
      if (!parts[a].sides.empty() && !parts[b].sides.empty()) {
        const Side far_a = parts[a].sides[test.best.cut_a];
        const Side far_b = parts[b].sides[test.best.cut_b];
        std::array<stats::Count, 4> corner{};  // bit 0: on the further side of a, bit 1: of b
        for (std::size_t i = 0; i < counted.size(); ++i) {
          const std::size_t which =
              (far_a.holds(counted[i][a]) ? 1U : 0U) + (far_b.holds(counted[i][b]) ? 2U : 0U);
          ++corner[which].n;
          corner[which].k += failed[i];
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
        effect.synergy = test.best.is_less == is_diagonal;
      }
      effect.tested = !is_tied[a][b];
      p.push_back(effect.tested ? test.p : 1);
      found.pairs.push_back(effect);
    }
  }
  const std::vector<double> pair_p = stats::holm(p);
  std::vector<std::pair<std::size_t, std::size_t>> named;
  for (std::size_t i = 0; i < found.pairs.size(); ++i) {
    found.pairs[i].p = pair_p[i];
    found.pairs[i].named = pair_p[i] <= options_.error;
    if (found.pairs[i].named) named.emplace_back(found.pairs[i].a, found.pairs[i].b);
  }

  // Shares and their intervals.
  if (all.empty()) return found;
  const Shares shares = shares_of(parts, named, failed, all);
  const auto total_of = [&](const Shares& of, std::size_t a) {
    double total = of.first[a];
    for (std::size_t i = 0; i < named.size(); ++i) {
      if (named[i].first == a || named[i].second == a) total += of.pair[i];
    }
    return total;
  };
  std::vector<std::vector<double>> first(space_.size()), total(space_.size());
  Draws draws(options_.seed, "resamples");
  std::vector<std::size_t> drawn(all.size());
  for (int r = 0; r < options_.resamples; ++r) {
    for (std::size_t& i : drawn) i = draws.below(static_cast<std::uint32_t>(all.size()));
    const Shares again = shares_of(parts, named, failed, drawn);
    for (std::size_t a = 0; a < space_.size(); ++a) {
      first[a].push_back(again.first[a]);
      total[a].push_back(total_of(again, a));
    }
  }
  for (std::size_t a = 0; a < space_.size(); ++a) {
    AxisEffect& effect = found.axes[a];
    effect.first = in_unit(shares.first[a]);
    effect.total = in_unit(total_of(shares, a));
    effect.first_interval = interval_of(std::move(first[a]), shares.first[a]);
    effect.total_interval = interval_of(std::move(total[a]), total_of(shares, a));
  }
  std::size_t at = 0;
  for (PairEffect& pair : found.pairs) {
    if (pair.named) pair.share = in_unit(shares.pair[at++]);
  }
  return found;
}

}  // namespace probe::search
