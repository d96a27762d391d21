#include "runtime/adaptive/chooser.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "runtime/base/check.h"

namespace probe::adaptive {

Chooser::Chooser(const Rule& rule, std::vector<Planned> order)
    : rule_(rule), order_(std::move(order)) {
  std::map<std::uint32_t, std::size_t> known;  // lists by task
  for (std::size_t place = 0; place < order_.size(); ++place) {
    const std::uint32_t task = rule_.kind == Rule::Kind::kEachTask ? order_[place].task : 0;
    const auto [at, is_new] = known.try_emplace(task, lists_.size());
    if (is_new) lists_.emplace_back();
    list_of_.push_back(at->second);
    index_of_.push_back(lists_[at->second].places.size());
    lists_[at->second].places.push_back(place);
    PROBE_CHECK(order_[place].outcome != Outcome::kUnderWay, "nothing is under way yet");
  }
  judge();
  for (std::size_t i = 0; i < lists_.size(); ++i) {
    advance(lists_[i]);
    measure(i);
  }
}

std::optional<std::size_t> Chooser::next() {
  if (open_.empty()) return std::nullopt;
  const std::size_t index = open_.begin()->second;
  List& list = lists_[index];
  const std::size_t place = list.places[list.next];
  order_[place].outcome = Outcome::kUnderWay;
  ++under_way_;
  advance(list);
  measure(index);
  return place;
}

void Chooser::tell(std::size_t place, Outcome outcome) {
  PROBE_CHECK(has_ended(outcome), "an episode that is told of has ended");
  List& list = lists_[list_of_[place]];
  Outcome& now = order_[place].outcome;
  if (now == Outcome::kUnderWay) --under_way_;
  const bool is_counted = index_of_[place] < list.next;
  if (is_counted) count(list, now, -1);
  // What was judged already is judged anew.
  if (has_ended(now) && place < judged_) {
    decision_ = {};
    judged_ = 0;
  }
  now = outcome;
  if (is_counted) count(list, now, 1);
  advance(list);
  judge();
  measure(list_of_[place]);
}

void Chooser::count(List& list, Outcome outcome, std::int64_t by) {
  if (outcome == Outcome::kSuccess) list.successes += by;
  if (outcome == Outcome::kFailure) list.failures += by;
  if (outcome == Outcome::kUnknown) list.unknown += by;
  if (outcome == Outcome::kNotAttempted) list.not_attempted += by;
}

void Chooser::advance(List& list) {
  for (; list.next < list.places.size(); ++list.next) {
    const Outcome outcome = order_[list.places[list.next]].outcome;
    if (outcome == Outcome::kAbsent) break;
    count(list, outcome, 1);
  }
}

// Whether a list needs more, and how much before others.
void Chooser::measure(std::size_t index) {
  List& list = lists_[index];
  open_.erase({-list.width, index});
  if (list.next == list.places.size()) return;
  if (rule_.kind == Rule::Kind::kDecided) {
    list.width = 1;
    if (decision_.verdict() == Decision::Verdict::kOpen) open_.insert({-list.width, index});
    return;
  }
  list.width = 1;
  if (list.not_attempted == 0) {
    const auto total = static_cast<std::int64_t>(list.places.size());
    const std::int64_t ended = list.successes + list.failures + list.unknown;
    const std::int64_t open = static_cast<std::int64_t>(list.next) - ended;
    // As those before: each success counts, and one half more of each kind.
    const double share = (static_cast<double>(list.successes) + 0.5) /
                         (static_cast<double>(list.successes + list.failures) + 1);
    const std::int64_t more = std::llround(share * static_cast<double>(open));
    const stats::Interval interval = stats::rate_of_drawn(
        {total, list.successes + more, list.failures + open - more, list.unknown}, kConfidence);
    list.width = interval.high - interval.low;
    if (rule_.is_narrow(list.width)) return;
  }
  open_.insert({-list.width, index});
}

// Starts that have ended, in their order and without a gap.
void Chooser::judge() {
  if (rule_.kind != Rule::Kind::kDecided) return;
  std::vector<std::pair<Outcome, bool>> start;
  for (;;) {
    start.clear();
    std::size_t end = judged_;
    for (; end < order_.size() && order_[end].task == order_[judged_].task &&
           order_[end].start == order_[judged_].start;
         ++end) {
      if (!has_ended(order_[end].outcome)) return;
      start.emplace_back(order_[end].outcome, order_[end].other);
    }
    if (start.empty()) return;
    decision_.add(start);
    judged_ = end;
  }
}

}  // namespace probe::adaptive
