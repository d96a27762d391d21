#include "compiler/space/start_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "compiler/define/role.h"
#include "compiler/define/views.h"
#include "compiler/geometry/footprint.h"
#include "compiler/geometry/pose.h"
#include "compiler/space/clutter.h"
#include "compiler/space/draws.h"
#include "runtime/base/trig.h"

namespace probe::space {
namespace {

using sema::SpaceAxisKind;

struct Row {
  std::uint32_t number = 0;  // of the task's starts
  sema::Start start;
  std::vector<sema::Start::Placed> clutter;
};

// To the bit.
std::string cell(double value) { return fmt::format("{}", value + 0.0); }

std::vector<std::uint32_t> wanted_starts(const sema::Task& task, const Point& point) {
  std::vector<std::uint32_t> wanted = point.starts;
  for (std::uint32_t i = 0; point.starts.empty() && i < task.starts.size(); ++i)
    wanted.push_back(i);
  return wanted;
}

// What the point moves, moved: in each start another way, as a step to one side would be a change
// of its own.
void move_things(const sema::Space& space, const Point& point, Row& row) {
  for (const std::size_t i : changed_axes(space, point.values)) {
    const sema::SpaceAxis& axis = space.axes[i];
    if (axis.kind != SpaceAxisKind::kPlace) continue;
    const SinCos way =
        portable_sincos(2 * std::numbers::pi * draw(point.draw, axis.name, row.number));
    for (sema::Start::Placed& placed : row.start.placed) {
      if (placed.object != axis.object) continue;
      placed.x += point.values[i] * way.cos;
      placed.y += point.values[i] * way.sin;
    }
  }
}

// Jitter goes by a start's number, which a table without the starts before it does not keep.
bool is_jittered(const sema::Model& model, const sema::Task& task) {
  return model.layouts[task.layout].joints_jitter > 0 ||
         std::ranges::any_of(sema::views_of(model, task), [&](const sema::View& view) {
           return model.cameras[view.camera].jitters();
         });
}

// As the layout's own table calls it, where it has one: by its role, maybe.
std::string row_name(const sema::Model& model, const sema::Task& task, sema::ObjectId object) {
  const std::string& name = model.objects[object].name;
  const sema::Layout& layout = model.layouts[task.layout];
  if (layout.given.empty()) return name;
  for (const sema::GivenPlace& given : layout.given.front()) {
    if (given.what.text == name) return name;
    const auto role = sema::find_role(model, given.what.text);
    if (!role) continue;
    const std::vector<sema::ObjectId> filled = task.objects_in(*role);
    if (filled.size() == 1 && filled.front() == object) return given.what.text;
  }
  return name;
}

std::string table_of(const sema::Model& model, const sema::Task& task, const std::vector<Row>& rows,
                     const Clutter& clutter) {
  const sema::Layout& own = model.layouts[task.layout];
  const bool joints = !own.given_joints.empty();
  const bool heights = std::ranges::all_of(rows, [](const Row& row) {
    return std::ranges::all_of(row.start.placed, [](const auto& p) { return p.z.has_value(); });
  });
  const double surface = model.scenes[task.scene].surface_z;
  std::string table = std::string("start,object,x_m,y_m") + (heights ? ",z_m" : "") +
                      ",qw,qx,qy,qz" + (joints ? ",value" : "") + "\n";
  const auto add = [&](std::size_t start, const std::string& object,
                       const sema::Start::Placed& p) {
    table += fmt::format("{},{},{},{}", start, object, cell(p.x), cell(p.y));
    // What has no height is as high above the surface as things of the layout fall from.
    if (heights)
      table += "," + cell(p.z.value_or(
                         surface - sema::lowest(model.objects[p.object], sema::axes_of(p.turn)) +
                         own.drop));
    for (const double q : p.turn.rotation) table += "," + cell(q);
    table += joints ? ",\n" : "\n";
  };
  for (std::size_t r = 0; r < rows.size(); ++r) {
    for (const sema::Start::Placed& placed : rows[r].start.placed)
      add(r, row_name(model, task, placed.object), placed);
    for (std::size_t i = 0; i < rows[r].clutter.size(); ++i)
      add(r, clutter.names[i], rows[r].clutter[i]);
    if (!joints) continue;
    for (const sema::GivenJoint& joint : own.given_joints[rows[r].start.given])
      table += fmt::format("{},{},,{},,,,,{}\n", r, joint.what.text, heights ? "," : "",
                           cell(joint.value));
  }
  return table;
}

}  // namespace

Clutter clutter_of(const sema::Model& model, const sema::Space& space, const Point& point) {
  Clutter out;
  for (const std::size_t axis : changed_axes(space, point.values)) {
    if (space.axes[axis].kind != SpaceAxisKind::kClutter) continue;
    const auto count = static_cast<std::size_t>(std::llround(point.values[axis]));
    for (std::size_t i = 0; i < count; ++i) {
      out.objects.push_back(space.clutter[i % space.clutter.size()]);
      const std::string& name = model.objects[out.objects.back()].name;
      const std::size_t copy = i / space.clutter.size();
      out.names.push_back(copy == 0 ? name : point.name + "_" + name + std::to_string(copy + 1));
      if (copy > 0) out.declarations += "object " + out.names.back() + " like " + name + " {}\n";
    }
  }
  return out;
}

bool has_own_starts(const sema::Model& model, const sema::Space& space, const Point& point) {
  const sema::Task& task = model.tasks[space.of];
  return wanted_starts(task, point).size() != task.starts.size() ||
         std::ranges::any_of(changed_axes(space, point.values), [&](std::size_t axis) {
           return sema::info_of(space.axes[axis].kind).moves_things;
         });
}

StartRows start_rows(const sema::Model& model, const sema::Space& space, const Point& point,
                     const Clutter& clutter, const sema::PartBoxes& ways) {
  const sema::Task& task = model.tasks[space.of];
  StartRows out;
  std::vector<Row> rows;
  for (const std::uint32_t number : wanted_starts(task, point)) {
    Row row{number, task.starts[number], {}};
    move_things(space, point, row);
    if (!clutter.objects.empty()) {
      auto laid = lay_clutter(model, task, row.start, number, clutter.objects, point.draw, ways);
      if (!laid) continue;
      row.clutter = *std::move(laid);
    }
    rows.push_back(std::move(row));
  }
  if (rows.size() != task.starts.size() && is_jittered(model, task)) {
    out.left_out =
        fmt::format("{} of {} starts would be left, and those that jitter keep all or none",
                    rows.size(), task.starts.size());
  } else if (rows.empty()) {
    out.left_out =
        fmt::format("{} more things find no room in any start", clutter.objects.size());
  } else {
    for (const Row& row : rows) out.starts.push_back(row.number);
    out.table = table_of(model, task, rows, clutter);
  }
  return out;
}

}  // namespace probe::space
