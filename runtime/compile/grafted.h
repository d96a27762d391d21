// A stored run's plan with the metrics of a text behind its own: what `judge --with`, `results
// --events` and `report` read runs by that were made without them.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "compiler/emit/graft.h"
#include "runtime/base/asset_root.h"
#include "runtime/plan/plan.h"
#include "runtime/rejudge/events.h"

namespace probe::compile {

inline constexpr char kEventsText[] = "std/events.probe";

// What `path` says when it is a text of metrics alone, looked for as it is named and then in the
// standard library; nothing when it is another text or a plan, or has a mistake.
// `assets` and `library` as of FilesRequest.
std::optional<AnalyzedText> metrics_text(const std::string& path, const AssetRoot& assets = {},
                                         const std::string& library = {});

struct GraftedPlan {
  plan::Plan plan;
  rejudge::EventMetrics metrics;        // by the sets of the text: `progress` are the subgoals
  std::vector<MetricLeftOut> left_out;  // by tasks that lack what they measure
};
Result<GraftedPlan> graft(const plan::Plan& stored, AnalyzedText text);

// Of these tasks alone, by name: nobody wants to hear of those that are not told of.
std::vector<MetricLeftOut> of_tasks(std::vector<MetricLeftOut> left_out,
                                    const std::set<std::string>& tasks);

// "metric `placed_it` is left out of 3 tasks, such as open_top: ...".
std::string to_text(const MetricLeftOut& out);

}  // namespace probe::compile
