#include "compiler/define/task_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compiler/define/thing.h"
#include "compiler/define/replaced.h"
#include "compiler/define/views.h"
#include "compiler/names/quantities.h"
#include "runtime/plan/limits.h"

namespace probe::sema {

void check_refer(Context& context, const Task& task, RoleId role, const Spelled& refer,
                 bool& poisoned) {
  for (const ObjectId id : task.objects_in(role)) {
    const Object& object = context.model.objects[id];
    if (object.find_phrase(refer.text) != nullptr) continue;
    std::vector<std::string_view> candidates;
    for (const Phrase& phrase : object.phrases) candidates.push_back(phrase.name);
    report_unknown(context.diagnostics, "phrase of `" + object.name + "`", {refer.span, refer.text},
                   candidates)
        .label(object.span, "the object");
    poisoned = true;
    return;
  }
}

bool has_broken_part(const Model& model, const Task& task) {
  const auto is_broken = [](const auto& table, auto id) {
    return id != decltype(id)::kNone && table[id].broken;
  };
  if (is_broken(model.layouts, task.layout) || is_broken(model.metrics, task.metrics) ||
      is_broken(model.templates, task.say))
    return true;
  for (const LaterSentence& later : task.later) {
    if (is_broken(model.templates, later.say)) return true;
  }
  for (const Task::OtherCamera& other : task.cameras) {
    if (is_broken(model.cameras, other.camera)) return true;
  }
  if (task.scene != SceneId::kNone) {
    for (const View& view : model.scenes[task.scene].views) {
      if (is_broken(model.cameras, view.camera)) return true;
    }
  }
  const std::vector<ObjectId> objects = task.objects();
  return std::any_of(objects.begin(), objects.end(),
                     [&](ObjectId id) { return is_broken(model.objects, id); });
}

void count_horizon(Context& context, Task& task, bool& poisoned) {
  if (!task.horizon_time || task.scene == SceneId::kNone || poisoned) return;
  const Scene& scene = context.model.scenes[task.scene];
  const double rate =
      scene.robot == RobotId::kNone ? 0 : context.model.robots[scene.robot].control_hz;
  // Of a scene or a robot without one something else is said.
  if (!(rate > 0)) return;
  // As many as reach it; what a decimal leaves is no step.
  const double steps = task.horizon_time->si() * rate, whole = std::ceil(steps * (1 - 1e-12));
  task.horizon = whole >= 1 && whole <= plan::kMaxHorizon ? static_cast<std::uint64_t>(whole) : 0;
  if (task.horizon != 0) return;
  poisoned = true;
  context
      .report(Situation::kHorizon, task.horizon_span,
              fmt::format("expected a horizon between 1 and {} steps, found {:.6g}",
                          plan::kMaxHorizon, steps))
      .help(fmt::format("a control step is {:.6g}ms here", 1000 / rate));
}

namespace {

// One object in one place: a scene with two of a kind needs a second declaration with `like`.
void check_roles(Context& context, const Task& task, bool& poisoned) {
  std::vector<ObjectId> seen;
  for (const ObjectId id : task.objects()) {
    if (std::find(seen.begin(), seen.end(), id) != seen.end()) {
      context.report(Code::P0203, task.span,
                     "`" + context.model.objects[id].name + "` stands twice in the scene of `" +
                         task.name + "`");
      poisoned = true;
    }
    seen.push_back(id);
  }
}

// What a part or a region that fills a role belongs to is in the scene, and fills one role.
void check_things(Context& context, const Task& task, bool& poisoned) {
  const Model& model = context.model;
  const Scene& scene = model.scenes[task.scene];
  std::vector<ObjectId> seen;
  for (const auto& [role, id] : things_of(task)) {
    const Object& object = model.objects[id];
    poisoned = poisoned || object.broken;
    if (std::ranges::find(seen, id) != seen.end()) {
      context.report(Code::P0203, task.span,
                     "`" + object.name + "` fills " +
                         (role == RoleId::kNone ? "a role" : "two roles") + " of `" + task.name +
                         "`" + (role == RoleId::kNone ? " and is a distractor" : ""));
      poisoned = true;
    }
    seen.push_back(id);
    if (std::ranges::find(scene.fixtures, object.of->fixture) != scene.fixtures.end()) continue;
    const Fixture& fixture = model.fixtures[object.of->fixture];
    const std::size_t of_two = static_cast<std::size_t>(role);
    Span span = of_two < 2 ? task.role_span[of_two] : task.span;
    for (const Task::Filled& filled : task.others) {
      if (filled.role != role) continue;
      const auto at = std::ranges::find(filled.objects, id) - filled.objects.begin();
      span = filled.spans[static_cast<std::size_t>(at)];
    }
    if (role == RoleId::kNone) {
      const auto at = std::ranges::find(task.part_distractors, id) - task.part_distractors.begin();
      span = task.place(task.part_distractor_spans[static_cast<std::size_t>(at)]);
    }
    context
        .report(Situation::kNotInScene, span,
                "fixture `" + fixture.name + "` is not in scene `" + scene.name + "` of `" +
                    task.name + "`")
        .label(scene.span, "the scene")
        .help("a scene names its fixtures: `fixture " + fixture.name + "`");
    poisoned = true;
  }
}

// A time in control steps of the task's robot.
void count_delay(Context& context, Task& task, bool& poisoned) {
  if (!task.delay_time) return;
  const double rate = context.model.robots[context.model.scenes[task.scene].robot].control_hz;
  const double steps = task.delay_time->si() * rate, whole = std::nearbyint(steps);
  if (whole >= 0 && whole <= plan::kMaxDelay && std::abs(steps - whole) <= 1e-9 * whole) {
    task.delay = static_cast<std::uint32_t>(whole);
    return;
  }
  poisoned = true;
  Diagnostic& said =
      context.report(Situation::kDelay, task.delay_span,
                     fmt::format("expected a whole number of control steps up to {}, found {:.6g}",
                                 plan::kMaxDelay, steps));
  if (rate > 0) said.help(fmt::format("a control step is {:.6g}ms here", 1000 / rate));
}

// A joint that begins somewhere is in the scene.
void check_joint_starts(Context& context, const Task& task, bool& poisoned) {
  const Scene& scene = context.model.scenes[task.scene];
  const std::vector<JointStart>* said[] = {&context.model.layouts[task.layout].joint_starts,
                                           &task.joint_starts};
  for (const std::vector<JointStart>* starts : said) {
    for (const JointStart& start : *starts) {
      if (std::ranges::find(scene.fixtures, start.fixture) != scene.fixtures.end()) continue;
      context
          .report(Code::P0201, start.span,
                  "fixture `" + context.model.fixtures[start.fixture].name + "` is not in scene `" +
                      scene.name + "` of `" + task.name + "`")
          .label(scene.span, "the scene");
      poisoned = true;
    }
  }
  const Layout& layout = context.model.layouts[task.layout];
  if (layout.given_joints.empty()) return;
  for (const GivenJoint& given : layout.given_joints.front()) {
    const bool is_arm = given.robot != RobotId::kNone;
    if (is_arm ? given.robot == scene.robot
               : std::ranges::find(scene.fixtures, given.fixture) != scene.fixtures.end())
      continue;
    const std::string name = is_arm ? "robot `" + context.model.robots[given.robot].name
                                    : "fixture `" + context.model.fixtures[given.fixture].name;
    context
        .report(Code::P0201, given.what.span,
                name + "` is not in scene `" + scene.name + "` of `" + task.name + "`")
        .label(scene.span, "the scene");
    poisoned = true;
    return;
  }
}

// A copy of a robot may have another description, without the link.
void check_mount(Context& context, const Task& task, const Camera& camera, bool& poisoned) {
  const Robot& robot = context.model.robots[context.model.scenes[task.scene].robot];
  if (!robot.model || robot.model->find_link(camera.mount_link.text) >= 0) return;
  context
      .report(Code::P0201, task.span,
              "robot `" + robot.name + "` of `" + task.name + "` has no link `" +
                  camera.mount_link.text + "`, on which camera `" + camera.name + "` is mounted")
      .label(camera.mount_link.span, "this link")
      .label(robot.span, "the robot");
  poisoned = true;
}

// What a task's camera takes the place of must be there, and a camera moves with a link, so that
// link must be in the scene.
void check_cameras(Context& context, const Task& task, bool& poisoned) {
  const Scene& scene = context.model.scenes[task.scene];
  for (const Task::OtherCamera& other : task.cameras) {
    if (!other.as || view_named(scene, other.as->text) != nullptr) continue;
    std::vector<std::string_view> names;
    for (const View& view : scene.views) names.push_back(view.name);
    report_unknown(context.diagnostics, "view", {other.as->span, other.as->text}, names)
        .label(scene.span, "the scene of `" + task.name + "`");
    poisoned = true;
  }
  for (const View& view : views_of(context.model, task)) {
    const Camera& camera = context.model.cameras[view.camera];
    if (is_copy_of(context.model, scene.robot, camera.mount_robot)) {
      check_mount(context, task, camera, poisoned);
      continue;
    }
    context
        .report(Situation::kOtherRobot, task.span,
                "camera `" + camera.name + "` of `" + task.name +
                    "` is mounted on a robot that is not in scene `" + scene.name + "`")
        .label(camera.mount_link.span, "this link")
        .help("a scene with another robot needs a camera of its own: `camera C { mount " +
              (scene.robot == RobotId::kNone ? std::string("ROBOT")
                                             : context.model.robots[scene.robot].name) +
              ".LINK at ... }`, and `camera C` in it");
    poisoned = true;
  }
}

}  // namespace

void check_fit(Context& context, Task& task, bool& poisoned) {
  check_roles(context, task, poisoned);
  check_things(context, task, poisoned);
  check_cameras(context, task, poisoned);
  check_joint_starts(context, task, poisoned);
  count_delay(context, task, poisoned);
}

}  // namespace probe::sema
