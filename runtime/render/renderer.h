// Pictures of a scene: RGB, depth and segmentation, every visibility question an Embree ray. One
// Renderer per world, camera and thread; what stands still and the meshes' ray structures are
// read-only and shared (SceneStore). Contracts and the shading law are in README.md of this folder.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "runtime/base/geometry.h"
#include "runtime/base/result.h"
#include "runtime/scene/mesh.h"

namespace probe::render {

// Pinhole camera in the world: forward, left and up are the rotation's columns.
struct Camera {
  Vec3 position = Vec3::Zero();
  Mat3 forward_left_up = Mat3::Identity();
  int width = 640, height = 480;
  double fx = 1, fy = 1, cx = 0, cy = 0;  // pixels at width x height; pixel centres at +0.5
};

// forward = normalize(direction), left = normalize(z x forward), up = forward x left; fails for a
// vertical direction.
Result<Mat3> look_along(const Vec3& direction);

struct Sun {
  Vec3 direction{0, 0, -1};  // the way light travels
  double power = 1;          // irradiance on a surface that faces it
  bool shadow = false;       // casts; off in the reference
};

// What lights corners of triangles, under Shading::kVertex (README.md, "Vertex law").
struct Lamp {
  enum class Kind : std::uint8_t { kSpot, kSun, kHeadlight };
  Kind kind = Kind::kSpot;
  Vec3 position = Vec3::Zero();  // m, world; of a spot
  Vec3 direction{0, 0, -1};      // the way its light travels; of a spot and a sun
  double diffuse = 1, specular = 0, ambient = 0;
  double cutoff_cosine = -1;            // of the angle to `direction` where a spot ends
  double exponent = 0;                  // how a spot narrows: the cosine's power
  std::array<double, 3> fade{1, 0, 0};  // divided by a + b d + c d^2 at a distance of d metres
};

enum class Shading : std::uint8_t { kPixel, kVertex };

struct Lights {
  double ambient = 0.3;
  std::vector<Sun> suns;                 // under kPixel
  std::array<double, 3> color{1, 1, 1};  // factors of all of it: red, green, blue
  Shading shading = Shading::kPixel;
  std::vector<Lamp> lamps{};  // under kVertex
};

// A rigid visual. `body` is what segmentation shows + 1; kBackdrop for geometry without a body.
inline constexpr std::uint16_t kBackdrop = 65534;
struct Visual {
  std::shared_ptr<const scene::Mesh> mesh;
  Pose origin;             // mesh frame in the frame of its pose (static: in world)
  std::uint16_t body = 0;  // task-local body index
  std::string name;        // for messages
  bool robot = false;      // robot links use the robot material (README)
};

struct SceneSpec {
  std::vector<Visual> statics;   // fixed in an episode
  std::vector<Visual> dynamics;  // one pose each per frame
  Camera camera;
  Lights lights;
  std::shared_ptr<const scene::Texture>
      photo;               // shown wherever no dynamic visual is nearest; may be null
  int samples = 1;         // a side of every pixel: 1, 2 or 4; of kVertex 1 or 2
  int occlusion_rays = 0;  // of ambient occlusion a sample: 0 (off) to 16
};

// Views into the renderer, valid until the next render().
struct FrameView {
  int width = 0, height = 0;
  std::span<const std::uint8_t> rgb;            // h x w x 3, row 0 on top
  std::span<const float> depth;                 // m along the camera's forward axis; 0 beyond 10 m
  std::span<const std::uint16_t> segmentation;  // 0 nothing, 1 + body, 65535 backdrop
};

class SceneStore;

class Renderer {
 public:
  // `store` is where meshes' ray structures and static pictures are shared; null: this renderer has
  // its own. Fails (kRender) on whatever cannot be drawn, naming it.
  static Result<std::unique_ptr<Renderer>> create(SceneSpec spec,
                                                  std::shared_ptr<SceneStore> store = nullptr);
  virtual ~Renderer() = default;
  // `poses`: one per dynamic visual, world. Fails (kRender) on a non-finite pose, naming the
  // visual. The first call traces the static picture, if no renderer of the store has yet.
  virtual Result<FrameView> render(std::span<const Pose> poses) = 0;
  // The same through another camera of the spec's size, for one that moves: the static picture is
  // traced again, from structures that stay.
  virtual Result<FrameView> render_from(const Camera& camera, std::span<const Pose> poses) = 0;
  // Traces every pixel again, without the block cache: the picture must be the same. For tests and
  // golden frames.
  virtual Result<FrameView> render_full(std::span<const Pose> poses) = 0;
};

// Embree's version and which packets of rays it traces natively here, for people.
Result<std::string> describe_ray_engine();

}  // namespace probe::render
