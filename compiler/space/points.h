// Points of a space as ordinary Probe text: each is a variant of the space's task, with
// declarations of its own for what no statement of a task says (lights, cameras, layouts).
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "compiler/geometry/part_boxes.h"
#include "compiler/model/model.h"
#include "runtime/base/asset_root.h"

namespace probe::space {

struct Point {
  std::string name;            // of its task: letters, digits, `_`
  std::vector<double> values;  // by axis, as SpaceAxis has them
  // What has no axis follows from it: which way a thing is moved, a lamp is tilted, a camera is
  // turned, where clutter lies.
  std::uint64_t draw = 0;
  std::vector<std::uint32_t> starts = {};  // of the task's; empty: all
};

// The point at which nothing is changed.
std::vector<double> own_values(const sema::Space& space);
// Axes by index that differ from the task's own, where a difference can be seen at all.
std::vector<std::size_t> changed_axes(const sema::Space& space, const std::vector<double>& values);
// The same point where a change that nobody sees is none: the task's own value to the bit.
std::vector<double> seen_values(const sema::Space& space, std::vector<double> values);
// Only what changes where things lie; all else as the task has it: two points that agree in this
// are solved alike by one who sees nothing.
std::vector<double> placed_values(const sema::Space& space, const std::vector<double>& values);

// "0.31", "-2.5cm", "put_the", "as the task"; of a factor "x 0.31".
std::string value_text(const sema::SpaceAxis& axis, double value);
// The same of a number in the unit that people read.
std::string amount_text(const sema::SpaceAxisInfo& info, double shown);
// "light.power x 0.31, clutter 2"; "nothing" where nothing is changed.
std::string point_text(const sema::Space& space, const std::vector<double>& values);

struct WrittenTable {
  std::string file;  // beside the text
  std::string text;  // a table of starts
};
struct WrittenPoint {
  std::string text;  // its lines, the last one ended
  std::optional<WrittenTable> table;
  // Of the task's starts those that it has, by its own numbers.
  std::vector<std::uint32_t> starts;
  // Where nothing could be written, why: clutter that has no room in any start.
  std::string left_out = {};
};

// The point must be one of `space`, whose task has no errors in `model`. `allowed`: whether more
// than one axis is known to move, which the text then says is meant. `ways`: what clutter keeps
// clear of, ways_of_fixtures() of the task's scene.
WrittenPoint write_point(const sema::Model& model, const sema::Space& space, const Point& point,
                         bool allowed, const sema::PartBoxes& ways = {});
// What the parts of fixtures fill wherever their joints stand. Reads their collision meshes.
sema::PartBoxes ways_of_fixtures(const sema::Model& model, const sema::Scene& scene,
                                 const AssetRoot& assets);

}  // namespace probe::space
