// Pictures by the vertex law: triangles drawn in screen order instead of rays traced, since nothing
// casts a shadow. The same contracts as of the renderer by rays (README.md).
#pragma once

#include <memory>

#include "runtime/render/renderer.h"

namespace probe::render {

// Fails (kRender) on what cannot be drawn, naming it: also on a photo, occlusion and 16 samples,
// which this law does not have.
Result<std::unique_ptr<Renderer>> create_vertex_renderer(SceneSpec spec, SceneStore& store);

}  // namespace probe::render
