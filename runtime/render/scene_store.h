// What pictures of the same things share: the ray structure of each mesh, the scenes that stand
// still, and what cameras that stand still see of them. Whoever owns the meshes owns one (the
// assets of a process), so that no change of task or world builds anything twice.
#pragma once

#include <cstddef>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/base/sha256.h"
#include "runtime/render/renderer.h"

namespace probe::render {

struct MeshGeometry;
struct VertexMesh;
struct StaticScene;
struct StaticPicture;

// Every call may come from any thread. A mesh is known by its address and kept as long as the
// store, so it must not be changed after it was given.
class SceneStore {
 public:
  // Six pictures of 640 x 480 with one sample a pixel; a ray takes 30 bytes.
  static constexpr std::size_t kKeptRays = std::size_t{1} << 21;

  // From here on, those that nobody holds go before another is made.
  static constexpr std::size_t kKeptScenes = 64;

  SceneStore();
  ~SceneStore();

  // One a visual; made at the first call for a mesh. Fails (kRender), naming the visual, on
  // one without a mesh, or with a mesh whose arrays do not fit together.
  Result<std::vector<std::shared_ptr<const MeshGeometry>>> geometries(
      std::span<const Visual> visuals);
  // The same for pictures whose light is that of vertices.
  Result<std::vector<std::shared_ptr<const VertexMesh>>> vertex_meshes(
      std::span<const Visual> visuals);
  Result<std::shared_ptr<const StaticScene>> static_scene(const std::vector<Visual>& statics);
  // What `spec`'s camera sees of its statics. Beyond those that somebody holds the latest are kept,
  // up to kKeptRays in all, so that tasks that take turns trace nothing twice and a sweep over
  // cameras does not fill the memory.
  Result<std::shared_ptr<const StaticPicture>> static_picture(const SceneSpec& spec);

 private:
  std::mutex mutex_;
  std::map<const scene::Mesh*, std::shared_ptr<const MeshGeometry>> geometries_;
  std::map<const scene::Mesh*, std::shared_ptr<const VertexMesh>> vertex_meshes_;
  void keep(std::shared_ptr<const StaticPicture> picture);

  std::map<Sha256, std::shared_ptr<const StaticScene>> scenes_;
  std::map<Sha256, std::weak_ptr<const StaticPicture>> pictures_;
  std::list<std::shared_ptr<const StaticPicture>> latest_;  // the last one asked for in front
};

}  // namespace probe::render
