// What stands still in a scene, as rays from any camera meet it. Read-only after it is made; shared
// by all cameras, worlds and tasks that have the same statics. What one camera sees of it is
// StaticPicture.
#pragma once

#include <memory>
#include <vector>

#include "runtime/base/sha256.h"
#include "runtime/render/top_scene.h"

namespace probe::render {

struct StaticScene {
  TopScene top;
  Sha256 key;

  // `meshes`: one a visual of `statics`. Fails (kRender), naming the visual, as TopScene
  // does.
  static Result<std::shared_ptr<const StaticScene>> make(
      const std::vector<Visual>& statics, std::vector<std::shared_ptr<const MeshGeometry>> meshes);
  // Equal for the same meshes in the same places under the same ids.
  static Sha256 key_of(const std::vector<Visual>& statics);
};

}  // namespace probe::render
