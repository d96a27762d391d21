#include "runtime/assets/mujoco_thing.h"

#include <fmt/format.h>

#include <filesystem>

#include "runtime/base/trig.h"
#include "runtime/mjcf/mesh_file.h"

namespace probe::assets {
namespace {

using mjcf::Body;
using mjcf::Model;
using mjcf::Motion;

Failure fail(const Model& model, const mjcf::At& at, std::string message) {
  return {Fault::kAsset, std::move(message), model.where(at)};
}

std::vector<std::size_t> children_of(const Model& model, std::size_t body) {
  std::vector<std::size_t> found;
  for (std::size_t i = 1; i < model.bodies.size(); ++i) {
    if (model.bodies[i].parent == static_cast<int>(body)) found.push_back(i);
  }
  return found;
}

// Where a joint puts what it moves, in the body's frame: at its `reference` nothing moves.
Pose at_zero(const mjcf::Joint& joint) {
  if (joint.motion == Motion::kSlide) return {-joint.reference * joint.axis, Quat::Identity()};
  const SinCos half = portable_sincos(-joint.reference / 2);
  const Vec3 v = half.sin * joint.axis;
  return {Vec3::Zero(), Quat(half.cos, v.x(), v.y(), v.z())};
}

class Finder {
 public:
  Finder(const Model& model, MujocoMeshes& meshes) : model_(model), meshes_(meshes) {}

  Result<MujocoThing> find() {
    const auto tops = children_of(model_, 0);
    if (tops.size() != 1)
      return fail(model_, model_.bodies[0].at,
                  fmt::format("the world has {} bodies, expected one: the thing", tops.size()));
    std::size_t root = tops[0];
    const auto within = children_of(model_, root);
    const Body& around = model_.bodies[root];
    if (within.size() == 1 && model_.bodies[within[0]].name == "object" && around.geoms.empty() &&
        around.joints.empty()) {
      for (const mjcf::Site& site : around.sites) thing_.outside.push_back(&site);
      thing_.is_wrapped = true;
      root = within[0];
    }
    for (const mjcf::Geom& geom : model_.bodies[0].geoms) thing_.of_world.push_back(&geom);
    for (const mjcf::Joint& joint : model_.bodies[root].joints) {
      if (joint.motion != Motion::kFree)
        return fail(model_, joint.at, "a joint that moves the thing itself");
      thing_.is_free = true;
      thing_.free_damping = joint.damping;
    }
    thing_.links.emplace_back();
    PROBE_TRY(add(root, 0, Pose{}));
    return std::move(thing_);
  }

 private:
  // What the body has, which stands at `pose` in the frame of link `to`.
  Status add(std::size_t index, std::size_t to, const Pose& pose) {
    const Body& body = model_.bodies[index];
    PROBE_ASSIGN(const mjcf::MassProperties mass, mass_of(body));
    MujocoLink& link = thing_.links[to];
    link.mass = mjcf::joined(link.mass, mjcf::moved(mass, pose));
    for (const mjcf::Geom& geom : body.geoms) link.geoms.push_back({&geom, pose * geom.pose});
    for (const mjcf::Site& site : body.sites) link.sites.push_back({&site, pose * site.pose});
    for (const std::size_t child : children_of(model_, index)) {
      const Body& next = model_.bodies[child];
      if (next.joints.empty()) {
        PROBE_TRY(add(child, to, pose * next.pose));
        continue;
      }
      const mjcf::Joint& joint = next.joints.front();
      if (next.joints.size() > 1)
        return fail(model_, next.joints[1].at,
                    "a second joint of one body: each has a link of its own here");
      if (joint.motion == Motion::kBall || joint.motion == Motion::kFree)
        return fail(model_, joint.at, "a ball or a free joint within a thing");
      if (joint.motion == Motion::kSlide && !joint.limited)
        return fail(model_, joint.at, "a slide without a range");
      const Pose anchor{joint.position, Quat::Identity()};
      MujocoLink moving;
      moving.name = next.name;
      moving.parent = static_cast<int>(to);
      moving.joint = &joint;
      moving.at = pose * next.pose * anchor * at_zero(joint);
      thing_.links.push_back(std::move(moving));
      PROBE_TRY(add(child, thing_.links.size() - 1, anchor.inverse()));
    }
    return {};
  }

  Result<mjcf::MassProperties> mass_of(const Body& body) {
    std::vector<mjcf::MassProperties> solids(model_.meshes.size());
    for (const mjcf::Geom& geom : body.geoms) {
      if (geom.shape != mjcf::Shape::kMesh || !mjcf::has_mass(model_, body, geom)) continue;
      PROBE_ASSIGN(const scene::Mesh* mesh, meshes_.get(geom.mesh));
      solids[static_cast<std::size_t>(geom.mesh)] =
          mjcf::solid_of(*mesh, model_.compiler.exact_mesh_inertia);
    }
    return mjcf::mass_of(model_, body, solids);
  }

  const Model& model_;
  MujocoMeshes& meshes_;
  MujocoThing thing_;
};

}  // namespace

MujocoMeshes::MujocoMeshes(const mjcf::Model& model, scene::MeshLimits limits)
    : model_(model), limits_(std::move(limits)) {}

Result<const scene::Mesh*> MujocoMeshes::get(int mesh) {
  // Seconds of work: each time that a mesh is asked for, something is made of its triangles.
  constexpr std::uintmax_t kMostBytes = std::uintmax_t{1} << 30, kMostTriangles = 20'000'000;
  const mjcf::MeshAsset& asset = model_.meshes[static_cast<std::size_t>(mesh)];
  const auto too_much = [&](const std::string& what) {
    return Failure{Fault::kAsset, "the meshes of all geoms together have more than " + what,
                   model_.where(asset.at)};
  };
  auto known = meshes_.find(mesh);
  if (known == meshes_.end()) {
    std::error_code error;
    const std::uintmax_t size = std::filesystem::file_size(asset.file, error);
    if (!error) bytes_ += size;
    if (bytes_ > kMostBytes) return too_much(std::to_string(kMostBytes >> 20) + " MiB");
    PROBE_ASSIGN(scene::Mesh read, mjcf::load_mesh_file(model_, asset, limits_));
    known = meshes_.emplace(mesh, std::move(read)).first;
  }
  for (const scene::MeshPart& part : known->second.parts) triangles_ += part.indices.size() / 3;
  if (triangles_ > kMostTriangles)
    return too_much(std::to_string(kMostTriangles / 1'000'000) + " million triangles");
  return &known->second;
}

Result<MujocoThing> find_thing(const mjcf::Model& model, MujocoMeshes& meshes) {
  return Finder(model, meshes).find();
}

MujocoThing standing_things(const mjcf::Model& model, std::vector<std::string>& notes) {
  MujocoThing thing;
  MujocoLink& link = thing.links.emplace_back();
  std::vector<Pose> poses(model.bodies.size());
  std::vector<bool> moves(model.bodies.size(), false);
  for (std::size_t i = 0; i < model.bodies.size(); ++i) {
    const Body& body = model.bodies[i];
    if (i > 0) {
      const auto parent = static_cast<std::size_t>(body.parent);
      poses[i] = poses[parent] * body.pose;
      moves[i] = moves[parent] || !body.joints.empty();
    }
    if (moves[i]) {
      notes.push_back(model.where(body.at) + ": body `" + body.name + "` moves and is left out");
      continue;
    }
    for (const mjcf::Geom& geom : body.geoms) link.geoms.push_back({&geom, poses[i] * geom.pose});
    for (const mjcf::Site& site : body.sites) link.sites.push_back({&site, poses[i] * site.pose});
  }
  return thing;
}

}  // namespace probe::assets
