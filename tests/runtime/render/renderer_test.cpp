#include <doctest/doctest.h>
#include <xmmintrin.h>

#include <algorithm>
#include <optional>
#include <random>
#include <thread>

#include "runtime/base/sha256.h"
#include "runtime/base/trig.h"
#include "tests/runtime/render/test_scenes.h"

namespace probe::render {
namespace {

using namespace test;

std::unique_ptr<Renderer> make(SceneSpec spec) {
  Result<std::unique_ptr<Renderer>> renderer = Renderer::create(std::move(spec));
  REQUIRE_MESSAGE(renderer.ok(), (renderer.ok() ? "" : to_text(renderer.failure())));
  return std::move(renderer).value();
}

FrameView draw(Renderer& renderer, const std::vector<Pose>& poses) {
  const Result<FrameView> frame = renderer.render(poses);
  REQUIRE_MESSAGE(frame.ok(), (frame.ok() ? "" : to_text(frame.failure())));
  return frame.value();
}

struct Copy {
  std::vector<std::uint8_t> rgb;
  std::vector<float> depth;
  std::vector<std::uint16_t> ids;
  explicit Copy(const FrameView& f)
      : rgb(f.rgb.begin(), f.rgb.end()),
        depth(f.depth.begin(), f.depth.end()),
        ids(f.segmentation.begin(), f.segmentation.end()) {}
  bool operator==(const Copy&) const = default;
};

SceneSpec square_scene(const Camera& camera) {
  SceneSpec spec;
  spec.camera = camera;
  spec.lights = table_lights();
  spec.dynamics = {visual(square(0.1), 4, "square")};
  return spec;
}

TEST_CASE("a square face covers exactly the pixels whose centres project into it") {
  for (const auto& [width, height] : {std::pair{640, 480}, {224, 224}, {37, 21}}) {
    const Camera camera = plain_camera(width, height);
    const auto renderer = make(square_scene(camera));
    const FrameView frame = draw(*renderer, {at(0.9, 0, 0)});
    int wrong = 0;
    float depth_error = 0;
    for (int j = 0; j < height; ++j) {
      for (int i = 0; i < width; ++i) {
        const bool expected = std::abs(i + 0.5 - camera.cx) < 0.1 * camera.fx / 0.9 &&
                              std::abs(j + 0.5 - camera.cy) < 0.1 * camera.fy / 0.9;
        const auto k = static_cast<std::size_t>(j * width + i);
        if ((frame.segmentation[k] == 5) != expected) ++wrong;
        if (expected) depth_error = std::max(depth_error, std::abs(frame.depth[k] - 0.9f));
        if (!expected && frame.depth[k] != 0) ++wrong;
      }
    }
    CHECK(wrong == 0);
    CHECK(depth_error < 5e-6f);
  }
}

TEST_CASE("what covers less than half is not met by rays, unless there is nothing else") {
  const auto mesh = square(0.1);
  mesh->parts.push_back(mesh->parts[0]);
  mesh->parts[1].material = 1;
  for (std::size_t i = 0; i < mesh->parts[1].positions.size(); i += 3)
    mesh->parts[1].positions[i] -= 0.2f;  // nearer
  mesh->materials.resize(2);
  const Camera camera = plain_camera(37, 21);
  SceneSpec spec = square_scene(camera);
  const auto depth = [&](float first, float second) {
    mesh->materials[0].opacity = first;
    mesh->materials[1].opacity = second;
    spec.dynamics[0].mesh = std::make_shared<scene::Mesh>(*mesh);
    return draw(*make(spec), {at(0.9, 0, 0)}).depth[10 * 37 + 18];
  };
  CHECK(depth(1, 1) == doctest::Approx(0.7));
  CHECK(depth(1, 0.5f) == doctest::Approx(0.7));
  CHECK(depth(1, 0.4f) == doctest::Approx(0.9));
  CHECK(depth(0.4f, 0.4f) == doctest::Approx(0.7));
}

TEST_CASE("moving the image centre by ten pixels moves the picture by ten pixels") {
  Camera camera = plain_camera();
  const auto before_renderer = make(square_scene(camera));
  const Copy before(draw(*before_renderer, {at(0.9, 0.05, 0.02)}));
  camera.cx += 10;
  const auto renderer = make(square_scene(camera));
  const FrameView after = draw(*renderer, {at(0.9, 0.05, 0.02)});
  int wrong = 0;
  for (std::size_t j = 0; j < 480; ++j) {
    for (std::size_t i = 0; i + 10 < 640; ++i) {
      if (before.ids[j * 640 + i] != after.segmentation[j * 640 + i + 10]) ++wrong;
    }
  }
  CHECK(wrong == 0);
}

TEST_CASE("the depth of a sphere is the analytic one") {
  SceneSpec spec;
  spec.camera = plain_camera();
  spec.lights = table_lights();
  spec.dynamics = {visual(sphere(0.1, 640), 0, "sphere")};
  const auto renderer = make(spec);
  for (const Vec3& center : {Vec3(1, 0, 0), Vec3(0.95, 0.25, -0.17)}) {
    const FrameView frame = draw(*renderer, {at(center.x(), center.y(), center.z())});
    double worst = 0;
    int seen = 0;
    for (int j = 0; j < 480; ++j) {
      for (int i = 0; i < 640; ++i) {
        const Vec3 d = Vec3(1, -(i + 0.5 - spec.camera.cx) / spec.camera.fx,
                            -(j + 0.5 - spec.camera.cy) / spec.camera.fy)
                           .normalized();
        const double b = d.dot(center), c = center.squaredNorm() - 0.01;
        if (b * b < c) continue;
        const double t = b - std::sqrt(b * b - c);
        const Vec3 normal = (t * d - center) / 0.1;
        if (-normal.dot(d) <= 0.3) continue;
        ++seen;
        worst = std::max(worst,
                         std::abs(frame.depth[static_cast<std::size_t>(j * 640 + i)] - t * d.x()));
      }
    }
    CHECK(seen > 5000);
    CHECK(worst < 1e-5);
  }
}

// Where a ray from the origin enters the box of half sizes `half`, as its t; nothing on a miss.
std::optional<double> enter_box(const Vec3& d, const Pose& box, const Vec3& half) {
  const Vec3 from = box.rotation.conjugate() * -box.position, along = box.rotation.conjugate() * d;
  double near = 0, far = 1e9;
  for (int k = 0; k < 3; ++k) {
    const double a = (-half[k] - from[k]) / along[k], b = (half[k] - from[k]) / along[k];
    near = std::max(near, std::min(a, b));
    far = std::min(far, std::max(a, b));
  }
  // A hair inside the silhouette, where one pixel more or less is rounding.
  if (near + 1e-5 > far) return std::nullopt;
  return near;
}

TEST_CASE("the depth of a turned box is the analytic one") {
  const Vec3 half(0.06, 0.1, 0.03);
  scene::MeshPart part;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      Vec3 center = Vec3::Zero(), across = Vec3::Zero(), up = Vec3::Zero();
      center[axis] = side * half[axis];
      across[(axis + 1) % 3] = half[(axis + 1) % 3];
      up[(axis + 2) % 3] = side * half[(axis + 2) % 3];
      const scene::MeshPart face = quad_part(center, across, up);
      const auto first = static_cast<std::uint32_t>(part.positions.size() / 3);
      part.positions.insert(part.positions.end(), face.positions.begin(), face.positions.end());
      part.normals.insert(part.normals.end(), face.normals.begin(), face.normals.end());
      for (const std::uint32_t index : face.indices) part.indices.push_back(first + index);
    }
  }
  SceneSpec spec;
  spec.camera = plain_camera();
  spec.lights = table_lights();
  spec.dynamics = {visual(colored(std::move(part), 0.5f), 0, "box")};
  const auto renderer = make(spec);
  for (const Pose& box : {Pose{Vec3(0.7, 0, 0), Quat(0.9, 0.2, -0.3, 0.25).normalized()},
                          Pose{Vec3(0.9, -0.2, 0.1), Quat(0.3, -0.5, 0.6, 0.1).normalized()}}) {
    const FrameView frame = draw(*renderer, {box});
    double worst = 0;
    int seen = 0;
    for (int j = 0; j < 480; ++j) {
      for (int i = 0; i < 640; ++i) {
        const Vec3 d = Vec3(1, -(i + 0.5 - spec.camera.cx) / spec.camera.fx,
                            -(j + 0.5 - spec.camera.cy) / spec.camera.fy)
                           .normalized();
        const auto t = enter_box(d, box, half);
        if (!t) continue;
        ++seen;
        worst = std::max(worst,
                         std::abs(frame.depth[static_cast<std::size_t>(j * 640 + i)] - *t * d.x()));
      }
    }
    CHECK(seen > 5000);
    CHECK(worst < 1e-5);
  }
}

TEST_CASE("an upward Lambert face under the table light has the byte of the shading law") {
  SceneSpec spec;
  spec.camera = plain_camera();
  spec.camera.forward_left_up = look_along(Vec3(1, 0, -1)).value();
  spec.lights = table_lights();
  auto mesh = colored(quad_part(Vec3::Zero(), Vec3(1, 0, 0), Vec3(0, 1, 0)), 0.25f);
  mesh->materials[0].roughness = 0;  // S is 0 and with it the Fresnel term
  spec.dynamics = {visual(mesh, 0, "floor")};
  const auto renderer = make(spec);
  const FrameView frame = draw(*renderer, {at(1, 0, -1)});
  const std::size_t middle = 240 * 640 + 320;
  CHECK(frame.segmentation[middle] == 1);
  CHECK(static_cast<int>(frame.rgb[3 * middle]) == 151);
  // Seen from below it is the same face: surfaces are two-sided, and then no sun reaches it.
  const FrameView below = draw(*renderer, {{Vec3(1, 0, -1), Quat(0, 1, 0, 0)}});
  CHECK(static_cast<int>(below.rgb[3 * middle]) == 151);
}

TEST_CASE("segmentation names the nearest body, hides hidden ones and marks the backdrop") {
  SceneSpec spec;
  spec.camera = plain_camera();
  spec.lights = table_lights();
  Visual wall = visual(square(0.2), kBackdrop, "wall");
  wall.origin = at(1.5, 0, 0);
  Visual shelf = visual(square(0.05), 7, "shelf");
  shelf.origin = at(0.5, 0.2, 0);
  spec.statics = {wall, shelf};
  spec.dynamics = {visual(square(0.1), 2, "near"), visual(square(0.1), 3, "far"),
                   visual(square(0.02), 9, "hidden")};
  const auto renderer = make(spec);
  const FrameView frame = draw(*renderer, {at(0.8, 0, 0), at(1.0, 0.1, 0), at(0.7, 0.28, 0)});
  const auto id = [&frame](int x, int y) {
    return frame.segmentation[static_cast<std::size_t>(y * 640 + x)];
  };
  CHECK(id(320, 240) == 3);
  CHECK(id(320 - 100, 240) == 4);
  CHECK(id(70, 240) == 8);  // the static shelf is nearer than "hidden"
  CHECK(id(320 + 80, 240) == 65535);
  CHECK(id(5, 5) == 0);
  CHECK(frame.depth[5 * 640 + 5] == 0);
  CHECK(frame.rgb[3 * (5 * 640 + 5)] == 0);
  CHECK(std::count(frame.segmentation.begin(), frame.segmentation.end(), std::uint16_t{10}) == 0);
}

TEST_CASE("a photo is untouched wherever no moving thing is nearest") {
  SceneSpec spec = square_scene(plain_camera(64, 48));
  auto photo = std::make_shared<scene::Texture>();
  photo->width = 64;
  photo->height = 48;
  for (int i = 0; i < 64 * 48 * 4; ++i) photo->rgba.push_back(static_cast<std::uint8_t>(i * 37));
  spec.photo = photo;
  Visual wall = visual(square(0.1), kBackdrop, "wall");
  wall.origin = at(0.7, -0.1, 0);
  spec.statics = {wall};
  const auto renderer = make(spec);
  const FrameView frame = draw(*renderer, {at(0.9, 0, 0)});
  int wrong = 0, backdrop = 0, moving = 0;
  for (std::size_t k = 0; k < 64 * 48; ++k) {
    if (frame.segmentation[k] == 5) {
      ++moving;
      continue;
    }
    if (frame.segmentation[k] == 65535) ++backdrop;
    for (std::size_t c = 0; c < 3; ++c) wrong += frame.rgb[3 * k + c] != photo->rgba[4 * k + c];
  }
  CHECK(wrong == 0);
  CHECK(backdrop > 50);
  CHECK(moving > 20);
}

TEST_CASE("a photo of another size is averaged over boxes") {
  SceneSpec spec;
  spec.camera = plain_camera(2, 1);
  auto photo = std::make_shared<scene::Texture>();
  *photo = {4, 2, std::vector<std::uint8_t>(4 * 8, 0)};
  for (const std::size_t texel : {0, 1, 4, 5})
    photo->rgba[4 * texel] = static_cast<std::uint8_t>(10 * texel);
  spec.photo = photo;
  const auto renderer = make(spec);
  const FrameView frame = draw(*renderer, {});
  CHECK(static_cast<int>(frame.rgb[0]) == 25);
  CHECK(static_cast<int>(frame.rgb[3]) == 0);
}

TEST_CASE("textures repeat, row 0 is on top and emission is shown as it is") {
  SceneSpec spec;
  spec.camera = plain_camera(64, 64);
  spec.camera.fx = spec.camera.fy = 64;
  spec.camera.cx = spec.camera.cy = 32;
  auto mesh = square(0.5);
  mesh->materials[0].base_color = {0, 0, 0};
  mesh->materials[0].emission_texture = 0;
  // Upper row red, green; lower row blue, white.
  mesh->textures.push_back(
      {2, 2, {255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 255, 255, 255, 255}});
  spec.dynamics = {visual(mesh, 0, "checker")};
  const auto renderer = make(spec);
  const FrameView frame = draw(*renderer, {at(1, 0, 0)});
  const auto pixel = [&frame](std::size_t x, std::size_t y) {
    const std::size_t k = 3 * (y * 64 + x);
    return std::array<int, 3>{frame.rgb[k], frame.rgb[k + 1], frame.rgb[k + 2]};
  };
  // Texel centres lie at a quarter and three quarters of the face.
  const auto near = [](std::array<int, 3> a, std::array<int, 3> b) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (b[k] == 255 ? a[k] < 240 : a[k] > 60) return false;
    }
    return true;
  };
  CHECK(near(pixel(16, 16), {255, 0, 0}));
  CHECK(near(pixel(48, 16), {0, 255, 0}));
  CHECK(near(pixel(16, 48), {0, 0, 255}));
  CHECK(near(pixel(48, 48), {255, 255, 255}));
}

std::shared_ptr<const scene::Texture> gradient(int width, int height) {
  auto photo = std::make_shared<scene::Texture>();
  *photo = {width, height, std::vector<std::uint8_t>(static_cast<std::size_t>(4 * width * height))};
  for (std::size_t k = 0; k < photo->rgba.size(); ++k) {
    photo->rgba[k] = static_cast<std::uint8_t>(40 + k * 13 % 200);
  }
  return photo;
}

struct Mode {
  bool shadow = false, photo = false;
  int samples = 1, occlusion = 0;
};

TEST_CASE("a cached frame equals a full one on random poses, entering and leaving, in every mode") {
  SceneSpec spec;
  spec.camera = plain_camera(200, 150);
  spec.lights = {
      .ambient = 0.3,
      .suns = {{Vec3(1, -0.3, -0.5), 2.2}, {Vec3(-1, -0.5, -1), 0.7}, {Vec3(0, 0, -1), 1}}};
  Visual wall = visual(square(0.5), kBackdrop, "wall");
  wall.origin = at(1.2, 0.1, 0);
  Visual floor = visual(colored(quad_part(Vec3::Zero(), Vec3(2, 0, 0), Vec3(0, 2, 0)), 0.4f),
                        kBackdrop, "floor");
  floor.origin = at(1, 0, -0.3);
  spec.statics = {wall, floor};
  spec.dynamics = {visual(sphere(0.1, 24), 0, "ball"), visual(square(0.2), 1, "card"),
                   visual(sphere(0.02, 12), 2, "pea")};
  const Mode modes[] = {{},
                        {.photo = true},
                        {.shadow = true},
                        {.shadow = true, .photo = true},
                        {.samples = 2},
                        {.photo = true, .samples = 2},
                        {.occlusion = 4},
                        {.shadow = true, .samples = 2, .occlusion = 3},
                        {.shadow = true, .photo = true, .samples = 4, .occlusion = 8}};
  for (const Mode& mode : modes) {
    CAPTURE(mode.shadow);
    CAPTURE(mode.photo);
    CAPTURE(mode.samples);
    CAPTURE(mode.occlusion);
    for (std::size_t sun : {0, 1}) spec.lights.suns[sun].shadow = mode.shadow;
    spec.photo = mode.photo ? gradient(200, 150) : nullptr;
    spec.samples = mode.samples;
    spec.occlusion_rays = mode.occlusion;
    const auto cached = make(spec);
    const auto full = make(spec);
    std::mt19937 random(5);
    std::uniform_real_distribution<double> unit(-1, 1);
    int different = 0, seen = 0;
    const int frames = mode.samples > 1 ? 40 : 200;
    for (int frame = 0; frame < frames; ++frame) {
      std::vector<Pose> poses;
      for (int b = 0; b < 3; ++b) {
        const double far = 0.8 * unit(random) + 0.4;  // often around and behind the camera
        poses.push_back({Vec3(far, 0.6 * unit(random), 0.5 * unit(random)),
                         Quat(unit(random), unit(random), unit(random), 1.1).normalized()});
      }
      const Copy a(draw(*cached, poses));
      const Result<FrameView> whole = full->render_full(poses);
      REQUIRE(whole.ok());
      if (!(a == Copy(whole.value()))) ++different;
      seen += static_cast<int>(std::count(a.ids.begin(), a.ids.end(), std::uint16_t{1}) > 0);
    }
    CHECK(different == 0);
    CHECK(10 * seen > frames);
  }
}

// Balls before a wall, more than an instance set has bits.
SceneSpec crowd(std::size_t bodies) {
  SceneSpec spec;
  spec.camera = plain_camera(200, 150);
  spec.lights = {.ambient = 0.3, .suns = {{Vec3(1, -0.3, -0.5), 2.2}}};
  spec.statics = {visual(square(0.5), kBackdrop, "wall")};
  spec.statics[0].origin = at(1.2, 0.1, 0);
  for (std::size_t b = 0; b < bodies; ++b) {
    spec.dynamics.push_back(visual(b % 2 == 0 ? sphere(0.05, 12) : square(0.06),
                                   static_cast<std::uint16_t>(b), "body"));
  }
  return spec;
}

Pose somewhere(std::mt19937& random) {
  std::uniform_real_distribution<double> unit(-1, 1);
  const double far = 0.5 * unit(random) + 0.7;
  return {Vec3(far, 0.4 * unit(random), 0.3 * unit(random)),
          Quat(unit(random), unit(random), unit(random), 1.1).normalized()};
}

TEST_CASE("two things of one mesh that meet in the picture lie where each of them lies") {
  const auto shared = square(0.2);
  SceneSpec spec;
  spec.camera = plain_camera(128, 128);
  spec.dynamics = {visual(shared, 0, "front"), visual(shared, 1, "behind")};
  const auto renderer = make(spec);
  // Right of the front one's upper right triangle the same of the other: their hits follow each
  // other.
  const std::vector<Pose> poses = {at(1.0, 0, 0), at(1.1, -0.15, 0)};
  const auto misplaced = [](const FrameView& frame) {
    int count = 0;
    for (std::size_t i = 0; i < frame.depth.size(); ++i) {
      const double depth[] = {0, 1.0, 1.1};
      count += std::abs(frame.depth[i] - depth[frame.segmentation[i]]) > 1e-5 ? 1 : 0;
    }
    return count;
  };
  CHECK(misplaced(draw(*renderer, poses)) == 0);
  const Result<FrameView> moving = renderer->render_from(spec.camera, poses);
  REQUIRE(moving.ok());
  CHECK(misplaced(*moving) == 0);
}

TEST_CASE("where nothing has moved the picture is kept, and still it is the full one") {
  for (const std::size_t bodies : {3, 40}) {
    CAPTURE(bodies);
    SceneSpec spec = crowd(bodies);
    const auto cached = make(spec);
    const auto full = make(spec);
    Camera elsewhere = spec.camera;
    elsewhere.position = Vec3(0.1, -0.1, 0.05);
    std::mt19937 random(11);
    std::vector<Pose> poses(bodies);
    for (Pose& pose : poses) pose = somewhere(random);
    int different = 0;
    for (int frame = 0; frame < 120; ++frame) {
      for (Pose& pose : poses) {
        if (random() % 4 == 0) pose = somewhere(random);
      }
      // A look through another camera, as the picture's owner may take between two frames.
      if (frame % 9 == 0) REQUIRE(cached->render_from(elsewhere, poses).ok());
      const Copy kept(draw(*cached, poses));
      const Result<FrameView> whole = full->render_full(poses);
      REQUIRE(whole.ok());
      different += kept == Copy(*whole) ? 0 : 1;
    }
    CHECK(different == 0);
  }
}

TEST_CASE("a camera that moves shows in every mode what one standing there shows") {
  for (const Mode& mode : {Mode{},
                           {.photo = true},
                           {.shadow = true},
                           {.samples = 2},
                           {.occlusion = 4},
                           {.shadow = true, .samples = 2, .occlusion = 3}}) {
    CAPTURE(mode.shadow);
    CAPTURE(mode.samples);
    CAPTURE(mode.occlusion);
    SceneSpec spec = crowd(5);
    spec.lights.suns[0].shadow = mode.shadow;
    spec.photo = mode.photo ? gradient(200, 150) : nullptr;
    spec.samples = mode.samples;
    spec.occlusion_rays = mode.occlusion;
    const auto moving = make(spec);
    std::mt19937 random(7);
    std::uniform_real_distribution<double> unit(-1, 1);
    for (int frame = 0; frame < 12; ++frame) {
      SceneSpec there = spec;
      there.camera.position = 0.2 * Vec3(unit(random), unit(random), unit(random));
      there.camera.forward_left_up =
          look_along(Vec3(1, 0.4 * unit(random), 0.4 * unit(random))).value();
      std::vector<Pose> poses(5);
      for (Pose& pose : poses) pose = somewhere(random);
      const Result<FrameView> seen = moving->render_from(there.camera, poses);
      REQUIRE(seen.ok());
      const auto standing = make(there);
      const Result<FrameView> whole = standing->render_full(poses);
      REQUIRE(whole.ok());
      CHECK(Copy(*seen) == Copy(*whole));
    }
  }
}

// A floor one metre under the camera's sight, a roof over its middle, the sun above both.
SceneSpec roofed_floor() {
  SceneSpec spec;
  spec.camera = plain_camera(64, 64);
  spec.camera.forward_left_up = look_along(Vec3(1, 0, -1)).value();
  spec.camera.fx = spec.camera.fy = 64;
  spec.camera.cx = spec.camera.cy = 32;
  spec.lights = {.ambient = 0.3, .suns = {{Vec3(0, 0, -1), 2.2, true}}};
  Visual floor = visual(colored(quad_part(Vec3::Zero(), Vec3(1, 0, 0), Vec3(0, 1, 0)), 0.25f),
                        kBackdrop, "floor");
  floor.origin = at(1, 0, -1);
  spec.statics = {floor};
  spec.dynamics = {
      visual(colored(quad_part(Vec3::Zero(), Vec3(0.1, 0, 0), Vec3(0, 0.1, 0)), 0.25f), 0, "roof")};
  return spec;
}
constexpr std::size_t kMiddle = 3 * (32 * 64 + 32);
const Pose kRoof = at(1, 0, 0.5);  // above the view
const Pose kAway = at(1, 5, 0.5);

TEST_CASE("a shadow darkens a static floor to its ambient light and goes with what cast it") {
  SceneSpec spec = roofed_floor();
  const auto renderer = make(spec);
  const Copy lit(draw(*renderer, {kAway}));
  const Copy dark(draw(*renderer, {kRoof}));
  CHECK(static_cast<int>(lit.rgb[kMiddle]) == 135);  // (0.25 (0.3 + 2.2 / pi))^(1/2.2)
  CHECK(static_cast<int>(dark.rgb[kMiddle]) == 78);  // (0.25 0.3)^(1/2.2)
  CHECK(lit.depth == dark.depth);
  CHECK(Copy(draw(*renderer, {kAway})) == lit);
}

TEST_CASE("the photo catches the shadow: scaled by the share of light that is left") {
  SceneSpec spec = roofed_floor();
  auto photo = std::make_shared<scene::Texture>();
  *photo = {64, 64, std::vector<std::uint8_t>(4 * 64 * 64, 200)};
  spec.photo = photo;
  const auto renderer = make(spec);
  const Copy lit(draw(*renderer, {kAway}));
  CHECK(std::all_of(lit.rgb.begin(), lit.rgb.end(), [](std::uint8_t b) { return b == 200; }));
  const FrameView dark = draw(*renderer, {kRoof});
  // 200 (0.3 / (0.3 + 2.2 / pi))^(1/2.2) = 115.7
  CHECK(static_cast<int>(dark.rgb[kMiddle]) == 115);
  CHECK(static_cast<int>(dark.rgb[0]) == 200);
}

TEST_CASE("statics shade statics and moving things where a sun casts") {
  SceneSpec spec = roofed_floor();
  Visual roof = spec.dynamics[0];
  roof.origin = kRoof;
  spec.statics.push_back(roof);
  spec.dynamics = {visual(
      colored(quad_part(Vec3::Zero(), Vec3(0.05, 0, 0), Vec3(0, 0.05, 0)), 0.5f), 0, "card")};
  const auto renderer = make(spec);
  CHECK(static_cast<int>(draw(*renderer, {kAway}).rgb[kMiddle]) == 78);
  CHECK(static_cast<int>(draw(*renderer, {at(0.95, 0, -0.95)}).rgb[kMiddle]) ==
        107);  // (0.5 0.3)^(1/2.2)
}

TEST_CASE("several samples a pixel average light, not bytes; depth and id stay one sample's") {
  // A white card's edge runs through the middle of a pixel column on black.
  SceneSpec spec;
  spec.camera = plain_camera(64, 48);
  spec.camera.fx = spec.camera.fy = 64;
  spec.camera.cx = 31.5;
  auto card = square(0.1);
  card->materials[0].emission = {1, 1, 1};
  spec.dynamics = {visual(card, 4, "card")};
  spec.samples = 2;
  const auto renderer = make(spec);
  const FrameView frame = draw(*renderer, {at(1, 0.1, 0)});  // its right edge at x = cx
  const std::size_t row = 24 * 64;
  CHECK(static_cast<int>(frame.rgb[3 * (row + 30)]) == 255);
  CHECK(static_cast<int>(frame.rgb[3 * (row + 31)]) == 186);  // half the light
  CHECK(static_cast<int>(frame.rgb[3 * (row + 32)]) == 0);
  CHECK(frame.segmentation[row + 31] == 5);
  CHECK(frame.depth[row + 31] == doctest::Approx(1).epsilon(1e-6));
  CHECK(frame.depth[row + 32] == 0);
}

TEST_CASE("a corner is less open to ambient light than a plane") {
  SceneSpec spec = roofed_floor();
  spec.lights = {.ambient = 1, .suns = {}};
  Visual wall = visual(square(1), kBackdrop, "wall");
  wall.origin = at(1, 0, 0);
  spec.statics.push_back(wall);
  spec.dynamics = {visual(sphere(0.01, 8), 0, "pea")};
  spec.occlusion_rays = 16;
  const auto renderer = make(spec);
  const FrameView frame = draw(*renderer, {kAway});
  // Rows below the middle show the floor, farther from the wall the lower they are.
  const auto at_row = [&frame](std::size_t row) {
    return static_cast<int>(frame.rgb[3 * (row * 64 + 32)]);
  };
  CHECK(at_row(60) == 135);  // 0.25^(1/2.2), open
  CHECK(at_row(32) < 112);
  CHECK(at_row(32) > 95);  // half open: 99
}

TEST_CASE("a camera that moves shows what one standing there shows") {
  SceneSpec spec = roofed_floor();
  spec.dynamics[0].origin = at(0, 0, -1.2);
  const auto moving = make(spec);
  draw(*moving, {kRoof});
  SceneSpec there = spec;
  there.camera.position = Vec3(0.1, 0.05, 0.02);
  there.camera.forward_left_up = look_along(Vec3(1, -0.2, -1.1)).value();
  const auto standing = make(there);
  const Result<FrameView> seen = moving->render_from(there.camera, std::vector<Pose>{kRoof});
  REQUIRE(seen.ok());
  CHECK(Copy(*seen) == Copy(draw(*standing, {kRoof})));
  const auto first = make(spec);
  CHECK(Copy(draw(*moving, {kRoof})) == Copy(draw(*first, {kRoof})));
  there.camera.width = 32;
  CHECK_FALSE(moving->render_from(there.camera, std::vector<Pose>{kRoof}).ok());
}

TEST_CASE("qualities that are not there are refused") {
  SceneSpec spec = roofed_floor();
  spec.samples = 3;
  CHECK_FALSE(Renderer::create(spec).ok());
  spec.samples = 1;
  spec.occlusion_rays = 99;
  CHECK_FALSE(Renderer::create(spec).ok());
}

TEST_CASE("two worlds on two threads draw what they draw one after the other") {
  SceneSpec spec = square_scene(plain_camera(320, 240));
  spec.dynamics.push_back(visual(sphere(0.1, 64), 1, "ball"));
  Visual wall = visual(square(0.3), kBackdrop, "wall");
  wall.origin = at(1.2, 0.1, 0);
  spec.statics = {wall};
  const auto episode = [&spec](double phase, std::vector<Sha256>& hashes) {
    Result<std::unique_ptr<Renderer>> renderer = Renderer::create(spec);
    if (!renderer) return;
    for (int k = 0; k < 40; ++k) {
      const SinCos turn = portable_sincos(0.1 * k + phase);
      const std::vector<Pose> poses{at(0.9, 0.2 * turn.sin, 0.1 * turn.cos),
                                    at(0.8, -0.2 * turn.cos, 0.1 * turn.sin)};
      const Result<FrameView> frame = (*renderer)->render(poses);
      if (!frame) return;
      hashes.push_back(sha256(std::as_bytes(frame->rgb)));
      hashes.push_back(sha256(std::as_bytes(frame->depth)));
    }
  };
  std::vector<Sha256> alone[2], together[2];
  episode(0, alone[0]);
  episode(1, alone[1]);
  std::thread first([&] { episode(0, together[0]); });
  std::thread second([&] { episode(1, together[1]); });
  first.join();
  second.join();
  CHECK(alone[0].size() == 80);
  CHECK(alone[0] == together[0]);
  CHECK(alone[1] == together[1]);
}

TEST_CASE("a sun marked so casts the shadow of one moving body on another") {
  SceneSpec spec;
  spec.camera = plain_camera(64, 64);
  spec.camera.forward_left_up = look_along(Vec3(1, 0, -1)).value();
  spec.camera.fx = spec.camera.fy = 64;
  spec.camera.cx = spec.camera.cy = 32;
  spec.lights = {.ambient = 0.3, .suns = {{Vec3(0, 0, -1), 2.2, false}}};
  const auto floor = colored(quad_part(Vec3::Zero(), Vec3(1, 0, 0), Vec3(0, 1, 0)), 0.25f);
  const auto roof = colored(quad_part(Vec3::Zero(), Vec3(0.1, 0, 0), Vec3(0, 0.1, 0)), 0.25f);
  spec.dynamics = {visual(floor, 0, "floor"), visual(roof, 1, "roof")};
  const std::vector<Pose> poses{at(1, 0, -1), at(1, 0, 0.5)};  // the roof is above the view
  const std::size_t middle = 3 * (32 * 64 + 32);
  const auto plain = make(spec);
  const int lit = draw(*plain, poses).rgb[middle];
  spec.lights.suns[0].shadow = true;
  const auto shadowed = make(spec);
  const int dark = draw(*shadowed, poses).rgb[middle];
  CHECK(lit > 130);
  CHECK(dark < 85);
  CHECK(dark > 70);  // (0.3 * 0.25)^(1/2.2) is 78
}

TEST_CASE("the control register of the caller is restored") {
  const auto renderer = make(square_scene(plain_camera(64, 48)));
  const unsigned before = _mm_getcsr() & ~0x3fu;  // without the sticky exception flags
  draw(*renderer, {at(0.9, 0, 0)});
  CHECK((_mm_getcsr() & ~0x3fu) == before);
  CHECK((before & 0x8040u) == 0);
}

TEST_CASE("what cannot be drawn is refused by name, and the renderer goes on") {
  const auto renderer = make(square_scene(plain_camera(64, 48)));
  const Copy before(draw(*renderer, {at(0.9, 0, 0)}));
  const Result<FrameView> nan = renderer->render(std::vector<Pose>{at(0.9, std::nan(""), 0)});
  REQUIRE_FALSE(nan.ok());
  CHECK(nan.failure().code == Fault::kRender);
  CHECK(to_text(nan.failure()).find("square") != std::string::npos);
  CHECK_FALSE(renderer->render(std::vector<Pose>{}).ok());
  CHECK(Copy(draw(*renderer, {at(0.9, 0, 0)})) == before);

  SceneSpec spec = square_scene(plain_camera(64, 48));
  spec.dynamics[0].mesh = nullptr;
  CHECK_FALSE(Renderer::create(spec).ok());
  auto broken = square(0.1);
  broken->parts[0].indices[2] = 99;
  spec.dynamics[0].mesh = broken;
  const auto refused = Renderer::create(spec);
  REQUIRE_FALSE(refused.ok());
  CHECK(to_text(refused.failure()).find("test mesh") != std::string::npos);
}

}  // namespace
}  // namespace probe::render
