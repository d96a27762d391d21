// The derived files of an import: its tasks sorted by what is to be done and where, with the
// variants that need starts of their own or the words inside their files; and its tasks repaired.
// What is asked of them stands in suite/libero/asked.probe. Reads no file.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "runtime/libero/bddl.h"
#include "runtime/libero/suite_text.h"
#include "runtime/libero/things.h"

namespace probe::libero {

// A task that an import has written, with what it was written from.
struct AskedTask {
  WrittenTask written;
  std::string instruction;
  BddlProblem problem;
};

// Text, and tables of starts beside those of the suites: "starts/libero_goal_03_alone.csv". The
// same bytes for the same input. `rooms`: scenes that have theirs, which others are shown in.
SuiteText write_probing(const std::vector<std::string>& suites, const std::vector<AskedTask>& tasks,
                        const Things& things, const std::set<std::string>& rooms);

// The same tasks judged by the rules of suite/libero/clean.probe, each compared with the
// benchmark's where a rule changes.
std::string write_clean(const std::vector<std::string>& suites,
                        const std::vector<AskedTask>& tasks);

}  // namespace probe::libero
