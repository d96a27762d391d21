// What does not change within an episode: rays, and the picture of the static scene with the
// distance of every sample. Read-only after it is made; shared by all renderers of the same
// statics, camera, lights, photo and quality.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "runtime/render/camera_rays.h"
#include "runtime/render/renderer.h"
#include "runtime/render/shading.h"
#include "runtime/render/shadow_marks.h"
#include "runtime/render/tile_tracer.h"
#include "runtime/render/top_scene.h"

namespace probe::render {

struct StaticPass {
  int samples = 1;            // a side of a pixel
  int width = 0, height = 0;  // of the picture; the rays' are `samples` times that
  CameraRays rays;
  LightTable lights;
  TopScene scene;
  std::vector<float> farthest;    // tile order: t of the static hit, 10 where there is none
  std::vector<std::uint8_t> rgb;  // raster: the photo, or the shaded statics
  std::vector<float> depth;       // raster
  std::vector<std::uint16_t> segmentation;  // raster
  // Tile order, linear and at most 1; only with several samples a pixel and without a photo.
  std::vector<std::array<float, 3>> linear;
  // Only where a sun casts: the static surface of every sample, and where its shadows can fall.
  StoredHits hits;
  ShadowReceivers receivers;

  std::shared_ptr<const scene::Texture> photo;  // its address names this in the cache

  bool casts() const { return lights.any_shadow(); }

  static Result<std::shared_ptr<const StaticPass>> shared(const SceneSpec& spec);
  // Always traced anew.
  static Result<std::shared_ptr<const StaticPass>> make(const SceneSpec& spec);
};

}  // namespace probe::render
