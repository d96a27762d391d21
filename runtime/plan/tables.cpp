#include "runtime/plan/tables.h"

#include <array>

namespace probe::plan {
namespace {

constexpr std::array kSections = {
    SectionInfo{Section::kStrings, "STRS", 1, false},
    SectionInfo{Section::kList, "LIST", 4, false},
    SectionInfo{Section::kReals, "REAL", 8, false},
    SectionInfo{Section::kAssets, "ASST", sizeof(AssetRecord), false},
    SectionInfo{Section::kObjects, "OBJT", sizeof(ObjectRecord), false},
    SectionInfo{Section::kRobots, "ROBT", sizeof(RobotRecord), false},
    SectionInfo{Section::kDrives, "DRIV", sizeof(DriveRecord), false},
    SectionInfo{Section::kCameras, "CAMR", sizeof(CameraRecord), false},
    SectionInfo{Section::kLights, "LITE", sizeof(LightRecord), false},
    SectionInfo{Section::kSuns, "SUNS", sizeof(SunRecord), false},
    SectionInfo{Section::kScenes, "SCNE", sizeof(SceneRecord), false},
    SectionInfo{Section::kConstants, "CNST", 8, false},
    SectionInfo{Section::kStates, "STAT", sizeof(StateRecord), false},
    SectionInfo{Section::kCode, "CODE", sizeof(Instruction), false},
    SectionInfo{Section::kPrograms, "PROG", sizeof(ProgramRecord), false},
    SectionInfo{Section::kMetrics, "METR", sizeof(MetricRecord), false},
    SectionInfo{Section::kBodies, "BODY", sizeof(BodyRecord), false},
    SectionInfo{Section::kPlacements, "PLAC", sizeof(PlacementRecord), false},
    SectionInfo{Section::kTasks, "TASK", sizeof(TaskRecord), false},
    SectionInfo{Section::kEpisodes, "EPIS", sizeof(EpisodeRecord), false},
    SectionInfo{Section::kSets, "SETS", sizeof(SetRecord), false},
    SectionInfo{Section::kSuites, "SUIT", sizeof(SuiteRecord), false},
    SectionInfo{Section::kViews, "VIEW", sizeof(ViewRecord), false},
    SectionInfo{Section::kSpans, "SPAN", sizeof(SpanRecord), true},
    SectionInfo{Section::kTexts, "TEXT", sizeof(TextRecord), true},
    SectionInfo{Section::kTextBytes, "TXTB", 1, true},
};

}  // namespace

std::span<const SectionInfo> all_sections() { return kSections; }

const SectionInfo* find_section(std::uint32_t kind) {
  for (const SectionInfo& info : kSections) {
    if (static_cast<std::uint32_t>(info.kind) == kind) return &info;
  }
  return nullptr;
}

}  // namespace probe::plan
