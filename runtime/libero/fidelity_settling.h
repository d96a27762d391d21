// Where things lie behind the ten steps of waiting, against the benchmark's own program.
#pragma once

#include <string>
#include <vector>

#include "runtime/libero/imported.h"
#include "runtime/libero/records.h"

namespace probe::libero {

// How far the thing that is farthest off is from where it lay in the record.
struct SettledStart {
  std::string task;  // "libero_goal_00"
  std::size_t start = 0;
  std::string farthest, tilted;  // objects
  double distance = 0;           // m, of model origins
  double angle = 0;              // rad
  double joint = 0;              // m or rad, of fixtures' joints
};

// The first `starts` of every task of which there are settled states.
Result<std::vector<SettledStart>> settle_all(Imported& imported, const Records& records,
                                             std::size_t starts);

}  // namespace probe::libero
