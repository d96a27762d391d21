#include "runtime/stage/privileged.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "runtime/plan/fixtures.h"
#include "runtime/plan/roles.h"
#include "runtime/plan/skills.h"
#include "runtime/stage/goal.h"
#include "runtime/stage/robot_of.h"
#include "runtime/stage/solution.h"
#include "runtime/vm/derived_solution.h"
#include "runtime/vm/made_up.h"

namespace probe::stage {
namespace {

// Contact of a finger, as the reference's metrics count it: N s over the last substep, 5e-4 N at
// 500 Hz.
constexpr double kContactImpulse = 1e-6;

std::vector<std::vector<Vec3>> vertices_of(const scene::CollisionShape& shape, const Vec3& at) {
  std::vector<std::vector<Vec3>> parts;
  for (const scene::ConvexPart& part : shape.parts) {
    parts.emplace_back();
    for (const Vec3& vertex : part.vertices) {
      parts.back().push_back(vertex + shape.center_of_mass + at);
    }
  }
  return parts;
}

// What moves a link, in the link's frame: the joint may be some fixed joints above it. `first` is
// the number of the fixture's first joint among those of all fixtures.
std::optional<policy::PrivilegedFixture::Joint> joint_above(const LoadedFixture& loaded, int link,
                                                            std::size_t first) {
  const robot::RobotModel& model = loaded.parts.model;
  const std::vector<world::JointSpec>& moving = loaded.fixture.joints;
  Pose to_moving;  // the link in the frame of the one that the joint moves
  for (int at = model.links[static_cast<std::size_t>(link)].parent_joint; at >= 0;) {
    const robot::Joint& joint = model.joints[static_cast<std::size_t>(at)];
    const auto found = std::ranges::find(moving, joint.name, &world::JointSpec::joint);
    if (found != moving.end()) {
      const auto own = static_cast<std::size_t>(found - moving.begin());
      const Pose back = to_moving.inverse();
      policy::PrivilegedFixture::Joint seen;
      seen.number = first + own;
      seen.slides = joint.kind == robot::JointKind::kPrismatic;
      seen.endless = joint.kind == robot::JointKind::kContinuous;
      seen.axis = back.rotation * joint.axis;
      seen.point = back.position;
      seen.lower = joint.lower;
      seen.upper = joint.upper;
      const bool at_upper = !seen.endless && plan::closes_at_upper(joint.lower, joint.upper);
      seen.closed = seen.endless ? 0 : at_upper ? joint.upper : joint.lower;
      seen.position = seen.rest = loaded.fixture.positions[own];
      return seen;
    }
    if (joint.kind != robot::JointKind::kFixed) return std::nullopt;
    to_moving = joint.origin * to_moving;
    at = model.links[static_cast<std::size_t>(joint.parent_link)].parent_joint;
  }
  return std::nullopt;
}

policy::Surroundings surroundings_of(const plan::Plan& plan, const plan::TaskRecord& task) {
  policy::Surroundings there;
  const plan::LightRecord& light = plan.lights()[task.light];
  there.ambient = light.ambient;
  for (const plan::SunRecord& sun : plan.suns(light)) there.power += sun.power;
  for (const plan::LampRecord& lamp : plan.lamps(light)) there.power += lamp.power;
  if (task.baseline == plan::kNone) return there;
  const plan::TaskRecord& baseline = plan.tasks()[task.baseline];
  there.camera_moved = (to_vec(plan.cameras()[task.camera].position) -
                        to_vec(plan.cameras()[baseline.camera].position))
                           .norm();
  const auto objects = [&](const plan::TaskRecord& one) {
    return static_cast<int>(std::ranges::count_if(plan.bodies(one), [](const auto& body) {
      return body.kind == static_cast<std::uint32_t>(plan::BodyKind::kObject);
    }));
  };
  there.clutter = objects(task) - objects(baseline);
  there.reworded = plan.text(task.prompt) != plan.text(baseline.prompt);
  return there;
}

}  // namespace

Result<policy::Privileged> make_privileged(const plan::Plan& plan, std::uint32_t task_index,
                                           const SharedAssets& assets, const TaskBodies& bodies) {
  const plan::TaskRecord& task = plan.tasks()[task_index];
  const plan::SceneRecord& scene = plan.scenes()[task.scene];
  const auto records = plan.bodies(task);
  const auto lacks_mesh = [&](const char* kind, const plan::BodyRecord& body) {
    return Failure{Fault::kAsset,
                   kind + (" `" + std::string(plan.text(body.name))) + "` has no collision mesh",
                   "task `" + std::string(plan.text(task.name)) + "`"};
  };
  policy::Privileged view;
  view.surroundings = surroundings_of(plan, task);
  view.base = base_pose(scene);
  view.surface_z = scene.surface_z;
  for (std::size_t i = 0; i < bodies.objects; ++i) {
    const plan::ObjectRecord& object = plan.objects()[records[i].index];
    const auto shape = assets.object_shape(records[i].index);
    if (!shape) return lacks_mesh("object", records[i]);
    policy::PrivilegedObject seen;
    seen.name = std::string(plan.text(records[i].name));
    seen.parts = vertices_of(*shape, Vec3::Zero());
    seen.center_of_mass = shape->center_of_mass;
    seen.box_min = to_vec(object.box_min);
    seen.box_max = to_vec(object.box_max);
    view.objects.push_back(std::move(seen));
  }
  if (bodies.fixture != TaskBodies::kNone) {
    const auto shape = assets.shape(scene.fixture_collision);
    if (!shape) return lacks_mesh("fixture", records[bodies.fixture]);
    view.fixtures.push_back(
        {bodies.names[bodies.fixture], vertices_of(*shape, to_vec(scene.fixture_position)), {}});
  }
  const auto loaded = assets.fixtures(task.scene);
  std::vector<std::size_t> first_joints = {0};  // by fixture; the last is their number
  for (const LoadedFixture* one : loaded)
    first_joints.push_back(first_joints.back() + one->fixture.joints.size());
  for (std::size_t k = bodies.robot_links; k < bodies.links.size(); ++k) {
    const auto [tree, link] = bodies.links[k];
    const UrdfParts& parts = loaded[tree - 1]->parts;
    view.fixtures.push_back(
        {bodies.names[bodies.first_link + k],
         vertices_of(*parts.shapes[static_cast<std::size_t>(link)], Vec3::Zero()),
         {},
         joint_above(*loaded[tree - 1], link, first_joints[tree - 1])});
  }
  view.fixture_joints = first_joints.back();
  const plan::TaskRoles roles = plan::roles_of(plan.tables(), task);
  view.source = roles.has_source() ? static_cast<int>(roles.source) : -1;
  view.target = roles.has_target() ? static_cast<int>(roles.target) : -1;
  view.first_distractor =
      roles.distractors.count > 0 ? static_cast<int>(roles.distractors.first) : -1;
  view.wrong_fixtures = wrong_fixtures_of(plan, task, bodies);
  return view;
}

Result<ToDo> ToDos::of(const plan::Plan& plan, std::uint32_t task, std::uint32_t start,
                       const TaskBodies& bodies) {
  std::vector<double> key = vm::begins_as(plan, task, start);
  if (const auto known = known_.find(key); known != known_.end()) return known->second;
  ToDo made;
  PROBE_ASSIGN(made.goal, goal_of(plan, task, start));
  const auto said = plan::skills_of(plan.tables(), task);
  std::vector<plan::SkillRecord> skills(said.begin(), said.end());
  if (skills.empty() && made.goal == policy::Goal::kOther) {
    PROBE_ASSIGN(skills, vm::derive_solution(plan, task, start));
  }
  made.solution = solution_of(plan, skills, bodies);
  return known_.try_emplace(std::move(key), std::move(made)).first->second;
}

void update_privileged(const vm::StepSample& sample, const TaskBodies& bodies, std::size_t fingers,
                       policy::Privileged* view) {
  for (std::size_t i = 0; i < view->objects.size(); ++i) {
    policy::PrivilegedObject& object = view->objects[i];
    object.pose = {sample.bodies[i].origin, sample.bodies[i].rotation};
    object.finger_contact.assign(fingers, false);
  }
  const std::size_t first = sample.joints.size() - view->fixture_joints;
  for (policy::PrivilegedFixture& fixture : view->fixtures) {
    if (fixture.joint)
      fixture.joint->position = sample.joints[first + fixture.joint->number].position;
  }
  // The last fixtures are the last bodies, link by link.
  const std::size_t moving = bodies.links.size() - bodies.robot_links;
  for (std::size_t k = 0; k < moving; ++k) {
    const vm::BodySample& link = sample.bodies[bodies.count() - moving + k];
    view->fixtures[view->fixtures.size() - moving + k].pose = {link.origin, link.rotation};
  }
  for (const vm::ContactSample& contact : sample.contacts) {
    // Objects come before links among a task's bodies.
    const bool is_finger =
        contact.b >= bodies.first_link && contact.b < bodies.first_link + fingers;
    if (!is_finger || contact.a >= bodies.objects) continue;
    if (contact.push.norm() >= kContactImpulse) {
      view->objects[contact.a].finger_contact[contact.b - bodies.first_link] = true;
    }
  }
}

}  // namespace probe::stage
