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

std::span<const SectionInfo> all_sections() { return kSections; }

const SectionInfo* find_section(std::uint32_t kind) {
  for (const SectionInfo& info : kSections) {
    if (static_cast<std::uint32_t>(info.kind) == kind) return &info;
  }
  return nullptr;
}

}  // namespace probe::plan
