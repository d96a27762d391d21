// The bodies of a task in the order of its plan, and what tells programs of tasks apart.
#include <algorithm>
#include <cmath>
#include <limits>

#include "compiler/lower/lower.h"
#include "runtime/base/check.h"

namespace probe::lower {
namespace {

std::uint32_t role_number(const sema::Task& task, sema::ObjectId object) {
  const sema::RoleId role = task.role_of(object);
  if (role != sema::RoleId::kNone) return static_cast<std::uint32_t>(role);
  const auto& others = task.distractors;
  return std::find(others.begin(), others.end(), object) != others.end()
             ? kDistractorRole
             : static_cast<std::uint32_t>(sema::RoleId::kNone);
}

void set_regions(Body& body, const std::vector<sema::Region>& regions, std::uint32_t owner) {
  if (regions.empty()) return;
  body.regions = &regions;
  body.owner = owner + 1;
}

// The part that a thing is, or that has it, gets its role.
void fill_role(const sema::Model& model, std::uint32_t role, sema::ObjectId thing,
               std::vector<Body>& bodies) {
  const sema::Object& object = model.objects[thing];
  for (Body& body : bodies) {
    if (body.kind != plan::BodyKind::kPart ||
        body.index != static_cast<std::uint32_t>(object.of->fixture) ||
        body.part != object.of->part)
      continue;
    if (object.of->is_part()) {
      body.role = role;
      continue;
    }
    const sema::Fixture& fixture = model.fixtures[object.of->fixture];
    body.filled.push_back({role, *object.of->region,
                           &fixture.regions[*object.of->region].region, object.name});
  }
}

}  // namespace

std::vector<Body> bodies_of(const sema::Model& model, const sema::Task& task) {
  const sema::Scene& scene = model.scenes[task.scene];
  const sema::Robot& robot = model.robots[scene.robot];
  PROBE_CHECK(robot.model.has_value(), "a task is lowered only after its robot was read");
  std::vector<Body> bodies;
  for (const sema::ObjectId id : task.objects()) {
    bodies.push_back({plan::BodyKind::kObject, static_cast<std::uint32_t>(id),
                      model.objects[id].name, role_number(task, id)});
    set_regions(bodies.back(), model.objects[id].regions, static_cast<std::uint32_t>(id));
  }
  bodies.push_back({plan::BodyKind::kSurface, 0, "surface"});
  set_regions(bodies.back(), scene.surface_regions, static_cast<std::uint32_t>(task.scene));
  if (scene.fixture) {
    bodies.push_back({plan::BodyKind::kFixture, 0, scene.fixture->text});
    set_regions(bodies.back(), scene.fixture_regions, static_cast<std::uint32_t>(task.scene));
  }
  std::uint32_t link = 0;
  for (const sema::Finger& finger : robot.fingers) {
    bodies.push_back({plan::BodyKind::kLink, link++, finger.link.text});
    bodies.back().is_finger = true;
  }
  for (const robot::Link& known : robot.model->links) {
    const bool is_finger =
        std::any_of(robot.fingers.begin(), robot.fingers.end(),
                    [&](const sema::Finger& finger) { return finger.link.text == known.name; });
    if (is_finger || !known.can_collide()) continue;
    bodies.push_back({plan::BodyKind::kLink, link++, known.name});
  }
  for (const sema::FixtureId id : scene.fixtures) {
    const sema::Fixture& fixture = model.fixtures[id];
    for (std::uint32_t i = 0; i < fixture.parts.size(); ++i) {
      bodies.push_back({plan::BodyKind::kPart, static_cast<std::uint32_t>(id),
                        fixture.body_name(fixture.parts[i]),
                        static_cast<std::uint32_t>(sema::RoleId::kNone), i});
    }
  }
  for (const auto& [role, thing] : task.things())
    fill_role(model, static_cast<std::uint32_t>(role), thing, bodies);
  for (const sema::ObjectId part : task.part_distractors)
    fill_role(model, kDistractorRole, part, bodies);
  return bodies;
}

std::vector<std::uint32_t> shape_of(const sema::Model& model, std::span<const sema::Metric> metrics,
                                    const std::vector<Body>& bodies) {
  std::vector<std::uint32_t> shape;
  shape.reserve(1 + 6 * bodies.size() + 9 * metrics.size());
  shape.push_back(static_cast<std::uint32_t>(bodies.size()));
  for (const Body& body : bodies) {
    // Which object it is counts for nothing: instructions name bodies by their place in the list,
    // unless some metric of the text calls one by its name.
    const bool is_any = body.kind == plan::BodyKind::kObject && !model.exprs.names_objects;
    shape.push_back(static_cast<std::uint32_t>(body.kind));
    shape.push_back(is_any ? 0 : body.index);
    shape.push_back(body.role);
    shape.push_back(body.owner);  // of its regions
    shape.push_back(body.part);
    for (const Body::Filled& filled : body.filled)
      shape.insert(shape.end(), {0xfffffffdu, filled.role, filled.number});
    shape.push_back(body.is_finger ? 1 : 0);
  }
  for (const sema::Metric& metric : metrics) {
    // A metric's name stands at its span.
    shape.insert(shape.end(),
                 {metric.expr, metric.variables, static_cast<std::uint32_t>(metric.readout),
                  metric.span.file.value, metric.span.begin, metric.span.end});
    shape.insert(shape.end(), {metric.readout_span.file.value, metric.readout_span.begin,
                               metric.readout_span.end});
  }
  return shape;
}

Room room_of(const sema::Model& model, const sema::Task& task) {
  const sema::Scene& scene = model.scenes[task.scene];
  // Objects start within the area, and a plan may have that a kilometre away.
  double farthest = std::abs(scene.surface_z) + model.layouts[task.layout].drop;
  const auto reach = [&](const auto& coordinates) {
    for (const double c : coordinates) farthest = std::max(farthest, std::abs(c));
  };
  reach(scene.area);
  reach(scene.base_position);
  if (scene.fixture) reach(scene.fixture_position);
  Room room;
  for (const sema::FixtureId id : scene.fixtures) {
    const sema::Fixture& fixture = model.fixtures[id];
    reach(fixture.position);
    reach(std::array{fixture.position[2] + scene.fixtures_lift});
    for (const sema::Fixture::Joint& joint : fixture.joints) {
      constexpr double kNone = std::numeric_limits<double>::infinity();
      room.joints.emplace_back(joint.is_endless ? -kNone : joint.lower,
                               joint.is_endless ? kNone : joint.upper);
    }
  }
  room.farthest += farthest;
  for (const sema::ObjectId id : task.objects()) {
    const sema::Object& object = model.objects[id];
    double square = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const double extent = object.box_max[i] - object.box_min[i];
      square += extent * extent;
    }
    room.largest = std::max(room.largest, std::sqrt(square) / 2);
  }
  return room;
}

}  // namespace probe::lower
