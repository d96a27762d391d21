// The files a plan names, loaded once per process and shared read-only by all worlds. A file is
// used only if its bytes are the ones the plan was built with.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/base/asset_root.h"
#include "runtime/base/result.h"
#include "runtime/base/sha256.h"
#include "runtime/robot/urdf.h"
#include "runtime/scene/collision_shape.h"
#include "runtime/scene/mesh.h"
#include "runtime/stage/fixture.h"

namespace probe::plan {
class Plan;
}
namespace probe::render {
class SceneStore;
}

namespace probe::stage {

// What a URDF's links look like and collide with. A link's collision meshes are merged into one
// shape in link frame.
struct UrdfParts {
  struct LinkVisual {
    int link = 0;  // RobotModel::links
    Pose origin;   // mesh frame in the link frame
    std::shared_ptr<const scene::Mesh> mesh;
  };
  robot::RobotModel model;
  std::vector<LinkVisual> visuals;
  std::vector<std::shared_ptr<const scene::CollisionShape>>
      shapes;  // one per link, null without collision
};

// A fixture with joints and what its URDF names.
struct LoadedFixture {
  Fixture fixture;
  UrdfParts parts;
  bool is_planned = false;  // else beside the plan
};

class SharedAssets {
 public:
  // Loads what `tasks` (indices of the plan's tasks) need. Fails (kAsset) naming a file that
  // is absent or has other bytes, and with the loaders' failures.
  // `fixtures` stand in the scene of every task behind those that the plan puts there; their files
  // are taken as they are.
  static Result<std::shared_ptr<const SharedAssets>> load(const plan::Plan& plan,
                                                          const AssetRoot& root,
                                                          std::span<const std::uint32_t> tasks,
                                                          std::span<const Fixture> fixtures = {});

  // By index into the plan's assets; null for an index that was not loaded.
  std::shared_ptr<const scene::Mesh> mesh(std::uint32_t asset) const;
  std::shared_ptr<const scene::CollisionShape> shape(std::uint32_t asset) const;
  std::shared_ptr<const scene::Texture> photo(std::uint32_t asset) const;
  // Of an object (index of the plan's objects), scaled, painted and covered as the plan says; null
  // where it has none.
  std::shared_ptr<const scene::Mesh> object_mesh(std::uint32_t object) const;
  std::shared_ptr<const scene::CollisionShape> object_shape(std::uint32_t object) const;
  // What stands behind a scene (index of the plan's scenes), covered as the plan says, or null.
  std::shared_ptr<const scene::Mesh> backdrop(std::uint32_t scene) const;
  const UrdfParts* robot(std::uint32_t urdf_asset) const;
  // Those with joints in a scene (index of the plan's scenes) of a loaded task: the plan's, then
  // the others.
  std::span<const LoadedFixture* const> fixtures(std::uint32_t scene) const;
  // The meshes' ray structures and what stands still, for every world and task; made as they are
  // first drawn.
  const std::shared_ptr<render::SceneStore>& pictures() const { return pictures_; }

 private:
  class Loader;
  AssetRoot root_;
  std::shared_ptr<render::SceneStore> pictures_;
  std::map<std::uint32_t, std::shared_ptr<const scene::Mesh>> meshes_;
  std::map<std::uint32_t, std::shared_ptr<const scene::CollisionShape>> shapes_;
  std::map<std::uint32_t, std::shared_ptr<const scene::Texture>> photos_;
  std::map<std::uint32_t, std::shared_ptr<const scene::Mesh>> object_meshes_, backdrops_;
  std::map<std::uint32_t, std::shared_ptr<const scene::CollisionShape>> object_shapes_;
  std::map<std::uint32_t, std::unique_ptr<const UrdfParts>> robots_;
  std::map<std::uint32_t, std::unique_ptr<const LoadedFixture>> planned_;  // by plan's index
  std::vector<std::unique_ptr<const LoadedFixture>> others_;
  std::map<std::uint32_t, std::vector<const LoadedFixture*>> by_scene_;
};

// Whether what was loaded for a task of one plan is what the same task of the other needs: they
// differ in nothing but where things start, in sources and in where in these something stands.
bool serves_both(const plan::Plan& a, const plan::Plan& b);

// Of every file the plan names, by path and content: equal digests, equal inputs.
Sha256 asset_digest(const plan::Plan& plan);

}  // namespace probe::stage
