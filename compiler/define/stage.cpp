// Robots, cameras, lights and scenes. Links and joints named here are looked up in the robot's
// URDF, and every drive's units must fit the kind of its joint.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "compiler/define/passes.h"

namespace probe::sema {
namespace {

constexpr std::uint32_t kLargestSide = 8192;  // of a picture as it is traced

template <std::size_t N>
void assign(std::array<double, N>& to, const std::optional<std::vector<Quantity>>& from) {
  if (!from) return;
  for (std::size_t i = 0; i < from->size() && i < N; ++i) to[i] = (*from)[i].si();
}

void missing(Context& context, std::string_view kind, const std::string& name, const Span& span,
             const char* statement) {
  context.report(Code::P0206, span,
                 std::string(kind) + " `" + name + "` has no `" + statement + "`");
}

// ---- robots
// ---------------------------------------------------------------------------------------------------------

struct RobotReader {
  Context& context;
  Robot& robot;
  bool has_control = false, has_grip = false, has_drive = false;

  void check_above_zero(const syntax::Quantity& written, double value, const char* why) {
    if (value > 0) return;
    context
        .report(Code::P0304, written.span,
                "expected a value above zero, found `" +
                    std::string(context.sources.text(written.span)) + "`")
        .point(why);
  }

  void operator()(const syntax::UrdfStmt& stmt) { robot.urdf = spelled(stmt.path); }
  void operator()(const syntax::TcpStmt& stmt) { robot.tcp = spelled(stmt.link); }
  void operator()(const syntax::FingersStmt& stmt) {
    robot.fingers.clear();
    for (const syntax::Finger& finger : stmt.fingers) {
      const std::string_view axis = finger.axis.text;
      Finger record{spelled(finger.link), {}};
      if (axis != "x" && axis != "y" && axis != "z") {
        report_unknown(context.diagnostics, "axis", finger.axis, {"x", "y", "z"});
      } else {
        record.opens[static_cast<std::size_t>(axis[0] - 'x')] = finger.negative ? -1 : 1;
      }
      robot.fingers.push_back(std::move(record));
    }
    if (robot.fingers.size() == 2 && robot.fingers[0].link.text == robot.fingers[1].link.text) {
      context.report(Code::P0304, stmt.fingers[1].link.span,
                     "expected two fingers, found `" + robot.fingers[0].link.text + "` twice");
    }
    if (robot.fingers.size() != 2) {
      context.report(Code::P0304, stmt.span,
                     "expected 2 fingers, found " + std::to_string(robot.fingers.size()));
    }
  }
  void operator()(const syntax::ControlStmt& stmt) {
    has_control = true;
    if (stmt.law.text != "ee_delta_pose") {
      report_unknown(context.diagnostics, "control law", stmt.law, {"ee_delta_pose"});
    }
    robot.control_hz =
        read_positive(context, stmt.rate, dim::kRate, "`control` takes a frequency").value_or(1);
  }
  void operator()(const syntax::ReachStmt& stmt) {
    robot.reach_min =
        read_si(context, stmt.least, dim::kLength, "`reach` takes lengths").value_or(0);
    robot.reach_max =
        read_positive(context, stmt.most, dim::kLength, "`reach` takes lengths").value_or(1);
    if (robot.reach_min >= 0 && robot.reach_min < robot.reach_max) return;
    context.report(Code::P0304, stmt.span,
                   "expected the nearest reach below the farthest, both from 0, found `" +
                       std::string(context.sources.text(stmt.span)) + "`");
  }
  void operator()(const syntax::DriveStmt& stmt) {
    has_drive = true;
    // Whether the joint turns or slides is known only with the URDF; the stiffness decides what the
    // others must be.
    const auto stiffness = make_quantity(stmt.stiffness.digits, to_text(stmt.stiffness.unit));
    const bool slides = stiffness && stiffness->dimension == dim::kLinearStiffness;
    Drive drive;
    drive.span = stmt.span;
    const auto k = read_quantity(context, stmt.stiffness,
                                 slides ? dim::kLinearStiffness : dim::kAngularStiffness,
                                 "a stiffness is in Nm/rad, or in N/m for a sliding joint");
    const auto d = read_quantity(
        context, stmt.damping, slides ? dim::kLinearDamping : dim::kAngularDamping,
        slides ? "a sliding joint is damped in Ns/m" : "a turning joint is damped in Nms/rad");
    const auto f = read_quantity(
        context, stmt.limit, slides ? dim::kForce : dim::kTorque,
        slides ? "a sliding joint is limited in N" : "a turning joint is limited in Nm");
    if (!k || !d || !f) return;
    check_above_zero(stmt.stiffness, k->si(), "a drive without stiffness holds nothing");
    check_above_zero(stmt.damping, d->si(), "a drive without damping swings for ever");
    check_above_zero(stmt.limit, f->si(), "a drive without force moves nothing");
    drive.stiffness = *k;
    drive.damping = *d;
    drive.limit = *f;
    for (const syntax::Name& joint : stmt.joints) {
      for (const Drive& known : robot.drives) {
        if (known.joint.text != joint.text) continue;
        context.report(Code::P0203, joint.span, "joint `" + known.joint.text + "` is driven twice")
            .label(known.joint.span, "first driven here");
      }
      drive.joint = spelled(joint);
      robot.drives.push_back(drive);
    }
  }
  void operator()(const syntax::GripStmt& stmt) {
    has_grip = true;
    robot.grip_closed =
        read_si(context, stmt.closed, dim::kLength, "`grip` takes lengths").value_or(0);
    robot.grip_open = read_si(context, stmt.open, dim::kLength, "`grip` takes lengths").value_or(1);
    if (robot.grip_closed >= robot.grip_open) {
      context.report(Code::P0304, stmt.span,
                     "expected the closed position below the open one, found `" +
                         std::string(context.sources.text(stmt.span)) + "`");
    }
    if (stmt.friction) {
      robot.finger_friction =
          read_positive(context, *stmt.friction, dim::kNumber, "`friction` takes a number")
              .value_or(1);
    }
    if (stmt.patch)
      robot.finger_patch =
          read_si(context, *stmt.patch, dim::kLength, "`patch` takes a length").value_or(0);
  }
};

void unknown_part(Context& context, std::string_view kind, const Spelled& name, const Robot& robot,
                  std::vector<std::string_view> candidates) {
  report_unknown(context.diagnostics, kind, {name.span, name.text}, candidates)
      .label(robot.urdf.span, "not in this file");
}

void check_link(Context& context, const Spelled& link, const Robot& robot) {
  if (!robot.model || link.text.empty() || robot.model->find_link(link.text) >= 0) return;
  std::vector<std::string_view> candidates;
  for (const robot::Link& known : robot.model->links) candidates.push_back(known.name);
  unknown_part(context, "link", link, robot, std::move(candidates));
}

void check_drive(Context& context, const Drive& drive, const Robot& robot) {
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
  if (slides == (drive.stiffness.dimension == dim::kLinearStiffness)) return;
  context
      .report(Code::P0302, drive.span,
              "joint `" + drive.joint.text + "` " + (slides ? "slides" : "turns") +
                  ", its stiffness is in " + (slides ? "N/m" : "Nm/rad"))
      .label(drive.joint.span, "this joint");
}

// A gripper opens as its fingers' joints go up: each must then move the way it is said to open, and
// two that open in one direction hold nothing.
void check_fingers(Context& context, const Robot& robot) {
  if (robot.fingers.size() != 2 || robot.fingers[0].link.text == robot.fingers[1].link.text) return;
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
          .report(Code::P0304, finger.link.span,
                  "finger `" + finger.link.text + "` is said to open against its joint's motion")
          .point("`" + joint.name + "` moves it the other way as its position grows")
          .label(robot.urdf.span, "the joint is described here");
      return;
    }
    if (!ways.empty() && joint.parent_link != parent) return;
    parent = joint.parent_link;
    ways.push_back(joint.origin.rotation * opens);
  }
  if (ways.size() != 2 || ways[0].dot(ways[1]) < 0.9) return;
  context
      .report(Code::P0304, robot.fingers[1].link.span,
              "expected fingers that open apart, found both opening in one direction")
      .label(robot.fingers[0].link.span, "opens the same way");
}

void load_model(Context& context, Robot& robot) {
  const std::string path = (std::filesystem::path(context.asset_root) / robot.urdf.text).string();
  auto model = robot::load_urdf(path);
  if (!model.ok()) {
    context
        .report(Code::P0202, robot.urdf.span,
                "the robot description cannot be read: " + model.failure().message)
        .note("looked for `" + robot.urdf.text + "` in the assets folder");
    return;
  }
  robot.model = std::move(model).value();
  check_link(context, robot.tcp, robot);
  for (const Finger& finger : robot.fingers) check_link(context, finger.link, robot);
  for (const Drive& drive : robot.drives) check_drive(context, drive, robot);
  check_fingers(context, robot);
}

void define_robots(Context& context) {
  for (const auto& declared : context.symbols.robot_decls) {
    const syntax::RobotDecl& node = *declared.node;
    Robot robot;
    robot.name = std::string(node.name.text);
    robot.span = node.name.span;
    const auto errors = context.mistakes();
    RobotReader reader{context, robot};
    for (const syntax::RobotStmt& stmt : node.body) std::visit(reader, stmt);
    if (declared.decl->complete) {
      if (robot.urdf.span.is_none()) missing(context, "robot", robot.name, robot.span, "urdf");
      if (robot.tcp.span.is_none()) missing(context, "robot", robot.name, robot.span, "tcp");
      if (robot.fingers.empty()) missing(context, "robot", robot.name, robot.span, "fingers");
      if (!reader.has_control) missing(context, "robot", robot.name, robot.span, "control");
      if (!reader.has_grip) missing(context, "robot", robot.name, robot.span, "grip");
      if (!reader.has_drive) missing(context, "robot", robot.name, robot.span, "drive");
    }
    if (!robot.urdf.span.is_none()) load_model(context, robot);
    robot.broken = !declared.decl->complete || context.mistakes() != errors;
    context.model.robots.add(std::move(robot));
  }
}

// ---- cameras and lights
// ---------------------------------------------------------------------------------------------

struct CameraReader {
  Context& context;
  Camera& camera;

  void operator()(const syntax::MountStmt& stmt) {
    if (stmt.frame.parts.size() != 2) {
      context.report(Code::P0201, stmt.frame.span, "expected `robot.link` to mount the camera on");
    } else {
      const auto robot = context.symbols.robots.find(stmt.frame.parts[0], context.diagnostics);
      camera.mount_link = spelled(stmt.frame.parts[1]);
      if (robot) {
        camera.mount_robot = static_cast<RobotId>(*robot);
        check_link(context, camera.mount_link, context.model.robots[camera.mount_robot]);
      }
    }
    assign(camera.position,
           read_point(context, stmt.at, 3, 3, dim::kLength, "`mount ... at` takes lengths"));
    const bool looks = stmt.kind == syntax::MountKind::kLook;
    camera.aim = looks ? plan::CameraAim::kLook : plan::CameraAim::kQuat;
    camera.aim_values = {};
    const std::size_t count = looks ? 3 : 4;
    const auto aim = read_point(
        context, stmt.direction, count, count, dim::kNumber,
        looks ? "`look` takes a direction of plain numbers" : "`quat` takes plain numbers");
    assign(camera.aim_values, aim);
    const auto& values = camera.aim_values;
    const auto is_zero = [](double value) { return value == 0; };
    if (aim && looks && std::all_of(values.begin(), values.end(), is_zero)) {
      context
          .report(Code::P0304, stmt.direction.span, "a camera looks along a direction, found none")
          .help("a direction is a vector, such as `look (1, 0, -1)`");
    } else if (aim && looks && values[0] == 0 && values[1] == 0) {
      context
          .report(Code::P0304, stmt.direction.span,
                  "the view is vertical, which leaves its roll open")
          .help("give the orientation with `quat`");
    }
    if (aim && !looks) make_unit(stmt.direction.span);
  }
  // A published quaternion has six digits or so; a plan wants its length to be 1.
  void make_unit(const Span& span) {
    double squares = 0;
    for (const double value : camera.aim_values) squares += value * value;
    const double length = std::sqrt(squares);
    if (std::abs(length - 1) > 1e-3) {
      context.report(Code::P0304, span,
                     "expected a unit quaternion (w, x, y, z), found one of another length");
      return;
    }
    for (double& value : camera.aim_values) value /= length;
  }
  void operator()(const syntax::ImageStmt& stmt) {
    camera.width = size(stmt.width);
    camera.height = size(stmt.height);
    camera.samples = 0;
    if (!stmt.samples) return;
    const auto samples = stmt.samples->value;
    if (samples != 1 && samples != 4 && samples != 16) {
      context.report(Code::P0304, stmt.samples->span, "expected 1, 4 or 16 samples a pixel");
      return;
    }
    // The renderer traces a picture of all samples and averages it.
    const std::uint32_t across = samples == 16 ? 4 : samples == 4 ? 2 : 1;
    if (std::max(camera.width, camera.height) * across > kLargestSide) {
      context.report(Code::P0304, stmt.samples->span,
                     "with " + std::to_string(samples) +
                         " samples a pixel an image side is at most " +
                         std::to_string(kLargestSide / across) + " pixels");
      return;
    }
    if (samples > 1) camera.samples = static_cast<std::uint32_t>(samples);
  }
  void operator()(const syntax::LensStmt& stmt) {
    if (stmt.values.size() != 4) {
      context.report(Code::P0302, stmt.span,
                     "expected fx, fy, cx, cy, found " + std::to_string(stmt.values.size()) +
                         (stmt.values.size() == 1 ? " value" : " values"));
      return;
    }
    double* const to[] = {&camera.fx, &camera.fy, &camera.cx, &camera.cy};
    for (std::size_t i = 0; i < 4; ++i) {
      *to[i] =
          read_positive(context, stmt.values[i], dim::kPixel, "`lens` takes pixels").value_or(1);
    }
  }
  std::uint32_t size(const syntax::Int& value) {
    if (value.value >= 1 && value.value <= kLargestSide)
      return static_cast<std::uint32_t>(value.value);
    context.report(Code::P0304, value.span, "expected an image side between 1 and 8192 pixels");
    return 1;
  }
};

void define_cameras(Context& context) {
  const auto& decls = context.symbols.camera_decls;
  std::vector<std::optional<std::uint32_t>> parents(decls.size());
  std::vector<bool> broken(decls.size(), false);  // reported; what it lacks follows from that
  for (std::size_t i = 0; i < decls.size(); ++i) {
    context.model.cameras.add({});
    if (decls[i].node->like)
      parents[i] = context.symbols.cameras.find(*decls[i].node->like, context.diagnostics);
  }
  for (const std::uint32_t i : parents_first(context, parents, context.symbols.cameras.names())) {
    const syntax::CameraDecl& node = *decls[i].node;
    Camera camera;
    if (parents[i]) camera = context.model.cameras[static_cast<CameraId>(*parents[i])];
    camera.name = std::string(node.name.text);
    camera.span = node.name.span;
    const auto errors = context.mistakes();
    for (const syntax::CameraStmt& stmt : node.body)
      std::visit(CameraReader{context, camera}, stmt);
    broken[i] = !decls[i].decl->complete || (node.like && !parents[i]) ||
                (parents[i] && broken[*parents[i]]);
    if (!broken[i]) {
      if (camera.mount_link.span.is_none())
        missing(context, "camera", camera.name, camera.span, "mount");
      if (camera.width == 0) missing(context, "camera", camera.name, camera.span, "image");
      if (camera.fx == 0) missing(context, "camera", camera.name, camera.span, "lens");
    }
    camera.broken = broken[i] = broken[i] || context.mistakes() != errors;
    context.model.cameras[static_cast<CameraId>(i)] = std::move(camera);
  }
}

void define_lights(Context& context) {
  for (const auto& declared : context.symbols.light_decls) {
    Light light;
    light.name = std::string(declared.node->name.text);
    light.span = declared.node->name.span;
    for (const syntax::LightStmt& stmt : declared.node->body) {
      if (const auto* ambient = std::get_if<syntax::AmbientStmt>(&stmt)) {
        light.ambient =
            read_si(context, ambient->value, dim::kNumber, "`ambient` takes a number").value_or(0);
        if (light.ambient < 0)
          context.report(Code::P0304, ambient->value.span,
                         "expected an ambient light of 0 or more");
        if (!ambient->occlusion) continue;
        if (ambient->occlusion->value < 1 || ambient->occlusion->value > plan::kMaxOcclusion) {
          context.report(Code::P0304, ambient->occlusion->span,
                         "expected 1 to 16 rays to find how open a place is");
          continue;
        }
        light.occlusion = static_cast<std::uint32_t>(ambient->occlusion->value);
        continue;
      }
      const auto& written = std::get<syntax::SunStmt>(stmt);
      plan::SunRecord sun;
      assign(sun.direction, read_point(context, written.direction, 3, 3, dim::kNumber,
                                       "`sun` takes a direction of plain numbers"));
      if (sun.direction == std::array<double, 3>{})
        context.report(Code::P0304, written.direction.span,
                       "a sun shines along a direction, found none");
      sun.power =
          read_positive(context, written.power, dim::kNumber, "`power` takes a number").value_or(1);
      sun.shadow = written.shadow ? 1 : 0;
      light.suns.push_back(sun);
    }
    context.model.lights.add(std::move(light));
  }
}

// ---- scenes
// ---------------------------------------------------------------------------------------------------------

struct SceneReader {
  Context& context;
  Scene& scene;
  bool has_surface = false, has_physics = false;

  void operator()(const syntax::SceneRobotStmt& stmt) {
    const auto robot = context.symbols.robots.find(stmt.robot, context.diagnostics);
    if (robot) scene.robot = static_cast<RobotId>(*robot);
    const auto at =
        read_point(context, stmt.at, 2, 3, dim::kLength, "`robot ... at` takes lengths");
    assign(scene.base_position, at);
    scene.base_on_surface = at && at->size() == 2;
    if (const auto yaw = read_quantity(context, stmt.yaw, dim::kAngle, "`yaw` takes an angle")) {
      scene.base_turn = make_turn(nullptr, nullptr, &*yaw);
    }
  }
  void operator()(const syntax::JointsStmt& stmt) {
    scene.joints.clear();
    scene.joints_span = stmt.span;
    // Lengths and angles mix here; each is checked against its joint when the robot is known.
    for (const syntax::Quantity& value : stmt.positions.coordinates) {
      const auto as_is = make_quantity("0", to_text(value.unit));
      const bool is_length = as_is && as_is->dimension == dim::kLength;
      const auto read = read_quantity(context, value, is_length ? dim::kLength : dim::kAngle,
                                      "a joint is at an angle or a length");
      if (read) scene.joints.push_back(*read);
    }
    if (scene.joints.size() != stmt.positions.coordinates.size())
      scene.joints.clear(), scene.joints_span = {};
  }
  void operator()(const syntax::SurfaceStmt& stmt) {
    has_surface = true;
    scene.surface_z =
        read_si(context, stmt.height, dim::kLength, "`surface` takes a height").value_or(0);
    const auto low = read_point(context, stmt.low, 2, 2, dim::kLength, "`area` takes lengths");
    const auto high = read_point(context, stmt.high, 2, 2, dim::kLength, "`area` takes lengths");
    if (!low || !high) return;
    scene.area = {(*low)[0].si(), (*low)[1].si(), (*high)[0].si(), (*high)[1].si()};
    if (scene.area[0] < scene.area[2] && scene.area[1] < scene.area[3]) return;
    context.report(Code::P0304, join(stmt.low.span, stmt.high.span),
                   "the second corner of an area lies above the first on both axes");
  }
  void operator()(const syntax::FixtureStmt& stmt) {
    scene.fixture = spelled(stmt.mesh);
    assign(scene.fixture_position,
           read_point(context, stmt.at, 3, 3, dim::kLength, "`fixture ... at` takes lengths"));
  }
  void operator()(const syntax::BackdropStmt& stmt) { scene.backdrop = spelled(stmt.mesh); }
  void operator()(const syntax::SceneCameraStmt& stmt) {
    scene.views.clear();
    for (const syntax::SceneCamera& written : stmt.cameras) {
      const auto camera = context.symbols.cameras.find(written.camera, context.diagnostics);
      if (!camera) continue;
      View view;
      const syntax::Name& name = written.as ? *written.as : written.camera;
      view.name = std::string(name.text);
      view.span = name.span;
      view.camera = static_cast<CameraId>(*camera);
      view.is_named = written.as.has_value();
      if (written.overlay) view.overlay = spelled(*written.overlay);
      add_view(std::move(view));
    }
    if (scene.views.size() > plan::kMaxViews) {
      context.report(Code::P0304, stmt.span,
                     "expected at most " + std::to_string(plan::kMaxViews) +
                         " cameras in a scene, found " + std::to_string(scene.views.size()));
    }
  }
  void add_view(View view) {
    for (const View& known : scene.views) {
      if (known.name != view.name) continue;
      context
          .report(Code::P0203, view.span,
                  "two cameras of scene `" + scene.name + "` are called `" + view.name + "`")
          .label(known.span, "first called so here")
          .help("`as NAME` gives a camera another name in its scene");
      return;
    }
    scene.views.push_back(std::move(view));
  }
  void operator()(const syntax::UseLightStmt& stmt) {
    const auto light = context.symbols.lights.find(stmt.light, context.diagnostics);
    if (light) scene.light = static_cast<LightId>(*light);
  }
  void operator()(const syntax::PhysicsStmt& stmt) {
    has_physics = true;
    scene.physics_span = stmt.rate.span;
    scene.physics_hz =
        read_positive(context, stmt.rate, dim::kRate, "`physics` takes a frequency").value_or(1);
    scene.friction =
        read_positive(context, stmt.friction, dim::kNumber, "`friction` takes a number")
            .value_or(1);
    if (stmt.window_step)
      context.report(Code::P0101, stmt.span, "`window step` is not available yet");
  }
};

// A world refuses joints that begin farther beyond a limit than rounding explains.
void check_joint_limits(Context& context, const Scene& scene, const Robot& robot) {
  if (!robot.model) return;
  constexpr double kRounding = 1e-3;  // m or rad, as in runtime/world
  for (std::size_t i = 0; i < scene.joints.size(); ++i) {
    const int index = robot.model->find_joint(robot.drives[i].joint.text);
    if (index < 0) continue;
    const robot::Joint& joint = robot.model->joints[static_cast<std::size_t>(index)];
    if (joint.kind == robot::JointKind::kContinuous || joint.kind == robot::JointKind::kFixed)
      continue;
    const double q = scene.joints[i].si();
    if (q >= joint.lower - kRounding && q <= joint.upper + kRounding) continue;
    context
        .report(Code::P0304, scene.joints_span,
                fmt::format("joint `{}` starts at {:.6g}, beyond its limits of {:.6g} and {:.6g}",
                            joint.name, q, joint.lower, joint.upper))
        .point("number " + std::to_string(i + 1));
  }
}

void check_joints(Context& context, const Scene& scene) {
  if (scene.robot == RobotId::kNone || scene.joints_span.is_none()) return;
  const Robot& robot = context.model.robots[scene.robot];
  if (scene.joints.size() != robot.drives.size()) {
    context.report(Code::P0304, scene.joints_span,
                   "expected " + std::to_string(robot.drives.size()) +
                       " joints, one per drive of `" + robot.name + "`, found " +
                       std::to_string(scene.joints.size()));
    return;
  }
  for (std::size_t i = 0; i < scene.joints.size(); ++i) {
    const bool slides = robot.drives[i].stiffness.dimension == dim::kLinearStiffness;
    const Dimension wanted = slides ? dim::kLength : dim::kAngle;
    if (scene.joints[i].dimension == wanted) continue;
    context
        .report(Code::P0302, scene.joints_span,
                "expected " + name_of(wanted) + " for joint `" + robot.drives[i].joint.text +
                    "`, found " + name_of(scene.joints[i].dimension))
        .point("number " + std::to_string(i + 1));
  }
  check_joint_limits(context, scene, robot);
}

// A control step is a whole number of physics steps.
void check_rates(Context& context, const Scene& scene) {
  if (scene.robot == RobotId::kNone || scene.physics_hz == 0) return;
  const double control_hz = context.model.robots[scene.robot].control_hz;
  if (control_hz == 0) return;
  const double substeps = scene.physics_hz / control_hz;
  constexpr double kMostSubsteps = 100000;
  if (substeps >= 1 && substeps <= kMostSubsteps && substeps == std::floor(substeps)) return;
  context
      .report(Code::P0304, scene.physics_span,
              "expected a whole number of physics steps in a control step, found " +
                  fmt::format("{:.6g}", substeps))
      .help("the robot is controlled at " + fmt::format("{:.6g}", control_hz) +
            "Hz: write a multiple of that, such as `500Hz` for 5Hz");
}

void define_scenes(Context& context) {
  const auto& decls = context.symbols.scene_decls;
  std::vector<std::optional<std::uint32_t>> parents(decls.size());
  std::vector<bool> broken(decls.size(), false);  // reported; what it lacks follows from that
  for (std::size_t i = 0; i < decls.size(); ++i) {
    context.model.scenes.add({});
    if (decls[i].node->like)
      parents[i] = context.symbols.scenes.find(*decls[i].node->like, context.diagnostics);
  }
  for (const std::uint32_t i : parents_first(context, parents, context.symbols.scenes.names())) {
    const syntax::SceneDecl& node = *decls[i].node;
    Scene scene;
    if (parents[i]) scene = context.model.scenes[static_cast<SceneId>(*parents[i])];
    scene.name = std::string(node.name.text);
    scene.span = node.name.span;
    SceneReader reader{context, scene};
    const auto errors = context.mistakes();
    for (const syntax::SceneStmt& stmt : node.body) std::visit(reader, stmt);
    if (scene.base_on_surface) scene.base_position[2] = scene.surface_z;
    broken[i] = !decls[i].decl->complete || context.mistakes() != errors ||
                (node.like && !parents[i]) || (parents[i] && broken[*parents[i]]);
    if (!broken[i]) {
      if (scene.robot == RobotId::kNone) missing(context, "scene", scene.name, scene.span, "robot");
      if (scene.joints_span.is_none()) missing(context, "scene", scene.name, scene.span, "joints");
      if (scene.area[0] == scene.area[2])
        missing(context, "scene", scene.name, scene.span, "surface");
      if (scene.views.empty()) missing(context, "scene", scene.name, scene.span, "camera");
      if (scene.light == LightId::kNone) missing(context, "scene", scene.name, scene.span, "light");
      if (scene.physics_hz == 0) missing(context, "scene", scene.name, scene.span, "physics");
      const bool has_robot =
          scene.robot != RobotId::kNone && !context.model.robots[scene.robot].broken;
      if (has_robot) check_joints(context, scene);
      check_rates(context, scene);
    }
    scene.complete = !broken[i] && context.mistakes() == errors && scene.robot != RobotId::kNone &&
                     !context.model.robots[scene.robot].broken;
    broken[i] = !scene.complete;
    context.model.scenes[static_cast<SceneId>(i)] = std::move(scene);
  }
}

}  // namespace

bool Camera::operator==(const Camera& other) const {
  return mount_link.text == other.mount_link.text && aim == other.aim &&
         position == other.position && aim_values == other.aim_values && width == other.width &&
         height == other.height && samples == other.samples && fx == other.fx && fy == other.fy &&
         cx == other.cx && cy == other.cy;
}

bool Light::operator==(const Light& other) const {
  if (ambient != other.ambient || occlusion != other.occlusion || suns.size() != other.suns.size())
    return false;
  for (std::size_t i = 0; i < suns.size(); ++i) {
    if (suns[i].direction != other.suns[i].direction || suns[i].power != other.suns[i].power ||
        suns[i].shadow != other.suns[i].shadow) {
      return false;
    }
  }
  return true;
}

void define_stage(Context& context) {
  define_robots(context);
  define_cameras(context);
  define_lights(context);
  define_scenes(context);
}

}  // namespace probe::sema
