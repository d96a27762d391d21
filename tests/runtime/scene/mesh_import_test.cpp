#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>

#include "runtime/scene/color.h"
#include "runtime/scene/image.h"
#include "runtime/scene/mesh_hash.h"
#include "runtime/scene/mesh_import.h"

namespace probe::scene {
namespace {

namespace fs = std::filesystem;

std::string write(const std::string& name, const std::string& text) {
  const fs::path path = fs::path(VLAPROBE_BINARY_DIR) / "tests" / "mesh_import_test" / name;
  fs::create_directories(path.parent_path());
  std::ofstream(path, std::ios::binary) << text;
  return path.string();
}

std::shared_ptr<const Mesh> load(const std::string& path, const Vec3& scale = {1, 1, 1}) {
  Result<std::shared_ptr<const Mesh>> mesh = load_mesh(path, scale);
  REQUIRE_MESSAGE(mesh.ok(), (mesh.ok() ? "" : to_text(mesh.failure())));
  return mesh.value();
}

std::string refusal(const std::string& path, const MeshLimits& limits = {}) {
  const Result<std::shared_ptr<const Mesh>> mesh = load_mesh(path, {1, 1, 1}, limits);
  REQUIRE_FALSE(mesh.ok());
  CHECK(mesh.failure().code == Fault::kAsset);
  CHECK(mesh.failure().where.find(path) == 0);
  return to_text(mesh.failure());
}

const std::string kTriangle =
    "mtllib m.mtl\nusemtl a\nv 1 2 3\nv 11 2 3\nv 1 12 3\nvt 0 1\nvt 1 1\nvt 0 0\nvn 0 0 1\n"
    "f 1/1/1 2/2/1 3/3/1\n";

TEST_CASE("an obj gives scaled positions, normals, and v counted from the top") {
  const std::string path = write("plain/t.obj", kTriangle);
  write("plain/m.mtl", "newmtl a\nKd 0.1 0.2 0.3\nKe 0.4 0 0\nKs 0.5 0.5 0.5\nNs 250\n");
  const auto mesh = load(path, {0.001, 0.001, 0.001});
  REQUIRE(mesh->parts.size() == 1);
  const MeshPart& part = mesh->parts[0];
  REQUIRE(part.positions.size() == 9);
  CHECK(part.positions[3 * part.indices[1]] == doctest::Approx(0.011));
  CHECK(part.normals[2] == 1.0f);
  CHECK(part.uv[2 * part.indices[0] + 1] == 0.0f);
  CHECK(part.uv[2 * part.indices[2] + 1] == 1.0f);
  const Material& material = mesh->materials[static_cast<std::size_t>(part.material)];
  CHECK(material.base_color[1] == doctest::Approx(0.2));
  CHECK(material.emission[0] == doctest::Approx(0.4));
  CHECK(material.roughness == doctest::Approx(1 - 0.5 * 0.5));
  CHECK(material.metallic == 0);
}

TEST_CASE("a mesh without normals gets flat ones, and mirroring keeps them unit") {
  const std::string path = write("flat/t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 1\nf 1 2 3\n");
  const auto mesh = load(path, {-2, 1, 1});
  const MeshPart& part = mesh->parts[0];
  for (std::size_t v = 0; v < 3; ++v) {
    const Vec3 n(part.normals[3 * v], part.normals[3 * v + 1], part.normals[3 * v + 2]);
    CHECK(n.norm() == doctest::Approx(1));
    CHECK(std::abs(n.z()) == doctest::Approx(std::sqrt(0.5)));
    CHECK(n.x() == 0.0);
  }
}

TEST_CASE("a texture without coordinates becomes the colour at its wrapped corner") {
  const std::string path =
      write("fold/meshes/t.obj", "mtllib m.mtl\nusemtl a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  write("fold/meshes/m.mtl", "newmtl a\nKd 1 1 1\nmap_Kd ../four.png\n");
  const std::vector<std::uint8_t> rgb{0, 0, 0, 255, 255, 255, 0, 0, 0, 255, 0, 0};
  REQUIRE(write_png(fs::path(path).parent_path().parent_path() / "four.png", 2, 2, rgb).ok());
  const auto mesh = load(path);
  const Material& material = mesh->materials[static_cast<std::size_t>(mesh->parts[0].material)];
  CHECK(material.base_color_texture == -1);
  CHECK(mesh->textures.empty());
  CHECK(material.base_color[0] == doctest::Approx(0.5));
  CHECK(material.base_color[1] == doctest::Approx(0.25));
}

TEST_CASE("a texture that varies is kept, once") {
  const std::string path = write("keep/t.obj", kTriangle);
  write("keep/m.mtl", "newmtl a\nKd 0 0 0\nmap_Kd p.png\nmap_Ke p.png\n");
  REQUIRE(write_png(fs::path(path).parent_path() / "p.png", 1, 2, std::vector<std::uint8_t>(6, 9))
              .ok());
  const auto mesh = load(path);
  CHECK(mesh->textures.size() == 1);
  CHECK(mesh->materials[0].base_color_texture == 0);
  CHECK(mesh->materials[0].emission_texture == 0);
}

TEST_CASE("texture paths that are absolute, escape the asset folder or lead nowhere are refused") {
  const std::string path = write("deep/meshes/t.obj", kTriangle);
  write("deep/meshes/m.mtl", "newmtl a\nmap_Kd /etc/black.png\n");
  CHECK(refusal(path).find("relative") != std::string::npos);
  write("deep/meshes/m.mtl", "newmtl a\nmap_Kd ../../black.png\n");
  CHECK(refusal(path).find("outside") != std::string::npos);
  write("deep/meshes/m.mtl", "newmtl a\nmap_Kd ../black.png\n");
  CHECK(refusal(path).find("../black.png") != std::string::npos);
  // A narrower asset root refuses what the default allows.
  const std::string root = fs::path(path).parent_path().string();
  CHECK(refusal(path, {.asset_root = root}).find("outside") != std::string::npos);
}

std::string bytes_of(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::string chunk(std::string body, const char (&type)[5], char filler) {
  while (body.size() % 4 != 0) body += filler;
  const auto size = static_cast<std::uint32_t>(body.size());
  return std::string(reinterpret_cast<const char*>(&size), 4) + std::string(type, 4) + body;
}

TEST_CASE(
    "a glb with embedded textures gives its colours, and roughness and metallic by their means") {
  const std::string folder = fs::path(write("glb/x.txt", "")).parent_path().string();
  // Colour: red above, blue below. Surface: G 64 and 192, B 255 and 0.
  REQUIRE(write_png(folder + "/c.png", 1, 2, std::vector<std::uint8_t>{255, 0, 0, 0, 0, 255}).ok());
  REQUIRE(
      write_png(folder + "/s.png", 1, 2, std::vector<std::uint8_t>{0, 64, 255, 0, 192, 0}).ok());
  const std::string color = bytes_of(folder + "/c.png"), surface = bytes_of(folder + "/s.png");
  const float vertices[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, /* uv */ 0, 0, 1, 0, 0, 1};
  std::string data(reinterpret_cast<const char*>(vertices), sizeof vertices);
  const std::size_t color_at = data.size(), surface_at = color_at + color.size();
  data += color + surface;
  const std::string json = R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],
"nodes":[{"mesh":0,"scale":[2,2,2]}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0,"TEXCOORD_0":1},"material":0}]}],
"materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0},"metallicRoughnessTexture":{"index":1},
"metallicFactor":1,"roughnessFactor":1}}],
"textures":[{"source":0},{"source":1}],
"images":[{"bufferView":2,"mimeType":"image/png"},{"bufferView":3,"mimeType":"image/png"}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]},
{"bufferView":1,"componentType":5126,"count":3,"type":"VEC2"}],
"bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":24},
{"buffer":0,"byteOffset":)" +
                           std::to_string(color_at) + R"(,"byteLength":)" +
                           std::to_string(color.size()) + R"(},{"buffer":0,"byteOffset":)" +
                           std::to_string(surface_at) + R"(,"byteLength":)" +
                           std::to_string(surface.size()) + R"(}],"buffers":[{"byteLength":)" +
                           std::to_string(data.size()) + "}]}";
  const std::string body = chunk(json, "JSON", ' ') + chunk(data, "BIN\0", '\0');
  const auto total = static_cast<std::uint32_t>(12 + body.size());
  const std::string file =
      std::string("glTF\2\0\0\0", 8) + std::string(reinterpret_cast<const char*>(&total), 4) + body;
  const auto mesh = load(write("glb/t.glb", file));
  REQUIRE(mesh->parts.size() == 1);
  float widest = 0;
  for (const float x : mesh->parts[0].positions) widest = std::max(widest, x);
  CHECK(widest == 2.0f);  // the node's scale is baked in
  const Material& material = mesh->materials[static_cast<std::size_t>(mesh->parts[0].material)];
  CHECK(material.roughness == doctest::Approx(128 / 255.0));
  CHECK(material.metallic == doctest::Approx(0.5));
  REQUIRE(mesh->textures.size() == 1);  // the surface texture is not kept
  CHECK(mesh->textures[0].rgba[0] == 255);
  CHECK(mesh->textures[0].rgba[4] == 0);
  // v counts from the top in glTF and here.
  const MeshPart& part = mesh->parts[0];
  for (std::size_t v = 0; v < 3; ++v) CHECK(part.uv[2 * v + 1] == part.positions[3 * v + 1] / 2);
  refusal(write("glb/cut.glb", file.substr(0, file.size() / 2)));
}

TEST_CASE("Collada files are not turned and their emission colours are read") {
  const std::string path = write("dae/t.dae", R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="meter" meter="1"/><up_axis>Z_UP</up_axis></asset>
<library_effects><effect id="e"><profile_COMMON><technique sid="common"><lambert>
<emission><color>0.2 0.4 0.3 1</color></emission><diffuse><color>0 0 0 1</color></diffuse>
</lambert></technique></profile_COMMON></effect></library_effects>
<library_materials><material id="m"><instance_effect url="#e"/></material></library_materials>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="pa" count="9">0 0 0 1 0 0 0 0 2</float_array><technique_common>
<accessor source="#pa" count="3" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles material="m" count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node><instance_geometry url="#g"><bind_material>
<technique_common><instance_material symbol="m" target="#m"/></technique_common></bind_material>
</instance_geometry></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>)");
  const auto mesh = load(path);
  float top = 0;
  for (std::size_t i = 2; i < 9; i += 3) top = std::max(top, mesh->parts[0].positions[i]);
  CHECK(top == 2.0f);
  const Material& material = mesh->materials[static_cast<std::size_t>(mesh->parts[0].material)];
  CHECK(material.emission[1] == doctest::Approx(0.4));
  CHECK(material.base_color[0] == 0.0f);
}

TEST_CASE("bad mesh files are refused by name") {
  const fs::path folder = fs::path(write("bad/x.txt", "")).parent_path();
  CHECK(refusal((folder / "missing.obj").string()).find("no such mesh file") != std::string::npos);
  CHECK(refusal((folder / "x.txt").string()).find("glb, gltf, obj, dae and stl") != std::string::npos);
  refusal(write("bad/empty.obj", ""));
  refusal(write("bad/empty.glb", ""));
  refusal(write("bad/short.glb", std::string("glTF\2\0\0\0\xff\0\0\0", 12)));
  refusal(write("bad/cut.dae", "<?xml version=\"1.0\"?><COLLADA><asset>"));
  refusal(write("bad/cut.stl", std::string(80, ' ') + std::string("\x05\0\0\0", 4) + "abc"));
  refusal(write("bad/points.obj", "v 0 0 0\nv 1 0 0\np 1\nl 1 2\n"));
  CHECK(
      refusal(write("bad/nan.obj", "v 0 0 nan\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")).find("not finite") !=
      std::string::npos);
  const std::string two =
      write("bad/two.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\n");
  CHECK(refusal(two, {.triangles = 1}).find("more than 1 triangles") != std::string::npos);
  CHECK_FALSE(load_mesh(two, {1, 0, 1}).ok());
  CHECK_FALSE(load_mesh(two, {1, std::nan(""), 1}).ok());
}

TEST_CASE("the content hash depends on what is drawn and not on the name") {
  Mesh mesh;
  mesh.materials.emplace_back();
  mesh.parts.push_back(
      {0, {0, 0, 0, 1, 0, 0, 0, 1, 0}, {0, 0, 1, 0, 0, 1, 0, 0, 1}, {}, {0, 1, 2}});
  const Sha256 before = mesh_hash(mesh);
  mesh.name = "elsewhere.obj";
  CHECK(mesh_hash(mesh) == before);
  mesh.materials[0].roughness = 0.5f;
  CHECK(mesh_hash(mesh) != before);
  mesh.materials[0].roughness = 1;
  mesh.parts[0].positions[4] = 1e-9f;
  CHECK(mesh_hash(mesh) != before);
  mesh.parts[0].positions[4] = 0;
  CHECK(mesh_hash(mesh) == before);
  mesh.materials[0].opacity = 0.5f;
  CHECK(mesh_hash(mesh) != before);
}

}  // namespace
}  // namespace probe::scene
