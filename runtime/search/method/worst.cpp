#include "runtime/search/method/worst.h"

#include <algorithm>
#include <boost/math/special_functions/erf.hpp>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <utility>

#include "runtime/base/check.h"
#include "runtime/search/method/draws.h"

namespace probe::search {
namespace {

// A point's failure rate is judged with those around it, as near as this: two lucky trials close to
// the own point would otherwise draw the search there.
constexpr double kReach = 0.12;
// Like one another: the same axes changed, and nowhere further apart.
constexpr double kAlike = 0.1;
// Rounds in which the elite came no nearer, by more than kNearer, that end the search.
constexpr int kPatience = 4;
constexpr double kNearer = 0.01;
// One in so many points of a round is drawn as the first round was: a weak spot found first does
// not hide a nearer one.
constexpr int kShareElsewhere = 5;
// One in so many is one of the elite with a smaller change.
constexpr int kShareNearer = 3;
// How much less is learnt from an elite that does not fail: it may be luck.
constexpr double kFromLuck = 0.3;
// Truncated to 0..1 this is nearly uniform.
constexpr double kFirstSpread = 1;

double normal_cdf(double z) { return 0.5 * std::erfc(-z / std::numbers::sqrt2); }

double normal_quantile(double p) {
  return -std::numbers::sqrt2 * boost::math::erfc_inv(2 * std::clamp(p, 1e-12, 1 - 1e-12));
}

double unit_of(const Axis& axis, double x) {
  return axis.kind == AxisKind::kCount ? x / std::max(axis.size - 1, 1) : x;
}

double apart(const Axis& axis, double a, double b) {
  if (axis.kind == AxisKind::kChoice) return a == b ? 0 : 1;
  return std::abs(unit_of(axis, a) - unit_of(axis, b));
}

}  // namespace

struct Worst::State {
  // What the next round is drawn from, of one axis. Continuous axes and counts in 0..1.
  struct Law {
    double change = 0.5;  // the chance that it is changed
    double mean = 0.5, spread = kFirstSpread;
    std::vector<double> options;  // of a choice, the own one 0
  };

  struct Seen {
    Point point;
    stats::Count failures;
    double distance = 0;
    // Failures and trials around it, weighed by nearness.
    double near_k = 0, near_n = 0;
    double rate() const { return near_k / near_n; }
  };

  Space space;
  WorstOptions options;
  std::vector<Law> laws;
  std::vector<Seen> seen;          // that had a trial, in order
  std::vector<std::size_t> elite;  // of the last round; indices into seen
  std::vector<Point> ask;
  int round = 0;  // that are told
  int idle = 0;   // rounds in a row whose elite came no nearer
  double nearest = 1e300;
  bool is_any_broken = false;  // in the elite
  bool is_second_look = false, is_over = false;
  int trials = 0, left_out = 0;

  bool can_change(std::size_t axis) const {
    return space[axis].kind == AxisKind::kContinuous || space[axis].size > 1;
  }

  double draw_changed(std::size_t a, Draws& draws) const {
    const Axis& axis = space[a];
    const Law& law = laws[a];
    const double u = draws.uniform();
    if (axis.kind == AxisKind::kChoice) {
      double below = 0;
      int last = 0;
      for (int option = 0; option < axis.size; ++option) {
        const double p = law.options[static_cast<std::size_t>(option)];
        if (p <= 0) continue;
        last = option;
        below += p;
        if (u < below) break;
      }
      return last;
    }
    const double low = normal_cdf((0 - law.mean) / law.spread);
    const double high = normal_cdf((1 - law.mean) / law.spread);
    const double z = normal_quantile(low + u * (high - low));
    const double x = std::clamp(law.mean + law.spread * z, 0.0, 1.0);
    return axis.kind == AxisKind::kCount ? std::round(x * (axis.size - 1)) : x;
  }

  Point draw(Draws& draws) const {
    // The own point itself is no change: drawn again, in the end anywhere else.
    for (int tries = 0; tries < 20; ++tries) {
      Point point = own_point(space);
      for (std::size_t a = 0; a < space.size(); ++a) {
        const bool is_changed = draws.uniform() < laws[a].change;
        const double x = draw_changed(a, draws);
        if (is_changed && can_change(a)) point[a] = x;
      }
      if (distance(space, point) > 0) return point;
    }
    return draw_anywhere(draws);
  }

  // Every second time an end of the axis: what breaks a policy often does so from somewhere on.
  static double changed_anywhere(const Axis& axis, Draws& draws) {
    const double last = axis.kind == AxisKind::kContinuous ? 1 : axis.size - 1;
    if (axis.kind != AxisKind::kChoice && draws.uniform() < 0.5) {
      if (axis.own == 0) return last;
      if (axis.own == last) return 0;
      return draws.uniform() < 0.5 ? 0 : last;
    }
    if (axis.kind == AxisKind::kContinuous) return draws.uniform();
    const auto other = static_cast<double>(draws.below(static_cast<std::uint32_t>(axis.size - 1)));
    return other < axis.own ? other : other + 1;
  }

  // Few axes changed more often than many, each anywhere but where it is.
  Point draw_anywhere(Draws& draws) const {
    std::vector<std::size_t> axes;
    for (std::size_t a = 0; a < space.size(); ++a) {
      if (can_change(a)) axes.push_back(a);
    }
    // As many as the greatest m with m <= d^u: P(m) is about 1 / m.
    const auto most = static_cast<double>(axes.size());
    const std::size_t changed =
        std::min(axes.size(), static_cast<std::size_t>(std::pow(most + 1, draws.uniform())));
    Point point = own_point(space);
    for (std::size_t i = 0; i < changed; ++i) {
      const std::size_t left = axes.size() - i;
      std::swap(axes[i], axes[i + draws.below(static_cast<std::uint32_t>(left))]);
      point[axes[i]] = changed_anywhere(space[axes[i]], draws);
    }
    return point;
  }

  // One of the elite with one of its changes put back, or made smaller: laws that know an axis at a
  // time cannot tell what two weak spots need.
  Point draw_nearer(Draws& draws) const {
    Point point = seen[elite[draws.below(static_cast<std::uint32_t>(elite.size()))]].point;
    std::vector<std::size_t> changed;
    for (std::size_t a = 0; a < space.size(); ++a) {
      if (point[a] != space[a].own) changed.push_back(a);
    }
    if (changed.empty()) return draw_anywhere(draws);
    const std::size_t a = changed[draws.below(static_cast<std::uint32_t>(changed.size()))];
    const double u = draws.uniform();
    const bool is_put_back = changed.size() > 1 && draws.uniform() < 0.5;
    const double shorter = space[a].own + u * (point[a] - space[a].own);
    if (is_put_back) {
      point[a] = space[a].own;
    } else if (space[a].kind == AxisKind::kContinuous) {
      point[a] = shorter;
    } else if (space[a].kind == AxisKind::kCount) {
      // Not to the own value itself, which would be put back.
      const double step = point[a] > space[a].own ? 1 : -1;
      point[a] = std::round(shorter) == space[a].own ? space[a].own + step : std::round(shorter);
    }
    return point;
  }

  void ask_round() {
    Draws draws(options.seed, "worst round " + std::to_string(round));
    const int elsewhere = round == 0      ? options.points
                          : is_any_broken ? options.points / kShareElsewhere
                                          : options.points / 2;
    const int nearer = is_any_broken ? elsewhere + options.points / kShareNearer : elsewhere;
    for (int i = 0; i < options.points; ++i) {
      ask.insert(ask.end(), static_cast<std::size_t>(options.repeats),
                 i < elsewhere ? draw_anywhere(draws)
                 : i < nearer  ? draw_nearer(draws)
                               : draw(draws));
    }
  }

  double nearness(const Point& a, const Point& b) const {
    double square = 0;
    for (std::size_t i = 0; i < space.size(); ++i) {
      const double d = apart(space[i], a[i], b[i]) / kReach;
      square += d * d;
      if (square > 18) return 0;
    }
    return std::exp(-square / 2);
  }

  void add(Seen one) {
    one.distance = distance(space, one.point);
    const auto k = static_cast<double>(one.failures.k), n = static_cast<double>(one.failures.n);
    one.near_k = k;
    one.near_n = n;
    for (Seen& other : seen) {
      const double w = nearness(one.point, other.point);
      if (w == 0) continue;
      one.near_k += w * static_cast<double>(other.failures.k);
      one.near_n += w * static_cast<double>(other.failures.n);
      other.near_k += w * k;
      other.near_n += w * n;
    }
    seen.push_back(std::move(one));
  }

  bool is_broken(const Seen& one) const { return one.rate() >= options.broken; }

  bool is_better(const Seen& a, const Seen& b) const {
    if (is_broken(a) != is_broken(b)) return is_broken(a);
    if (!is_broken(a) && a.rate() != b.rate()) return a.rate() > b.rate();
    return a.distance < b.distance;
  }

  // The best of the last elite and of what was seen from `first` on; empty where nothing failed.
  std::vector<std::size_t> elite_of(std::size_t first) const {
    std::vector<std::size_t> order = elite;
    for (std::size_t i = first; i < seen.size(); ++i) order.push_back(i);
    std::stable_sort(order.begin(), order.end(),
                     [&](auto a, auto b) { return is_better(seen[a], seen[b]); });
    const double share = std::ceil(options.elite * options.points);
    order.resize(std::min(order.size(), static_cast<std::size_t>(share)));
    // Where nothing fails there is nothing to go after.
    std::erase_if(order, [&](auto i) { return seen[i].rate() <= 0; });
    return order;
  }

  void learn() {
    if (elite.empty()) return;
    is_any_broken = is_broken(seen[elite.front()]);
    const double fresh = options.smoothing * (is_any_broken ? 1 : kFromLuck);
    const double floor = options.spread_floor;
    for (std::size_t a = 0; a < space.size(); ++a) {
      Law& law = laws[a];
      const Axis& axis = space[a];
      double changed = 0, sum = 0, squares = 0;
      std::vector<double> chosen(law.options.size());
      for (const std::size_t i : elite) {
        const double x = seen[i].point[a];
        if (x == axis.own) continue;
        const double unit = unit_of(axis, x);
        changed += 1;
        sum += unit;
        squares += unit * unit;
        if (axis.kind == AxisKind::kChoice) chosen[static_cast<std::size_t>(x)] += 1;
      }
      const double share_changed = changed / static_cast<double>(elite.size());
      law.change = std::clamp(fresh * share_changed + (1 - fresh) * law.change, floor, 1 - floor);
      if (changed == 0) continue;
      if (axis.kind == AxisKind::kChoice) {
        const double others = static_cast<double>(axis.size - 1);
        for (std::size_t option = 0; option < chosen.size(); ++option) {
          if (static_cast<double>(option) == axis.own) continue;
          double& p = law.options[option];
          p = fresh * chosen[option] / changed + (1 - fresh) * p;
          p = (p + floor) / (1 + floor * others);
        }
        continue;
      }
      const double mean = sum / changed;
      law.mean = fresh * mean + (1 - fresh) * law.mean;
      if (changed < 2) continue;
      const double spread = std::sqrt(std::max(squares / changed - mean * mean, 0.0));
      const double least = axis.kind == AxisKind::kCount ? 0.5 / axis.size : floor;
      law.spread = std::max(fresh * spread + (1 - fresh) * law.spread, std::max(floor, least));
    }
  }

  bool is_alike(const Point& a, const Point& b) const {
    for (std::size_t i = 0; i < space.size(); ++i) {
      if ((a[i] == space[i].own) != (b[i] == space[i].own)) return false;
      if (apart(space[i], a[i], b[i]) > kAlike) return false;
    }
    return true;
  }

  // The best points that failed themselves, none like a better one; indices into seen.
  std::vector<std::size_t> best(std::size_t count) const {
    std::vector<std::size_t> order, kept;
    for (std::size_t i = 0; i < seen.size(); ++i) {
      // After the second look, of those that had one.
      if (is_over && seen[i].failures.n <= options.repeats) continue;
      if (seen[i].failures.k > 0 && seen[i].failures.rate() >= options.broken) order.push_back(i);
    }
    if (order.empty()) {
      for (std::size_t i = 0; i < seen.size(); ++i) {
        if (seen[i].failures.k > 0) order.push_back(i);
      }
    }
    std::stable_sort(order.begin(), order.end(),
                     [&](auto a, auto b) { return is_better(seen[a], seen[b]); });
    for (const std::size_t i : order) {
      if (kept.size() == count) break;
      const bool is_new = std::none_of(kept.begin(), kept.end(), [&](auto other) {
        return is_alike(seen[i].point, seen[other].point);
      });
      if (is_new) kept.push_back(i);
    }
    return kept;
  }

  void go_on() {
    ask.clear();
    if (is_second_look) {
      is_over = true;
      return;
    }
    if (round < options.rounds && idle < kPatience) return ask_round();
    is_second_look = true;
    for (const std::size_t i : best(3 * static_cast<std::size_t>(options.keep))) {
      ask.insert(ask.end(), static_cast<std::size_t>(options.second_look), seen[i].point);
    }
    is_over = ask.empty();
  }

  // After a round, how near its elite came, if all of it fails.
  void count_idle() {
    double far = 0;
    for (const std::size_t i : elite) {
      if (!is_broken(seen[i])) return;
      far += seen[i].distance / static_cast<double>(elite.size());
    }
    if (elite.empty()) return;
    if (far < nearest - kNearer) {
      idle = 0;
      nearest = far;
    } else {
      ++idle;
    }
  }
};

Worst::Worst(Space space, const WorstOptions& options) : state_(std::make_unique<State>()) {
  PROBE_CHECK(options.points > 0 && options.repeats > 0 && options.keep > 0,
              "a round has points and an end has candidates");
  state_->space = std::move(space);
  state_->options = options;
  bool can_change = false;
  for (std::size_t a = 0; a < state_->space.size(); ++a) {
    const Axis& axis = state_->space[a];
    State::Law law;
    if (axis.kind == AxisKind::kChoice && axis.size > 1) {
      law.options.assign(static_cast<std::size_t>(axis.size), 1.0 / (axis.size - 1));
      law.options[static_cast<std::size_t>(axis.own)] = 0;
    }
    can_change = can_change || state_->can_change(a);
    state_->laws.push_back(std::move(law));
  }
  if (!can_change) {
    state_->is_over = true;
    return;
  }
  state_->go_on();
}

Worst::~Worst() = default;
Worst::Worst(Worst&&) noexcept = default;
Worst& Worst::operator=(Worst&&) noexcept = default;

bool Worst::done() const { return state_->is_over; }
std::span<const Point> Worst::ask() const { return state_->ask; }
int Worst::trials() const { return state_->trials; }
int Worst::left_out() const { return state_->left_out; }

void Worst::tell(std::span<const Outcome> outcomes) {
  State& s = *state_;
  PROBE_CHECK(outcomes.size() == s.ask.size(), "every trial that was asked has its outcome");
  const std::size_t first = s.seen.size();
  const auto repeats =
      static_cast<std::size_t>(s.is_second_look ? s.options.second_look : s.options.repeats);
  for (std::size_t i = 0; i < outcomes.size(); i += repeats) {
    State::Seen one{.point = s.ask[i], .failures = {}};
    for (std::size_t j = i; j < i + repeats; ++j) {
      if (outcomes[j] == Outcome::kLeftOut) {
        ++s.left_out;
        continue;
      }
      ++s.trials;
      ++one.failures.n;
      one.failures.k += outcomes[j] == Outcome::kFailed ? 1 : 0;
    }
    if (one.failures.n == 0) continue;
    if (!s.is_second_look) {
      s.add(std::move(one));
      continue;
    }
    // To what was seen of the very point, and of all around it.
    for (State::Seen& other : s.seen) {
      const double w = s.nearness(one.point, other.point);
      other.near_k += w * static_cast<double>(one.failures.k);
      other.near_n += w * static_cast<double>(one.failures.n);
      if (other.point != one.point) continue;
      other.failures.k += one.failures.k;
      other.failures.n += one.failures.n;
    }
  }
  if (!s.is_second_look) {
    ++s.round;
    s.elite = s.elite_of(first);
    s.learn();
    s.count_idle();
  }
  s.go_on();
}

std::vector<Candidate> Worst::candidates() const {
  std::vector<Candidate> result;
  for (const std::size_t i : state_->best(static_cast<std::size_t>(state_->options.keep))) {
    const State::Seen& one = state_->seen[i];
    result.push_back({one.point, one.failures, one.distance});
  }
  return result;
}

std::vector<Point> points_of(std::span<const Candidate> candidates) {
  std::vector<Point> points;
  for (const Candidate& one : candidates) points.push_back(one.point);
  return points;
}

}  // namespace probe::search
