#include "runtime/render/renderer.h"

#include <algorithm>
#include <cstring>

#include "runtime/render/block_marks.h"
#include "runtime/render/encode.h"
#include "runtime/render/scene_store.h"
#include "runtime/render/static_picture.h"
#include "runtime/render/tile_tracer.h"
#include "runtime/render/top_scene.h"

namespace probe::render {
namespace {

class EmbreeRenderer final : public Renderer {
 public:
  EmbreeRenderer(SceneSpec spec, std::shared_ptr<SceneStore> store,
                 std::shared_ptr<const StaticScene> scene, TopScene dynamics)
      : spec_(std::move(spec)),
        store_(std::move(store)),
        scene_(std::move(scene)),
        dynamics_(std::move(dynamics)) {}

  Result<FrameView> render(std::span<const Pose> poses) override {
    if (!still_) {
      PROBE_ASSIGN(still_, store_->static_picture(spec_));
      marks_ = BlockMarks(sample_camera(spec_.camera, spec_.samples), still_->rays);
      last_marks_ = marks_;
    }
    const FlushDenormals guard;
    PROBE_TRY(place(poses, *still_));
    if (shown_ != still_.get()) show(*still_);
    marks_.clear();
    mark(*still_, marks_);
    for (int y = 0; y < marks_.blocks_y(); ++y) {
      for (int x = 0; x < marks_.blocks_x(); ++x) {
        // A marked block starts as its background too: misses need nothing else.
        if (marks_.marked(x, y) || last_marks_.marked(x, y)) restore_block(still_->picture, x, y);
      }
    }
    draw(*still_, marks_);
    std::swap(marks_, last_marks_);
    return view();
  }

  Result<FrameView> render_from(const Camera& camera, std::span<const Pose> poses) override {
    PROBE_TRY(retrace(camera));
    const FlushDenormals guard;
    PROBE_TRY(place(poses, moving_));
    show(moving_);
    BlockMarks marks(sample_camera(camera, spec_.samples), moving_.rays);
    mark(moving_, marks);
    draw(moving_, marks);
    return view();
  }

  Result<FrameView> render_full(std::span<const Pose> poses) override {
    PROBE_TRY(retrace(spec_.camera));
    const FlushDenormals guard;
    PROBE_TRY(place(poses, moving_));
    show(moving_);
    BlockMarks marks(sample_camera(spec_.camera, spec_.samples), moving_.rays);
    marks.mark_all();
    draw(moving_, marks);
    return view();
  }

 private:
  FrameView view() const {
    return {frame_.width, frame_.height, frame_.rgb, frame_.depth, frame_.segmentation};
  }

  Status retrace(const Camera& camera) {
    if (camera.width != spec_.camera.width || camera.height != spec_.camera.height) {
      return Failure{
          .code = Fault::kRender, .message = "a renderer keeps its picture's size", .where = "camera"};
    }
    return moving_.trace(spec_, camera, scene_);
  }

  Status place(std::span<const Pose> poses, const StaticPicture& seen) {
    PROBE_TRY(dynamics_.place(poses));
    origins_.set(dynamics_, seen.rays.origin);
    return {};
  }

  void mark(const StaticPicture& seen, BlockMarks& marks) {
    marks.mark(dynamics_.instances());
    if (seen.casts()) shadow_marks_.mark(seen.receivers, dynamics_.instances(), marks);
  }

  // The whole frame is what stands still.
  void show(const StaticPicture& seen) {
    frame_ = seen.picture;
    shown_ = &seen;
    last_marks_.clear();
  }

  void restore_block(const Picture& still, int block_x, int block_y) {
    const int side = kBlockSide / spec_.samples;
    const int width = still.width, height = still.height;
    const int left = block_x * side, top = block_y * side;
    const int columns = std::min(side, width - left);
    if (columns <= 0) return;
    const auto n = static_cast<std::size_t>(columns);
    for (int y = top; y < std::min(top + side, height); ++y) {
      const std::size_t at = static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                             static_cast<std::size_t>(left);
      std::memcpy(frame_.rgb.data() + 3 * at, still.rgb.data() + 3 * at, 3 * n);
      std::memcpy(frame_.depth.data() + at, still.depth.data() + at, sizeof(float) * n);
      std::memcpy(frame_.segmentation.data() + at, still.segmentation.data() + at,
                  sizeof(std::uint16_t) * n);
    }
  }

  // Traces the marked blocks and writes what moving things show there.
  void draw(const StaticPicture& seen, const BlockMarks& marks) {
    if (dynamics_.empty()) return;
    const bool plain = seen.samples == 1 && !seen.casts();
    for (int ty = 0; ty < seen.rays.tiles_y; ++ty) {
      for (int tx = 0; tx < seen.rays.tiles_x; ++tx) {
        const unsigned blocks = marks.tile_blocks(tx, ty);
        if (blocks == 0) continue;
        const int tile = ty * seen.rays.tiles_x + tx;
        tracer_->trace(dynamics_, origins_, seen.rays, tile, blocks,
                       seen.farthest.data() + static_cast<std::size_t>(tile) * kTileSamples);
        if (plain) {
          draw_tile(seen, tile);
        } else {
          blend_tile(seen, tile, blocks);
        }
      }
    }
  }

  std::size_t pixel_of(const StaticPicture& seen, int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(seen.picture.width) +
           static_cast<std::size_t>(x);
  }

  void shade_dynamics(const StaticPicture& seen, int tile) {
    const Casters all{&dynamics_, &seen.scene->top};
    tracer_->shade(dynamics_, seen.rays, tile, seen.lights, {all, all, spec_.occlusion_rays});
  }

  // One sample a pixel, nothing falls on statics: hits are pixels.
  void draw_tile(const StaticPicture& seen, int tile) {
    const CameraRays& rays = seen.rays;
    const std::size_t base = static_cast<std::size_t>(tile) * kTileSamples;
    const TileHits& hits = tracer_->hits();
    if (hits.count == 0) return;
    shade_dynamics(seen, tile);
    const ShadeOutput& colors = tracer_->colors();
    const int left = tile % rays.tiles_x * kTileSide, top = tile / rays.tiles_x * kTileSide;
    for (std::size_t i = 0; i < static_cast<std::size_t>(hits.count); ++i) {
      const std::size_t sample = hits.sample[i];
      const int x = left + kTileOffsets[sample].x, y = top + kTileOffsets[sample].y;
      if (x >= rays.width || y >= rays.height) continue;
      const std::size_t pixel = pixel_of(seen, x, y);
      frame_.depth[pixel] = hits.t[i] * rays.cosine[base + sample];
      frame_.segmentation[pixel] = dynamics_.instances()[hits.instance[i]].id;
      frame_.rgb[3 * pixel] = to_display_byte(colors.r[i]);
      frame_.rgb[3 * pixel + 1] = to_display_byte(colors.g[i]);
      frame_.rgb[3 * pixel + 2] = to_display_byte(colors.b[i]);
    }
  }

  // A tile whose samples are averaged, or on whose statics shadows fall.
  void blend_tile(const StaticPicture& seen, int tile, unsigned blocks) {
    const CameraRays& rays = seen.rays;
    const std::size_t base = static_cast<std::size_t>(tile) * kTileSamples;
    const int left = tile % rays.tiles_x * kTileSide, top = tile / rays.tiles_x * kTileSide;
    const int n = seen.samples;
    covered_.fill(false);
    changed_.fill(false);
    const TileHits& hits = tracer_->hits();
    if (hits.count > 0) shade_dynamics(seen, tile);
    for (std::size_t i = 0; i < static_cast<std::size_t>(hits.count); ++i) {
      const std::size_t sample = hits.sample[i];
      covered_[sample] = true;
      keep_color(i, sample);
      const int x = left + kTileOffsets[sample].x, y = top + kTileOffsets[sample].y;
      if (x >= rays.width || y >= rays.height || x % n != 0 || y % n != 0) continue;
      const std::size_t pixel = pixel_of(seen, x / n, y / n);
      frame_.depth[pixel] = hits.t[i] * rays.cosine[base + sample];
      frame_.segmentation[pixel] = dynamics_.instances()[hits.instance[i]].id;
    }
    if (seen.casts()) shade_statics(seen, tile, blocks);
    write_means(seen, tile);
  }

  void keep_color(std::size_t hit, std::size_t sample) {
    const ShadeOutput& colors = tracer_->colors();
    changed_[sample] = true;
    color_[sample] = {capped(colors.r[hit]), capped(colors.g[hit]), capped(colors.b[hit])};
  }

  // The static samples of the marked blocks that no moving thing covers.
  void shade_statics(const StaticPicture& seen, int tile, unsigned blocks) {
    tracer_->take(seen.hits, tile, blocks, covered_);
    const TileHits& hits = tracer_->hits();
    if (hits.count == 0) return;
    if (!seen.photo) {
      // Moving things take sun from statics, not ambient light, which would need wider marks.
      tracer_->shade(
          seen.scene->top, seen.rays, tile, seen.lights,
          {{&dynamics_, &seen.scene->top}, {nullptr, &seen.scene->top}, spec_.occlusion_rays});
      for (std::size_t i = 0; i < static_cast<std::size_t>(hits.count); ++i) {
        keep_color(i, hits.sample[i]);
      }
      return;
    }
    tracer_->catch_shadow(seen.scene->top, seen.rays, tile, seen.lights, dynamics_);
    for (std::size_t i = 0; i < static_cast<std::size_t>(hits.count); ++i) {
      const float left = tracer_->light_left()[i];
      if (left == 1) continue;  // the photo's bytes stay as they are
      const std::size_t sample = hits.sample[i];
      std::array<float, 3> color = background(seen, tile, sample);
      for (float& channel : color) channel *= left;
      changed_[sample] = true;
      color_[sample] = color;
    }
  }

  // Linear light of a sample that nothing changes.
  std::array<float, 3> background(const StaticPicture& seen, int tile, std::size_t sample) const {
    const std::size_t index = static_cast<std::size_t>(tile) * kTileSamples + sample;
    if (!seen.linear.empty()) return seen.linear[index];
    const int x = tile % seen.rays.tiles_x * kTileSide + kTileOffsets[sample].x;
    const int y = tile / seen.rays.tiles_x * kTileSide + kTileOffsets[sample].y;
    if (x >= seen.rays.width || y >= seen.rays.height) return {0, 0, 0};
    const std::size_t pixel = pixel_of(seen, x / seen.samples, y / seen.samples);
    return {kDisplayThresholds[seen.picture.rgb[3 * pixel]],
            kDisplayThresholds[seen.picture.rgb[3 * pixel + 1]],
            kDisplayThresholds[seen.picture.rgb[3 * pixel + 2]]};
  }

  // Pixels of which a sample changed; n x n samples of one follow each other in Morton order.
  void write_means(const StaticPicture& seen, int tile) {
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
      const std::size_t pixel = pixel_of(seen, x / n, y / n);
      for (std::size_t k = 0; k < 3; ++k)
        frame_.rgb[3 * pixel + k] = to_display_byte(share * sum[k]);
    }
  }

  SceneSpec spec_;
  std::shared_ptr<SceneStore> store_;
  std::shared_ptr<const StaticScene> scene_;
  std::shared_ptr<const StaticPicture> still_;  // of the spec's camera; from the first render() on
  StaticPicture moving_;                        // of the last camera that moved
  TopScene dynamics_;
  RayOrigins origins_;  // of the dynamics, from the last camera
  BlockMarks marks_,
      last_marks_;  // of this frame and of the one in `frame_`, where still_ is shown
  ShadowMarks shadow_marks_;
  std::unique_ptr<TileTracer> tracer_ = std::make_unique<TileTracer>();
  std::array<bool, kTileSamples> covered_{}, changed_{};  // of the tile in work
  std::array<std::array<float, 3>, kTileSamples> color_{};
  Picture frame_;
  const StaticPicture* shown_ = nullptr;  // what `frame_` was last copied from
};

}  // namespace

Result<std::unique_ptr<Renderer>> Renderer::create(SceneSpec spec,
                                                   std::shared_ptr<SceneStore> store) {
  if (!store) store = std::make_shared<SceneStore>();
  PROBE_TRY(StaticPicture::check(spec));
  PROBE_ASSIGN(auto meshes, store->geometries(spec.dynamics));
  PROBE_ASSIGN(TopScene dynamics,
               TopScene::create(spec.dynamics, std::move(meshes), TopScene::Kind::kDynamic));
  PROBE_ASSIGN(auto scene, store->static_scene(spec.statics));
  return std::unique_ptr<Renderer>(std::make_unique<EmbreeRenderer>(
      std::move(spec), std::move(store), std::move(scene), std::move(dynamics)));
}

}  // namespace probe::render
