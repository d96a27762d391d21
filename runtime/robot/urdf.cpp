// The adapter of urdfdom: the only file that includes it. urdfdom checks and reads each element;
// order, angles and the shape of the tree come from urdf_text.h, the rules for numbers are in
// model_check.h.
#include "runtime/robot/urdf.h"

#include <console_bridge/console.h>
#include <urdf_parser/urdf_parser.h>

#include <array>
#include <exception>
#include <iterator>
#include <mutex>
#include <optional>

#include <fmt/format.h>

#include "runtime/base/file.h"
#include "runtime/robot/model_check.h"
#include "runtime/robot/urdf_limits.h"
#include "runtime/robot/urdf_text.h"

namespace probe::robot {
namespace {

constexpr std::size_t kLargestFile = std::size_t{16} << 20;

// urdfdom reports through one handler a process. While this lives, what it says goes into `text`
// instead of the console; the lock keeps two readers apart.
class Listener : public console_bridge::OutputHandler {
 public:
  Listener() : lock_(mutex()) { console_bridge::useOutputHandler(this); }
  ~Listener() override { console_bridge::restorePreviousOutputHandler(); }
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

  void log(const std::string& line, console_bridge::LogLevel level, const char*, int) override {
    if (level < console_bridge::CONSOLE_BRIDGE_LOG_ERROR) return;
    if (!text.empty()) text += "; ";
    text += line;
  }

  std::string text;

 private:
  static std::mutex& mutex() {
    static std::mutex one;
    return one;
  }
  std::unique_lock<std::mutex> lock_;
};

Result<std::string> read_text(const std::string& path) {
  PROBE_ASSIGN(std::string text, read_file(path, {.most = kLargestFile, .code = Fault::kUrdf}));
  if (text.empty()) return Failure{Fault::kUrdf, "the file is empty", path};
  // TinyXML reads a C string and would not see what follows a zero byte.
  if (text.find('\0') != std::string::npos) return Failure{Fault::kUrdf, "not text", path};
  return text;
}

Vec3 to_vec(const urdf::Vector3& v) { return {v.x, v.y, v.z}; }

MeshRef to_mesh(const urdf::Mesh& mesh, const Pose& origin) {
  return MeshRef{mesh.filename, to_vec(mesh.scale), origin};
}

std::optional<Primitive> to_primitive(const urdf::Geometry* geometry, const Pose& origin) {
  using Kind = Primitive::Kind;
  if (const auto* box = dynamic_cast<const urdf::Box*>(geometry)) {
    return Primitive{Kind::kBox, 0.5 * to_vec(box->dim), origin};
  }
  if (const auto* sphere = dynamic_cast<const urdf::Sphere*>(geometry)) {
    return Primitive{Kind::kSphere, Vec3::Constant(sphere->radius), origin};
  }
  if (const auto* cylinder = dynamic_cast<const urdf::Cylinder*>(geometry)) {
    const double r = cylinder->radius;
    return Primitive{Kind::kCylinder, Vec3(r, r, 0.5 * cylinder->length), origin};
  }
  return std::nullopt;
}

// Its material's, where the file gives it one.
Vec3 color_of(const urdf::Visual& visual) {
  if (visual.material == nullptr) return DrawnPrimitive{}.color;
  const urdf::Color& color = visual.material->color;
  return Vec3(color.r, color.g, color.b).cwiseMax(0).cwiseMin(1);
}

void add_primitive(const urdf::Visual& from, const Primitive& shape, Link& link) {
  link.drawn.push_back({shape, color_of(from)});
}
void add_primitive(const urdf::Collision&, const Primitive& shape, Link& link) {
  link.primitives.push_back(shape);
}

// Meshes into `meshes`, other shapes into the link's own lists.
template <typename Elements>
Status add_shapes(const Elements& elements, const std::vector<Quat>& turns, const std::string& path,
                  Link& link, std::vector<MeshRef>& meshes) {
  if (elements.size() != turns.size()) {
    return Failure{Fault::kUrdf,
                   fmt::format("link `{}` has a shape that was not understood", link.name), path};
  }
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const urdf::Geometry* geometry = elements[i]->geometry.get();
    const Pose origin{to_vec(elements[i]->origin.position), turns[i]};
    if (const auto* mesh = dynamic_cast<const urdf::Mesh*>(geometry)) {
      meshes.push_back(to_mesh(*mesh, origin));
      continue;
    }
    const std::optional<Primitive> primitive = to_primitive(geometry, origin);
    if (!primitive) {
      return Failure{
          Fault::kUrdf,
          fmt::format("link `{}` has a shape that is no mesh, box, sphere or cylinder", link.name),
          path};
    }
    add_primitive(*elements[i], *primitive, link);
  }
  return {};
}

Result<Link> to_link(const urdf::Link& from, const LinkText& text, const std::string& path) {
  Link link;
  link.name = from.name;
  if (from.inertial) {
    const urdf::Inertial& in = *from.inertial;
    link.mass = in.mass;
    link.center_of_mass = to_vec(in.origin.position);
    Mat3 inertia;
    inertia << in.ixx, in.ixy, in.ixz, in.ixy, in.iyy, in.iyz, in.ixz, in.iyz, in.izz;
    const Mat3 turn = text.inertial.toRotationMatrix();
    const Mat3 turned = turn * inertia * turn.transpose();
    link.inertia = 0.5 * (turned + turned.transpose());
  }
  PROBE_TRY(add_shapes(from.visual_array, text.visuals, path, link, link.visuals));
  PROBE_TRY(add_shapes(from.collision_array, text.collisions, path, link, link.collisions));
  return link;
}

JointKind to_kind(int type) {
  switch (type) {
    case urdf::Joint::REVOLUTE:
      return JointKind::kRevolute;
    case urdf::Joint::CONTINUOUS:
      return JointKind::kContinuous;
    case urdf::Joint::PRISMATIC:
      return JointKind::kPrismatic;
    default:
      return JointKind::kFixed;  // the scan admitted no other
  }
}

Result<Joint> to_joint(const urdf::Joint& from, const JointText& text, const RobotModel& model) {
  Joint joint;
  joint.name = from.name;
  joint.kind = to_kind(from.type);
  joint.parent_link = model.find_link(text.parent);
  joint.child_link = model.find_link(text.child);
  joint.origin = {to_vec(from.parent_to_joint_origin_transform.position), text.origin};
  const Vec3 axis = to_vec(from.axis);
  const double length = axis.norm();
  if (joint.kind != JointKind::kFixed) joint.axis = length > 1e-9 ? Vec3(axis / length) : axis;
  if (from.limits) {
    joint.lower = from.limits->lower;
    joint.upper = from.limits->upper;
    joint.effort = from.limits->effort;
    joint.velocity = from.limits->velocity;
  }
  if (from.dynamics) {
    joint.damping = from.dynamics->damping;
    joint.friction = from.dynamics->friction;
  }
  return joint;
}

Status add_mimic(const urdf::Joint& from, RobotModel& model, Joint& joint) {
  if (!from.mimic) return {};
  joint.mimic = model.find_joint(from.mimic->joint_name);
  joint.mimic_scale = from.mimic->multiplier;
  joint.mimic_offset = from.mimic->offset;
  if (joint.mimic >= 0) return {};
  return Failure{Fault::kUrdf,
                 fmt::format("joint `{}` mimics the joint `{}`, which is not there", joint.name,
                             from.mimic->joint_name),
                 model.path};
}

Result<RobotModel> to_model(const urdf::ModelInterface& from, const UrdfText& text,
                            const std::string& path) {
  RobotModel model;
  model.name = from.getName();
  model.path = path;
  for (const LinkText& link : text.links) {
    PROBE_ASSIGN(Link read, to_link(*from.getLink(link.name), link, path));
    model.links.push_back(std::move(read));
  }
  for (const JointText& joint : text.joints) {
    PROBE_ASSIGN(Joint read, to_joint(*from.getJoint(joint.name), joint, model));
    model.links[std::size_t(read.child_link)].parent_joint = int(model.joints.size());
    model.joints.push_back(std::move(read));
  }
  for (Joint& joint : model.joints) {
    PROBE_TRY(add_mimic(*from.getJoint(joint.name), model, joint));
  }
  model.root = text.root;
  return model;
}

}  // namespace

bool RobotModel::is_fixed(int link) const {
  while (links[static_cast<std::size_t>(link)].parent_joint >= 0) {
    const auto joint = static_cast<std::size_t>(links[static_cast<std::size_t>(link)].parent_joint);
    if (joints[joint].kind != JointKind::kFixed) return false;
    link = joints[joint].parent_link;
  }
  return true;
}

int RobotModel::find_link(std::string_view wanted) const {
  for (std::size_t i = 0; i < links.size(); ++i) {
    if (links[i].name == wanted) return int(i);
  }
  return -1;
}

int RobotModel::find_joint(std::string_view wanted) const {
  for (std::size_t i = 0; i < joints.size(); ++i) {
    if (joints[i].name == wanted) return int(i);
  }
  return -1;
}

Result<RobotModel> load_urdf(const std::string& path) {
  PROBE_ASSIGN(const std::string text, read_text(path));
  PROBE_ASSIGN(const UrdfText scanned, scan_urdf(text, path));
  PROBE_ASSIGN(const std::string finite, without_infinite_limits(text, path));
  urdf::ModelInterfaceSharedPtr parsed;
  std::string said;
  try {
    Listener listener;
    parsed = urdf::parseURDF(finite);
    said = listener.text;
  } catch (const std::exception& e) {
    return Failure{Fault::kUrdf, fmt::format("urdfdom gave up: {}", e.what()), path};
  }
  if (!parsed) {
    return Failure{Fault::kUrdf,
                   said.empty() ? "urdfdom could not read it and did not say why" : said, path};
  }
  PROBE_ASSIGN(RobotModel model, to_model(*parsed, scanned, path));
  PROBE_TRY(check_model(model));
  return model;
}

}  // namespace probe::robot
