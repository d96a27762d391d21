// One metric, of a `metrics` block or of a task's `set`.
#pragma once

#include "compiler/names/context.h"

namespace probe::sema {

// Of the poison type when its expression was reported.
Metric read_metric(Context& context, const syntax::File& file, const syntax::MetricStmt& stmt);

}  // namespace probe::sema
