#include "runtime/render/renderer.h"

#include <algorithm>
#include <cstring>

#include "runtime/render/block_marks.h"
#include "runtime/render/encode.h"
#include "runtime/render/static_pass.h"
#include "runtime/render/tile_tracer.h"
#include "runtime/render/top_scene.h"

namespace probe::render {
namespace {

class EmbreeRenderer final : public Renderer {
 public:
  EmbreeRenderer(SceneSpec spec, std::shared_ptr<const StaticPass> pass, TopScene dynamics)
      : spec_(std::move(spec)),
        static_(std::move(pass)),
        dynamics_(std::move(dynamics)),
        marks_(sample_camera(spec_.camera, spec_.samples), static_->rays),
        last_marks_(marks_),
        tracer_(std::make_unique<TileTracer>()) {
    show_statics(*static_);
  }

  Result<FrameView> render(std::span<const Pose> poses) override {
    const FlushDenormals guard;
    PROBE_TRY(dynamics_.place(poses, static_->rays.origin));
    marks_.clear();
    marks_.mark(dynamics_.instances());
    if (static_->casts()) shadow_marks_.mark(static_->receivers, dynamics_.instances(), marks_);
    for (int y = 0; y < marks_.blocks_y(); ++y) {
      for (int x = 0; x < marks_.blocks_x(); ++x) {
        // A marked block starts as its background too: misses need nothing else.
        if (marks_.marked(x, y) || last_marks_.marked(x, y)) restore_block(*static_, x, y);
      }
    }
    draw(*static_);
    std::swap(marks_, last_marks_);
    return view();
  }

  Result<FrameView> render_full(std::span<const Pose> poses) override {
    return render_from(spec_.camera, poses);
  }

  Result<FrameView> render_from(const Camera& camera, std::span<const Pose> poses) override {
    if (camera.width != static_->width || camera.height != static_->height) {
      return Failure{
          .code = "render", .message = "a renderer keeps its picture's size", .where = "camera"};
    }
    SceneSpec spec = spec_;
    spec.camera = camera;
    PROBE_ASSIGN(const std::shared_ptr<const StaticPass> fresh, StaticPass::make(spec));
    const FlushDenormals guard;
    PROBE_TRY(dynamics_.place(poses, fresh->rays.origin));
    show_statics(*fresh);
    marks_.mark_all();
    draw(*fresh);
    std::swap(marks_, last_marks_);  // the next cached frame restores all of it
    return view();
  }

 private:
  FrameView view() const { return {static_->width, static_->height, rgb_, depth_, segmentation_}; }

  void show_statics(const StaticPass& pass) {
    rgb_ = pass.rgb;
    depth_ = pass.depth;
    segmentation_ = pass.segmentation;
  }

  void restore_block(const StaticPass& pass, int block_x, int block_y) {
    const int side = kBlockSide / pass.samples;
    const int width = pass.width, height = pass.height;
    const int left = block_x * side, top = block_y * side;
    const int columns = std::min(side, width - left);
    if (columns <= 0) return;
    const auto n = static_cast<std::size_t>(columns);
    for (int y = top; y < std::min(top + side, height); ++y) {
      const std::size_t at = static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                             static_cast<std::size_t>(left);
      std::memcpy(rgb_.data() + 3 * at, pass.rgb.data() + 3 * at, 3 * n);
      std::memcpy(depth_.data() + at, pass.depth.data() + at, sizeof(float) * n);
      std::memcpy(segmentation_.data() + at, pass.segmentation.data() + at,
                  sizeof(std::uint16_t) * n);
    }
  }

  // Traces the marked blocks and writes what moving things show there.
  void draw(const StaticPass& pass) {
    if (dynamics_.empty()) return;
    const bool plain = pass.samples == 1 && !pass.casts();
    for (int ty = 0; ty < pass.rays.tiles_y; ++ty) {
      for (int tx = 0; tx < pass.rays.tiles_x; ++tx) {
        const unsigned blocks = marks_.tile_blocks(tx, ty);
        if (blocks == 0) continue;
        const int tile = ty * pass.rays.tiles_x + tx;
        tracer_->trace(dynamics_, pass.rays, tile, blocks,
                       pass.farthest.data() + static_cast<std::size_t>(tile) * kTileSamples);
        if (plain) {
          draw_tile(pass, tile);
        } else {
          blend_tile(pass, tile, blocks);
        }
      }
    }
  }

  std::size_t pixel_of(const StaticPass& pass, int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(pass.width) +
           static_cast<std::size_t>(x);
  }

  void shade_dynamics(const StaticPass& pass, int tile) {
    const Casters all{&dynamics_, &pass.scene};
    tracer_->shade(dynamics_, pass.rays, tile, pass.lights, {all, all, spec_.occlusion_rays});
  }

  // One sample a pixel, nothing falls on statics: hits are pixels.
  void draw_tile(const StaticPass& pass, int tile) {
    const CameraRays& rays = pass.rays;
    const std::size_t base = static_cast<std::size_t>(tile) * kTileSamples;
    const TileHits& hits = tracer_->hits();
    if (hits.count == 0) return;
    shade_dynamics(pass, tile);
    const ShadeOutput& colors = tracer_->colors();
    const int left = tile % rays.tiles_x * kTileSide, top = tile / rays.tiles_x * kTileSide;
    for (std::size_t i = 0; i < static_cast<std::size_t>(hits.count); ++i) {
      const std::size_t sample = hits.sample[i];
      const int x = left + kTileOffsets[sample].x, y = top + kTileOffsets[sample].y;
      if (x >= rays.width || y >= rays.height) continue;
      const std::size_t pixel = pixel_of(pass, x, y);
      depth_[pixel] = hits.t[i] * rays.cosine[base + sample];
      segmentation_[pixel] = dynamics_.instances()[hits.instance[i]].id;
      rgb_[3 * pixel] = to_display_byte(colors.r[i]);
      rgb_[3 * pixel + 1] = to_display_byte(colors.g[i]);
      rgb_[3 * pixel + 2] = to_display_byte(colors.b[i]);
    }
  }

  // A tile whose samples are averaged, or on whose statics shadows fall.
  void blend_tile(const StaticPass& pass, int tile, unsigned blocks) {
    const CameraRays& rays = pass.rays;
    const std::size_t base = static_cast<std::size_t>(tile) * kTileSamples;
    const int left = tile % rays.tiles_x * kTileSide, top = tile / rays.tiles_x * kTileSide;
    const int n = pass.samples;
    covered_.fill(false);
    changed_.fill(false);
    const TileHits& hits = tracer_->hits();
    if (hits.count > 0) shade_dynamics(pass, tile);
    for (std::size_t i = 0; i < static_cast<std::size_t>(hits.count); ++i) {
      const std::size_t sample = hits.sample[i];
      covered_[sample] = true;
      keep_color(i, sample);
      const int x = left + kTileOffsets[sample].x, y = top + kTileOffsets[sample].y;
      if (x >= rays.width || y >= rays.height || x % n != 0 || y % n != 0) continue;
      const std::size_t pixel = pixel_of(pass, x / n, y / n);
      depth_[pixel] = hits.t[i] * rays.cosine[base + sample];
      segmentation_[pixel] = dynamics_.instances()[hits.instance[i]].id;
    }
    if (pass.casts()) shade_statics(pass, tile, blocks);
    write_means(pass, tile);
  }

  void keep_color(std::size_t hit, std::size_t sample) {
    const ShadeOutput& colors = tracer_->colors();
    changed_[sample] = true;
    color_[sample] = {capped(colors.r[hit]), capped(colors.g[hit]), capped(colors.b[hit])};
  }

  // The static samples of the marked blocks that no moving thing covers.
  void shade_statics(const StaticPass& pass, int tile, unsigned blocks) {
    tracer_->take(pass.hits, tile, blocks, covered_);
    const TileHits& hits = tracer_->hits();
    if (hits.count == 0) return;
    if (!pass.photo) {
      // Moving things take sun from statics, not ambient light, which would need wider marks.
      tracer_->shade(pass.scene, pass.rays, tile, pass.lights,
                     {{&dynamics_, &pass.scene}, {nullptr, &pass.scene}, spec_.occlusion_rays});
      for (std::size_t i = 0; i < static_cast<std::size_t>(hits.count); ++i) {
        keep_color(i, hits.sample[i]);
      }
      return;
    }
    tracer_->catch_shadow(pass.scene, pass.rays, tile, pass.lights, dynamics_);
    for (std::size_t i = 0; i < static_cast<std::size_t>(hits.count); ++i) {
      const float left = tracer_->light_left()[i];
      if (left == 1) continue;  // the photo's bytes stay as they are
      const std::size_t sample = hits.sample[i];
      std::array<float, 3> color = background(pass, tile, sample);
      for (float& channel : color) channel *= left;
      changed_[sample] = true;
      color_[sample] = color;
    }
  }

  // Linear light of a sample that nothing changes.
  std::array<float, 3> background(const StaticPass& pass, int tile, std::size_t sample) const {
    const std::size_t index = static_cast<std::size_t>(tile) * kTileSamples + sample;
    if (!pass.linear.empty()) return pass.linear[index];
    const int x = tile % pass.rays.tiles_x * kTileSide + kTileOffsets[sample].x;
    const int y = tile / pass.rays.tiles_x * kTileSide + kTileOffsets[sample].y;
    if (x >= pass.rays.width || y >= pass.rays.height) return {0, 0, 0};
    const std::size_t pixel = pixel_of(pass, x / pass.samples, y / pass.samples);
    return {kDisplayThresholds[pass.rgb[3 * pixel]], kDisplayThresholds[pass.rgb[3 * pixel + 1]],
            kDisplayThresholds[pass.rgb[3 * pixel + 2]]};
  }

  // Pixels of which a sample changed; n x n samples of one follow each other in Morton order.
  void write_means(const StaticPass& pass, int tile) {
    const int n = pass.samples;
    const auto each = static_cast<std::size_t>(n * n);
    const float share = 1.0f / static_cast<float>(each);
    const int left = tile % pass.rays.tiles_x * kTileSide;
    const int top = tile / pass.rays.tiles_x * kTileSide;
    for (std::size_t first = 0; first < kTileSamples; first += each) {
      bool any = false;
      for (std::size_t s = first; s < first + each; ++s) any = any || changed_[s];
      const int x = left + kTileOffsets[first].x, y = top + kTileOffsets[first].y;
      if (!any || x >= pass.rays.width || y >= pass.rays.height) continue;
      std::array<float, 3> sum{0, 0, 0};
      for (std::size_t s = first; s < first + each; ++s) {
        const std::array<float, 3> color = changed_[s] ? color_[s] : background(pass, tile, s);
        for (std::size_t k = 0; k < 3; ++k) sum[k] += color[k];
      }
      const std::size_t pixel = pixel_of(pass, x / n, y / n);
      for (std::size_t k = 0; k < 3; ++k) rgb_[3 * pixel + k] = to_display_byte(share * sum[k]);
    }
  }

  SceneSpec spec_;
  std::shared_ptr<const StaticPass> static_;
  TopScene dynamics_;
  BlockMarks marks_, last_marks_;  // of this frame and of the picture in the buffers
  ShadowMarks shadow_marks_;
  std::unique_ptr<TileTracer> tracer_;
  std::array<bool, kTileSamples> covered_{}, changed_{};  // of the tile in work
  std::array<std::array<float, 3>, kTileSamples> color_{};
  std::vector<std::uint8_t> rgb_;
  std::vector<float> depth_;
  std::vector<std::uint16_t> segmentation_;
};

}  // namespace

Result<std::unique_ptr<Renderer>> Renderer::create(SceneSpec spec) {
  PROBE_ASSIGN(TopScene dynamics, TopScene::create(spec.dynamics, TopScene::Kind::kDynamic));
  PROBE_ASSIGN(std::shared_ptr<const StaticPass> pass, StaticPass::shared(spec));
  return std::unique_ptr<Renderer>(
      std::make_unique<EmbreeRenderer>(std::move(spec), std::move(pass), std::move(dynamics)));
}

}  // namespace probe::render
