// A frame in its order: what stands still (kept for a camera that does), what moves drawn over it,
// and the pixels that either changed.
#include "runtime/render/vertex_renderer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "runtime/render/camera_rays.h"
#include "runtime/render/picture.h"
#include "runtime/render/placed_mesh.h"
#include "runtime/render/placing_check.h"
#include "runtime/render/scene_store.h"

namespace probe::render {
namespace {

// Triangles drawn into samples, and the colours that pixels show of them.
class Layer {
 public:
  explicit Layer(PlacedMeshes meshes) : meshes_(std::move(meshes)) {}

  PlacedMeshes& meshes() { return meshes_; }
  const PlacedMeshes& meshes() const { return meshes_; }
  SampleBuffer& buffer() { return buffer_; }
  const SampleBuffer& buffer() const { return buffer_; }
  std::size_t drawn() const { return drawn_.size(); }
  void keep(std::size_t drawn) { drawn_.resize(drawn); }
  void draw(std::size_t instance, RowSpans* spans) {
    meshes_.draw(instance, buffer_, drawn_, spans);
  }
  // Colours have to be found anew: things were placed.
  void forget() { faces_.fill({}); }
  // What the mirror shows, if there is one.
  void reflect(Layer* mirrored) { mirrored_ = mirrored; }

  // The mean of a pixel's samples; returns the triangle in its middle, 0 for none: of those that
  // are there the nearest that holds it, else the one of most samples.
  std::uint32_t color(int x, int y, std::uint8_t* rgb) {
    const std::uint32_t* ids = buffer_.ids(x, y);
    std::array<int, 3> sum{};
    if (ids[0] == ids[1] && ids[0] == ids[2] && ids[0] == ids[3]) {
      if (ids[0] != 0) sum = color_of(face(ids[0]), x, y);
      for (std::size_t k = 0; k < 3; ++k) rgb[k] = static_cast<std::uint8_t>(sum[k]);
      return ids[0];
    }
    const float across = meshes_.across(x), down = meshes_.down(y);
    std::uint32_t inside = 0, most = ids[0];
    int most_count = 0;
    float nearest = 0;
    for (int i = 0; i < 4; ++i) {
      if (std::find(ids, ids + i, ids[i]) != ids + i) continue;
      const auto count = static_cast<int>(std::count(ids + i, ids + 4, ids[i]));
      if (count > most_count) {
        most = ids[i];
        most_count = count;
      }
      if (ids[i] == 0) continue;
      const SeenFace& seen = face(ids[i]);
      const std::array<int, 3> color = color_of(seen, x, y);
      for (std::size_t k = 0; k < 3; ++k) sum[k] += count * color[k];
      if (!is_inside(seen, across, down)) continue;
      const float nearness =
          (seen.by_across[3] * across + seen.by_down[3] * down + seen.at_middle[3]) / seen.volume;
      if (nearness > nearest) {
        nearest = nearness;
        inside = ids[i];
      }
    }
    for (std::size_t k = 0; k < 3; ++k) rgb[k] = static_cast<std::uint8_t>((sum[k] + 2) / 4);
    return inside != 0 ? inside : most;
  }

  // Of the triangles shown last: neighbours and rows ask for the same ones.
  const SeenFace& face(std::uint32_t id) {
    SeenFace& known = faces_[id % faces_.size()];
    if (known.id != id) known = meshes_.face(id, drawn_[id - 1]);
    return known;
  }

 private:
  static float plane(const std::array<float, 3>& of, float across, float down) {
    return of[0] * across + of[1] * down + of[2];
  }

  // What a triangle shows in the middle of a pixel, 0 .. 255, whether that lies in it or beside.
  std::array<int, 3> color_of(const SeenFace& face, int x, int y) {
    const float across = meshes_.across(x), down = meshes_.down(y);
    const Rgb sums = face.by_across * across + face.by_down * down + face.at_middle;
    const float denominator = sums[3];
    const bool is_before = denominator * face.volume > 0;
    Rgb color = is_before ? sums / denominator : face.mean;
    for (int k = 0; k < 3; ++k) color[k] = color[k] > 0 ? (color[k] < 1 ? color[k] : 1) : 0;
    if (face.texture == nullptr) {
      color *= 255.0f;
    } else {
      const float scale = is_before ? 1 / denominator : 0;
      const float u = plane(face.u, across, down) * scale, v = plane(face.v, across, down) * scale;
      // How far a step of a pixel goes in the texture, the longest way.
      const auto wide = static_cast<float>(face.texture->width()) * std::abs(scale);
      const auto tall = static_cast<float>(face.texture->height()) * std::abs(scale);
      const float right = 1 / meshes_.fx(), below = 1 / meshes_.fy();
      const float texels =
          std::max(std::max(std::abs(face.u[0] - u * face.by_across[3]) * right * wide,
                            std::abs(face.u[1] - u * face.by_down[3]) * below * wide),
                   std::max(std::abs(face.v[0] - v * face.by_across[3]) * right * tall,
                            std::abs(face.v[1] - v * face.by_down[3]) * below * tall));
      color *= face.texture->at(u, v, texels);
    }
    if (face.mirror > 0 && mirrored_ != nullptr) {
      std::array<std::uint8_t, 3> seen{};
      mirrored_->color(x, y, seen.data());
      color += Rgb{static_cast<float>(seen[0]), static_cast<float>(seen[1]),
                   static_cast<float>(seen[2]), 0};
    }
    std::array<int, 3> bytes{};
    for (int k = 0; k < 3; ++k)
      bytes[static_cast<std::size_t>(k)] = static_cast<int>(std::min(color[k], 255.0f) + 0.5f);
    return bytes;
  }

  static bool is_inside(const SeenFace& face, float across, float down) {
    return std::ranges::all_of(face.edge, [&](const std::array<float, 3>& edge) {
      return plane(edge, across, down) * face.volume >= 0;
    });
  }

  PlacedMeshes meshes_;
  SampleBuffer buffer_;
  std::vector<DrawnTriangle> drawn_;
  std::array<SeenFace, 256> faces_;
  Layer* mirrored_ = nullptr;
};

class VertexRenderer final : public Renderer {
 public:
  VertexRenderer(SceneSpec spec, LampTable lamps, const PlacedMeshes& meshes)
      : spec_(std::move(spec)), lamps_(std::move(lamps)), seen_(meshes), mirrored_(meshes) {
    for (Layer* layer : {&seen_, &mirrored_})
      layer->buffer().resize(spec_.camera.width, spec_.camera.height, spec_.samples > 1);
  }

  Result<FrameView> render(std::span<const Pose> poses) override {
    PROBE_TRY(check(poses));
    const FlushDenormals guard;
    if (!is_still_) {
      begin(spec_.camera);
      still_buffer_ = seen_.buffer();
      still_drawn_ = seen_.drawn();
      seen_.reflect(nullptr);
      show_all();
      still_frame_ = frame_;
      is_still_ = true;
      touched_.clear(frame_.height);
    }
    restore();
    draw_dynamics(poses, &touched_);
    const auto mirror = reflect(spec_.camera, poses);
    if (mirror) touched_.add(mirror->top, mirror->bottom, mirror->left, mirror->right);
    for (int y = 0; y < frame_.height; ++y) {
      const RowSpans::Span row = touched_.rows()[static_cast<std::size_t>(y)];
      for (int x = row.left; x < row.right; ++x) {
        const std::uint32_t* ids = seen_.buffer().ids(x, y);
        if (mirror || std::max({ids[0], ids[1], ids[2], ids[3]}) > still_drawn_) show(x, y);
      }
    }
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
    draw_dynamics(poses, nullptr);
    reflect(camera, poses);
    show_all();
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

  // Everything of it is what stands still.
  void begin(const Camera& camera) {
    seen_.meshes().look_from(camera);
    seen_.buffer().clear();
    seen_.keep(0);
    seen_.forget();
    for (std::size_t i = 0; i < spec_.statics.size(); ++i) {
      seen_.meshes().place(i, Pose{}, lamps_);
      seen_.draw(i, nullptr);
    }
  }

  void draw_dynamics(std::span<const Pose> poses, RowSpans* spans) {
    seen_.forget();
    const std::size_t statics = spec_.statics.size();
    for (std::size_t i = 0; i < poses.size(); ++i) {
      seen_.meshes().place(statics + i, poses[i], lamps_);
      seen_.draw(statics + i, spans);
    }
  }

  // What the mirror shows, where one is seen.
  std::optional<PlacedMeshes::Mirror> reflect(const Camera& camera, std::span<const Pose> poses) {
    seen_.reflect(nullptr);
    const auto mirror = seen_.meshes().mirror();
    if (!mirror) return std::nullopt;
    mirrored_.meshes().look_into(camera, *mirror);
    mirrored_.buffer().clear();
    mirrored_.keep(0);
    mirrored_.forget();
    const std::size_t statics = spec_.statics.size();
    for (std::size_t i = 0; i < statics + poses.size(); ++i) {
      if (i == mirror->instance) continue;
      mirrored_.meshes().place(i, i < statics ? Pose{} : poses[i - statics], lamps_);
      mirrored_.draw(i, nullptr);
    }
    seen_.reflect(&mirrored_);
    return mirror;
  }

  // The last frame's moving things go.
  void restore() {
    seen_.keep(still_drawn_);
    for (int y = 0; y < frame_.height; ++y) {
      const RowSpans::Span row = touched_.rows()[static_cast<std::size_t>(y)];
      if (row.left == row.right) continue;
      seen_.buffer().restore(still_buffer_, y, row.left, row.right);
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

  void show_all() {
    frame_.clear(spec_.camera.width, spec_.camera.height);
    for (int y = 0; y < frame_.height; ++y) {
      for (int x = 0; x < frame_.width; ++x) show(x, y);
    }
  }

  void show(int x, int y) {
    const std::size_t at = frame_.at(x, y);
    const std::uint32_t middle = seen_.color(x, y, &frame_.rgb[3 * at]);
    if (middle == 0) {
      frame_.depth[at] = 0;
      frame_.segmentation[at] = 0;
      return;
    }
    const SeenFace& face = seen_.face(middle);
    const float denominator = face.by_across[3] * seen_.meshes().across(x) +
                              face.by_down[3] * seen_.meshes().down(y) + face.at_middle[3];
    const float depth = face.volume / denominator;
    frame_.depth[at] =
        depth > 0 && std::isfinite(depth) ? depth : 1 / *seen_.buffer().nearness(x, y);
    frame_.segmentation[at] = face.body;
  }

  SceneSpec spec_;
  LampTable lamps_;
  Layer seen_, mirrored_;
  SampleBuffer still_buffer_;
  Picture frame_, still_frame_;
  std::size_t still_drawn_ = 0;
  bool is_still_ =
      false;  // `still_*` are of the spec's camera, and frame_ differs in touched_ only
  RowSpans touched_;
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
