// A plan with one of everything, for tests: two tasks over one program, two episodes each, a suite,
// a set, sources.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "runtime/plan/isa.h"
#include "runtime/plan/writer.h"

namespace probe::plan {

inline Instruction make_instruction(Op op, std::uint32_t dst, std::uint32_t a = 0,
                                    std::uint32_t b = 0) {
  return {static_cast<std::uint8_t>(op), 0, static_cast<std::uint16_t>(dst),
          static_cast<std::uint16_t>(a), static_cast<std::uint16_t>(b)};
}

inline std::uint32_t add_asset(Writer& w, std::string_view path, AssetKind kind) {
  AssetRecord asset;
  asset.path = w.text(path);
  asset.kind = static_cast<std::uint32_t>(kind);
  asset.byte_size = 10 + path.size();
  asset.sha256 = sha256(path).bytes;
  w.records.assets.push_back(asset);
  return static_cast<std::uint32_t>(w.records.assets.size() - 1);
}

inline void add_object(Writer& w, std::string_view name, double half) {
  ObjectRecord object;
  object.name = w.text(name);
  object.text = w.text(name);
  object.visual = add_asset(w, "objects/" + std::string(name) + ".glb", AssetKind::kVisualMesh);
  object.collision =
      add_asset(w, "objects/" + std::string(name) + ".obj", AssetKind::kCollisionMesh);
  object.box_min = {-half, -half, -half};
  object.box_max = {half, half, half};
  object.density = 700;
  object.friction = 0.5;
  w.records.objects.push_back(object);
}

inline void add_program(Writer& w) {
  using enum Op;
  Records& r = w.records;
  const std::vector<double> constants = {0.05, 1.0, 2.0, 3.0};
  const std::vector<StateRecord> states = {{static_cast<std::uint16_t>(kONCE), 0},
                                           {static_cast<std::uint16_t>(kHOLD), 5}};
  const std::vector<Instruction> code = {
      make_instruction(kPOS, 0, 0),       make_instruction(kTCP, 1),
      make_instruction(kVSUB, 2, 0, 1),   make_instruction(kVLEN, 3, 2),
      make_instruction(kKR, 4, 0),        make_instruction(kLT, 5, 3, 4),
      make_instruction(kONCE, 6, 5, 0),   make_instruction(kEMITB, 7, 6, 0),
      make_instruction(kOPEN, 7, 3),      make_instruction(kKV, 8, 1),
      make_instruction(kVDOT, 9, 7, 8),   make_instruction(kEMITR, 10, 9, 1),
      make_instruction(kIMP, 10, 3, 0),   make_instruction(kLE, 11, 4, 10),
      make_instruction(kHOLD, 12, 11, 1), make_instruction(kEMITB, 13, 12, 2),
      make_instruction(kKB, 13, 1),       make_instruction(kAXIS, 14, 0, 2),
      make_instruction(kEND, 15)};
  const std::vector<MetricRecord> metrics = {
      {w.text("near"), static_cast<std::uint32_t>(MetricType::kBool),
       static_cast<std::uint32_t>(Readout::kOnce)},
      {w.text("spread"), static_cast<std::uint32_t>(MetricType::kReal),
       static_cast<std::uint32_t>(Readout::kFinal)},
      {w.text("steady"), static_cast<std::uint32_t>(MetricType::kBool),
       static_cast<std::uint32_t>(Readout::kAtEnd)}};
  ProgramRecord program;
  program.constants = append<double>(r.constants, constants);
  program.states = append<StateRecord>(r.states, states);
  program.code = append<Instruction>(r.code, code);
  program.metrics = append<MetricRecord>(r.metrics, metrics);
  r.programs.push_back(program);
}

inline void add_task(Writer& w, std::string_view name, std::string_view prompt,
                     std::uint32_t baseline) {
  Records& r = w.records;
  TaskRecord task;
  task.name = w.text(name);
  task.prompt = w.text(prompt);
  task.scene = task.camera = task.light = task.program = 0;
  task.source = 0;
  task.target = 1;
  const auto kind = [](BodyKind k) { return static_cast<std::uint32_t>(k); };
  const std::vector<BodyRecord> bodies = {{kind(BodyKind::kObject), 0, w.text("carrot")},
                                          {kind(BodyKind::kObject), 1, w.text("plate")},
                                          {kind(BodyKind::kSurface), 0, w.text("surface")},
                                          {kind(BodyKind::kLink), 0, w.text("left_finger")},
                                          {kind(BodyKind::kLink), 1, w.text("right_finger")},
                                          {kind(BodyKind::kLink), 2, w.text("wrist")}};
  task.bodies = append<BodyRecord>(r.bodies, bodies);
  task.horizon = 60;
  task.baseline = baseline;
  task.axes = baseline == kNone ? 0 : static_cast<std::uint32_t>(Axis::kLanguageAction);
  task.drop = 0.5;
  task.settle = 0.5;
  const auto index = static_cast<std::uint32_t>(r.tasks.size());
  task.episodes = {static_cast<std::uint32_t>(r.episodes.size()), 2};
  for (std::uint32_t i = 0; i < 2; ++i) {
    EpisodeRecord episode;
    episode.task = index;
    episode.index = i;
    episode.placements = {2 * i, 2};
    r.episodes.push_back(episode);
  }
  r.tasks.push_back(task);
}

inline Writer small_writer() {
  Writer w;
  Records& r = w.records;
  add_object(w, "carrot", 0.02);
  add_object(w, "plate", 0.1);

  RobotRecord robot;
  robot.name = w.text("widowx");
  robot.tcp = w.text("gripper_link");
  robot.urdf = add_asset(w, "robots/arm.urdf", AssetKind::kUrdf);
  robot.control = static_cast<std::uint32_t>(Control::kEeDeltaPose);
  robot.control_hz = 5;
  robot.fingers = {FingerRecord{w.text("left_finger"), {0, 1, 0}},
                   FingerRecord{w.text("right_finger"), {0, -1, 0}}};
  robot.grip_open = 0.037;
  robot.reach_max = 0.62;
  const std::vector<DriveRecord> drives = {{w.text("waist"), 1000, 100, 50},
                                           {w.text("elbow"), 900, 90, 40}};
  robot.drives = append<DriveRecord>(r.drives, drives);
  const std::vector<std::uint32_t> meshes = {
      add_asset(w, "robots/link.obj", AssetKind::kCollisionMesh)};
  robot.meshes = w.list(meshes);
  r.robots.push_back(robot);

  CameraRecord camera;
  camera.name = w.text("third_view");
  camera.mount_link = w.text("base_link");
  camera.aim = static_cast<std::uint32_t>(CameraAim::kLook);
  camera.width = 640;
  camera.height = 480;
  camera.aim_values = {1, 0.5, -1, 0};
  camera.fx = camera.fy = 600;
  r.cameras.push_back(camera);

  r.suns.push_back({{0, 0, -1}, 2.2, 1, 0});
  LightRecord light;
  light.name = w.text("studio");
  light.ambient = 0.3;
  light.suns = {0, 1};
  r.lights.push_back(light);

  SceneRecord scene;
  scene.name = w.text("table");
  scene.robot = 0;
  scene.photo = add_asset(w, "scenes/table.png", AssetKind::kPhoto);
  scene.base_rotation = {1, 0, 0, 0};
  scene.joints = w.reals(std::vector<double>{0.1, -0.2});
  scene.surface_z = 0.87;
  scene.area = {-0.3, -0.2, 0.1, 0.2};
  scene.physics_hz = 500;
  scene.friction = 0.5;
  r.scenes.push_back(scene);

  for (std::uint32_t i = 0; i < 4; ++i) {
    PlacementRecord placement;
    placement.object = i % 2;
    placement.position = {0.01 * i, 0.1, 1.37};
    placement.rotation = {1, 0, 0, 0};
    r.placements.push_back(placement);
  }
  add_program(w);
  add_task(w, "carrot_on_plate", "put carrot on plate", kNone);
  add_task(w, "carrot_on_plate_drop", "drop carrot on plate", 0);

  SetRecord set;
  set.name = w.text("core");
  set.members = w.list(std::vector<std::uint32_t>{0});
  r.sets.push_back(set);
  SuiteRecord suite;
  suite.name = w.text("smoke");
  suite.prefix = w.text("widowx_");
  suite.trained_on = w.text("bridge_v2");
  suite.members = w.list(std::vector<std::uint32_t>{0, 1});
  suite.seeds = w.list(std::vector<std::uint32_t>{42, 7});
  r.suites.push_back(suite);

  const std::uint32_t text =
      w.source("suite/small.probe", "task carrot_on_plate {\n  near = once x\n}\n");
  r.spans.push_back({2, 0, text, 0, 4});
  r.spans.push_back({1, 0, text, 25, 29});
  return w;
}

inline std::vector<std::byte> small_plan() {
  Writer w = small_writer();
  auto bytes = w.finish();
  return bytes.ok() ? *bytes : std::vector<std::byte>{};
}

}  // namespace probe::plan
