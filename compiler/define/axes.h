// What differs between a variant and its baseline, and what lies outside the training data.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/diag/diagnostic.h"
#include "compiler/model/model.h"
#include "compiler/syntax/ast.h"
#include "runtime/plan/axes.h"

namespace probe::sema {

// Whether a role beside source and target is filled by other objects.
bool other_moves(const Model& model, const Task& task, const Task& baseline, RoleId role);

// A mask of plan::Axis over the normalised records; names do not count. Both are complete: what they
// say is in Task::prompt.
std::uint32_t axes_between(const Model& model, const Task& task, const Task& baseline);
// Whether that is any.
bool differs(const Model& model, const Task& task, const Task& baseline);

// The axis that a phrase names, `appearance`; reported when no phrase can move it.
std::optional<plan::Axis> phrase_axis(Diagnostics& diagnostics, const syntax::Name& word);

// Bits 1 source, 2 target, 4 relation. The relation is new only when both objects are known.
std::uint32_t out_of_distribution(const Model& model, const Task& task);

// Whether a task's instruction has what this axis of language is about: a phrase of that axis, a
// negation; another verb frame than the first task along the baselines, or its frame in other
// words. No axis beside those of language is used.
bool uses(const Model& model, const Task& task, plan::Axis axis);

}  // namespace probe::sema
