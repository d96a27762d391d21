// A frame in its order: what stands still (kept for a camera that does), what moves drawn over it,
// and the pixels that this changed.
#include "runtime/render/vertex_renderer.h"

#include <algorithm>
#include <optional>
#include <vector>

#include "runtime/render/camera_rays.h"
#include "runtime/render/picture.h"
#include "runtime/render/placing_check.h"
#include "runtime/render/scene_store.h"
#include "runtime/render/vertex_layer.h"

namespace probe::render {
namespace {

using SeenMirror = std::optional<PlacedMeshes::Mirror>;

class VertexRenderer final : public Renderer {
 public:
  VertexRenderer(SceneSpec spec, LampTable lamps, const PlacedMeshes& meshes)
      : spec_(std::move(spec)), lamps_(std::move(lamps)), seen_(meshes), mirrored_(meshes) {
    seen_.buffer().resize(spec_.camera.width, spec_.camera.height, spec_.samples > 1);
  }

  Result<FrameView> render(std::span<const Pose> poses) override {
    PROBE_TRY(check(poses));
    const FlushDenormals guard;
    if (!is_still_) begin_still();
    restore();
    rest(poses);
    for (std::size_t i = 0; i < poses.size(); ++i) {
      if (rests_[i].is_in) continue;
      place(seen_, i, poses[i]);
      draw(seen_, spec_.statics.size() + i, &touched_);
    }
    const auto mirror = reflect(spec_.camera, poses);
    list_changed(touched_, mirror);
    show(mirror, frame_);
    return view();
  }

  Result<FrameView> render_from(const Camera& camera, std::span<const Pose> poses) override {
    if (camera.width != spec_.camera.width || camera.height != spec_.camera.height) {
      return Failure{.code = Fault::kRender,
                     .message = "a renderer keeps its picture's size",
                     .where = "camera"};
    }
    PROBE_TRY(check_camera(camera));
    return draw_all(camera, poses);
  }

  Result<FrameView> render_full(std::span<const Pose> poses) override {
    return draw_all(spec_.camera, poses);
  }

 private:
  Result<FrameView> draw_all(const Camera& camera, std::span<const Pose> poses) {
    PROBE_TRY(check(poses));
    const FlushDenormals guard;
    is_still_ = false;
    begin(camera);
    for (std::size_t i = 0; i < poses.size(); ++i) place(seen_, i, poses[i]);
    seen_.meshes().draw_all(seen_.buffer());
    const auto mirror = reflect(camera, poses);
    list_all();
    show(mirror, frame_);
    return view();
  }

  FrameView view() const {
    return {frame_.width, frame_.height, frame_.rgb, frame_.depth, frame_.segmentation};
  }

  Status check(std::span<const Pose> poses) const {
    return check_poses(poses, spec_.dynamics.size(), [this](std::size_t i) {
      return std::string(seen_.meshes().name(spec_.statics.size() + i));
    });
  }

  // `index`: of the dynamics.
  void place(VertexLayer& layer, std::size_t index, const Pose& pose) {
    layer.meshes().place(spec_.statics.size() + index, pose, lamps_);
  }

  void draw(VertexLayer& layer, std::size_t instance, RowSpans* spans) {
    layer.meshes().draw(instance, layer.buffer(), spans);
  }

  // Everything of it is what stands still.
  void begin(const Camera& camera) {
    seen_.meshes().look_from(camera);
    seen_.buffer().clear();
    for (std::size_t i = 0; i < spec_.statics.size(); ++i) seen_.meshes().place(i, Pose{}, lamps_);
  }

  void begin_still() {
    begin(spec_.camera);
    for (std::size_t i = 0; i < spec_.statics.size(); ++i) draw(seen_, i, nullptr);
    statics_ = seen_.buffer();
    still_ = statics_;
    rests_.assign(spec_.dynamics.size(), {});
    list_all();
    show({}, frame_);
    still_frame_ = frame_;
    is_still_ = true;
    touched_.clear(frame_.height);
  }

  // What has not moved for a while becomes part of what stands still, until it moves: numbers of
  // triangles say who is shown where two are equally near, so that nobody can tell.
  void rest(std::span<const Pose> poses) {
    constexpr int kFrames = 3;
    bool leaves = false, joins = false;
    for (std::size_t i = 0; i < poses.size(); ++i) {
      Rest& rest = rests_[i];
      const bool is_same = rest.frames > 0 && rest.pose.position == poses[i].position &&
                           rest.pose.rotation.coeffs() == poses[i].rotation.coeffs();
      rest.frames = is_same ? std::min(rest.frames + 1, kFrames) : 1;
      rest.pose = poses[i];
      leaves = leaves || (rest.is_in && !is_same);
      joins = joins || (!rest.is_in && rest.frames == kFrames);
    }
    if (!leaves && !joins) return;
    seen_.buffer() = leaves ? statics_ : still_;
    for (std::size_t i = 0; i < poses.size(); ++i) {
      Rest& rest = rests_[i];
      const bool was_in = rest.is_in;
      rest.is_in = rest.frames == kFrames;
      if (!rest.is_in || (was_in && !leaves)) continue;
      if (!was_in) place(seen_, i, poses[i]);
      draw(seen_, spec_.statics.size() + i, nullptr);
    }
    touched_.add(0, frame_.height - 1, 0, frame_.width - 1);
    list_changed(touched_, {});
    show({}, still_frame_);
    still_ = seen_.buffer();
    frame_ = still_frame_;
  }

  // The mirror that the camera sees, if it does; what it shows is in mirrored_, then, and the
  // pixels it is seen in are touched_.
  SeenMirror reflect(const Camera& camera, std::span<const Pose> poses) {
    auto mirror = seen_.meshes().mirror();
    if (!mirror || !mirror->narrow(seen_.buffer())) return {};
    SampleBuffer& buffer = mirrored_.buffer();
    if (buffer.width() == 0)
      buffer.resize(spec_.camera.width, spec_.camera.height, spec_.samples > 1);
    mirrored_.meshes().look_into(camera, *mirror);
    buffer.clear(mirror->left, mirror->right, mirror->top, mirror->bottom);
    const std::size_t statics = spec_.statics.size();
    for (std::size_t i = 0; i < statics + poses.size(); ++i) {
      if (i == mirror->instance) continue;
      mirrored_.meshes().place(i, i < statics ? Pose{} : poses[i - statics], lamps_);
    }
    mirrored_.meshes().draw_all(buffer);
    touched_.add(mirror->top, mirror->bottom, mirror->left, mirror->right);
    return mirror;
  }

  // The last frame's moving things go.
  void restore() {
    for (int y = 0; y < frame_.height; ++y) {
      const RowSpans::Span row = touched_.rows()[static_cast<std::size_t>(y)];
      if (row.left == row.right) continue;
      seen_.buffer().restore(still_, y, row.left, row.right);
      const std::size_t from = frame_.at(row.left, y), to = frame_.at(row.right - 1, y) + 1;
      const auto copy = [&](const auto& still, auto& shown, std::size_t channels) {
        std::copy(still.begin() + static_cast<std::ptrdiff_t>(channels * from),
                  still.begin() + static_cast<std::ptrdiff_t>(channels * to),
                  shown.begin() + static_cast<std::ptrdiff_t>(channels * from));
      };
      copy(still_frame_.rgb, frame_.rgb, 3);
      copy(still_frame_.depth, frame_.depth, 1);
      copy(still_frame_.segmentation, frame_.segmentation, 1);
    }
    touched_.clear(frame_.height);
  }

  static PixelAt pixel_at(int x, int y) {
    return {static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y)};
  }

  // Pixels by tiles, as neighbours show the same triangles; of each row [left, right) of `span_of`.
  void list(const auto& span_of, const auto& is_shown) {
    constexpr int kTile = 16;
    pixels_.clear();
    for (int top = 0; top < frame_.height; top += kTile) {
      for (int first = 0; first < frame_.width; first += kTile) {
        for (int y = top; y < std::min(top + kTile, frame_.height); ++y) {
          const RowSpans::Span row = span_of(y);
          const int right = std::min(row.right, first + kTile);
          for (int x = std::max(row.left, first); x < right; ++x) {
            if (is_shown(x, y)) pixels_.push_back(pixel_at(x, y));
          }
        }
      }
    }
  }

  void list_all() {
    frame_.resize(spec_.camera.width, spec_.camera.height);
    list([this](int) { return RowSpans::Span{0, frame_.width}; }, [](int, int) { return true; });
  }

  // Pixels that show other triangles than what stands still, and those that show a mirror.
  void list_changed(const RowSpans& rows, const SeenMirror& mirror) {
    list([&](int y) { return rows.rows()[static_cast<std::size_t>(y)]; },
         [&](int x, int y) {
           const std::uint32_t* ids = seen_.buffer().ids(x, y);
           return !std::equal(ids, ids + 4, still_.ids(x, y)) || (mirror && mirror->is_in(ids));
         });
  }

  void show(const SeenMirror& mirror, Picture& picture) {
    seen_.show(pixels_, mirror, mirrored_, picture);
  }

  SceneSpec spec_;
  LampTable lamps_;
  VertexLayer seen_, mirrored_;
  SampleBuffer statics_, still_;
  Picture frame_, still_frame_;
  // How long a dynamic visual has been where it is, and whether it is drawn into still_.
  struct Rest {
    Pose pose;
    int frames = 0;
    bool is_in = false;
  };
  std::vector<Rest> rests_;
  bool is_still_ = false;  // still_* and rests_ are of the spec's camera, and frame_ and seen_
                           // differ from them in touched_ only
  RowSpans touched_;
  std::vector<PixelAt> pixels_;  // that are to be shown
};

}  // namespace

Result<std::unique_ptr<Renderer>> create_vertex_renderer(SceneSpec spec, SceneStore& store) {
  const auto refuse = [](const char* message) {
    return Failure{.code = Fault::kRender, .message = message, .where = "light"};
  };
  if (spec.photo)
    return refuse("`shading vertex` draws the scene's meshes: no photo is behind them");
  if (spec.occlusion_rays != 0) return refuse("`shading vertex` has no ambient occlusion");
  if (spec.samples != 1 && spec.samples != 2)
    return refuse("under `shading vertex` a pixel has 1 or 4 samples");
  PROBE_TRY(check_camera(spec.camera));
  PROBE_ASSIGN(LampTable lamps, LampTable::make(spec.lights));
  PlacedMeshes meshes;
  for (const auto* visuals : {&spec.statics, &spec.dynamics}) {
    PROBE_ASSIGN(const auto made, store.vertex_meshes(*visuals));
    PROBE_TRY(meshes.add(*visuals, made));
  }
  return std::unique_ptr<Renderer>(
      std::make_unique<VertexRenderer>(std::move(spec), std::move(lamps), meshes));
}

}  // namespace probe::render
