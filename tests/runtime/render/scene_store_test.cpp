// What is built once: ray structures for as long as the store, static scenes and pictures for as
// long as somebody looks or there is room.
#include "runtime/render/scene_store.h"

#include <doctest/doctest.h>

#include "runtime/render/mesh_geometry.h"
#include "runtime/render/static_picture.h"
#include "runtime/render/static_scene.h"
#include "tests/runtime/render/test_scenes.h"

namespace probe::render {
namespace {

using namespace test;

SceneSpec wall_and_ball() {
  SceneSpec spec;
  spec.camera = plain_camera(64, 48);
  spec.lights.ambient = 1;
  spec.statics = {visual(square(0.4), kBackdrop, "wall")};
  spec.statics[0].origin = at(2, 0, 0);
  spec.dynamics = {visual(sphere(0.1, 16), 0, "ball")};
  return spec;
}

TEST_CASE("a ray structure outlives the renderers that asked for it, so a new task builds none") {
  const auto store = std::make_shared<SceneStore>();
  const SceneSpec spec = wall_and_ball();
  const MeshGeometry* ball = nullptr;
  const StaticScene* wall = nullptr;
  {
    const auto renderer = Renderer::create(spec, store);
    REQUIRE(renderer.ok());
    ball = store->geometries(spec.dynamics)->front().get();
    wall = store->static_scene(spec.statics)->get();
  }
  SceneSpec next = spec;  // another camera, the same things
  next.camera.position = Vec3(0.3, 0, 0);
  REQUIRE(Renderer::create(next, store).ok());
  CHECK(store->geometries(next.dynamics)->front().get() == ball);
  CHECK(store->static_scene(next.statics)->get() == wall);
  next.statics[0].body = 3;  // shown under another id
  CHECK(store->static_scene(next.statics)->get() != wall);
}

TEST_CASE("cameras that stand still share their static picture and its scene") {
  SceneStore store;
  const SceneSpec spec = wall_and_ball();
  auto first = store.static_picture(spec);
  REQUIRE(first.ok());
  CHECK(store.static_picture(spec)->get() == first->get());
  SceneSpec dark = spec;
  dark.lights.ambient = 0.1;
  CHECK(store.static_picture(dark)->get() != first->get());
  CHECK((*first)->scene.get() == (*store.static_picture(dark))->scene.get());
}

TEST_CASE("tasks that take turns find their static pictures again, and a sweep fills no memory") {
  SceneStore store;
  SceneSpec table = wall_and_ball(), sink = wall_and_ball();
  sink.camera.position = Vec3(0.2, 0, 0);
  const StaticPicture* first = store.static_picture(table)->get();
  const StaticPicture* second = store.static_picture(sink)->get();
  for (int turn = 0; turn < 3; ++turn) {
    CHECK(store.static_picture(table)->get() == first);
    CHECK(store.static_picture(sink)->get() == second);
  }
  const std::weak_ptr<const StaticPicture> watched = *store.static_picture(table);
  std::vector<std::weak_ptr<const StaticPicture>> all;
  SceneSpec large = wall_and_ball();
  large.camera = plain_camera(1024, 768);
  for (int k = 0; k < 4; ++k) {
    large.camera.position.x() = -0.01 * k;
    const auto picture = store.static_picture(large);
    REQUIRE(picture.ok());
    all.push_back(*picture);
  }
  CHECK(!watched.expired());  // small: there is room beside the large ones
  CHECK(all[0].expired());
  CHECK(all[1].expired());
  CHECK(!all[2].expired());
  CHECK(!all[3].expired());
  // What alone is larger than all that is kept is not kept.
  large.camera = plain_camera(2048, 1536);
  const std::weak_ptr<const StaticPicture> huge = *store.static_picture(large);
  CHECK(huge.expired());
  CHECK(!all[3].expired());
}

TEST_CASE("scenes that nobody holds go when there are many") {
  SceneStore store;
  SceneSpec spec = wall_and_ball();
  const auto held = store.static_scene(spec.statics);
  REQUIRE(held.ok());
  spec.statics[0].origin.position.x() = 9;
  const std::weak_ptr<const StaticScene> watched = *store.static_scene(spec.statics);
  CHECK(!watched.expired());
  for (std::size_t k = 0; k < SceneStore::kKeptScenes; ++k) {
    spec.statics[0].origin.position.x() = 3 + 0.01 * static_cast<double>(k);
    REQUIRE(store.static_scene(spec.statics).ok());
  }
  CHECK(watched.expired());
  CHECK(store.static_scene(wall_and_ball().statics)->get() != nullptr);
  CHECK(held->use_count() == 2);
}

TEST_CASE("what has no mesh is refused by name and the store goes on") {
  SceneStore store;
  SceneSpec spec = wall_and_ball();
  spec.statics[0].mesh = nullptr;
  const auto refused = store.static_scene(spec.statics);
  REQUIRE_FALSE(refused.ok());
  CHECK(refused.failure().where == "wall");
  CHECK(store.geometries(spec.dynamics).ok());
}

}  // namespace
}  // namespace probe::render
