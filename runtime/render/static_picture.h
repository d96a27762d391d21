// What one camera sees of a StaticScene: its rays, and the picture with the distance of every
// sample. Of a camera that stands still it is traced once and then read-only, shared by all worlds
// through SceneStore; a camera that moves owns one and traces it again for every frame, in the same
// memory.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "runtime/render/camera_rays.h"
#include "runtime/render/picture.h"
#include "runtime/render/renderer.h"
#include "runtime/render/shading.h"
#include "runtime/render/shadow_marks.h"
#include "runtime/render/static_scene.h"
#include "runtime/render/tile_tracer.h"

namespace probe::render {

// Fails (kRender) on light that is not finite, negative or has no direction.
Result<LightTable> make_lights(const Lights& lights);

struct StaticPicture {
  std::shared_ptr<const StaticScene> scene;
  std::shared_ptr<const scene::Texture> photo;  // its address is part of the key
  int samples = 1;                              // a side of a pixel
  CameraRays rays;                              // the picture's size times `samples`
  RayOrigins origins;
  LightTable lights;
  Picture picture;              // the photo, or the shaded statics
  std::vector<float> farthest;  // tile order: t of the static hit, 10 where there is none
  // Tile order, linear and at most 1; only with several samples a pixel and without a photo.
  std::vector<std::array<float, 3>> linear;
  // Only where a sun casts: the static surface of every sample, and where its shadows can fall.
  StoredHits hits;
  ShadowReceivers receivers;

  bool casts() const { return lights.any_shadow(); }

  // Traces all of it, through `camera` in the place of `spec`'s. Fails (kRender) on a camera,
  // lights, a photo or a quality that cannot be; then it is not to be used.
  Status trace(const SceneSpec& spec, const Camera& camera,
               std::shared_ptr<const StaticScene> seen);

  // That trace() of this spec would not fail, at the price of a few comparisons.
  static Status check(const SceneSpec& spec);
  // Equal for specs that give the same picture.
  static Sha256 key_of(const SceneSpec& spec);
};

}  // namespace probe::render
