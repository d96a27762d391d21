#include "compiler/model/space.h"

namespace probe::sema {

const SpaceAxisInfo& info_of(SpaceAxisKind kind) {
  static constexpr SpaceAxisInfo kTable[] = {
#define PROBE_SPACE_AXIS(Name, label, unit, per_si, how, moves) \
  {label, unit, per_si, Spacing::how, moves},
#include "compiler/model/space_axes.def"
  };
  return kTable[static_cast<std::size_t>(kind)];
}

}  // namespace probe::sema
