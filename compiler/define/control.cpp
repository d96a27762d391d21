#include "compiler/define/control.h"

#include <fmt/format.h>

#include "compiler/define/robot.h"
#include "compiler/names/quantities.h"

namespace probe::sema {
namespace {

std::string law_word(const Robot& robot) { return std::string(robot::row_of(robot.law).word); }

Diagnostic& unread(Context& context, const Span& span, const Robot& robot, const char* what) {
  return context.report(Situation::kLawUnread, span,
                        fmt::format("`{}` does not read {}", law_word(robot), what));
}

// One number for all six directions, (shift, turn), or all six.
void read_six(Context& context, const syntax::Point& written, const Takes& takes, bool may_be_zero,
              std::array<double, 6>* out) {
  const std::size_t count = written.coordinates.size();
  if (count != 1 && count != 2 && count != 6) {
    context
        .report(Code::P0302, written.span,
                "expected 1, 2 or 6 numbers, found " + std::to_string(count))
        .point("for all, for shift and turn, or for each of x y z and about x y z");
    return;
  }
  for (std::size_t i = 0; i < 6; ++i) {
    const syntax::Quantity& number = written.coordinates[count == 6   ? i
                                                         : count == 2 ? i / 3
                                                                      : std::size_t{0}];
    const bool again = i > 0 && count != 6 && (count == 1 || i != 3);
    if (again) {
      (*out)[i] = (*out)[i - 1];
      continue;
    }
    const auto value = read_si(context, number, dim::kNumber, takes);
    if (!value) return;
    if (*value == 0 && !may_be_zero) {
      context
          .report(Situation::kNotPositive, number.span,
                  "expected a value above zero, found `" +
                      std::string(context.sources.text(number.span)) + "`")
          .point("without a gain the tool does not follow its goal there");
      return;
    }
    if (*value < 0) {
      context
          .report(
              Situation::kNegative, number.span,
              "expected 0 or more, found `" + std::string(context.sources.text(number.span)) + "`")
          .point("a negative gain drives the tool away from its goal");
      return;
    }
    (*out)[i] = *value;
  }
}

// Lengths, then angles: what an action of 1 asks for.
void read_output(Context& context, const syntax::Point& written, std::array<double, 6>* out) {
  const std::size_t count = written.coordinates.size();
  if (count != 2 && count != 6) {
    context
        .report(Code::P0302, written.span,
                "expected 2 or 6 numbers, found " + std::to_string(count))
        .point("`output (5cm, 0.5rad)`: a shift and a turn, or x y z and about x y z");
    return;
  }
  for (std::size_t i = 0; i < 6; ++i) {
    const bool turns = i >= 3;
    const syntax::Quantity& number = written.coordinates[count == 6 ? i : i / 3];
    if (count == 2 && i % 3 != 0) {
      (*out)[i] = (*out)[i - 1];
      continue;
    }
    const auto value = read_positive(
        context, number, turns ? dim::kAngle : dim::kLength,
        {"an action of 1 asks for so much: nothing would move", plan::Magnitude::kOutput});
    if (!value) return;
    (*out)[i] = *value;
  }
}

struct SettingReader {
  Context& context;
  Robot& robot;

  robot::OscPose* osc() { return std::get_if<robot::OscPose>(&robot.law); }
  robot::JointDelta* steps() { return std::get_if<robot::JointDelta>(&robot.law); }

  void operator()(const syntax::ControlKpStmt& stmt) {
    if (osc() == nullptr) return void(unread(context, stmt.span, robot, "`kp`"));
    read_six(context, stmt.values, {"`kp` takes 1/s2, without a unit", plan::Magnitude::kGain},
             false, &osc()->kp);
  }
  void operator()(const syntax::ControlDampingStmt& stmt) {
    if (osc() == nullptr) return void(unread(context, stmt.span, robot, "`damping`"));
    read_six(context, stmt.values,
             {"`damping` takes a ratio: 1 is critical", plan::Magnitude::kGain}, true,
             &osc()->damping);
  }
  void operator()(const syntax::ControlOutputStmt& stmt) {
    if (osc() == nullptr) return void(unread(context, stmt.span, robot, "`output`"));
    read_output(context, stmt.values, &osc()->output);
  }
  void operator()(const syntax::ControlNullStmt& stmt) {
    if (osc() == nullptr) return void(unread(context, stmt.span, robot, "`null`"));
    if (const auto value = share_or_more(stmt.value, "`null` takes 1/s2, without a unit", {}))
      osc()->null_kp = *value;
  }
  void operator()(const syntax::ControlUncoupleStmt& stmt) {
    if (osc() == nullptr) return void(unread(context, stmt.span, robot, "`uncouple`"));
    osc()->uncouple = true;
  }
  void operator()(const syntax::ControlRampStmt& stmt) {
    if (osc() == nullptr) return void(unread(context, stmt.span, robot, "`ramp`"));
    if (const auto value = share_or_more(stmt.value, "`ramp` takes a share of a control step", 1))
      osc()->ramp = *value;
  }
  void operator()(const syntax::ControlHomeStmt& stmt) {
    if (osc() == nullptr) unread(context, stmt.span, robot, "`home`");
  }
  void operator()(const syntax::ControlFromStmt& stmt) {
    if (steps() == nullptr) return void(unread(context, stmt.span, robot, "`from`"));
    if (stmt.what.text != "target" && stmt.what.text != "measured")
      report_unknown(context.diagnostics, "place to step from", stmt.what, {"target", "measured"});
    steps()->from_target = stmt.what.text != "measured";
  }
  void operator()(const syntax::ControlMostStmt& stmt) {
    if (steps() == nullptr) return void(unread(context, stmt.span, robot, "`most`"));
    const auto most = make_quantity(stmt.value.digits, to_text(stmt.value.unit));
    const bool slides = most && most->dimension == dim::kLength;
    steps()->most =
        read_positive(context, stmt.value, slides ? dim::kLength : dim::kAngle,
                      {"`most` takes a step of a joint", plan::Magnitude::kJointPosition})
            .value_or(0);
  }

  void operator()(const syntax::ControlPathStmt& stmt) {
    auto* paths = std::get_if<robot::EeDeltaInterpolated>(&robot.law);
    const char* word = stmt.of_arm ? "`arm_path`" : "`grip_path`";
    if (paths == nullptr) return void(unread(context, stmt.span, robot, word));
    const auto& written = stmt.limits.coordinates;
    if (written.size() != 3) {
      context
          .report(Code::P0302, stmt.limits.span,
                  "expected 3 numbers, found " + std::to_string(written.size()))
          .point("the most speed, acceleration and jerk of a joint: rad or m, a s, s2 and s3");
      return;
    }
    robot::PathLimits& limits = stmt.of_arm ? paths->arm : paths->fingers;
    double* const to[] = {&limits.speed, &limits.acceleration, &limits.jerk};
    for (std::size_t i = 0; i < 3; ++i) {
      const auto value = read_positive(
          context, written[i], dim::kNumber,
          {"a path takes numbers in rad or m and s, without a unit", plan::Magnitude::kGain});
      if (value) *to[i] = *value;
    }
  }

  std::optional<double> share_or_more(const syntax::Quantity& written, const char* takes,
                                      std::optional<double> most) {
    const auto value = read_si(context, written, dim::kNumber, {takes, plan::Magnitude::kGain});
    if (!value || (*value >= 0 && (!most || *value <= *most))) return value;
    context
        .report(Situation::kNegative, written.span,
                fmt::format("expected {}, found `{}`",
                            most ? fmt::format("0 to {:g}", *most) : std::string("0 or more"),
                            context.sources.text(written.span)))
        .point(takes);
    return std::nullopt;
  }
};

// What a law of targets cannot do without, and one of efforts finds in the description.
struct DriveReader {
  Context& context;
  Robot& robot;
  const WrittenDrive& written;
  const robot::Joint* joint;  // null where there is none
  bool is_law_known;
  bool is_again;  // of a line whose first joint was read: what is wrong of all is said once

  void missing(std::string_view what, std::string_view example) {
    if (!is_law_known || is_again) return;
    context
        .report(Situation::kDriveLacks, written.span,
                fmt::format("joint `{}` has no `{}`, which `{}` drives it by", written.joint.text,
                            what, law_word(robot)))
        .help(fmt::format("write `drive {} ... {} {}`", written.joint.text, what, example));
  }

  Drive for_targets() {
    Drive drive{written.joint, written.slides().value_or(false), 0, 0, 0, 0, 0, written.span};
    const bool n = drive.slides;
    if (!written.stiffness) missing("stiffness", n ? "1000N/m" : "1000Nm/rad");
    if (!written.damping) missing("damping", n ? "200Ns/m" : "200Nms/rad");
    if (!written.limit) missing("limit", n ? "60N" : "60Nm");
    drive.stiffness = written.stiffness ? written.stiffness->si() : 0;
    drive.damping = written.damping ? written.damping->si() : 0;
    drive.limit = written.limit ? written.limit->si() : 0;
    return drive;
  }

  Drive for_efforts() {
    Drive drive{written.joint, false, 0, 0, 0, 0, 0, written.span};
    drive.slides = joint != nullptr ? joint->kind == robot::JointKind::kPrismatic
                                    : written.slides().value_or(false);
    if (written.stiffness && !is_again) {
      unread(context, written.span, robot, "the stiffness of a drive")
          .point("it gives efforts: a spring would pull against them")
          .help("leave it out, damping, friction and armature are the joint's own");
    }
    const auto or_described = [](const std::optional<Quantity>& value, double described) {
      return value ? value->si() : described;
    };
    drive.damping = or_described(written.damping, joint != nullptr ? joint->damping : 0);
    drive.limit = or_described(written.limit, joint != nullptr ? joint->effort : 1);
    drive.friction = joint != nullptr ? joint->friction : 0;
    if (drive.limit > 0 || written.limit) return drive;  // else it was said already
    context
        .report(Situation::kDriveLacks, written.span,
                fmt::format("joint `{}` has no limit that `{}` clips its effort to",
                            written.joint.text, law_word(robot)))
        .label(robot.urdf.span, "this description gives it no `effort`")
        .help(fmt::format("write `drive {} limit {}`", written.joint.text,
                          drive.slides ? "20N" : "80Nm"));
    return drive;
  }

  Drive read() {
    Drive drive = by_efforts(robot) ? for_efforts() : for_targets();
    if (written.friction) drive.friction = written.friction->si();
    if (written.armature) drive.armature = written.armature->si();
    return drive;
  }
};

}  // namespace

std::optional<bool> WrittenDrive::slides() const {
  if (stiffness) return stiffness->dimension == dim::kLinearStiffness;
  if (damping) return damping->dimension == dim::kLinearDamping;
  if (limit) return limit->dimension == dim::kForce;
  if (friction) return friction->dimension == dim::kForce;
  if (armature) return armature->dimension == dim::kMass;
  return std::nullopt;
}

bool by_efforts(const Robot& robot) {
  return robot::row_of(robot.law).reads == robot::Reads::kDynamics;
}

void choose_law(const syntax::ControlStmt& stmt, Robot& robot) {
  const robot::KindRow* kind = robot::find_kind(stmt.law.text);
  if (kind == nullptr) return;
  switch (kind->kind) {
    case robot::ControlKind::kEeDeltaPose:
      robot.law = robot::EeDeltaPose{};
      break;
    case robot::ControlKind::kOscPose:
      robot.law = robot::OscPose{};
      std::get<robot::OscPose>(robot.law).uncouple = false;  // unless it is said
      break;
    case robot::ControlKind::kJointDelta:
      robot.law = robot::JointDelta{};
      break;
    case robot::ControlKind::kJointPosition:
      robot.law = robot::JointPosition{};
      break;
    case robot::ControlKind::kEeDeltaInterpolated:
      robot.law = robot::EeDeltaInterpolated{};
      break;
  }
}

void read_control(Context& context, const syntax::ControlStmt& stmt, Robot& robot) {
  if (robot::find_kind(stmt.law.text) == nullptr) {
    std::vector<std::string_view> known;
    for (const robot::KindRow& row : robot::control_kinds()) known.push_back(row.word);
    report_unknown(context.diagnostics, "control law", stmt.law, known);
    return;
  }
  SettingReader reader{context, robot};
  for (const syntax::ControlSetting& setting : stmt.body) std::visit(reader, setting);
}

void read_sign_grip(Context& context, const syntax::GripStmt& stmt, Robot& robot) {
  auto* osc = std::get_if<robot::OscPose>(&robot.law);
  if (osc == nullptr) {
    for (const auto* of : {&stmt.pace, &stmt.stiffness, &stmt.limit}) {
      if (!*of) continue;
      unread(context, (*of)->span, robot, "`pace`, `stiffness` and `limit` of a gripper")
          .help("its fingers have drives with targets: `drive FINGER stiffness ... limit ...`");
    }
    return;
  }
  const auto read = [&](const std::optional<syntax::Quantity>& written, const Dimension& of,
                        const Takes& takes, double* to) {
    if (!written) return;
    if (const auto value = read_positive(context, *written, of, takes)) *to = *value;
  };
  read(stmt.pace, dim::kNumber, "`pace` takes a share of half the way, a physics step",
       &osc->grip.pace);
  if (osc->grip.pace > 2) {
    context.report(Situation::kMagnitude, stmt.pace->span,
                   "expected a pace up to 2: the whole way in one physics step");
  }
  read(stmt.stiffness, dim::kLinearStiffness,
       {"`stiffness` of a gripper is in N/m", plan::Magnitude::kGain}, &osc->grip.stiffness);
  read(stmt.limit, dim::kForce, {"`limit` of a gripper is in N", plan::Magnitude::kForce},
       &osc->grip.limit);
}

void define_drives(Context& context, std::span<const WrittenDrive> written, bool is_law_known,
                   Robot& robot) {
  for (std::size_t i = 0; i < written.size(); ++i) {
    const WrittenDrive& drive = written[i];
    const bool is_again = i > 0 && written[i - 1].span.begin == drive.span.begin;
    const int index = robot.model ? robot.model->find_joint(drive.joint.text) : -1;
    const robot::Joint* joint =
        index < 0 ? nullptr : &robot.model->joints[static_cast<std::size_t>(index)];
    robot.drives.push_back(
        DriveReader{context, robot, drive, joint, is_law_known, is_again}.read());
  }
}

void define_home(Context& context, const syntax::ControlStmt& stmt, Robot& robot) {
  auto* osc = std::get_if<robot::OscPose>(&robot.law);
  if (osc == nullptr) return;
  const syntax::ControlHomeStmt* home = nullptr;
  for (const syntax::ControlSetting& setting : stmt.body) {
    if (const auto* found = std::get_if<syntax::ControlHomeStmt>(&setting)) home = found;
  }
  std::vector<const Drive*> arm;
  std::string names;
  for (const Drive& drive : robot.drives) {
    if (moves_finger(robot, drive.joint.text)) continue;
    arm.push_back(&drive);
    names += (names.empty() ? "`" : ", `") + drive.joint.text + "`";
  }
  if (home == nullptr) {
    context
        .report(Situation::kHomeMissing, stmt.span,
                "`osc_pose` has no `home`, where it draws the joints that the tool leaves free")
        .help(fmt::format("write `home (..)` with a position for each of {}", names));
    return;
  }
  const auto& positions = home->positions.coordinates;
  if (positions.size() != arm.size()) {
    std::string missing;
    for (std::size_t i = positions.size(); i < arm.size(); ++i)
      missing += (missing.empty() ? "`" : ", `") + arm[i]->joint.text + "`";
    Diagnostic& said =
        context.report(Situation::kHomeMissing, home->positions.span,
                       fmt::format("expected {} positions, one for each joint of the arm, found {}",
                                   arm.size(), positions.size()));
    if (!missing.empty()) said.point("none for " + missing);
    if (robot.fingers.empty()) {
      said.help("without fingers all joints that move are the arm's: " + names +
                "; fix those of the hand in a `urdf` of its own to leave them out");
    } else {
      said.help("the arm's joints are " + names + "; those of fingers have no home");
    }
    return;
  }
  for (std::size_t i = 0; i < arm.size(); ++i) {
    const auto q = read_si(context, positions[i], arm[i]->slides ? dim::kLength : dim::kAngle,
                           {"`home` takes positions of joints", plan::Magnitude::kJointPosition});
    if (!q) return;
    osc->home.push_back(*q);
    const int index = robot.model ? robot.model->find_joint(arm[i]->joint.text) : -1;
    if (index < 0) continue;
    const robot::Joint& joint = robot.model->joints[static_cast<std::size_t>(index)];
    if (joint.kind == robot::JointKind::kContinuous) continue;
    if (*q >= joint.lower && *q <= joint.upper) continue;
    context.report(Situation::kJointLimit, positions[i].span,
                   fmt::format("joint `{}` has its home at {:.6g}, beyond its limits of {:.6g} and "
                               "{:.6g}",
                               joint.name, *q, joint.lower, joint.upper));
  }
}

}  // namespace probe::sema
