#include "runtime/render/scene_store.h"

#include <utility>

#include "runtime/render/mesh_geometry.h"
#include "runtime/render/static_picture.h"
#include "runtime/render/static_scene.h"
#include "runtime/render/vertex_mesh.h"

namespace probe::render {

SceneStore::SceneStore() = default;
SceneStore::~SceneStore() = default;

namespace {

// Of every visual's mesh what `known` has of it, made where it has nothing yet.
template <typename Made>
Result<std::vector<std::shared_ptr<const Made>>> each_once(
    std::span<const Visual> visuals,
    std::map<const scene::Mesh*, std::shared_ptr<const Made>>& known) {
  std::vector<std::shared_ptr<const Made>> found;
  for (const Visual& visual : visuals) {
    if (!visual.mesh) {
      return Failure{
          .code = Fault::kRender, .message = "the visual has no mesh", .where = visual.name};
    }
    std::shared_ptr<const Made>& made = known[visual.mesh.get()];
    if (!made) {
      PROBE_ASSIGN(made, Made::build(visual.mesh));
    }
    found.push_back(made);
  }
  return found;
}

}  // namespace

Result<std::vector<std::shared_ptr<const MeshGeometry>>> SceneStore::geometries(
    std::span<const Visual> visuals) {
  const std::scoped_lock lock(mutex_);
  return each_once(visuals, geometries_);
}

Result<std::vector<std::shared_ptr<const VertexMesh>>> SceneStore::vertex_meshes(
    std::span<const Visual> visuals) {
  const std::scoped_lock lock(mutex_);
  return each_once(visuals, vertex_meshes_);
}

Result<std::shared_ptr<const StaticScene>> SceneStore::static_scene(
    const std::vector<Visual>& statics) {
  PROBE_ASSIGN(auto meshes, geometries(statics));
  const Sha256 key = StaticScene::key_of(statics);
  const std::scoped_lock lock(mutex_);
  if (const auto known = scenes_.find(key); known != scenes_.end()) return known->second;
  PROBE_ASSIGN(auto made, StaticScene::make(statics, std::move(meshes)));
  if (scenes_.size() >= kKeptScenes) {
    std::erase_if(scenes_, [](const auto& entry) { return entry.second.use_count() == 1; });
  }
  scenes_[key] = made;
  return made;
}

Result<std::shared_ptr<const StaticPicture>> SceneStore::static_picture(const SceneSpec& spec) {
  PROBE_ASSIGN(auto scene, static_scene(spec.statics));
  const Sha256 key = StaticPicture::key_of(spec);
  const std::scoped_lock lock(mutex_);
  std::erase_if(pictures_, [](const auto& entry) { return entry.second.expired(); });
  // A live picture holds its photo, so that no other can have its address.
  if (const auto found = pictures_.find(key); found != pictures_.end()) {
    if (auto known = found->second.lock()) {
      keep(known);
      return known;
    }
  }
  auto made = std::make_shared<StaticPicture>();
  PROBE_TRY(made->trace(spec, spec.camera, std::move(scene)));
  pictures_[key] = made;
  keep(made);
  return std::shared_ptr<const StaticPicture>(std::move(made));
}

// With the lock held.
void SceneStore::keep(std::shared_ptr<const StaticPicture> picture) {
  latest_.remove(picture);
  latest_.push_front(std::move(picture));
  std::size_t rays = 0;
  std::erase_if(latest_, [&](const auto& kept) {
    const std::size_t more = kept->rays.dx.size();
    if (rays + more > kKeptRays) return true;
    rays += more;
    return false;
  });
}

}  // namespace probe::render
