// The tables of a plan as typed views, whoever owns the bytes: a mapped file (Plan) or vectors
// (Writer). Views never outlive that owner. Knows nothing of files, hashes or verification.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

#include "runtime/plan/format.h"

namespace probe::plan {

struct Tables {
  std::string_view strings;
  std::span<const std::uint32_t> list;
  std::span<const double> reals;
  std::span<const AssetRecord> assets;
  std::span<const ObjectRecord> objects;
  std::span<const RobotRecord> robots;
  std::span<const DriveRecord> drives;
  std::span<const CameraRecord> cameras;
  std::span<const LightRecord> lights;
  std::span<const SunRecord> suns;
  std::span<const SceneRecord> scenes;
  std::span<const double> constants;
  std::span<const StateRecord> states;
  std::span<const Instruction> code;
  std::span<const ProgramRecord> programs;
  std::span<const MetricRecord> metrics;
  std::span<const BodyRecord> bodies;
  std::span<const PlacementRecord> placements;
  std::span<const TaskRecord> tasks;
  std::span<const EpisodeRecord> episodes;
  std::span<const SetRecord> sets;
  std::span<const SuiteRecord> suites;
  std::span<const ViewRecord> views;
  std::span<const SpanRecord> spans;
  std::span<const TextRecord> texts;
  std::string_view text_bytes;

  // Only with references that were verified, or that the same writer gave out.
  std::string_view text(StringRef ref) const { return strings.substr(ref.offset, ref.length); }
  std::string_view source(const TextRecord& t) const {
    return text_bytes.substr(t.bytes.first, t.bytes.count);
  }
  std::string_view path(const TextRecord& t) const {
    return text_bytes.substr(t.path.offset, t.path.length);
  }
};

// The records of a slice; the slice lies inside the table.
template <typename Record>
std::span<const Record> slice_of(std::span<const Record> table, Slice slice) {
  return table.subspan(slice.first, slice.count);
}

// One line a section: what the directory must say of it.
struct SectionInfo {
  Section kind;
  const char* name;  // four letters, as in FORMAT.md
  std::uint32_t stride;
  bool ignorable;
};

// All known sections, ascending by kind.
std::span<const SectionInfo> all_sections();
// Null when the kind is not known.
const SectionInfo* find_section(std::uint32_t kind);

// Calls visit(kind, table) for every table in ascending order of kind; each table is a span or
// string_view. The one place that pairs sections with members of Tables.
template <typename AnyTables, typename Visit>
void for_each_table(AnyTables& t, Visit&& visit) {
  visit(Section::kStrings, t.strings);
  visit(Section::kList, t.list);
  visit(Section::kReals, t.reals);
  visit(Section::kAssets, t.assets);
  visit(Section::kObjects, t.objects);
  visit(Section::kRobots, t.robots);
  visit(Section::kDrives, t.drives);
  visit(Section::kCameras, t.cameras);
  visit(Section::kLights, t.lights);
  visit(Section::kSuns, t.suns);
  visit(Section::kScenes, t.scenes);
  visit(Section::kConstants, t.constants);
  visit(Section::kStates, t.states);
  visit(Section::kCode, t.code);
  visit(Section::kPrograms, t.programs);
  visit(Section::kMetrics, t.metrics);
  visit(Section::kBodies, t.bodies);
  visit(Section::kPlacements, t.placements);
  visit(Section::kTasks, t.tasks);
  visit(Section::kEpisodes, t.episodes);
  visit(Section::kSets, t.sets);
  visit(Section::kSuites, t.suites);
  visit(Section::kViews, t.views);
  visit(Section::kSpans, t.spans);
  visit(Section::kTexts, t.texts);
  visit(Section::kTextBytes, t.text_bytes);
}

}  // namespace probe::plan
