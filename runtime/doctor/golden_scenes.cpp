// What the golden pictures show. Changing anything here makes the stored ones useless.
#include "runtime/doctor/golden_scenes.h"

#include <algorithm>
#include <array>
#include <filesystem>

#include "runtime/render/renderer.h"
#include "runtime/robot/kinematics.h"
#include "runtime/robot/urdf.h"
#include "runtime/scene/hull.h"
#include "runtime/scene/mesh_cache.h"
#include "runtime/world/world.h"

namespace probe::doctor {
namespace {

namespace fs = std::filesystem;

constexpr const char* kUrdf = "robots/widowx/wx250s.urdf";
constexpr double kTable = 0.87;  // m

constexpr std::array<const char*, 8> kJoints{"waist",        "shoulder",    "elbow",
                                             "forearm_roll", "wrist_angle", "wrist_rotate",
                                             "left_finger",  "right_finger"};

render::Lights table_lights() {
  return {.ambient = 0.3,
          .suns = {{Vec3(0, 0, -1), 2.2}, {Vec3(-1, -0.5, -1), 0.7}, {Vec3(1, 1, -1), 0.7}}};
}

Pose at(double x, double y, double z) { return {Vec3(x, y, z), Quat::Identity()}; }

Result<GoldenFrame> draw(const std::string& name, const render::SceneSpec& spec,
                         const std::vector<Pose>& poses) {
  PROBE_ASSIGN(const auto renderer, render::Renderer::create(spec));
  PROBE_ASSIGN(const render::FrameView frame, renderer->render(poses));
  return GoldenFrame{name,
                     frame.width,
                     frame.height,
                     {frame.rgb.begin(), frame.rgb.end()},
                     {frame.depth.begin(), frame.depth.end()},
                     {frame.segmentation.begin(), frame.segmentation.end()}};
}

Result<render::Visual> visual(const std::string& root, const std::string& path,
                              std::uint16_t body) {
  render::Visual visual;
  PROBE_ASSIGN(visual.mesh, scene::shared_mesh((fs::path(root) / path).string()));
  visual.body = body;
  visual.name = path;
  return visual;
}

// 96 x 96, filled by the object seen from above at an angle.
Result<GoldenFrame> draw_object(const std::string& root, const std::string& name) {
  render::SceneSpec spec;
  PROBE_ASSIGN(render::Visual object, visual(root, "objects/" + name + "/visual.glb", 0));
  double radius = 0;
  for (const scene::MeshPart& part : object.mesh->parts) {
    for (std::size_t k = 0; k + 2 < part.positions.size(); k += 3) {
      const Vec3 p(part.positions[k], part.positions[k + 1], part.positions[k + 2]);
      radius = std::max(radius, p.norm());
    }
  }
  if (!(radius > 0)) return Failure{Fault::kAsset, "the mesh has no size", object.name};
  const Vec3 view = Vec3(-1, -0.6, -1.1).normalized();
  spec.camera.position = -4 * radius * view;
  PROBE_ASSIGN(spec.camera.forward_left_up, render::look_along(view));
  spec.camera.width = spec.camera.height = 96;
  spec.camera.fx = spec.camera.fy = 180;
  spec.camera.cx = spec.camera.cy = 48;
  spec.lights = table_lights();
  spec.dynamics = {std::move(object)};
  return draw(name, spec, {Pose{}});
}

// Where a robot stands and what its camera sees.
struct Stage {
  const char* name;
  std::vector<std::pair<const char*, Pose>> statics;
  std::vector<std::pair<const char*, Pose>> objects;
  Vec3 base;
  std::array<double, 8> joints;
  Vec3 camera;  // in the base
  Mat3 axes;    // in the base
  render::Lights lights;
};

Mat3 facing(const Vec3& direction) {
  const auto axes = render::look_along(direction);
  return axes.ok() ? *axes : Mat3::Identity();
}

Stage table() {
  return {"table",
          {{"scenes/table/visual.glb", Pose{}}},
          {{"objects/carrot/visual.glb", at(-0.235, -0.075, kTable + 0.019)},
           {"objects/plate/visual.glb", at(-0.125, 0.025, kTable + 0.003)}},
          Vec3(0.147, 0.028, 0.870),
          {-0.01840777, 0.0398835, 0.22242722, -0.00460194, 1.36524296, 0.00153398, 0.037, 0.037},
          Vec3(0, -0.16, 0.36),
          facing(Vec3(1, 0.553, -1.085)),
          table_lights()};
}

Stage sink() {
  return {"sink",
          {{"scenes/sink/visual.glb", Pose{}}, {"fixtures/sink/visual.glb", at(-0.16, 0.13, 0.88)}},
          {{"objects/eggplant/visual.glb", at(-0.12, 0.2, 0.94)},
           {"objects/basket/visual.glb", at(-0.125, 0.025, 0.93)}},
          Vec3(0.127, 0.060, 0.850),
          {-0.2600599, -0.12875618, 0.04461369, -0.00652761, 1.7033415, -0.26983038, 0.037, 0.037},
          Vec3(-0.003, -0.21, 0.39),
          Quat(-0.907313, 0.0782, -0.36434, -0.194741).normalized().toRotationMatrix(),
          {.ambient = 0.3, .suns = {{Vec3(0, 0, -1), 0.3}}}};
}

struct Robot {
  std::vector<render::Visual> visuals;
  std::vector<Pose> poses;
};

Result<Robot> place_robot(const std::string& root, const Stage& stage) {
  const std::string urdf = (fs::path(root) / kUrdf).string();
  PROBE_ASSIGN(const robot::RobotModel model, robot::load_urdf(urdf));
  const std::vector<std::string> joints(kJoints.begin(), kJoints.end());
  PROBE_ASSIGN(robot::Tree tree, robot::Tree::create(model, joints));
  std::vector<Pose> links(model.links.size());
  tree.link_poses(stage.joints, links);
  Robot robot;
  for (std::size_t link = 0; link < model.links.size(); ++link) {
    for (const robot::MeshRef& ref : model.links[link].visuals) {
      render::Visual visual;
      const std::string path = (fs::path(urdf).parent_path() / ref.path).string();
      PROBE_ASSIGN(visual.mesh, scene::shared_mesh(path, ref.scale));
      visual.origin = ref.origin;
      visual.body = static_cast<std::uint16_t>(100 + link);
      visual.name = model.links[link].name;
      visual.robot = true;
      robot.visuals.push_back(std::move(visual));
      robot.poses.push_back(Pose{stage.base, Quat(0, 0, 0, 1)} * links[link]);
    }
  }
  return robot;
}

Result<GoldenFrame> draw_stage(const std::string& root, const Stage& stage, const std::string& name,
                               bool fine) {
  render::SceneSpec spec;
  for (const auto& [path, pose] : stage.statics) {
    PROBE_ASSIGN(render::Visual fixed, visual(root, path, render::kBackdrop));
    fixed.origin = pose;
    spec.statics.push_back(std::move(fixed));
  }
  PROBE_ASSIGN(Robot robot, place_robot(root, stage));
  spec.dynamics = std::move(robot.visuals);
  std::vector<Pose> poses = std::move(robot.poses);
  std::uint16_t body = 0;
  for (const auto& [path, pose] : stage.objects) {
    PROBE_ASSIGN(render::Visual object, visual(root, path, body++));
    spec.dynamics.push_back(std::move(object));
    poses.push_back(pose);
  }
  const Pose base{stage.base, Quat(0, 0, 0, 1)};
  spec.camera.position = base.apply(stage.camera);
  spec.camera.forward_left_up = base.rotation.toRotationMatrix() * stage.axes;
  spec.camera.width = 320;
  spec.camera.height = 240;
  spec.camera.fx = spec.camera.fy = 311.794;
  spec.camera.cx = 159.7505;
  spec.camera.cy = 119.7725;
  spec.lights = stage.lights;
  if (fine) {
    for (render::Sun& sun : spec.lights.suns) sun.shadow = true;
    spec.samples = 2;
    spec.occlusion_rays = 8;
  }
  return draw(name, spec, poses);
}

}  // namespace

Result<std::vector<GoldenFrame>> draw_golden_frames(const std::string& root) {
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(fs::path(root) / "objects", error)) {
    if (fs::exists(entry.path() / "visual.glb")) names.push_back(entry.path().filename().string());
  }
  if (names.empty()) return Failure{Fault::kAsset, "has no objects with a visual.glb", root};
  std::sort(names.begin(), names.end());
  std::vector<GoldenFrame> frames;
  for (const std::string& name : names) {
    PROBE_ASSIGN(GoldenFrame frame, draw_object(root, name));
    frames.push_back(std::move(frame));
  }
  PROBE_ASSIGN(GoldenFrame on_table, draw_stage(root, table(), "scene_table", false));
  PROBE_ASSIGN(GoldenFrame in_sink, draw_stage(root, sink(), "scene_sink", false));
  PROBE_ASSIGN(GoldenFrame fine, draw_stage(root, table(), "scene_table_fine", true));
  for (GoldenFrame* frame : {&on_table, &in_sink, &fine}) frames.push_back(std::move(*frame));
  return frames;
}

Result<GoldenSettle> settle_golden_objects(const std::string& root) {
  PROBE_ASSIGN(const robot::RobotModel model, robot::load_urdf((fs::path(root) / kUrdf).string()));
  world::WorldSpec spec;
  spec.surface_z = kTable;
  spec.articulations.emplace_back();
  spec.articulations[0].model = &model;
  spec.articulations[0].base = {table().base, Quat(0, 0, 0, 1)};
  for (std::size_t i = 0; i < kJoints.size(); ++i) {
    spec.articulations[0].joints.push_back({kJoints[i], 1000, 200, 100});
    spec.articulations[0].positions.push_back(table().joints[i]);
  }
  double x = -0.3;
  for (const char* name : {"carrot", "green_cube", "orange", "plate"}) {
    const std::string path = (fs::path(root) / "objects" / name / "collision.obj").string();
    PROBE_ASSIGN(scene::CollisionShape shape, scene::load_collision_obj(path, Vec3::Ones()));
    spec.bodies.push_back({.name = name,
                           .shape = std::make_shared<scene::CollisionShape>(std::move(shape)),
                           .density = 700,
                           .pose = at(x, 0.1, kTable + 0.05)});
    x += 0.08;
  }
  PROBE_ASSIGN(const auto world, world::World::create(std::move(spec)));
  PROBE_TRY(world->step(500));
  GoldenSettle settle;
  settle.state = world->state_hash();
  for (std::size_t i = 0; i < 4; ++i) settle.positions.push_back(world->body(i).pose.position);
  return settle;
}

}  // namespace probe::doctor
