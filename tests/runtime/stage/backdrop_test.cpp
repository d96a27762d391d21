#include "runtime/stage/backdrop.h"

#include <doctest/doctest.h>

#include "runtime/scene/mesh_import.h"

namespace probe::stage {
namespace {

const std::array<double, 4> kArea{-0.2, -0.2, 0.2, 0.2};

void add_level(scene::Mesh& mesh, double z, const std::array<double, 4>& at) {
  scene::MeshPart part;
  for (const auto& [x, y] :
       {std::pair{at[0], at[1]}, {at[2], at[1]}, {at[2], at[3]}, {at[0], at[3]}}) {
    for (const double value : {x, y, z}) part.positions.push_back(static_cast<float>(value));
    for (const float value : {0.0F, 0.0F, 1.0F}) part.normals.push_back(value);
  }
  part.indices = {0, 1, 2, 0, 2, 3};
  mesh.parts.push_back(part);
  mesh.materials.resize(1);
}

TEST_CASE(
    "the table is what most plumb lines meet first, not the floor below or a shelf above a part") {
  scene::Mesh mesh;
  add_level(mesh, 0, {-5, -5, 5, 5});
  add_level(mesh, 0.75, {-0.3, -0.5, 0.15, 0.5});
  add_level(mesh, 1.2, {-0.3, 0.1, 0.3, 0.2});
  CHECK(table_height({&mesh}, {}, kArea).value() == doctest::Approx(0.75));
  CHECK(table_height({&mesh, Vec3(0, 0, -0.1)}, {}, kArea).value() == doctest::Approx(0.65));
}

TEST_CASE(
    "of an area that is wider than its table, the table is the level nearest to the surface") {
  scene::Mesh mesh;
  add_level(mesh, 0.72, {-5, -5, 5, 5});
  add_level(mesh, 0.87, {-0.3, -0.5, 0.15, 0.5});
  const std::array<double, 4> wide = {-0.6, -0.9, 0.6, 0.9};
  CHECK(table_height({&mesh}, {}, wide).value() == doctest::Approx(0.72));
  CHECK(table_height({&mesh}, {}, wide, 0.9).value() == doctest::Approx(0.87));
  CHECK(table_height({&mesh}, {}, kArea, 0.8).value() == doctest::Approx(0.87));
  CHECK_FALSE(table_height({&mesh}, {}, wide, 1.5));
}

TEST_CASE("places that a fixture covers say nothing of the backdrop, and nothing is no table") {
  scene::Mesh bench, basin, walls;
  add_level(bench, 0.869, {-0.3, -0.5, 0.3, 0.5});
  add_level(basin, 0.05, {-0.2, -0.2, 0.1, 0.2});
  const SeenMesh sink{&basin, Vec3(0, 0, 0.88)};
  CHECK(table_height({&bench}, sink, kArea).value() == doctest::Approx(0.869));
  add_level(basin, 0.05, {0, -0.2, 0.2, 0.2});
  CHECK_FALSE(table_height({&bench}, sink, kArea));
  CHECK_FALSE(table_height({&walls}, {}, kArea));
  CHECK_FALSE(table_height({}, {}, kArea));
}

TEST_CASE("a heap has no height of its own") {
  scene::Mesh heap;
  for (int k = 0; k < 20; ++k) {
    add_level(heap, 0.7 + 0.01 * k, {-0.2 + 0.02 * k, -0.2, -0.18 + 0.02 * k, 0.2});
  }
  CHECK_FALSE(table_height({&heap}, {}, kArea));
}

TEST_CASE(
    "a backdrop is lifted by what is missing, but not by a hair and not from the floor of a room") {
  CHECK(backdrop_lift(0.87, 0.82) == doctest::Approx(-0.05));
  CHECK(backdrop_lift(0.87, 0.93) == doctest::Approx(0.06));
  CHECK(backdrop_lift(0.869, 0.87) == 0);
  CHECK(backdrop_lift(0.0, 0.75) == 0);
  CHECK(backdrop_lift(std::nullopt, 0.75) == 0);
}

TEST_CASE("a backdrop that stands moves as far as its scene moved the surface, its table or not") {
  plan::SceneRecord scene;
  scene.surface_z = scene.backdrop_z = 0.43676;
  scene.backdrop_stands = 1;
  CHECK(backdrop_lift(scene, 0.42492) == 0);
  scene.surface_z += 0.05;
  CHECK(backdrop_lift(scene, 0.42492) == doctest::Approx(0.05));
  CHECK(backdrop_lift(scene, std::nullopt) == doctest::Approx(0.05));
  scene.backdrop_stands = 0;
  CHECK(backdrop_lift(scene, 0.42492) == doctest::Approx(0.06184));
}

TEST_CASE("the tables of our own scenes lie where their surfaces are") {
  for (const auto& [name, area, z] :
       {std::tuple{"table", std::array{-0.34, -0.20, 0.04, 0.20}, 0.87},
        {"sink", std::array{-0.34, -0.12, 0.04, 0.36}, 0.869}}) {
    const auto mesh =
        scene::load_mesh(VLAPROBE_SOURCE_DIR "/assets/scenes/" + std::string(name) + "/visual.glb");
    REQUIRE(mesh.ok());
    const auto sink = scene::load_mesh(VLAPROBE_SOURCE_DIR "/assets/fixtures/sink/visual.glb");
    REQUIRE(sink.ok());
    const bool covered = std::string(name) == "sink";
    const auto height = table_height(
        {mesh->get()}, {covered ? sink->get() : nullptr, Vec3(-0.16, 0.13, 0.88)}, area);
    REQUIRE(height.has_value());
    CHECK(*height == doctest::Approx(z).epsilon(1e-4));
  }
}

TEST_CASE("the floor of a room is covered where things stand on it, too") {
  scene::Texture plain;
  plain.width = plain.height = 1;
  plain.rgba = {10, 20, 30, 255};
  const std::array floor{Cover{plan::CoverOf::kFloor, &plain, 0.4}};
  const std::array<double, 4> all{-2, -2, 2, 2};
  scene::Mesh room;
  add_level(room, 0.017, all);
  CHECK(covered_backdrop(room, {}, kArea, 0.017, floor).ok());
  add_level(room, 0.87, kArea);
  CHECK(covered_backdrop(room, {}, kArea, 0.87, floor).ok());
  // A table on legs has no floor.
  scene::Mesh table;
  add_level(table, 0.87, kArea);
  table.parts[0].positions.insert(table.parts[0].positions.end(), {0.1F, 0.1F, 0.2F});
  table.parts[0].normals.insert(table.parts[0].normals.end(), {0.0F, 0.0F, 1.0F});
  table.parts[0].indices.insert(table.parts[0].indices.end(), {0, 1, 4});
  CHECK_FALSE(covered_backdrop(table, {}, kArea, 0.87, floor).ok());
}

}  // namespace
}  // namespace probe::stage
