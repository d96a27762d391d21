// A verified plan, mapped read-only and used in place. Nothing of a file is believed before
// verify() has passed, and afterwards no accessor can fail on its content. Views live as long as
// the Plan, also across a move of it.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/base/sha256.h"
#include "runtime/plan/format.h"
#include "runtime/plan/tables.h"
#include "runtime/plan/verify.h"

namespace probe::plan {

class Plan {
 public:
  // Fails with kIo when the file cannot be read, with kPlan when it breaks a rule of
  // FORMAT.md; `where` starts with the path. The file must not be changed while the plan lives
  // (write a new one and rename it).
  static Result<Plan> open(const std::string& path, const VerifyOptions& options = {});
  static Result<Plan> from_bytes(std::vector<std::byte> bytes, const VerifyOptions& options = {});

  Plan(Plan&&) noexcept;
  Plan& operator=(Plan&&) noexcept;
  Plan(const Plan&) = delete;
  Plan& operator=(const Plan&) = delete;
  ~Plan();

  // The content address of the suite: equal with and without sources inside.
  Sha256 root() const;
  std::span<const std::byte> bytes() const;
  bool has_sources() const { return !tables_.texts.empty(); }

  const Tables& tables() const { return tables_; }
  std::string_view text(StringRef ref) const { return tables_.text(ref); }
  // The records of each section under its member's name in sections.def: tasks(), objects() ...
#define PROBE_SECTION(kind, name, tag, Record, member, may_be_ignored) \
  View<Record> member() const { return tables_.member; }
#include "runtime/plan/sections.def"

  std::span<const DriveRecord> drives(const RobotRecord& robot) const;
  std::span<const GearRecord> gears(const RobotRecord& robot) const;  // one per drive, or none
  std::vector<FingerRecord> fingers(const RobotRecord& robot) const {
    return fingers_of(tables_, robot);
  }
  const LawRecord* law(const RobotRecord& robot) const { return law_of(tables_, robot); }
  std::span<const double> home(const LawRecord& law) const;
  std::span<const std::uint32_t> meshes(const RobotRecord& robot) const;  // indices of assets()
  std::span<const SunRecord> suns(const LightRecord& light) const;
  std::span<const LampRecord> lamps(const LightRecord& light) const {
    return slice_of(tables_.lamps, light.lamps);
  }
  // Null: a picture as it is.
  const SensorRecord* sensor(const CameraRecord& camera) const {
    return camera.sensor.count == 0 ? nullptr : &tables_.sensors[camera.sensor.first];
  }
  // Null: by its density.
  const MassRecord* mass(const ObjectRecord& object) const {
    return object.mass.count == 0 ? nullptr : &tables_.masses[object.mass.first];
  }
  // Null: none of its own.
  const DampingRecord* damping(const ObjectRecord& object) const {
    return object.damping.count == 0 ? nullptr : &tables_.dampings[object.damping.first];
  }
  std::span<const ShownRecord> shown(const FixtureRecord& fixture) const {
    return slice_of(tables_.shown, fixture.shown);
  }
  // By joint; empty: none has any.
  std::span<const double> armatures(const FixtureRecord& fixture) const {
    return slice_of(tables_.reals, fixture.armatures);
  }
  // Null: the object looks as its mesh does.
  const CoverRecord* cover(const ObjectRecord& object) const {
    return object.cover.count == 0 ? nullptr : &tables_.covers[object.cover.first];
  }
  std::span<const CoverRecord> covers(const SceneRecord& scene) const {
    return slice_of(tables_.covers, scene.covers);
  }
  std::span<const double> joints(const SceneRecord& scene) const;
  // Where an episode's robot begins, in drive order: as its scene says, or as its start does.
  std::span<const double> joints(const SceneRecord& scene, const EpisodeRecord& episode) const {
    return episode.arm.count == 0 ? joints(scene) : slice_of(tables_.reals, episode.arm);
  }
  std::span<const std::uint32_t> fixtures(const SceneRecord& scene) const;  // indices of fixtures()
  std::span<const FixtureJointRecord> joints(const FixtureRecord& fixture) const;
  std::span<const PartRecord> parts(const FixtureRecord& fixture) const;
  std::span<const std::uint32_t> meshes(const FixtureRecord& fixture) const;
  std::span<const double> constants(const ProgramRecord& program) const;
  std::span<const StateRecord> states(const ProgramRecord& program) const;
  std::span<const Instruction> code(const ProgramRecord& program) const;
  std::span<const MetricRecord> metrics(const ProgramRecord& program) const;
  std::span<const MetricRecord> metrics(const TaskRecord& task) const;
  std::span<const BodyRecord> bodies(const TaskRecord& task) const;
  std::span<const EpisodeRecord> episodes(const TaskRecord& task) const;
  std::span<const PlacementRecord> placements(const EpisodeRecord& episode) const;
  std::span<const std::uint32_t> members(const SetRecord& set) const;      // indices of tasks()
  std::span<const std::uint32_t> members(const SuiteRecord& suite) const;  // indices of tasks()
  std::span<const std::uint32_t> seeds(const SuiteRecord& suite) const;
  // Which of a member's episodes a suite runs: their numbers in the task, ascending.
  std::vector<std::uint32_t> episodes(const SuiteRecord& suite, std::uint32_t task) const;
  std::size_t episode_count(const SuiteRecord& suite) const;  // of all its members
  // Every camera of the task, at least one, the first first: also where the plan stores no views.
  std::vector<ViewRecord> views(const TaskRecord& task) const;

  // Index of the task called `name`, or called so after the prefix of some suite
  // ("widowx_carrot_on_plate").
  std::optional<std::uint32_t> find_task(std::string_view name) const;
  std::optional<std::uint32_t> find_suite(std::string_view name) const;
  std::optional<std::uint32_t> find_set(std::string_view name) const;
  // Index among metrics(task).
  std::optional<std::uint32_t> find_metric(const TaskRecord& task, std::string_view name) const;

  // Index among metrics(task) of the one at which episodes end; none where they last the horizon.
  std::optional<std::uint32_t> ends_metric(const TaskRecord& task) const;

  // Where something was written; none when unknown or stripped.
  std::span<const SpanRecord> spans_of(SpanKind what, std::uint32_t index) const;
  // The first of these, or null.
  const SpanRecord* span_of(SpanKind what, std::uint32_t index) const;

 private:
  class Storage;  // a mapping or a vector
  explicit Plan(std::unique_ptr<Storage> storage);
  static Result<Plan> adopt(std::unique_ptr<Storage> storage, const VerifyOptions& options);

  std::unique_ptr<Storage> storage_;
  Tables tables_;
};

}  // namespace probe::plan
