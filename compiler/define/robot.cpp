// `robot`: links and joints named here are looked up in the URDF, and every drive's units must fit
// the kind of its joint.
#include "compiler/define/robot.h"

#include <map>
#include <set>
#include <span>

#include "compiler/define/control.h"
#include "compiler/define/define.h"
#include "compiler/define/described.h"
#include "compiler/define/record.h"
#include "compiler/define/robot_copy.h"
#include "compiler/define/robot_fit.h"
#include "compiler/names/quantities.h"
#include "runtime/plan/limits.h"

namespace probe::sema {
namespace {

struct RobotReader {
  Context& context;
  Robot& robot;
  bool has_control = false, has_grip = false, has_drive = false, has_fingers = false;
  Span grip_span = {};
  std::vector<WrittenDrive> drives = {};
  std::map<const syntax::DriveStmt*, std::optional<WrittenDrive>> read_drives = {};

  void check_not_negative(const syntax::Quantity& written, const Quantity& value) {
    if (value.si() >= 0) return;
    context.report(
        Situation::kNegative, written.span,
        "expected 0 or more, found `" + std::string(context.sources.text(written.span)) + "`");
  }

  void check_above_zero(const syntax::Quantity& written, double value, const char* why) {
    if (value > 0) return;
    context
        .report(Situation::kNotPositive, written.span,
                "expected a value above zero, found `" +
                    std::string(context.sources.text(written.span)) + "`")
        .point(why);
  }

  void operator()(const syntax::UrdfStmt& stmt) { robot.urdf = spelled(stmt.path); }
  // Unit; zero where the axis has another name, which is told.
  std::array<double, 3> axis_of(const syntax::SignedAxis& written) {
    std::array<double, 3> out{};
    const std::string_view axis = written.axis.text;
    if (axis != "x" && axis != "y" && axis != "z") {
      report_unknown(context.diagnostics, "axis", written.axis, {"x", "y", "z"});
    } else {
      out[static_cast<std::size_t>(axis[0] - 'x')] = written.negative ? -1 : 1;
    }
    return out;
  }

  void operator()(const syntax::TcpStmt& stmt) {
    robot.tcp = spelled(stmt.link);
    if (!stmt.points) return;
    robot.points = axis_of(*stmt.points);
    robot.points_span = stmt.points->axis.span;
  }
  void operator()(const syntax::FingersStmt& stmt) {
    has_fingers = true;
    robot.fingers.clear();
    for (const syntax::Finger& finger : stmt.fingers) {
      robot.fingers.push_back({spelled(finger.link), axis_of(finger.opens)});
    }
    for (std::size_t i = 1; i < robot.fingers.size(); ++i) {
      for (std::size_t k = 0; k < i; ++k) {
        if (robot.fingers[i].link.text != robot.fingers[k].link.text) continue;
        context.report(
            Situation::kFingerCount, stmt.fingers[i].link.span,
            "expected different fingers, found `" + robot.fingers[i].link.text + "` twice");
      }
    }
    if (robot.fingers.size() > plan::kMaxFingers) {
      context.report(Situation::kFingerCount, stmt.span,
                     "expected at most " + std::to_string(plan::kMaxFingers) + " fingers, found " +
                         std::to_string(robot.fingers.size()));
    }
  }
  void operator()(const syntax::ControlStmt& stmt) {
    has_control = true;
    read_control(context, stmt, robot);
    robot.control_hz = read_positive(context, stmt.rate, dim::kRate,
                                     {"`control` takes a frequency", plan::Magnitude::kControlRate})
                           .value_or(1);
  }
  void operator()(const syntax::ReachStmt& stmt) {
    robot.reach_min = read_si(context, stmt.least, dim::kLength,
                              {"`reach` takes lengths", plan::Magnitude::kLength})
                          .value_or(0);
    robot.reach_max = read_positive(context, stmt.most, dim::kLength,
                                    {"`reach` takes lengths", plan::Magnitude::kLength})
                          .value_or(1);
    if (robot.reach_min >= 0 && robot.reach_min < robot.reach_max) return;
    context.report(Situation::kReachOrder, stmt.span,
                   "expected the nearest reach below the farthest, both from 0, found `" +
                       std::string(context.sources.text(stmt.span)) + "`");
  }
  // What `stmt` says of each of its joints; nothing where a number of it could not be read.
  std::optional<WrittenDrive> read_drive(const syntax::DriveStmt& stmt) {
    // Whether the joint turns or slides is known only with the URDF; the first quantity decides
    // what the others must be.
    const auto is_of = [&](const std::optional<syntax::Quantity>& written, const Dimension& of) {
      if (!written) return false;
      const auto value = make_quantity(written->digits, to_text(written->unit));
      return value && value->dimension == of;
    };
    const bool slides = stmt.stiffness  ? is_of(stmt.stiffness, dim::kLinearStiffness)
                        : stmt.damping  ? is_of(stmt.damping, dim::kLinearDamping)
                        : stmt.limit    ? is_of(stmt.limit, dim::kForce)
                        : stmt.friction ? is_of(stmt.friction, dim::kForce)
                                        : is_of(stmt.armature, dim::kMass);
    WrittenDrive drive;
    drive.span = stmt.span;
    bool all_read = true;
    const auto read = [&](const std::optional<syntax::Quantity>& written, const Dimension& of,
                          const Takes& takes, std::optional<Quantity>* to) {
      if (!written) return;
      *to = read_quantity(context, *written, of, takes);
      all_read = all_read && to->has_value();
    };
    read(stmt.stiffness, slides ? dim::kLinearStiffness : dim::kAngularStiffness,
         {"a stiffness is in Nm/rad, or in N/m for a sliding joint", plan::Magnitude::kGain},
         &drive.stiffness);
    read(stmt.damping, slides ? dim::kLinearDamping : dim::kAngularDamping,
         {slides ? "a sliding joint is damped in Ns/m" : "a turning joint is damped in Nms/rad",
          plan::Magnitude::kGain},
         &drive.damping);
    read(stmt.limit, slides ? dim::kForce : dim::kTorque,
         {slides ? "a sliding joint is limited in N" : "a turning joint is limited in Nm",
          plan::Magnitude::kForce},
         &drive.limit);
    read(stmt.friction, slides ? dim::kForce : dim::kTorque,
         slides ? "friction of a sliding joint is in N" : "friction of a turning joint is in Nm",
         &drive.friction);
    read(
        stmt.armature, slides ? dim::kMass : dim::kInertia,
        {slides ? "armature of a sliding joint is in kg" : "armature of a turning joint is in kgm2",
         plan::Magnitude::kArmature},
        &drive.armature);
    if (!all_read) return std::nullopt;
    if (drive.stiffness)
      check_above_zero(*stmt.stiffness, drive.stiffness->si(),
                       "a drive without stiffness holds nothing");
    if (drive.damping && !by_efforts(robot))
      check_above_zero(*stmt.damping, drive.damping->si(),
                       "a drive without damping swings for ever");
    if (drive.limit)
      check_above_zero(*stmt.limit, drive.limit->si(), "a drive without force moves nothing");
    if (drive.damping && by_efforts(robot)) check_not_negative(*stmt.damping, *drive.damping);
    if (drive.friction) check_not_negative(*stmt.friction, *drive.friction);
    if (drive.armature) check_not_negative(*stmt.armature, *drive.armature);
    return drive;
  }
  // Each statement is read once, whichever of its joints are left to it.
  void drive(const DrivenJoint& driven) {
    has_drive = true;
    const auto [read, is_new] = read_drives.try_emplace(driven.stmt);
    if (is_new) read->second = read_drive(*driven.stmt);
    if (!read->second) return;
    const syntax::Name& joint = *driven.joint;
    for (const WrittenDrive& known : drives) {
      if (known.joint.text != joint.text) continue;
      context.report(Code::P0203, joint.span, "joint `" + known.joint.text + "` is driven twice")
          .label(known.joint.span, "first driven here");
    }
    drives.push_back(*read->second);
    drives.back().joint = spelled(joint);
    if (drives.size() == plan::kMaxDrives + 1) {
      context.report(Situation::kTooManyDrives, joint.span,
                     "expected at most " + std::to_string(plan::kMaxDrives) + " drives of a robot");
    }
  }
  void operator()(const syntax::DriveStmt&) {}  // `drive` reads them, joint by joint
  void operator()(const syntax::GripStmt& stmt) {
    has_grip = true;
    grip_span = stmt.span;
    read_sign_grip(context, stmt, robot);
    const auto closed = make_quantity(stmt.closed.digits, to_text(stmt.closed.unit));
    robot.grip_turns = closed && closed->dimension == dim::kAngle;
    const Dimension& of = robot.grip_turns ? dim::kAngle : dim::kLength;
    const Takes takes{robot.grip_turns ? "`grip` takes two angles or two lengths"
                                       : "`grip` takes lengths, or angles of fingers that turn",
                      plan::Magnitude::kJointPosition};
    robot.grip_closed = read_si(context, stmt.closed, of, takes).value_or(0);
    robot.grip_open = read_si(context, stmt.open, of, takes).value_or(1);
    // Fingers that slide open as their joints go up; those that turn may do either.
    const bool in_order = robot.grip_turns ? robot.grip_closed != robot.grip_open
                                           : robot.grip_closed < robot.grip_open;
    if (!in_order) {
      context.report(Situation::kGripOrder, stmt.span,
                     std::string("expected the closed position ") +
                         (robot.grip_turns ? "to differ from" : "below") +
                         " the open one, found `" + std::string(context.sources.text(stmt.span)) +
                         "`");
    }
    if (stmt.friction) {
      robot.finger_friction =
          read_positive(context, *stmt.friction, dim::kNumber,
                        {"`friction` takes a number", plan::Magnitude::kFriction})
              .value_or(1);
    }
    if (!stmt.patch) return;
    robot.finger_patch = read_si(context, *stmt.patch, dim::kLength,
                                 {"`patch` takes a length", plan::Magnitude::kLength})
                             .value_or(0);
    if (robot.finger_patch < 0)
      context.report(Situation::kNegative, stmt.patch->span,
                     "expected a patch radius of 0 or more");
  }
};

void unknown_part(Context& context, std::string_view kind, const Spelled& name, const Robot& robot,
                  std::vector<std::string_view> candidates) {
  report_unknown(context.diagnostics, kind, {name.span, name.text}, candidates)
      .label(robot.urdf.span, "not in this file");
}

}  // namespace

void check_link(Context& context, const Spelled& link, const Robot& robot) {
  if (!robot.model || link.text.empty() || robot.model->find_link(link.text) >= 0) return;
  std::vector<std::string_view> candidates;
  for (const robot::Link& known : robot.model->links) candidates.push_back(known.name);
  unknown_part(context, "link", link, robot, std::move(candidates));
}

namespace {

void check_drive(Context& context, const WrittenDrive& drive, const Robot& robot) {
  const int index = robot.model->find_joint(drive.joint.text);
  if (index < 0) {
    std::vector<std::string_view> candidates;
    for (const robot::Joint& known : robot.model->joints) candidates.push_back(known.name);
    unknown_part(context, "joint", drive.joint, robot, std::move(candidates));
    return;
  }
  const robot::JointKind kind = robot.model->joints[static_cast<std::size_t>(index)].kind;
  if (kind == robot::JointKind::kFixed) {
    context.report(Code::P0302, drive.joint.span,
                   "joint `" + drive.joint.text + "` is fixed, it cannot be driven");
    return;
  }
  const bool slides = kind == robot::JointKind::kPrismatic;
  if (!drive.slides().has_value() || slides == *drive.slides()) return;
  const char* what = drive.stiffness  ? slides ? "stiffness is in N/m" : "stiffness is in Nm/rad"
                     : drive.damping  ? slides ? "damping is in Ns/m" : "damping is in Nms/rad"
                     : drive.limit    ? slides ? "limit is in N" : "limit is in Nm"
                     : drive.friction ? slides ? "friction is in N" : "friction is in Nm"
                     : slides         ? "armature is in kg"
                                      : "armature is in kgm2";
  context
      .report(Code::P0302, drive.span,
              "joint `" + drive.joint.text + "` " + (slides ? "slides" : "turns") + ", its " + what)
      .label(drive.joint.span, "this joint");
}

// A gripper opens as its fingers' joints go up: each must then move the way it is said to open, and
// two that open in one direction hold nothing.
void check_fingers(Context& context, const Robot& robot) {
  std::vector<Vec3> ways;  // in the frame of the link both hang on
  int parent = -1;
  for (const Finger& finger : robot.fingers) {
    const int link = robot.model->find_link(finger.link.text);
    const Vec3 opens(finger.opens[0], finger.opens[1], finger.opens[2]);
    const int above =
        link < 0 ? -1 : robot.model->links[static_cast<std::size_t>(link)].parent_joint;
    if (above < 0 || opens.isZero()) return;
    const robot::Joint& joint = robot.model->joints[static_cast<std::size_t>(above)];
    if (joint.kind == robot::JointKind::kPrismatic && joint.axis.dot(opens) < 0) {
      context
          .report(Situation::kFingerDirection, finger.link.span,
                  "finger `" + finger.link.text + "` is said to open against its joint's motion")
          .point("`" + joint.name + "` moves it the other way as its position grows")
          .label(robot.urdf.span, "the joint is described here");
      return;
    }
    if (robot.fingers.size() != 2) continue;
    if (!ways.empty() && joint.parent_link != parent) return;
    parent = joint.parent_link;
    ways.push_back(joint.origin.rotation * opens);
  }
  if (ways.size() != 2 || ways[0].dot(ways[1]) < 0.9) return;
  context
      .report(Situation::kFingerDirection, robot.fingers[1].link.span,
              "expected fingers that open apart, found both opening in one direction")
      .label(robot.fingers[0].link.span, "opens the same way");
}

void check_mesh_count(Context& context, const Robot& robot) {
  std::set<std::string> files;
  for (const robot::Link& link : robot.model->links) {
    for (const robot::MeshRef& mesh : link.visuals) files.insert("visual " + mesh.path);
    for (const robot::MeshRef& mesh : link.collisions) files.insert("collision " + mesh.path);
  }
  if (files.size() <= plan::kMaxMeshes) return;
  context.report(Situation::kTooManyMeshes, robot.urdf.span,
                 "expected at most " + std::to_string(plan::kMaxMeshes) +
                     " meshes in a robot description, found " + std::to_string(files.size()));
}

// Copied drives of joints that a description of its own lacks or fixes: of another hand, or of one
// that it does not have.
void drop_copied_drives(const Span& own, std::vector<WrittenDrive>& drives, Robot& robot) {
  std::erase_if(drives, [&](const WrittenDrive& drive) {
    if (is_within(drive.joint.span, own)) return false;
    const int joint = robot.model->find_joint(drive.joint.text);
    const bool is_gone = joint < 0 || robot.model->joints[static_cast<std::size_t>(joint)].kind ==
                                          robot::JointKind::kFixed;
    if (is_gone) robot.dropped_drives.push_back(drive.joint);
    return is_gone;
  });
}

// `own`: the robot's text, without that of what it copies.
void load_model(Context& context, const Span& own, std::vector<WrittenDrive>& drives,
                Robot& robot) {
  robot.model = described_by(context, robot.urdf, "the robot description");
  if (!robot.model) return;
  if (robot.like != RobotId::kNone) drop_copied_drives(own, drives, robot);
  check_mesh_count(context, robot);
  check_link(context, robot.tcp, robot);
  for (const Finger& finger : robot.fingers) check_link(context, finger.link, robot);
  for (const WrittenDrive& drive : drives) check_drive(context, drive, robot);
  check_fingers(context, robot);
}

}  // namespace

bool moves_finger(const Robot& robot, std::string_view joint) {
  if (!robot.model) return false;
  for (const Finger& finger : robot.fingers) {
    const int link = robot.model->find_link(finger.link.text);
    if (link < 0) continue;
    const int above = robot.model->links[static_cast<std::size_t>(link)].parent_joint;
    if (above < 0) continue;
    const robot::Joint& own = robot.model->joints[static_cast<std::size_t>(above)];
    if (own.name == joint) return true;
    const bool mimics = own.mimic >= 0;
    if (mimics && robot.model->joints[static_cast<std::size_t>(own.mimic)].name == joint)
      return true;
  }
  return false;
}

namespace {

// The statements as they hold, over those of what is copied.
void read_robot(Context& context, const Declared<syntax::RobotDecl>& declared,
                const RobotText& text, Robot& robot) {
  const auto errors = context.mistakes();
  RobotReader reader{context, robot};
  const syntax::ControlStmt* control = nullptr;
  for (const syntax::RobotStmt* stmt : text.statements) {
    if (const auto* found = std::get_if<syntax::ControlStmt>(stmt)) control = found;
  }
  if (control != nullptr) choose_law(*control, robot);
  for (const syntax::RobotStmt* stmt : text.statements) std::visit(reader, *stmt);
  for (const DrivenJoint& driven : text.drives) reader.drive(driven);
  const auto need = [&](bool is_there, std::string_view statement) {
    if (!declared.decl->complete) return;
    require(context, is_there, "robot", robot.name, robot.span, statement);
  };
  need(!robot.urdf.span.is_none(), "urdf");
  need(!robot.tcp.span.is_none(), "tcp");
  need(reader.has_fingers, "fingers");
  need(reader.has_control, "control");
  const bool bare = reader.has_fingers && robot.fingers.empty();
  if (!bare) need(reader.has_grip, "grip");
  if (bare && reader.has_grip) {
    context
        .report(Situation::kNoFingers, reader.grip_span, "`grip` of a robot that has `fingers none`");
  }
  need(reader.has_drive, "drive");
  if (!robot.urdf.span.is_none()) load_model(context, declared.decl->span, reader.drives, robot);
  // What is wrong so far may be why a joint is not the arm's.
  const bool clean = context.mistakes() == errors;
  // Of a law that is refused nothing is lacking.
  const bool is_law_known = control != nullptr && robot::find_kind(control->law.text) != nullptr;
  define_drives(context, reader.drives, is_law_known, robot);
  if (clean && control != nullptr) define_home(context, *control, robot);
  if (declared.decl->complete && context.mistakes() == errors) check_fit(context, robot);
  robot.broken = !declared.decl->complete || context.mistakes() != errors;
}

// What is underlined in another robot was right there: it does not fit this one.
void name_copies(Context& context, std::size_t first, const Declared<syntax::RobotDecl>& declared) {
  for (std::size_t i = first; i < context.diagnostics.size(); ++i) {
    Diagnostic& said = context.diagnostics[i];
    if (!is_within(said.primary, declared.decl->span))
      said.label(declared.node->name.span,
                 "copied by `" + std::string(declared.node->name.text) + "`");
  }
}

}  // namespace

void define_robots(Context& context) {
  const auto& decls = context.symbols.robot_decls;
  std::vector<std::optional<std::uint32_t>> parents(decls.size());
  for (std::size_t i = 0; i < decls.size(); ++i) {
    context.model.robots.add({});
    if (const auto& like = decls[i].node->like)
      parents[i] = context.symbols.robots.find(*like, context.diagnostics);
  }
  std::vector<RobotText> texts(decls.size());
  for (const std::uint32_t i :
       parents_first(context, parents, context.symbols.robots.names())) {
    const Declared<syntax::RobotDecl>& declared = decls[i];
    Robot robot;
    robot.name = std::string(declared.node->name.text);
    robot.span = declared.node->name.span;
    if (parents[i]) robot.like = static_cast<RobotId>(*parents[i]);
    // Of a copy of what has a mistake only its own text could be told of.
    robot.broken = declared.node->like &&
                   (!parents[i] || context.model.robots[static_cast<RobotId>(*parents[i])].broken);
    if (!robot.broken) {
      texts[i] = over(parents[i] ? texts[*parents[i]] : RobotText{}, *declared.node);
      const std::size_t first = context.diagnostics.size();
      read_robot(context, declared, texts[i], robot);
      if (parents[i]) name_copies(context, first, declared);
    }
    context.model.robots[static_cast<RobotId>(i)] = std::move(robot);
  }
}

}  // namespace probe::sema
