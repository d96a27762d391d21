// The stored starts of a task, `.pruned_init`: what torch.save makes of a numpy array, a zip
// archive with a pickle in it. Read without either, and nothing in it is run.
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/libero/bddl.h"

namespace probe::libero {

// Where a model's origin is: x, y, z in the world, m; quaternion w, x, y, z.
struct StatePose {
  std::array<double, 3> position{};
  std::array<double, 4> rotation{1, 0, 0, 0};
};

// One stored start: MuJoCo's time and positions, [time, qpos, qvel].
struct StartState {
  double time = 0;                  // s
  std::array<double, 7> arm{};      // rad, joint1 .. joint7
  std::array<double, 2> fingers{};  // m, as stored: the second is 0 or less
  std::vector<StatePose> objects;   // in the order of the problem's objects
  std::vector<double> joints;       // of fixtures, m or rad, in the order of joint_names
  double fastest = 0;               // largest |velocity|; 0 in all that were released
};

// The joints of a category's model in its order, by category: "flat_stove" -> {"button"}. What has
// none may be left out.
using JointsOf = std::map<std::string, std::vector<std::string>, std::less<>>;

struct StartStates {
  // "wooden_cabinet_1", "top_level": those of all fixtures, in the order of the problem's fixtures.
  std::vector<std::pair<std::string, std::string>> joint_names;
  std::vector<StartState> starts;
};

// Fails (kUsage, where = path) on what is no such archive, on a pickle that holds anything but one
// array of float64, naming the opcode or the global that is refused and running neither, on rows
// that are not those of the problem, on numbers that are not finite, on quaternions that are none.
Result<StartStates> read_states(const std::string& path, const BddlProblem& problem,
                                const JointsOf& joints_of);

}  // namespace probe::libero
