// Stage 2: what a plan says of robots beyond their own record: control laws, gears, fingers.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <vector>

#include "runtime/plan/limits.h"
#include "runtime/plan/verify_records.h"

namespace probe::plan {

Status RecordCheck::check(const LawRecord& l) const {
  for (const std::array<double, 6>* of : {&l.kp, &l.damping, &l.output}) {
    for (const double& value : *of) PROBE_TRY(check_not_negative(value, "a gain"));
  }
  PROBE_TRY(check_magnitude(l.kp, Magnitude::kGain));
  PROBE_TRY(check_magnitude(l.damping, Magnitude::kGain));
  PROBE_TRY(check_finite(l.output));
  for (const double* gain : {&l.null_kp, &l.grip_stiffness}) {
    PROBE_TRY(check_not_negative(*gain, "a gain"));
    PROBE_TRY(check_magnitude(*gain, Magnitude::kGain));
  }
  for (const double* of : {&l.ramp, &l.grip_pace, &l.grip_limit, &l.most})
    PROBE_TRY(check_not_negative(*of, "a number of a control law"));
  PROBE_TRY(check_magnitude(l.most, Magnitude::kJointPosition));
  PROBE_TRY(check_slice(l.home, t.reals.size(), "REAL"));
  PROBE_TRY(check_magnitude(slice_of(t.reals, l.home), Magnitude::kJointPosition));
  for (const std::array<double, 3>* path : {&l.arm_path, &l.finger_path}) {
    for (const double& value : *path) {
      PROBE_TRY(check_not_negative(value, "a limit of a path"));
      PROBE_TRY(check_magnitude(value, Magnitude::kGain));
    }
  }
  return check_zero(l.zero);
}

Status RecordCheck::check(const GearRecord& g) const {
  PROBE_TRY(check_not_negative(g.friction, "the friction of a joint"));
  PROBE_TRY(check_finite({&g.friction, 1}));
  if (g.friction != 0) PROBE_TRY(check_magnitude(g.friction, Magnitude::kForce));
  PROBE_TRY(check_not_negative(g.armature, "an armature"));
  return check_magnitude(g.armature, Magnitude::kArmature);
}

Status RecordCheck::check(const FingerRecord& f) const {
  PROBE_TRY(check_name(f.link, "the link of a finger"));
  return check_unit(f.opens, "the opening axis of a finger");
}

namespace {

class RobotCheck : FieldCheck {
 public:
  using FieldCheck::FieldCheck;

  Status run() {
    for (const RobotRecord& r : t.robots) {
      PROBE_TRY(drives(r));
      PROBE_TRY(law(r));
      if (r.gears.count != 0 && r.gears.count != r.drives.count) {
        return fail(
            Rule::kGearCount, &r.gears,
            fmt::format("a robot of {} drives has {} gears", r.drives.count, r.gears.count));
      }
      PROBE_TRY(fingers(r));
      PROBE_TRY(next(r.law, &laws_));
      PROBE_TRY(next(r.gears, &gears_));
      PROBE_TRY(next(r.more_fingers, &fingers_));
    }
    PROBE_TRY(all_owned(t.laws, laws_));
    PROBE_TRY(all_owned(t.gears, gears_));
    return all_owned(t.fingers, fingers_);
  }

 private:
  Status drives(const RobotRecord& r) const {
    std::vector<std::string_view> joints;
    for (const DriveRecord& d : slice_of(t.drives, r.drives)) joints.push_back(t.text(d.joint));
    std::ranges::sort(joints);
    if (std::ranges::adjacent_find(joints) != joints.end())
      return fail(Rule::kDriveTwice, &r.drives, "a joint has one drive, not two");
    return {};
  }

  Status law(const RobotRecord& r) const {
    const auto control = static_cast<Control>(r.control);
    const std::uint32_t wanted = control == Control::kEeDeltaPose ? 0 : 1;
    if (r.law.count != wanted) {
      return fail(
          Rule::kLawPresent, &r.law,
          fmt::format("control {} has {} records in LAWS, not {}", r.control, wanted, r.law.count));
    }
    if (wanted == 0) return {};
    const LawRecord& l = t.laws[r.law.first];
    const bool osc = control == Control::kOscPose, steps = control == Control::kJointDelta;
    const bool paths = control == Control::kEeDeltaInterpolated;
    // `osc_pose` alone has a home, one for each joint of the arm; who moves fingers is not known
    // here.
    if (osc ? l.home.count == 0 || l.home.count > r.drives.count
            : l.home.count != 0 || l.home.first != 0) {
      return fail(Rule::kLawHome, &l.home,
                  fmt::format("control {} of {} drives has {} home positions", r.control,
                              r.drives.count, l.home.count));
    }
    if (osc) PROBE_TRY(osc_numbers(l));
    if (paths) PROBE_TRY(path_numbers(r, l));
    LawRecord unread = l;  // what is left of it when all that is read is gone
    unread.home = {};
    unread.flags &= ~(osc ? kLawUncoupled : steps ? kLawFromTarget : 0U);
    if (steps) unread.most = 0;
    if (paths) unread.arm_path = unread.finger_path = {};
    if (osc) {
      unread.kp = unread.damping = unread.output = {};
      unread.null_kp = unread.ramp = 0;
      unread.grip_pace = unread.grip_stiffness = unread.grip_limit = 0;
    }
    const bool clean =
        unread.flags == 0 && unread.most == 0 && unread.null_kp == 0 && unread.ramp == 0 &&
        unread.grip_pace == 0 && unread.grip_stiffness == 0 && unread.grip_limit == 0 &&
        unread.kp == std::array<double, 6>{} && unread.damping == std::array<double, 6>{} &&
        unread.output == std::array<double, 6>{} && unread.arm_path == std::array<double, 3>{} &&
        unread.finger_path == std::array<double, 3>{};
    if (clean) return {};
    return fail(Rule::kLawNumbers, &l,
                fmt::format("control {} has a number that it does not read", r.control));
  }

  Status osc_numbers(const LawRecord& l) const {
    for (const double& output : l.output) {
      PROBE_TRY(check_positive(output, "what an action of 1 asks for"));
      PROBE_TRY(check_magnitude(output, Magnitude::kOutput));
    }
    const bool shares = l.ramp <= 1 && l.grip_pace > 0 && l.grip_pace <= 2;
    if (shares && l.grip_limit > 0 && l.grip_limit <= info(Magnitude::kForce).most) return {};
    return fail(Rule::kLawNumbers, &l.ramp,
                "osc_pose ramps over a share of a step, and its gripper has a pace and a force");
  }

  Status path_numbers(const RobotRecord& r, const LawRecord& l) const {
    for (const std::array<double, 3>* path : {&l.arm_path, &l.finger_path}) {
      for (const double& value : *path) {
        if (value > 0) continue;
        return fail(Rule::kLawNumbers, &value,
                    "paths of ee_delta_interpolated have a speed, an acceleration and a jerk");
      }
    }
    // What a drive is to reach at a speed lies damping / stiffness of it ahead.
    for (const DriveRecord& d : slice_of(t.drives, r.drives)) {
      if (d.stiffness > 0) continue;
      return fail(Rule::kLawNumbers, &d.stiffness,
                  "a drive under ee_delta_interpolated has a stiffness above 0");
    }
    return {};
  }

  Status fingers(const RobotRecord& r) const {
    const std::size_t own = finger_count(r) - r.more_fingers.count;
    const bool in_order = r.fingers[0].link.length != 0 || own == 0;
    if (in_order && finger_count(r) <= kMaxFingers &&
        (own == r.fingers.size() || r.more_fingers.count == 0)) {
      return {};
    }
    return fail(Rule::kFingerOrder, &r.fingers,
                fmt::format("a robot's {} fingers, at most {}, fill its record first",
                            finger_count(r), kMaxFingers));
  }

  Status next(const Slice& slice, std::size_t* before) const {
    if (slice.count == 0 ? slice.first != 0 : slice.first != *before) {
      return fail(Rule::kRobotOwned, &slice,
                  fmt::format("a robot's records must begin at {}, not {}",
                              slice.count == 0 ? 0 : *before, slice.first));
    }
    *before += slice.count;
    return {};
  }

  template <typename Record>
  Status all_owned(std::span<const Record> records, std::size_t owned) const {
    if (owned == records.size()) return {};
    return fail(Rule::kRobotOwned, &records[owned], "it belongs to no robot");
  }

  std::size_t laws_ = 0, gears_ = 0, fingers_ = 0;
};

}  // namespace

Status verify_robots(std::span<const std::byte> bytes, const Tables& tables) {
  return RobotCheck(bytes, tables).run();
}

}  // namespace probe::plan
