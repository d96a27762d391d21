#include "runtime/cli/full/progress.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "runtime/base/percent.h"
#include "runtime/store/not_attempted.h"

namespace probe::cli {
namespace {

// Worth a place on one line, in this order.
constexpr std::array<std::string_view, 4> kShown = {"success", "intention", "grasp", "wrong"};
constexpr int kBarWidth = 20;
// A log has a line every ten seconds while somebody may be looking, then one a minute: runs take
// days.
constexpr double kLogOften = 10, kLogSeldom = 60, kOftenFor = 120;  // s

}  // namespace

void Progress::add(const run::RunProgress& progress) {
  done_ = progress.done;
  skipped_ = progress.skipped;
  total_ = progress.total;
  is_at_most_ = progress.is_at_most;
  if (progress.row == nullptr) return;
  if (progress.row->invalid) {
    ++(store::is_not_attempted(*progress.row) ? not_attempted_ : invalid_);
    return;
  }
  for (const std::string_view name : kShown) {
    for (const store::MetricValue& value : progress.row->metrics) {
      if (value.name != name || !value.is_bool) continue;
      auto at = std::find_if(rates_.begin(), rates_.end(),
                             [&](const Rate& rate) { return rate.name == name; });
      if (at == rates_.end()) {
        rates_.push_back({value.name, {}});
        at = rates_.end() - 1;
      }
      at->count.k += value.value != 0 ? 1 : 0;
      ++at->count.n;
    }
  }
}

std::string Progress::counts() const {
  std::string text = is_at_most_
                         ? fmt::format("{} of at most {} episodes", finished(), total_)
                         : fmt::format("{}/{} episodes", finished(), total_);
  if (skipped_ > 0) text += fmt::format(" ({} were there)", skipped_);
  if (not_attempted_ > 0) text += fmt::format(", {} not attempted", not_attempted_);
  if (invalid_ > 0) text += fmt::format(", {} invalid", invalid_);
  return text;
}

std::string Progress::rate_text(const Rate& rate) const {
  // How many were run depends on how they ended: a count, and no interval of a fixed number.
  if (is_at_most_) return fmt::format("{} {}/{}", rate.name, rate.count.k, rate.count.n);
  const stats::Interval interval = stats::wilson(rate.count);
  return fmt::format("{} {}/{} {} % [{}]", rate.name, rate.count.k, rate.count.n,
                     decimal_text(100 * rate.count.rate(), 0),
                     percent_range(interval.low, interval.high, "-"));
}

// Episodes that were there cost nothing, so only this call's pace counts.
std::string Progress::time_left(double now) const {
  if (is_at_most_) return "";
  const int left = total_ - finished();
  if (left <= 0) return "done in " + duration_text(now - begun_);
  if (done_ == 0) return "";
  return duration_text((now - begun_) / done_ * left) + " left";
}

std::string Progress::terminal_line(double now, std::size_t columns, bool color) const {
  std::vector<std::string> parts = {counts()};
  if (const std::string left = time_left(now); !left.empty()) parts.push_back(left);
  std::string line;
  for (const std::string& part : parts) line += (line.empty() ? "" : "  ") + part;
  std::string bar;
  std::size_t used = line.size();
  if (total_ > 0 && used + kBarWidth + 3 <= columns) {
    const int full = static_cast<int>(static_cast<long long>(kBarWidth) * finished() / total_);
    const std::string done(static_cast<std::size_t>(full), '=');
    bar = "[" + (color ? "\033[32m" + done + "\033[0m" : done) +
          std::string(static_cast<std::size_t>(kBarWidth - full), ' ') + "] ";
    used += kBarWidth + 3;
  }
  for (const Rate& rate : rates_) {
    const std::string text = "  " + rate_text(rate);
    if (used + text.size() > columns) break;
    line += text;
    used += text.size();
  }
  if (bar.empty()) line.resize(std::min(line.size(), columns));
  return bar + line;
}

std::optional<std::string> Progress::log_line(double now) {
  const double every = now - begun_ < kOftenFor ? kLogOften : kLogSeldom;
  if (logged_ && now - *logged_ < every) return std::nullopt;
  logged_ = now;
  std::string line = counts();
  for (const Rate& rate : rates_) line += ", " + rate_text(rate);
  if (const std::string left = time_left(now); !left.empty()) line += ", " + left;
  return line;
}

}  // namespace probe::cli
