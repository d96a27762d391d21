#include "runtime/search/method/tolerance_grid.h"

#include <algorithm>
#include <cmath>

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

// Success at `x` over success at 0: floor + (1 - floor) G, G a logistic curve over its own value at
// 0 that is `at` at `place`. With E = exp(place / slope),
//   G(x) = at (E - 1) / (at E - 1 + (1 - at) exp(x / slope)),
// here divided by E so that steps do not overflow.
double curve(double x, double place, double slope, double floor, double at) {
  const double shrunk = std::exp(-place / slope);
  const double rise = std::exp(std::min((x - place) / slope, 700.0));
  const double g = at * (1 - shrunk) / (at - shrunk + (1 - at) * rise);
  return floor + (1 - floor) * g;
}

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

}  // namespace

void ToleranceGrid::add_curve(std::size_t group, double tolerance, double slope, double floor,
                              double prior) {
  // A floor of half and more is told by where half of its own fall is.
  const double at = floor < 0.5 ? (0.5 - floor) / (1 - floor) : 0.5;
  const double axis = levels_ - 1;
  for (int level = 0; level < levels_; ++level) {
    const double success = floor >= 1 ? 1 : curve(level / axis, tolerance, slope, floor, at);
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
      for (const Weighed& floor : kFloors) {
        add_curve(cell, tolerance, slope, floor.value, inside * floor.prior / slopes);
      }
    }
  }
  add_curve(kInside, 1, 1, 1, kFlat);
  for (std::size_t place = 0; place < kHigherPlaces; ++place) {
    const double x = (static_cast<double>(place) + 0.5) / kHigherPlaces;
    for (const double slope : kSlopes) {
      for (const double floor : kHigherFloors) {
        add_curve(kInside, x, slope, floor,
                  kHigherFloor / (kHigherPlaces * slopes * kHigherFloors.size()));
      }
    }
  }
  for (std::size_t place = 0; place < kBeyondPlaces; ++place) {
    const double x = 1 + (static_cast<double>(place) + 0.5) / (2 * kBeyondPlaces);
    for (const double slope : kSlopes) {
      add_curve(kInside, x, slope, 0, kBeyondEnd / (kBeyondPlaces * slopes));
    }
  }
  first_of_.push_back(curve_count());
  PROBE_CHECK(curve_count() == kCurves, "every curve has its place");
  groups_.fill(1);
  normalise();
}

void ToleranceGrid::update(int level, bool succeeded) {
  const float* at = curve_.data() + static_cast<std::size_t>(level) * kCurves;
  for (std::size_t group = 0; group < kGroups; ++group) {
    if (groups_[group] == 0) continue;
    for (std::size_t c = first_of_[group]; c < first_of_[group + 1]; ++c) {
      const double g = at[c];
      double* weight = weight_.data() + c * kRates.size();
      if (succeeded) {
        for (std::size_t k = 0; k < kRates.size(); ++k) weight[k] *= kRates[k] * g;
      } else {
        for (std::size_t k = 0; k < kRates.size(); ++k) weight[k] *= 1 - kRates[k] * g;
      }
    }
  }
}

void ToleranceGrid::normalise() {
  double sum = 0;
  for (std::size_t group = 0; group < kGroups; ++group) {
    if (groups_[group] == 0) continue;
    double in_group = 0;
    for (const double weight : weights_of(group)) in_group += weight;
    groups_[group] = in_group;
    sum += in_group;
  }
  PROBE_CHECK(sum > 0, "some curve explains what was seen");
  for (std::size_t group = 0; group < kGroups; ++group) {
    if (groups_[group] == 0) continue;
    groups_[group] /= sum;
    if (groups_[group] < kGone) groups_[group] = 0;
    for (double& weight : weights_of(group)) {
      weight /= sum;
      if (weight < kGone) weight = 0;
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
    for (std::size_t i = 0; i < levels.size(); ++i) {
      const float* at = curve_.data() + static_cast<std::size_t>(levels[i]) * kCurves;
      double success = 0;
      for (std::size_t c = first_of_[group]; c < first_of_[group + 1]; ++c)
        success += rate[c] * at[c];
      bins.success[i * count + bin_of[group]] += success;
    }
  }
  for (std::size_t i = 0; i < levels.size(); ++i) {
    for (std::size_t b = 0; b < count; ++b) {
      double& success = bins.success[i * count + b];
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
  for (std::size_t i = 0; i < levels.size(); ++i) {
    for (std::size_t b = 0; b < bin_count; ++b) {
      noise[i] += all.weight[b] * entropy(all.success[i * bin_count + b]);
    }
  }
  // joint[v][b]: the probability of bin b and of the v-th way the chosen trials may come out.
  std::vector<double> joint = all.weight;
  std::vector<int> chosen;
  while (chosen.size() < count) {
    const std::size_t ways = joint.size() / bin_count;
    std::size_t best = 0;
    double best_gain = -1e300;
    for (std::size_t i = 0; i < levels.size(); ++i) {
      const double* success = all.success.data() + i * bin_count;
      double gain = -noise[i];
      for (std::size_t v = 0; v < ways; ++v) {
        double yes = 0, either = 0;
        for (std::size_t b = 0; b < bin_count; ++b) {
          yes += joint[v * bin_count + b] * success[b];
          either += joint[v * bin_count + b];
        }
        gain += minus_x_log_x(yes) + minus_x_log_x(either - yes) - minus_x_log_x(either);
      }
      if (coarse(gain) > best_gain) {
        best_gain = coarse(gain);
        best = i;
      }
    }
    chosen.push_back(levels[best]);
    std::vector<double> split(2 * joint.size());
    const double* success = all.success.data() + best * bin_count;
    for (std::size_t v = 0; v < ways; ++v) {
      for (std::size_t b = 0; b < bin_count; ++b) {
        const double p = joint[v * bin_count + b];
        split[2 * v * bin_count + b] = p * success[b];
        split[(2 * v + 1) * bin_count + b] = p * (1 - success[b]);
      }
    }
    joint = std::move(split);
  }
  return chosen;
}

}  // namespace probe::search
