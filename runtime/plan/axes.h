// What a variant can differ in from its baseline, made from axes.def.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "runtime/plan/format.h"

namespace probe::plan {

// The column `in`: what shows whether an axis has moved.
enum class AxisIn : std::uint8_t { kPicture, kWords, kRule };

struct AxisInfo {
  Axis axis;
  std::string_view name;  // "language.action"
  AxisIn in;
  bool is_phrase;  // moved by a phrase of an object that names it

  constexpr bool is_language() const { return in == AxisIn::kWords; }
  // "action": what stands behind the dot, or all of it.
  constexpr std::string_view word() const { return name.substr(name.rfind('.') + 1); }
};

// In the order in which they are listed everywhere.
inline constexpr std::array kAxisTable = {
#define PROBE_AXIS(bit, name, text, in, is_phrase) \
  AxisInfo{Axis::k##name, text, AxisIn::k##in, is_phrase},
#include "runtime/plan/axes.def"
};

constexpr std::uint32_t bit(Axis axis) { return static_cast<std::uint32_t>(axis); }
constexpr bool moves(std::uint32_t mask, Axis axis) { return (mask & bit(axis)) != 0; }

inline constexpr std::uint32_t kAllAxes = [] {
  std::uint32_t mask = 0;
  for (const AxisInfo& info : kAxisTable) mask |= bit(info.axis);
  return mask;
}();
inline constexpr std::uint32_t kLanguageAxes = [] {
  std::uint32_t mask = 0;
  for (const AxisInfo& info : kAxisTable) mask |= info.is_language() ? bit(info.axis) : 0;
  return mask;
}();

constexpr const AxisInfo& info(Axis axis) {
  std::size_t at = 0;
  while (kAxisTable[at].axis != axis) ++at;
  return kAxisTable[at];
}
constexpr std::string_view axis_name(Axis axis) { return info(axis).name; }

// Null when no axis is called so.
constexpr const AxisInfo* find_axis(std::string_view name) {
  for (const AxisInfo& info : kAxisTable) {
    if (info.name == name) return &info;
  }
  return nullptr;
}
// An axis of language by its short word: "negation". Null when there is none.
constexpr const AxisInfo* find_language_axis(std::string_view word) {
  for (const AxisInfo& info : kAxisTable) {
    if (info.is_language() && info.word() == word) return &info;
  }
  return nullptr;
}

// The axes of a mask, in the order of the table.
inline std::vector<Axis> axes_in(std::uint32_t mask) {
  std::vector<Axis> axes;
  for (const AxisInfo& info : kAxisTable) {
    if (moves(mask, info.axis)) axes.push_back(info.axis);
  }
  return axes;
}
inline std::vector<std::string_view> axis_names(std::uint32_t mask) {
  std::vector<std::string_view> names;
  for (const Axis axis : axes_in(mask)) names.push_back(axis_name(axis));
  return names;
}

// The bits of TaskRecord::ood, from the lowest: what was not seen in training.
inline constexpr std::array<std::string_view, 3> kNovelty = {"source", "target", "relation"};

}  // namespace probe::plan
