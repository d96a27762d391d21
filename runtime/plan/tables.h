// The tables of a plan as typed views, whoever owns the bytes: a mapped file (Plan) or vectors
// (Writer). Views never outlive that owner. Knows nothing of files, hashes or verification.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <type_traits>
#include <vector>

#include "runtime/plan/format.h"

namespace probe::plan {

// How the records of a section are seen: text as text, all others as a span.
template <typename Record>
using View =
    std::conditional_t<std::is_same_v<Record, char>, std::string_view, std::span<const Record>>;

// One member a line of sections.def.
struct Tables {
#define PROBE_SECTION(kind, name, tag, Record, member, may_be_ignored) View<Record> member;
#include "runtime/plan/sections.def"

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

// Of a robot whose record was verified. All its fingers, in the order of its first links.
std::size_t finger_count(const RobotRecord& robot);
std::vector<FingerRecord> fingers_of(const Tables& tables, const RobotRecord& robot);
// Null for ee_delta_pose, whose numbers are the robot's.
const LawRecord* law_of(const Tables& tables, const RobotRecord& robot);

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
// string_view.
template <typename AnyTables, typename Visit>
void for_each_table(AnyTables& t, Visit&& visit) {
#define PROBE_SECTION(kind, name, tag, Record, member, may_be_ignored) \
  visit(Section::k##name, t.member);
#include "runtime/plan/sections.def"
}

}  // namespace probe::plan
