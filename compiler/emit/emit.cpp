#include "compiler/emit/emit.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <set>

#include "compiler/define/axes.h"
#include "compiler/emit/assets.h"
#include "compiler/lower/intervals.h"
#include "compiler/lower/lower.h"
#include "runtime/base/asset_path.h"
#include "runtime/plan/axes.h"
#include "runtime/plan/writer.h"

namespace probe::emit {
namespace {

using sema::Model;
using sema::ObjectId;
using sema::TaskId;

// OBJ first: that is how convex decompositions are stored.
constexpr std::array<std::string_view, 5> kCollisionExtensions{".obj", ".stl", ".glb", ".gltf",
                                                               ".dae"};

constexpr std::uint32_t kCodeSpan = 1, kTaskSpan = 2, kObjectSpan = 3, kMetricSpan = 4;

// Gives each used row of a table its index in the plan, in the order of first use.
template <typename Id>
class Used {
 public:
  explicit Used(std::size_t size) : index_(size, plan::kNone) {}
  // True when the row is new and its record is to be pushed.
  bool add(Id id, std::uint32_t index) {
    std::uint32_t& known = index_[static_cast<std::size_t>(id)];
    if (known != plan::kNone) return false;
    known = index;
    return true;
  }
  std::uint32_t operator[](Id id) const {
    return id == Id::kNone ? plan::kNone : index_[static_cast<std::size_t>(id)];
  }

 private:
  std::vector<std::uint32_t> index_;
};

std::uint32_t size32(const auto& table) { return static_cast<std::uint32_t>(table.size()); }

class Emitter {
 public:
  Emitter(const Model& model, const SourceSet& sources, const EmitOptions& options,
          Diagnostics& diagnostics)
      : model_(model),
        sources_(sources),
        options_(options),
        diagnostics_(diagnostics),
        assets_(options.asset_root, options.write, options.inspect_asset),
        objects_(model.objects.size()),
        robots_(model.robots.size()),
        cameras_(model.cameras.size()),
        lights_(model.lights.size()),
        scenes_(model.scenes.size()),
        tasks_(model.tasks.size()) {}

  Result<std::vector<std::byte>> run(const std::vector<FileId>& files) {
    if (options_.write) add_sources(files);
    const std::vector<TaskId> chosen = choose_tasks();
    for (std::size_t i = 0; i < chosen.size(); ++i)
      tasks_.add(chosen[i], static_cast<std::uint32_t>(i));
    for (const TaskId id : chosen) add_task(model_.tasks[id]);
    report_constants();
    report_misses(chosen);
    if (diagnostics_.has_errors() || !options_.write) return std::vector<std::byte>{};
    add_assets();
    add_sets_and_suites();
    writer_.fill_ids();
    if (!check_language_only(chosen)) return std::vector<std::byte>{};
    return writer_.finish();
  }

 private:
  plan::Records& records() { return writer_.records; }

  // ---- what goes in
  // -------------------------------------------------------------------------------------------------

  bool suite_is_kept(const sema::Suite& suite) const {
    return options_.suite.empty() || suite.name == options_.suite;
  }

  // All concrete tasks, or those of one suite with the baselines they are compared with, as
  // declared.
  std::vector<TaskId> choose_tasks() const {
    std::vector<bool> wanted(model_.tasks.size(), options_.suite.empty());
    for (const sema::Suite& suite : model_.suites) {
      if (options_.suite.empty() || suite.name != options_.suite) continue;
      for (TaskId id : suite.members) {
        for (; id != TaskId::kNone && !wanted[static_cast<std::size_t>(id)];
             id = model_.tasks[id].baseline) {
          wanted[static_cast<std::size_t>(id)] = true;
        }
      }
    }
    std::vector<TaskId> chosen;
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      const sema::Task& task = model_.tasks[static_cast<TaskId>(i)];
      const bool is_kept = !options_.wants_task || options_.wants_task(task.name);
      if (wanted[i] && is_kept && !task.abstract && task.complete) {
        chosen.push_back(static_cast<TaskId>(i));
      }
    }
    return chosen;
  }

  void add_sources(const std::vector<FileId>& files) {
    for (const FileId id : files) {
      const SourceFile& file = sources_.file(id);
      const std::filesystem::path name(file.name());
      const std::string path =
          name.lexically_normal().lexically_relative(options_.source_folder).generic_string();
      texts_[id.value] =
          writer_.source(path.empty() ? name.filename().string() : path, file.text());
    }
  }

  void add_span(std::uint32_t what, std::uint32_t index, const Span& span) {
    const auto text = texts_.find(span.file.value);
    if (text != texts_.end())
      records().spans.push_back({what, index, text->second, span.begin, span.end});
  }

  // ---- the world
  // ----------------------------------------------------------------------------------------------------

  // A folder's picture mesh and what is felt: `collision`, or the picture mesh where there is none.
  struct MeshPair {
    std::string visual, collision;
  };
  MeshPair find_meshes(const std::string& folder) const {
    MeshPair meshes{assets_.find(folder + "/visual", kMeshExtensions),
                    assets_.find(folder + "/collision", kCollisionExtensions)};
    // Where neither is there, one message is enough: that about the picture mesh.
    if (!assets_.has(meshes.collision)) meshes.collision = meshes.visual;
    return meshes;
  }

  void add_object(ObjectId id) {
    if (!objects_.add(id, size32(records().objects))) return;
    const sema::Object& object = model_.objects[id];
    plan::ObjectRecord record;
    record.name = writer_.text(object.name);
    record.text = writer_.text(object.text.text);
    const AssetOwner owner{AssetOwner::Kind::kObject, static_cast<std::uint32_t>(id)};
    const MeshPair meshes = find_meshes("objects/" + object.mesh.text);
    record.visual =
        assets_.add(meshes.visual, plan::AssetKind::kVisualMesh, object.mesh.span, owner);
    record.collision =
        assets_.add(meshes.collision, plan::AssetKind::kCollisionMesh, object.mesh.span, owner);
    record.box_min = object.box_min;
    record.box_max = object.box_max;
    record.density = object.density;
    record.friction = object.friction;
    add_span(kObjectSpan, size32(records().objects), object.span);
    records().objects.push_back(record);
  }

  void add_robot(sema::RobotId id) {
    if (!robots_.add(id, size32(records().robots))) return;
    const sema::Robot& robot = model_.robots[id];
    plan::RobotRecord record;
    record.name = writer_.text(robot.name);
    record.tcp = writer_.text(robot.tcp.text);
    const AssetOwner owner{AssetOwner::Kind::kRobot, static_cast<std::uint32_t>(id)};
    record.urdf = assets_.add(robot.urdf.text, plan::AssetKind::kUrdf, robot.urdf.span, owner);
    record.control = static_cast<std::uint32_t>(plan::Control::kEeDeltaPose);
    record.control_hz = robot.control_hz;
    for (std::size_t i = 0; i < record.fingers.size(); ++i) {
      record.fingers[i] = {writer_.text(robot.fingers[i].link.text), robot.fingers[i].opens};
    }
    record.grip_closed = robot.grip_closed;
    record.grip_open = robot.grip_open;
    record.finger_friction = robot.finger_friction;
    record.finger_patch = robot.finger_patch;
    record.link_friction = robot.link_friction;
    record.reach_min = robot.reach_min;
    record.reach_max = robot.reach_max;
    std::vector<plan::DriveRecord> drives;
    for (const sema::Drive& drive : robot.drives) {
      drives.push_back({writer_.text(drive.joint.text), drive.stiffness.si(), drive.damping.si(),
                        drive.limit.si()});
    }
    record.drives = plan::append(records().drives, std::span<const plan::DriveRecord>(drives));
    record.meshes = writer_.list(robot_meshes(robot, owner));
    records().robots.push_back(record);
  }

  // Every file the URDF names, each once, in its order.
  std::vector<std::uint32_t> robot_meshes(const sema::Robot& robot, AssetOwner owner) {
    std::vector<std::uint32_t> meshes;
    const std::filesystem::path folder = std::filesystem::path(robot.urdf.text).parent_path();
    const auto add = [&](const robot::MeshRef& mesh, plan::AssetKind kind) {
      const std::string path = (folder / mesh.path).lexically_normal().generic_string();
      const std::uint32_t index = assets_.add(path, kind, robot.urdf.span, owner);
      if (std::find(meshes.begin(), meshes.end(), index) == meshes.end()) meshes.push_back(index);
    };
    for (const robot::Link& link : robot.model->links) {
      for (const robot::MeshRef& mesh : link.visuals) add(mesh, plan::AssetKind::kVisualMesh);
      for (const robot::MeshRef& mesh : link.collisions) add(mesh, plan::AssetKind::kCollisionMesh);
    }
    return meshes;
  }

  void add_camera(sema::CameraId id) {
    if (!cameras_.add(id, size32(records().cameras))) return;
    const sema::Camera& camera = model_.cameras[id];
    plan::CameraRecord record;
    record.name = writer_.text(camera.name);
    record.mount_link = writer_.text(camera.mount_link.text);
    record.aim = static_cast<std::uint32_t>(camera.aim);
    record.width = camera.width;
    record.height = camera.height;
    record.samples = camera.samples;
    record.position = camera.position;
    record.aim_values = camera.aim_values;
    record.fx = camera.fx;
    record.fy = camera.fy;
    record.cx = camera.cx;
    record.cy = camera.cy;
    records().cameras.push_back(record);
  }

  void add_light(sema::LightId id) {
    if (!lights_.add(id, size32(records().lights))) return;
    const sema::Light& light = model_.lights[id];
    plan::LightRecord record;
    record.name = writer_.text(light.name);
    record.ambient = light.ambient;
    record.occlusion = light.occlusion;
    record.suns = plan::append(records().suns, std::span<const plan::SunRecord>(light.suns));
    records().lights.push_back(record);
  }

  std::uint32_t add_photo(const std::optional<sema::Spelled>& overlay, AssetOwner owner) {
    if (!overlay) return plan::kNone;
    return assets_.add("scenes/" + overlay->text, plan::AssetKind::kPhoto, overlay->span, owner);
  }

  void add_scene(sema::SceneId id) {
    if (!scenes_.add(id, size32(records().scenes))) return;
    const sema::Scene& scene = model_.scenes[id];
    add_robot(scene.robot);
    plan::SceneRecord record;
    record.name = writer_.text(scene.name);
    record.robot = robots_[scene.robot];
    const AssetOwner owner{AssetOwner::Kind::kScene, static_cast<std::uint32_t>(id)};
    const std::optional<sema::Spelled>& overlay = scene.views.front().overlay;
    record.photo = add_photo(overlay, owner);
    if (scene.backdrop) {
      const std::string folder = "scenes/" + scene.backdrop->text + "/";
      const Span& span = scene.backdrop->span;
      // A photo in the folder is what the camera saw there: it stands behind everything, and the
      // mesh, where there is one, only for depth and for what hides what.
      const std::string photo = assets_.find(folder + "photo", kPhotoExtensions);
      const std::string visual = assets_.find(folder + "visual", kMeshExtensions);
      const bool has_photo = assets_.has(photo);
      if (has_photo && !overlay) {
        record.photo = assets_.add(photo, plan::AssetKind::kPhoto, span, owner);
      }
      if (!has_photo || assets_.has(visual)) {
        record.backdrop = assets_.add(visual, plan::AssetKind::kVisualMesh, span, owner);
      }
    }
    if (scene.fixture) {
      const MeshPair meshes = find_meshes("fixtures/" + scene.fixture->text);
      const Span& span = scene.fixture->span;
      record.fixture_visual = assets_.add(meshes.visual, plan::AssetKind::kVisualMesh, span, owner);
      record.fixture_collision =
          assets_.add(meshes.collision, plan::AssetKind::kCollisionMesh, span, owner);
      record.fixture_position = scene.fixture_position;
    }
    record.base_position = scene.base_position;
    record.base_rotation = scene.base_turn.rotation;
    std::vector<double> joints;
    for (const sema::Quantity& joint : scene.joints) joints.push_back(joint.si());
    record.joints = writer_.reals(joints);
    record.surface_z = scene.surface_z;
    record.area = scene.area;
    record.physics_hz = scene.physics_hz;
    record.friction = scene.friction;
    records().scenes.push_back(record);
  }

  // ---- tasks
  // --------------------------------------------------------------------------------------------------------

  // Tasks of one shape share one program.
  std::uint32_t add_program(lower::Program program, std::uint64_t horizon, double control_hz) {
    for (std::size_t i = 0; i < programs_.size(); ++i) {
      if (programs_[i].same_as(program)) return static_cast<std::uint32_t>(i);
    }
    note_constants(program, horizon, control_hz);
    plan::ProgramRecord record;
    record.constants =
        plan::append(records().constants, std::span<const double>(program.constants));
    record.states =
        plan::append(records().states, std::span<const plan::StateRecord>(program.states));
    for (std::size_t i = 0; i < program.code.size(); ++i) {
      add_span(kCodeSpan, size32(records().code) + static_cast<std::uint32_t>(i), program.spans[i]);
    }
    record.code = plan::append(records().code, std::span<const plan::Instruction>(program.code));
    record.metrics = {size32(records().metrics), size32(program.metrics)};
    for (const lower::ProgramMetric& metric : program.metrics) {
      add_span(kMetricSpan, size32(records().metrics), metric.span);
      records().metrics.push_back({writer_.text(metric.name),
                                   static_cast<std::uint32_t>(metric.type),
                                   static_cast<std::uint32_t>(metric.readout)});
    }
    records().programs.push_back(record);
    programs_.push_back(std::move(program));
    return size32(programs_) - 1;
  }

  // P0603 at once; P0602 when a metric is constant in every program that has it: over the
  // distractors of a task without any it may be.
  void note_constants(const lower::Program& program, std::uint64_t horizon, double control_hz) {
    const lower::Findings findings = lower::find_constants(program, horizon, control_hz);
    for (const std::size_t at : findings.contradictions) {
      const Span& span = program.spans[at];
      if (!contradictions_.insert({span.file.value, span.begin}).second) continue;
      diagnostics_.report(Code::P0603, span, "these conditions exclude one another");
    }
    for (std::size_t i = 0; i < program.metrics.size(); ++i) {
      const auto known =
          std::find_if(findings.constants.begin(), findings.constants.end(),
                       [&](const lower::ConstantMetric& found) { return found.metric == i; });
      const Span& span = program.metrics[i].span;
      Constant& constant = constants_[{span.file.value, span.begin}];
      constant.metric = program.metrics[i];
      if (known == findings.constants.end()) {
        constant.varies = true;
      } else {
        const auto& number = known->number;
        constant.values.insert(number         ? fmt::format("{:.6g}", *number)
                               : known->value ? "true"
                                              : "false");
      }
    }
  }

  void report_constants() {
    for (const auto& [place, constant] : constants_) {
      if (constant.varies || constant.values.size() != 1) continue;
      diagnostics_.report(
          Code::P0602, constant.metric.span,
          "metric `" + constant.metric.name + "` is always " + *constant.values.begin());
    }
  }

  bool needs(const sema::Task& task, const AssetOwner& owner) const {
    switch (owner.kind) {
      case AssetOwner::Kind::kObject: {
        const std::vector<ObjectId> objects = task.objects();
        return std::find(objects.begin(), objects.end(), static_cast<ObjectId>(owner.id)) !=
               objects.end();
      }
      case AssetOwner::Kind::kScene:
        return task.scene == static_cast<sema::SceneId>(owner.id);
      case AssetOwner::Kind::kRobot:
        return model_.scenes[task.scene].robot == static_cast<sema::RobotId>(owner.id);
    }
    return false;
  }

  // Each with the tasks that cannot run without it.
  void report_misses(const std::vector<TaskId>& chosen) {
    constexpr std::size_t kNamed = 6;
    for (const AssetMiss& miss : assets_.misses()) {
      std::string names;
      std::size_t count = 0;
      for (const TaskId id : chosen) {
        if (!needs(model_.tasks[id], miss.owner) || ++count > kNamed) continue;
        names += (count == 1 ? "`" : ", `") + model_.tasks[id].name + "`";
      }
      if (count > kNamed) names += " and " + std::to_string(count - kNamed) + " more";
      diagnostics_.report(Code::P0202, miss.span, "asset `" + miss.path + "` " + miss.why)
          .note("looked for it in the assets folder `" + options_.asset_root + "`")
          .note("needed by " + names);
    }
  }

  plan::Slice add_bodies(const std::vector<lower::Body>& bodies) {
    std::vector<plan::BodyRecord> rows;
    for (const lower::Body& body : bodies) {
      const bool is_object = body.kind == plan::BodyKind::kObject;
      const std::uint32_t index =
          is_object ? objects_[static_cast<ObjectId>(body.index)] : body.index;
      rows.push_back({static_cast<std::uint32_t>(body.kind), index, writer_.text(body.name)});
    }
    return plan::append(records().bodies, std::span<const plan::BodyRecord>(rows));
  }

  // Equal starts share their placements: a variant that only changes words adds none.
  plan::Slice add_placements(const sema::Start& start, double z) {
    std::vector<plan::PlacementRecord> rows;
    std::vector<double> key;
    for (const sema::Start::Placed& placed : start.placed) {
      plan::PlacementRecord row;
      row.object = objects_[placed.object];
      row.position = {placed.x, placed.y, z};
      row.rotation = placed.turn.rotation;
      key.push_back(static_cast<double>(row.object));
      key.insert(key.end(), row.position.begin(), row.position.end());
      key.insert(key.end(), row.rotation.begin(), row.rotation.end());
      rows.push_back(row);
    }
    const auto [at, is_new] = placements_.try_emplace(std::move(key), plan::Slice{});
    if (is_new)
      at->second = plan::append(records().placements, std::span<const plan::PlacementRecord>(rows));
    return at->second;
  }

  // Tasks of one scene share them.
  plan::Slice add_views(const std::vector<sema::View>& views, sema::SceneId scene) {
    const AssetOwner owner{AssetOwner::Kind::kScene, static_cast<std::uint32_t>(scene)};
    std::vector<plan::ViewRecord> rows;
    std::vector<std::uint32_t> key;
    for (const sema::View& view : views) {
      const std::uint32_t photo =
          rows.empty() ? records().scenes[scenes_[scene]].photo : add_photo(view.overlay, owner);
      const plan::ViewRecord& row =
          rows.emplace_back(writer_.text(view.name), cameras_[view.camera], photo);
      key.insert(key.end(), {row.name.offset, row.name.length, row.camera, row.photo});
    }
    const auto [at, is_new] = views_.try_emplace(std::move(key), plan::Slice{});
    if (is_new) at->second = plan::append(records().views, std::span<const plan::ViewRecord>(rows));
    return at->second;
  }

  void add_task(const sema::Task& task) {
    const sema::Scene& scene = model_.scenes[task.scene];
    if (!model_.robots[scene.robot].model || model_.robots[scene.robot].fingers.size() != 2) return;
    for (const ObjectId id : task.objects()) add_object(id);
    add_scene(task.scene);
    const std::vector<sema::View> views = views_of(model_, task);
    for (const sema::View& view : views) add_camera(view.camera);
    add_light(light_of(model_, task));
    const std::vector<lower::Body> bodies = lower::bodies_of(model_, task);
    auto program = lower::lower_task(model_, task, bodies, diagnostics_);
    if (!program) return;

    const sema::Layout& layout = model_.layouts[task.layout];
    plan::TaskRecord record;
    record.name = writer_.text(task.name);
    record.prompt = writer_.text(task.prompt);
    record.scene = scenes_[task.scene];
    record.camera = cameras_[views.front().camera];
    if (has_names(views)) record.views = add_views(views, task.scene);
    record.light = lights_[light_of(model_, task)];
    record.program =
        add_program(std::move(*program), task.horizon, model_.robots[scene.robot].control_hz);
    record.source = objects_[task.source];
    record.target = objects_[task.target];
    record.bodies = add_bodies(bodies);
    record.distractors = size32(task.distractors);
    record.horizon = static_cast<std::uint32_t>(task.horizon);
    record.baseline = tasks_[task.baseline];
    record.axes = record.baseline == plan::kNone ? 0 : task.axes;
    record.ood = task.ood;
    if (task.allow_confounded) record.allow = writer_.text(*task.allow_confounded);
    record.drop = layout.drop;
    record.settle = layout.settle;
    const std::uint32_t index = size32(records().tasks);
    record.episodes = {size32(records().episodes), size32(task.starts)};
    for (std::size_t e = 0; e < task.starts.size(); ++e) {
      plan::EpisodeRecord episode;
      episode.task = index;
      episode.index = static_cast<std::uint32_t>(e);
      episode.placements = add_placements(task.starts[e], scene.surface_z + layout.drop);
      records().episodes.push_back(episode);
    }
    add_span(kTaskSpan, index, task.span);
    records().tasks.push_back(record);
  }

  void add_assets() {
    for (const Asset& asset : assets_.assets()) {
      plan::AssetRecord record;
      record.path = writer_.text(asset.path);
      record.kind = static_cast<std::uint32_t>(asset.kind);
      record.byte_size = asset.byte_size;
      record.sha256 = asset.hash.bytes;
      records().assets.push_back(record);
    }
  }

  plan::Slice add_members(const std::vector<TaskId>& members) {
    std::vector<std::uint32_t> indices;
    for (const TaskId id : members) {
      if (tasks_[id] != plan::kNone) indices.push_back(tasks_[id]);
    }
    return writer_.list(indices);
  }

  void add_sets_and_suites() {
    for (const sema::TaskSet& set : model_.sets) {
      plan::SetRecord record;
      record.name = writer_.text(set.name);
      record.members = add_members(set.members);
      records().sets.push_back(record);
    }
    for (const sema::Suite& suite : model_.suites) {
      if (!suite_is_kept(suite)) continue;
      plan::SuiteRecord record;
      record.name = writer_.text(suite.name);
      record.prefix = writer_.text(suite.prefix);
      if (suite.trained_on != sema::DatasetId::kNone) {
        record.trained_on = writer_.text(model_.datasets[suite.trained_on].name);
      }
      record.members = add_members(suite.members);
      record.seeds = writer_.list(suite.seeds);
      records().suites.push_back(record);
    }
  }

  // P0704: "only the language changed" is an equality of ids, episode by episode.
  bool check_language_only(const std::vector<TaskId>& chosen) {
    bool ok = true;
    for (std::size_t i = 0; i < records().tasks.size(); ++i) {
      const plan::TaskRecord& task = records().tasks[i];
      if (task.baseline == plan::kNone || task.axes == 0 || (task.axes & ~plan::kLanguageAxes) != 0)
        continue;
      const plan::TaskRecord& baseline = records().tasks[task.baseline];
      bool same =
          task.judge_id == baseline.judge_id && task.episodes.count == baseline.episodes.count;
      for (std::uint32_t e = 0; same && e < task.episodes.count; ++e) {
        same = records().episodes[task.episodes.first + e].start_id ==
               records().episodes[baseline.episodes.first + e].start_id;
      }
      if (same) continue;
      ok = false;
      const sema::Task& written = model_.tasks[chosen[i]];
      diagnostics_.report(
          Code::P0704, written.span,
          "`" + written.name +
              "` changes only language, but its starts or its judgement differ from its baseline");
    }
    return ok;
  }

  const Model& model_;
  const SourceSet& sources_;
  const EmitOptions& options_;
  Diagnostics& diagnostics_;
  AssetTable assets_;
  plan::Writer writer_;
  std::map<std::uint32_t, std::uint32_t> texts_;  // FileId -> kTexts
  Used<ObjectId> objects_;
  Used<sema::RobotId> robots_;
  Used<sema::CameraId> cameras_;
  Used<sema::LightId> lights_;
  Used<sema::SceneId> scenes_;
  Used<TaskId> tasks_;
  std::vector<lower::Program> programs_;
  struct Constant {
    lower::ProgramMetric metric;
    bool varies = false;
    std::set<std::string> values;
  };
  std::map<std::pair<std::uint32_t, std::uint32_t>, Constant> constants_;  // by file and place
  std::set<std::pair<std::uint32_t, std::uint32_t>> contradictions_;
  std::map<std::vector<double>, plan::Slice> placements_;
  std::map<std::vector<std::uint32_t>, plan::Slice> views_;
};

}  // namespace

Result<std::vector<std::byte>> emit(const Model& model, const SourceSet& sources,
                                    const std::vector<FileId>& files, const EmitOptions& options,
                                    Diagnostics& diagnostics) {
  return Emitter(model, sources, options, diagnostics).run(files);
}

}  // namespace probe::emit
