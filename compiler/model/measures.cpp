#include "compiler/model/measures.h"

namespace probe::sema {
namespace {

const MeasureInfo kMeasures[] = {
#define PROBE_MEASURE(id, name, params, result, length, time, angle, mass, of_start, meaning) \
  {Measure::id, name, params, result, {length, time, angle, mass, 0}, of_start, meaning},
#include "compiler/model/measures.def"
};

}  // namespace

std::span<const MeasureInfo> all_measures() { return kMeasures; }

}  // namespace probe::sema
