// The emitter of one plan: the records that are being filled, and which row of the model has which
// index. One member function a construct, each in the file of its name.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "compiler/define/support.h"
#include "compiler/emit/assets.h"
#include "compiler/emit/emit.h"
#include "compiler/lower/lower.h"
#include "compiler/lower/program.h"
#include "compiler/model/model.h"
#include "runtime/plan/writer.h"

namespace probe::emit {

using sema::Model;
using sema::ObjectId;
using sema::TaskId;

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
        assets_(options.asset_root, options.inspect_asset,
                options.hashed == nullptr ? own_hashes_ : *options.hashed),
        objects_(model.objects.size()),
        robots_(model.robots.size()),
        cameras_(model.cameras.size()),
        lights_(model.lights.size()),
        scenes_(model.scenes.size()),
        tasks_(model.tasks.size()) {}

  Result<std::vector<std::byte>> run(const std::vector<FileId>& files);

 private:
  plan::Records& records() { return writer_.records; }

  bool suite_is_kept(const sema::Suite& suite) const;

  // All concrete tasks, or those of one suite with the baselines they are compared with, as
  // declared.
  std::vector<TaskId> choose_tasks() const;
  void add_sources(const std::vector<FileId>& files);
  void add_span(plan::SpanKind what, std::uint32_t index, const Span& span);

  // A folder's picture mesh and what is felt: `collision`, or the picture mesh where there is none.
  struct MeshPair {
    std::string visual, collision;
  };
  MeshPair find_meshes(const std::string& folder) const;
  void add_object(ObjectId id);
  void add_robot(sema::RobotId id);

  // Every file the URDF names, each once, in its order.
  void add_law(const sema::Robot& robot, plan::RobotRecord* record);
  std::vector<std::uint32_t> urdf_meshes(const robot::RobotModel& model, const sema::Spelled& urdf,
                                         AssetOwner owner);
  // Its record: one for each height at which scenes have it.
  std::uint32_t fixture_index(const sema::Scene& scene, sema::FixtureId id);
  // `owner`: what the names begin with.
  void add_regions(const std::vector<sema::Region>& regions, const std::string& owner,
                   plan::BodyKind kind, std::uint32_t index);
  void add_camera(sema::CameraId id);
  void add_light(sema::LightId id);
  // P0304 where the task's light is of corners and a camera asks for what that law does not have.
  void check_shading(const sema::Task& task, const std::vector<sema::View>& views);
  std::uint32_t add_photo(const std::optional<sema::Spelled>& overlay, AssetOwner owner);
  void add_scene(sema::SceneId id);

  // Tasks of one shape share one program, which is made once. Nothing when something was reported.
  // `steps`: after which it is judged.
  std::optional<std::uint32_t> add_program(const sema::Task& task,
                                           std::span<const sema::Metric> metrics,
                                           const std::vector<lower::Body>& bodies,
                                           std::uint64_t steps);
  std::uint32_t keep_program(lower::Program program);

  // P0603 at once; P0602 when a metric is constant in every program and for every horizon that has
  // it: over the distractors of a task without any it may be.
  void note_constants(const sema::Task& task, std::uint32_t program, std::uint64_t horizon, double control_hz,
                      const lower::Room& room);
  void report_constants();
  bool needs(const sema::Task& task, const AssetOwner& owner) const;

  // Each with the tasks that cannot run without it.
  void report_misses(const std::vector<TaskId>& chosen);
  plan::Slice add_bodies(const sema::Scene& scene, const std::vector<lower::Body>& bodies);

  // Equal starts share their placements: a variant that only changes words adds none.
  plan::Slice add_placements(const sema::Start& start, double z);
  // One for each start, in their order; tasks with one list of starts share the answer.
  const std::vector<plan::Slice>& placements_of(std::span<const sema::Start> starts, double z);

  // Tasks of one shape share them.
  plan::Slice add_roles(const sema::Task& task, const std::vector<lower::Body>& bodies);
  // Tasks of one scene share them.
  plan::Slice add_views(const std::vector<sema::View>& views, sema::SceneId scene);
  // P0304, once for a photo and a camera: one of another shape than the picture that it is behind.
  void check_photo(const sema::View& view, sema::SceneId scene, std::uint32_t photo);
  void add_task(const sema::Task& task);
  plan::Slice add_moves(const sema::Task& task);
  plan::Slice add_joint_starts(const sema::Task& task, const sema::Start& start);
  plan::Slice add_shakes(const std::vector<sema::View>& views, std::size_t index);
  plan::Slice add_arm_start(const sema::Task& task, std::size_t index);
  plan::Slice add_covers(const std::map<plan::CoverOf, sema::Cover>& covers, AssetOwner owner);
  // What its words say of places; `index` is the task's. Shapes that are alike share programs.
  std::uint32_t region_named(const std::string& name, plan::BodyKind kind, std::uint32_t index);
  void add_skills(const sema::Task& task, const std::vector<lower::Body>& bodies,
                  std::uint32_t index);
  // What is said in the course of the episode, with what brings it.
  void add_later(const sema::Task& task, const std::vector<lower::Body>& bodies,
                 std::uint32_t index);
  bool holds_where_it_begins(const sema::Task& task, const lower::Program& condition) const;
  void add_claims(const sema::Task& task, const std::vector<lower::Body>& bodies,
                  std::uint32_t index);
  void add_put(const sema::Task& task, const sema::Put& put, ObjectId where,
               const std::vector<lower::Body>& bodies, std::uint32_t index);
  void add_assets();
  plan::Slice add_members(const std::vector<TaskId>& members);
  void add_sets();
  void add_suites();
  plan::Slice add_drawn(const sema::Suite& suite);

  bool is_asked(sema::QuestionSetId set, TaskId task) const;
  std::map<sema::QuestionSetId, std::uint32_t> add_families();
  plan::Slice add_options(const std::vector<sema::AskedOption>& options);
  void add_questions();

  // P0704: "only the language changed" is an equality of ids, episode by episode.
  bool check_language_only(const std::vector<TaskId>& chosen);

  const Model& model_;
  const SourceSet& sources_;
  const EmitOptions& options_;
  Diagnostics& diagnostics_;
  AssetHashes own_hashes_;  // where nobody gave any
  AssetTable assets_;
  plan::Writer writer_;
  std::map<std::uint32_t, std::uint32_t> texts_;  // FileId -> kTexts
  Used<ObjectId> objects_;
  Used<sema::RobotId> robots_;
  Used<sema::CameraId> cameras_;
  Used<sema::LightId> lights_;
  std::map<std::pair<sema::FixtureId, double>, std::uint32_t> fixtures_;  // by lift
  Used<sema::SceneId> scenes_;
  Used<TaskId> tasks_;
  std::set<std::pair<sema::LightId, sema::CameraId>> shading_told_;  // by check_shading
  std::set<std::pair<std::uint32_t, sema::CameraId>> photo_told_;    // by check_photo
  std::vector<lower::Program> programs_;
  std::map<std::vector<std::uint32_t>, std::uint32_t> programs_by_shape_;  // lower::shape_of
  // Program, horizon, control rate, room.
  std::set<std::tuple<std::uint32_t, std::uint64_t, double, lower::Room>> noted_;
  struct Constant {
    lower::ProgramMetric metric;
    const sema::Task* task = nullptr;  // the first that is judged by it
    bool varies = false;
    std::set<std::string> values;
  };
  std::map<std::pair<std::uint32_t, std::uint32_t>, Constant> constants_;  // by file and place
  std::set<std::pair<std::uint32_t, std::uint32_t>> contradictions_;
  std::map<std::vector<double>, plan::Slice> placements_;
  std::map<std::vector<double>, plan::Slice> joint_starts_, arm_starts_, shakes_;
  std::map<std::pair<const sema::Start*, double>, std::vector<plan::Slice>> placement_lists_;
  std::map<std::vector<std::uint32_t>, plan::Slice> views_, roles_;
  std::map<std::vector<std::uint32_t>, std::uint32_t> claim_programs_;  // by shape
};

}  // namespace probe::emit
