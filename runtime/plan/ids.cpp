#include "runtime/plan/ids.h"

#include <cmath>

#include "runtime/plan/fixtures.h"
#include "runtime/plan/later.h"
#include "runtime/plan/questions.h"
#include "runtime/plan/roles.h"

namespace probe::plan {
namespace {

// Each kind of id begins with its own word, so that no encoding of one is an encoding of another.
// The number is the version of the encoding; changing an encoding means raising it.
Hasher tagged(std::string_view tag) {
  Hasher hasher;
  hasher.text(tag);
  return hasher;
}

void hash_constants(Hasher& h, std::span<const double> constants) {
  // By bit pattern, not by value: 0.0 and -0.0 are different constants to MUL.
  h.u32(static_cast<std::uint32_t>(constants.size())).bytes(std::as_bytes(constants));
}

void hash_sensor(Hasher& h, const SensorRecord& s) {
  h.text("sensor").f64(s.noise).f64(s.blur).f64(s.exposure).f64s(s.patch).f64(s.dropped);
  h.u32(s.mirrored);
}

}  // namespace

Sha256 root_hash(const Header& header, std::span<const DirectoryEntry> directory) {
  Hasher h = tagged("vlaprobe.root.1");
  h.u32(header.major).u32(header.minor);
  for (const DirectoryEntry& entry : directory) {
    if ((entry.flags & kIgnorable) != 0) continue;
    h.u32(entry.kind).u32(entry.version).u32(entry.flags);
    h.u64(entry.size).u32(entry.count).u32(entry.stride).hash(to_sha256(entry.sha256));
  }
  return h.finish();
}

Sha256 prompt_id(std::string_view prompt) {
  return tagged("vlaprobe.prompt.1").text(prompt).finish();
}

Sha256 prompt_id(const Tables& tables, std::uint32_t task) {
  const std::string_view first = tables.text(tables.tasks[task].prompt);
  const std::span<const LaterRecord> later = later_of(tables, task);
  if (later.empty()) return prompt_id(first);
  Hasher h = tagged("vlaprobe.prompt.2");
  h.text(first).u32(static_cast<std::uint32_t>(later.size()));
  for (const LaterRecord& sentence : later)
    h.text(tables.text(sentence.text)).hash(program_hash(tables, tables.programs[sentence.program]));
  return h.finish();
}

Sha256 program_hash(const Tables& tables, const ProgramRecord& program) {
  Hasher h = tagged("vlaprobe.program.1");
  hash_constants(h, slice_of(tables.constants, program.constants));
  h.u32(program.states.count).bytes(std::as_bytes(slice_of(tables.states, program.states)));
  h.u32(program.code.count).bytes(std::as_bytes(slice_of(tables.code, program.code)));
  h.u32(program.metrics.count);
  for (const MetricRecord& metric : slice_of(tables.metrics, program.metrics)) {
    h.u32(metric.type).u32(metric.readout).text(tables.text(metric.name));
  }
  return h.finish();
}

Sha256 episode_id(const Sha256& start, const Sha256& prompt, const Sha256& judge) {
  return tagged("vlaprobe.episode.1").hash(start).hash(prompt).hash(judge).finish();
}

Sha256 question_id(const Tables& tables, const QuestionRecord& q) {
  const FamilyRecord& family = tables.families[q.family];
  Hasher h = tagged("vlaprobe.question.1");
  h.u32(family.form).u32(family.moment).u32(family.pixels).text(tables.text(q.text));
  // An end belongs to what was asked of the policy and to who judged it, not to its start alone.
  if (moment_of(family) == QuestionMoment::kEnd) {
    const TaskRecord& task = tables.tasks[q.task];
    h.hash(prompt_id(tables, q.task)).hash(to_sha256(task.judge_id));
  }
  h.u32(q.truth).u32(q.right).u32(q.a).u32(q.b);
  if (q.program == kNone) {
    h.u32(0);
  } else {
    h.u32(1).hash(program_hash(tables, tables.programs[q.program]));
  }
  h.u32(q.options.count);
  for (const OptionRecord& option : slice_of(tables.options, q.options)) {
    h.text(tables.text(option.text)).u32(option.body).u32(option.flags).u32(option.words.count);
    for (const StringRef& word : slice_of(tables.words, option.words)) h.text(tables.text(word));
  }
  return h.finish();
}

IdHasher::IdHasher(const Tables& tables)
    : tables_(tables),
      programs_(tables.programs.size()),
      objects_(tables.objects.size()),
      scenes_(tables.scenes.size()),
      cameras_(tables.cameras.size()),
      lights_(tables.lights.size()) {}

Sha256 IdHasher::asset(std::uint32_t index) const {
  // An absent file hashes like no file that exists: its size is given as well.
  if (index == kNone) return tagged("vlaprobe.asset.none").finish();
  const AssetRecord& record = tables_.assets[index];
  return tagged("vlaprobe.asset.1").u64(record.byte_size).hash(to_sha256(record.sha256)).finish();
}

Sha256 IdHasher::program(std::uint32_t index) {
  std::optional<Sha256>& known = programs_[index];
  if (!known) known = program_hash(tables_, tables_.programs[index]);
  return *known;
}

Sha256 IdHasher::object(std::uint32_t index) {
  std::optional<Sha256>& known = objects_[index];
  if (known) return *known;
  const ObjectRecord& o = tables_.objects[index];
  Hasher h = tagged("vlaprobe.object.1");
  h.hash(asset(o.visual)).hash(asset(o.collision)).f64s(o.box_min).f64s(o.box_max);
  h.f64(o.density).f64(o.friction);
  // Behind all else, so that objects without them keep their ids.
  if (o.scale != 0) h.text("scale").f64(o.scale);
  if (o.paint[3] != 0) h.text("paint").bytes(std::as_bytes(std::span(o.paint)));
  if (o.cover.count != 0) hash_covers(h, o.cover);
  if (o.mass.count != 0) {
    const MassRecord& mass = tables_.masses[o.mass.first];
    h.text("mass").f64(mass.mass).f64s(mass.centre).f64s(mass.inertia);
  }
  if (o.damping.count != 0) {
    const DampingRecord& damping = tables_.dampings[o.damping.first];
    h.text("damping").f64(damping.shift).f64(damping.turn);
  }
  known = h.finish();
  return *known;
}

void IdHasher::hash_covers(Hasher& h, const Slice& covers) const {
  h.text("texture").u32(covers.count);
  for (const CoverRecord& cover : slice_of(tables_.covers, covers))
    h.u32(cover.what).hash(asset(cover.texture)).f64(cover.side);
}

// Link and joint names are references into the URDF's content and so are part of what is simulated.
// The rate and the control law stand in the judge id; reach is a static check and stands in none.
Sha256 IdHasher::robot(const RobotRecord& r) const {
  // What only some robots have is part of a second version, so that the others keep their ids.
  const bool more = r.gears.count != 0 || r.more_fingers.count != 0;
  Hasher h = tagged(more ? "vlaprobe.robot.2" : "vlaprobe.robot.1");
  if (more) {
    h.u32(r.gears.count);
    for (const GearRecord& gear : slice_of(tables_.gears, r.gears))
      h.f64(gear.friction).f64(gear.armature);
    h.u32(r.more_fingers.count);
    for (const FingerRecord& finger : slice_of(tables_.fingers, r.more_fingers))
      h.text(tables_.text(finger.link)).f64s(finger.opens);
  }
  h.hash(asset(r.urdf)).text(tables_.text(r.tcp));
  h.u32(r.meshes.count);
  for (std::uint32_t mesh : slice_of(tables_.list, r.meshes)) h.hash(asset(mesh));
  for (const FingerRecord& finger : r.fingers) h.text(tables_.text(finger.link)).f64s(finger.opens);
  h.f64(r.grip_closed).f64(r.grip_open);
  h.f64(r.finger_friction).f64(r.finger_patch).f64(r.link_friction);
  h.u32(r.drives.count);
  for (const DriveRecord& drive : slice_of(tables_.drives, r.drives)) {
    h.text(tables_.text(drive.joint)).f64(drive.stiffness).f64(drive.damping).f64(drive.limit);
  }
  return h.finish();
}

// Where its joints begin is the start's.
Sha256 IdHasher::fixture(const FixtureRecord& f) const {
  Hasher h = tagged("vlaprobe.fixture.1");
  h.hash(asset(f.urdf)).u32(f.meshes.count);
  for (const std::uint32_t mesh : slice_of(tables_.list, f.meshes)) h.hash(asset(mesh));
  h.f64s(f.position).f64s(f.rotation).f64(f.friction).u32(f.joints.count);
  for (const FixtureJointRecord& joint : slice_of(tables_.fixture_joints, f.joints)) {
    h.text(tables_.text(joint.joint)).u32(joint.motion).f64(joint.lower).f64(joint.upper);
    h.f64(joint.friction).f64(joint.damping).f64(joint.stiffness).f64(joint.rest);
  }
  if (f.armatures.count != 0) h.text("armature").f64s(slice_of(tables_.reals, f.armatures));
  if (f.shown.count != 0) {
    h.text("shown").u32(f.shown.count);
    for (const ShownRecord& shown : slice_of(tables_.shown, f.shown))
      h.text(tables_.text(shown.link)).u32(shown.joint).u32(shown.side).f64(shown.at);
  }
  return h.finish();
}

// All of a scene but its robot.
void IdHasher::hash_surroundings(Hasher& h, const SceneRecord& s) const {
  h.hash(asset(s.photo)).hash(asset(s.backdrop));
  h.hash(asset(s.fixture_visual)).hash(asset(s.fixture_collision)).f64s(s.fixture_position);
  h.f64s(s.base_position).f64s(s.base_rotation);
  h.u32(s.joints.count).f64s(slice_of(tables_.reals, s.joints));
  h.f64(s.surface_z).f64s(s.area).f64(s.physics_hz).f64(s.friction);
  // Behind all else, so that scenes without them keep their ids.
  if (s.fixtures.count != 0) {
    h.u32(s.fixtures.count);
    for (const std::uint32_t index : slice_of(tables_.list, s.fixtures))
      h.hash(fixture(tables_.fixtures[index]));
  }
  if (s.air_density != 0 || s.air_viscosity != 0)
    h.text("air").f64(s.air_density).f64(s.air_viscosity);
  if (s.covers.count != 0) hash_covers(h, s.covers);
  if (s.backdrop_stands != 0) h.text("stands").f64(s.backdrop_z);
}

Sha256 IdHasher::scene(std::uint32_t index) {
  std::optional<Sha256>& known = scenes_[index];
  if (known) return *known;
  const SceneRecord& s = tables_.scenes[index];
  // What only some scenes have is part of a second version, so that the others keep their ids.
  Hasher h = tagged(s.fixtures.count == 0 ? "vlaprobe.scene.1" : "vlaprobe.scene.2");
  h.hash(robot(tables_.robots[s.robot]));
  hash_surroundings(h, s);
  known = h.finish();
  return *known;
}

// What only some cameras have is part of a second version, so that the others keep their ids.
void IdHasher::hash_lens(Hasher& h, const CameraRecord& c) const {
  if (c.samples != 0) h.u32(c.samples);
  h.text(tables_.text(c.mount_link)).u32(c.aim).u32(c.width).u32(c.height);
  h.f64s(c.position).f64s(c.aim_values).f64(c.fx).f64(c.fy).f64(c.cx).f64(c.cy);
}

Sha256 IdHasher::camera(std::uint32_t index) {
  std::optional<Sha256>& known = cameras_[index];
  if (known) return *known;
  const CameraRecord& c = tables_.cameras[index];
  Hasher h = tagged(c.samples == 0 ? "vlaprobe.camera.1" : "vlaprobe.camera.2");
  hash_lens(h, c);
  for (const SensorRecord& s : slice_of(tables_.sensors, c.sensor)) hash_sensor(h, s);
  known = h.finish();
  return *known;
}

// A task with one camera is known by that camera alone. Among several, a policy tells them apart by
// name, so names count.
Sha256 IdHasher::cameras(const TaskRecord& task) {
  if (task.views.count == 0) return camera(task.camera);
  Hasher h = tagged("vlaprobe.cameras.1");
  h.u32(task.views.count);
  for (const ViewRecord& view : slice_of(tables_.views, task.views)) {
    h.text(tables_.text(view.name)).hash(camera(view.camera)).hash(asset(view.photo));
  }
  return h.finish();
}

std::optional<Sha256> IdHasher::sensors(const TaskRecord& task) const {
  Hasher h = tagged("vlaprobe.sensors.1");
  bool any = false;
  const auto add = [&](const CameraRecord& camera) {
    h.u32(camera.sensor.count);
    for (const SensorRecord& s : slice_of(tables_.sensors, camera.sensor)) {
      any = true;
      hash_sensor(h, s);
    }
  };
  if (task.views.count == 0) add(tables_.cameras[task.camera]);
  for (const ViewRecord& view : slice_of(tables_.views, task.views))
    add(tables_.cameras[view.camera]);
  if (!any) return std::nullopt;
  return h.finish();
}

Sha256 IdHasher::lenses(const TaskRecord& task) {
  if (!sensors(task)) return cameras(task);
  const auto lens = [&](const CameraRecord& c) {
    Hasher h = tagged(c.samples == 0 ? "vlaprobe.camera.1" : "vlaprobe.camera.2");
    hash_lens(h, c);
    return h.finish();
  };
  if (task.views.count == 0) return lens(tables_.cameras[task.camera]);
  Hasher h = tagged("vlaprobe.cameras.1");
  h.u32(task.views.count);
  for (const ViewRecord& view : slice_of(tables_.views, task.views)) {
    h.text(tables_.text(view.name)).hash(lens(tables_.cameras[view.camera]));
    h.hash(asset(view.photo));
  }
  return h.finish();
}

Sha256 IdHasher::surroundings_at(const SceneRecord& scene, double surface_z) const {
  SceneRecord there = scene;
  // To the nanometre: differences of heights are rounded.
  const auto above = [&](double z) { return std::nearbyint((z - scene.surface_z) * 1e9) * 1e-9; };
  if (scene.surface_z != surface_z) {
    there.base_position[2] = surface_z + above(scene.base_position[2]);
    there.fixture_position[2] = surface_z + above(scene.fixture_position[2]);
    there.surface_z = surface_z;
  }
  there.covers = {};
  Hasher h = tagged("vlaprobe.surroundings.1");
  hash_surroundings(h, there);
  return h.finish();
}

Sha256 IdHasher::light(std::uint32_t index) {
  std::optional<Sha256>& known = lights_[index];
  if (known) return *known;
  const LightRecord& l = tables_.lights[index];
  Hasher h = tagged(l.occlusion == 0 ? "vlaprobe.light.1" : "vlaprobe.light.2");
  if (l.occlusion != 0) h.u32(l.occlusion);
  h.f64(l.ambient).u32(l.suns.count);
  for (const SunRecord& sun : slice_of(tables_.suns, l.suns)) {
    h.f64s(sun.direction).f64(sun.power).u32(sun.shadow);
  }
  if (l.color != std::array<double, 3>{}) h.text("color").f64s(l.color);
  if (l.shading != 0) {
    h.text("shading").u32(l.shading).u32(l.lamps.count);
    for (const LampRecord& lamp : slice_of(tables_.lamps, l.lamps)) {
      h.u32(lamp.kind).f64s(lamp.position).f64s(lamp.direction);
      h.f64(lamp.power).f64(lamp.specular).f64(lamp.ambient);
      h.f64(lamp.cutoff).f64(lamp.exponent).f64s(lamp.fade);
    }
  }
  known = h.finish();
  return *known;
}

void IdHasher::hash_law(Hasher& h, const LawRecord& law) const {
  h.f64s(law.kp).f64s(law.damping).f64s(law.output).f64(law.null_kp).f64(law.ramp);
  h.f64(law.grip_pace).f64(law.grip_stiffness).f64(law.grip_limit).f64(law.most);
  h.u32(law.flags).u32(law.home.count).f64s(slice_of(tables_.reals, law.home));
  // Behind all else, so that laws without them keep their ids.
  if (law.arm_path[0] != 0) h.text("paths").f64s(law.arm_path).f64s(law.finger_path);
}

Sha256 IdHasher::judge(const TaskRecord& task) {
  const RobotRecord& r = tables_.robots[tables_.scenes[task.scene].robot];
  const LawRecord* law = law_of(tables_, r);
  Hasher h = tagged(law == nullptr ? "vlaprobe.judge.1" : "vlaprobe.judge.2");
  if (law != nullptr) hash_law(h, *law);
  return h.hash(program(task.program)).u32(task.horizon).u32(r.control).f64(r.control_hz).finish();
}

Sha256 IdHasher::start(const TaskRecord& task, const EpisodeRecord& episode) {
  const SceneRecord& s = tables_.scenes[task.scene];
  const bool has_joints = s.fixtures.count > 0;
  Hasher h = tagged(has_joints ? "vlaprobe.start.2" : "vlaprobe.start.1");
  h.hash(scene(task.scene)).hash(cameras(task)).hash(light(task.light));
  h.f64(task.drop).f64(task.settle).u32(episode.placements.count);
  for (const PlacementRecord& p : slice_of(tables_.placements, episode.placements)) {
    h.hash(object(p.object)).f64s(p.position).f64s(p.rotation);
  }
  if (has_joints) {
    const std::vector<double> joints = joint_starts_of(tables_, s, episode);
    h.u32(static_cast<std::uint32_t>(joints.size())).f64s(joints);
  }
  if (task.idle != 0) hash_idle(h, task);
  if (episode.arm.count != 0) h.text("arm").f64s(slice_of(tables_.reals, episode.arm));
  if (episode.shaken.count != 0) h.text("shaken").f64s(slice_of(tables_.reals, episode.shaken));
  if (task.delay != 0) h.text("delay").u32(task.delay);
  if (task.moves.count != 0) hash_moves(h.text("moves"), task);
  return h.finish();
}

void IdHasher::hash_moves(Hasher& h, const TaskRecord& task) const {
  h.u32(task.moves.count);
  for (const MoveRecord& leg : slice_of(tables_.moves, task.moves))
    h.u32(leg.body).u32(leg.way).f64s(leg.to).f64(leg.speed);
}

// While it idles the robot is controlled, so its law and rate are part of where things are then.
void IdHasher::hash_idle(Hasher& h, const TaskRecord& task) const {
  const RobotRecord& r = tables_.robots[tables_.scenes[task.scene].robot];
  h.text("idle").u32(task.idle).u32(r.control).f64(r.control_hz);
  if (const LawRecord* law = law_of(tables_, r)) hash_law(h, *law);
}

std::vector<IdHasher::StartPart> IdHasher::start_parts(const TaskRecord& task,
                                                       const EpisodeRecord& episode) {
  const SceneRecord& s = tables_.scenes[task.scene];
  Hasher drop = tagged("vlaprobe.drop.1");
  drop.f64(task.drop).f64(task.settle);
  std::vector<StartPart> parts = {{"robot", robot(tables_.robots[s.robot])},
                                  {"scene", surroundings_at(s, s.surface_z)},
                                  {"camera", lenses(task)},
                                  {"light", light(task.light)},
                                  {"drop", drop.finish()}};
  if (task.idle != 0) {
    Hasher idle;
    hash_idle(idle, task);
    parts.push_back({"idle steps", idle.finish()});
  }
  if (const auto sensor = sensors(task)) parts.push_back({"sensor", *sensor});
  if (s.covers.count != 0) {
    Hasher covers = tagged("vlaprobe.covers.1");
    hash_covers(covers, s.covers);
    parts.push_back({"textures", covers.finish()});
  }
  if (task.delay != 0)
    parts.push_back({"delay", tagged("vlaprobe.delay.1").u32(task.delay).finish()});
  if (task.moves.count != 0) {
    Hasher moves = tagged("vlaprobe.moves.1");
    hash_moves(moves, task);
    parts.push_back({"moves", moves.finish()});
  }
  if (episode.arm.count != 0) {
    Hasher arm = tagged("vlaprobe.arm.1");
    parts.push_back({"arm", arm.f64s(slice_of(tables_.reals, episode.arm)).finish()});
  }
  if (episode.shaken.count != 0) {
    Hasher shaken = tagged("vlaprobe.shaken.1");
    parts.push_back(
        {"place of the cameras", shaken.f64s(slice_of(tables_.reals, episode.shaken)).finish()});
  }
  const TaskRoles roles = roles_of(tables_, task);
  if (s.fixtures.count > 0) {
    Hasher joints = tagged("vlaprobe.joints.1");
    joints.f64s(joint_starts_of(tables_, s, episode));
    parts.push_back({"joints of fixtures", joints.finish()});
  }
  std::uint32_t number = 0;
  for (const PlacementRecord& p : slice_of(tables_.placements, episode.placements)) {
    const std::string role = label_of_body(tables_, roles, number);
    Hasher pose = tagged("vlaprobe.pose.1");
    pose.f64s(p.position).f64s(p.rotation);
    parts.push_back({role, object(p.object)});
    parts.push_back({"pose of the " + role, pose.finish()});
    ++number;
  }
  return parts;
}

Sha256 IdHasher::prompt(std::uint32_t task) {
  if (!prompt_ || prompt_->first != task) prompt_ = {task, prompt_id(tables_, task)};
  return prompt_->second;
}

Sha256 IdHasher::episode(const TaskRecord& task, const EpisodeRecord& episode) {
  return episode_id(to_sha256(episode.start_id), prompt(episode.task), to_sha256(task.judge_id));
}

}  // namespace probe::plan
