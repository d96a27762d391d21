#include "compiler/define/in_start.h"

#include <algorithm>

#include "compiler/define/query.h"
#include "compiler/define/views.h"
#include "compiler/geometry/camera_pose.h"
#include "compiler/geometry/footprint.h"
#include "runtime/base/upright.h"

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
  const Mat3 turn = pose_of({}, placed.turn.rotation).rotation.toRotationMatrix();
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
    : relations_(relations), task_(task), objects_(task.objects()) {
  const Model& model = relations.model_;
  for (const Start::Placed& placed : start.placed) {
    const Object& object = model.objects[placed.object];
    placed_.push_back(
        placed_body(model.scenes[task.scene], object, relations.centres_.of(object), placed));
  }
}

Alike alike_of(const Model& model, std::span<const ObjectId> objects, const Phrase& phrase) {
  Alike alike;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const Object& object = model.objects[objects[i]];
    // What an object is when nothing is said of its place.
    const auto with = [&](Truth relation) {
      return evaluate(phrase.means, object, [&](const QueryOp&) { return relation; });
    };
    const Truth rest = std::max(with(Truth::kYes), with(Truth::kNo));
    const auto body = static_cast<std::uint16_t>(i);
    if (rest == Truth::kYes) alike.sure.push_back(body);
    if (rest != Truth::kNo) alike.all.push_back(body);
  }
  return alike;
}

std::optional<std::vector<std::uint16_t>> related_bodies(const Model& model,
                                                         std::span<const ObjectId> objects,
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
    const auto at = std::find(objects.begin(), objects.end(), other);
    const auto body = static_cast<std::uint16_t>(at - objects.begin());
    // Nothing is left of what is not there, nor of itself.
    if (at == objects.end() || body == described) return std::nullopt;
    of.push_back(body);
  }
  return of;
}

Truth InStart::holds(const QueryOp& op, std::uint16_t described, const Alike& alike) const {
  const auto of = related_bodies(relations_.model_, objects_, op, described, alike);
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
  const Alike alike = alike_of(model, objects_, phrase);
  Denotation found;
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    const auto body = static_cast<std::uint16_t>(i);
    const Truth truth = evaluate(phrase.means, model.objects[objects_[i]],
                                 [&](const QueryOp& op) { return holds(op, body, alike); });
    if (objects_[i] == wanted) {
      found.fits = truth == Truth::kYes;
      found.may_fit = truth != Truth::kNo;
    } else if (truth == Truth::kYes) {
      found.sure.push_back(objects_[i]);
    } else if (truth == Truth::kUnknown) {
      found.perhaps.push_back(objects_[i]);
    }
  }
  return found;
}

}  // namespace probe::sema
