// Reads, checks and shares the files of a plan. A file's bytes are checked before anything parses
// them.
#include "runtime/stage/assets.h"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <set>
#include <sstream>

#include "runtime/base/file.h"
#include "runtime/base/libm_binding.h"
#include "runtime/plan/plan.h"
#include "runtime/render/scene_store.h"
#include "runtime/scene/collision_mesh.h"
#include "runtime/scene/covered_mesh.h"
#include "runtime/scene/hull.h"
#include "runtime/scene/image.h"
#include "runtime/scene/mesh_cache.h"
#include "runtime/scene/shape_mesh.h"
#include "runtime/stage/backdrop.h"

namespace probe::stage {
namespace {

namespace fs = std::filesystem;

scene::CollisionShape make_primitive(const robot::Primitive& primitive) {
  switch (primitive.kind) {
    case robot::Primitive::Kind::kSphere:
      return scene::make_sphere_shape(primitive.half.x());
    case robot::Primitive::Kind::kCylinder:
      return scene::make_cylinder_shape(primitive.half.x(), primitive.half.z());
    case robot::Primitive::Kind::kBox:
      break;
  }
  return scene::make_box_shape(primitive.half);
}

// What a file names may not lie outside the folder that has it.
scene::MeshLimits limits_in(const AssetRoot& root, std::string_view path) {
  scene::MeshLimits limits;
  limits.asset_root = root.holder(path);
  limits.self_contained = true;
  return limits;
}

// Each collision mesh of a link, one convex part a mesh, and its primitives, in the link's frame.
// `named`: the path under the root of a mesh that the URDF names.
Result<std::shared_ptr<const scene::CollisionShape>> load_link_shape(
    const robot::Link& link, const AssetRoot& root,
    const std::function<std::string(const robot::MeshRef&)>& named) {
  std::vector<std::vector<Vec3>> components;
  for (const robot::MeshRef& ref : link.collisions) {
    const std::string path = named(ref);
    PROBE_ASSIGN(scene::TriangleSoup soup,
                 scene::load_triangles(root.file(path), ref.scale, limits_in(root, path)));
    for (Vec3& point : soup.vertices) point = ref.origin.apply(point);
    components.push_back(std::move(soup.vertices));
  }
  scene::CollisionShape shape;
  if (!components.empty()) {
    PROBE_ASSIGN(shape, scene::make_collision_shape(components, link.name));
  }
  if (!link.primitives.empty()) {
    std::vector<scene::PlacedShape> all;
    if (!components.empty()) all.push_back({std::move(shape), Pose{}});
    for (const robot::Primitive& primitive : link.primitives) {
      all.push_back({make_primitive(primitive), primitive.origin});
    }
    shape = scene::join_shapes(std::move(all));
  }
  return std::shared_ptr<const scene::CollisionShape>(
      std::make_shared<scene::CollisionShape>(std::move(shape)));
}

}  // namespace

class SharedAssets::Loader {
 public:
  Loader(const plan::Plan& plan, SharedAssets& assets) : plan_(plan), assets_(assets) {}

  Status task(const plan::TaskRecord& task) {
    const plan::SceneRecord& scene = plan_.scenes()[task.scene];
    for (const std::uint32_t visual : {scene.backdrop, scene.fixture_visual}) {
      if (visual != plan::kNone) PROBE_TRY(mesh(visual));
    }
    PROBE_TRY(backdrop(task.scene));
    if (scene.fixture_collision != plan::kNone) PROBE_TRY(shape(scene.fixture_collision));
    for (const plan::ViewRecord& view : plan_.views(task)) {
      if (view.photo != plan::kNone) PROBE_TRY(photo(view.photo));
    }
    for (const plan::BodyRecord& body : plan_.bodies(task)) {
      if (body.kind != static_cast<std::uint32_t>(plan::BodyKind::kObject)) continue;
      PROBE_TRY(object(body.index));
    }
    for (const std::uint32_t index : plan_.fixtures(scene)) PROBE_TRY(planned(index));
    by_scene(task.scene);
    return robot(plan_.robots()[scene.robot]);
  }

  Status fixture(const Fixture& fixture) {
    const auto is_it = [&](const auto& other) { return other->fixture.name == fixture.name; };
    bool known = std::ranges::any_of(assets_.others_, is_it);
    for (const auto& [index, other] : assets_.planned_) known = known || is_it(other);
    if (known) {
      return Failure{Fault::kAsset, "two fixtures are called `" + fixture.name + "`", fixture.urdf};
    }
    if (fixture.positions.size() != fixture.joints.size()) {
      return Failure{Fault::kAsset,
                     "fixture `" + fixture.name + "`: " + std::to_string(fixture.joints.size()) +
                         " joints, initial positions of " +
                         std::to_string(fixture.positions.size()),
                     fixture.urdf};
    }
    PROBE_ASSIGN(robot::RobotModel model,
                 robot::load_urdf(assets_.root_.file(fixture.urdf)));
    PROBE_ASSIGN(UrdfParts parts, parts_of(std::move(model), fixture.urdf));
    assets_.others_.push_back(
        std::make_unique<LoadedFixture>(LoadedFixture{fixture, std::move(parts), false}));
    for (auto& [scene, all] : assets_.by_scene_) all.push_back(assets_.others_.back().get());
    return {};
  }

 private:
  void by_scene(std::uint32_t scene) {
    std::vector<const LoadedFixture*>& all = assets_.by_scene_[scene];
    all.clear();
    for (const std::uint32_t index : plan_.fixtures(plan_.scenes()[scene]))
      all.push_back(assets_.planned_.at(index).get());
  }

  // Of the plan: its files have the plan's bytes, as a robot's.
  Status planned(std::uint32_t index) {
    if (assets_.planned_.contains(index)) return {};
    const plan::FixtureRecord& record = plan_.fixtures()[index];
    PROBE_ASSIGN(UrdfParts parts, verified_parts(record.urdf, plan_.meshes(record)));
    PROBE_TRY(check_parts(plan_, record, parts.model));
    assets_.planned_[index] = std::make_unique<LoadedFixture>(
        LoadedFixture{fixture_of(plan_, record), std::move(parts), true});
    return {};
  }

  std::string path_of(std::uint32_t asset) const {
    return assets_.root_.file(plan_.text(plan_.assets()[asset].path));
  }

  // That the file is there with the plan's bytes. Each file once.
  Status verify(std::uint32_t asset) {
    if (!verified_.insert(asset).second) return {};
    const plan::AssetRecord& record = plan_.assets()[asset];
    const std::string name(plan_.text(record.path));
    if (fs::path(name).is_absolute() ||
        fs::path(name).lexically_normal().string().starts_with("..")) {
      return Failure{Fault::kAsset, "the plan names a file outside the asset folder", name};
    }
    const auto bytes = read_file(path_of(asset));
    if (!bytes)
      return Failure{
          Fault::kAsset,
          "this file of the plan is not in " + assets_.root_.text() +
              "; --assets names other folders, one each time",
          name};
    const Sha256 hash = sha256(std::string_view(*bytes));
    if (bytes->size() != record.byte_size || hash.bytes != record.sha256) {
      return Failure{Fault::kAsset, "its bytes are not the ones the plan was built with", name};
    }
    return {};
  }

  Status mesh(std::uint32_t asset) {
    if (assets_.meshes_.contains(asset)) return {};
    PROBE_TRY(verify(asset));
    PROBE_ASSIGN(assets_.meshes_[asset], scene::shared_mesh(path_of(asset), {1, 1, 1}, limits(asset)));
    return {};
  }

  Status shape(std::uint32_t asset) {
    if (assets_.shapes_.contains(asset)) return {};
    PROBE_TRY(verify(asset));
    PROBE_ASSIGN(scene::CollisionShape shape,
                 scene::load_collision_mesh(path_of(asset), {1, 1, 1}, limits(asset)));
    assets_.shapes_[asset] = std::make_shared<scene::CollisionShape>(std::move(shape));
    return {};
  }

  Status object(std::uint32_t index) {
    const plan::ObjectRecord& object = plan_.objects()[index];
    const Vec3 scale = Vec3::Constant(object.scale == 0 ? 1 : object.scale);
    if (object.visual != plan::kNone && !assets_.object_meshes_.contains(index)) {
      PROBE_TRY(mesh(object.visual));
      std::shared_ptr<const scene::Mesh> seen = assets_.mesh(object.visual);
      if (object.scale != 0) {
        PROBE_ASSIGN(seen, scene::shared_mesh(path_of(object.visual), scale, limits(object.visual)));
      }
      if (object.paint[3] != 0) {
        const auto& rgb = object.paint;
        seen = std::make_shared<scene::Mesh>(scene::painted_mesh(*seen, {rgb[0], rgb[1], rgb[2]}));
      }
      if (const plan::CoverRecord* cover = plan_.cover(object)) {
        PROBE_TRY(photo(cover->texture));
        seen = std::make_shared<scene::Mesh>(scene::covered_mesh(
            *seen, *assets_.photo(cover->texture), cover->side,
            [](const Vec3&, const Vec3&, const Vec3&, const Vec3&) { return true; }));
      }
      assets_.object_meshes_[index] = std::move(seen);
    }
    if (object.collision == plan::kNone || assets_.object_shapes_.contains(index)) return {};
    PROBE_TRY(shape(object.collision));
    assets_.object_shapes_[index] = assets_.shape(object.collision);
    if (object.scale != 0) PROBE_TRY(scaled_shape(index, scale));
    if (const plan::MassRecord* mass = plan_.mass(object);
        mass != nullptr && mass->inertia != std::array<double, 6>{}) {
      const auto& i = mass->inertia;
      Mat3 inertia;
      inertia << i[0], i[3], i[4], i[3], i[1], i[5], i[4], i[5], i[2];
      assets_.object_shapes_[index] =
          std::make_shared<scene::CollisionShape>(scene::shape_weighing(
              *assets_.object_shapes_[index], mass->mass, to_vec(mass->centre), inertia));
    }
    return {};
  }

  Status scaled_shape(std::uint32_t index, const Vec3& scale) {
    const plan::ObjectRecord& object = plan_.objects()[index];
    auto scaled = scene::load_collision_mesh(path_of(object.collision), scale, limits(object.collision));
    if (!scaled) {
      return Failure{scaled.failure().code,
                     "object `" + std::string(plan_.text(object.name)) +
                         "`, whose mesh is scaled: " + scaled.failure().message,
                     scaled.failure().where};
    }
    assets_.object_shapes_[index] =
        std::make_shared<scene::CollisionShape>(std::move(scaled).value());
    return {};
  }

  Status backdrop(std::uint32_t index) {
    const plan::SceneRecord& record = plan_.scenes()[index];
    if (record.backdrop == plan::kNone || assets_.backdrops_.contains(index)) return {};
    std::shared_ptr<const scene::Mesh> seen = assets_.mesh(record.backdrop);
    const auto covers = plan_.covers(record);
    if (!covers.empty()) {
      std::vector<Cover> textures;
      for (const plan::CoverRecord& cover : covers) {
        PROBE_TRY(photo(cover.texture));
        textures.push_back({static_cast<plan::CoverOf>(cover.what),
                            assets_.photo(cover.texture).get(), cover.side});
      }
      const scene::Mesh* const fixture = record.fixture_visual == plan::kNone
                                             ? nullptr
                                             : assets_.mesh(record.fixture_visual).get();
      auto covered = covered_backdrop(*seen, {fixture, to_vec(record.fixture_position)},
                                      record.area, record.surface_z, textures);
      if (!covered)
        return Failure{covered.failure().code, covered.failure().message,
                       "scene `" + std::string(plan_.text(record.name)) + "`"};
      seen = std::make_shared<scene::Mesh>(std::move(*covered));
    }
    assets_.backdrops_[index] = std::move(seen);
    return {};
  }

  Status photo(std::uint32_t asset) {
    if (assets_.photos_.contains(asset)) return {};
    PROBE_TRY(verify(asset));
    PROBE_ASSIGN(scene::Texture texture, scene::load_image(path_of(asset)));
    assets_.photos_[asset] = std::make_shared<scene::Texture>(std::move(texture));
    return {};
  }

  Status robot(const plan::RobotRecord& record) {
    if (assets_.robots_.contains(record.urdf)) return {};
    PROBE_ASSIGN(UrdfParts parts, verified_parts(record.urdf, plan_.meshes(record)));
    assets_.robots_[record.urdf] = std::make_unique<UrdfParts>(std::move(parts));
    return {};
  }

  // Of a URDF and its meshes, all of them assets of the plan.
  Result<UrdfParts> verified_parts(std::uint32_t urdf, std::span<const std::uint32_t> meshes) {
    PROBE_TRY(verify(urdf));
    const std::string name(plan_.text(plan_.assets()[urdf].path));
    std::set<std::string> known;
    for (const std::uint32_t asset : meshes) {
      PROBE_TRY(verify(asset));
      known.insert(fs::path(plan_.text(plan_.assets()[asset].path)).lexically_normal().string());
    }
    PROBE_ASSIGN(robot::RobotModel model, robot::load_urdf(path_of(urdf)));
    for (const robot::Link& link : model.links) {
      for (const auto* refs : {&link.visuals, &link.collisions}) {
        for (const robot::MeshRef& ref : *refs) {
          const std::string mesh =
              (fs::path(name).parent_path() / ref.path).lexically_normal().string();
          if (known.contains(mesh)) continue;
          return Failure{
              Fault::kAsset,
              "link `" + link.name + "` has the mesh `" + mesh + "`, which the plan does not name",
              name};
        }
      }
    }
    return parts_of(std::move(model), name);
  }

  // What the links of a URDF (a path under the root) look like and collide with.
  Result<UrdfParts> parts_of(robot::RobotModel model, const std::string& urdf) const {
    // A path under the root: a mesh may be of another thing than its URDF.
    const auto named = [&](const robot::MeshRef& ref) {
      return (fs::path(urdf).parent_path() / ref.path).lexically_normal().string();
    };
    UrdfParts parts;
    parts.model = std::move(model);
    for (std::size_t i = 0; i < parts.model.links.size(); ++i) {
      const robot::Link& link = parts.model.links[i];
      for (const robot::MeshRef& ref : link.visuals) {
        UrdfParts::LinkVisual visual;
        visual.link = static_cast<int>(i);
        visual.origin = ref.origin;
        const std::string path = named(ref);
        PROBE_ASSIGN(visual.mesh, scene::shared_mesh(assets_.root_.file(path), ref.scale,
                                                     limits_in(assets_.root_, path)));
        parts.visuals.push_back(std::move(visual));
      }
      for (const robot::DrawnPrimitive& drawn : link.drawn) {
        parts.visuals.push_back(
            {.link = static_cast<int>(i),
             .origin = drawn.shape.origin,
             .mesh = std::make_shared<const scene::Mesh>(scene::shape_mesh(drawn))});
      }
      parts.shapes.emplace_back();
      if (link.can_collide()) {
        PROBE_ASSIGN(parts.shapes.back(), load_link_shape(link, assets_.root_, named));
      }
    }
    return parts;
  }

  scene::MeshLimits limits(std::uint32_t asset) const {
    return limits_in(assets_.root_, plan_.text(plan_.assets()[asset].path));
  }

  const plan::Plan& plan_;
  SharedAssets& assets_;
  std::set<std::uint32_t> verified_;
};

Result<std::shared_ptr<const SharedAssets>> SharedAssets::load(const plan::Plan& plan,
                                                               const AssetRoot& root,
                                                               std::span<const std::uint32_t> tasks,
                                                               std::span<const Fixture> fixtures) {
  // Here, because every simulation begins here. It is a thing of the process: once is enough.
  static constexpr std::string_view kMultibody[] = {"libSimTK"};
  static const Result<TrigBinding> bound = bind_trigonometry(kMultibody);
  if (!bound) return bound.failure();
  auto assets = std::make_shared<SharedAssets>();
  assets->root_ = root;
  assets->pictures_ = std::make_shared<render::SceneStore>();
  Loader loader(plan, *assets);
  for (const std::uint32_t task : tasks) PROBE_TRY(loader.task(plan.tasks()[task]));
  for (const Fixture& fixture : fixtures) PROBE_TRY(loader.fixture(fixture));
  return std::shared_ptr<const SharedAssets>(std::move(assets));
}

namespace {

template <typename T>
std::shared_ptr<const T> find(const std::map<std::uint32_t, std::shared_ptr<const T>>& map,
                              std::uint32_t asset) {
  const auto found = map.find(asset);
  return found == map.end() ? nullptr : found->second;
}

}  // namespace

std::shared_ptr<const scene::Mesh> SharedAssets::mesh(std::uint32_t asset) const {
  return find(meshes_, asset);
}

std::shared_ptr<const scene::CollisionShape> SharedAssets::shape(std::uint32_t asset) const {
  return find(shapes_, asset);
}

std::shared_ptr<const scene::Texture> SharedAssets::photo(std::uint32_t asset) const {
  return find(photos_, asset);
}

std::shared_ptr<const scene::Mesh> SharedAssets::object_mesh(std::uint32_t object) const {
  return find(object_meshes_, object);
}

std::shared_ptr<const scene::CollisionShape> SharedAssets::object_shape(
    std::uint32_t object) const {
  return find(object_shapes_, object);
}

std::shared_ptr<const scene::Mesh> SharedAssets::backdrop(std::uint32_t scene) const {
  return find(backdrops_, scene);
}

const UrdfParts* SharedAssets::robot(std::uint32_t urdf_asset) const {
  const auto found = robots_.find(urdf_asset);
  return found == robots_.end() ? nullptr : found->second.get();
}

std::span<const LoadedFixture* const> SharedAssets::fixtures(std::uint32_t scene) const {
  const auto found = by_scene_.find(scene);
  if (found == by_scene_.end()) return {};
  return found->second;
}

bool serves_both(const plan::Plan& a, const plan::Plan& b) {
  const auto is_starts_or_sources = [](plan::Section section) {
    return section == plan::Section::kEpisodes || section == plan::Section::kPlacements ||
           section == plan::Section::kSpans || section == plan::Section::kTexts ||
           section == plan::Section::kTextBytes;
  };
  const auto same = [](const auto& one, const auto& other) {
    return one.size() == other.size() &&
           std::equal(std::as_bytes(std::span(one)).begin(), std::as_bytes(std::span(one)).end(),
                      std::as_bytes(std::span(other)).begin());
  };
#define PROBE_SECTION(kind, name, tag, Record, member, may_be_ignored)  \
  if (!is_starts_or_sources(plan::Section::k##name) &&                  \
      !same(a.tables().member, b.tables().member))                      \
    return false;
#include "runtime/plan/sections.def"
  return true;
}

Sha256 asset_digest(const plan::Plan& plan) {
  Hasher hasher;
  for (const plan::AssetRecord& asset : plan.assets()) {
    hasher.text(plan.text(asset.path)).hash(Sha256{asset.sha256});
  }
  return hasher.finish();
}

}  // namespace probe::stage
