#include "runtime/search/method/minimal.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "runtime/base/check.h"

namespace probe::search {
namespace {

// A set is unfair after so many left-out trials, if more than counted ones.
constexpr int kUnfairSetAfter = 3;

}  // namespace

Minimal::Minimal(const MinimalOptions& options) : options_(options) {
  PROBE_CHECK(options.axes >= 1 && options.axes <= 63, "a case changes 1 to 63 axes");
  PROBE_CHECK(0 < options.passes && options.passes < options.fails && options.fails < 1,
              "a set that passes fails less often than one that fails");
  PROBE_CHECK(options.batch >= 1 && options.test_budget >= 1, "a set is tried");
  go_on();
}

// The verdict of `set`; nullptr, with trials of it to run or all over, where it is still open.
const SetTried* Minimal::judged(AxisSet set) {
  const auto [at, is_new] = index_.try_emplace(set, finding_.tried.size());
  if (is_new) {
    finding_.tried.push_back({.set = set, .failures = {}});
    open_ = true;
  }
  SetTried& one = finding_.tried[at->second];
  if (!open_ || at->second + 1 != finding_.tried.size()) return &one;
  const double k = static_cast<double>(finding_.tried.size());
  const double limit = std::log(k * (k + 1) / options_.error);
  const double up = std::log(options_.fails / options_.passes);
  const double down = std::log((1 - options_.passes) / (1 - options_.fails));
  const auto& [failures, n] = one.failures;
  one.log_ratio = static_cast<double>(failures) * up - static_cast<double>(n - failures) * down;
  open_ = false;
  if (one.log_ratio >= limit) {
    one.verdict = Verdict::kFails;
    return &one;
  }
  if (one.log_ratio <= -limit) {
    one.verdict = Verdict::kPasses;
    return &one;
  }
  if (one.left_out >= kUnfairSetAfter && one.left_out > n) {
    one.verdict = Verdict::kLeftOut;
    return &one;
  }
  const int room = options_.test_budget - static_cast<int>(n);
  if (room <= 0) {
    one.verdict = Verdict::kUnclear;
    return &one;
  }
  open_ = true;
  if (finding_.trials >= options_.budget || finding_.left_out >= options_.budget) {
    end(MinimalStatus::kBudgetSpent);
    return nullptr;
  }
  // As few as can decide.
  const double fewest =
      std::ceil(std::min((limit - one.log_ratio) / up, (limit + one.log_ratio) / down));
  const int count = std::min({std::max(options_.batch, static_cast<int>(fewest)), room,
                              options_.budget - finding_.trials});
  ask_.assign(static_cast<std::size_t>(count), set);
  return nullptr;
}

// The set that is kept, cut into granularity_ parts of neighbouring axes, as even as can be.
std::vector<AxisSet> Minimal::parts() const {
  const int size = std::popcount(finding_.set);
  std::vector<AxisSet> parts(static_cast<std::size_t>(granularity_));
  int place = 0;
  for (AxisSet rest = finding_.set; rest != 0; rest &= rest - 1, ++place) {
    parts[static_cast<std::size_t>(place * granularity_ / size)] |= rest & ~(rest - 1);
  }
  return parts;
}

void Minimal::end(MinimalStatus status) {
  finding_.status = status;
  ask_.clear();
}

void Minimal::go_on() {
  ask_.clear();
  const AxisSet all = (AxisSet{1} << options_.axes) - 1;
  if (!is_cutting_) {
    const SetTried* whole = judged(all);
    if (whole == nullptr) return;
    if (whole->verdict != Verdict::kFails) return end(MinimalStatus::kNotReliable);
    finding_.set = all;
    const SetTried* none = judged(0);
    if (none == nullptr) return;
    if (none->verdict == Verdict::kFails) {
      finding_.set = 0;
      return end(MinimalStatus::kFailsAtOwnPoint);
    }
    is_cutting_ = true;
  }
  while (std::popcount(finding_.set) > 1) {
    bool is_smaller = false;
    const std::vector<AxisSet> cut = parts();
    for (std::size_t i = 0; i < 2 * cut.size() && !is_smaller; ++i) {
      const bool is_part = i < cut.size();
      const AxisSet set = is_part ? cut[i] : finding_.set & ~cut[i - cut.size()];
      const SetTried* one = judged(set);
      if (one == nullptr) return;
      if (one->verdict != Verdict::kFails) continue;
      is_smaller = true;
      finding_.set = set;
      granularity_ = is_part ? 2 : std::max(granularity_ - 1, 2);
    }
    const int size = std::popcount(finding_.set);
    if (is_smaller) continue;
    if (granularity_ >= size) break;
    granularity_ = std::min(2 * granularity_, size);
  }
  // Every axis alone put back was judged on the way here.
  for (AxisSet rest = finding_.set; rest != 0; rest &= rest - 1) {
    const AxisSet axis = rest & ~(rest - 1);
    const SetTried* without = judged(finding_.set & ~axis);
    if (without == nullptr) return;
    if (without->verdict != Verdict::kPasses) finding_.doubtful |= axis;
  }
  end(MinimalStatus::kFound);
}

void Minimal::tell(std::span<const Outcome> outcomes) {
  PROBE_CHECK(outcomes.size() == ask_.size(), "every trial that was asked has its outcome");
  SetTried& one = finding_.tried.back();
  for (const Outcome outcome : outcomes) {
    if (outcome == Outcome::kLeftOut) {
      ++one.left_out;
      ++finding_.left_out;
      continue;
    }
    ++one.failures.n;
    ++finding_.trials;
    one.failures.k += outcome == Outcome::kFailed ? 1 : 0;
  }
  go_on();
}

}  // namespace probe::search
