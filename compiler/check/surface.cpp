// P0505 as an error: an object over the edge of the surface, and one that a table of starts has far
// below or above it.
#include <algorithm>
#include <array>
#include <cmath>

#include "compiler/check/starts.h"
#include "compiler/define/starts.h"
#include "compiler/define/support.h"
#include "compiler/geometry/footprint.h"
#include "compiler/geometry/pose.h"

namespace probe::sema {

bool is_over_edge(const TaskStarts& starts, const Start::Placed& placed) {
  const std::array<double, 4>& area = starts.model.scenes[starts.task.scene].area;
  // Most stand far from every edge.
  const double reach = reach_of(starts.object(placed));
  if (placed.x - reach >= area[0] && placed.x + reach <= area[2] && placed.y - reach >= area[1] &&
      placed.y + reach <= area[3])
    return false;
  return !is_inside(footprint(starts.object(placed), placed), area);
}

namespace {

// What is stored in a table top is pushed out of it, as recorded starts are; not from as deep as
// this. What falls from higher has not come to rest when the settling time ends.
constexpr double kDeepest = 0.1;  // m
constexpr double kHighest = 2.0;  // m

// Where there are fixtures things may stand on what is lower or higher than the surface: all that
// can hold them counts.
bool check_heights(const TaskStarts& starts, Travels& travels) {
  const Scene& scene = starts.model.scenes[starts.task.scene];
  const bool has_fixtures = scene.fixture || !scene.fixtures.empty();
  std::optional<Travels::Heights> heights;  // looked up once something is far from the surface
  for (std::size_t e = 0; e < starts.task.starts.size(); ++e) {
    const Start& start = starts.task.starts[e];
    for (const Start::Placed& placed : start.placed) {
      if (!placed.z) continue;
      const Object& object = starts.object(placed);
      const double bottom = *placed.z + lowest(object, axes_of(placed.turn));
      const auto is_off = [&](double low, double high) {
        return bottom < low - kDeepest || bottom > high + kHighest;
      };
      if (!is_off(scene.surface_z, scene.surface_z)) continue;
      if (!heights) heights = travels.heights(scene);
      if (!heights) return true;
      if (!is_off(heights->low, heights->high)) continue;
      const bool is_below = bottom < heights->low;
      const GivenPlace* row =
          row_of(starts.model, starts.layout, starts.task, start, placed.object);
      const std::string far =
          centimetres(is_below ? heights->low - bottom : bottom - heights->high) +
          (is_below ? " below" : " above");
      Diagnostic& said = starts.reporter.report(
          Situation::kOverEdge, row == nullptr ? starts.place({placed.object}) : row->z_span,
          "`" + object.name + "` begins " + far +
              (has_fixtures ? " the surface and all that stands in `" : " the surface of `") +
              scene.name + "` in start " + std::to_string(e) + " of `" + starts.task.name + "`");
      said.label(starts.layout.span, "the layout")
          .label(scene.span,
                 "the surface is at " + centimetres(scene.surface_z) +
                     (has_fixtures ? ", what stands there from " + centimetres(heights->low) +
                                         " to " + centimetres(heights->high)
                                   : ""))
          .help("`z_m` is the height of its model's origin above the floor, in metres")
          .cause = cause_of(starts.layout.span, {scene.name, object.name});
      return false;
    }
  }
  return true;
}

}  // namespace

bool check_surface(const TaskStarts& starts, Travels& travels) {
  if (!check_heights(starts, travels)) return false;
  const Scene& scene = starts.model.scenes[starts.task.scene];
  // What is put into a fixture or onto another object stands on that.
  const std::vector<Put> puts = puts_of(starts.model, starts.task);
  const Start::Placed* first = nullptr;
  CountedStarts counted{0, starts.task.starts.size()};
  std::vector<std::string> others;
  for (std::size_t e = 0; e < starts.task.starts.size(); ++e) {
    for (const Start::Placed& placed : starts.task.starts[e].placed) {
      if (std::ranges::find(puts, placed.object, &Put::object) != puts.end()) continue;
      if (!is_over_edge(starts, placed)) continue;
      if (first == nullptr) first = &placed;
      const std::string name = "`" + starts.object(placed).name + "`";
      if (placed.object == first->object) {
        counted.add(e);
      } else if (std::ranges::find(others, name) == others.end()) {
        others.push_back(name);
      }
    }
  }
  if (first == nullptr) return true;
  const std::string& name = starts.object(*first).name;
  Diagnostic& said =
      starts.reporter.report(Situation::kOverEdge, starts.place({first->object}),
                             "`" + name + "` stands over the edge of `" + scene.name + "` " +
                                 counted.text() + " `" + starts.task.name + "`");
  said.cause = cause_of(starts.layout.span, {scene.name, name});
  said.point(counted.first_words(at(starts.object(*first), *first)))
      .label(starts.layout.span, "the layout")
      .label(scene.span, "the surface is x " + centimetres(scene.area[0]) + " .. " +
                             centimetres(scene.area[2]) + ", y " + centimetres(scene.area[1]) +
                             " .. " + centimetres(scene.area[3]));
  if (others.empty()) return false;
  std::string also;
  for (const std::string& other : others) also += (also.empty() ? "" : ", ") + other;
  said.note(std::string(others.size() == 1 ? "so does " : "so do ") + also);
  return false;
}

}  // namespace probe::sema
