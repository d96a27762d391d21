#include "runtime/render/static_pass.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>

#include "runtime/base/sha256.h"
#include "runtime/render/encode.h"

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

Status check_quality(const SceneSpec& spec) {
  const auto refuse = [](std::string message) -> Status {
    return Failure{.code = "render", .message = std::move(message), .where = "camera"};
  };
  if (spec.samples != 1 && spec.samples != 2 && spec.samples != 4) {
    return refuse("a pixel has 1, 2 or 4 samples a side, not " + std::to_string(spec.samples));
  }
  if (spec.occlusion_rays < 0 || spec.occlusion_rays > kMaxOcclusionRays) {
    return refuse("ambient occlusion takes 0 to 16 rays, not " +
                  std::to_string(spec.occlusion_rays));
  }
  return {};
}

std::size_t count_of(int width, int height) {
  return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
}

// Fills a static pass tile by tile.
class StaticTracer {
 public:
  StaticTracer(StaticPass& pass, const SceneSpec& spec)
      : pass_(pass), occlusion_rays_(spec.occlusion_rays) {
    // Shadows keep their place in a plane; a grid round a point before the camera holds the scene.
    const Vec3 centre = spec.camera.position + spec.camera.forward_left_up.col(0);
    const CameraRays& rays = pass.rays;
    if (pass.casts()) {
      pass.receivers.prepare(pass.lights,
                             {static_cast<float>(centre.x()), static_cast<float>(centre.y()),
                              static_cast<float>(centre.z())},
                             4 * static_cast<std::size_t>(rays.tiles()));
    }
  }

  void trace() {
    const std::size_t samples = static_cast<std::size_t>(pass_.rays.tiles()) * kTileSamples;
    pass_.farthest.assign(samples, kFarthest);
    if (pass_.samples > 1 && !pass_.photo) pass_.linear.assign(samples, {0, 0, 0});
    for (int tile = 0; tile < pass_.rays.tiles(); ++tile) {
      if (!pass_.scene.empty()) trace_tile(tile);
      if (pass_.casts()) keep(tile);
    }
    if (!pass_.linear.empty()) average();
  }

 private:
  void trace_tile(int tile) {
    const CameraRays& rays = pass_.rays;
    const std::size_t base = static_cast<std::size_t>(tile) * kTileSamples;
    tracer_->trace(pass_.scene, rays, tile, 0xF, pass_.farthest.data() + base);
    if (!pass_.photo) {
      const Casters statics{nullptr, &pass_.scene};
      tracer_->shade(pass_.scene, rays, tile, pass_.lights, {statics, statics, occlusion_rays_});
    }
    const TileHits& hits = tracer_->hits();
    const ShadeOutput& colors = tracer_->colors();
    for (std::size_t i = 0; i < static_cast<std::size_t>(hits.count); ++i) {
      const std::size_t sample = hits.sample[i];
      pass_.farthest[base + sample] = hits.t[i];
      const int x = tile % rays.tiles_x * kTileSide + kTileOffsets[sample].x;
      const int y = tile / rays.tiles_x * kTileSide + kTileOffsets[sample].y;
      if (x >= rays.width || y >= rays.height) continue;
      if (!pass_.linear.empty()) {
        pass_.linear[base + sample] = {capped(colors.r[i]), capped(colors.g[i]),
                                       capped(colors.b[i])};
      }
      if (x % pass_.samples != 0 || y % pass_.samples != 0) continue;
      const std::size_t pixel =
          count_of(pass_.width, y / pass_.samples) + static_cast<std::size_t>(x / pass_.samples);
      pass_.depth[pixel] = hits.t[i] * rays.cosine[base + sample];
      pass_.segmentation[pixel] = pass_.scene.instances()[hits.instance[i]].id;
      if (pass_.photo || pass_.samples > 1) continue;
      pass_.rgb[3 * pixel] = to_display_byte(colors.r[i]);
      pass_.rgb[3 * pixel + 1] = to_display_byte(colors.g[i]);
      pass_.rgb[3 * pixel + 2] = to_display_byte(colors.b[i]);
    }
  }

  // The static surface of a tile, for shadows to fall on.
  void keep(int tile) {
    if (pass_.scene.empty()) {
      pass_.hits.first.push_back(0);
      return;
    }
    const CameraRays& rays = pass_.rays;
    const TileHits& hits = tracer_->hits();
    pass_.hits.add_tile(hits);
    const std::size_t base = static_cast<std::size_t>(tile) * kTileSamples;
    for (std::size_t i = 0; i < static_cast<std::size_t>(hits.count); ++i) {
      const std::size_t ray = base + hits.sample[i];
      const int block = hits.sample[i] / 64;
      const auto bx = static_cast<std::size_t>(2 * (tile % rays.tiles_x) + block % 2);
      const auto by = static_cast<std::size_t>(2 * (tile / rays.tiles_x) + block / 2);
      pass_.receivers.add(
          by * 2 * static_cast<std::size_t>(rays.tiles_x) + bx,
          {rays.origin[0] + hits.t[i] * rays.dx[ray], rays.origin[1] + hits.t[i] * rays.dy[ray],
           rays.origin[2] + hits.t[i] * rays.dz[ray]});
    }
  }

  void average() {
    const CameraRays& rays = pass_.rays;
    const int n = pass_.samples;
    std::vector<std::array<float, 3>> sums(count_of(pass_.width, pass_.height), {0, 0, 0});
    for (int tile = 0; tile < rays.tiles(); ++tile) {
      for (std::size_t sample = 0; sample < kTileSamples; ++sample) {
        const int x = tile % rays.tiles_x * kTileSide + kTileOffsets[sample].x;
        const int y = tile / rays.tiles_x * kTileSide + kTileOffsets[sample].y;
        if (x >= rays.width || y >= rays.height) continue;
        auto& sum = sums[count_of(pass_.width, y / n) + static_cast<std::size_t>(x / n)];
        const auto& c = pass_.linear[static_cast<std::size_t>(tile) * kTileSamples + sample];
        for (std::size_t k = 0; k < 3; ++k) sum[k] += c[k];
      }
    }
    const float share = 1.0f / static_cast<float>(n * n);
    for (std::size_t pixel = 0; pixel < sums.size(); ++pixel) {
      for (std::size_t k = 0; k < 3; ++k) {
        pass_.rgb[3 * pixel + k] = to_display_byte(share * sums[pixel][k]);
      }
    }
  }

  StaticPass& pass_;
  int occlusion_rays_;
  std::unique_ptr<TileTracer> tracer_ = std::make_unique<TileTracer>();
};

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
  hasher.u32(static_cast<std::uint32_t>(spec.samples));
  hasher.u32(static_cast<std::uint32_t>(spec.occlusion_rays));
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
  PROBE_TRY(check_quality(spec));
  auto pass = std::make_shared<StaticPass>();
  pass->samples = spec.samples;
  pass->width = spec.camera.width;
  pass->height = spec.camera.height;
  PROBE_ASSIGN(pass->rays, make_camera_rays(sample_camera(spec.camera, spec.samples)));
  PROBE_ASSIGN(pass->lights, make_lights(spec.lights));
  PROBE_ASSIGN(pass->scene, TopScene::create(spec.statics, TopScene::Kind::kStatic));
  const FlushDenormals guard;
  PROBE_TRY(pass->scene.place(std::vector<Pose>(spec.statics.size()), pass->rays.origin));

  const std::size_t pixels = count_of(pass->width, pass->height);
  pass->depth.assign(pixels, 0);
  pass->segmentation.assign(pixels, 0);
  if (spec.photo) {
    PROBE_TRY(check_photo(*spec.photo));
    pass->photo = spec.photo;
    pass->rgb = fit_photo(*spec.photo, pass->width, pass->height);
  } else {
    pass->rgb.assign(3 * pixels, 0);
  }
  StaticTracer(*pass, spec).trace();
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
