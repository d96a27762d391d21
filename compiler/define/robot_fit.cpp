#include "compiler/define/robot_fit.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "compiler/define/robot.h"
#include "runtime/robot/controller.h"
#include "runtime/robot/kinematics.h"

namespace probe::sema {
namespace {

using Names = std::vector<std::string>;

bool has(const Names& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

std::string listed(const Names& names) {
  std::string out;
  for (const std::string& name : names) out += (out.empty() ? "" : ", ") + name;
  return out;
}

class Fit {
 public:
  Fit(Context& context, const Robot& robot)
      : context_(context), robot_(robot), model_(*robot.model) {
    for (const Drive& drive : robot.drives) driven_.push_back(drive.joint.text);
    for (const Finger& finger : robot.fingers) {
      if (std::string joint = drive_of(finger); !joint.empty() && !has(fingers_, joint))
        fingers_.push_back(std::move(joint));
    }
    for (const std::string& joint : driven_) {
      if (!has(fingers_, joint)) arm_.push_back(joint);
    }
  }

  void check() {
    if (!all_driven() || !all_used() || !fingers_move() || !in_order() || !points_apart()) return;
    // What is left is told in the words of whoever would fail.
    const robot::EeControlSpec spec{robot_.tcp.text, arm_, fingers_, robot_.grip_closed,
                                    robot_.grip_open};
    robot::Law law = robot_.law;
    if (auto* paths = std::get_if<robot::EeDeltaInterpolated>(&law))
      paths->period = 1 / robot_.control_hz;
    if (auto* osc = std::get_if<robot::OscPose>(&law)) {
      for (const std::string& joint : arm_) osc->limits.push_back(drive(joint).limit);
    }
    const auto made = robot::Controller::create(model_, spec, law);
    if (made.ok()) return;
    context_.report(Situation::kNoController, robot_.span, made.failure().message)
        .label(robot_.urdf.span, "by this description");
  }

 private:
  const Drive& drive(const std::string& joint) const {
    return *std::find_if(robot_.drives.begin(), robot_.drives.end(),
                         [&](const Drive& known) { return known.joint.text == joint; });
  }

  // The driven joint that moves a finger: its own, or the one that it mimics.
  std::string drive_of(const Finger& finger) const {
    const int link = model_.find_link(finger.link.text);
    const int above = link < 0 ? -1 : model_.links[static_cast<std::size_t>(link)].parent_joint;
    if (above < 0) return {};
    const robot::Joint& own = model_.joints[static_cast<std::size_t>(above)];
    if (has(driven_, own.name) || own.mimic < 0) return own.name;
    return model_.joints[static_cast<std::size_t>(own.mimic)].name;
  }

  bool all_driven() {
    for (const robot::Joint& joint : model_.joints) {
      if (joint.kind == robot::JointKind::kFixed || has(driven_, joint.name)) continue;
      if (joint.mimic >= 0 &&
          has(driven_, model_.joints[static_cast<std::size_t>(joint.mimic)].name))
        continue;
      Diagnostic& said =
          context_.report(Situation::kUndriven, robot_.span,
                          fmt::format("joint `{}` of `{}` moves, but no `drive` says how",
                                      joint.name, robot_.name));
      said.label(robot_.urdf.span, "described here")
          .help(fmt::format("write `drive {} ...`, or make it `fixed` in the description",
                            joint.name));
      for (const Spelled& drive : robot_.dropped_drives)
        said.label(drive.span, fmt::format("`{}` is no joint that moves there", drive.text));
      return false;
    }
    return true;
  }

  // Joints between the description's root and the tool; of those that mimic, the one they follow.
  Names on_the_way() const {
    Names names;
    for (int link = model_.find_link(robot_.tcp.text); link >= 0;) {
      const int above = model_.links[static_cast<std::size_t>(link)].parent_joint;
      if (above < 0) break;
      const robot::Joint& joint = model_.joints[static_cast<std::size_t>(above)];
      const bool follows = joint.mimic >= 0 && !has(driven_, joint.name);
      names.push_back(follows ? model_.joints[static_cast<std::size_t>(joint.mimic)].name
                              : joint.name);
      link = joint.parent_link;
    }
    return names;
  }

  bool all_used() {
    const Names way = on_the_way();
    for (const std::string& joint : driven_) {
      const bool moves_tool = has(way, joint), moves_finger = has(fingers_, joint);
      if (moves_tool != moves_finger) continue;
      Diagnostic& said = context_.report(
          Situation::kDriveAside, drive(joint).joint.span,
          moves_tool
              ? fmt::format("joint `{}` moves a finger and the tool `{}`", joint, robot_.tcp.text)
              : fmt::format("joint `{}` moves neither the tool `{}` nor a finger", joint,
                            robot_.tcp.text));
      said.label(robot_.tcp.span, "the tool");
      if (moves_tool) {
        said.help("name a link of the hand that no finger carries");
      } else {
        said.help(
            "actions say where the tool goes and how wide the gripper is: make the joint "
            "`fixed` in the description, or name its link in `fingers`");
      }
      return false;
    }
    return true;
  }

  // A jaw that is fixed to the hand is no finger: nothing opens it.
  bool fingers_move() {
    for (const Finger& finger : robot_.fingers) {
      const std::string joint = drive_of(finger);
      if (has(driven_, joint)) continue;
      Names moved;
      for (const Finger& other : robot_.fingers) {
        if (has(driven_, drive_of(other))) moved.push_back(other.link.text);
      }
      Diagnostic& said = context_.report(
          Situation::kStillFinger, finger.link.span,
          joint.empty() ? fmt::format("no joint moves finger `{}`", finger.link.text)
                        : fmt::format("no drive moves finger `{}`: joint `{}` is fixed",
                                      finger.link.text, joint));
      said.label(robot_.urdf.span, "described here");
      said.help(moved.empty()
                    ? "name in `fingers` the links that drives open"
                    : fmt::format("name in `fingers` only those that move: `{}`", listed(moved)));
      return false;
    }
    return true;
  }

  bool in_order() {
    Names wanted = arm_;
    wanted.insert(wanted.end(), fingers_.begin(), fingers_.end());
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      if (wanted[i] == driven_[i]) continue;
      context_
          .report(Situation::kDriveOrder, drive(driven_[i]).joint.span,
                  fmt::format("expected the drive of `{}` here, found `{}`", wanted[i], driven_[i]))
          .point(
              "drives stand in the order of actions: the arm's, then the fingers' as `fingers` "
              "has them")
          .help("write the drives of " + listed(wanted) + " in this order");
      return false;
    }
    return true;
  }

  // Fingers that close along the way the hand is said to point close on nothing.
  bool points_apart() {
    if (robot_.points_span.is_none()) return true;
    const auto tree = robot::Tree::create(model_, driven_);
    if (!tree.ok() || robot_.fingers.size() != 2) return true;
    // Fingers that turn: half closed.
    std::vector<double> q(driven_.size(), 0.0);
    for (std::size_t i = 0; i < driven_.size(); ++i) {
      if (has(fingers_, driven_[i])) q[i] = 0.5 * (robot_.grip_closed + robot_.grip_open);
    }
    std::vector<Pose> poses(tree->link_count());
    tree->link_poses(q, poses);
    const auto at = [&](const std::string& link) -> const Pose& {
      return poses[static_cast<std::size_t>(model_.find_link(link))];
    };
    const Vec3 points =
        at(robot_.tcp.text).rotation * Vec3(robot_.points[0], robot_.points[1], robot_.points[2]);
    for (const Finger& finger : robot_.fingers) {
      const Vec3 opens =
          at(finger.link.text).rotation * Vec3(finger.opens[0], finger.opens[1], finger.opens[2]);
      constexpr double kAlong = 0.7;  // of the cosine
      if (std::abs(opens.dot(points)) < kAlong) continue;
      context_
          .report(Situation::kPointsAlong, robot_.points_span,
                  fmt::format("`{}` is to point the way finger `{}` opens", robot_.tcp.text,
                              finger.link.text))
          .label(finger.link.span, "opens that way")
          .help(
              "`tcp LINK points +z` says along which axis of the link the hand points at what it "
              "grasps; unsaid it is +x");
      return false;
    }
    return true;
  }

  Context& context_;
  const Robot& robot_;
  const robot::RobotModel& model_;
  Names driven_, fingers_, arm_;
};

}  // namespace

void check_fit(Context& context, const Robot& robot) {
  if (!robot.model || robot.drives.empty()) return;
  Fit(context, robot).check();
}

}  // namespace probe::sema
