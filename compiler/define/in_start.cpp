#include "compiler/define/in_start.h"

#include <algorithm>

#include "compiler/define/fixture.h"
#include "compiler/define/query.h"
#include "compiler/define/thing.h"
#include "compiler/define/views.h"
#include "compiler/geometry/footprint.h"
#include "compiler/geometry/part_place.h"
#include "compiler/geometry/pose.h"
#include "runtime/base/upright.h"
#include "runtime/robot/kinematics.h"

namespace probe::sema {
namespace {

// A fixture's hollows are not known here: what is put down over one may stand so much lower, or on
// a rim so much higher (m).
constexpr double kFixtureBelow = 0.2, kFixtureAbove = 0.1;

using Box = std::array<lower::Interval, 3>;

Box around(const Vec3& at, const Vec3& below, const Vec3& above) {
  Box box;
  for (int i = 0; i < 3; ++i)
    box[static_cast<std::size_t>(i)] = {at[i] - below[i], at[i] + above[i]};
  return box;
}

lower::PlacedBody placed_body(const Scene& scene, const Object& object, const Centre& centre,
                              const Start::Placed& placed) {
  const Mat3 turn = axes_of(placed.turn);
  const Vec3 low(object.box_min.data()), high(object.box_max.data());
  const Vec3 origin(placed.x, placed.y, scene.surface_z - lowest(object, turn));
  Vec3 below = Vec3::Constant(scene.fixture ? kSettlesOnFixture : kSettlesOnSurface);
  Vec3 above = below;
  if (scene.fixture) below.z() = kFixtureBelow, above.z() = kFixtureAbove;
  // What is put down higher may come to rest on something.
  if (placed.z) above.z() += std::max(0.0, *placed.z - origin.z());
  const Vec3 unsure = turn.cwiseAbs() * centre.within;
  lower::PlacedBody body;
  body.origin = around(origin, below, above);
  body.position = around(origin + turn * centre.at, below + unsure, above + unsure);
  const Vec3 half = upright_half((high - low) / 2, turn);
  body.half = around(half, Vec3::Zero(), Vec3::Zero());
  for (std::size_t axis = 0; axis < 3; ++axis)
    body.axes[axis] = around(turn.col(static_cast<int>(axis)), Vec3::Zero(), Vec3::Zero());
  return body;
}

// A part where its joints begin: what it stands for in expressions is its centre of mass.
lower::PlacedBody placed_part(const Model& model, const Task& task, const OfFixture& of,
                              std::span<const double> all_joints) {
  const Fixture& fixture = model.fixtures[of.fixture];
  lower::PlacedBody body;
  const Vec3 slack = Vec3::Constant(kSettlesOnFixture);
  const auto tree = tree_of(fixture);
  if (!tree) return body;
  const auto joints = joints_of(model, model.scenes[task.scene], of.fixture, all_joints);
  const Pose pose =
      part_pose(place_of(model.scenes[task.scene], fixture), fixture, *tree, joints, of.part);
  const auto link = static_cast<std::size_t>(fixture.parts[of.part].index);
  body.origin = around(pose.position, slack, slack);
  body.position = around(pose.apply(fixture.model->links[link].center_of_mass), slack, slack);
  const Mat3 turn = pose.rotation.toRotationMatrix();
  for (std::size_t axis = 0; axis < 3; ++axis)
    body.axes[axis] = around(turn.col(static_cast<int>(axis)), Vec3::Zero(), Vec3::Zero());
  return body;
}

}  // namespace

const lower::Program* Relations::program(const Task& task, std::uint32_t relation,
                                         const std::vector<std::uint16_t>& of,
                                         const std::vector<std::uint16_t>& alike) {
  const CameraId camera = views_of(model_, task).front().camera;
  Key key{{task.scene, camera}, {relation, static_cast<std::uint32_t>(task.objects().size())}};
  // Which body has which role, where a relation speaks of roles; and which object it is, by name.
  for (const ObjectId id : task.objects()) {
    key.second.push_back(static_cast<std::uint32_t>(task.role_of(id)));
    if (model_.exprs.names_objects) key.second.push_back(static_cast<std::uint32_t>(id));
  }
  for (const auto& [role, id] : things_of(task)) {
    key.second.push_back(static_cast<std::uint32_t>(role));
    key.second.push_back(static_cast<std::uint32_t>(id));
  }
  key.second.push_back(static_cast<std::uint32_t>(of.size()));
  key.second.insert(key.second.end(), of.begin(), of.end());
  key.second.insert(key.second.end(), alike.begin(), alike.end());
  const auto [at, is_new] = programs_.try_emplace(std::move(key));
  if (is_new)
    at->second = lower::lower_relation(
        model_, model_.predicates[static_cast<PredicateId>(relation)], of, alike,
        lower::bodies_of(model_, task),
        frame_of(model_, model_.scenes[task.scene], model_.cameras[camera]), diagnostics_);
  return at->second ? &*at->second : nullptr;
}

InStart::InStart(Relations& relations, const Task& task, const Start& start)
    : relations_(relations), task_(task), scenery_(scenery_of(relations.model_, task)) {
  const Model& model = relations.model_;
  placed_ = placed_objects(model, relations.centres_, task, start);
  if (scenery_.body_count <= placed_.size()) return;
  placed_.resize(scenery_.body_count);
  const std::vector<double> joints = joint_starts_of(model, task, start);
  for (std::size_t i = 0; i < scenery_.things.size(); ++i) {
    const Object& object = model.objects[scenery_.things[i]];
    if (object.of) placed_[scenery_.bodies[i]] = placed_part(model, task, *object.of, joints);
  }
}

std::vector<lower::PlacedBody> placed_objects(const Model& model, Centres& centres,
                                              const Task& task, const Start& start) {
  std::vector<lower::PlacedBody> bodies;
  for (const Start::Placed& placed : start.placed) {
    const Object& object = model.objects[placed.object];
    bodies.push_back(placed_body(model.scenes[task.scene], object, centres.of(object), placed));
  }
  return bodies;
}

Scenery scenery_of(const Model& model, const Task& task) {
  Scenery scenery{denotable(model, task), {}, 0};
  scenery.body_count = task.objects().size();
  std::vector<lower::Body> bodies;
  for (std::size_t i = 0; i < scenery.things.size(); ++i) {
    const Object& object = model.objects[scenery.things[i]];
    if (!object.of) {
      scenery.bodies.push_back(static_cast<std::uint16_t>(i));
      continue;
    }
    if (bodies.empty()) bodies = lower::bodies_of(model, task);
    scenery.body_count = bodies.size();
    const auto at = std::ranges::find_if(bodies, [&](const lower::Body& body) {
      return body.kind == plan::BodyKind::kPart && body.part == object.of->part &&
             body.index == static_cast<std::uint32_t>(object.of->fixture);
    });
    scenery.bodies.push_back(static_cast<std::uint16_t>(at - bodies.begin()));
  }
  return scenery;
}

Alike alike_of(const Model& model, const Scenery& scenery, const Phrase& phrase) {
  Alike alike;
  for (std::size_t i = 0; i < scenery.things.size(); ++i) {
    const Object& object = model.objects[scenery.things[i]];
    // What an object is when nothing is said of its place.
    const auto with = [&](Truth relation) {
      return evaluate(phrase.means, object, [&](const QueryOp&) { return relation; });
    };
    const Truth rest = std::max(with(Truth::kYes), with(Truth::kNo));
    if (rest == Truth::kYes) alike.sure.push_back(scenery.bodies[i]);
    if (rest != Truth::kNo) alike.all.push_back(scenery.bodies[i]);
  }
  return alike;
}

std::string unsaid_in(const Model& model, const Task& task, const Phrase& phrase) {
  const Scenery scenery = scenery_of(model, task);
  const Alike alike = alike_of(model, scenery, phrase);
  std::string first;
  std::size_t count = 0;
  for (std::size_t i = 0; i < scenery.things.size(); ++i) {
    const std::uint16_t body = scenery.bodies[i];
    const auto is_in = [&](const auto& all) { return std::ranges::find(all, body) != all.end(); };
    if (!is_in(alike.all) || is_in(alike.sure)) continue;
    if (count++ == 0) first = model.objects[scenery.things[i]].name;
  }
  if (count == 0) return {};
  const std::string who = "`" + first + "`" +
                          (count == 1   ? " does"
                           : count == 2 ? " and one other do"
                                        : " and " + std::to_string(count - 1) + " others do");
  return who + " not say what `" + phrase.means_text +
         "` asks for and may be meant, too: state it there, or ask for a fact, which is false "
         "where it "
         "is not stated";
}

std::optional<std::vector<std::uint16_t>> related_bodies(const Model& model, const Scenery& scenery,
                                                         const QueryOp& op, std::uint16_t described,
                                                         const Alike& alike) {
  // One alone is not the leftmost.
  const Predicate& relation = model.predicates[static_cast<PredicateId>(op.a)];
  const bool is_alone = std::all_of(alike.all.begin(), alike.all.end(),
                                    [&](std::uint16_t body) { return body == described; });
  if (relation.is_comparison && is_alone) return std::nullopt;
  std::vector<std::uint16_t> of{described};
  for (const ObjectId other : op.to) {
    if (other == ObjectId::kNone) continue;
    const auto at = std::ranges::find(scenery.things, other);
    // Nothing is left of what is not there, nor of itself.
    if (at == scenery.things.end()) return std::nullopt;
    const std::uint16_t body =
        scenery.bodies[static_cast<std::size_t>(at - scenery.things.begin())];
    if (body == described) return std::nullopt;
    of.push_back(body);
  }
  return of;
}

Truth InStart::holds(const QueryOp& op, std::uint16_t described, const Alike& alike) const {
  const auto of = related_bodies(relations_.model_, scenery_, op, described, alike);
  if (!of) return Truth::kNo;
  const auto among = [&](const std::vector<std::uint16_t>& members) {
    const lower::Program* program = relations_.program(task_, op.a, *of, members);
    if (program == nullptr) return Truth::kUnknown;
    const auto truth = lower::holds(*program, placed_);
    return !truth ? Truth::kUnknown : *truth ? Truth::kYes : Truth::kNo;
  };
  const Truth sure = among(alike.sure);
  if (alike.sure == alike.all || sure == among(alike.all)) return sure;
  return Truth::kUnknown;
}

Denotation InStart::denote(const Phrase& phrase, ObjectId wanted) const {
  const Model& model = relations_.model_;
  const Alike alike = alike_of(model, scenery_, phrase);
  Denotation found;
  for (std::size_t i = 0; i < scenery_.things.size(); ++i) {
    const std::uint16_t body = scenery_.bodies[i];
    const bool may_be = std::ranges::find(alike.all, body) != alike.all.end();
    const ObjectId id = scenery_.things[i];
    const Truth truth = may_be ? evaluate(phrase.means, model.objects[id],
                                          [&](const QueryOp& op) { return holds(op, body, alike); })
                               : Truth::kNo;
    if (id == wanted) {
      found.fits = truth == Truth::kYes;
      found.may_fit = truth != Truth::kNo;
    } else if (truth == Truth::kYes) {
      found.sure.push_back(id);
    } else if (truth == Truth::kUnknown) {
      found.perhaps.push_back(id);
    }
  }
  return found;
}

std::string InStart::lack(const Phrase& phrase, ObjectId wanted) const {
  const Model& model = relations_.model_;
  const auto at = std::ranges::find(scenery_.things, wanted);
  if (at == scenery_.things.end()) return {};
  const std::uint16_t body =
      scenery_.bodies[static_cast<std::size_t>(at - scenery_.things.begin())];
  const Alike alike = alike_of(model, scenery_, phrase);
  // Where it stands among those alike is not asked of what is none of them.
  const bool is_alike = std::ranges::find(alike.all, body) != alike.all.end();
  return lack_of(model, phrase.means, model.objects[wanted], [&](const QueryOp& op) {
    return is_alike ? holds(op, body, alike) : Truth::kUnknown;
  });
}

}  // namespace probe::sema
