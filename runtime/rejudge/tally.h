// A run for people, in a few lines a task or, of many tasks, a line each: of each condition how often
// it was true, of each number its mean and, in the lines, its extremes with the unit.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>

#include "runtime/plan/plan.h"
#include "runtime/store/results.h"

namespace probe::rejudge {

// Tasks in the order of the rows, metrics in the order of the plan. Invalid episodes count nowhere;
// the first one is named with its reason. Without a plan numbers have no units. A `first` that
// never came (-1) is counted apart.
std::string tally_text(std::span<const store::ResultRow> rows, const plan::Plan* plan);

// The same of rows that are not all there at once.
class TallyText {
 public:
  TallyText();
  ~TallyText();
  void add(const store::ResultRow& row);
  // Lines of each task; a table where they are more than kMostInLines, unless `is_long`.
  static constexpr std::size_t kMostInLines = 5;
  std::string text(const plan::Plan* plan, bool is_long = false) const;

 private:
  std::string table(const plan::Plan* plan) const;

  struct Parts;
  std::unique_ptr<Parts> parts_;
};

// The plan that a results folder keeps; nothing when it cannot be read.
std::optional<plan::Plan> stored_plan(const std::string& dir);

}  // namespace probe::rejudge
