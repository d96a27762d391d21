// Which verdicts can still change: a pass over the program that asks of each register whether
// anything that may yet be measured moves it.
#include <vector>

#include "runtime/vm/judge.h"

namespace probe::vm {

bool Judge::decided() const {
  if (!stepped_) return decided_;
  // What hangs on constants and the start alone never changes; the steps say it of the rest.
  std::vector<bool> settled(registers_.size(), true);
  for (const Step& s : each_) {
    const plan::OpInfo& info = *plan::find_op(static_cast<std::uint8_t>(s.op));
    const bool a = !plan::is_register(info.a) || settled[s.a];
    const bool b = !plan::is_register(info.b) || settled[s.b];
    const auto is = [&](std::uint16_t reg, double truth) {
      return settled[reg] && registers_[reg].x == truth;
    };
    bool now = false;
    switch (s.op) {
      case plan::Op::kAND:
        now = (a && b) || is(s.a, 0) || is(s.b, 0);
        break;
      case plan::Op::kOR:
        now = (a && b) || is(s.a, 1) || is(s.b, 1);
        break;
      case plan::Op::kONCE:
      case plan::Op::kALWAYS:  // the state is 1 once it was seen, or broken
        now = a || states_[s.b].value != 0;
        break;
      case plan::Op::kHOLD:  // of what stays true it may still have to see enough
        now = is(s.a, 0) || (is(s.a, 1) && states_[s.b].value >= hold_[s.b]);
        break;
      case plan::Op::kCOUNT:
        now = is(s.a, 0);
        break;
      case plan::Op::kFIRST:
        now = is(s.a, 0) || states_[s.b].started;
        break;
      case plan::Op::kMAXR:
      case plan::Op::kMINR:
      case plan::Op::kRISES:
      case plan::Op::kKEPT:
        now = a;
        break;
      case plan::Op::kEMITB:
      case plan::Op::kEMITR:
        if (!a) return false;
        continue;
      default:  // a measurement may always change, and so may a monitor that is not named here
        now = info.known == plan::Known::kOperands && a && b;
        break;
    }
    settled[s.dst] = now;
  }
  return true;
}

}  // namespace probe::vm
