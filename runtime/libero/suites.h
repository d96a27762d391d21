// The five suites: which tasks they have, in which order, how long an episode is; and what a task's
// file name says.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace probe::libero {

struct Suite {
  std::string_view folder;  // "libero_spatial"
  std::size_t horizon = 0;  // control steps of 50 ms, behind the kWaiting
  std::size_t tasks = 0;
};

constexpr std::size_t kWaiting = 10;  // control steps of standing still with the gripper open

std::span<const Suite> suites();

// Of the stems of the files that a suite's folder has, those of its tasks in the order of their
// numbers; `missing` are tasks without a file, `strange` files that are no task of the suite.
struct TaskOrder {
  std::vector<std::string> stems;
  std::vector<std::size_t> numbers;  // of the stems: what is missing keeps its own
  std::vector<std::string> missing, strange;
};
TaskOrder order_tasks(const Suite& suite, const std::vector<std::string>& stems);

// "KITCHEN_SCENE3_turn_on_the_stove" -> "turn on the stove": what policies are told.
std::string instruction_of(std::string_view stem);
// "kitchen_scene3", or nothing where the name says no scene.
std::string scene_of(std::string_view stem);

}  // namespace probe::libero
