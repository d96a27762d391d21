// Where clutter lies: in each start of its own, clear of what is there and of the ways of fixtures'
// parts, in the picture and within reach.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "compiler/geometry/part_boxes.h"
#include "compiler/model/model.h"

namespace probe::space {

// `objects` beside what lies in `start` already, on the area of the task's scene, each turned at
// random about the vertical; drawn from `of` and the start's number, so that more clutter leaves
// the first of it where it was. Nothing where one found no room in 200 tries. `ways`: what parts of
// the scene's fixtures fill, wherever their joints stand.
std::optional<std::vector<sema::Start::Placed>> lay_clutter(
    const sema::Model& model, const sema::Task& task, const sema::Start& start, std::size_t number,
    const std::vector<sema::ObjectId>& objects, std::uint64_t of, const sema::PartBoxes& ways);

}  // namespace probe::space
