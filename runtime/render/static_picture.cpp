#include "runtime/render/static_picture.h"

#include <algorithm>
#include <cmath>

#include "runtime/base/sha256.h"
#include "runtime/render/encode.h"

namespace probe::render {
namespace {

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
  return Failure{.code = Fault::kRender,
                 .message = "the photo has not width x height pixels",
                 .where = "photo"};
}

Status check_quality(const SceneSpec& spec) {
  const auto refuse = [](std::string message) -> Status {
    return Failure{.code = Fault::kRender, .message = std::move(message), .where = "camera"};
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

// Fills a static picture tile by tile.
class StaticTracer {
 public:
  StaticTracer(StaticPicture& out, const SceneSpec& spec, const Camera& camera)
      : out_(out), occlusion_rays_(spec.occlusion_rays) {
    const CameraRays& rays = out.rays;
    out.hits = {};
    out.receivers = {};
    if (!out.casts()) return;
    // Shadows keep their place in a plane; a grid round a point before the camera holds the scene.
    const Vec3 centre = camera.position + camera.forward_left_up.col(0);
    out.receivers.prepare(out.lights,
                          {static_cast<float>(centre.x()), static_cast<float>(centre.y()),
                           static_cast<float>(centre.z())},
                          4 * static_cast<std::size_t>(rays.tiles()));
  }

  void trace() {
    const std::size_t samples = static_cast<std::size_t>(out_.rays.tiles()) * kTileSamples;
    out_.farthest.assign(samples, kFarthest);
    out_.linear.clear();
    if (out_.samples > 1 && !out_.photo) out_.linear.assign(samples, {0, 0, 0});
    for (int tile = 0; tile < out_.rays.tiles(); ++tile) {
      if (!statics().empty()) trace_tile(tile);
      if (out_.casts()) keep(tile);
    }
    if (!out_.linear.empty()) average();
  }

 private:
  const TopScene& statics() const { return out_.scene->top; }

  void trace_tile(int tile) {
    const CameraRays& rays = out_.rays;
    Picture& picture = out_.picture;
    const std::size_t base = static_cast<std::size_t>(tile) * kTileSamples;
    tracer_->trace(statics(), out_.origins, rays, tile, kAllBlocks, out_.farthest.data() + base);
    if (!out_.photo) {
      const Casters casters{nullptr, &statics()};
      tracer_->shade(statics(), rays, tile, out_.lights, {casters, casters, occlusion_rays_});
    }
    const TileHits& hits = tracer_->hits();
    const ShadeOutput& colors = tracer_->colors();
    const std::size_t count = static_cast<std::size_t>(hits.count);
    for (std::size_t i = 0; i < count; ++i) out_.farthest[base + hits.sample[i]] = hits.t[i];
    const int n = out_.samples;
    if (n == 1) {
      show_hits(hits, statics(), rays, tile, out_.photo ? nullptr : &colors, picture);
      return;
    }
    const int left = tile % rays.tiles_x * kTileSide, top = tile / rays.tiles_x * kTileSide;
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t sample = hits.sample[i];
      const int x = left + kTileOffsets[sample].x, y = top + kTileOffsets[sample].y;
      if (x >= rays.width || y >= rays.height) continue;
      if (!out_.linear.empty()) {
        out_.linear[base + sample] = {capped(colors.r[i]), capped(colors.g[i]),
                                      capped(colors.b[i])};
      }
      if (x % n != 0 || y % n != 0) continue;
      const std::size_t pixel = picture.at(x / n, y / n);
      picture.depth[pixel] = hits.t[i] * rays.cosine[base + sample];
      picture.segmentation[pixel] = statics().instances()[hits.instance[i]].id;
    }
  }

  // The static surface of a tile, for shadows to fall on.
  void keep(int tile) {
    if (statics().empty()) {
      out_.hits.first.push_back(0);
      return;
    }
    const CameraRays& rays = out_.rays;
    const TileHits& hits = tracer_->hits();
    out_.hits.add_tile(hits);
    const std::size_t base = static_cast<std::size_t>(tile) * kTileSamples;
    for (std::size_t i = 0; i < static_cast<std::size_t>(hits.count); ++i) {
      const std::size_t ray = base + hits.sample[i];
      const int block = hits.sample[i] / 64;
      const auto bx = static_cast<std::size_t>(2 * (tile % rays.tiles_x) + block % 2);
      const auto by = static_cast<std::size_t>(2 * (tile / rays.tiles_x) + block / 2);
      out_.receivers.add(
          by * 2 * static_cast<std::size_t>(rays.tiles_x) + bx,
          {rays.origin[0] + hits.t[i] * rays.dx[ray], rays.origin[1] + hits.t[i] * rays.dy[ray],
           rays.origin[2] + hits.t[i] * rays.dz[ray]});
    }
  }

  void average() {
    const CameraRays& rays = out_.rays;
    const int n = out_.samples;
    Picture& picture = out_.picture;
    std::vector<std::array<float, 3>> sums(count_of(picture.width, picture.height), {0, 0, 0});
    for (int tile = 0; tile < rays.tiles(); ++tile) {
      for (std::size_t sample = 0; sample < kTileSamples; ++sample) {
        const int x = tile % rays.tiles_x * kTileSide + kTileOffsets[sample].x;
        const int y = tile / rays.tiles_x * kTileSide + kTileOffsets[sample].y;
        if (x >= rays.width || y >= rays.height) continue;
        auto& sum = sums[picture.at(x / n, y / n)];
        const auto& c = out_.linear[static_cast<std::size_t>(tile) * kTileSamples + sample];
        for (std::size_t k = 0; k < 3; ++k) sum[k] += c[k];
      }
    }
    const float share = 1.0f / static_cast<float>(n * n);
    for (std::size_t pixel = 0; pixel < sums.size(); ++pixel) {
      for (std::size_t k = 0; k < 3; ++k) {
        picture.rgb[3 * pixel + k] = to_display_byte(share * sums[pixel][k]);
      }
    }
  }

  StaticPicture& out_;
  int occlusion_rays_;
  std::unique_ptr<TileTracer> tracer_ = std::make_unique<TileTracer>();
};

}  // namespace

Result<LightTable> make_lights(const Lights& lights) {
  LightTable table;
  if (!std::isfinite(lights.ambient) || lights.ambient < 0) {
    return Failure{
        .code = Fault::kRender, .message = "ambient light must be finite, 0 or more", .where = ""};
  }
  table.ambient = static_cast<float>(lights.ambient);
  for (std::size_t k = 0; k < 3; ++k) {
    if (!std::isfinite(lights.color[k]) || lights.color[k] < 0)
      return Failure{.code = Fault::kRender,
                     .message = "the colour of a light has factors of 0 or more",
                     .where = ""};
    table.color[k] = static_cast<float>(lights.color[k]);
  }
  for (const Sun& sun : lights.suns) {
    const double length = sun.direction.norm();
    if (!sun.direction.allFinite() || !(length > 0) || !std::isfinite(sun.power) || sun.power < 0) {
      return Failure{.code = Fault::kRender,
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

Status StaticPicture::check(const SceneSpec& spec) {
  PROBE_TRY(check_quality(spec));
  PROBE_TRY(check_camera(sample_camera(spec.camera, spec.samples)));
  PROBE_TRY(make_lights(spec.lights));
  if (spec.photo) PROBE_TRY(check_photo(*spec.photo));
  return {};
}

Status StaticPicture::trace(const SceneSpec& spec, const Camera& camera,
                            std::shared_ptr<const StaticScene> seen) {
  PROBE_TRY(check_quality(spec));
  scene = std::move(seen);
  samples = spec.samples;
  PROBE_TRY(make_camera_rays(sample_camera(camera, spec.samples), rays));
  PROBE_ASSIGN(lights, make_lights(spec.lights));
  origins.set(scene->top, rays.origin);

  picture.clear(camera.width, camera.height);
  if (spec.photo) {
    PROBE_TRY(check_photo(*spec.photo));
    picture.rgb = fit_photo(*spec.photo, picture.width, picture.height);
  }
  photo = spec.photo;
  const FlushDenormals guard;
  StaticTracer(*this, spec, camera).trace();
  return {};
}

Sha256 StaticPicture::key_of(const SceneSpec& spec) {
  Hasher hasher;
  const auto vec3 = [&hasher](const Vec3& v) {
    for (int k = 0; k < 3; ++k) hasher.f64(v[k]);
  };
  hasher.hash(StaticScene::key_of(spec.statics));
  const Camera& camera = spec.camera;
  vec3(camera.position);
  for (int k = 0; k < 3; ++k) vec3(camera.forward_left_up.col(k));
  hasher.u32(static_cast<std::uint32_t>(camera.width))
      .u32(static_cast<std::uint32_t>(camera.height));
  hasher.f64(camera.fx).f64(camera.fy).f64(camera.cx).f64(camera.cy);
  hasher.f64(spec.lights.ambient).f64s(spec.lights.color).u64(spec.lights.suns.size());
  for (const Sun& sun : spec.lights.suns) {
    vec3(sun.direction);
    hasher.f64(sun.power).u8(sun.shadow ? 1 : 0);
  }
  hasher.u64(reinterpret_cast<std::uintptr_t>(spec.photo.get()));
  hasher.u32(static_cast<std::uint32_t>(spec.samples));
  hasher.u32(static_cast<std::uint32_t>(spec.occlusion_rays));
  return hasher.finish();
}

}  // namespace probe::render
