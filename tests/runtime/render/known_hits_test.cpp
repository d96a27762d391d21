#include "runtime/render/known_hits.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "runtime/render/scene_store.h"
#include "tests/runtime/render/test_scenes.h"

namespace probe::render {
namespace {

using namespace test;

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double unit() { return std::uniform_real_distribution<double>(-1, 1)(engine_); }
  Vec3 vec() { return {unit(), unit(), unit()}; }
  Quat turn() { return Quat(unit(), unit(), unit(), unit() + 1.5).normalized(); }

 private:
  std::mt19937 engine_;
};

void add_triangle(scene::MeshPart& part, const Vec3 (&corners)[3]) {
  for (const Vec3& p : corners) {
    part.indices.push_back(static_cast<std::uint32_t>(part.positions.size() / 3));
    for (int k = 0; k < 3; ++k) {
      part.positions.push_back(static_cast<float>(p[k]));
      part.normals.push_back(k == 0 ? -1.0f : 0.0f);
    }
  }
}

// Triangles of all sizes that cut each other; some so thin that rounding turns them over, some
// drawn twice, some a little above another, some sharing an edge.
std::shared_ptr<scene::Mesh> soup(Random& random, int count) {
  scene::MeshPart part;
  Vec3 last[3] = {Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};
  for (int i = 0; i < count; ++i) {
    const double size = std::pow(10.0, -1.5 + random.unit());
    Vec3 corners[3];
    const Vec3 middle = 0.15 * random.vec();
    for (Vec3& corner : corners) corner = middle + size * random.vec();
    switch (i % 6) {
      case 1:
        corners[2] = corners[0] + 0.7 * (corners[1] - corners[0]) +
                     std::pow(10.0, -5 + 2 * random.unit()) * random.vec();
        break;
      case 2:
        std::copy(last, last + 3, corners);
        break;
      case 3:
        for (int k = 0; k < 3; ++k) corners[k] = last[k] + Vec3(1e-4 * random.unit(), 0, 0);
        break;
      case 4:
        corners[0] = last[1];
        corners[1] = last[0];
        break;
      default:
        break;
    }
    add_triangle(part, corners);
    std::copy(corners, corners + 3, last);
  }
  return colored(std::move(part), 0.5f);
}

SceneSpec soups(Random& random, int width, int height) {
  SceneSpec spec;
  spec.camera = plain_camera(width, height);
  spec.camera.fx = spec.camera.fy = 0.8 * width;
  Visual wall = visual(square(0.5), kBackdrop, "wall");
  wall.origin = at(0.9, 0.1, 0);
  spec.statics = {wall, visual(soup(random, 60), 9, "still soup")};
  spec.statics[1].origin = at(0.8, 0, 0);
  for (std::uint16_t body = 0; body < 4; ++body) {
    spec.dynamics.push_back(visual(soup(random, 60), body, "soup"));
  }
  spec.dynamics.push_back(visual(sphere(0.1, 16), 4, "ball"));
  spec.lights = table_lights();
  return spec;
}

std::vector<Pose> poses_of(const SceneSpec& spec, Random& random) {
  std::vector<Pose> poses;
  for (std::size_t b = 0; b < spec.dynamics.size(); ++b) {
    // From behind the camera to behind the wall.
    poses.push_back(
        {Vec3(0.5 + 0.6 * random.unit(), 0.3 * random.unit(), 0.3 * random.unit()), random.turn()});
  }
  return poses;
}

TEST_CASE("what is known without rays is what rays say, however triangles lie") {
  Random random(4);
  for (int scene = 0; scene < 8; ++scene) {
    CAPTURE(scene);
    SceneSpec spec = soups(random, 160, 120);
    const auto store = std::make_shared<SceneStore>();
    auto drawn = Renderer::create(spec, store);
    auto traced = Renderer::create(spec, store);
    REQUIRE(drawn.ok());
    REQUIRE(traced.ok());
    for (int frame = 0; frame < 25; ++frame) {
      CAPTURE(frame);
      const std::vector<Pose> poses = poses_of(spec, random);
      const auto one = (*drawn)->render(poses);
      const auto two = (*traced)->render_full(poses);
      REQUIRE(one.ok());
      REQUIRE(two.ok());
      CHECK(std::ranges::equal(one->rgb, two->rgb));
      CHECK(std::ranges::equal(one->depth, two->depth));
      CHECK(std::ranges::equal(one->segmentation, two->segmentation));
    }
  }
}

TEST_CASE("a camera that moves through triangles shows what rays show") {
  Random random(8);
  SceneSpec spec = soups(random, 101, 77);
  const auto store = std::make_shared<SceneStore>();
  auto moving = Renderer::create(spec, store);
  REQUIRE(moving.ok());
  for (int look = 0; look < 100; ++look) {
    CAPTURE(look);
    SceneSpec there = spec;
    there.camera.position = Vec3(0.4 + 0.4 * random.unit(), 0.2 * random.unit(), 0);
    there.camera.forward_left_up = look_along(Vec3(1, random.unit(), 0.5 * random.unit())).value();
    const std::vector<Pose> poses = poses_of(spec, random);
    const auto seen = (*moving)->render_from(there.camera, poses);
    auto standing = Renderer::create(there, store);
    REQUIRE(seen.ok());
    REQUIRE(standing.ok());
    const auto whole = (*standing)->render_full(poses);
    REQUIRE(whole.ok());
    CHECK(std::ranges::equal(seen->rgb, whole->rgb));
    CHECK(std::ranges::equal(seen->depth, whole->depth));
    CHECK(std::ranges::equal(seen->segmentation, whole->segmentation));
  }
}

// Shares of the packets of marked blocks that need no ray, and of those whose triangle is before
// the wall.
struct Shares {
  int packets = 0, settled = 0, hits = 0;
};
Shares shares(const std::shared_ptr<scene::Mesh>& mesh, const Pose& pose) {
  const Camera camera = plain_camera(96, 96);
  SceneStore store;
  const std::vector<Visual> visuals{visual(mesh, 0, "thing")};
  auto meshes = store.geometries(visuals);
  REQUIRE(meshes.ok());
  auto scene = TopScene::create(visuals, std::move(*meshes), TopScene::Kind::kDynamic);
  REQUIRE(scene.ok());
  REQUIRE(scene->place(std::vector<Pose>{pose}).ok());
  CameraRays rays;
  REQUIRE(make_camera_rays(camera, rays).ok());
  BlockMarks marks(camera, rays);
  marks.mark(scene->instances());
  KnownHits known;
  const KnownTriangles found = known.look(scene->instances(), camera, rays, marks);
  Shares out;
  if (found.sheet == nullptr) return out;
  const std::vector<float> farthest(64, kFarthest);
  for (int y = 0; y < marks.blocks_y(); ++y) {
    for (int x = 0; x < marks.blocks_x(); ++x) {
      if (!marks.marked(x, y)) continue;
      const int tile = y / 2 * rays.tiles_x + x / 2, block = 2 * (y % 2) + x % 2;
      BlockAnswers answers;
      found.sheet->answer(x, y, farthest.data(),
                          rays.cosine.data() + kTileSamples * tile + 64 * block, answers);
      for (std::size_t p = 0; p < 8; ++p) {
        ++out.packets;
        out.settled += answers.settled(p) ? 1 : 0;
      }
      out.hits += static_cast<int>(std::ranges::count(answers.hit, 1));
    }
  }
  return out;
}

TEST_CASE("most of a plain thing is known without rays, and nothing of one drawn twice") {
  const Shares ball = shares(sphere(0.1, 12), at(1, 0, 0));
  CHECK(ball.packets > 0);
  CHECK(ball.settled > ball.packets / 2);
  CHECK(ball.hits > 200);
  scene::MeshPart twice = quad_part(Vec3::Zero(), Vec3(0, -0.2, 0), Vec3(0, 0, 0.2));
  twice.indices = {0, 2, 1, 0, 2, 1};
  CHECK(shares(colored(twice, 0.5f), at(1, 0, 0)).hits == 0);
  twice.indices = {0, 2, 1};
  CHECK(shares(colored(twice, 0.5f), at(1, 0, 0)).hits > 200);
}

TEST_CASE("what is too near for a ray or seen from its edge is left to rays") {
  CHECK(shares(square(0.2), at(0.015, 0, 0)).settled == 0);
  CHECK(shares(square(0.2), at(9.998, 0, 0)).hits == 0);
  const Pose edge{Vec3(1, 0, 0), Quat(std::sqrt(0.5), 0, 0, std::sqrt(0.5))};
  CHECK(shares(square(0.2), edge).hits == 0);
}

TEST_CASE("a board half a millimetre before another is known, one that touches it is not") {
  const auto boards = [](double gap) {
    scene::MeshPart part;
    add_triangle(part, {Vec3(0, -0.1, -0.1), Vec3(0, 0.1, -0.1), Vec3(0, 0, 0.1)});
    add_triangle(part, {Vec3(gap, -0.1, -0.1), Vec3(gap, 0.1, -0.1), Vec3(gap, 0, 0.1)});
    return shares(colored(part, 0.5f), at(0.35, 0, 0));
  };
  CHECK(boards(5e-4).settled > 0.8 * boards(5e-4).packets);
  CHECK(boards(1e-5).settled < 0.6 * boards(1e-5).packets);
}

TEST_CASE("what reaches behind the camera is known where it lies before it") {
  // A floor from behind the camera to 4 m before it, 0.2 m below.
  const scene::MeshPart floor = quad_part(Vec3(1.5, 0, -0.2), Vec3(0, -5, 0), Vec3(2.5, 0, 0));
  const Shares seen = shares(colored(floor, 0.5f), at(0, 0, 0));
  CHECK(seen.packets > 0);
  CHECK(seen.settled > 0);
  CHECK(seen.hits > 500);
}

TEST_CASE("many small triangles in few pixels are left to rays") {
  CHECK(shares(sphere(0.1, 96), at(9, 0, 0)).packets == 0);
}

}  // namespace
}  // namespace probe::render
