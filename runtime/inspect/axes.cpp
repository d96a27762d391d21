#include "runtime/inspect/axes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "runtime/plan/fixtures.h"
#include "runtime/plan/ids.h"
#include "runtime/plan/later.h"
#include "runtime/plan/roles.h"
#include "runtime/plan/shakes.h"

namespace probe::inspect {
namespace {

using ByRole = std::vector<std::pair<std::string_view, std::vector<std::uint32_t>>>;
ByRole objects_by_role(const plan::Plan& plan, const plan::TaskRecord& task) {
  ByRole all;
  for (const plan::RoleRecord& role : plan::roles_of(plan.tables(), task).others) {
    if (role.kind == static_cast<std::uint32_t>(plan::RoleKind::kPlaced)) continue;
    auto& objects = all.emplace_back(plan.text(role.name), std::vector<std::uint32_t>()).second;
    for (const plan::BodyRecord& body : plan.bodies(task).subspan(role.first, role.count))
      objects.push_back(body.index);
  }
  return all;
}

std::vector<std::uint32_t> distractors(const plan::Plan& plan, const plan::TaskRecord& task) {
  std::vector<std::uint32_t> objects;
  const plan::Slice slice = plan::roles_of(plan.tables(), task).distractors;
  for (const plan::BodyRecord& body : plan.bodies(task).subspan(slice.first, slice.count)) {
    objects.push_back(body.index);
  }
  std::sort(objects.begin(), objects.end());
  return objects;
}

// Declared roles that parts and regions fill, by name, those of a set in its order.
std::vector<std::pair<std::string_view, std::string_view>> others_of_things(
    const plan::Plan& plan, const plan::TaskRecord& task) {
  std::vector<std::pair<std::string_view, std::string_view>> all;
  for (const plan::RoleRecord& role : plan::roles_of(plan.tables(), task).things) {
    const std::string_view name = plan.text(role.name);
    if (name != "source" && name != "target" && !plan::is_part_distractor(role))
      all.emplace_back(name, plan::thing_in(plan.tables(), task, role));
  }
  std::ranges::stable_sort(all, {}, [](const auto& one) { return one.first; });
  return all;
}

// Whether the declared roles are filled by the same objects, those of a set in the same order.
bool same_others(const plan::Plan& plan, const plan::TaskRecord& a, const plan::TaskRecord& b) {
  return objects_by_role(plan, a) == objects_by_role(plan, b) &&
         others_of_things(plan, a) == others_of_things(plan, b);
}

// The part or region that is source or target; empty where none is.
bool same_thing(const plan::Plan& plan, const plan::TaskRecord& a, const plan::TaskRecord& b,
                std::string_view role) {
  return plan::thing_in(plan.tables(), a, role) == plan::thing_in(plan.tables(), b, role);
}

void replace_all(std::string& text, std::string_view what, std::string_view by) {
  if (what.empty()) return;
  for (std::size_t at = text.find(what); at != std::string::npos;
       at = text.find(what, at + by.size())) {
    text.replace(at, what.size(), by);
  }
}

// The instruction with the names of its objects taken out, the longer name first: one may be part
// of the other.
std::string frame_of(const plan::Plan& plan, const plan::TaskRecord& task) {
  std::string text(plan.text(task.prompt));
  const plan::TaskRoles roles = plan::roles_of(plan.tables(), task);
  std::vector<std::pair<std::string_view, std::string>> names;
  for (std::uint32_t i = 0; i < roles.distractors.first; ++i) {
    names.emplace_back(plan.text(plan.objects()[plan.bodies(task)[i].index].text),
                       "{" + plan::label_of_body(plan.tables(), roles, i) + "}");
  }
  // What parts are called, too; a region without a name of its own is called as its part.
  for (const plan::RoleRecord& role : roles.things) {
    if (role.kind == static_cast<std::uint32_t>(plan::RoleKind::kRegion)) continue;
    const std::uint32_t part = plan.bodies(task)[role.first].index;
    names.emplace_back(plan.text(plan.parts()[part].text),
                       "{" + std::string(plan.text(role.name)) + "}");
  }
  std::stable_sort(names.begin(), names.end(),
                   [](const auto& a, const auto& b) { return a.first.size() > b.first.size(); });
  for (const auto& [name, role] : names) replace_all(text, name, role);
  return text;
}

// Whether the same sentences come later, the same brings them.
bool same_later(const plan::Plan& plan, std::uint32_t a, std::uint32_t b) {
  return std::ranges::equal(
      plan::later_of(plan.tables(), a), plan::later_of(plan.tables(), b),
      [&](const plan::LaterRecord& p, const plan::LaterRecord& q) {
        return plan.text(p.text) == plan.text(q.text) &&
               plan.programs()[p.program].hash == plan.programs()[q.program].hash;
      });
}

// Whether one is the other's baseline and the compiler says that the axis does not move between
// them.
bool is_kept(const plan::Plan& plan, const plan::TaskRecord& a, const plan::TaskRecord& b,
             plan::Axis axis) {
  const plan::TaskRecord* const table = plan.tasks().data();
  const auto is_of = [&](const plan::TaskRecord& variant, const plan::TaskRecord& baseline) {
    return variant.baseline == static_cast<std::uint32_t>(&baseline - table) &&
           !plan::moves(variant.axes, axis);
  };
  return is_of(a, b) || is_of(b, a);
}

// Where things stand, in what order, and how they get there. A turn counts only where the same
// object stands in both: rest poses belong to the object. Heights belong to the scene. `jitter`
// shifts every object in its own way, and the plan does not say by how much: where nothing but
// another object stands elsewhere, the compiler's word for a task and its baseline decides.
bool same_layout(const plan::Plan& plan, const plan::TaskRecord& a, const plan::TaskRecord& b,
                 bool same_distractors) {
  const auto ours = plan.episodes(a);
  const auto theirs = plan.episodes(b);
  if (a.drop != b.drop || a.settle != b.settle || a.idle != b.idle || ours.size() != theirs.size())
    return false;
  const plan::TaskRoles ours_by_role = plan::roles_of(plan.tables(), a);
  const plan::TaskRoles theirs_by_role = plan::roles_of(plan.tables(), b);
  // Of tasks with other roles those bodies are compared that have a role in both.
  const std::size_t in_roles =
      std::min(ours_by_role.distractors.first, theirs_by_role.distractors.first);
  const bool same_shape = ours_by_role.distractors.first == theirs_by_role.distractors.first &&
                          ours_by_role.objects == theirs_by_role.objects;
  const std::size_t compared = same_distractors && same_shape ? ours_by_role.objects : in_roles;
  const bool is_said_to_be = is_kept(plan, a, b, plan::Axis::kLayout);
  for (std::size_t e = 0; e < ours.size(); ++e) {
    const auto here = plan.placements(ours[e]);
    const auto there = plan.placements(theirs[e]);
    for (std::size_t i = 0; i < compared; ++i) {
      const bool is_other = here[i].object != there[i].object;
      const bool stands_there = here[i].position[0] == there[i].position[0] &&
                                here[i].position[1] == there[i].position[1];
      if (!stands_there && !(is_other && is_said_to_be)) return false;
      if (!is_other && here[i].rotation != there[i].rotation) return false;
    }
  }
  return true;
}

// Whether the two would be judged alike with the robot's law and rate of one: those are the
// scene's.
bool same_judge(plan::IdHasher& hasher, const plan::TaskRecord& a, plan::TaskRecord b) {
  b.scene = a.scene;
  return hasher.judge(a) == hasher.judge(b);
}

// A quantifier over objects unrolls with their number, so equal metrics may be unequal programs
// when the scenes hold different bodies, and so may metrics of a role that another part fills; then
// the compiler's word for a task and its baseline decides, or the words they were written with, as
// far as the plan has them.
bool same_goal(const plan::Plan& plan, plan::IdHasher& hasher, const plan::TaskRecord& a,
               const plan::TaskRecord& b) {
  if (a.horizon != b.horizon) return false;
  if (same_judge(hasher, a, b)) return true;
  const auto ours = plan.metrics(a);
  const auto theirs = plan.metrics(b);
  const bool same_things = same_thing(plan, a, b, "source") && same_thing(plan, a, b, "target") &&
                           others_of_things(plan, a) == others_of_things(plan, b);
  if ((a.bodies.count == b.bodies.count && same_things) || ours.size() != theirs.size())
    return false;
  if (is_kept(plan, a, b, plan::Axis::kGoal)) return true;
  const plan::MetricRecord* const table = plan.metrics().data();
  for (std::size_t m = 0; m < ours.size(); ++m) {
    if (plan.text(ours[m].name) != plan.text(theirs[m].name) || ours[m].type != theirs[m].type ||
        ours[m].readout != theirs[m].readout)
      return false;
    const plan::SpanRecord* here =
        plan.span_of(plan::SpanKind::kMetrics, static_cast<std::uint32_t>(&ours[m] - table));
    const plan::SpanRecord* there =
        plan.span_of(plan::SpanKind::kMetrics, static_cast<std::uint32_t>(&theirs[m] - table));
    if (here != nullptr && there != nullptr &&
        (here->text != there->text || here->begin != there->begin))
      return false;
  }
  return true;
}

// Whether the arm begins alike in all starts; of another scene's arm it is no question.
bool same_arms(const plan::Plan& plan, const plan::TaskRecord& a, const plan::TaskRecord& b) {
  const auto ours = plan.episodes(a), theirs = plan.episodes(b);
  const auto arm = [&](const plan::EpisodeRecord& episode) {
    return plan::slice_of(plan.tables().reals, episode.arm);
  };
  for (std::size_t e = 0; e < std::min(ours.size(), theirs.size()); ++e) {
    if (!std::ranges::equal(arm(ours[e]), arm(theirs[e]))) return false;
  }
  return true;
}

// Whether the cameras stand alike in all starts that both have.
bool same_shakes(const plan::Plan& plan, const plan::TaskRecord& a, const plan::TaskRecord& b) {
  const auto ours = plan.episodes(a), theirs = plan.episodes(b);
  for (std::size_t e = 0; e < std::min(ours.size(), theirs.size()); ++e) {
    if (!std::ranges::equal(plan::shakes_of(plan.tables(), ours[e]),
                            plan::shakes_of(plan.tables(), theirs[e])))
      return false;
  }
  return true;
}

bool same_moves(const plan::Plan& plan, const plan::TaskRecord& a, const plan::TaskRecord& b) {
  const auto legs = [&](const plan::TaskRecord& task) {
    return plan::slice_of(plan.tables().moves, task.moves);
  };
  return std::ranges::equal(
      legs(a), legs(b), [](const plan::MoveRecord& p, const plan::MoveRecord& q) {
        return p.body == q.body && p.way == q.way && p.to == q.to && p.speed == q.speed;
      });
}

// Whether what stands at `b` stands as at `a` where surfaces are of different heights: at the same
// place, or as high above the surface.
bool stands_alike(const std::array<double, 3>& a, double surface_a, const std::array<double, 3>& b,
                  double surface_b) {
  constexpr double kRounding = 1e-9;  // m
  const double above = (a[2] - surface_a) - (b[2] - surface_b);
  return a[0] == b[0] && a[1] == b[1] && (a[2] == b[2] || std::abs(above) <= kRounding);
}

// All of a fixture but where it stands and where its joints begin.
bool acts_alike(const plan::Plan& plan, const plan::FixtureRecord& a,
                const plan::FixtureRecord& b) {
  const plan::Tables& tables = plan.tables();
  const auto same_joint = [&](const plan::FixtureJointRecord& p,
                              const plan::FixtureJointRecord& q) {
    return plan.text(p.joint) == plan.text(q.joint) && p.motion == q.motion && p.lower == q.lower &&
           p.upper == q.upper && p.friction == q.friction && p.damping == q.damping &&
           p.stiffness == q.stiffness && p.rest == q.rest;
  };
  const auto same_shown = [&](const plan::ShownRecord& p, const plan::ShownRecord& q) {
    return plan.text(p.link) == plan.text(q.link) && p.joint == q.joint && p.side == q.side &&
           p.at == q.at;
  };
  return a.urdf == b.urdf && a.rotation == b.rotation && a.friction == b.friction &&
         std::ranges::equal(plan::slice_of(tables.list, a.meshes),
                            plan::slice_of(tables.list, b.meshes)) &&
         std::ranges::equal(plan.armatures(a), plan.armatures(b)) &&
         std::ranges::equal(plan::slice_of(tables.fixture_joints, a.joints),
                            plan::slice_of(tables.fixture_joints, b.joints), same_joint) &&
         std::ranges::equal(plan::slice_of(tables.shown, a.shown),
                            plan::slice_of(tables.shown, b.shown), same_shown);
}

// Whether the rest of two scenes is alike whose surfaces are of different heights.
bool same_but_for_height(const plan::Plan& plan, plan::IdHasher& hasher, plan::SceneRecord here,
                         plan::SceneRecord there) {
  const auto fixtures = [&](const plan::SceneRecord& scene) {
    return plan::slice_of(plan.tables().list, scene.fixtures);
  };
  const auto same_fixture = [&](std::uint32_t p, std::uint32_t q) {
    const plan::FixtureRecord &a = plan.fixtures()[p], &b = plan.fixtures()[q];
    return acts_alike(plan, a, b) &&
           stands_alike(a.position, here.surface_z, b.position, there.surface_z);
  };
  if (!std::ranges::equal(fixtures(here), fixtures(there), same_fixture) ||
      !stands_alike(here.base_position, here.surface_z, there.base_position, there.surface_z) ||
      !stands_alike(here.fixture_position, here.surface_z, there.fixture_position, there.surface_z))
    return false;
  here.fixtures = there.fixtures = {};
  there.base_position = here.base_position;
  there.fixture_position = here.fixture_position;
  there.surface_z = here.surface_z;
  return hasher.surroundings_at(here, here.surface_z) ==
         hasher.surroundings_at(there, here.surface_z);
}

// Whether both descend from one task, and by what the compiler says of each step no words moved on
// the way to either.
bool same_words_since(const plan::Plan& plan, std::uint32_t a, std::uint32_t b) {
  const auto root = [&](std::uint32_t task) -> std::optional<std::uint32_t> {
    for (std::uint32_t up = plan.tasks()[task].baseline; up != plan::kNone;
         up = plan.tasks()[task].baseline) {
      if ((plan.tasks()[task].axes & plan::kLanguageAxes) != 0) return std::nullopt;
      task = up;
    }
    return task;
  };
  const auto ours = root(a);
  return ours && ours == root(b);
}

std::vector<double> joint_starts(const plan::Plan& plan, const plan::TaskRecord& task) {
  return plan::joint_starts_of(plan.tables(), plan.scenes()[task.scene], plan.episodes(task)[0]);
}

}  // namespace

Difference difference(const plan::Plan& plan, std::uint32_t first, std::uint32_t second) {
  const plan::TaskRecord& a = plan.tasks()[first];
  const plan::TaskRecord& b = plan.tasks()[second];
  const bool same_distractors = distractors(plan, a) == distractors(plan, b),
             same_part_distractors = std::ranges::is_permutation(
                 plan::part_distractors_of(plan.tables(), a),
                 plan::part_distractors_of(plan.tables(), b));
  // Scenes, cameras and lights are compared by content: by those parts of starts without objects.
  plan::IdHasher hasher(plan.tables());
  const auto ours = hasher.start_parts(a, {}), theirs = hasher.start_parts(b, {});
  const auto is_same = [&](std::string_view name) {
    const auto part = [name](const auto& parts) {
      return std::ranges::find(parts, name, &plan::IdHasher::StartPart::name)->hash;
    };
    return part(ours) == part(theirs);
  };
  // What only some starts have.
  const auto is_same_of_some = [&](std::string_view name) {
    const auto part = [name](const auto& parts) {
      const auto at = std::ranges::find(parts, name, &plan::IdHasher::StartPart::name);
      return at == parts.end() ? std::nullopt : std::optional(at->hash);
    };
    return part(ours) == part(theirs);
  };
  const plan::SceneRecord &here = plan.scenes()[a.scene], &there = plan.scenes()[b.scene];
  plan::TaskRecord elsewhere = a;
  elsewhere.scene = b.scene;
  const bool scene_moves =
      !is_same("robot") ||
      (here.surface_z == there.surface_z ? !is_same("scene")
                                         : !same_but_for_height(plan, hasher, here, there)) ||
      hasher.judge(a) != hasher.judge(elsewhere);  // another law or rate
  const auto moves = [&](plan::Axis axis) {
    switch (axis) {
      case plan::Axis::kObjectSource:
        return a.source != b.source || !same_thing(plan, a, b, "source");
      case plan::Axis::kObjectTarget:
        return a.target != b.target || !same_thing(plan, a, b, "target");
      case plan::Axis::kObjectOther:
        return !same_others(plan, a, b);
      case plan::Axis::kDistractors:
        return !same_distractors || !same_part_distractors;
      case plan::Axis::kLayout:
        return !same_layout(plan, a, b, same_distractors);
      case plan::Axis::kScene:
        return scene_moves;
      case plan::Axis::kSceneTexture:
        return !scene_moves && !is_same_of_some("textures");
      case plan::Axis::kSceneGeometry:
        return !scene_moves && here.surface_z != there.surface_z;
      // All starts of a task have one.
      case plan::Axis::kFixture:
        return !scene_moves && joint_starts(plan, a) != joint_starts(plan, b);
      // Another scene comes with its own camera and light; whether one was chosen on top of that is
      // not in the records.
      case plan::Axis::kLight:
        return !scene_moves && !is_same("light");
      case plan::Axis::kCamera:
        return !scene_moves && (!is_same("camera") || !same_shakes(plan, a, b));
      case plan::Axis::kSensor:
        return a.views.count == b.views.count && !is_same_of_some("sensor");
      case plan::Axis::kRobot:
        return !same_arms(plan, a, b);
      case plan::Axis::kLatency:
        return a.delay != b.delay;
      case plan::Axis::kMotion:
        return !same_moves(plan, a, b);
      case plan::Axis::kGoal:
        return !same_goal(plan, hasher, a, b);
      // Frames and phrases are not in a plan.
      case plan::Axis::kLanguageAction:
      case plan::Axis::kLanguageNegation:
      case plan::Axis::kLanguageAppearance:
      case plan::Axis::kLanguageCommonsense:
      case plan::Axis::kLanguageSpatial:
      case plan::Axis::kLanguageParaphrase:
        break;
    }
    return false;
  };
  Difference found;
  for (const plan::AxisInfo& info : plan::kAxisTable)
    found.axes |= moves(info.axis) ? bit(info.axis) : 0;
  // Words that follow what fills a role ("both cubes") are other words in one frame.
  found.language = !same_words_since(plan, first, second) &&
                   (frame_of(plan, a) != frame_of(plan, b) || !same_later(plan, first, second));
  return found;
}

std::vector<std::string> axes_between(const plan::Plan& plan, std::uint32_t a, std::uint32_t b) {
  if (plan.tasks()[a].baseline == b) return plan::moved_axes(plan.tables(), plan.tasks()[a]);
  if (plan.tasks()[b].baseline == a) return plan::moved_axes(plan.tables(), plan.tasks()[b]);
  const Difference found = difference(plan, a, b);
  std::vector<std::string> names =
      plan::axis_names_between(plan.tables(), found.axes, plan.tasks()[a], plan.tasks()[b]);
  if (found.language) names.emplace_back("language");
  return names;
}

}  // namespace probe::inspect
