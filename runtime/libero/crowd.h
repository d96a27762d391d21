// Things that a task does not have, put where nothing stands in any of its starts.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/libero/bddl.h"
#include "runtime/libero/things.h"

namespace probe::libero {

// What may be put somewhere, turned as the benchmark stands it up: of some models y is up.
struct Standing {
  std::string object;  // "ketchup_1"
  std::array<std::string, 4> turn = {"1", "0", "0", "0"};  // w x y z, as tables have them
};

struct Foreign {
  Standing what;
  double x = 0, y = 0, z = 0;  // m
};

// The turn of an object in the first row of a table that is about it; none: it is in no row.
std::optional<Standing> standing_in(std::string_view table, const std::string& object);

// Up to two, near the source and free of all else by the circles around both: of drawers and doors
// also by how far they come out. `table`: of the task's starts; `declared`: the objects that there
// are; `turn`: from which of them on, so that tasks do not all get the same. Nothing is taken that
// shares a noun with anything of the task: no instruction becomes ambiguous by it.
std::vector<Foreign> crowd(const BddlProblem& problem, const Things& things, std::string_view table,
                           const std::vector<Standing>& declared, std::size_t turn);

}  // namespace probe::libero
