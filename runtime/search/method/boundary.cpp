#include "runtime/search/method/boundary.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "runtime/base/check.h"
#include "runtime/search/method/confirm.h"
#include "runtime/search/method/monotone.h"
#include "runtime/search/method/tolerance_grid.h"

namespace probe::search {
namespace {

// The posterior's interval that is called one of 95 %: a search stops when it happens to be narrow,
// and slopes lie between those of the grid, so that one of 95 % covers 92 % (simulation_test).
constexpr double kCredible = 0.985;
constexpr int kMostChecks = 3;
constexpr double kNotMonotoneBelow = 0.005, kDoubtfulBelow = 0.2;
// A level is unfair after so many left-out trials, if more than counted ones.
constexpr int kUnfairLevelAfter = 2;
// Of longer axes so many levels are thought of at a time.
constexpr int kLevelsThoughtOf = 64;

}  // namespace

struct Boundary::State {
  explicit State(const BoundaryOptions& o)
      : options(o),
        grid(o.levels),
        successes(static_cast<std::size_t>(o.levels)),
        left_out(static_cast<std::size_t>(o.levels)) {}

  BoundaryOptions options;
  ToleranceGrid grid;
  std::vector<stats::Count> successes;  // a level
  std::vector<int> left_out;            // a level
  std::vector<int> ask;
  BoundaryStatus status = BoundaryStatus::kRunning;
  int trials = 0, all_left_out = 0;
  int end_asked = 0;
  int checks = 0;       // rounds of check trials that were run
  int check_asked = 0;  // of the round that runs
  bool is_checking = false;
  double monotone = 1;

  std::int64_t tried(int level) const { return successes[static_cast<std::size_t>(level)].n; }

  bool is_unfair(int level) const {
    const int left = left_out[static_cast<std::size_t>(level)];
    return left >= kUnfairLevelAfter && left > tried(level);
  }

  int highest_tried() const {
    for (int level = options.levels - 1; level > 0; --level) {
      if (tried(level) > 0) return level;
    }
    return 0;
  }

  // The first unfair level beyond all that were tried; `levels` where there is none.
  int unfair_from() const {
    for (int level = highest_tried() + 1; level < options.levels; ++level) {
      if (is_unfair(level)) return level;
    }
    return options.levels;
  }

  int last_level() const {
    return unfair_from() == options.levels ? options.levels - 1 : highest_tried();
  }

  // Levels that may be asked. Between the last that was fair and the first that was not, the one
  // half-way, so that an unfair end is found in few trials.
  std::vector<int> fair_levels() const {
    const int highest = highest_tried(), unfair = unfair_from();
    std::vector<int> levels;
    for (int level = 0; level < options.levels; ++level) {
      const bool is_open = unfair == options.levels || level <= highest ||
                           (level < unfair && level == (highest + unfair) / 2);
      if (is_open && !is_unfair(level)) levels.push_back(level);
    }
    return levels;
  }

  // All fair levels of a short axis; of a long one those around the tolerance and some elsewhere.
  std::vector<int> levels_thought_of() const {
    std::vector<int> fair = fair_levels();
    if (fair.size() <= kLevelsThoughtOf) return fair;
    const int last = last_level();
    const int low = static_cast<int>(grid.quantile(0.005, last)) - 1;
    const int high = static_cast<int>(grid.quantile(0.995, last)) + 2;
    const int stride = std::max(1, (high - low) / (kLevelsThoughtOf / 2));
    const int far_stride = static_cast<int>(fair.size()) / (kLevelsThoughtOf / 2);
    std::vector<int> some;
    for (std::size_t i = 0; i < fair.size(); ++i) {
      const int level = fair[i];
      const bool is_near = level >= low && level <= high && (level - low) % stride == 0;
      if (is_near || static_cast<int>(i) % far_stride == 0 || i + 1 == fair.size())
        some.push_back(level);
    }
    return some;
  }

  int room(int limit) const { return std::clamp(limit - trials, 0, options.batch); }

  void fill(int level, int count) { ask.insert(ask.end(), static_cast<std::size_t>(count), level); }

  void end(BoundaryStatus with) {
    status = with;
    ask.clear();
  }

  int check_size() const { return std::min(options.check_trials, options.budget / 4); }

  double error_in_levels() const { return std::max(options.error * (options.levels - 1), 0.5); }

  // What could be said now if the axis is monotone.
  BoundaryStatus verdict() const {
    const int last = last_level();
    const double tail = (1 - kCredible) / 2;
    if (last > 0 && grid.beyond(last) >= kConfidence) return BoundaryStatus::kNoFall;
    const double half = (grid.quantile(1 - tail, last) - grid.quantile(tail, last)) / 2;
    if (grid.beyond(last) < tail && half <= error_in_levels()) return BoundaryStatus::kFound;
    return BoundaryStatus::kUndecided;
  }

  // At the own value first: true while more of it is to be asked, or all is over.
  bool begins() {
    if (is_unfair(0)) {
      end(BoundaryStatus::kLeftOut);
      return true;
    }
    const stats::Count own = successes[0];
    const int n = static_cast<int>(own.n);
    if (n < options.own_trials) {
      const int size = room(options.budget - check_size());
      // The end beside the first of them: what it tells decides where to look.
      const std::vector<int> fair = fair_levels();
      if (fair.back() > 0 && end_asked < options.end_trials) {
        const int beside = std::min(options.end_trials - end_asked, size / 2);
        fill(fair.back(), beside);
        end_asked += beside;
      }
      fill(0, std::min(options.own_trials - n, size - static_cast<int>(ask.size())));
      return !ask.empty();
    }
    if (exact_upper(own, kConfidence) < options.own_at_least) {
      end(BoundaryStatus::kFailsAtOwnValue);
      return true;
    }
    const bool is_doubtful = own.rate() < 2 * options.own_at_least &&
                             exact_lower(own, kConfidence) < options.own_at_least;
    if (!is_doubtful) return false;
    if (n < 4 * options.own_trials) {
      fill(0, room(options.budget - check_size()));
      return !ask.empty();
    }
    if (own.rate() >= options.own_at_least) return false;
    end(BoundaryStatus::kFailsAtOwnValue);
    return true;
  }

  // Check trials spread over the fair levels; true while there are more. A round that is not the
  // first ends with the budget.
  bool checks_on() {
    const int size = check_size();
    const int now = std::min(room(options.budget), size - check_asked);
    if (now <= 0) {
      is_checking = false;
      ++checks;
      monotone = monotone_p(successes, options.seed);
      return false;
    }
    const std::vector<int> fair = fair_levels();
    for (int i = 0; i < now; ++i, ++check_asked) {
      // Every third place in turn, so that each batch sees the whole axis.
      const int place = check_asked % 3 * ((size + 2) / 3) + check_asked / 3;
      const double at = (std::min(place, size - 1) + 0.5) / size;
      ask.push_back(fair[static_cast<std::size_t>(at * static_cast<double>(fair.size()))]);
    }
    return true;
  }

  void go_on() {
    ask.clear();
    if (all_left_out > options.budget / 2 + 4 * options.batch)
      return end(BoundaryStatus::kUndecided);
    if (is_checking && checks_on()) return;
    if (checks == 0 && begins()) return;
    if (fair_levels().size() == 1) return end(BoundaryStatus::kLeftOut);
    const int reserved = checks == 0 ? check_size() : 0;
    BoundaryStatus now = verdict();
    const bool is_spent = trials + reserved >= options.budget;
    // Success stays up to the last level that was tried; how far that may be is not known yet.
    const int highest = highest_tried(), unfair = unfair_from();
    if (now == BoundaryStatus::kNoFall && !is_spent && unfair < options.levels &&
        unfair - highest > std::max(error_in_levels(), 1.0)) {
      return fill((highest + unfair) / 2,
                  room(std::min(options.budget - reserved, trials + options.end_trials)));
    }
    if (now != BoundaryStatus::kUndecided || is_spent) {
      const bool is_doubtful =
          checks < kMostChecks && monotone >= kNotMonotoneBelow && monotone < kDoubtfulBelow;
      if (check_size() > 0 && (checks == 0 || (is_doubtful && !is_spent))) {
        is_checking = true;
        check_asked = 0;
        if (checks_on()) return;
      }
      monotone = monotone_p(successes, options.seed);
      if (monotone < kNotMonotoneBelow) now = BoundaryStatus::kNotMonotone;
      return end(now);
    }
    if (checks > 0 && monotone < kNotMonotoneBelow) return end(BoundaryStatus::kNotMonotone);
    const int size = room(options.budget - reserved);
    ask = grid.most_informative(levels_thought_of(), static_cast<std::size_t>(size));
  }
};

Boundary::Boundary(const BoundaryOptions& options) {
  PROBE_CHECK(options.levels >= 2 && options.batch >= 1 && options.batch <= 8,
              "a boundary has two levels at least and batches of 1..8 trials");
  state_ = std::make_unique<State>(options);
  state_->go_on();
  if (state_->ask.empty() && !done()) state_->end(BoundaryStatus::kUndecided);
}

Boundary::~Boundary() = default;
Boundary::Boundary(Boundary&&) noexcept = default;
Boundary& Boundary::operator=(Boundary&&) noexcept = default;

bool Boundary::done() const { return state_->status != BoundaryStatus::kRunning; }
std::span<const int> Boundary::ask() const { return state_->ask; }

void Boundary::tell(std::span<const Outcome> outcomes) {
  State& s = *state_;
  PROBE_CHECK(outcomes.size() == s.ask.size(), "every trial that was asked has its outcome");
  std::vector<ToleranceGrid::Trial> trials;
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    const auto level = static_cast<std::size_t>(s.ask[i]);
    if (outcomes[i] == Outcome::kLeftOut) {
      ++s.left_out[level];
      ++s.all_left_out;
      continue;
    }
    const bool succeeded = outcomes[i] == Outcome::kSucceeded;
    ++s.successes[level].n;
    s.successes[level].k += succeeded ? 1 : 0;
    ++s.trials;
    trials.push_back({s.ask[i], succeeded});
  }
  s.grid.update(trials);
  s.go_on();
}

BoundaryFinding Boundary::finding() const {
  const State& s = *state_;
  const double tail = (1 - kCredible) / 2;
  const int last = s.last_level();
  BoundaryFinding found;
  found.status = s.status;
  found.threshold = s.grid.quantile(0.5, last);
  found.low = s.grid.quantile(tail, last);
  found.high = s.grid.quantile(1 - tail, last);
  found.no_fall = s.grid.beyond(last);
  found.own = s.successes[0];
  found.own_rate = stats::wilson(found.own);
  found.trials = s.trials;
  found.left_out = s.all_left_out;
  found.last_level = last;
  found.monotone_p = s.monotone;
  if (found.status == BoundaryStatus::kUndecided && s.trials > 0) {
    const double half = (found.high - found.low) / 2;
    const double times = std::pow(half / s.error_in_levels(), 2);
    // Where no fall is what is open, the width is that of a clipped interval: half as many again.
    found.budget_needed = static_cast<int>(std::ceil(std::max(times, 1.5) * s.trials / 10)) * 10;
  }
  return found;
}

}  // namespace probe::search
