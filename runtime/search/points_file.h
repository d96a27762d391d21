// Points of a space compiled: one text, one frozen plan, and which of them are fair.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "compiler/space/points.h"
#include "runtime/plan/plan.h"
#include "runtime/search/base_task.h"

namespace probe::search {

class StoredPoints;

// One point, as it came out.
struct PlannedPoint {
  space::Point point;
  std::optional<std::uint32_t> task;  // of the plan's tasks; none: left out
  // Of the base task's starts those in which it is fair, by their numbers there; the plan's task
  // has them as its starts 0, 1, ...
  std::vector<std::uint32_t> starts;
  std::string why;  // it is left out, or some of its starts are: the compiler's first word
  // The point with the same things in the same places and nothing else changed, which the expert is
  // asked of: of `points`, or kBase.
  std::size_t proof = 0;
};
inline constexpr std::size_t kBase = static_cast<std::size_t>(-1);

struct PlannedPoints {
  plan::Plan plan;  // its suite `points` has the base task and all points that are fair
  std::uint32_t base_task = 0;
  std::vector<PlannedPoint> points;  // those that were asked for, then others that prove them
  AssetRoot assets;                  // where the plan's files lie
};

// Writes `folder`/points.probe with its tables and points.csv, which says what each task changes.
// A point that the compiler refuses is left out, with the reason; one that moves things, start by
// start. What `stored` has of it is not compiled again. Fails (kUsage) where the base task itself
// is refused there.
Result<PlannedPoints> plan_points(const BaseTask& base, std::vector<space::Point> points,
                                  StoredPoints& stored, const std::string& folder);

// As a `use` in a file of `folder` says `file`. A way up through a link would lead elsewhere.
std::string use_of(const std::string& file, const std::string& folder);

// A point that is kept as a text, and what a comment says of it.
struct KeptPoint {
  space::Point point;
  std::string remark;
};
// The text as one writes it to keep: `file` with its tables beside it, a suite `found`.
Status write_found(const BaseTask& base, const std::vector<KeptPoint>& kept,
                   const std::string& file);

}  // namespace probe::search
