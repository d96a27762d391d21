// What does not change within an episode: rays, and the picture of the static scene with the
// distance of every sample. Read-only after it is made; shared by all renderers of the same
// statics, camera, lights and photo.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "runtime/render/camera_rays.h"
#include "runtime/render/renderer.h"
#include "runtime/render/shading.h"
#include "runtime/render/top_scene.h"

namespace probe::render {

struct StaticPass {
  CameraRays rays;
  LightTable lights;
  std::vector<float> farthest;    // tile order: t of the static hit, 10 where there is none
  std::vector<std::uint8_t> rgb;  // raster: the photo, or the shaded statics
  std::vector<float> depth;       // raster
  std::vector<std::uint16_t> segmentation;  // raster

  // What names it in the cache is kept alive here, so that no address is used twice.
  std::vector<std::shared_ptr<const MeshGeometry>> meshes;
  std::shared_ptr<const scene::Texture> photo;

  static Result<std::shared_ptr<const StaticPass>> shared(const SceneSpec& spec);
  // Always traced anew.
  static Result<std::shared_ptr<const StaticPass>> make(const SceneSpec& spec);
};

}  // namespace probe::render
