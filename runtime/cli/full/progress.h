// What `run` says while it runs: one line that is redrawn on a terminal; in a log one at once, one
// every ten seconds, and one a minute when it takes longer. Pure: the clock and the terminal's
// width are given, nothing is printed.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "runtime/follow/follow.h"
#include "runtime/run/run.h"
#include "runtime/stats/intervals.h"

namespace probe::cli {

using follow::duration_text;

class Progress {
 public:
  // Seconds of a clock that only goes forward, here and below.
  explicit Progress(double now) : begun_(now) {}

  void add(const run::RunProgress& progress);

  // At most `columns` wide: what does not fit is left out, rates from the right, then the bar.
  // `color`: the bar's full part in green.
  std::string terminal_line(double now, std::size_t columns, bool color) const;

  // A line with everything, when it is time for one; nothing otherwise.
  std::optional<std::string> log_line(double now);

 private:
  struct Rate {
    std::string name;
    stats::Count count;
  };

  int finished() const { return done_ + skipped_; }
  std::string counts() const;
  std::string rate_text(const Rate& rate) const;
  std::string time_left(double now) const;

  double begun_;
  std::optional<double> logged_;
  int done_ = 0, skipped_ = 0, total_ = 0, invalid_ = 0, not_attempted_ = 0;
  std::vector<Rate> rates_;  // of this call's valid episodes
  bool is_at_most_ = false;  // how many there will be depends on how they end
};

}  // namespace probe::cli
