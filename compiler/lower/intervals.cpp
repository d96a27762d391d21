#include "compiler/lower/intervals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "runtime/plan/isa.h"
#include "runtime/plan/readouts.h"

namespace probe::lower {
namespace {

using plan::Op;

constexpr double kNever = *plan::info(plan::Readout::kFirst).never;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// No body is faster (m/s).
constexpr double kFastest = 1000;
// What has settled moves less than this (m/s, rad/s; m), and presses what carries it more (N s).
constexpr double kStill = 2e-3, kSettled = 1e-3, kLeastPress = 1e-5;
// Of RATIO.
constexpr double kLeastDivisor = 1e-3;
// Components of unit vectors, with room for their rounding.
constexpr double kUnit = 1 + 1e-9;

// 0 times infinity is 0 here: the factor is 0 whatever the other is.
double times(double a, double b) { return a == 0 || b == 0 ? 0 : a * b; }

Interval product(const Interval& a, const Interval& b) {
  const double corners[] = {times(a.low, b.low), times(a.low, b.high), times(a.high, b.low),
                            times(a.high, b.high)};
  return {*std::min_element(corners, corners + 4), *std::max_element(corners, corners + 4)};
}

double least_of(const Interval& a) { return a.low > 0 ? a.low : a.high < 0 ? -a.high : 0; }
double most_of(const Interval& a) { return std::max(std::abs(a.low), std::abs(a.high)); }

Interval sum(const Interval& a, const Interval& b) { return {a.low + b.low, a.high + b.high}; }
Interval negative(const Interval& a) { return {-a.high, -a.low}; }

// What is known of one result.
struct Known {
  Interval number;
  std::array<Interval, 3> vector;
  std::optional<bool> truth;
  std::size_t instruction = 0;
  // The result is that of instruction `base` plus `offset`.
  std::size_t base = 0;
  double offset = 0;
};

// Limits of one register along a chain of `and`.
struct Limits {
  Interval range;
  bool low_open = false, high_open = false;

  void above(double value, bool open) {
    if (value < range.low || (value == range.low && !open)) return;
    range.low = value;
    low_open = open;
  }
  void below(double value, bool open) {
    if (value > range.high || (value == range.high && !open)) return;
    range.high = value;
    high_open = open;
  }
  bool is_empty() const {
    return range.low > range.high || (range.low == range.high && (low_open || high_open));
  }
};

class Pass {
 public:
  Pass(const Program& program, std::uint64_t horizon, double control_hz, const Room& room)
      : program_(program),
        horizon_(static_cast<double>(horizon)),
        control_hz_(control_hz),
        room_(room) {}
  // In one start, before anything moves.
  Pass(const Program& program, std::span<const PlacedBody> placed)
      : program_(program), horizon_(1), control_hz_(0), placed_(placed) {}

  // The same, and what else is known before anything moves.
  Pass(const Program& program, const AtRest& rest)
      : program_(program), horizon_(1), control_hz_(0), placed_(rest.placed), rest_(&rest) {}

  Findings run() {
    for (std::size_t i = 0; i < program_.code.size(); ++i) {
      const plan::Instruction& code = program_.code[i];
      const Op op = static_cast<Op>(code.op);
      if (op == Op::kEMITB && known_[code.a].truth)
        findings_.constants.push_back({code.b, *known_[code.a].truth, std::nullopt});
      if (op == Op::kEMITR && known_[code.a].number.is_point())
        findings_.constants.push_back({code.b, false, known_[code.a].number.low});
      if (op == Op::kEMITB || op == Op::kEMITR || op == Op::kEND) continue;
      known_.push_back(result(op, code, i));
      known_.back().instruction = i;
      place(op, code, known_.back());
    }
    return std::move(findings_);
  }

 private:
  static Known number(double low, double high) { return of({low, high}); }
  static Known of(const Interval& interval) {
    Known known;
    known.number = interval;
    return known;
  }
  // The same bounds on all three axes.
  static Known vector(double low, double high) {
    Known known;
    known.vector = {{{low, high}, {low, high}, {low, high}}};
    return known;
  }
  static Known vector(const std::array<Interval, 3>& axes) {
    Known known;
    known.vector = axes;
    return known;
  }
  template <typename Combine>
  static Known by_axis(const Known& a, const Known& b, Combine combine) {
    Known known;
    for (std::size_t i = 0; i < 3; ++i) known.vector[i] = combine(a.vector[i], b.vector[i]);
    return known;
  }
  // Of the first `axes` axes.
  static Interval length(const std::array<Interval, 3>& v, std::size_t axes) {
    double least = 0, most = 0;
    for (std::size_t i = 0; i < axes; ++i) {
      least += least_of(v[i]) * least_of(v[i]);
      most += most_of(v[i]) * most_of(v[i]);
    }
    return {std::sqrt(least), std::sqrt(most)};
  }
  static Interval inner(const std::array<Interval, 3>& a, const std::array<Interval, 3>& b) {
    return sum(sum(product(a[0], b[0]), product(a[1], b[1])), product(a[2], b[2]));
  }

  static Known truth(std::optional<bool> value) {
    Known known;
    known.truth = value;
    return known;
  }

  // A joint is held at its limits as a contact is: it goes beyond them by less than this (m, rad).
  Known joint(std::uint16_t index) const {
    constexpr double kBeyond = 1e-2;
    if (rest_ != nullptr && index < rest_->joints.size()) return of(rest_->joints[index]);
    if (index >= room_.joints.size()) return {};
    return number(room_.joints[index].first - kBeyond, room_.joints[index].second + kBeyond);
  }

  // `x - 1cm` stays comparable with `x`.
  void place(Op op, const plan::Instruction& code, Known& result) const {
    result.base = result.instruction;
    if (op != Op::kADD && op != Op::kSUB) return;
    const Known& a = known_[code.a];
    const Known& b = known_[code.b];
    if (b.number.is_point()) {
      result.base = a.base;
      result.offset = a.offset + (op == Op::kADD ? b.number.low : -b.number.low);
    } else if (op == Op::kADD && a.number.is_point()) {
      result.base = b.base;
      result.offset = b.offset + a.number.low;
    }
  }

  Known result(Op op, const plan::Instruction& code, std::size_t at) {
    const auto a = [&]() -> const Known& { return known_[code.a]; };
    const auto b = [&]() -> const Known& { return known_[code.b]; };
    switch (op) {
      case Op::kKR:
        return number(program_.constants[code.a], program_.constants[code.a]);
      case Op::kKB:
        return truth(code.a != 0);
      case Op::kKV: {
        std::array<Interval, 3> axes;
        for (std::size_t i = 0; i < 3; ++i) {
          const double value = program_.constants[code.a + i];
          axes[i] = {value, value};
        }
        return vector(axes);
      }
      case Op::kPOS:
      case Op::kSTART:
        if (code.a < placed_.size()) return vector(placed_[code.a].position);
        return vector(-room_.farthest, room_.farthest);
      case Op::kORIGIN:
        if (code.a < placed_.size()) return vector(placed_[code.a].origin);
        return vector(-room_.farthest, room_.farthest);
      case Op::kTCP:
        return vector(-room_.farthest, room_.farthest);
      case Op::kHALF:
        if (code.a < placed_.size()) return vector(placed_[code.a].half);
        return vector(0, room_.largest);
      case Op::kOPEN:
        return vector(-kUnit, kUnit);
      case Op::kAXIS:
        if (code.a < placed_.size()) return vector(placed_[code.a].axes[code.b]);
        return vector(-kUnit, kUnit);
      // As far as what is measured in the world's frame: both lie in the room.
      case Op::kLOCAL:
        return vector(-4 * room_.farthest, 4 * room_.farthest);
      case Op::kSLIDE:
      case Op::kTURN:
        return joint(code.a);
      case Op::kSLIDING:
        return rest_ != nullptr ? number(-kStill, kStill) : number(-kFastest, kFastest);
      case Op::kVEL:
        return rest_ != nullptr ? vector(-kStill, kStill) : vector(-kFastest, kFastest);
      case Op::kVADD:
        return by_axis(a(), b(), sum);
      case Op::kVSUB:
        if (rest_ != nullptr && is_same_place(code.a, code.b)) return vector(-kSettled, kSettled);
        return by_axis(a(), b(),
                       [](const Interval& p, const Interval& q) { return sum(p, negative(q)); });
      case Op::kVSCALE: {
        std::array<Interval, 3> axes;
        for (std::size_t i = 0; i < 3; ++i) axes[i] = product(a().vector[i], b().number);
        return vector(axes);
      }
      case Op::kVDOT:
        return of(inner(a().vector, b().vector));
      case Op::kIMP: {
        const auto touch = rest_ != nullptr ? rest_->touch(code.a, code.b) : std::nullopt;
        return touch && !*touch ? number(0, 0) : number(touch ? kLeastPress : 0, kInfinity);
      }
      case Op::kVLEN:
        return of(length(a().vector, 3));
      case Op::kVLENXY:
        return of(length(a().vector, 2));
      case Op::kVX:
        return of(a().vector[0]);
      case Op::kVY:
        return of(a().vector[1]);
      case Op::kVZ:
        return of(a().vector[2]);
      case Op::kGRIP:
        return number(0, 1);
      case Op::kSTEP:
        return number(1, horizon_);
      case Op::kTIME:
        // With room for the rounding of a sum of steps.
        return number(0, control_hz_ > 0 ? horizon_ / control_hz_ * kUnit : kInfinity);
      case Op::kADD:
        return of(sum(a().number, b().number));
      case Op::kSUB:
        return of(sum(a().number, negative(b().number)));
      case Op::kMUL:
        return of(product(a().number, b().number));
      case Op::kRATIO:
        return of(product(a().number, {1 / std::max(b().number.high, kLeastDivisor),
                                       1 / std::max(b().number.low, kLeastDivisor)}));
      case Op::kNEG:
        return of(negative(a().number));
      case Op::kABS:
        return number(least_of(a().number), most_of(a().number));
      case Op::kMIN:
        return number(std::min(a().number.low, b().number.low),
                      std::min(a().number.high, b().number.high));
      case Op::kMAX:
        return number(std::max(a().number.low, b().number.low),
                      std::max(a().number.high, b().number.high));
      case Op::kLT:
        return truth(compare(a(), b(), false));
      case Op::kLE:
        return truth(compare(a(), b(), true));
      case Op::kAND:
        return both(at, a().truth, b().truth);
      case Op::kOR:
        return truth(either(code, a().truth, b().truth));
      case Op::kNOT:
        return truth(a().truth ? std::optional(!*a().truth) : std::nullopt);
      case Op::kONCE:
      case Op::kALWAYS:
        return truth(a().truth);
      case Op::kHOLD:
        return truth(rest_ != nullptr || a().truth == std::optional(false) ? a().truth
                                                                           : std::nullopt);
      // A read-out has one value, that of the last step.
      case Op::kCOUNT:
        if (a().truth) return number(*a().truth ? horizon_ : 0, *a().truth ? horizon_ : 0);
        return number(0, horizon_);
      case Op::kFIRST:
        if (a().truth) return number(*a().truth ? 1 : kNever, *a().truth ? 1 : kNever);
        return number(kNever, horizon_);
      case Op::kMAXR:
      case Op::kMINR:
        return of(a().number);
      case Op::kRISES:  // every other step at most
        if (a().truth) return number(*a().truth ? 1 : 0, *a().truth ? 1 : 0);
        return number(0, std::ceil(horizon_ / 2));
      case Op::kGATED:
        return vector(std::array<Interval, 3>{a().number, Interval{0, 1}, Interval{0, 0}});
      case Op::kKEPT:
        return of(a().vector[0]);
      // Contacts and turning have no bound that is worth a message.
      case Op::kPUSH:
        if (rest_ != nullptr && rest_->touch(code.a, code.b) == std::optional(false))
          return vector(0, 0);
        return {};
      case Op::kSPIN:
        return rest_ != nullptr ? vector(-kStill, kStill) : Known{};
      case Op::kTURNING:
        return rest_ != nullptr ? number(-kStill, kStill) : Known{};
      case Op::kVCROSS:
      // Without a result.
      case Op::kEND:
      case Op::kEMITB:
      case Op::kEMITR:
        return {};
    }
    return {};
  }

  // Where one body is, and where it was when it had settled.
  bool is_same_place(std::uint16_t a, std::uint16_t b) const {
    const plan::Instruction& one = program_.code[known_[a].instruction];
    const plan::Instruction& other = program_.code[known_[b].instruction];
    const auto is_place = [](const plan::Instruction& code) {
      return static_cast<Op>(code.op) == Op::kPOS || static_cast<Op>(code.op) == Op::kSTART;
    };
    return is_place(one) && is_place(other) && one.a == other.a;
  }

  static std::optional<bool> compare(const Known& left, const Known& right, bool or_equal) {
    if (left.base == right.base)
      return or_equal ? left.offset <= right.offset : left.offset < right.offset;
    const Interval& a = left.number;
    const Interval& b = right.number;
    if (or_equal ? a.high <= b.low : a.high < b.low) return true;
    if (or_equal ? a.low > b.high : a.low >= b.high) return false;
    return std::nullopt;
  }

  std::optional<bool> either(const plan::Instruction& code, std::optional<bool> a,
                             std::optional<bool> b) {
    if (a == std::optional(true) || b == std::optional(true)) return true;
    if (a && b) return false;
    // Nothing is left out by these when their opposites exclude one another.
    Conjunction opposite;
    if (collect_not(code.a, opposite) && collect_not(code.b, opposite) && opposite.impossible)
      return true;
    return std::nullopt;
  }

  Known both(std::size_t at, std::optional<bool> a, std::optional<bool> b) {
    if (a == std::optional(false) || b == std::optional(false)) return truth(false);
    if (a && b) return truth(true);
    const plan::Instruction& code = program_.code[at];
    Conjunction conjunction;
    if (collect(code.a, conjunction) && collect(code.b, conjunction)) {
      if (conjunction.impossible) findings_.contradictions.push_back(at);
    }
    return truth(std::nullopt);
  }

  struct Conjunction {
    std::map<std::uint16_t, Limits> limits;
    // Comparisons of two measurements, the smaller first: whether they must differ.
    std::map<std::pair<std::uint16_t, std::uint16_t>, bool> orders;
    bool impossible = false;
  };

  // The comparisons that all hold when `reg` holds. False when a part has been found impossible.
  bool collect(std::uint16_t reg, Conjunction& out) {
    const std::size_t at = known_[reg].instruction;
    const auto& found = findings_.contradictions;
    if (std::find(found.begin(), found.end(), at) != found.end()) return false;
    const plan::Instruction& code = program_.code[at];
    // What is none of these says nothing that could contradict.
    const auto op = static_cast<Op>(code.op);
    if (op == Op::kAND) return collect(code.a, out) && collect(code.b, out);
    if (op == Op::kNOT) return collect_not(code.a, out);
    if (op == Op::kLT || op == Op::kLE) note(code.a, code.b, op == Op::kLT, out);
    return true;
  }

  // The comparisons that all hold when `reg` does not.
  bool collect_not(std::uint16_t reg, Conjunction& out) {
    const plan::Instruction& code = program_.code[known_[reg].instruction];
    const auto op = static_cast<Op>(code.op);
    if (op == Op::kOR) return collect_not(code.a, out) && collect_not(code.b, out);
    if (op == Op::kNOT) return collect(code.a, out);
    // Not a < b is b <= a: a measurement that is no number ends the episode instead.
    if (op == Op::kLT || op == Op::kLE) note(code.b, code.a, op == Op::kLE, out);
    return true;
  }

  void note(std::uint16_t less, std::uint16_t more, bool open, Conjunction& out) {
    const Interval& a = known_[less].number;
    const Interval& b = known_[more].number;
    if (!a.is_point() && !b.is_point()) {
      bool& differ = out.orders.try_emplace({less, more}, false).first->second;
      differ = differ || open;
      const auto other = out.orders.find({more, less});
      if (other != out.orders.end() && (differ || other->second)) out.impossible = true;
      return;
    }
    if (a.is_point() && b.is_point()) return;
    const std::uint16_t reg = a.is_point() ? more : less;
    Limits& limits = out.limits.try_emplace(reg, Limits{known_[reg].number}).first->second;
    if (a.is_point()) {
      limits.above(a.low, open);
    } else {
      limits.below(b.low, open);
    }
    out.impossible = out.impossible || limits.is_empty();
  }

  const Program& program_;
  double horizon_, control_hz_;
  Room room_;
  std::span<const PlacedBody> placed_;
  const AtRest* rest_ = nullptr;
  std::vector<Known> known_;
  Findings findings_;
};

}  // namespace

Findings find_constants(const Program& program, std::uint64_t horizon, double control_hz,
                        const Room& room) {
  return Pass(program, horizon, control_hz, room).run();
}

std::optional<bool> holds_at_rest(const Program& program, std::size_t metric, const AtRest& rest) {
  for (const ConstantMetric& found : Pass(program, rest).run().constants) {
    if (found.metric == metric && !found.number) return found.value;
  }
  return std::nullopt;
}

std::optional<bool> holds(const Program& program, std::span<const PlacedBody> placed) {
  const Findings findings = Pass(program, placed).run();
  if (findings.constants.empty()) return std::nullopt;
  return findings.constants.front().value;
}

}  // namespace probe::lower
