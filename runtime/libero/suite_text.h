// A suite of LIBERO as a Probe text and tables of starts. Reads no file and knows no model.
#pragma once

#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/libero/bddl.h"
#include "runtime/libero/states.h"
#include "runtime/libero/suites.h"
#include "runtime/libero/things.h"

namespace probe::libero {

// One task as it was read.
struct TaskSource {
  std::size_t number = 0;  // within its suite
  std::string stem;        // of its files
  BddlProblem problem;
  StartStates states;
};

// Where a fixture stands instead of in the middle of its region: m, quaternion w x y z.
struct FixturePose {
  std::string suite, stem, fixture;
  StatePose pose;
  std::string where;  // FILE:LINE
};

// What stands for a task in the text.
struct WrittenTask {
  std::string id;     // of its layout, its metrics and its table: "libero_goal_03"
  std::string name;   // "open_the_top_drawer_and_put_the_bowl_inside"
  std::string scene;  // of suite/libero/stage.probe: "libero_tabletop"
  std::string stage;  // its own, with its room and fixtures: "libero_goal_tabletop"
  std::string table;  // of its starts
  std::string goal;   // "in_site(source, target) and drawer_closed(white_cabinet_1.cabinet_bottom)"
};

struct SuiteText {
  struct Table {
    std::string path;  // "starts/libero_goal_03.csv", beside the text
    std::string text;
  };
  std::string text;  // as `fmt` lays it out
  std::vector<Table> tables;
  std::vector<std::string> notes;  // what is odd, a line each
  std::vector<WrittenTask> tasks;
};

// The tasks in the order of their numbers; all their categories are in `things`; `rooms`: scenes
// that have theirs (rooms.h). The same bytes for the same input. `taken`: names of fixtures and
// scenes that other texts have, so that all of an import can be used together; those of this one
// are added. Fails (kUsage, where = the problem's file) on a problem class, a region or a joint
// that is not known.
Result<SuiteText> write_suite(const Suite& suite, const std::vector<TaskSource>& tasks,
                              const Things& things, const std::set<std::string>& rooms,
                              const std::vector<FixturePose>& poses, std::set<std::string>& taken);

// The scene of suite/libero/stage.probe that a problem plays in; empty: its class is not known.
std::string_view scene_of_class(const BddlProblem& problem);

}  // namespace probe::libero
