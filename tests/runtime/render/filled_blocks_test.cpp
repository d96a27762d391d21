#include "runtime/render/filled_blocks.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <random>

#include "runtime/render/scene_store.h"
#include "runtime/render/static_scene.h"
#include "tests/runtime/render/test_scenes.h"

namespace probe::render {
namespace {

using namespace test;

std::shared_ptr<const StaticScene> still(const std::vector<Visual>& statics) {
  SceneStore store;
  const auto scene = store.static_scene(statics);
  REQUIRE(scene.ok());
  return *scene;
}

// Two tiles a side, so four blocks a side.
Camera small_camera() {
  Camera camera = plain_camera(32, 32);
  camera.fx = camera.fy = 32;
  camera.cx = camera.cy = 16;
  return camera;
}

// Ids + 1 of what fills each block, row by row; 0 where rays have to see.
std::array<std::array<int, 4>, 4> fills(const std::vector<Visual>& statics, const Camera& camera) {
  const auto scene = still(statics);
  BlockFills search;
  search.look(scene->top, camera);
  std::array<std::array<int, 4>, 4> out{};
  for (std::size_t tile = 0; tile < 4; ++tile) {
    const FilledBlocks blocks =
        search.of_tile(static_cast<int>(tile % 2), static_cast<int>(tile / 2));
    for (std::size_t b = 0; b < 4; ++b) {
      if (!blocks[b].filled) continue;
      out[2 * (tile / 2) + b / 2][2 * (tile % 2) + b % 2] =
          scene->top.instances()[blocks[b].name.instance].id;
    }
  }
  return out;
}

// A triangle, larger than sight, `x` metres before the camera.
Visual wall(double x, std::uint16_t body) {
  scene::MeshPart part = quad_part(Vec3::Zero(), Vec3(0, -9, 0), Vec3(0, 0, 9));
  part.indices.resize(3);
  Visual out = visual(colored(std::move(part), 0.5f), body, "wall");
  out.origin = at(x, 4, -4);
  return out;
}

TEST_CASE("a wall fills the blocks in which nothing is before it") {
  const std::array<int, 4> row{7, 7, 7, 7};
  CHECK(fills({wall(1, 6), wall(2, 3)}, small_camera()) ==
        std::array<std::array<int, 4>, 4>{row, row, row, row});
  // A square of 4 pixels in the upper left block; its middle is 12 pixels left of and above the
  // picture's.
  Visual post = visual(square(0.03), 1, "post");
  post.origin = at(0.5, 0.5 * 12 / 32.0, 0.5 * 12 / 32.0);
  CHECK(fills({wall(1, 6), post}, small_camera()) ==
        std::array<std::array<int, 4>, 4>{{{0, 7, 7, 7}, row, row, row}});
  post.origin.position *= 3;  // behind the wall
  CHECK(fills({wall(1, 6), post}, small_camera()) ==
        std::array<std::array<int, 4>, 4>{row, row, row, row});
}

TEST_CASE("what is near another surface, out of reach or seen from the side fills nothing") {
  const std::array<std::array<int, 4>, 4> none{};
  CHECK(fills({wall(1, 6), wall(1, 3)}, small_camera()) == none);
  CHECK(fills({wall(1, 6), wall(1.0005, 3)}, small_camera()) == none);
  CHECK(fills({wall(9.95, 6)}, small_camera()) == none);
  CHECK(fills({wall(-1, 6)}, small_camera()) == none);
  CHECK(fills({wall(0.012, 6)}, small_camera()) == none);
  const Visual floor =
      visual(colored(quad_part(Vec3(4, 0, -0.02), Vec3(5, 0, 0), Vec3(0, 5, 0)), 0.5f), 1, "floor");
  CHECK(fills({floor}, small_camera()) == none);
}

// A room of large triangles round the camera, boards in it that cut and touch each other.
SceneSpec room() {
  SceneSpec spec;
  const auto add = [&spec](const Vec3& center, const Vec3& across, const Vec3& up) {
    const auto body = static_cast<std::uint16_t>(spec.statics.size());
    spec.statics.push_back(
        visual(colored(quad_part(center, across, up), 0.1f + 0.05f * static_cast<float>(body)),
               body, "board"));
  };
  add(Vec3(0, 0, -1), Vec3(2, 0, 0), Vec3(0, 2, 0));
  add(Vec3(0, 0, 1), Vec3(2, 0, 0), Vec3(0, -2, 0));
  for (const double side : {-2.0, 2.0}) {
    add(Vec3(side, 0, 0), Vec3(0, -side, 0), Vec3(0, 0, 1));
    add(Vec3(0, side, 0), Vec3(side, 0, 0), Vec3(0, 0, 1));
  }
  add(Vec3(0.7, 0.1, -0.3), Vec3(0, 0.4, 0.1), Vec3(0.3, 0, 0.4));
  add(Vec3(0.7, 0.1, -0.3), Vec3(0.4, 0, 0), Vec3(0, 0.3, 0.2));
  add(Vec3(0.5, -0.4, -0.999), Vec3(0.3, 0, 0), Vec3(0, 0.3, 0));   // 1 mm above the floor
  add(Vec3(-0.5, 0.4, -1), Vec3(0.3, 0.1, 0), Vec3(-0.1, 0.3, 0));  // in the floor
  spec.statics.back().origin = {Vec3(0.2, -0.1, 0), Quat(0.8, 0, 0, 0.6)};
  spec.dynamics = {visual(sphere(0.1, 16), 20, "ball")};
  spec.lights = table_lights();
  return spec;
}

TEST_CASE("pictures of a room are those of rays alone, wherever the camera is, and save many") {
  SceneSpec spec = room();
  spec.camera = plain_camera(100, 76);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto store = std::make_shared<SceneStore>();
  auto moving = Renderer::create(spec, store);
  REQUIRE(moving.ok());
  const auto scene = still(spec.statics);
  BlockFills search;
  int filled = 0, blocks = 0;
  for (int look = 0; look < 60; ++look) {
    CAPTURE(look);
    SceneSpec there = spec;
    there.camera.position = Vec3(1.5 * unit(random), 1.5 * unit(random), 0.95 * unit(random));
    there.camera.forward_left_up =
        look_along(Vec3(unit(random), unit(random), 0.7 * unit(random))).value();
    there.camera.fx = there.camera.fy = 60 + 40 * unit(random);
    const std::vector<Pose> poses{at(unit(random), unit(random), unit(random))};
    const auto seen = (*moving)->render_from(there.camera, poses);
    REQUIRE(seen.ok());
    auto standing = Renderer::create(there, store);
    REQUIRE(standing.ok());
    const auto whole = (*standing)->render_full(poses);
    REQUIRE(whole.ok());
    CHECK(std::ranges::equal(seen->rgb, whole->rgb));
    CHECK(std::ranges::equal(seen->depth, whole->depth));
    CHECK(std::ranges::equal(seen->segmentation, whole->segmentation));
    search.look(scene->top, there.camera);
    for (int tile = 0; tile < 7 * 5; ++tile) {
      const FilledBlocks found = search.of_tile(tile % 7, tile / 7);
      blocks += 4;
      filled += static_cast<int>(std::ranges::count_if(found, &FilledBlock::filled));
    }
  }
  CHECK(filled > blocks / 4);
}

TEST_CASE("a scene of many triangles is left to rays") {
  Visual ball = visual(sphere(0.1, 64), 2, "ball");
  ball.origin = at(0.5, 0.4, 0.4);
  CHECK(fills({wall(1, 6), ball}, small_camera()) == std::array<std::array<int, 4>, 4>{});
}

}  // namespace
}  // namespace probe::render
