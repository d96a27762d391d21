#include "runtime/expert/tool_way.h"

#include "runtime/expert/servo.h"

namespace probe::expert {
namespace {

constexpr double kPass = 0.03;                      // m, how near the others are passed
constexpr double kWayTurn = 0.2, kLastTurn = 0.05;  // rad
constexpr double kWayStands = 0.0015;               // m in a decision: less is standing still
constexpr int kWayPatience = 3, kWayLongest = 25;   // decisions
constexpr double kNearEnough = 4;                   // times as far will do where it stands

}  // namespace

void ToolWay::begin(std::vector<Pose> way, double near, double before_last) {
  *this = {};
  way_ = std::move(way);
  near_ = near;
  before_last_ = before_last;
}

ToolWay::State ToolWay::advance(const Pose& tool) {
  still_ = is_near(tool, before_, kWayStands, 0.01) ? still_ + 1 : 0;
  before_ = tool;
  ++steps_;
  while (true) {
    const double shift = is_last() ? near_ : is_next_last() ? before_last_ : kPass;
    const bool stands = still_ >= kWayPatience || steps_ >= kWayLongest;
    if (!is_near(tool, goal(), shift, is_last() ? kLastTurn : kWayTurn)) {
      if (!stands) return State::kGoing;
      if (!is_near(tool, goal(), kNearEnough * shift, 0.3)) return State::kStuck;
    }
    steps_ = still_ = 0;
    if (is_last()) return State::kThere;
    ++next_;
  }
}

}  // namespace probe::expert
