#include "runtime/render/blend.h"

#include "runtime/render/encode.h"

namespace probe::render {
namespace {

// Linear light of a sample that nothing changes.
std::array<float, 3> background(const StaticPicture& seen, int tile, std::size_t sample) {
  const std::size_t index = static_cast<std::size_t>(tile) * kTileSamples + sample;
  if (!seen.linear.empty()) return seen.linear[index];
  const int x = tile % seen.rays.tiles_x * kTileSide + kTileOffsets[sample].x;
  const int y = tile / seen.rays.tiles_x * kTileSide + kTileOffsets[sample].y;
  if (x >= seen.rays.width || y >= seen.rays.height) return {0, 0, 0};
  const std::uint8_t* rgb =
      seen.picture.rgb.data() + 3 * seen.picture.at(x / seen.samples, y / seen.samples);
  return {kDisplayThresholds[rgb[0]], kDisplayThresholds[rgb[1]], kDisplayThresholds[rgb[2]]};
}

}  // namespace

void TileBlender::draw(const StaticPicture& seen, const TopScene& dynamics, int occlusion_rays,
                       int tile, const BlockSets& blocks, TileTracer& tracer, Picture& frame) {
  const CameraRays& rays = seen.rays;
  const std::size_t base = static_cast<std::size_t>(tile) * kTileSamples;
  const int left = tile % rays.tiles_x * kTileSide, top = tile / rays.tiles_x * kTileSide;
  const int n = seen.samples;
  covered_.fill(false);
  changed_.fill(false);
  const TileHits& hits = tracer.hits();
  if (hits.count > 0) {
    const Casters all{&dynamics, &seen.scene->top};
    tracer.shade(dynamics, rays, tile, seen.lights, {all, all, occlusion_rays});
  }
  for (std::size_t i = 0; i < static_cast<std::size_t>(hits.count); ++i) {
    const std::size_t sample = hits.sample[i];
    covered_[sample] = true;
    keep_color(tracer, i, sample);
    const int x = left + kTileOffsets[sample].x, y = top + kTileOffsets[sample].y;
    if (x >= rays.width || y >= rays.height || x % n != 0 || y % n != 0) continue;
    const std::size_t pixel = frame.at(x / n, y / n);
    frame.depth[pixel] = hits.t[i] * rays.cosine[base + sample];
    frame.segmentation[pixel] = dynamics.instances()[hits.instance[i]].id;
  }
  if (seen.casts()) shade_statics(seen, dynamics, occlusion_rays, tile, blocks, tracer);
  write_means(seen, tile, frame);
}

void TileBlender::keep_color(const TileTracer& tracer, std::size_t hit, std::size_t sample) {
  const ShadeOutput& colors = tracer.colors();
  changed_[sample] = true;
  color_[sample] = {capped(colors.r[hit]), capped(colors.g[hit]), capped(colors.b[hit])};
}

// The static samples of the marked blocks that no moving thing covers.
void TileBlender::shade_statics(const StaticPicture& seen, const TopScene& dynamics,
                                int occlusion_rays, int tile, const BlockSets& blocks,
                                TileTracer& tracer) {
  const TopScene& statics = seen.scene->top;
  tracer.take(statics, seen.hits, tile, blocks, covered_);
  const TileHits& hits = tracer.hits();
  if (hits.count == 0) return;
  if (!seen.photo) {
    // Moving things take sun from statics, not ambient light, which would need wider marks.
    tracer.shade(statics, seen.rays, tile, seen.lights,
                 {{&dynamics, &statics}, {nullptr, &statics}, occlusion_rays});
    for (std::size_t i = 0; i < static_cast<std::size_t>(hits.count); ++i) {
      keep_color(tracer, i, hits.sample[i]);
    }
    return;
  }
  tracer.catch_shadow(statics, seen.rays, tile, seen.lights, dynamics);
  for (std::size_t i = 0; i < static_cast<std::size_t>(hits.count); ++i) {
    const float light = tracer.light_left()[i];
    if (light == 1) continue;  // the photo's bytes stay as they are
    const std::size_t sample = hits.sample[i];
    std::array<float, 3> color = background(seen, tile, sample);
    for (float& channel : color) channel *= light;
    changed_[sample] = true;
    color_[sample] = color;
  }
}

// Pixels of which a sample changed; n x n samples of one follow each other in Morton order.
void TileBlender::write_means(const StaticPicture& seen, int tile, Picture& frame) const {
  const int n = seen.samples;
  const auto each = static_cast<std::size_t>(n * n);
  const float share = 1.0f / static_cast<float>(each);
  const int left = tile % seen.rays.tiles_x * kTileSide;
  const int top = tile / seen.rays.tiles_x * kTileSide;
  for (std::size_t first = 0; first < kTileSamples; first += each) {
    bool any = false;
    for (std::size_t s = first; s < first + each; ++s) any = any || changed_[s];
    const int x = left + kTileOffsets[first].x, y = top + kTileOffsets[first].y;
    if (!any || x >= seen.rays.width || y >= seen.rays.height) continue;
    std::array<float, 3> sum{0, 0, 0};
    for (std::size_t s = first; s < first + each; ++s) {
      const std::array<float, 3> color = changed_[s] ? color_[s] : background(seen, tile, s);
      for (std::size_t k = 0; k < 3; ++k) sum[k] += color[k];
    }
    std::uint8_t* rgb = frame.rgb.data() + 3 * frame.at(x / n, y / n);
    for (std::size_t k = 0; k < 3; ++k) rgb[k] = to_display_byte(share * sum[k]);
  }
}

}  // namespace probe::render
