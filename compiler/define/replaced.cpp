#include "compiler/define/replaced.h"

#include <algorithm>
#include <string>

namespace probe::sema {
namespace {

// What a declaration copies in the end; circles were reported and are cut.
FixtureId root_of(const Model& model, FixtureId id) {
  for (std::size_t hops = 0; hops < model.fixtures.size(); ++hops) {
    const FixtureId like = model.fixtures[id].like;
    if (like == FixtureId::kNone) break;
    id = like;
  }
  return id;
}

// "top_drawer" of "cabinet.top_drawer".
std::string own_name(const std::string& name) { return name.substr(name.rfind('.') + 1); }

ObjectId thing_named(const Model& model, const Fixture& fixture, const std::string& name) {
  for (const Fixture::Part& part : fixture.parts) {
    if (part.thing != ObjectId::kNone && own_name(model.objects[part.thing].name) == name)
      return part.thing;
  }
  for (const Fixture::OwnRegion& own : fixture.regions) {
    if (own.thing != ObjectId::kNone && own_name(model.objects[own.thing].name) == name)
      return own.thing;
  }
  return ObjectId::kNone;
}

FixtureId fixture_named(const Model& model, const std::string& name) {
  for (std::size_t i = 0; i < model.fixtures.size(); ++i) {
    if (model.fixtures[model.fixtures.id(i)].name == name) return model.fixtures.id(i);
  }
  return FixtureId::kNone;
}

}  // namespace

bool is_copy_of(const Model& model, RobotId robot, RobotId of) {
  for (std::size_t hops = 0; robot != RobotId::kNone && hops <= model.robots.size(); ++hops) {
    if (robot == of) return true;
    robot = model.robots[robot].like;
  }
  return false;
}

FixtureId standing_for(const Model& model, const Scene& scene, FixtureId id) {
  if (std::ranges::find(scene.fixtures, id) != scene.fixtures.end()) return id;
  FixtureId found = FixtureId::kNone;
  for (const FixtureId there : scene.fixtures) {
    if (root_of(model, there) != root_of(model, id)) continue;
    if (found != FixtureId::kNone) return FixtureId::kNone;
    found = there;
  }
  return found;
}

ObjectId standing_for(const Model& model, const Scene& scene, ObjectId thing) {
  if (thing == ObjectId::kNone || !model.objects[thing].of) return thing;
  const FixtureId here = model.objects[thing].of->fixture;
  const FixtureId there = standing_for(model, scene, here);
  if (there == here || there == FixtureId::kNone) return thing;
  const ObjectId found =
      thing_named(model, model.fixtures[there], own_name(model.objects[thing].name));
  return found == ObjectId::kNone ? thing : found;
}

ObjectId same_as(const Model& model, const Scene& scene, ObjectId thing) {
  const ObjectId found = standing_for(model, scene, thing);
  if (found == thing) return thing;
  const Fixture& here = model.fixtures[model.objects[thing].of->fixture];
  const Fixture& there = model.fixtures[model.objects[found].of->fixture];
  return here.position == there.position && here.turn == there.turn ? found : thing;
}

void follow_fixtures(const Model& model, Task& task) {
  if (task.scene == SceneId::kNone) return;
  const Scene& scene = model.scenes[task.scene];
  if (scene.fixtures.empty()) return;
  const auto follow = [&](ObjectId& thing) { thing = standing_for(model, scene, thing); };
  follow(task.source);
  follow(task.target);
  for (Task::Filled& filled : task.others) std::ranges::for_each(filled.objects, follow);
  std::ranges::for_each(task.part_distractors, follow);
  for (JointStart& start : task.joint_starts) {
    const FixtureId there = standing_for(model, scene, start.fixture);
    if (there == FixtureId::kNone || there == start.fixture) continue;
    const std::string& name = model.fixtures[start.fixture].joints[start.joint].name;
    const auto& joints = model.fixtures[there].joints;
    const auto joint = std::ranges::find(joints, name, &Fixture::Joint::name);
    if (joint == joints.end()) continue;
    start.fixture = there;
    start.joint = static_cast<std::uint32_t>(joint - joints.begin());
  }
  for (SkillUse& use : task.solution) {
    for (SkillOperand* operand : {&use.what, &use.to}) {
      const FixtureId named = fixture_named(model, operand->owner.text);
      if (named == FixtureId::kNone) continue;
      const FixtureId there = standing_for(model, scene, named);
      if (there != FixtureId::kNone) operand->owner.text = model.fixtures[there].name;
    }
  }
}

}  // namespace probe::sema
