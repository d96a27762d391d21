// The plans of several folders as the tasks of one benchmark: tasks that mean the same are one, and
// their starts are told apart by content.
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "runtime/base/numbering.h"
#include "runtime/report/benchmark.h"

namespace probe::report {

// Where a plan's tasks and starts are in the benchmark.
struct PlanTasks {
  std::vector<int> task;                // of the benchmark, by index in the plan
  std::vector<std::vector<int>> start;  // by task of the plan and index of the episode
};

// Fills a benchmark's plans, tasks, objects, metrics and instructions; it must live as long.
class JoinedPlans {
 public:
  explicit JoinedPlans(Benchmark& benchmark) : benchmark_(benchmark) {}

  // Its index, or that of an equal one that is there.
  int add(plan::Plan plan, const std::string& suite_name);
  // Its index; a new one is added.
  int metric(const std::string& name, bool truth);

  const PlanTasks& map(int plan) const { return maps_[static_cast<std::size_t>(plan)]; }
  // Of the plan's tasks, those of the suite that was run.
  const std::vector<std::uint32_t>& members(std::size_t plan) const { return members_[plan]; }
  // Names that mean different tasks in different plans.
  const std::vector<std::string>& two_meanings() const { return two_meanings_; }

 private:
  using TaskKey = std::tuple<std::string, std::string, std::string, std::string, std::string>;

  int object(const plan::Plan& plan, std::uint32_t index);
  void add_tasks(int index);
  void add_task(const plan::Plan& plan, int index, std::uint32_t t, PlanTasks& map);
  StartPlace place(const plan::Plan& plan, const plan::TaskRecord& task,
                   const plan::EpisodeRecord& episode);
  Task describe(const plan::Plan& plan, int index, std::uint32_t t);

  Benchmark& benchmark_;
  std::vector<std::vector<std::uint32_t>> members_;  // by plan
  std::vector<PlanTasks> maps_;                      // by plan
  std::map<TaskKey, std::size_t> by_content_;
  Numbering<std::string> clusters_, taken_;
  std::vector<std::string> two_meanings_;
};

// The index of `item` in `list`, appended if it is not there.
template <typename Item>
int index_in(std::vector<Item>& list, const Item& item) {
  const auto found = std::find(list.begin(), list.end(), item);
  if (found != list.end()) return static_cast<int>(found - list.begin());
  list.push_back(item);
  return static_cast<int>(list.size()) - 1;
}

}  // namespace probe::report
