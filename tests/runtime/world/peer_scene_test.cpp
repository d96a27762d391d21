// The scene that was also given to another engine, replayed with the same joint targets: poses at
// the end of each phase, slip in the hold, drift at rest.
#include <doctest/doctest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <sstream>

#include "tests/runtime/world/arm_bench.h"

namespace probe::world {
namespace {

const std::string kFolder = std::string(VLAPROBE_SOURCE_DIR) + "/../shared/reference/peer_scene/";

std::string attribute(const std::string& line, const std::string& name) {
  const auto begin = line.find(" " + name + "=\"");
  if (begin == std::string::npos) return "";
  const auto from = begin + name.size() + 3;
  return line.substr(from, line.find('"', from) - from);
}

std::vector<double> numbers(const std::string& text) {
  std::istringstream in(text);
  std::vector<double> out;
  for (double x = 0; in >> x;) out.push_back(x);
  return out;
}

struct Peer {
  std::vector<BodySpec> bodies;
};

// One element a line: meshes first, then bodies with a free joint and their shapes.
bool read_peer(const std::string& path, Peer* out) {
  std::ifstream file(path);
  if (!file) return false;
  std::map<std::string, std::vector<Vec3>> meshes;
  std::vector<std::vector<Vec3>> parts;
  BodySpec body;
  double mass = 0;
  const auto finish = [&] {
    if (parts.empty()) return;
    auto shape = scene::make_collision_shape(parts, body.name);
    REQUIRE(shape.ok());
    body.shape = std::make_shared<scene::CollisionShape>(std::move(shape).value());
    body.density = mass / body.shape->volume;
    out->bodies.push_back(body);
    parts.clear();
  };
  bool is_free = false;
  for (std::string line; std::getline(file, line);) {
    if (line.find("<mesh ") != std::string::npos) {
      const std::vector<double> v = numbers(attribute(line, "vertex"));
      for (std::size_t i = 0; i + 2 < v.size(); i += 3) {
        meshes[attribute(line, "name")].emplace_back(v[i], v[i + 1], v[i + 2]);
      }
    }
    if (line.find("<body ") != std::string::npos) {
      finish();
      is_free = line.find("<freejoint") != std::string::npos;
      body = BodySpec{};
      body.name = attribute(line, "name");
      const std::vector<double> p = numbers(attribute(line, "pos"));
      if (is_free) body.pose.position = Vec3(p[0], p[1], p[2]);
      const std::string weight = attribute(line, "mass");
      if (!weight.empty()) mass = std::stod(weight);
    }
    if (!is_free || line.find("<geom ") != 0) continue;
    const std::string mesh = attribute(line, "mesh");
    if (!mesh.empty()) {
      parts.push_back(meshes[mesh]);
      continue;
    }
    const std::vector<double> half = numbers(attribute(line, "size"));
    parts.emplace_back();
    for (int i = 0; i < 8; ++i) {
      parts.back().emplace_back(i & 1 ? half[0] : -half[0], i & 2 ? half[1] : -half[1],
                                i & 4 ? half[2] : -half[2]);
    }
  }
  finish();
  return true;
}

struct Command {
  int phase = 0;
  std::vector<double> targets;
};

std::vector<Command> read_commands(const std::string& path) {
  std::ifstream file(path);
  std::vector<Command> out;
  for (std::string line; std::getline(file, line);) {
    const std::vector<double> v = numbers(line);
    if (v.size() == 9) out.push_back({static_cast<int>(v[0]), {v.begin() + 1, v.end()}});
  }
  return out;
}

TEST_CASE("the other engine's scene: grasped, held, carried, released, at rest") {
  auto robot = load_widowx();
  for (const int which : {0, 1}) {
    const std::string n = std::to_string(which);
    Peer peer;
    if (!robot.ok() || !read_peer(kFolder + "h" + n + "_ell.xml", &peer)) {
      MESSAGE("skipped: no scene in ", kFolder);
      return;
    }
    const std::vector<Command> commands = read_commands(kFolder + "tb" + n + ".txt");
    REQUIRE(commands.size() > 200);
    REQUIRE(peer.bodies.size() == 4);
    WorldSpec spec;
    spec.articulations = {robot.value()->spec};
    spec.articulations[0].base = Pose{};
    spec.articulations[0].positions = commands.front().targets;
    spec.articulations[0].positions[0] = 0;
    for (std::size_t f : {6U, 7U}) spec.articulations[0].positions[f] = 0.037;
    spec.bodies = peer.bodies;
    spec.sleeping = false;
    auto made = World::create(spec);
    REQUIRE_MESSAGE(made.ok(), (made.ok() ? "" : to_text(made.failure())));
    World& world = **made;
    const std::size_t held = static_cast<std::size_t>(which);  // cube or carrot
    const auto in_gripper = [&] {
      return world.frame_pose("gripper_link").inverse() * world.body(held).pose;
    };
    // Where the hand would be if the arm stood at its targets: what a rigid grasp follows.
    std::vector<std::string> names;
    for (const JointSpec& drive : spec.articulations[0].joints) names.push_back(drive.joint);
    auto tree = robot::Tree::create(robot.value()->model, names);
    REQUIRE(tree.ok());
    const auto hand = static_cast<std::size_t>(robot.value()->model.find_link("gripper_link"));
    const auto commanded = [&](const std::vector<double>& targets) {
      std::vector<Pose> poses(robot.value()->model.links.size());
      tree->link_poses(targets, poses);
      return poses[hand];
    };
    Pose in_commanded;  // the body when the fingers have closed
    Pose hold_start;
    std::vector<Vec3> rest_start;
    double slip = 0, drift = 0, lifted = 0;
    for (std::size_t i = 0; i < commands.size(); ++i) {
      const bool begins = i == 0 || commands[i - 1].phase != commands[i].phase;
      if (begins && commands[i].phase == 4) hold_start = in_gripper();
      // The rest is measured from two seconds after the release on.
      const bool resting = commands[i].phase == 9;
      world.set_targets(commands[i].targets);
      REQUIRE(world.step(100).ok());
      if (commands[i].phase == 4) {
        slip = std::max(slip, (in_gripper().position - hold_start.position).norm());
        lifted = world.body(held).center.z();
      }
      if (resting && begins) {
        for (std::size_t b = 0; b < 4; ++b) rest_start.push_back(world.body(b).center);
      }
      for (std::size_t b = 0; resting && b < 4; ++b) {
        drift = std::max(drift, (world.body(b).center - rest_start[b]).norm());
      }
      if (i + 1 < commands.size() && commands[i + 1].phase == commands[i].phase) continue;
      const Vec3 c = world.body(held).center;
      const int phase = commands[i].phase;
      if (phase == 2)
        in_commanded = commanded(commands[i].targets).inverse() * world.body(held).pose;
      if (phase >= 3 && phase <= 5) {
        const Vec3 rigid = (commanded(commands[i].targets) * in_commanded).position;
        const double off = (world.body(held).pose.position - rigid).norm();
        MESSAGE(spec.bodies[held].name, " after phase ", phase, ": ", off * 1e3,
                " mm from where a rigid grasp on the commanded hand would have it");
        CHECK(off < (phase == 4 ? 3e-4 : 1e-3));
      }
      MESSAGE(spec.bodies[held].name, " after phase ", commands[i].phase, ": ", c.x(), " ", c.y(),
              " ", c.z());
    }
    MESSAGE(spec.bodies[held].name, ": slip in the hold ", slip * 1e3, " mm, drift at rest ",
            drift * 1e3, " mm");
    CHECK(lifted > 0.05);
    CHECK(slip < 1e-5);
    CHECK(drift < 1e-6);
    const Vec3 plate = world.body(2).center, end = world.body(held).center;
    CHECK(std::hypot(end.x() - plate.x(), end.y() - plate.y()) < 0.06);
    CHECK(end.z() > 0.005);
  }
}

}  // namespace
}  // namespace probe::world
