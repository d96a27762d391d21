// A run whose episodes are exported: which of them, and what they have in common with others'.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/export/dataset/dataset.h"
#include "runtime/export/dataset/demonstration.h"
#include "runtime/plan/plan.h"
#include "runtime/store/results.h"

namespace probe::dataset {

struct Source {
  std::string dir;     // as it was named
  std::string policy;  // who acted
  // The expert, pushed off its way in some steps: store::RunIdentity says so, whatever rows call
  // it.
  bool is_pushed = false;
  plan::Plan plan;
  std::vector<store::ResultRow> rows;  // those that are wanted, in the stored order
  std::vector<std::uint32_t> tasks;    // of these rows, ascending
  // store::RunIdentity::until: how many episodes there are depends on how they ended.
  std::string until = {};
};

bool is_success(const store::ResultRow& row);

// A task's cameras as policies see them.
std::vector<CameraShape> cameras_of(const plan::Plan& plan, const plan::TaskRecord& task);

// Why the action that the row's trace has at a step is not what was done at the picture of that
// step, so that nobody should learn it: its world did not wait for the policy, or its task's
// actions act late. Nothing: it is.
std::optional<std::string> lateness(const plan::Plan& plan, const store::ResultRow& row);

// The valid episodes of the run in `dir` that the options name, whose actions answer their pictures
// and whose traces are not among `taken`, to which theirs are added; what else there was is told in
// `left_out`. Fails (kStore) when there is no run.
Result<Source> open_source(const std::string& dir, const DatasetOptions& options,
                           std::set<std::string>& taken, std::vector<std::string>& left_out);

// What all tasks of the sources have; fails (kUsage) naming two that differ in it, an unknown
// camera, and a control rate that is no whole number.
Result<Shape> shape_of(const std::vector<Source>& sources, const DatasetOptions& options);

}  // namespace probe::dataset
