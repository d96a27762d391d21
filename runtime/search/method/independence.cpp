#include "runtime/search/method/independence.h"

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace probe::search {
namespace {

// A side of a cut that holds fewer trials is no side.
constexpr int kFewest = 5;
// Exceedances after which a p value is known well enough (Besag and Clifford's h).
constexpr int kEnough = 10;

// Two axes, or an axis and the outcome, over some trials: how strongly they go together, at the
// best pair of cuts. Permutations leave the sums of rows and columns, so all but one cell of each
// fourfold table is worked out once.
class Together {
 public:
  // `of_a` and `of_b`: the part of each trial.
  Together(const Parts& a, const Parts& b, const std::vector<std::uint8_t>& of_a,
           const std::vector<std::uint8_t>& of_b)
      : a_(a), b_(b), table_(static_cast<std::size_t>(a.count * b.count)), other_(table_) {
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

  BestCuts best(const std::vector<std::uint8_t>& of_a, const std::vector<std::uint8_t>& of_b) {
    std::fill(table_.begin(), table_.end(), 0);
    const auto width = static_cast<std::size_t>(b_.count);
    // Counted in two tables in turn, which do not wait for one another.
    std::fill(other_.begin(), other_.end(), 0);
    for (std::size_t i = 0; i + 1 < of_a.size(); i += 2) {
      ++table_[of_a[i] * width + of_b[i]];
      ++other_[of_a[i + 1] * width + of_b[i + 1]];
    }
    if (of_a.size() % 2 == 1) ++table_[of_a.back() * width + of_b.back()];
    for (std::size_t i = 0; i < table_.size(); ++i) table_[i] += other_[i];
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
    BestCuts best;
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
  std::vector<int> table_, other_;
  std::vector<double> expected_, scale_;  // cut of a x cut of b
};

// Trials that are permuted among one another: the parts of one axis, between the trials of all
// others. The `fixed` first trials are one part of the other axis, so that their order is no
// matter.
struct Run {
  std::size_t first = 0, size = 0, fixed = 0;
  bool is_a = false;  // whose parts move
};

// The most common part, and how often.
std::pair<std::uint8_t, std::size_t> most_common(const Parts& parts,
                                                 std::span<const std::size_t> trials) {
  std::vector<std::size_t> n(static_cast<std::size_t>(parts.count));
  for (const std::size_t i : trials) ++n[parts.of[i]];
  const auto most = std::max_element(n.begin(), n.end());
  return {static_cast<std::uint8_t>(most - n.begin()), *most};
}

Run run_of(const Parts& a, const Parts& b, std::span<std::size_t> trials,
           std::vector<std::uint8_t>& of_a, std::vector<std::uint8_t>& of_b) {
  const auto [part_a, n_a] = most_common(a, trials);
  const auto [part_b, n_b] = most_common(b, trials);
  const bool is_a = n_b >= n_a;
  const Parts& still = is_a ? b : a;
  const std::uint8_t part = is_a ? part_b : part_a;
  std::stable_partition(trials.begin(), trials.end(),
                        [&](std::size_t i) { return still.of[i] == part; });
  const Run run{of_a.size(), trials.size(), std::max(n_a, n_b), is_a};
  for (const std::size_t i : trials) {
    of_a.push_back(a.of[i]);
    of_b.push_back(b.of[i]);
  }
  return run;
}

}  // namespace

IndependenceTest independence(const Parts& a, const Parts& b, std::vector<std::size_t> among,
                              const std::vector<const Parts*>& within, int permutations,
                              Draws draws) {
  const auto is_before = [&](std::size_t i, std::size_t j) {
    for (const Parts* axis : within) {
      if (axis->of[i] != axis->of[j]) return axis->of[i] < axis->of[j];
    }
    return false;
  };
  std::vector<std::uint8_t> of_a, of_b;
  std::vector<Run> runs;
  if (!within.empty()) std::stable_sort(among.begin(), among.end(), is_before);
  for (std::size_t first = 0, i = 0; i < among.size(); ++i) {
    if (i + 1 < among.size() && !is_before(among[i], among[i + 1])) continue;
    runs.push_back(run_of(a, b, std::span(among).subspan(first, i + 1 - first), of_a, of_b));
    first = i + 1;
  }
  Together together(a, b, of_a, of_b);
  IndependenceTest test{.p = 1, .best = together.best(of_a, of_b)};
  if (test.best.square == 0) return test;
  int exceedances = 0;
  for (int done = 1; done <= permutations; ++done) {
    for (const Run& run : runs) {
      std::uint8_t* permuted = (run.is_a ? of_a : of_b).data() + run.first;
      for (std::size_t i = run.size; i > run.fixed; --i) {
        std::swap(permuted[i - 1], permuted[draws.below(static_cast<std::uint32_t>(i))]);
      }
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

}  // namespace probe::search
