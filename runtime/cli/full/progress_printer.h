// Prints what `run` and its kin say while they run.
#pragma once

#include <chrono>
#include <cstdlib>

#include "runtime/base/say.h"
#include "runtime/cli/full/drawn_line.h"
#include "runtime/cli/full/progress.h"
#include "runtime/cli/full/run_options.h"

namespace probe::cli {

// A line that is redrawn on a terminal, one now and then elsewhere, and one for each episode that
// went wrong.
class ProgressPrinter {
 public:
  void operator()(const run::RunProgress& progress) {
    const double now = now_s();
    progress_.add(progress);
    if (progress.row && progress.row->invalid) {
      line_.clear();
      print_invalid(*progress.row);
    }
    const auto columns = DrawnLine::columns();
    if (!columns) {
      if (const auto line = progress_.log_line(now)) say("{}\n", *line);
      return;
    }
    constexpr double kRedrawEvery = 0.1;  // s
    if (now - drawn_ < kRedrawEvery && progress.done + progress.skipped < progress.total) return;
    drawn_ = now;
    // The last column stays free: a full line would wrap.
    line_.draw(progress_.terminal_line(now, *columns - 1, color_));
  }
  void clear() { line_.clear(); }

 private:
  static double now_s() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
  }

  Progress progress_{now_s()};
  double drawn_ = 0;
  bool color_ = std::getenv("NO_COLOR") == nullptr;
  DrawnLine line_;
};

}  // namespace probe::cli
