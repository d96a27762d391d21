// A `space`: what may vary about a task, along which axes, how far. A search goes through it.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/model/ids.h"
#include "compiler/source/source.h"

namespace probe::sema {

enum class SpaceAxisKind : std::uint8_t {
#define PROBE_SPACE_AXIS(Name, label, unit, per_si, how, moves) k##Name,
#include "compiler/model/space_axes.def"
};
enum class Spacing : std::uint8_t { kEven, kRatio, kWhole, kChoice };

struct SpaceAxisInfo {
  std::string_view label, unit;
  double per_si = 1;
  Spacing spacing = Spacing::kEven;
  bool moves_things = false;
};
const SpaceAxisInfo& info_of(SpaceAxisKind kind);

struct SpaceAxis {
  SpaceAxisKind kind = SpaceAxisKind::kAmbient;
  std::string name;  // "camera.third_view.x", one in its space
  Span span;
  // SI; of `power` and `exposure` factors, of `delay` control steps, of choices their numbers. What
  // the task itself has lies between the two, at either end too.
  double low = 0, high = 0, own = 0;
  std::uint32_t view = 0;             // of a camera's: which of the task's views
  ObjectId object = ObjectId::kNone;  // what is placed
  RoleId role = RoleId::kNone;        // whose phrases
  std::vector<std::string> choices;   // as the text names them; the first is the task's own
};

struct Space {
  std::string name;
  Span span;
  TaskId of = TaskId::kNone;
  bool broken = false;            // something was reported
  std::vector<SpaceAxis> axes;    // in the order of the text
  std::vector<ObjectId> clutter;  // what lies around, in this order, over and over
};

}  // namespace probe::sema
