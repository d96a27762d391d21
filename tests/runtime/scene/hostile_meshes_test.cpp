// Files that are small and cost their reader all it has: each is a failure that names the file,
// after at most the time and memory that reading may take.
#include <doctest/doctest.h>

#include <functional>
#include <string>
#include <vector>

#include "runtime/base/json.h"
#include "runtime/base/large.h"
#include "runtime/scene/image.h"
#include "runtime/scene/mesh_import.h"
#include "tests/runtime/run/temporary_folder.h"
#include "tests/runtime/scene/tiny_meshes.h"

namespace probe::scene {
namespace {

using namespace test;

constexpr float kTriangle[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};

// One triangle; `change` gets the description before it is written.
std::string one_triangle(const std::function<void(Json&)>& change, const std::string& more = "") {
  Json root = Json::parse(R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
    "nodes": [{"mesh": 0}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
    "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 36}],
    "buffers": [{"byteLength": 36}]})");
  std::string bytes(reinterpret_cast<const char*>(kTriangle), sizeof kTriangle);
  bytes += more;
  root["buffers"][0]["byteLength"] = bytes.size();
  change(root);
  return glb_file({root.dump(), bytes});
}

struct Refusals {
  run::TemporaryFolder folder;
  MeshLimits limits{.cpu_s = 1};

  std::string of(const std::string& name, const std::string& bytes) const {
    const std::string path = write_text(folder / "h/" + name, bytes);
    const auto mesh = load_mesh(path, {1, 1, 1}, limits);
    REQUIRE_FALSE(mesh.ok());
    CHECK(mesh.failure().code == Fault::kAsset);
    CHECK(mesh.failure().where.starts_with(path));
    return mesh.failure().message;
  }
};

TEST_CASE("a mesh that makes its reader crash is a failure that names the file") {
  const Refusals refusal;
  const std::string plain = write_text(refusal.folder / "h/a.glb", one_triangle([](Json&) {}));
  REQUIRE(load_mesh(plain).ok());
  const std::string deep =
      "{\"asset\":{\"version\":\"2.0\"},\"extras\":" + std::string(2'000'000, '[') +
      std::string(2'000'000, ']') + "}";
  CHECK(refusal.of("json.glb", glb_file({deep, ""})).find("glTF description") != std::string::npos);
  CHECK(refusal.of("nodes.glb", one_triangle([](Json& root) {
                     root["nodes"] = Json::array();
                     for (int i = 0; i < 150'000; ++i)
                       root["nodes"].push_back({{"children", Json::array({i + 1})}});
                     root["nodes"].push_back({{"mesh", 0}});
                   })) == "the mesh makes its reader crash (SIGSEGV)");
  CHECK(refusal.of("skins.glb", one_triangle([](Json& root) {
                     root["skins"] = Json::array();
                     for (int i = 0; i < 100; ++i)
                       root["skins"].push_back({{"joints", Json::array({0})}});
                     root["nodes"][0]["skin"] = 99;
                   })) == "the mesh makes its reader crash (SIGSEGV)");
  // The next one is read as ever.
  CHECK(load_mesh(plain).ok());
}

TEST_CASE("a mesh that takes too much time or memory is given up") {
  const Refusals refusal;
  // Which of the two it meets first depends on the machine.
  const auto is_given_up = [&](const std::string& name, const std::string& bytes) {
    const std::string why = refusal.of(name, bytes);
    return why == "the mesh takes more than 1 s of computing" + large_hint() ||
           why == "the mesh cannot be read within 2048 MiB of memory" + large_hint();
  };
  CHECK(is_given_up("tree.glb", one_triangle([](Json& root) {
                      root["nodes"] = Json::array();
                      for (int i = 0; i < 26; ++i)
                        root["nodes"].push_back({{"children", Json::array({i + 1, i + 1})}});
                      root["nodes"].push_back({{"mesh", 0}});
                    })));
  CHECK(is_given_up("skin.dae", R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit meter="1"/><up_axis>Z_UP</up_axis></asset><library_controllers><controller id="c">
<skin source="#c"><bind_shape_matrix>1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1</bind_shape_matrix></skin>
</controller></library_controllers><library_visual_scenes><visual_scene id="s"><node id="n">
<instance_controller url="#c"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>)"));
  std::string materials, faces = "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\n";
  for (int i = 0; i < 50'000; ++i) {
    materials += "newmtl m" + std::to_string(i) + "\nKd 1 0 0\n";
    faces += "usemtl m" + std::to_string(i) + "\nf 1 2 3\n";
  }
  write_text(refusal.folder / "h/m.mtl", materials);
  CHECK(is_given_up("materials.obj", faces));
  std::string star, corners = "f";
  for (int i = 0; i < 30'000; ++i) {
    star += "v " + number(i * 0.01) + " " + number(i % 2 == 0 ? 0 : 1 + i % 7) + " 0\n";
    corners += " " + std::to_string(i + 1);
  }
  CHECK(is_given_up("polygon.obj", star + corners + "\n"));
#ifndef __SANITIZE_ADDRESS__
  const std::string sparse =
      refusal.of("sparse.glb", one_triangle([](Json& root) {
                   root["accessors"][0] = Json::parse(R"({"componentType": 5126, "count": 300000000,
      "type": "VEC3", "sparse": {"count": 3, "indices": {"bufferView": 0, "componentType": 5125},
      "values": {"bufferView": 0}}})");
                 }));
  CHECK_MESSAGE(sparse.find("MiB of memory") != std::string::npos, sparse);
#endif
}

TEST_CASE("one picture that a mesh names many times is not decoded for ever") {
  Refusals refusal;
  refusal.limits.cpu_s = 10;
  constexpr int kSide = 4096;
  const auto png = png_bytes(kSide, kSide, std::vector<std::uint8_t>(3 * kSide * kSide));
  REQUIRE(png.ok());
  const auto name_often = [&](Json& root) {
    Json view = Json::object();
    view["buffer"] = 0;
    view["byteOffset"] = sizeof kTriangle;
    view["byteLength"] = png->size();
    root["bufferViews"].push_back(view);
    for (const char* table : {"images", "textures", "materials"}) root[table] = Json::array();
    Json& primitives = root["meshes"][0]["primitives"];
    primitives = Json::array();
    for (int i = 0; i < 24; ++i) {
      root["images"].push_back(Json::parse(R"({"bufferView": 1, "mimeType": "image/png"})"));
      root["textures"].push_back(Json::parse("{\"source\": " + std::to_string(i) + "}"));
      root["materials"].push_back(
          Json::parse(R"({"pbrMetallicRoughness": {"baseColorTexture": {"index": )" +
                      std::to_string(i) + "}}}"));
      primitives.push_back(
          Json::parse(R"({"attributes": {"POSITION": 0}, "material": )" + std::to_string(i) + "}"));
    }
  };
  CHECK(refusal.of("pictures.glb", one_triangle(name_often, *png)) ==
        "the mesh's pictures have more than 100663296 pixels in all" + large_hint());
}

TEST_CASE("a mesh names at most a thousand other files") {
  const Refusals refusal;
  std::string materials;
  for (int i = 0; i < 100'000; ++i) {
    materials += "newmtl m" + std::to_string(i) + "\nmap_Kd " + std::to_string(i) + ".png\n";
  }
  write_text(refusal.folder / "h/m.mtl", materials);
  std::string libraries;
  for (int i = 0; i < 100'000; ++i) libraries += "mtllib m.mtl\n";
  CHECK(refusal.of("many.obj", obj_box(libraries)) == "names more than 1024 other files");
}

TEST_CASE("numbers of an OBJ file may begin with their point") {
  const run::TemporaryFolder folder;
  const std::string path =
      write_text(folder / "h/point.obj",
                 "v .05 0 0\nv 1 -.5 0\nv 0 +.25 1e-1\nvt .5 .5\nvt 0 0\nvt 1 .5\nf 1/1 2/2 3/3\n");
  const auto mesh = load_mesh(path);
  REQUIRE_MESSAGE(mesh.ok(), (mesh ? "" : to_text(mesh.failure())));
  const std::vector<float> wanted = {0.05f, 0, 0, 1, -0.5f, 0, 0, 0.25f, 0.1f};
  CHECK((*mesh)->parts[0].positions == wanted);
}

}  // namespace
}  // namespace probe::scene
