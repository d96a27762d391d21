// Names and types of predicates, metrics and their expressions. Says which numbers have which
// dimension; how they are measured is the lowering's business.
#pragma once

#include "compiler/names/context.h"

namespace probe::sema {

Metric analyze_metric(Context& context, const syntax::File& file, const syntax::MetricStmt& stmt);

// The columns of measures.def.
struct MeasureInfo {
  Measure measure;
  std::string_view name;
  std::string_view params;
  char result;
  Dimension dimension;
  std::string_view meaning;
};
std::span<const MeasureInfo> all_measures();
inline const MeasureInfo& info(Measure measure) {
  return all_measures()[static_cast<std::size_t>(measure)];
}

}  // namespace probe::sema
