#include "runtime/rejudge/program_view.h"

#include <algorithm>

#include "runtime/plan/fixtures.h"
#include "runtime/plan/source_line.h"

namespace probe::rejudge {
namespace {

using plan::Kind;
using plan::Op;

constexpr std::uint32_t kFar = 1u << 20;

// Source text on one line.
std::string one_line(std::string_view text) {
  std::string out;
  bool blank = false;
  for (const char c : text) {
    if (c == ' ' || c == '\t' || c == '\n' || c == '\r') {
      blank = !out.empty();
      continue;
    }
    if (blank) out.push_back(' ');
    blank = false;
    out.push_back(c);
  }
  return out;
}

}  // namespace

ProgramView::ProgramView(const plan::Plan& plan, const plan::TaskRecord& task)
    : plan_(plan),
      task_(task),
      program_(plan.programs()[task.program]),
      code_(plan.code(program_)) {
  for (std::uint32_t i = 0; i < code_.size(); ++i) {
    if (plan::find_op(code_[i].op)->result != Kind::kUnused) index_.push_back(i);
  }
  for (std::uint32_t m = 0; m < program_.metrics.count; ++m) uses_.push_back(below(emitted(m)));
}

std::vector<bool> ProgramView::below(std::uint16_t reg) const {
  std::vector<bool> below(registers());
  below[reg] = true;
  for (std::size_t i = registers(); i-- > 0;) {
    if (!below[i]) continue;
    const plan::Instruction& in = at(static_cast<std::uint16_t>(i));
    const plan::OpInfo& info = *plan::find_op(in.op);
    if (plan::is_register(info.a)) below[in.a] = true;
    if (plan::is_register(info.b)) below[in.b] = true;
  }
  return below;
}

std::uint16_t ProgramView::emitted(std::uint32_t metric) const {
  for (const plan::Instruction& in : code_) {
    if (plan::find_op(in.op)->b == Kind::kMetric && in.b == metric) return in.a;
  }
  return 0;  // not in a verified plan
}

std::uint16_t ProgramView::hold(std::uint16_t reg) const {
  return plan_.states(program_)[at(reg).b].n;
}

void ProgramView::locate(std::uint16_t reg, std::uint32_t metric, Condition& condition) const {
  condition.text = plan::find_op(at(reg).op)->name;
  const auto places = plan_.spans_of(plan::SpanKind::kCode, program_.code.first + index_[reg]);
  if (places.empty()) return;
  // One place for all, or one for each metric that depends on it.
  std::size_t before = 0, users = 0;
  for (std::uint32_t m = 0; m < uses_.size(); ++m) {
    if (!uses_[m][reg]) continue;
    ++users;
    if (m < metric) ++before;
  }
  const plan::SpanRecord& span = places[places.size() == users ? before : 0];
  const plan::TextRecord& text = plan_.texts()[span.text];
  const std::string_view source = plan_.tables().source(text);
  condition.file = plan_.tables().path(text);
  condition.line = plan::line_at(source, span.begin).number;
  condition.text = one_line(source.substr(span.begin, span.end - span.begin));
}

std::string ProgramView::bodies(std::uint16_t reg, bool swapped) const {
  std::vector<bool> seen(registers());
  std::vector<std::uint16_t> open = {reg};
  std::vector<std::string> named;
  std::string out;
  const auto add = [&](const std::string& name) {
    if (std::ranges::find(named, name) != named.end()) return;
    named.push_back(name);
    out += (out.empty() ? "" : ", ") + name;
  };
  const auto name = [&](std::uint16_t body) {
    add(std::string(plan_.text(plan_.bodies(task_)[body].name)));
  };
  while (!open.empty()) {
    const std::uint16_t next = open.back();
    open.pop_back();
    if (seen[next]) continue;
    seen[next] = true;
    const plan::Instruction& in = at(next);
    const plan::OpInfo& info = *plan::find_op(in.op);
    if (plan::is_body(info.a)) name(in.a);
    if (plan::is_body(info.b)) name(in.b);
    if (info.a == Kind::kJoint)
      add(plan::joint_names_of(plan_.tables(), plan_.scenes()[task_.scene])[in.a]);
    // The operand that is to be looked at first is pushed last.
    const bool is_turned = swapped && next == reg;
    if (is_turned && plan::is_register(info.a)) open.push_back(in.a);
    if (plan::is_register(info.b)) open.push_back(in.b);
    if (!is_turned && plan::is_register(info.a)) open.push_back(in.a);
  }
  return out;
}

bool ProgramView::is_condition(std::uint16_t reg) const {
  return op(reg) == Op::kLT || op(reg) == Op::kLE || op(reg) == Op::kHOLD || is_kept(reg);
}

bool ProgramView::is_kept(std::uint16_t reg) const {
  return op(reg) == Op::kONCE || op(reg) == Op::kALWAYS;
}

std::vector<std::uint16_t> ProgramView::conditions(std::uint16_t reg) const {
  std::vector<bool> below(registers());
  below[reg] = true;
  std::vector<std::uint16_t> found;
  for (std::size_t i = registers(); i-- > 0;) {
    const auto at_reg = static_cast<std::uint16_t>(i);
    const plan::Instruction& in = at(at_reg);
    const plan::OpInfo& info = *plan::find_op(in.op);
    if (!below[i] || info.result == Kind::kVector) continue;
    if (is_condition(at_reg)) found.push_back(at_reg);
    if (is_kept(at_reg)) continue;  // what was once so is no more to be seen in what is so now
    if (info.a == Kind::kBool) below[in.a] = true;
    if (info.b == Kind::kBool) below[in.b] = true;
  }
  std::ranges::reverse(found);
  return found;
}

std::vector<std::uint32_t> ProgramView::distances(const vm::Judge& judge,
                                                  const std::vector<int>& held) const {
  std::vector<std::uint32_t> to_true(registers(), 0), to_false(registers(), 0);
  for (std::size_t i = 0; i < registers(); ++i) {
    const plan::Instruction& in = at(static_cast<std::uint16_t>(i));
    if (plan::find_op(in.op)->result != Kind::kBool) continue;
    const bool value = judge.register_value(i).x() != 0;
    const auto op = static_cast<Op>(in.op);
    if (op == Op::kAND) {
      to_true[i] = to_true[in.a] + to_true[in.b];
      to_false[i] = std::min(to_false[in.a], to_false[in.b]);
    } else if (op == Op::kOR) {
      to_true[i] = std::min(to_true[in.a], to_true[in.b]);
      to_false[i] = to_false[in.a] + to_false[in.b];
    } else if (op == Op::kNOT) {
      to_true[i] = to_false[in.a];
      to_false[i] = to_true[in.a];
    } else if (op == Op::kHOLD) {
      const auto reg = static_cast<std::uint16_t>(i);
      to_true[i] = value ? 0 : to_true[in.a] + hold(reg) - static_cast<std::uint32_t>(held[i]);
      to_false[i] = value ? 1 : 0;
    } else {
      // Every other truth is one thing that is so or is not, and a constant stays what it is.
      const std::uint32_t step = op == Op::kKB ? kFar : 1;
      to_true[i] = value ? 0 : step;
      to_false[i] = value ? step : 0;
    }
    to_true[i] = std::min(to_true[i], kFar);
    to_false[i] = std::min(to_false[i], kFar);
  }
  return to_true;
}

std::vector<bool> ProgramView::deciding(std::uint16_t reg, const vm::Judge& judge) const {
  const auto truth = [&](std::uint16_t r) { return judge.register_value(r).x() != 0; };
  std::vector<bool> marked(registers());
  marked[reg] = true;
  for (std::size_t i = registers(); i-- > 0;) {
    if (!marked[i]) continue;
    const plan::Instruction& in = at(static_cast<std::uint16_t>(i));
    const plan::OpInfo& info = *plan::find_op(in.op);
    const bool value = truth(static_cast<std::uint16_t>(i));
    if (info.op == Op::kAND || info.op == Op::kOR) {
      // A conjunction is false, a disjunction true, because of those that are.
      const bool all = (info.op == Op::kAND) == value;
      if (all || truth(in.a) == value) marked[in.a] = true;
      if (all || truth(in.b) == value) marked[in.b] = true;
    } else if (info.a == Kind::kBool) {
      marked[in.a] = true;
    }
  }
  return marked;
}

}  // namespace probe::rejudge
