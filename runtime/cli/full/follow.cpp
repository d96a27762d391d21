#include "runtime/cli/full/follow.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <memory>

#include "runtime/base/clock.h"
#include "runtime/base/say.h"
#include "runtime/cli/verbs.h"
#include "runtime/cli/watch.h"
#include "runtime/follow/drawing.h"
#include "runtime/follow/follow.h"
#include "runtime/follow/page.h"

namespace probe::cli {
namespace {

using Clock = std::chrono::steady_clock;

class Drawn {
 public:
  void draw(const std::vector<std::string>& lines) {
    struct winsize size {};
    const bool is_known = ::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0;
    const std::string text = drawing_.next(lines, is_known ? size.ws_col : 0, is_known ? size.ws_row : 0);
    std::fwrite(text.data(), 1, text.size(), stdout);
    std::fflush(stdout);
  }

 private:
  follow::Drawing drawing_;
};

}  // namespace

int follow_run(const std::string& dir, bool json, const std::string& port) {
  constexpr double kOften = 2, kSeldom = 30;  // s; drawn, in a log
  const Interrupt interrupt;
  std::unique_ptr<follow::FollowPage> page;
  if (!port.empty()) {
    auto started = follow::FollowPage::start(dir, port);
    if (!started) return report(started.failure());
    page = std::move(*started);
    say("{}\n", page->address());
  }
  const bool is_drawn = !json && ::isatty(STDOUT_FILENO) != 0;
  follow::Following following(dir);
  Drawn drawn;
  const auto begun = Clock::now();
  for (double told = -kSeldom;;) {
    const auto looked = Clock::now();
    const double now = seconds_since(begun);
    const auto seen = following.look(now);
    if (!seen) return report(seen.failure());
    const auto lines = follow::to_lines(*seen);
    if (json) {
      put("{}\n", follow::to_json(*seen).dump());
      std::fflush(stdout);
    } else if (is_drawn) {
      drawn.draw(lines);
    } else if (seen->is_done() || now - told >= kSeldom) {
      told = now;
      for (const std::string& line : lines) put("{}\n", line);
      std::fflush(stdout);
    }
    if (seen->is_done()) return kFine;
    // A large folder is not read all the time.
    const double wait = std::max(kOften, 10 * seconds_since(looked));
    if (interrupt.wait(std::chrono::milliseconds(static_cast<int>(1000 * wait)))) return kFine;
  }
}

}  // namespace probe::cli
