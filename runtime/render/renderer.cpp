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
        marks_(spec_.camera, static_->rays),
        last_marks_(marks_),
        tracer_(std::make_unique<TileTracer>()) {
    show_statics(*static_);
  }

  Result<FrameView> render(std::span<const Pose> poses) override {
    const FlushDenormals guard;
    PROBE_TRY(dynamics_.place(poses, static_->rays.origin));
    marks_.clear();
    marks_.mark(dynamics_.instances());
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
    PROBE_ASSIGN(const std::shared_ptr<const StaticPass> fresh, StaticPass::make(spec_));
    const FlushDenormals guard;
    PROBE_TRY(dynamics_.place(poses, fresh->rays.origin));
    show_statics(*fresh);
    marks_.mark_all();
    draw(*fresh);
    std::swap(marks_, last_marks_);
    return view();
  }

 private:
  FrameView view() const {
    return {static_->rays.width, static_->rays.height, rgb_, depth_, segmentation_};
  }

  void show_statics(const StaticPass& pass) {
    rgb_ = pass.rgb;
    depth_ = pass.depth;
    segmentation_ = pass.segmentation;
  }

  void restore_block(const StaticPass& pass, int block_x, int block_y) {
    const int width = pass.rays.width, height = pass.rays.height;
    const int left = block_x * kBlockSide, top = block_y * kBlockSide;
    const int columns = std::min(kBlockSide, width - left);
    if (columns <= 0) return;
    const auto n = static_cast<std::size_t>(columns);
    for (int y = top; y < std::min(top + kBlockSide, height); ++y) {
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
    for (int ty = 0; ty < pass.rays.tiles_y; ++ty) {
      for (int tx = 0; tx < pass.rays.tiles_x; ++tx) {
        const unsigned blocks = marks_.tile_blocks(tx, ty);
        if (blocks == 0) continue;
        draw_tile(pass, tx, ty, blocks);
      }
    }
  }

  void draw_tile(const StaticPass& pass, int tx, int ty, unsigned blocks) {
    const CameraRays& rays = pass.rays;
    const int tile = ty * rays.tiles_x + tx;
    const std::size_t base = static_cast<std::size_t>(tile) * kTileSamples;
    tracer_->trace(dynamics_, rays, tile, blocks, pass.farthest.data() + base);
    const TileHits& hits = tracer_->hits();
    if (hits.count == 0) return;
    tracer_->shade(dynamics_, rays, tile, pass.lights, spec_.shadows);
    const ShadeOutput& colors = tracer_->colors();
    for (std::size_t i = 0; i < static_cast<std::size_t>(hits.count); ++i) {
      const std::size_t sample = hits.sample[i];
      const int x = tx * kTileSide + kTileOffsets[sample].x;
      const int y = ty * kTileSide + kTileOffsets[sample].y;
      if (x >= rays.width || y >= rays.height) continue;
      const std::size_t pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(rays.width) +
                                static_cast<std::size_t>(x);
      depth_[pixel] = hits.t[i] * rays.cosine[base + sample];
      segmentation_[pixel] = dynamics_.instances()[hits.instance[i]].id;
      rgb_[3 * pixel] = to_display_byte(colors.r[i]);
      rgb_[3 * pixel + 1] = to_display_byte(colors.g[i]);
      rgb_[3 * pixel + 2] = to_display_byte(colors.b[i]);
    }
  }

  SceneSpec spec_;
  std::shared_ptr<const StaticPass> static_;
  TopScene dynamics_;
  BlockMarks marks_, last_marks_;  // of this frame and of the picture in the buffers
  std::unique_ptr<TileTracer> tracer_;
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
