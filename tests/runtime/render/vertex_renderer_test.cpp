// The vertex law and the pictures that are drawn by it.
#include "runtime/render/vertex_renderer.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "runtime/render/mipmap.h"
#include "runtime/render/sample_buffer.h"
#include "runtime/render/vertex_law.h"
#include "tests/runtime/render/test_scenes.h"

namespace probe::render {
namespace {

using namespace test;

struct VertexFrame {
  std::vector<std::uint8_t> rgb;
  std::vector<float> depth;
  std::vector<std::uint16_t> ids;
  bool operator==(const VertexFrame&) const = default;
};

VertexFrame kept(const Result<FrameView>& frame) {
  REQUIRE_MESSAGE(frame.ok(), (frame.ok() ? "" : to_text(frame.failure())));
  return {{frame->rgb.begin(), frame->rgb.end()},
          {frame->depth.begin(), frame->depth.end()},
          {frame->segmentation.begin(), frame->segmentation.end()}};
}

std::unique_ptr<Renderer> vertex_renderer(SceneSpec spec) {
  auto made = Renderer::create(std::move(spec));
  REQUIRE_MESSAGE(made.ok(), (made.ok() ? "" : to_text(made.failure())));
  return std::move(made).value();
}

Lights lit_by(std::vector<Lamp> lamps, double ambient = 0) {
  Lights lights;
  lights.ambient = ambient;
  lights.shading = Shading::kVertex;
  lights.lamps = std::move(lamps);
  return lights;
}

Lamp sun_along(const Vec3& direction, double power) {
  Lamp lamp;
  lamp.kind = Lamp::Kind::kSun;
  lamp.direction = direction;
  lamp.diffuse = power;
  return lamp;
}

// Before a camera of 64 x 64 pixels, its pixels an eighth of a metre at a metre.
SceneSpec before_camera(std::shared_ptr<const scene::Mesh> mesh, Lights lights, int samples = 1) {
  SceneSpec spec;
  spec.camera = plain_camera(64, 64);
  spec.camera.fx = spec.camera.fy = 64;
  spec.camera.cx = spec.camera.cy = 32;
  spec.lights = std::move(lights);
  spec.samples = samples;
  spec.dynamics = {visual(std::move(mesh), 6, "thing")};
  return spec;
}

std::array<int, 3> pixel(const VertexFrame& frame, int x, int y, int width = 64) {
  const auto at = static_cast<std::size_t>(3 * (y * width + x));
  return {frame.rgb[at], frame.rgb[at + 1], frame.rgb[at + 2]};
}

// Of what a byte b shows of white light.
float linear_of(int byte) {
  const double s = byte / 255.0;
  return static_cast<float>(s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4));
}

}  // namespace

TEST_CASE("a face under one lamp has the formula's colour, without gamma") {
  // The square looks at the eye along -x; its material is byte 128 of 255.
  auto mesh = square(0.4, linear_of(128));
  mesh->materials[0].specular = 0;
  const auto frame =
      kept(vertex_renderer(before_camera(mesh, lit_by({sun_along(Vec3(1, 0, 0), 0.5)}, 0.25)))
               ->render(std::vector<Pose>{at(1, 0, 0)}));
  const int expected = static_cast<int>(std::lround(255 * (0.25 + 0.5) * (128 / 255.0)));
  CHECK(pixel(frame, 32, 32) == std::array<int, 3>{expected, expected, expected});
  CHECK(frame.ids[32 * 64 + 32] == 7);
  CHECK(frame.depth[32 * 64 + 32] == doctest::Approx(1).epsilon(1e-5));
  CHECK(pixel(frame, 0, 0) == std::array<int, 3>{0, 0, 0});
  CHECK(frame.ids[0] == 0);
  CHECK(frame.depth[0] == 0);
}

TEST_CASE("the highlight is added, the whole is clamped, and a texture is multiplied in last") {
  VertexMaterial material;
  material.color = {1, 0.5f, 0};
  material.specular = 0.5f;
  material.shine = std::make_shared<const PowerTable>(64);
  Lamp sun = sun_along(Vec3(0, 0, -1), 0.6);
  sun.specular = 0.4;
  sun.ambient = 0.1;
  const auto table = LampTable::make(lit_by({sun}));
  REQUIRE(table.ok());
  LampsThere there;
  table->put(Pose{}, Vec3(0, 0, 3), Vec3(0, 0, -1), there);
  const auto color = there.color_of(material, Float3::Zero(), Float3::UnitZ());
  // Eye and sun stand in one line over the face: the half vector is the normal.
  CHECK(color[0] == doctest::Approx(0.1 + 0.6 + 0.4 * 0.5));
  CHECK(color[1] == doctest::Approx((0.1 + 0.6) * 0.5 + 0.4 * 0.5));
  CHECK(color[2] == doctest::Approx(0.4 * 0.5));
  // Turned away: only what is ambient.
  CHECK(there.color_of(material, Float3::Zero(), -Float3::UnitZ())[0] == doctest::Approx(0.1));
  sun.diffuse = 5;
  const auto bright = LampTable::make(lit_by({sun}));
  bright->put(Pose{}, Vec3(0, 0, 3), Vec3(0, 0, -1), there);
  CHECK(there.color_of(material, Float3::Zero(), Float3::UnitZ())[0] == 1.0f);

  auto mesh = square(0.4);
  mesh->materials[0].specular = 0;
  mesh->materials[0].base_color_texture = 0;
  mesh->textures.push_back({2, 2, std::vector<std::uint8_t>(16, 100)});
  const auto frame =
      kept(vertex_renderer(before_camera(mesh, lit_by({sun_along(Vec3(1, 0, 0), 5)})))
               ->render(std::vector<Pose>{at(1, 0, 0)}));
  CHECK(pixel(frame, 32, 32) == std::array<int, 3>{100, 100, 100});
}

TEST_CASE("a spot narrows by its cosine's power, ends at its cutoff and fades with distance") {
  VertexMaterial material;
  material.specular = 0;
  material.shine = std::make_shared<const PowerTable>(0);
  Lamp spot;
  spot.position = Vec3(0, 0, 2);
  spot.direction = Vec3(0, 0, -3);
  spot.cutoff_cosine = std::cos(M_PI / 4);
  spot.exponent = 10;
  spot.fade = {1, 0, 0.5};
  const auto table = LampTable::make(lit_by({spot}));
  REQUIRE(table.ok());
  LampsThere there;
  table->put(Pose{}, Vec3(0, 0, 5), Vec3(0, 0, -1), there);
  const auto at_x = [&](double x) {
    return there.color_of(material, Float3(static_cast<float>(x), 0, 0), Float3::UnitZ())[0];
  };
  for (const double x : {0.0, 0.5, 1.0, 1.9}) {
    CAPTURE(x);
    const double far = std::hypot(x, 2.0), along = 2 / far;
    CHECK(at_x(x) ==
          doctest::Approx(std::pow(along, 10) * along / (1 + 0.5 * far * far)).epsilon(1e-3));
  }
  CHECK(at_x(2.01) == 0);
}

TEST_CASE("powers are read from a table that is right to a ten thousandth") {
  for (const double exponent : {0.0, 0.5, 1.0, 10.0, 12.8, 64.0, 128.0}) {
    const PowerTable table(exponent);
    for (int i = 0; i <= 1000; ++i) {
      const double x = i / 1000.0;
      CAPTURE(exponent);
      CAPTURE(x);
      if (exponent == 0.5 && x < 0.01) continue;  // its slope at 0 has no end
      CHECK(table.at(static_cast<float>(x)) ==
            doctest::Approx(std::pow(x, exponent)).epsilon(2e-4).scale(1));
    }
  }
}

TEST_CASE("a headlight shines along the camera's axis, from all over") {
  VertexMaterial material;
  material.specular = 0;
  material.shine = std::make_shared<const PowerTable>(0);
  Lamp head;
  head.kind = Lamp::Kind::kHeadlight;
  head.diffuse = 0.5;
  head.ambient = 0.1;
  const auto table = LampTable::make(lit_by({head}));
  REQUIRE(table.ok());
  LampsThere there;
  table->put(Pose{}, Vec3(0, 0, 1), Vec3(0.6, 0, -0.8), there);
  for (const float x : {-3.0f, 0.0f, 2.0f})
    CHECK(there.color_of(material, Float3(x, 0, 0), Float3::UnitZ())[0] ==
          doctest::Approx(0.1 + 0.5 * 0.8));
}

TEST_CASE("a flat metal gives back the colours of what is before it, and nothing behind it") {
  // A floor of metal under the eye, a card that stands on it, one that hangs below it.
  auto floor = colored(quad_part(Vec3(2, 0, -0.5), Vec3(0, -2, 0), Vec3(2, 0, 0)), 0);
  floor->materials[0].metallic = 0.5f;
  floor->materials[0].specular = 0;
  auto card = square(0.2, 1);
  card->materials[0].specular = 0;
  SceneSpec spec = before_camera(floor, lit_by({}, 0.8));
  spec.dynamics.push_back(visual(card, 7, "card"));
  const auto renderer = vertex_renderer(spec);
  const auto standing = kept(renderer->render(std::vector<Pose>{Pose{}, at(2, 0, -0.3)}));
  // Its middle is seen at the depth of 2 m and 0.3 m low, its image 0.7 m low.
  const int row = 32 + static_cast<int>(64 * 0.3 / 2), image = 32 + static_cast<int>(64 * 0.7 / 2);
  CHECK(pixel(standing, 32, row)[0] == 204);
  CHECK(standing.ids[static_cast<std::size_t>(64 * row + 32)] == 8);
  CHECK(pixel(standing, 32, image)[0] == 102);
  CHECK(standing.ids[static_cast<std::size_t>(64 * image + 32)] == 7);
  CHECK(pixel(standing, 5, image)[0] == 0);
  const auto below = kept(renderer->render(std::vector<Pose>{Pose{}, at(2, 0, -0.8)}));
  int lit = 0;
  for (const std::uint8_t byte : below.rgb) lit += byte > 0 ? 1 : 0;
  CHECK(lit == 0);
}

TEST_CASE("light is found at corners and runs straight between them") {
  // A spot on the middle of a large square lights no corner of it: the middle stays dark.
  Lamp spot;
  spot.position = Vec3(0.5, 0, 0);
  spot.direction = Vec3(1, 0, 0);
  spot.cutoff_cosine = std::cos(0.3);
  auto mesh = square(0.45);
  const auto frame = kept(
      vertex_renderer(before_camera(mesh, lit_by({spot})))->render(std::vector<Pose>{at(1, 0, 0)}));
  CHECK(frame.ids[32 * 64 + 32] == 7);
  CHECK(pixel(frame, 32, 32) == std::array<int, 3>{0, 0, 0});
}

TEST_CASE("the back of a face shows nothing") {
  const auto renderer =
      vertex_renderer(before_camera(square(0.3), lit_by({sun_along(Vec3(1, 0, 0), 1)})));
  const Pose turned{Vec3(1, 0, 0), Quat(0, 0, 0, 1)};
  const auto frame = kept(renderer->render(std::vector<Pose>{turned}));
  CHECK(std::ranges::all_of(frame.ids, [](std::uint16_t id) { return id == 0; }));
}

TEST_CASE("an edge has quarters of its colour with four samples, all or nothing with one") {
  auto mesh = square(0.3, linear_of(200));
  mesh->materials[0].specular = 0;
  const Pose leaning{Vec3(1, 0.01, 0.02), Quat(Eigen::AngleAxisd(0.2, Vec3::UnitX()))};
  for (const int samples : {1, 2}) {
    CAPTURE(samples);
    const auto frame =
        kept(vertex_renderer(before_camera(mesh, lit_by({sun_along(Vec3(1, 0, 0), 1)}), samples))
                 ->render(std::vector<Pose>{leaning}));
    std::array<int, 5> seen{};
    for (std::size_t i = 0; i < frame.rgb.size(); i += 3) {
      const int quarters = (frame.rgb[i] + 25) / 50;
      CHECK(std::abs(frame.rgb[i] - 50 * quarters) <= 1);
      ++seen[static_cast<std::size_t>(quarters)];
    }
    CHECK(seen[0] > 0);
    CHECK(seen[4] > 0);
    if (samples == 1) {
      CHECK(seen[1] + seen[2] + seen[3] == 0);
    } else {
      CHECK(std::min({seen[1], seen[2], seen[3]}) > 0);
    }
  }
}

TEST_CASE("a pane covers its share of what lies behind it, in quarters") {
  auto wall = square(0.45, linear_of(200)), pane = square(0.2, linear_of(80));
  wall->materials[0].specular = pane->materials[0].specular = 0;
  for (const auto& [opacity, quarters] :
       {std::pair{1.0f, 4}, {0.75f, 3}, {0.5f, 2}, {0.25f, 1}, {0.2f, 1}, {0.1f, 0}}) {
    pane->materials[0].opacity = opacity;
    CAPTURE(opacity);
    for (const int samples : {1, 2}) {
      SceneSpec spec = before_camera(std::make_shared<scene::Mesh>(*wall),
                                     lit_by({sun_along(Vec3(1, 0, 0), 1)}), samples);
      spec.dynamics.push_back(visual(std::make_shared<scene::Mesh>(*pane), 7, "pane"));
      const auto renderer = vertex_renderer(spec);
      const std::vector<Pose> poses{at(1, 0, 0), at(0.9, 0, 0)};
      const auto frame = kept(renderer->render(poses));
      CHECK(pixel(frame, 32, 32)[0] == 200 - 30 * quarters);
      CHECK(pixel(frame, 10, 10)[0] == 200);
      CHECK(frame.ids[32 * 64 + 32] == (quarters >= 2 ? 8 : 7));
      CHECK(frame == kept(renderer->render_full(poses)));
    }
  }
}

TEST_CASE("two triangles share their edge: no sample is lost between them, none is shown twice") {
  std::mt19937 random(5);
  std::uniform_int_distribution<int> place(-3000, 20000);
  for (int round = 0; round < 300; ++round) {
    SampleBuffer buffer;
    buffer.resize(64, 64, true);
    // A quad that turns against the clock as seen, cut along either diagonal, covers the same.
    DrawnCorner corner[4];
    for (DrawnCorner& c : corner) c = {place(random), place(random), 1};
    const auto turn = [&](int a, int b, int c) {
      return (corner[b].x - corner[a].x) * (corner[c].y - corner[a].y) -
             (corner[c].x - corner[a].x) * (corner[b].y - corner[a].y);
    };
    if (turn(0, 1, 2) >= 0 || turn(1, 2, 3) >= 0 || turn(2, 3, 0) >= 0 || turn(3, 0, 1) >= 0)
      continue;
    buffer.draw(corner[0], corner[1], corner[2], 1);
    buffer.draw(corner[0], corner[2], corner[3], 1);
    SampleBuffer other;
    other.resize(64, 64, true);
    other.draw(corner[0], corner[1], corner[3], 1);
    other.draw(corner[1], corner[2], corner[3], 1);
    int differing = 0;
    for (int y = 0; y < 64; ++y) {
      for (int x = 0; x < 64; ++x)
        for (int k = 0; k < 4; ++k) differing += buffer.ids(x, y)[k] != other.ids(x, y)[k] ? 1 : 0;
    }
    CHECK(differing == 0);
  }
}

TEST_CASE("what moves over what stands still gives the bytes of a picture that is drawn whole") {
  SceneSpec spec;
  spec.camera = plain_camera(128, 96);
  spec.samples = 2;
  Lamp spot;
  spot.position = Vec3(0, 0, 2);
  spot.specular = 0.3;
  spot.exponent = 10;
  spot.cutoff_cosine = 0.5;
  Lamp head;
  head.kind = Lamp::Kind::kHeadlight;
  head.diffuse = 0.4;
  head.specular = 0.5;
  head.ambient = 0.1;
  spec.lights = lit_by({spot, head});
  auto wall = square(1.5);
  spec.statics = {visual(wall, kBackdrop, "wall")};
  spec.statics[0].origin = at(2, 0, 0);
  spec.dynamics = {visual(sphere(0.1, 24), 0, "ball"), visual(square(0.2), 1, "card"),
                   visual(sphere(0.05, 40), 2, "bead")};
  const auto kept_one = vertex_renderer(spec), whole = vertex_renderer(spec);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> side(-0.6, 0.6), far(-0.3, 2.2), turn(-3, 3);
  for (int round = 0; round < 40; ++round) {
    std::vector<Pose> poses;
    for (int i = 0; i < 3; ++i)
      poses.push_back({Vec3(far(random), side(random), side(random)),
                       Quat(Eigen::AngleAxisd(turn(random), Vec3(1, 2, 3).normalized()))});
    const auto quick = kept(kept_one->render(poses));
    CHECK(quick == kept(whole->render_full(poses)));
    CHECK(quick == kept(whole->render_from(spec.camera, poses)));
  }
}

TEST_CASE("what rests, and moves again, shows what it shows in a picture that is drawn whole") {
  SceneSpec spec;
  spec.camera = plain_camera(96, 64);
  spec.samples = 2;
  Lamp head;
  head.kind = Lamp::Kind::kHeadlight;
  head.diffuse = 0.8;
  head.ambient = 0.1;
  spec.lights = lit_by({head});
  spec.statics = {visual(square(1.5), kBackdrop, "wall")};
  spec.statics[0].origin = at(2, 0, 0);
  spec.dynamics = {visual(sphere(0.2, 24), 0, "ball"), visual(sphere(0.2, 30), 1, "other"),
                   visual(square(0.3), 2, "card")};
  const auto kept_one = vertex_renderer(spec), whole = vertex_renderer(spec);
  std::vector<Pose> poses = {at(1, 0.1, 0), at(1, -0.1, 0.05), at(1.1, 0, 0)};
  std::mt19937 random(9);
  std::uniform_int_distribution<int> which(0, 9);
  std::uniform_real_distribution<double> step(-0.05, 0.05);
  for (int frame = 0; frame < 80; ++frame) {
    CAPTURE(frame);
    // Mostly nothing moves: each comes to rest, is left beside one that moves, and moves again.
    const int moves = which(random);
    if (moves < 3) poses[static_cast<std::size_t>(moves)].position += Vec3(0, step(random), 0);
    CHECK(kept(kept_one->render(poses)) == kept(whole->render_full(poses)));
  }
}

TEST_CASE("a spot that cannot reach a mesh is left out, and one that may is not") {
  VertexMaterial material;
  material.shine = std::make_shared<const PowerTable>(32);
  Lamp spot;
  spot.position = Vec3(0, 0, 2);
  spot.cutoff_cosine = std::sqrt(0.5);
  spot.specular = 0.3;
  const auto table = LampTable::make(lit_by({spot}));
  REQUIRE(table.ok());
  LampsThere there;
  table->put(Pose{}, Vec3(0, 1, 2), Vec3(0, 0, -1), there);
  int left_out = 0;
  for (double x = 0; x < 4; x += 0.01) {
    CAPTURE(x);
    const Float3 at(static_cast<float>(x), 0, 0);
    constexpr float kRadius = 0.05f;
    if (there.lamps[0].may_reach({at, kRadius})) continue;
    ++left_out;
    // As one of much that is lit.
    const Float3 corner = at - Float3(kRadius, 0, 0), normal = Float3::UnitZ();
    std::array<float, 3> color{1, 1, 1};
    CornerArrays one{.count = 1};
    for (std::size_t k = 0; k < 3; ++k) {
      one.position[k] = corner.data() + k;
      one.normal[k] = normal.data() + k;
      one.color[k] = &color[k];
    }
    there.light(material, one, {at, 100});
    CHECK(color == std::array<float, 3>{});
  }
  CHECK(left_out > 150);
}

TEST_CASE("a floor that passes under the eye is cut there and drawn to the lower edge") {
  auto floor = colored(quad_part(Vec3(0, 0, -0.2), Vec3(0, -3, 0), Vec3(3, 0, 0)), 0.5f);
  const auto frame =
      kept(vertex_renderer(before_camera(floor, lit_by({}, 1)))->render(std::vector<Pose>{Pose{}}));
  for (int x = 0; x < 64; ++x) {
    CHECK(frame.ids[static_cast<std::size_t>(63 * 64 + x)] == 7);
    CHECK(frame.ids[static_cast<std::size_t>(10 * 64 + x)] == 0);
  }
  // z = 0.2 under the eye; row 63 looks down by 31.5 / 64.
  CHECK(frame.depth[63 * 64 + 32] == doctest::Approx(0.2 / (31.5 / 64)).epsilon(1e-4));
}

TEST_CASE("a texture from afar is the mean of its texels") {
  scene::Texture checks{64, 64, {}};
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      const std::uint8_t value = (x + y) % 2 == 0 ? 200 : 100;
      checks.rgba.insert(checks.rgba.end(), {value, value, value, 255});
    }
  }
  const MipChain chain(checks);
  CHECK(chain.at(0.3f, 0.7f, 64)[0] == doctest::Approx(150));
  CHECK(chain.at(0.5f / 64, 0.5f / 64, 0.5f)[0] == doctest::Approx(200));
  CHECK(chain.at(1.5f / 64, 0.5f / 64, 1)[0] == doctest::Approx(100));
  // Half way between the first and the second size.
  CHECK(chain.at(0.5f / 64, 0.5f / 64, std::sqrt(2.0f))[0] == doctest::Approx(175).epsilon(0.01));
  // It repeats.
  CHECK(chain.at(-0.25f, 3.75f, 0)[1] == chain.at(0.75f, 0.75f, 0)[1]);
}

TEST_CASE("what the vertex law does not have is refused by name") {
  const auto refused = [](auto change) {
    SceneSpec spec = before_camera(square(0.3), lit_by({sun_along(Vec3(1, 0, 0), 1)}));
    change(spec);
    const auto made = Renderer::create(std::move(spec));
    return made.ok() ? std::string() : made.failure().message;
  };
  CHECK(refused([](SceneSpec&) {}).empty());
  CHECK(refused([](SceneSpec& s) {
          s.photo = std::make_shared<scene::Texture>();
        }).find("no photo") != std::string::npos);
  CHECK(refused([](SceneSpec& s) { s.occlusion_rays = 4; }).find("no ambient occlusion") !=
        std::string::npos);
  CHECK(refused([](SceneSpec& s) { s.samples = 4; }).find("1 or 4 samples") != std::string::npos);
  CHECK(refused([](SceneSpec& s) {
          s.lights.lamps[0].direction = Vec3::Zero();
        }).find("direction") != std::string::npos);
  CHECK(refused([](SceneSpec& s) { s.lights.lamps[0].diffuse = -1; }).find("strength") !=
        std::string::npos);
  CHECK(refused([](SceneSpec& s) { s.lights.suns.push_back({}); }).find("no suns") !=
        std::string::npos);
  CHECK(refused([](SceneSpec& s) { s.camera.fx = 0; }) != "");
}

}  // namespace probe::render
