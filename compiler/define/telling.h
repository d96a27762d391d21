// A task whose instruction changes in the course of the episode, as each of its sentences tells it.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/model/model.h"

namespace probe::sema {

// What the condition of a later sentence is called as a metric.
inline constexpr std::string_view kWhenMetric = "when";

std::size_t sentence_count(const Task& task);

// The task as if it said this sentence alone, 0 being its first. What one asks for before another
// comes is done where that one comes: its condition counts as success, too.
Task telling(const Task& task, std::size_t sentence);

// Calls `check` for the task, or for each of its tellings where its instruction changes.
template <typename Check>
void for_each_telling(const Task& task, Check check) {
  if (task.later.empty()) return check(task);
  for (std::size_t i = 0; i < sentence_count(task); ++i) check(telling(task, i));
}

// What is measured of its episodes: its metrics, and the conditions of later sentences.
std::vector<const Metric*> measured_in(const Task& task);

// Whether the same brings the later sentences of two tasks, which are as many.
bool same_turns(const Model& model, const Task& a, const Task& b);

// All that is said, in one line: "open the drawer, then put the can into it".
std::string whole_prompt(const Task& task);

}  // namespace probe::sema
