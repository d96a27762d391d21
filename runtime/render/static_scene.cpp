#include "runtime/render/static_scene.h"

namespace probe::render {

Result<std::shared_ptr<const StaticScene>> StaticScene::make(
    const std::vector<Visual>& statics, std::vector<std::shared_ptr<const MeshGeometry>> meshes) {
  auto scene = std::make_shared<StaticScene>();
  scene->key = key_of(statics);
  PROBE_ASSIGN(scene->top, TopScene::create(statics, std::move(meshes), TopScene::Kind::kStatic));
  const FlushDenormals guard;
  PROBE_TRY(scene->top.place(std::vector<Pose>(statics.size())));
  return std::shared_ptr<const StaticScene>(std::move(scene));
}

Sha256 StaticScene::key_of(const std::vector<Visual>& statics) {
  Hasher hasher;
  hasher.u64(statics.size());
  for (const Visual& visual : statics) {
    hasher.u64(reinterpret_cast<std::uintptr_t>(visual.mesh.get()));
    for (int k = 0; k < 3; ++k) hasher.f64(visual.origin.position[k]);
    for (int k = 0; k < 4; ++k) hasher.f64(visual.origin.rotation.coeffs()[k]);
    hasher.u32(visual.body).u8(visual.robot ? 1 : 0);
  }
  return hasher.finish();
}

}  // namespace probe::render
