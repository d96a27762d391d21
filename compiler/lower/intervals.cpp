#include "compiler/lower/intervals.h"

#include <algorithm>
#include <limits>
#include <map>
#include <optional>

#include "runtime/plan/isa.h"

namespace probe::lower {
namespace {

using plan::Op;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Interval {
  double low = -kInfinity, high = kInfinity;
  bool is_point() const { return low == high; }
};

// 0 times infinity is 0 here: the factor is 0 whatever the other is.
double times(double a, double b) { return a == 0 || b == 0 ? 0 : a * b; }

Interval product(const Interval& a, const Interval& b) {
  const double corners[] = {times(a.low, b.low), times(a.low, b.high), times(a.high, b.low),
                            times(a.high, b.high)};
  return {*std::min_element(corners, corners + 4), *std::max_element(corners, corners + 4)};
}

// What is known of one result. Vectors keep one interval for all of their components.
struct Known {
  Interval number;
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
  Pass(const Program& program, std::uint64_t horizon)
      : program_(program), horizon_(static_cast<double>(horizon)) {}

  Findings run() {
    for (std::size_t i = 0; i < program_.code.size(); ++i) {
      const plan::Instruction& code = program_.code[i];
      const Op op = static_cast<Op>(code.op);
      if (op == Op::kEMITB && known_[code.a].truth)
        findings_.constants.push_back({code.b, *known_[code.a].truth});
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
  static Known truth(std::optional<bool> value) {
    Known known;
    known.truth = value;
    return known;
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
      case Op::kHALF:
      case Op::kIMP:
      case Op::kVLEN:
      case Op::kVLENXY:
        return number(0, kInfinity);
      case Op::kVX:
      case Op::kVY:
      case Op::kVZ:
        return of(a().number);
      case Op::kGRIP:
        return number(0, 1);
      case Op::kSTEP:
        return number(1, horizon_);
      case Op::kTIME:
        return number(0, kInfinity);
      case Op::kADD:
        return number(a().number.low + b().number.low, a().number.high + b().number.high);
      case Op::kSUB:
        return number(a().number.low - b().number.high, a().number.high - b().number.low);
      case Op::kMUL:
        return of(product(a().number, b().number));
      case Op::kNEG:
        return number(-a().number.high, -a().number.low);
      case Op::kABS:
        return absolute(a().number);
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
        return truth(either(a().truth, b().truth));
      case Op::kNOT:
        return truth(a().truth ? std::optional(!*a().truth) : std::nullopt);
      case Op::kONCE:
      case Op::kALWAYS:
        return truth(a().truth);
      case Op::kHOLD:
        return truth(a().truth == std::optional(false) ? a().truth : std::nullopt);
      case Op::kCOUNT:
        return number(0, horizon_);
      case Op::kFIRST:
        return number(-1, horizon_);
      case Op::kMAXR:
      case Op::kMINR:
        return of(a().number);
      default:
        return {};
    }
  }

  static Known absolute(const Interval& a) {
    if (a.low >= 0) return number(a.low, a.high);
    if (a.high <= 0) return number(-a.high, -a.low);
    return number(0, std::max(-a.low, a.high));
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

  static std::optional<bool> either(std::optional<bool> a, std::optional<bool> b) {
    if (a == std::optional(true) || b == std::optional(true)) return true;
    if (a && b) return false;
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
    bool impossible = false;
  };

  // The comparisons that all hold when `reg` holds. False when a part has been found impossible.
  bool collect(std::uint16_t reg, Conjunction& out) {
    const std::size_t at = known_[reg].instruction;
    const auto& found = findings_.contradictions;
    if (std::find(found.begin(), found.end(), at) != found.end()) return false;
    const plan::Instruction& code = program_.code[at];
    switch (static_cast<Op>(code.op)) {
      case Op::kAND:
        return collect(code.a, out) && collect(code.b, out);
      case Op::kLT:
        note(code.a, code.b, true, out);
        break;
      case Op::kLE:
        note(code.a, code.b, false, out);
        break;
      case Op::kNOT: {
        // Not a < b is b <= a: a measurement that is no number ends the episode instead.
        const plan::Instruction& inner = program_.code[known_[code.a].instruction];
        if (static_cast<Op>(inner.op) == Op::kLT) note(inner.b, inner.a, false, out);
        if (static_cast<Op>(inner.op) == Op::kLE) note(inner.b, inner.a, true, out);
        break;
      }
      default:
        break;
    }
    return true;
  }

  void note(std::uint16_t less, std::uint16_t more, bool open, Conjunction& out) {
    const Interval& a = known_[less].number;
    const Interval& b = known_[more].number;
    if (a.is_point() == b.is_point()) return;
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
  double horizon_;
  std::vector<Known> known_;
  Findings findings_;
};

}  // namespace

Findings find_constants(const Program& program, std::uint64_t horizon) {
  return Pass(program, horizon).run();
}

}  // namespace probe::lower
