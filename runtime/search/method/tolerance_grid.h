// The posterior of the psi method over tolerance, slope, own rate and floor. A part of boundary;
// knows nothing of budgets and stages.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace probe::search {

class ToleranceGrid {
 public:
  // Tolerances inside the axis, each the middle of a cell; one more group holds all curves that do
  // not fall to half inside it.
  static constexpr std::size_t kInside = 200;
  static constexpr std::size_t kGroups = kInside + 1;

  explicit ToleranceGrid(int levels);

  struct Trial {
    int level = 0;
    bool succeeded = false;
  };
  void update(std::span<const Trial> trials);

  // The posterior of each group; sums to 1.
  const std::array<double, kGroups>& groups() const { return groups_; }
  // The posterior probability that half is not reached up to `level`.
  double beyond(int level) const;
  // The `share`-quantile of the tolerance in levels, `last` at most.
  double quantile(double share, int last) const;

  // Up to `count` of `levels` whose outcomes together tell most of the tolerance.
  std::vector<int> most_informative(std::span<const int> levels, std::size_t count) const;

 private:
  static constexpr std::array<double, 12> kRates = {0.1, 0.2, 0.3,  0.4,  0.5,  0.6,
                                                    0.7, 0.8, 0.88, 0.94, 0.98, 0.999};
  struct Bins {
    std::vector<double> weight;   // a bin
    std::vector<double> success;  // bin x level
  };
  struct Fall;
  // One curve at every level, and its prior; curves of a group stand together.
  void add_curve(std::size_t group, const Fall& fall, double floor, double prior);
  std::span<double> weights_of(std::size_t group);
  void normalise();
  Bins bins(std::span<const int> levels) const;

  std::size_t curve_count() const { return curves_; }  // so far

  int levels_ = 0;
  std::size_t curves_ = 0;
  std::vector<std::size_t> first_of_;     // the first curve of a group; and the end
  std::vector<float> curve_;              // level x curve: success over own rate
  std::vector<double> weight_;            // curve x rate
  std::array<double, kGroups> groups_{};  // a group of 0 is gone for good
};

}  // namespace probe::search
