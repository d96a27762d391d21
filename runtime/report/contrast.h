// Two rates on the same starts: what differs, how surely, and what would tell. A contrast's rows
// are pairs of outcomes, one row a start of a task.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "runtime/base/numbering.h"
#include "runtime/stats/clustered.h"
#include "runtime/stats/here_and_anew.h"

namespace probe::report {

// A difference is real where its adjusted p is at most this.
inline constexpr double kAlpha = 0.05;

// What the data answer to one of the two questions of a difference (runtime/stats/here_and_anew.h).
struct Answer {
  stats::Interval interval;          // 95 %
  double p = 1;                      // exact: sign flips, or dealing out unpaired starts
  double adjusted = 1;               // for the table's family, see there
  std::int64_t family = 1;           // tests that it was adjusted for
  std::vector<std::int64_t> nets;    // first less second, in episodes, by unit: a start or a place;
                                     // empty when not paired
  std::optional<double> detectable;  // where it is not real: the difference that as many units,
                                     // with as many that differ, find with 80 % power
  std::optional<std::int64_t> more;  // where it is not real: the units that are missing for finding
                                     // the difference that was seen, adjusted, with 80 % power

  bool is_real() const { return adjusted <= kAlpha; }
};

// The difference of two rates, on the same starts where there are such.
struct Contrast {
  stats::PairTable pairs;  // of episodes; empty when not paired
  stats::Count first, second;
  std::int64_t starts = 0;  // rows of task and start
  bool paired = true;
  double difference = 0;  // first - second
  Answer here;            // on these starts; units place by place, in each the tasks in their order
  Answer anew;            // for starts never tried; places in the order of tasks and starts
};

// Adds one pair: what was true of the first and of the second.
void count_pair(stats::PairTable& table, bool a, bool b);

// Pairs of tasks, a row a start. `group` tells starts of one place apart: they are exchanged one by
// one unless their rows share it.
class PairRows {
 public:
  // The row of the start that was added last, or of a `fresh` one.
  stats::PairTable& at(int task, std::uint32_t place, int group, bool fresh);
  bool empty() const { return rows_.empty(); }
  const std::vector<stats::PlacedPairs>& rows() const { return rows_; }  // without numbered starts
  Contrast contrast() const;

 private:
  std::vector<stats::PlacedPairs> by_place() const;  // with their starts numbered place by place

  std::vector<stats::PlacedPairs> rows_;
  std::vector<int> groups_;  // by row
  Numbering<std::uint32_t> places_;
  Numbering<int> tasks_;
};

// A paired contrast as one of its tests sees it: one outcome a unit. `discordance` is the share of
// units with a winner; `episodes` turns a difference of shares of units into one of rates.
struct UnitDesign {
  std::int64_t units = 0, differ = 0;
  double discordance = 0;
  double episodes = 1;
};
UnitDesign unit_design(const Contrast& contrast, const Answer& answer);

// Fills `detectable` and `more` of the answers that are not real; both adjusted before.
void say_what_would_tell(Contrast& contrast);

// Adjusts both answers of the contrasts of one family, each question for itself.
enum class Adjustment : std::uint8_t { kHolm, kBenjaminiHochberg };
void adjust(std::span<Contrast* const> family, Adjustment method);

}  // namespace probe::report
