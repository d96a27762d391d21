#include "runtime/plan/tables.h"

#include <array>

namespace probe::plan {
namespace {

constexpr std::array kSections = {
#define PROBE_SECTION(kind, name, tag, Record, member, may_be_ignored) \
  SectionInfo{Section::k##name, tag, sizeof(Record), may_be_ignored},
#include "runtime/plan/sections.def"
};

constexpr bool ascending_kinds() {
  for (std::size_t i = 1; i < kSections.size(); ++i) {
    if (kSections[i - 1].kind >= kSections[i].kind) return false;
  }
  return true;
}
static_assert(ascending_kinds(), "sections.def ascends by kind and repeats none");

}  // namespace

std::size_t finger_count(const RobotRecord& robot) {
  std::size_t count = robot.more_fingers.count;
  for (const FingerRecord& finger : robot.fingers) count += finger.link.length == 0 ? 0 : 1;
  return count;
}

std::vector<FingerRecord> fingers_of(const Tables& tables, const RobotRecord& robot) {
  std::vector<FingerRecord> fingers;
  for (const FingerRecord& finger : robot.fingers) {
    if (finger.link.length != 0) fingers.push_back(finger);
  }
  const auto more = slice_of(tables.fingers, robot.more_fingers);
  fingers.insert(fingers.end(), more.begin(), more.end());
  return fingers;
}

const LawRecord* law_of(const Tables& tables, const RobotRecord& robot) {
  return robot.law.count == 0 ? nullptr : &tables.laws[robot.law.first];
}

std::span<const SectionInfo> all_sections() { return kSections; }

const SectionInfo* find_section(std::uint32_t kind) {
  for (const SectionInfo& info : kSections) {
    if (static_cast<std::uint32_t>(info.kind) == kind) return &info;
  }
  return nullptr;
}

}  // namespace probe::plan
