#include "compiler/lower/builder.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "runtime/plan/verify.h"

namespace probe::lower {

using plan::Op;

std::uint16_t Builder::append(Op op, std::uint16_t a, std::uint16_t b, bool has_result) {
  // One place is kept for END.
  if (program_.code.size() + 1 >= plan::kMaxInstructions) {
    full_ = true;
    return 0;
  }
  const std::uint16_t dst = results_;
  program_.code.push_back({static_cast<std::uint8_t>(op), 0, dst, a, b});
  program_.spans.push_back(span_);
  if (has_result) {
    ++results_;
    makers_.push_back(static_cast<std::uint32_t>(program_.code.size() - 1));
  }
  return dst;
}

std::uint16_t Builder::ask(std::uint16_t result) {
  asked_.try_emplace({result, program_.metrics.size()}, span_);
  return result;
}

std::uint16_t Builder::emit(Op op, std::uint16_t a, std::uint16_t b) {
  const auto [at, is_new] = known_.try_emplace({op, a, b}, 0);
  if (is_new) at->second = append(op, a, b, true);
  return ask(at->second);
}

std::uint16_t Builder::constant_slot(double value) {
  const auto slot = static_cast<std::uint16_t>(program_.constants.size());
  const auto [at, is_new] = constants_.try_emplace(std::bit_cast<std::uint64_t>(value), slot);
  if (is_new) program_.constants.push_back(value);
  return at->second;
}

std::uint16_t Builder::constant(double value) { return emit(Op::kKR, constant_slot(value)); }

std::uint16_t Builder::vector(double x, double y, double z) {
  // KV reads three neighbours, so they are searched for together.
  const double wanted[] = {x, y, z};
  std::size_t at = 0;
  const auto matches = [&](std::size_t first) {
    for (std::size_t i = 0; i < 3; ++i) {
      if (std::bit_cast<std::uint64_t>(program_.constants[first + i]) !=
          std::bit_cast<std::uint64_t>(wanted[i]))
        return false;
    }
    return true;
  };
  while (at + 3 <= program_.constants.size() && !matches(at)) ++at;
  if (at + 3 > program_.constants.size()) {
    at = program_.constants.size();
    program_.constants.insert(program_.constants.end(), {x, y, z});
  }
  return emit(Op::kKV, static_cast<std::uint16_t>(at));
}

std::uint16_t Builder::in_register(const Value& value) {
  switch (value.kind) {
    case Value::kTruth:
      return emit(Op::kKB, value.truth ? 1 : 0);
    case Value::kNumber:
      return constant(value.number);
    default:
      return value.index;
  }
}

Value Builder::logical_not(const Value& a) {
  if (a.kind == Value::kTruth) return Value::of_truth(!a.truth);
  return Value::of_register(emit(Op::kNOT, a.index));
}

Value Builder::logical_and(const Value& a, const Value& b) {
  if (a.kind == Value::kTruth) return a.truth ? b : a;
  if (b.kind == Value::kTruth) return b.truth ? a : b;
  if (a.index == b.index) return a;
  return Value::of_register(emit(Op::kAND, a.index, b.index));
}

Value Builder::logical_or(const Value& a, const Value& b) {
  if (a.kind == Value::kTruth) return a.truth ? a : b;
  if (b.kind == Value::kTruth) return b.truth ? b : a;
  if (a.index == b.index) return a;
  return Value::of_register(emit(Op::kOR, a.index, b.index));
}

Value Builder::less(const Value& a, const Value& b, bool or_equal) {
  if (a.kind == Value::kNumber && b.kind == Value::kNumber) {
    return Value::of_truth(or_equal ? a.number <= b.number : a.number < b.number);
  }
  const std::uint16_t left = in_register(a);
  const std::uint16_t right = in_register(b);
  return Value::of_register(emit(or_equal ? Op::kLE : Op::kLT, left, right));
}

Value Builder::arithmetic(Op op, const Value& a, const Value& b) {
  if (a.kind == Value::kNumber && b.kind == Value::kNumber) {
    // What is not folded here is computed by the judge.
    const double x = a.number, y = b.number;
    if (op == Op::kADD) return Value::of_number(x + y);
    if (op == Op::kSUB) return Value::of_number(x - y);
    if (op == Op::kMUL) return Value::of_number(x * y);
    if (op == Op::kMIN) return Value::of_number(y < x ? y : x);
    if (op == Op::kMAX) return Value::of_number(x < y ? y : x);
  }
  const std::uint16_t left = in_register(a);
  const std::uint16_t right = in_register(b);
  return Value::of_register(emit(op, left, right));
}

Value Builder::negate(const Value& a) {
  if (a.kind == Value::kNumber) return Value::of_number(-a.number);
  return Value::of_register(emit(Op::kNEG, a.index));
}

Value Builder::monitor(Op op, const Value& a, std::uint16_t n) {
  const std::uint16_t input = in_register(a);
  const auto [at, is_new] = monitors_.try_emplace({op, input, n}, 0);
  if (is_new) {
    const auto slot = static_cast<std::uint16_t>(program_.states.size());
    program_.states.push_back({static_cast<std::uint16_t>(op), n});
    at->second = append(op, input, slot, true);
  }
  return Value::of_register(ask(at->second));
}

void Builder::emit_metric(const Value& value, ProgramMetric metric) {
  const std::uint16_t input = in_register(value);
  const Op op = metric.type == plan::MetricType::kBool ? Op::kEMITB : Op::kEMITR;
  program_.metrics.push_back(std::move(metric));
  append(op, input, static_cast<std::uint16_t>(program_.metrics.size() - 1), false);
}

// A shared truth stands at several places in the text, and an explanation of one metric must not
// cite another's. What was asked for and then folded away counts for nothing.
void Builder::find_places() {
  std::vector<std::vector<Span>> places(makers_.size());
  for (const plan::Instruction& end : program_.code) {
    if (end.op != static_cast<std::uint8_t>(Op::kEMITB) &&
        end.op != static_cast<std::uint8_t>(Op::kEMITR))
      continue;
    std::vector<bool> is_used(makers_.size());
    is_used[end.a] = true;
    for (std::size_t r = end.a + std::size_t{1}; r-- > 0;) {
      if (!is_used[r]) continue;
      const plan::Instruction& in = program_.code[makers_[r]];
      const plan::OpInfo& info = *plan::find_op(in.op);
      if (plan::is_register(info.a)) is_used[in.a] = true;
      if (plan::is_register(info.b)) is_used[in.b] = true;
      if (info.result != plan::Kind::kBool) continue;
      const auto asked = asked_.find({static_cast<std::uint16_t>(r), std::size_t{end.b}});
      places[r].push_back(asked == asked_.end() ? program_.spans[makers_[r]] : asked->second);
    }
  }
  for (std::size_t r = 0; r < places.size(); ++r) {
    const Span& first = program_.spans[makers_[r]];
    const bool is_one_place = std::all_of(places[r].begin(), places[r].end(),
                                          [&](const Span& place) { return place == first; });
    if (!is_one_place) program_.places[makers_[r]] = std::move(places[r]);
  }
}

Program Builder::finish() {
  find_places();
  program_.code.push_back({static_cast<std::uint8_t>(Op::kEND), 0, results_, 0, 0});
  program_.spans.push_back(span_);
  return std::move(program_);
}

}  // namespace probe::lower
