#include "compiler/space/clutter.h"

#include <algorithm>
#include <numbers>
#include <string>

#include "compiler/define/views.h"
#include "compiler/geometry/footprint.h"
#include "compiler/geometry/in_frame.h"
#include "compiler/geometry/pose.h"
#include "compiler/geometry/reachable.h"
#include "compiler/geometry/travel.h"
#include "compiler/space/draws.h"
#include "runtime/base/geometry.h"
#include "runtime/base/trig.h"

namespace probe::space {
namespace {

// What settling may move, and that nothing begins by touching.
constexpr double kRoom = 0.005;  // m
constexpr int kTries = 200;

// Turned about the vertical where it rests.
sema::Turn about_vertical(double angle, const sema::Turn& rest) {
  const SinCos half = portable_sincos(angle / 2);
  const Quat q = Quat(half.cos, 0, 0, half.sin) * to_quat(rest.rotation);
  return {{q.w(), q.x(), q.y(), q.z()}};
}

// By a camera that stands still, where there is one: what nobody sees is no clutter.
bool is_seen(const std::vector<sema::Frustum>& eyes, const sema::Object& object,
             const sema::Start::Placed& placed) {
  return eyes.empty() || std::ranges::any_of(eyes, [&](const sema::Frustum& eye) {
           const auto outside = eye.outside(object, placed);
           return outside && *outside == 0;
         });
}

// Whether it meets no part of a fixture on its way down to the surface, wherever the part stands.
bool is_clear(const sema::PartBoxes& ways, const sema::Model& model, const sema::Task& task,
              const sema::Start::Placed& placed) {
  if (ways.all().empty()) return true;
  const sema::Object& object = model.objects[placed.object];
  const double surface = model.scenes[task.scene].surface_z;
  const Mat3 turn = sema::axes_of(placed.turn);
  const double z = surface - sema::lowest(object, turn);
  const scene::Solid body = sema::solid(object, turn, {placed.x, placed.y, z});
  const Vec3 room = Vec3::Constant(kRoom), half = body.half_extent() + room;
  const Vec3 drop(0, 0, model.layouts[task.layout].drop);
  const scene::Solid falling = scene::upright_solid(body.centre - half, body.centre + half + drop);
  bool is_met = false;
  ways.each_near(falling.centre, falling.half_extent(), [&](const sema::PartBox& box) {
    is_met = is_met || scene::overlap(box.solid, falling) > 0;
  });
  return !is_met;
}

}  // namespace

std::optional<std::vector<sema::Start::Placed>> lay_clutter(
    const sema::Model& model, const sema::Task& task, const sema::Start& start, std::size_t number,
    const std::vector<sema::ObjectId>& objects, std::uint64_t of, const sema::PartBoxes& ways) {
  const sema::Scene& scene = model.scenes[task.scene];
  const auto& area = scene.area;
  const sema::Robot& robot = model.robots[scene.robot];
  std::vector<sema::Footprint> there;
  for (const sema::Start::Placed& placed : start.placed)
    there.push_back(footprint(model.objects[placed.object], placed));
  std::vector<sema::Frustum> eyes;
  for (const sema::View& view : sema::views_of(model, task)) {
    if (auto eye = sema::Frustum::of(model, scene, model.cameras[view.camera]))
      eyes.push_back(*std::move(eye));
  }
  std::vector<sema::Start::Placed> laid;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const sema::Object& object = model.objects[objects[i]];
    const sema::Turn rest = object.rest.empty() ? sema::Turn{} : object.rest.front();
    const std::string what = "clutter " + std::to_string(number) + " " + std::to_string(i);
    bool found = false;
    for (std::uint64_t t = 0; t < kTries && !found; ++t) {
      sema::Start::Placed placed;
      placed.object = objects[i];
      placed.x = area[0] + draw(of, what, 3 * t) * (area[2] - area[0]);
      placed.y = area[1] + draw(of, what, 3 * t + 1) * (area[3] - area[1]);
      placed.turn = about_vertical(2 * std::numbers::pi * draw(of, what, 3 * t + 2), rest);
      const sema::Footprint print = footprint(object, placed);
      if (!is_inside(print, area) || !is_seen(eyes, object, placed)) continue;
      // The compiler wants all that lies around within the arm's reach (P0502).
      if (!is_in_annulus(robot, distance_to_base(scene, placed))) continue;
      bool free = true;
      for (const sema::Footprint& other : there) free = free && overlap(print, other) < -kRoom;
      if (!free || !is_clear(ways, model, task, placed)) continue;
      there.push_back(print);
      laid.push_back(placed);
      found = true;
    }
    if (!found) return std::nullopt;
  }
  return laid;
}

}  // namespace probe::space
