// What is built once: ray structures and static scenes for as long as the store, pictures for as
// long as somebody looks.
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

TEST_CASE("cameras that stand still share their static picture, and nobody keeps it for them") {
  SceneStore store;
  const SceneSpec spec = wall_and_ball();
  auto first = store.static_picture(spec);
  REQUIRE(first.ok());
  CHECK(store.static_picture(spec)->get() == first->get());
  SceneSpec dark = spec;
  dark.lights.ambient = 0.1;
  CHECK(store.static_picture(dark)->get() != first->get());
  CHECK((*first)->scene.get() == (*store.static_picture(dark))->scene.get());
  const std::weak_ptr<const StaticPicture> watched = *first;
  first = store.static_picture(dark);
  CHECK(watched.expired());
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
