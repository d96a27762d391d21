#include "compiler/define/axes.h"

#include <algorithm>
#include <cmath>

#include "compiler/define/fixture.h"
#include "compiler/define/motion.h"
#include "compiler/define/replaced.h"
#include "compiler/define/role.h"
#include "compiler/define/starts.h"
#include "compiler/define/task.h"
#include "compiler/define/telling.h"
#include "compiler/define/template.h"
#include "compiler/define/views.h"
#include "compiler/define/wording.h"
#include "compiler/model/same.h"
#include "compiler/names/name_table.h"
#include "runtime/plan/axes.h"

namespace probe::sema {
namespace {

bool same_cells(const Layout& a, const std::string& name_a, const Layout& b,
                const std::string& name_b) {
  const auto find = [](const Layout& layout, const std::string& name) {
    return std::find_if(layout.cells.begin(), layout.cells.end(),
                        [&](const Cells& c) { return c.name == name; });
  };
  const auto cells_a = find(a, name_a);
  const auto cells_b = find(b, name_b);
  if (cells_a == a.cells.end() || cells_b == b.cells.end())
    return (cells_a == a.cells.end()) == (cells_b == b.cells.end());
  if (cells_a->grids.size() != cells_b->grids.size()) return false;
  for (std::size_t g = 0; g < cells_a->grids.size(); ++g) {
    const auto& grid_a = cells_a->grids[g];
    const auto& grid_b = cells_b->grids[g];
    if (!std::equal(grid_a.begin(), grid_a.end(), grid_b.begin(), grid_b.end(),
                    [](const Cell& p, const Cell& q) { return p.x == q.x && p.y == q.y; })) {
      return false;
    }
  }
  return true;
}

bool same_words(const std::vector<Spelled>& a, const std::vector<Spelled>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const Spelled& p, const Spelled& q) { return p.text == q.text; });
}

// Whether they take the same of a layout's starts and begin as long after. Which starts phrases
// leave is known when they are enumerated: the words alone say nothing, another phrase may be clear
// in the same starts, and the same one in others where the camera is another.
bool same_choice(const Task& a, const Task& b) {
  if (a.idle != b.idle) return false;
  if (a.clear.empty() && b.clear.empty()) return true;
  if (!a.starts.empty() && !b.starts.empty()) return start_at_same_places(a, b);
  return std::equal(a.clear.begin(), a.clear.end(), b.clear.begin(), b.clear.end(),
                    [](const ClearPhrase& p, const ClearPhrase& q) {
                      return p.role == q.role && p.phrase.text == q.phrase.text;
                    });
}

// Of one start of two tables; what only one of them has comes with its object and is no change of
// its own.
bool same_places(const std::vector<GivenPlace>& a, const std::vector<GivenPlace>& b) {
  return std::ranges::all_of(a, [&](const GivenPlace& place) {
    const auto other = std::ranges::find_if(
        b, [&](const GivenPlace& one) { return one.what.text == place.what.text; });
    return other == b.end() || place.is_same(*other);
  });
}

bool same_layout(const Layout& a, const Layout& b) {
  if (&a == &b) return true;
  if (a.by_rest != b.by_rest || a.jitter != b.jitter || a.drop != b.drop || a.settle != b.settle)
    return false;
  if (a.places.size() != b.places.size() || a.orients.size() != b.orients.size()) return false;
  for (std::size_t i = 0; i < a.places.size(); ++i) {
    const Place& p = a.places[i];
    const Place& q = b.places[i];
    if (p.how != q.how || !same_words(p.what, q.what)) return false;
    if (p.is_put() && p.where.text != q.where.text) return false;
    if (p.is_put()) continue;
    if (p.how == Place::kAt ? (p.at.x != q.at.x || p.at.y != q.at.y)
                            : !same_cells(a, p.cells, b, q.cells))
      return false;
  }
  if (!std::ranges::equal(a.given, b.given, same_places)) return false;
  for (std::size_t i = 0; i < a.orients.size(); ++i) {
    if (a.orients[i].what.text != b.orients[i].what.text ||
        a.orients[i].turns != b.orients[i].turns)
      return false;
  }
  return true;
}

// Where the joints of a task's arm begin that its file of starts says, start by start: what repeats
// the scene says nothing.
std::vector<std::vector<GivenJoint>> given_arms(const Model& model, const Task& task) {
  const Scene& scene = model.scenes[task.scene];
  std::vector<std::vector<GivenJoint>> arms = model.layouts[task.layout].given_joints;
  for (std::vector<GivenJoint>& start : arms) {
    std::erase_if(start, [&](const GivenJoint& joint) {
      return joint.robot == RobotId::kNone ||
             (joint.robot == scene.robot && joint.joint < scene.joints.size() &&
              joint.value == scene.joints[joint.joint].si());
    });
  }
  return arms;
}

// Whether those of two tasks begin alike. A list without such rows is as long as any.
bool same_given_arms(const Model& model, const Task& a, const Task& b) {
  if (model.layouts[a.layout].given_joints.empty() && model.layouts[b.layout].given_joints.empty())
    return true;
  std::vector<std::vector<GivenJoint>> here = given_arms(model, a), there = given_arms(model, b);
  const std::size_t longest = std::max(here.size(), there.size());
  here.resize(longest);
  there.resize(longest);
  return std::ranges::equal(
      here, there, [](const std::vector<GivenJoint>& p, const std::vector<GivenJoint>& q) {
        return std::ranges::equal(
            p, q, [](const GivenJoint& x, const GivenJoint& y) { return x.is_same(y); });
      });
}

// A pose of an object that only one of the two has comes with that object and is no change of its
// own.
bool same_poses(const Model& model, const Task& a, const Task& b) {
  if (a.poses.empty() && b.poses.empty()) return true;
  const std::vector<ObjectId> others = b.objects();
  for (const ObjectId object : a.objects()) {
    if (std::find(others.begin(), others.end(), object) == others.end()) continue;
    if (rest_of(model, a, object) != rest_of(model, b, object)) return false;
  }
  return true;
}

std::string_view text_of(const std::optional<Spelled>& value) {
  return value ? std::string_view(value->text) : std::string_view();
}

std::string_view main_photo(const Scene& scene) {
  return scene.views.empty() ? std::string_view() : text_of(scene.views.front().overlay);
}

// Whether both see what one scene has, and nothing else.
bool see_one_scene(const Task& a, const Task& b) {
  return a.scene == b.scene && a.cameras.empty() && b.cameras.empty();
}

// Whether policies get the same pictures under the same names. The photo behind the first is the
// scene's; alone it needs no name.
bool same_cameras(const Model& model, const Task& a, const Task& b) {
  if (see_one_scene(a, b)) return true;
  const std::vector<View> here = views_of(model, a), there = views_of(model, b);
  if (here.size() != there.size()) return false;
  for (std::size_t i = 0; i < here.size(); ++i) {
    if (!(model.cameras[here[i].camera] == model.cameras[there[i].camera])) return false;
    if (has_names(here) && here[i].name != there[i].name) return false;
    if (i > 0 && text_of(here[i].overlay) != text_of(there[i].overlay)) return false;
  }
  return has_names(here) == has_names(there);
}

// What the cameras do to their pictures; of other views it is no question.
bool same_sensors(const Model& model, const Task& a, const Task& b) {
  if (see_one_scene(a, b)) return true;
  const std::vector<View> here = views_of(model, a), there = views_of(model, b);
  if (here.size() != there.size()) return true;
  for (std::size_t i = 0; i < here.size(); ++i) {
    if (!(model.cameras[here[i].camera].sensor == model.cameras[there[i].camera].sensor))
      return false;
  }
  return true;
}

bool same_covers(const Scene& a, const Scene& b) {
  return std::equal(a.covers.begin(), a.covers.end(), b.covers.begin(), b.covers.end(),
                    [](const auto& p, const auto& q) {
                      return p.first == q.first && p.second.is_same(q.second);
                    });
}

// The same robot among the same things. Camera, light, textures and the surface's height are axes of
// their own.
bool same_stage(const Model& model, const Scene& a, const Scene& b) {
  const auto joints = [](const Scene& scene) {
    std::vector<double> values;
    for (const Quantity& joint : scene.joints) values.push_back(joint.si());
    return values;
  };
  return a.robot == b.robot &&
         stands_alike(a.base_position, a.surface_z, b.base_position, b.surface_z) &&
         a.base_turn == b.base_turn && joints(a) == joints(b) && a.area == b.area &&
         text_of(a.fixture) == text_of(b.fixture) &&
         stands_alike(a.fixture_position, a.surface_z, b.fixture_position, b.surface_z) &&
         text_of(a.backdrop) == text_of(b.backdrop) && a.backdrop_stands == b.backdrop_stands &&
         main_photo(a) == main_photo(b) && same_fixtures(model, a, b);
}

bool same_physics(const Scene& a, const Scene& b) {
  return a.physics_hz == b.physics_hz && a.friction == b.friction &&
         a.air_density == b.air_density && a.air_viscosity == b.air_viscosity;
}

bool same_scene(const Model& model, const Scene& a, const Scene& b) {
  return same_physics(a, b) && same_stage(model, a, b);
}

bool is_same_place(const Model& model, const Scene& a, const Scene& b) {
  return same_scene(model, a, b) && same_covers(a, b) && a.surface_z == b.surface_z;
}

// The same time is the same at any control rate.
bool same_horizon(const Task& a, const Task& b) {
  if (a.horizon_time && b.horizon_time) return a.horizon_time->si() == b.horizon_time->si();
  return a.horizon == b.horizon;
}

bool same_goal(const Model& model, const Task& a, const Task& b) {
  return same_horizon(a, b) &&
         std::equal(a.judged.begin(), a.judged.end(), b.judged.begin(), b.judged.end(),
                    [&](const Metric& p, const Metric& q) {
                      return p.name == q.name && p.readout == q.readout &&
                             (p.expr == q.expr || same_expression(model, p.expr, q.expr));
                    });
}

bool is_seen(const Object& object) { return !object.seen_in.empty(); }

// Nothing but words and tags tells the two apart.
bool is_same_body(const Object& a, const Object& b) {
  const auto paint = [](const Object& object) {
    return object.paint ? std::optional(object.paint->rgb) : std::nullopt;
  };
  if (a.scale != b.scale || paint(a) != paint(b) ||
      a.texture.has_value() != b.texture.has_value() ||
      (a.texture && !a.texture->is_same(*b.texture)))
    return false;
  return a.mesh.text == b.mesh.text && a.box_min == b.box_min && a.box_max == b.box_max &&
         a.density == b.density && a.mass == b.mass && a.damping == b.damping &&
         a.friction == b.friction;
}

// The same roles are filled, each by as many objects.
bool same_shape(const Task& a, const Task& b) {
  const auto same_number = [](const Task::Filled& p, const Task::Filled& q) {
    return p.role == q.role && p.objects.size() == q.objects.size();
  };
  return (a.source == ObjectId::kNone) == (b.source == ObjectId::kNone) &&
         (a.target == ObjectId::kNone) == (b.target == ObjectId::kNone) &&
         std::equal(a.others.begin(), a.others.end(), b.others.begin(), b.others.end(),
                    same_number);
}

// Whether a policy hears the same. Their instructions are made up.
bool same_prompts(const Task& a, const Task& b) {
  return a.prompt == b.prompt &&
         std::ranges::equal(a.later, b.later, {}, &LaterSentence::text, &LaterSentence::text);
}

// A layout that speaks of objects by their own names.
bool places_by_name(const Model& model, const Layout& layout) {
  const auto is_name = [&](const Spelled& word) {
    return word.text != "distractors" && !find_role(model, word.text);
  };
  const auto names_any = [&](const Place& place) {
    return std::ranges::any_of(place.what, is_name);
  };
  return std::ranges::any_of(layout.places, names_any) ||
         std::ranges::any_of(layout.orients, is_name, &Orient::what) ||
         (!layout.given.empty() &&
          std::ranges::any_of(layout.given.front(), is_name, &GivenPlace::what));
}

// Whether a policy hears, sees and is judged by the same, whatever declarations say it. What tells
// most tasks apart comes first.
bool is_same_experiment(const Model& model, const Task& a, const Task& b) {
  if (!same_prompts(a, b)) return false;
  const Layout& layout = model.layouts[a.layout];
  if (!same_goal(model, a, b) || !same_layout(layout, model.layouts[b.layout]) ||
      !same_choice(a, b) ||
      (a.scene != b.scene && !is_same_place(model, model.scenes[a.scene], model.scenes[b.scene])) ||
      layout.joints_jitter != model.layouts[b.layout].joints_jitter ||
      !same_given_arms(model, a, b) || a.delay != b.delay || !same_motions(model, a, b) ||
      !same_sensors(model, a, b) ||
      !(model.lights[light_of(model, a)] == model.lights[light_of(model, b)]) ||
      !same_cameras(model, a, b) ||
      joint_starts_in_all(model, a) != joint_starts_in_all(model, b) ||
      a.distractors.size() != b.distractors.size() || !same_shape(a, b) || a.things() != b.things() ||
      !std::ranges::is_permutation(a.part_distractors, b.part_distractors))
    return false;
  // The order of distractors that both have is no difference.
  std::vector<ObjectId> here = a.objects(), there = b.objects();
  if (here.size() != there.size()) return false;
  const auto in_roles =
      static_cast<std::ptrdiff_t>(here.size() - a.distractors.size() - a.placed.size());
  std::sort(here.begin() + in_roles, here.end());
  std::sort(there.begin() + in_roles, there.end());
  // A layout that jitters, or that names objects, puts a twin elsewhere.
  const bool tells_twins =
      here != there && (layout.jitter > 0 || places_by_name(model, layout));
  for (std::size_t i = 0; i < here.size(); ++i) {
    if (here[i] != there[i] &&
        (tells_twins || !is_same_body(model.objects[here[i]], model.objects[there[i]])))
      return false;
    if (rest_of(model, a, here[i]) != rest_of(model, b, there[i])) return false;
  }
  return same_turns(model, a, b);
}

}  // namespace

namespace {

// How a task differs from its baseline, one axis at a time.
class Comparison {
 public:
  Comparison(const Model& model, const Task& task, const Task& baseline)
      : model_(model),
        task_(task),
        baseline_(baseline),
        stage_moves_(task.scene != baseline.scene &&
                     !same_stage(model, model.scenes[task.scene], model.scenes[baseline.scene])),
        scene_moves_(stage_moves_ || !same_physics(model.scenes[task.scene],
                                                   model.scenes[baseline.scene])),
        action_moves_(asks_otherwise(model, task, baseline)) {}

  bool moves(plan::Axis axis) const {
    switch (axis) {
      case plan::Axis::kObjectSource:
        return !is_same(task_.source, baseline_.source);
      case plan::Axis::kObjectTarget:
        return !is_same(task_.target, baseline_.target);
      case plan::Axis::kObjectOther: {
        if (task_.others.empty() && baseline_.others.empty()) return false;
        for (std::size_t i = 0; i < model_.roles.size(); ++i) {
          if (other_moves(model_, task_, baseline_, model_.roles.id(i))) return true;
        }
        return false;
      }
      case plan::Axis::kDistractors:
        return !std::ranges::is_permutation(task_.distractors, baseline_.distractors) ||
               !std::ranges::is_permutation(task_.part_distractors,
                                            seen_from(task_, baseline_.part_distractors));
      case plan::Axis::kLanguageAction:
        return action_moves_;
      case plan::Axis::kLanguageNegation:
        return has_negation(model_, task_) != has_negation(model_, baseline_);
      case plan::Axis::kLanguageAppearance:
      case plan::Axis::kLanguageCommonsense:
      case plan::Axis::kLanguageSpatial:
        return phrase_moves(axis);
      case plan::Axis::kLanguageParaphrase:
        return !action_moves_ && has_other_words(model_, task_, baseline_);
      case plan::Axis::kLayout:
        return !same_layout(model_.layouts[task_.layout], model_.layouts[baseline_.layout]) ||
               !same_choice(task_, baseline_) || !same_poses(model_, task_, baseline_);
      case plan::Axis::kScene:
        return scene_moves_;
      case plan::Axis::kSceneTexture:
        return !stage_moves_ && task_.scene != baseline_.scene &&
               !same_covers(scene(task_), scene(baseline_));
      case plan::Axis::kSceneGeometry:
        return !stage_moves_ && scene(task_).surface_z != scene(baseline_).surface_z;
      // Another scene's joints begin where they do.
      case plan::Axis::kFixture:
        return !stage_moves_ &&
               joint_starts_in_all(model_, task_) != joint_starts_in_all(model_, baseline_);
      // Another scene comes with its own camera and light; only an override makes them a change of
      // their own. One of other friction alone does not.
      case plan::Axis::kLight:
        return (!stage_moves_ || task_.light != LightId::kNone ||
                baseline_.light != LightId::kNone) &&
               !(model_.lights[light_of(model_, task_)] ==
                 model_.lights[light_of(model_, baseline_)]);
      case plan::Axis::kCamera:
        return (!stage_moves_ || !task_.cameras.empty() || !baseline_.cameras.empty()) &&
               !same_cameras(model_, task_, baseline_);
      case plan::Axis::kSensor:
        return !same_sensors(model_, task_, baseline_);
      case plan::Axis::kRobot:
        return model_.layouts[task_.layout].joints_jitter !=
                   model_.layouts[baseline_.layout].joints_jitter ||
               !same_given_arms(model_, task_, baseline_);
      case plan::Axis::kLatency:
        return task_.delay != baseline_.delay;
      case plan::Axis::kMotion:
        return !same_motions(model_, task_, baseline_);
      case plan::Axis::kGoal:
        return !same_goal(model_, task_, baseline_);
    }
    return false;
  }

 private:
  const Scene& scene(const Task& task) const { return model_.scenes[task.scene]; }
  // A drawer of the cabinet that stands in the very place of the baseline's is that drawer.
  bool is_same(ObjectId here, ObjectId there) const {
    return here == same_as(model_, scene(task_), there);
  }
  std::vector<ObjectId> seen_from(const Task& task, std::vector<ObjectId> things) const {
    for (ObjectId& thing : things) thing = same_as(model_, scene(task), thing);
    return things;
  }

  bool phrase_moves(plan::Axis axis) const {
    if (task_.refer.empty() && baseline_.refer.empty()) return false;
    for (std::size_t i = 0; i < model_.roles.size(); ++i) {
      if (phrase_moves(axis, model_.roles.id(i))) return true;
    }
    return false;
  }
  bool phrase_moves(plan::Axis axis, RoleId role) const {
    const Phrase* now = referring(model_, task_, role).phrase;
    const Phrase* then = referring(model_, baseline_, role).phrase;
    if (now == nullptr && then == nullptr) return false;
    const bool same_object = task_.objects_in(role) == baseline_.objects_in(role);
    if (now != nullptr && then != nullptr) {
      // Two phrases of different objects are alike when they refer in the same way.
      if (same_object ? now->name == then->name : now->axis == then->axis) return false;
    }
    return (now != nullptr ? now : then)->axis == axis;
  }

  const Model& model_;
  const Task& task_;
  const Task& baseline_;
  bool stage_moves_;  // other things stand there: nothing else of the scene is told apart
  bool scene_moves_;
  bool action_moves_;  // the words ask for another action
};

}  // namespace

bool other_moves(const Model& model, const Task& task, const Task& baseline, RoleId role) {
  if (role == RoleId::kSource || role == RoleId::kTarget) return false;
  std::vector<ObjectId> there = baseline.objects_in(role);
  for (ObjectId& thing : there) thing = same_as(model, model.scenes[task.scene], thing);
  return task.objects_in(role) != there;
}

std::uint32_t axes_between(const Model& model, const Task& task, const Task& baseline) {
  if (is_same_experiment(model, task, baseline)) return 0;
  const Comparison comparison(model, task, baseline);
  std::uint32_t mask = 0;
  for (const plan::AxisInfo& info : plan::kAxisTable)
    mask |= comparison.moves(info.axis) ? bit(info.axis) : 0;
  return mask;
}

bool differs(const Model& model, const Task& task, const Task& baseline) {
  if (is_same_experiment(model, task, baseline)) return false;
  const Comparison comparison(model, task, baseline);
  return std::ranges::any_of(
      plan::kAxisTable, [&](const plan::AxisInfo& info) { return comparison.moves(info.axis); });
}

std::optional<plan::Axis> phrase_axis(Diagnostics& diagnostics, const syntax::Name& word) {
  std::vector<std::string_view> words;
  for (const plan::AxisInfo& info : plan::kAxisTable) {
    if (!info.is_phrase) continue;
    if (info.word() == word.text) return info.axis;
    words.push_back(info.word());
  }
  report_unknown(diagnostics, "axis", word, words);
  return std::nullopt;
}

std::uint32_t out_of_distribution(const Model& model, const Task& task) {
  if (model.datasets.size() == 0) return 0;
  const auto is_new = [&](ObjectId id) {
    return id != ObjectId::kNone && task.is_object(id) && !is_seen(model.objects[id]);
  };
  const std::uint32_t mask = (is_new(task.source) ? 1u : 0u) | (is_new(task.target) ? 2u : 0u);
  if (mask != 0 || !task.has_both()) return mask;
  for (const Dataset& dataset : model.datasets) {
    for (const Dataset::Relation& relation : dataset.relations) {
      if (relation.subject == task.source && relation.object == task.target) return 0;
    }
  }
  return 4;
}

namespace {

// What a task is compared with in the end; itself when it has no baseline.
const Task& root_of(const Model& model, const Task& task) {
  const Task* root = &task;
  for (std::size_t hops = 0; root->baseline != TaskId::kNone && hops < model.tasks.size(); ++hops) {
    root = &model.tasks[root->baseline];
  }
  return *root;
}

bool has_phrase(const Model& model, const Task& task, plan::Axis axis) {
  for (std::size_t i = 0; i < model.roles.size(); ++i) {
    const Phrase* phrase = referring(model, task, model.roles.id(i)).phrase;
    if (phrase != nullptr && phrase->axis == axis) return true;
  }
  return false;
}

}  // namespace

bool uses(const Model& model, const Task& task, plan::Axis axis) {
  const Task& root = root_of(model, task);
  switch (axis) {
    case plan::Axis::kLanguageAction:
      return root.complete && asks_otherwise(model, task, root);
    case plan::Axis::kLanguageNegation:
      return has_negation(model, task);
    case plan::Axis::kLanguageAppearance:
    case plan::Axis::kLanguageCommonsense:
    case plan::Axis::kLanguageSpatial:
      return has_phrase(model, task, axis);
    case plan::Axis::kLanguageParaphrase:
      return root.complete && is_reworded(model, task, root);
    case plan::Axis::kObjectSource:
    case plan::Axis::kObjectTarget:
    case plan::Axis::kObjectOther:
    case plan::Axis::kDistractors:
    case plan::Axis::kLayout:
    case plan::Axis::kScene:
    case plan::Axis::kFixture:
    case plan::Axis::kLight:
    case plan::Axis::kCamera:
    case plan::Axis::kSceneTexture:
    case plan::Axis::kSceneGeometry:
    case plan::Axis::kSensor:
    case plan::Axis::kRobot:
    case plan::Axis::kLatency:
    case plan::Axis::kMotion:
    case plan::Axis::kGoal:
      break;
  }
  return false;
}

}  // namespace probe::sema
