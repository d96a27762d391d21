#include "runtime/render/static_pass.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>

#include "runtime/base/sha256.h"
#include "runtime/render/encode.h"
#include "runtime/render/tile_tracer.h"

namespace probe::render {
namespace {

Result<LightTable> make_lights(const Lights& lights) {
  LightTable table;
  if (!std::isfinite(lights.ambient) || lights.ambient < 0) {
    return Failure{
        .code = "render", .message = "ambient light must be finite, 0 or more", .where = ""};
  }
  table.ambient = static_cast<float>(lights.ambient);
  for (const Sun& sun : lights.suns) {
    const double length = sun.direction.norm();
    if (!sun.direction.allFinite() || !(length > 0) || !std::isfinite(sun.power) || sun.power < 0) {
      return Failure{.code = "render",
                     .message = "a sun needs a direction and a power of 0 or more",
                     .where = ""};
    }
    const Vec3 towards = -sun.direction / length;
    table.suns.push_back({static_cast<float>(towards.x()), static_cast<float>(towards.y()),
                          static_cast<float>(towards.z()), static_cast<float>(sun.power),
                          sun.shadow});
  }
  return table;
}

// How much of each source pixel lies in target pixel `index`.
struct Share {
  int source;
  double weight;
};
std::vector<Share> shares(int index, int source_size, int target_size) {
  const double scale = static_cast<double>(source_size) / target_size;
  const double from = index * scale, to = (index + 1) * scale;
  std::vector<Share> out;
  for (int s = static_cast<int>(from); s < source_size && s < to; ++s) {
    const double weight = std::min<double>(to, s + 1) - std::max<double>(from, s);
    if (weight > 1e-9) out.push_back({s, weight});
  }
  return out;
}

// The photo's bytes; another size is box-filtered, since it is a display picture and not light.
std::vector<std::uint8_t> fit_photo(const scene::Texture& photo, int width, int height) {
  std::vector<std::uint8_t> rgb(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) *
                                3);
  std::vector<std::vector<Share>> columns;
  for (int x = 0; x < width; ++x) columns.push_back(shares(x, photo.width, width));
  std::size_t out = 0;
  for (int y = 0; y < height; ++y) {
    const std::vector<Share> rows = shares(y, photo.height, height);
    for (int x = 0; x < width; ++x) {
      double sum[3] = {}, weight = 0;
      for (const Share& row : rows) {
        for (const Share& column : columns[static_cast<std::size_t>(x)]) {
          const double w = row.weight * column.weight;
          const std::size_t texel =
              4 * (static_cast<std::size_t>(row.source) * static_cast<std::size_t>(photo.width) +
                   static_cast<std::size_t>(column.source));
          for (std::size_t k = 0; k < 3; ++k) sum[k] += w * photo.rgba[texel + k];
          weight += w;
        }
      }
      for (const double channel : sum) {
        rgb[out++] = static_cast<std::uint8_t>(channel / weight + 0.5);
      }
    }
  }
  return rgb;
}

Status check_photo(const scene::Texture& photo) {
  if (photo.width > 0 && photo.height > 0 &&
      photo.rgba.size() ==
          4 * static_cast<std::size_t>(photo.width) * static_cast<std::size_t>(photo.height)) {
    return {};
  }
  return Failure{
      .code = "render", .message = "the photo has not width x height pixels", .where = "photo"};
}

Sha256 key_of(const SceneSpec& spec) {
  Hasher hasher;
  const auto pointer = [&hasher](const void* p) {
    hasher.u64(reinterpret_cast<std::uintptr_t>(p));
  };
  const auto vec3 = [&hasher](const Vec3& v) {
    for (int k = 0; k < 3; ++k) hasher.f64(v[k]);
  };
  const Camera& camera = spec.camera;
  vec3(camera.position);
  for (int k = 0; k < 3; ++k) vec3(camera.forward_left_up.col(k));
  hasher.u32(static_cast<std::uint32_t>(camera.width))
      .u32(static_cast<std::uint32_t>(camera.height));
  hasher.f64(camera.fx).f64(camera.fy).f64(camera.cx).f64(camera.cy);
  hasher.f64(spec.lights.ambient).u64(spec.lights.suns.size());
  for (const Sun& sun : spec.lights.suns) {
    vec3(sun.direction);
    hasher.f64(sun.power).u8(sun.shadow ? 1 : 0);
  }
  pointer(spec.photo.get());
  hasher.u64(spec.statics.size());
  for (const Visual& visual : spec.statics) {
    pointer(visual.mesh.get());
    vec3(visual.origin.position);
    for (int k = 0; k < 4; ++k) hasher.f64(visual.origin.rotation.coeffs()[k]);
    hasher.u32(visual.body).u8(visual.robot ? 1 : 0);
  }
  return hasher.finish();
}

}  // namespace

Result<std::shared_ptr<const StaticPass>> StaticPass::make(const SceneSpec& spec) {
  auto pass = std::make_shared<StaticPass>();
  PROBE_ASSIGN(pass->rays, make_camera_rays(spec.camera));
  PROBE_ASSIGN(pass->lights, make_lights(spec.lights));
  PROBE_ASSIGN(TopScene scene, TopScene::create(spec.statics, TopScene::Kind::kStatic));
  const FlushDenormals guard;
  const CameraRays& rays = pass->rays;
  PROBE_TRY(scene.place(std::vector<Pose>(spec.statics.size()), rays.origin));
  for (const Instance& instance : scene.instances()) pass->meshes.push_back(instance.geometry);

  const std::size_t pixels =
      static_cast<std::size_t>(rays.width) * static_cast<std::size_t>(rays.height);
  pass->depth.assign(pixels, 0);
  pass->segmentation.assign(pixels, 0);
  if (spec.photo) {
    PROBE_TRY(check_photo(*spec.photo));
    pass->photo = spec.photo;
    pass->rgb = fit_photo(*spec.photo, rays.width, rays.height);
  } else {
    pass->rgb.assign(3 * pixels, 0);
  }
  pass->farthest.assign(static_cast<std::size_t>(rays.tiles()) * kTileSamples, kFarthest);
  if (scene.empty()) return std::shared_ptr<const StaticPass>(std::move(pass));

  const auto tracer = std::make_unique<TileTracer>();
  for (int tile = 0; tile < rays.tiles(); ++tile) {
    const std::size_t base = static_cast<std::size_t>(tile) * kTileSamples;
    tracer->trace(scene, rays, tile, 0xF, pass->farthest.data() + base);
    if (!spec.photo) tracer->shade(scene, rays, tile, pass->lights, false);
    const TileHits& hits = tracer->hits();
    const int left = tile % rays.tiles_x * kTileSide, top = tile / rays.tiles_x * kTileSide;
    for (std::size_t i = 0; i < static_cast<std::size_t>(hits.count); ++i) {
      const std::size_t sample = hits.sample[i];
      pass->farthest[base + sample] = hits.t[i];
      const int x = left + kTileOffsets[sample].x, y = top + kTileOffsets[sample].y;
      if (x >= rays.width || y >= rays.height) continue;
      const std::size_t pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(rays.width) +
                                static_cast<std::size_t>(x);
      pass->depth[pixel] = hits.t[i] * rays.cosine[base + sample];
      pass->segmentation[pixel] = scene.instances()[hits.instance[i]].id;
      if (spec.photo) continue;
      pass->rgb[3 * pixel] = to_display_byte(tracer->colors().r[i]);
      pass->rgb[3 * pixel + 1] = to_display_byte(tracer->colors().g[i]);
      pass->rgb[3 * pixel + 2] = to_display_byte(tracer->colors().b[i]);
    }
  }
  return std::shared_ptr<const StaticPass>(std::move(pass));
}

Result<std::shared_ptr<const StaticPass>> StaticPass::shared(const SceneSpec& spec) {
  static std::mutex mutex;
  static std::map<Sha256, std::weak_ptr<const StaticPass>> cache;
  const std::scoped_lock lock(mutex);
  std::erase_if(cache, [](const auto& entry) { return entry.second.expired(); });
  const Sha256 key = key_of(spec);
  const auto found = cache.find(key);
  if (found != cache.end()) {
    if (auto known = found->second.lock()) return known;
  }
  PROBE_ASSIGN(std::shared_ptr<const StaticPass> made, make(spec));
  cache[key] = made;
  return made;
}

}  // namespace probe::render
