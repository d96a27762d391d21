// A task of LIBERO as its BDDL file says it: where things are put, what they are, what is wanted.
// What the words mean in a scene, and what a policy is told, is not known here.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/libero/sexpr.h"

namespace probe::libero {

// A part of the world that things are put on or in: of a table or floor rectangles; of an object or
// a fixture a box that its model has.
struct BddlRegion {
  std::string name;    // with its target before it, as facts call it: "main_table_plate_region"
  std::string own;     // without: "plate_region"
  std::string target;  // "main_table"
  // x_min, y_min, x_max, y_max, m, from the middle of the workspace. Empty: its model has it.
  std::vector<std::array<double, 4>> ranges;
  std::optional<std::array<double, 2>> yaw;  // rad, least and most
  Spot spot;
};

// An object or a fixture.
struct BddlThing {
  std::string name;      // "akita_black_bowl_1"
  std::string category;  // "akita_black_bowl"
  Spot spot;
};

struct BddlFact {
  std::string predicate;  // of predicates.def
  std::vector<std::string> arguments;
  Spot spot;
};

struct BddlProblem {
  std::string path;
  std::string problem_class;  // "libero_tabletop_manipulation", in lower case
  std::string language;       // as written, words with one blank between them
  std::vector<BddlRegion> regions;
  std::vector<BddlThing> fixtures, objects;  // in the order of the file
  std::vector<std::string> interest;
  std::vector<BddlFact> init, goal;  // all of each hold

  const BddlThing* find_object(std::string_view name) const;
  const BddlThing* find_fixture(std::string_view name) const;
  const BddlRegion* find_region(std::string_view name) const;
};

struct BddlRead {
  BddlProblem problem;
  std::vector<Failure> mistakes;  // in the order of the file; with any the problem must not be used
  std::vector<Failure> oddities;  // what does no harm, and is not what it should be
};

// Words are compared in lower case, but for `:language`. Mistakes (kUsage, where =
// "path:line:column"): an unknown section, predicate or part of a region, a section that is missing
// or there twice, a name that two things or regions have, a fact about what is not declared or with
// another number of arguments, a number that is none, a rectangle whose corners are swapped. A
// bracket without its other half ends the reading.
BddlRead read_bddl(std::string_view text, const std::string& path);

}  // namespace probe::libero
