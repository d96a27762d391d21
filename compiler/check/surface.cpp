// P0505 as an error: an object over the edge of the surface.
#include <algorithm>
#include <array>

#include "compiler/check/starts.h"
#include "compiler/define/support.h"
#include "compiler/geometry/footprint.h"

namespace probe::sema {

bool is_over_edge(const TaskStarts& starts, const Start::Placed& placed) {
  const std::array<double, 4>& area = starts.model.scenes[starts.task.scene].area;
  const Footprint shape = footprint(starts.object(placed), placed);
  const double rx = shape.reach_along({1, 0});
  const double ry = shape.reach_along({0, 1});
  return !(shape.centre.x - rx >= area[0] && shape.centre.x + rx <= area[2] &&
           shape.centre.y - ry >= area[1] && shape.centre.y + ry <= area[3]);
}

bool check_surface(const TaskStarts& starts) {
  const Scene& scene = starts.model.scenes[starts.task.scene];
  // What is put into a fixture or onto another object stands on that.
  const std::vector<Put> puts = puts_of(starts.model, starts.task);
  for (std::size_t e = 0; e < starts.task.starts.size(); ++e) {
    for (const Start::Placed& placed : starts.task.starts[e].placed) {
      if (std::ranges::find(puts, placed.object, &Put::object) != puts.end()) continue;
      if (!is_over_edge(starts, placed)) continue;
      starts.reporter
          .report(Situation::kOverEdge, starts.place({placed.object}),
                  "`" + starts.object(placed).name + "` stands over the edge of `" + scene.name +
                      "` in `" + starts.task.name + "`")
          .point("episode " + std::to_string(e) + ": " + at(starts.object(placed), placed))
          .label(starts.layout.span, "the layout")
          .label(scene.span, "the surface is x " + centimetres(scene.area[0]) + " .. " +
                                 centimetres(scene.area[2]) + ", y " + centimetres(scene.area[1]) +
                                 " .. " + centimetres(scene.area[3]));
      return false;
    }
  }
  return true;
}

}  // namespace probe::sema
