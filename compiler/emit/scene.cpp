// Scenes as records, with what stands in them and behind them.
#include <fmt/format.h>

#include <array>

#include "compiler/emit/emitter.h"
#include "runtime/base/asset_path.h"

namespace probe::emit {
namespace {

// OBJ first: that is how convex decompositions are stored.
constexpr std::array<std::string_view, 5> kCollisionExtensions{".obj", ".stl", ".glb", ".gltf",
                                                               ".dae"};

}  // namespace

Emitter::MeshPair Emitter::find_meshes(const std::string& folder) const {
  MeshPair meshes{assets_.find(folder + "/visual", kMeshExtensions),
                  assets_.find(folder + "/collision", kCollisionExtensions)};
  // Where neither is there, one message is enough: that about the picture mesh.
  if (!assets_.has(meshes.collision)) meshes.collision = meshes.visual;
  return meshes;
}

std::uint32_t Emitter::add_photo(const std::optional<sema::Spelled>& overlay, AssetOwner owner) {
  if (!overlay) return plan::kNone;
  return assets_.add("scenes/" + overlay->text, plan::AssetKind::kPhoto, overlay->span, owner);
}

void Emitter::add_scene(sema::SceneId id) {
  if (!scenes_.add(id, size32(records().scenes))) return;
  const sema::Scene& scene = model_.scenes[id];
  add_robot(scene.robot);
  plan::SceneRecord record;
  record.name = writer_.text(scene.name);
  record.robot = robots_[scene.robot];
  const AssetOwner owner{AssetOwner::Kind::kScene, static_cast<std::uint32_t>(id)};
  const std::optional<sema::Spelled>& overlay = scene.views.front().overlay;
  record.photo = add_photo(overlay, owner);
  if (scene.backdrop) {
    const std::string folder = "scenes/" + scene.backdrop->text + "/";
    const Span& span = scene.backdrop->span;
    // A photo in the folder is what the camera saw there: it stands behind everything, and the
    // mesh, where there is one, only for depth and for what hides what.
    const std::string photo = assets_.find(folder + "photo", kPhotoExtensions);
    const std::string visual = assets_.find(folder + "visual", kMeshExtensions);
    const bool has_photo = assets_.has(photo);
    if (has_photo && !overlay) {
      if (scene.backdrop_z != scene.surface_z) {
        diagnostics_
            .report(Situation::kPhotoMoved, scene.surface_span,
                    fmt::format("the surface is at {:.6g}cm here and at {:.6g}cm in the photo `{}`",
                                100 * scene.surface_z, 100 * scene.backdrop_z, photo))
            .label(span, "the photo is of the other height")
            .help("write `backdrop` again, with one that was photographed at this height");
      }
      record.photo = assets_.add(photo, plan::AssetKind::kPhoto, span, owner);
    }
    if (!has_photo || assets_.has(visual)) {
      record.backdrop = assets_.add(visual, plan::AssetKind::kVisualMesh, span, owner);
      record.backdrop_stands = scene.backdrop_stands ? 1 : 0;
      if (scene.backdrop_stands) record.backdrop_z = scene.backdrop_z;
    }
  }
  if (scene.fixture) {
    const MeshPair meshes = find_meshes("fixtures/" + scene.fixture->text);
    const Span& span = scene.fixture->span;
    record.fixture_visual = assets_.add(meshes.visual, plan::AssetKind::kVisualMesh, span, owner);
    record.fixture_collision =
        assets_.add(meshes.collision, plan::AssetKind::kCollisionMesh, span, owner);
    record.fixture_position = scene.fixture_position;
  }
  record.covers = add_covers(scene.covers, owner);
  if (!scene.covers.empty() && (record.photo != plan::kNone || record.backdrop == plan::kNone)) {
    diagnostics_
        .report(Situation::kPhotoCovered, scene.covers.begin()->second.picture.span,
                record.photo != plan::kNone
                    ? "a photo stands before what this texture covers"
                    : "scene `" + scene.name + "` has no backdrop that a texture could cover")
        .help("textures cover the meshes of a `backdrop` that no photo stands before");
  }
  record.base_position = scene.base_position;
  record.base_rotation = scene.base_turn.rotation;
  std::vector<double> joints;
  for (const sema::Quantity& joint : scene.joints) joints.push_back(joint.si());
  record.joints = writer_.reals(joints);
  record.surface_z = scene.surface_z;
  record.area = scene.area;
  record.physics_hz = scene.physics_hz;
  record.friction = scene.friction;
  record.air_density = scene.air_density;
  record.air_viscosity = scene.air_viscosity;
  std::vector<std::uint32_t> fixtures;
  for (const sema::FixtureId fixture : scene.fixtures) {
    fixtures.push_back(fixture_index(scene, fixture));
  }
  if (!fixtures.empty()) record.fixtures = writer_.list(fixtures);
  const std::uint32_t index = size32(records().scenes);
  add_regions(scene.surface_regions, "surface", plan::BodyKind::kSurface, index);
  add_regions(scene.fixture_regions, "fixture", plan::BodyKind::kFixture, index);
  records().scenes.push_back(record);
}

}  // namespace probe::emit
