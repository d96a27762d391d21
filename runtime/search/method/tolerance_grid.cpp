#include "runtime/search/method/tolerance_grid.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <utility>

#include "runtime/base/check.h"

namespace probe::search {
namespace {

struct Weighed {
  double value, prior;
};

// Slopes in shares of the axis: 0.002 is a step between any two levels, 0.3 falls all along it.
constexpr std::array<double, 7> kSlopes = {0.002, 0.008, 0.02, 0.04, 0.08, 0.15, 0.3};
// Floors in shares of the own rate: most policies fail for good.
constexpr std::array<Weighed, 4> kFloors = {{{0.005, 0.55}, {0.1, 0.2}, {0.25, 0.15}, {0.4, 0.1}}};
// Of no fall to half: flat, a fall to a higher floor somewhere, one that is over beyond the end.
constexpr double kFlat = 0.1, kHigherFloor = 0.08, kBeyondEnd = 0.07;
constexpr std::array<double, 2> kHigherFloors = {0.65, 0.82};
constexpr std::size_t kHigherPlaces = 10, kBeyondPlaces = 10;
constexpr std::size_t kCurves = ToleranceGrid::kInside * kSlopes.size() * kFloors.size() + 1 +
                                kHigherPlaces * kSlopes.size() * kHigherFloors.size() +
                                kBeyondPlaces * kSlopes.size();

// Bins that a batch is chosen with, each about as probable; a few more where the curves change.
constexpr std::size_t kBins = 48;

// A group of less is not thought of when a batch is chosen; a weight of less is 0 from then on.
constexpr double kNegligible = 1e-7, kGone = 1e-20;

double entropy(double p) {
  double sum = 0;
  if (p > 0) sum -= p * std::log(p);
  if (p < 1) sum -= (1 - p) * std::log1p(-p);
  return sum;
}

double minus_x_log_x(double x) { return x > 0 ? -x * std::log(x) : 0; }

// Gains that differ by less than the arithmetic of two machines do not decide.
double coarse(double gain) { return std::round(gain * 1e9); }

// How the trials of a batch may come out together. Those of one level are told by how many of them
// succeed, not by which.
class WaysOut {
 public:
  explicit WaysOut(const std::vector<double>& bins) { joint_[0] = bins; }

  // Of each way the probability of each bin and of that way.
  const std::map<std::uint64_t, std::vector<double>>& joint() const { return joint_; }

  // One more trial, at `level`, whose chance to succeed in a bin is success[bin].
  void add(int level, const std::vector<double>& success) {
    const auto at = std::find(levels_.begin(), levels_.end(), level);
    const auto place = static_cast<std::size_t>(at - levels_.begin());
    if (at == levels_.end()) levels_.push_back(level);
    PROBE_CHECK(place < 8, "a batch has 8 trials at most");
    std::map<std::uint64_t, std::vector<double>> split;
    for (const auto& [successes, joint] : joint_) {
      std::vector<double>& fails = split[successes];
      std::vector<double>& succeeds = split[successes + (std::uint64_t{1} << (8 * place))];
      fails.resize(joint.size());
      succeeds.resize(joint.size());
      for (std::size_t b = 0; b < joint.size(); ++b) {
        fails[b] += joint[b] * (1 - success[b]);
        succeeds[b] += joint[b] * success[b];
      }
    }
    joint_ = std::move(split);
  }

 private:
  std::vector<int> levels_;  // that are chosen
  // By the successes at each of levels_, a byte for each.
  std::map<std::uint64_t, std::vector<double>> joint_;
};

}  // namespace

// The exponentials of curves that have a place and a slope in common.
struct ToleranceGrid::Fall {
  Fall(int levels, double place, double slope) : shrunk(std::exp(-place / slope)) {
    const double axis = levels - 1;
    for (int level = 0; level < levels; ++level) {
      rise.push_back(std::exp(std::min((level / axis - place) / slope, 700.0)));
    }
  }

  // Success at a level over success at 0: floor + (1 - floor) G, G a logistic curve over its own
  // value at 0 that is `at` at the place. With E = exp(place / slope),
  //   G(x) = at (E - 1) / (at E - 1 + (1 - at) exp(x / slope)),
  // here divided by E so that steps do not overflow.
  double success(int level, double floor, double at) const {
    const double up = rise[static_cast<std::size_t>(level)];
    return floor + (1 - floor) * (at * (1 - shrunk) / (at - shrunk + (1 - at) * up));
  }

  double shrunk = 0;
  std::vector<double> rise;  // a level
};

void ToleranceGrid::add_curve(std::size_t group, const Fall& fall, double floor, double prior) {
  // A floor of half and more is told by where half of its own fall is.
  const double at = floor < 0.5 ? (0.5 - floor) / (1 - floor) : 0.5;
  for (int level = 0; level < levels_; ++level) {
    const double success = floor >= 1 ? 1 : fall.success(level, floor, at);
    curve_[static_cast<std::size_t>(level) * kCurves + curve_count()] = static_cast<float>(success);
  }
  while (first_of_.size() <= group) first_of_.push_back(curve_count());
  ++curves_;
  weight_.insert(weight_.end(), kRates.size(), prior);
}

ToleranceGrid::ToleranceGrid(int levels) : levels_(levels) {
  PROBE_CHECK(levels >= 2, "an axis has its own value and an end");
  curve_.resize(static_cast<std::size_t>(levels) * kCurves);
  weight_.reserve(kCurves * kRates.size());
  const double slopes = static_cast<double>(kSlopes.size());
  const double inside = (1 - kFlat - kHigherFloor - kBeyondEnd) / static_cast<double>(kInside);
  for (std::size_t cell = 0; cell < kInside; ++cell) {
    const double tolerance = (static_cast<double>(cell) + 0.5) / static_cast<double>(kInside);
    for (const double slope : kSlopes) {
      const Fall fall(levels, tolerance, slope);
      for (const Weighed& floor : kFloors) {
        add_curve(cell, fall, floor.value, inside * floor.prior / slopes);
      }
    }
  }
  add_curve(kInside, Fall(levels, 1, 1), 1, kFlat);
  for (std::size_t place = 0; place < kHigherPlaces; ++place) {
    const double x = (static_cast<double>(place) + 0.5) / kHigherPlaces;
    for (const double slope : kSlopes) {
      const Fall fall(levels, x, slope);
      for (const double floor : kHigherFloors) {
        add_curve(kInside, fall, floor,
                  kHigherFloor / (kHigherPlaces * slopes * kHigherFloors.size()));
      }
    }
  }
  for (std::size_t place = 0; place < kBeyondPlaces; ++place) {
    const double x = 1 + (static_cast<double>(place) + 0.5) / (2 * kBeyondPlaces);
    for (const double slope : kSlopes) {
      add_curve(kInside, Fall(levels, x, slope), 0, kBeyondEnd / (kBeyondPlaces * slopes));
    }
  }
  first_of_.push_back(curve_count());
  PROBE_CHECK(curve_count() == kCurves, "every curve has its place");
  groups_.fill(1);
  normalise();
}

void ToleranceGrid::update(std::span<const Trial> trials) {
  for (std::size_t group = 0; group < kGroups; ++group) {
    if (groups_[group] == 0) continue;
    for (std::size_t c = first_of_[group]; c < first_of_[group + 1]; ++c) {
      double* weight = weight_.data() + c * kRates.size();
      std::array<double, kRates.size()> after;
      std::copy_n(weight, kRates.size(), after.begin());
      for (const Trial& trial : trials) {
        const double g = curve_[static_cast<std::size_t>(trial.level) * kCurves + c];
        if (trial.succeeded) {
          for (std::size_t k = 0; k < kRates.size(); ++k) after[k] *= kRates[k] * g;
        } else {
          for (std::size_t k = 0; k < kRates.size(); ++k) after[k] *= 1 - kRates[k] * g;
        }
      }
      std::copy_n(after.begin(), kRates.size(), weight);
    }
  }
  normalise();
}

void ToleranceGrid::normalise() {
  double sum = 0;
  for (std::size_t group = 0; group < kGroups; ++group) {
    if (groups_[group] == 0) continue;
    std::array<double, kRates.size()> of_rate{};  // sums that do not wait for one another
    const std::span<const double> weights = weights_of(group);
    for (std::size_t i = 0; i < weights.size(); i += kRates.size()) {
      for (std::size_t k = 0; k < kRates.size(); ++k) of_rate[k] += weights[i + k];
    }
    groups_[group] = std::accumulate(of_rate.begin(), of_rate.end(), 0.0);
    sum += groups_[group];
  }
  PROBE_CHECK(sum > 0, "some curve explains what was seen");
  const double scale = 1 / sum;
  for (std::size_t group = 0; group < kGroups; ++group) {
    if (groups_[group] == 0) continue;
    groups_[group] *= scale;
    if (groups_[group] < kGone) groups_[group] = 0;
    for (double& weight : weights_of(group)) {
      const double scaled = weight * scale;
      weight = scaled < kGone ? 0 : scaled;
    }
  }
}

std::span<double> ToleranceGrid::weights_of(std::size_t group) {
  return std::span(weight_).subspan(first_of_[group] * kRates.size(),
                                    (first_of_[group + 1] - first_of_[group]) * kRates.size());
}

double ToleranceGrid::beyond(int level) const {
  const double end = level * static_cast<double>(kInside) / (levels_ - 1);  // in cells
  double sum = groups_[kInside];
  for (std::size_t cell = 0; cell < kInside; ++cell) {
    sum += groups_[cell] * std::clamp(static_cast<double>(cell) + 1 - end, 0.0, 1.0);
  }
  return sum;
}

double ToleranceGrid::quantile(double share, int last) const {
  const double level_of_cell = (levels_ - 1) / static_cast<double>(kInside);
  double below = 0;
  for (std::size_t cell = 0; cell < kInside; ++cell) {
    if (below + groups_[cell] >= share && groups_[cell] > 0) {
      const double in_cell = (share - below) / groups_[cell];
      return std::min((static_cast<double>(cell) + in_cell) * level_of_cell,
                      static_cast<double>(last));
    }
    below += groups_[cell];
  }
  return last;
}

ToleranceGrid::Bins ToleranceGrid::bins(std::span<const int> levels) const {
  // Neighbouring groups share a bin until it is probable enough; no fall is a bin of its own.
  std::array<std::size_t, kGroups> bin_of{};
  Bins bins;
  for (std::size_t group = 0; group < kGroups; ++group) {
    const bool is_new = group == 0 || group == kInside || bins.weight.back() >= 1.0 / kBins;
    if (is_new) bins.weight.push_back(0);
    bins.weight.back() += groups_[group];
    bin_of[group] = bins.weight.size() - 1;
  }
  const std::size_t count = bins.weight.size();
  bins.success.assign(levels.size() * count, 0);
  std::vector<double> rate(kCurves);  // weight times own rate, of a curve
  for (std::size_t group = 0; group < kGroups; ++group) {
    if (groups_[group] < kNegligible) continue;
    for (std::size_t c = first_of_[group]; c < first_of_[group + 1]; ++c) {
      for (std::size_t k = 0; k < kRates.size(); ++k) {
        rate[c] += weight_[c * kRates.size() + k] * kRates[k];
      }
    }
    double* of_bin = bins.success.data() + bin_of[group] * levels.size();
    const auto row = [&](std::size_t i) {
      return curve_.data() + static_cast<std::size_t>(levels[i]) * kCurves;
    };
    // Four levels at a time, whose sums do not wait for one another.
    std::size_t i = 0;
    for (; i + 4 <= levels.size(); i += 4) {
      const float *r0 = row(i), *r1 = row(i + 1), *r2 = row(i + 2), *r3 = row(i + 3);
      double s0 = 0, s1 = 0, s2 = 0, s3 = 0;
      for (std::size_t c = first_of_[group]; c < first_of_[group + 1]; ++c) {
        s0 += rate[c] * r0[c];
        s1 += rate[c] * r1[c];
        s2 += rate[c] * r2[c];
        s3 += rate[c] * r3[c];
      }
      of_bin[i] += s0;
      of_bin[i + 1] += s1;
      of_bin[i + 2] += s2;
      of_bin[i + 3] += s3;
    }
    for (; i < levels.size(); ++i) {
      double success = 0;
      for (std::size_t c = first_of_[group]; c < first_of_[group + 1]; ++c)
        success += rate[c] * row(i)[c];
      of_bin[i] += success;
    }
  }
  for (std::size_t b = 0; b < count; ++b) {
    for (std::size_t i = 0; i < levels.size(); ++i) {
      double& success = bins.success[b * levels.size() + i];
      success = bins.weight[b] > 0 ? std::min(1.0, success / bins.weight[b]) : 0;
    }
  }
  return bins;
}

std::vector<int> ToleranceGrid::most_informative(std::span<const int> levels,
                                                 std::size_t count) const {
  const Bins all = bins(levels);
  const std::size_t bin_count = all.weight.size();
  std::vector<double> noise(levels.size());  // entropy of an outcome whose bin is known
  for (std::size_t b = 0; b < bin_count; ++b) {
    for (std::size_t i = 0; i < levels.size(); ++i) {
      noise[i] += all.weight[b] * entropy(all.success[b * levels.size() + i]);
    }
  }
  WaysOut ways(all.weight);
  std::vector<int> chosen;
  std::vector<double> gain(levels.size()), yes(levels.size());
  while (chosen.size() < count) {
    for (std::size_t i = 0; i < levels.size(); ++i) gain[i] = -noise[i];
    for (const auto& [successes, joint] : ways.joint()) {
      double either = 0;
      std::fill(yes.begin(), yes.end(), 0.0);
      for (std::size_t b = 0; b < bin_count; ++b) {
        const double p = joint[b];
        const double* success = all.success.data() + b * levels.size();
        for (std::size_t i = 0; i < levels.size(); ++i) yes[i] += p * success[i];
        either += p;
      }
      const double of_either = minus_x_log_x(either);
      for (std::size_t i = 0; i < levels.size(); ++i) {
        gain[i] += minus_x_log_x(yes[i]) + minus_x_log_x(either - yes[i]) - of_either;
      }
    }
    std::size_t best = 0;
    for (std::size_t i = 1; i < levels.size(); ++i) {
      if (coarse(gain[i]) > coarse(gain[best])) best = i;
    }
    chosen.push_back(levels[best]);
    std::vector<double> success(bin_count);
    for (std::size_t b = 0; b < bin_count; ++b) success[b] = all.success[b * levels.size() + best];
    ways.add(levels[best], success);
  }
  return chosen;
}

}  // namespace probe::search
