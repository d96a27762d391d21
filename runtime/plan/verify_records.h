// What every record of a plan says by itself, and of which others it speaks. Of the verifier's
// second stage only.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "runtime/plan/verify_fields.h"

namespace probe::plan {

// One overload a kind of record: a section of sections.def whose record has none does not compile.
// Indices, slices and kinds of other records are checked, not what those records say, unless they
// stand in an earlier section.
class RecordCheck : FieldCheck {
 public:
  using FieldCheck::FieldCheck;

  // Every record of every section, in the order of the file.
  Status run() const;

 private:
  // Checked by those who refer into them.
  Status each(std::string_view) const { return {}; }
  Status each(std::span<const std::uint32_t>) const { return {}; }
  // By the third stage.
  Status each(std::span<const Instruction>) const { return {}; }
  Status each(std::span<const double> values) const { return check_finite(values); }
  template <typename Record>
  Status each(std::span<const Record> records) const {
    for (const Record& record : records) PROBE_TRY(check(record));
    return {};
  }

  // Not negative, and of a magnitude that friction and lengths have.
  Status check_friction(const double& value) const;
  Status check_length(const double& value, const char* what) const;

  Status check(const AssetRecord& asset) const;
  Status check(const ObjectRecord& object) const;
  Status check(const MassRecord& mass) const;
  Status check(const DampingRecord& damping) const;
  Status check(const RobotRecord& robot) const;
  Status check(const DriveRecord& drive) const;
  Status check(const LawRecord& law) const;
  Status check(const GearRecord& gear) const;
  Status check(const FingerRecord& finger) const;
  Status check(const CameraRecord& camera) const;
  Status check(const LightRecord& light) const;
  Status check(const SunRecord& sun) const;
  Status check(const LampRecord& lamp) const;
  Status check(const SensorRecord& sensor) const;
  Status check(const CoverRecord& cover) const;
  Status check(const MoveRecord& m) const;
  Status check(const SceneRecord& scene) const;
  Status check(const StateRecord& state) const;
  Status check(const ProgramRecord& program) const;
  Status check(const MetricRecord& metric) const;
  Status check(const BodyRecord& body) const;
  Status check(const PlacementRecord& placement) const;
  Status check(const RoleRecord& role) const;
  Status check(const TaskRecord& task) const;
  Status check(const ClaimRecord& claim) const;
  Status check(const LaterRecord& later) const;
  Status check(const SkillRecord& skill) const;
  Status check(const EpisodeRecord& episode) const;
  Status check(const SetRecord& set) const;
  Status check(const SuiteRecord& suite) const;
  Status check(const FixtureRecord& fixture) const;
  Status check(const FixtureJointRecord& joint) const;
  Status check(const PartRecord& part) const;
  Status check(const ShownRecord& shown) const;
  Status check(const RegionRecord& region) const;
  Status check(const TurnedRecord& turned) const;
  Status check(const ViewRecord& view) const;
  Status check(const FamilyRecord& family) const;
  Status check(const QuestionRecord& question) const;
  Status check(const OptionRecord& option) const;
  Status check(const StringRef& word) const;
  Status check(const OmissionRecord& omission) const;
  Status check(const SpanRecord& span) const;
  Status check(const TextRecord& text) const;
};

// What the records of questions say of one another and of tasks; after RecordCheck.
Status verify_questions(std::span<const std::byte> bytes, const Tables& tables);

// What robots and their laws, gears and fingers say of one another; after RecordCheck.
Status verify_robots(std::span<const std::byte> bytes, const Tables& tables);

// What the records of fixtures say of one another, of scenes and of episodes; after RecordCheck.
Status verify_fixtures(std::span<const std::byte> bytes, const Tables& tables);

// What objects, cameras, scenes and episodes say of their scales, textures, sensors and arms; after
// RecordCheck.
Status verify_variations(std::span<const std::byte> bytes, const Tables& tables);

// What skills say of their tasks; after verify_relations.
Status verify_skills(std::span<const std::byte> bytes, const Tables& tables);

// What claims say of their tasks and programs; after verify_relations.
Status verify_claims(std::span<const std::byte> bytes, const Tables& tables);

// What later sentences say of their tasks and programs; after verify_relations.
Status verify_later(std::span<const std::byte> bytes, const Tables& tables);

// What records say of one another; after RecordCheck.
Status verify_relations(std::span<const std::byte> bytes, const Tables& tables);

}  // namespace probe::plan
