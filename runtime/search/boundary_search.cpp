// How much of each change a policy stands, one axis and one direction at a time.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runtime/base/words.h"
#include "runtime/search/hunt.h"
#include "runtime/search/method/boundary.h"
#include "runtime/search/scale.h"

namespace probe::search {
namespace {

std::string_view word_of(BoundaryStatus status) {
  switch (status) {
    case BoundaryStatus::kFound:
      return "found";
    case BoundaryStatus::kNoFall:
      return "no fall";
    case BoundaryStatus::kFailsAtOwnValue:
      return "fails unchanged";
    case BoundaryStatus::kNotMonotone:
      return "not monotone";
    case BoundaryStatus::kUndecided:
      return "undecided";
    case BoundaryStatus::kLeftOut:
      return "left out";
    case BoundaryStatus::kRunning:
      break;
  }
  return "under way";
}

class BoundarySearch {
 public:
  explicit BoundarySearch(Hunt& hunt) : hunt_(hunt), space_(hunt.space()) {
    for (const AxisSide& side : sides_of(space_, hunt.options.levels)) {
      BoundaryOptions options;
      options.levels = side.levels;
      options.seed = hunt.draw_of({static_cast<double>(sides_.size())});
      options.error = hunt.options.error;
      if (hunt.options.budget) options.budget = *hunt.options.budget;
      sides_.push_back({side, Boundary(options), {}, {}, {}});
    }
  }

  Status run() {
    if (sides_.empty())
      return Failure{Fault::kUsage,
                     "space `" + space_.name +
                         "` has words alone, which have no order: `search axes` tells which matter",
                     "--space"};
    std::vector<space::Point> points;
    for (Side& side : sides_) add_points(side, points);
    PROBE_ASSIGN(const PlannedPoints planned, hunt_.plan(std::move(points)));
    Trials::Asking asking;
    asking.ask = [&]() -> Result<std::vector<Trial>> { return ask(); };
    asking.tell = [&](std::span<const Outcome> outcomes) { tell(outcomes); };
    PROBE_TRY(hunt_.try_out(planned, asking, "boundary"));
    report(planned);
    return {};
  }

 private:
  struct Side {
    AxisSide side;
    Boundary method;
    std::vector<std::size_t> points;     // by level from 1, by way
    std::vector<std::uint64_t> numbers;  // trials that were asked, by level
    std::size_t asked = 0;               // of the batch that is under way
  };

  void add_points(Side& side, std::vector<space::Point>& points) const {
    const sema::SpaceAxis& axis = space_.axes[side.side.axis];
    const int ways = ways_of(axis.kind);
    std::string stem = space_.name + "_" + side_text(space_, side.side);
    std::ranges::replace(stem, '.', '_');
    std::ranges::replace(stem, ' ', '_');
    for (int level = 1; level < side.side.levels; ++level) {
      for (int way = 0; way < ways; ++way) {
        space::Point point;
        point.name = stem + "_" + std::to_string(level) +
                     (ways > 1 ? std::string(1, static_cast<char>('a' + way)) : "");
        point.values = space::own_values(space_);
        point.values[side.side.axis] = side.side.value_at(axis, level);
        // One draw for all levels: farther is farther the same way.
        std::vector<double> key = space::own_values(space_);
        key.push_back(static_cast<double>(side.side.axis * 8 + static_cast<std::size_t>(way)));
        point.draw = hunt_.draw_of(key);
        side.points.push_back(points.size());
        points.push_back(std::move(point));
      }
    }
    side.numbers.assign(static_cast<std::size_t>(side.side.levels), 0);
  }

  // Of the sides that are shared out among several calls.
  bool is_mine(const Side& side) const {
    const auto number = static_cast<int>(&side - sides_.data());
    return number % hunt_.options.run.shards == hunt_.options.run.shard - 1;
  }

  std::vector<Trial> ask() {
    std::vector<Trial> trials;
    for (Side& side : sides_) {
      side.asked = 0;
      if (side.method.done() || !is_mine(side)) continue;
      const int ways = ways_of(space_.axes[side.side.axis].kind);
      for (const int level : side.method.ask()) {
        ++side.asked;
        if (level == 0 || !can_be_seen(side, level)) {
          trials.push_back({kBase, side.numbers[0]++});
          continue;
        }
        const std::uint64_t number = side.numbers[static_cast<std::size_t>(level)]++;
        const std::uint64_t way =
            hunt_.draw_of({static_cast<double>(side.side.axis), side.side.up ? 1.0 : 0.0,
                           static_cast<double>(level), static_cast<double>(number)}) %
            static_cast<std::uint64_t>(ways);
        const auto at =
            static_cast<std::size_t>((level - 1) * ways) + static_cast<std::size_t>(way);
        trials.push_back({side.points[at], number});
      }
    }
    return trials;
  }

  // A noise below a picture's level is the task itself.
  bool can_be_seen(const Side& side, int level) const {
    std::vector<double> values = space::own_values(space_);
    values[side.side.axis] = side.side.value_at(space_.axes[side.side.axis], level);
    return !space::changed_axes(space_, values).empty();
  }

  void tell(std::span<const Outcome> outcomes) {
    std::size_t at = 0;
    for (Side& side : sides_) {
      if (side.asked == 0) continue;
      side.method.tell(outcomes.subspan(at, side.asked));
      at += side.asked;
    }
    hunt_.summary.trials += static_cast<int>(outcomes.size());
    const auto open = std::ranges::count_if(sides_, [](const Side& s) { return !s.method.done(); });
    hunt_.tell(
        fmt::format("{} trials, {} of {} sides open", hunt_.summary.trials, open, sides_.size()));
  }

  void report(const PlannedPoints& planned) {
    Json axes = Json::array();
    for (const Side& side : sides_) {
      const BoundaryFinding found = side.method.finding();
      const sema::SpaceAxis& axis = space_.axes[side.side.axis];
      const auto text_at = [&](double level) {
        return space::value_text(axis, value_at(side, level));
      };
      const std::string name = side_text(space_, side.side);
      std::string line = name + ": ";
      const std::string trials = fmt::format("{} trials", found.trials);
      const std::string last = text_at(found.last_level);
      switch (found.status) {
        case BoundaryStatus::kFound:
          line += fmt::format("success falls to half of what it is unchanged ({}) at {} ({}, {})",
                              k_of_n(found.own), text_at(found.threshold),
                              interval_text(side, found), trials);
          break;
        case BoundaryStatus::kNoFall:
          line += fmt::format("success stays above half to {} ({})", last, trials);
          break;
        case BoundaryStatus::kFailsAtOwnValue:
          line += fmt::format("nothing to fall from: {} succeed where nothing is changed",
                              k_of_n(found.own));
          break;
        case BoundaryStatus::kNotMonotone:
          line += fmt::format(
              "success falls and rises again, so no one tolerance tells it (p = {:.2g}, {})",
              found.monotone_p, trials);
          break;
        case BoundaryStatus::kUndecided:
          line += fmt::format("undecided after {}: {}", trials, interval_text(side, found));
          if (found.budget_needed)
            line += fmt::format("; some {} would tell (--budget {})", *found.budget_needed,
                                *found.budget_needed);
          hunt_.summary.is_done = false;
          break;
        case BoundaryStatus::kLeftOut:
          line += found.own.n == 0
                      ? fmt::format("not even the task itself {}", hunt_.fair_words())
                      : fmt::format("nothing but the task itself {}", hunt_.fair_words()) +
                            reason(side, 1, planned);
          break;
        case BoundaryStatus::kRunning:
          line += "under way";
          hunt_.summary.is_done = false;
          break;
      }
      if (found.last_level < side.side.levels - 1 && found.status != BoundaryStatus::kLeftOut)
        line += "; nothing beyond " + last + " " + hunt_.fair_words() +
                reason(side, found.last_level + 1, planned);
      hunt_.summary.lines.push_back(line);
      Json one = {{"axis", axis.name},
                  {"up", side.side.up},
                  {"side", name},
                  {"status", word_of(found.status)},
                  {"unit", sema::info_of(axis.kind).unit},
                  {"own", shown(axis, axis.own)},
                  {"end", shown(axis, side.side.up ? axis.high : axis.low)},
                  {"last_fair", shown(axis, value_at(side, found.last_level))},
                  {"trials", found.trials},
                  {"left_out", found.left_out},
                  {"own_success", json_of(found.own)},
                  {"no_fall", found.no_fall},
                  {"sentence", line}};
      const bool has_threshold =
          found.status == BoundaryStatus::kFound || found.status == BoundaryStatus::kUndecided;
      if (has_threshold) {
        one["tolerance"] = shown(axis, value_at(side, found.threshold));
        one["low"] = shown(axis, value_at(side, found.low));
        one["high"] = shown(axis, value_at(side, found.high));
      }
      if (found.budget_needed) one["budget_needed"] = *found.budget_needed;
      axes.push_back(std::move(one));
      if (found.status == BoundaryStatus::kFound) keep(side, found, planned, line);
    }
    for (const sema::SpaceAxis& axis : space_.axes) {
      if (sema::info_of(axis.kind).spacing == sema::Spacing::kChoice)
        hunt_.summary.lines.push_back(axis.name +
                                      ": has no order; `search axes` tells whether it matters");
    }
    hunt_.summary.findings["axes"] = std::move(axes);
  }

  static double shown(const sema::SpaceAxis& axis, double value) {
    return value * sema::info_of(axis.kind).per_si;
  }
  double value_at(const Side& side, double level) const {
    return side.side.value_at(space_.axes[side.side.axis],
                              std::min(level, static_cast<double>(side.side.levels - 1)));
  }
  std::string end_text(const Side& side, const BoundaryFinding& found, double level) const {
    const std::string text = space::value_text(space_.axes[side.side.axis], value_at(side, level));
    return level > found.last_level ? "beyond " + text : text;
  }

  // The smaller number first.
  std::string interval_text(const Side& side, const BoundaryFinding& found) const {
    std::string low = end_text(side, found, found.low), high = end_text(side, found, found.high);
    if (!side.side.up) std::swap(low, high);
    return low + " to " + high;
  }

  std::string reason(const Side& side, int level, const PlannedPoints& planned) const {
    const auto at =
        static_cast<std::size_t>((level - 1) * ways_of(space_.axes[side.side.axis].kind));
    if (at >= side.points.size()) return "";
    const std::string& why = planned.points[side.points[at]].why;
    return why.empty() ? "" : " (" + why + ")";
  }

  // The first level that lies beyond the interval, in the first of its ways.
  void keep(const Side& side, const BoundaryFinding& found, const PlannedPoints& planned,
            const std::string& line) {
    const int level = std::min(static_cast<int>(std::ceil(found.high)), found.last_level);
    if (level < 1) return;
    const auto at =
        static_cast<std::size_t>((level - 1) * ways_of(space_.axes[side.side.axis].kind));
    const PlannedPoint& point = planned.points[side.points[at]];
    if (!point.task) return;
    hunt_.kept.push_back({point.point, "the first step beyond the interval of " + line});
  }

  Hunt& hunt_;
  const sema::Space& space_;
  std::vector<Side> sides_;
};

}  // namespace

Status search_boundary(Hunt& hunt) { return BoundarySearch(hunt).run(); }

}  // namespace probe::search
