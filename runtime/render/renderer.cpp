// A frame in its order: what stands still (kept, or traced anew for a camera that moves), what
// moves put in its places, the blocks that it can touch, and rays in those blocks alone.
#include "runtime/render/renderer.h"

#include <algorithm>
#include <limits>

#include "runtime/render/blend.h"
#include "runtime/render/block_marks.h"
#include "runtime/render/known_hits.h"
#include "runtime/render/scene_store.h"
#include "runtime/render/static_picture.h"
#include "runtime/render/tile_tracer.h"
#include "runtime/render/top_scene.h"
#include "runtime/render/vertex_renderer.h"

namespace probe::render {
namespace {

bool casts(const Lights& lights) {
  return std::any_of(lights.suns.begin(), lights.suns.end(),
                     [](const Sun& sun) { return sun.shadow; });
}

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
    PROBE_ASSIGN(InstanceSet moved, place(poses, still_->rays.origin));
    // Moving things shade what does not move.
    if (still_->casts() || spec_.occlusion_rays > 0) moved = kAllInstances;
    if (shown_ != still_.get()) {
      show(*still_);
      last_marks_.clear();
      moved = kAllInstances;
    }
    marks_.clear();
    mark(*still_, marks_);
    stale_ = marks_;
    for (int y = 0; y < marks_.blocks_y(); ++y) {
      for (int x = 0; x < marks_.blocks_x(); ++x) {
        // What a block shows can change only where something that moved is or was.
        if (((marks_.touching(x, y) | last_marks_.touching(x, y)) & moved) == 0) {
          stale_.unmark(x, y);
          continue;
        }
        // A block that is traced starts as its background too: misses need nothing else.
        restore_block(still_->picture, x, y, spec_.samples, frame_);
      }
    }
    KnownTriangles known;
    if (spec_.samples == 1) {
      known = known_.look(dynamics_.instances(), spec_.camera, still_->rays, stale_);
    }
    draw(*still_, stale_, known);
    std::swap(marks_, last_marks_);
    return view();
  }

  Result<FrameView> render_from(const Camera& camera, std::span<const Pose> poses) override {
    PROBE_TRY(check_size(camera));
    if (spec_.samples == 1 && !spec_.photo && !casts(spec_.lights)) return glance(camera, poses);
    return retrace(camera, poses, false);
  }

  Result<FrameView> render_full(std::span<const Pose> poses) override {
    return retrace(spec_.camera, poses, true);
  }

 private:
  FrameView view() const {
    return {frame_.width, frame_.height, frame_.rgb, frame_.depth, frame_.segmentation};
  }

  Status check_size(const Camera& camera) const {
    if (camera.width == spec_.camera.width && camera.height == spec_.camera.height) return {};
    return Failure{.code = Fault::kRender,
                   .message = "a renderer keeps its picture's size",
                   .where = "camera"};
  }

  Result<InstanceSet> place(std::span<const Pose> poses, const std::array<float, 3>& eye) {
    PROBE_TRY(dynamics_.place(poses));
    const InstanceSet seen_otherwise = origins_.set(dynamics_, eye);
    return dynamics_.moved() | seen_otherwise;
  }

  void mark(const StaticPicture& seen, BlockMarks& marks) {
    marks.mark(dynamics_.instances());
    if (seen.casts()) shadow_marks_.mark(seen.receivers, dynamics_.instances(), marks);
  }

  // The whole frame is what stands still.
  void show(const StaticPicture& seen) {
    frame_ = seen.picture;
    shown_ = &seen;
  }

  // The static picture through any camera, then what moves: in its blocks, or in all of them.
  Result<FrameView> retrace(const Camera& camera, std::span<const Pose> poses, bool everywhere) {
    PROBE_TRY(moving_.trace(spec_, camera, scene_));
    const FlushDenormals guard;
    PROBE_TRY(place(poses, moving_.rays.origin));
    show(moving_);
    BlockMarks marks(sample_camera(camera, spec_.samples), moving_.rays);
    if (everywhere) {
      marks.mark_all();
    } else {
      mark(moving_, marks);
    }
    draw(moving_, marks, {});
    return view();
  }

  // The same through a camera that moves, where a pixel is one sample and nothing casts: tile by
  // tile, without shading what is hidden and without keeping what the next frame cannot use.
  Result<FrameView> glance(const Camera& camera, std::span<const Pose> poses) {
    PROBE_TRY(tile_rays_.look(camera, moving_.rays));
    PROBE_ASSIGN(moving_.lights, make_lights(spec_.lights));
    const CameraRays& rays = moving_.rays;
    const FlushDenormals guard;
    PROBE_TRY(place(poses, rays.origin));
    moving_.origins.set(scene_->top, rays.origin);
    frame_.clear(camera.width, camera.height);
    shown_ = nullptr;
    BlockMarks marks(camera, rays);
    marks.mark(dynamics_.instances());
    const KnownTriangles known = known_.look(dynamics_.instances(), camera, rays, marks);
    fills_.look(scene_->top, camera);
    for (int tile = 0; tile < rays.tiles(); ++tile) {
      glance_at(tile, marks.tile_blocks(tile % rays.tiles_x, tile / rays.tiles_x), known);
    }
    return view();
  }

  void glance_at(int tile, const BlockSets& blocks, const KnownTriangles& known) {
    tile_rays_.make(tile, moving_.rays);
    const CameraRays& rays = moving_.rays;
    std::array<float, kTileSamples> farthest;
    farthest.fill(kFarthest);
    const int tile_x = tile % rays.tiles_x, tile_y = tile / rays.tiles_x;
    const FilledBlocks filled = fills_.of_tile(tile_x, tile_y);
    const PacketSet hidden = hidden_by(known, blocks, tile_x, tile_y);
    still_tracer_->trace(scene_->top, moving_.origins, rays, tile, kAllBlocks, farthest.data(),
                         filled, fills_.draw_rest(tile_x, tile_y, filled, hidden), hidden);
    const TileHits& still = still_tracer_->hits();
    if (!is_empty(blocks)) {
      for (std::size_t i = 0; i < static_cast<std::size_t>(still.count); ++i) {
        farthest[still.sample[i]] = still.t[i];
      }
      tracer_->trace(dynamics_, origins_, rays, tile, blocks, farthest.data(), {}, known);
      const TileHits& hits = tracer_->hits();
      if (hits.count > 0) {
        std::array<bool, kTileSamples> covered{};
        for (std::size_t i = 0; i < static_cast<std::size_t>(hits.count); ++i) {
          covered[hits.sample[i]] = true;
        }
        still_tracer_->drop(covered);
        draw_tile(moving_, tile);
      }
    }
    if (still.count == 0) return;
    const Casters statics{nullptr, &scene_->top};
    still_tracer_->shade(scene_->top, rays, tile, moving_.lights,
                         {statics, statics, spec_.occlusion_rays});
    show_hits(still, scene_->top, rays, tile, &still_tracer_->colors(), frame_);
  }

  // Packets of a tile that show nothing but what moves, whatever stands still there.
  PacketSet hidden_by(const KnownTriangles& known, const BlockSets& blocks, int tile_x,
                      int tile_y) const {
    if (known.sheet == nullptr || is_empty(blocks)) return 0;
    const float closest = fills_.closest(tile_x, tile_y);
    if (closest == std::numeric_limits<float>::infinity()) return 0;
    PacketSet hidden = 0;
    for (int block = 0; block < 4; ++block) {
      const InstanceSet set = blocks[static_cast<std::size_t>(block)];
      if (set == 0 || !known.has(set)) continue;
      hidden |= known.sheet->covers(2 * tile_x + block % 2, 2 * tile_y + block / 2, closest)
                << (8 * block);
    }
    return hidden;
  }

  // Traces the marked blocks and writes what moving things show there.
  void draw(const StaticPicture& seen, const BlockMarks& marks, const KnownTriangles& known) {
    if (dynamics_.empty()) return;  // whatever is marked
    const bool plain = seen.samples == 1 && !seen.casts();
    for (int ty = 0; ty < seen.rays.tiles_y; ++ty) {
      for (int tx = 0; tx < seen.rays.tiles_x; ++tx) {
        const BlockSets blocks = marks.tile_blocks(tx, ty);
        if (is_empty(blocks)) continue;
        const int tile = ty * seen.rays.tiles_x + tx;
        tracer_->trace(dynamics_, origins_, seen.rays, tile, blocks,
                       seen.farthest.data() + static_cast<std::size_t>(tile) * kTileSamples, {},
                       known);
        if (plain) {
          draw_tile(seen, tile);
        } else {
          blender_->draw(seen, dynamics_, spec_.occlusion_rays, tile, blocks, *tracer_, frame_);
        }
      }
    }
  }

  // One sample a pixel, nothing falls on statics: hits are pixels.
  void draw_tile(const StaticPicture& seen, int tile) {
    if (tracer_->hits().count == 0) return;
    const Casters all{&dynamics_, &scene_->top};
    tracer_->shade(dynamics_, seen.rays, tile, seen.lights, {all, all, spec_.occlusion_rays});
    show_hits(tracer_->hits(), dynamics_, seen.rays, tile, &tracer_->colors(), frame_);
  }

  SceneSpec spec_;
  std::shared_ptr<SceneStore> store_;
  std::shared_ptr<const StaticScene> scene_;
  std::shared_ptr<const StaticPicture> still_;  // of the spec's camera; from the first render() on
  StaticPicture moving_;                        // of the last camera that moved
  TileRays tile_rays_;
  TopScene dynamics_;
  RayOrigins origins_;  // of the dynamics, from the last camera
  BlockMarks marks_,
      last_marks_;    // of this frame and of the one in `frame_`, where still_ is shown
  BlockMarks stale_;  // what of this frame has to be traced
  ShadowMarks shadow_marks_;
  BlockFills fills_;
  KnownHits known_;
  std::unique_ptr<TileTracer> tracer_ = std::make_unique<TileTracer>();
  std::unique_ptr<TileTracer> still_tracer_ = std::make_unique<TileTracer>();
  std::unique_ptr<TileBlender> blender_ = std::make_unique<TileBlender>();
  Picture frame_;
  const StaticPicture* shown_ = nullptr;  // what `frame_` was last copied from
};

}  // namespace

Result<std::unique_ptr<Renderer>> Renderer::create(SceneSpec spec,
                                                   std::shared_ptr<SceneStore> store) {
  if (!store) store = std::make_shared<SceneStore>();
  if (spec.lights.shading == Shading::kVertex)
    return create_vertex_renderer(std::move(spec), *store);
  PROBE_TRY(StaticPicture::check(spec));
  PROBE_ASSIGN(auto meshes, store->geometries(spec.dynamics));
  PROBE_ASSIGN(TopScene dynamics,
               TopScene::create(spec.dynamics, std::move(meshes), TopScene::Kind::kDynamic));
  PROBE_ASSIGN(auto scene, store->static_scene(spec.statics));
  return std::unique_ptr<Renderer>(std::make_unique<EmbreeRenderer>(
      std::move(spec), std::move(store), std::move(scene), std::move(dynamics)));
}

}  // namespace probe::render
