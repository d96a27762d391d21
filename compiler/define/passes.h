// The passes of the analysis in the order in which analyze() runs them. Each reads names and
// earlier tables from the context, adds its own table to the model and reports what it finds wrong.
#pragma once

#include <span>

#include "compiler/names/context.h"

namespace probe::sema {

void define_catalog(Context& context);
void define_stage(Context& context);
void define_layouts(Context& context);
void define_templates(Context& context);
void define_judgement(Context& context);
void define_tasks(Context& context);
void define_sets(Context& context);
void define_suites(Context& context);

// Checks over the finished model, one file per family of codes.
void check_language(Context& context);
void check_starts(Context& context);
void check_metrics(Context& context);
void check_comparisons(Context& context);
void check_tags(Context& context);  // after the suites
void check_magnitudes(Context& context);
void check_boxes(Context& context);
// `roots`: the files named by the user rather than by `use`.
void check_unused(Context& context, std::span<const FileId> roots);

}  // namespace probe::sema
