// Each format a user may bring, as the smallest file that shows what is taken from it.
#include <doctest/doctest.h>

#include "runtime/scene/collision_mesh.h"
#include "runtime/scene/glb_writer.h"
#include "runtime/scene/image.h"
#include "runtime/scene/mesh_hash.h"
#include "runtime/scene/mesh_references.h"
#include "runtime/scene/vertex_colors.h"
#include "tests/runtime/run/temporary_folder.h"
#include "tests/runtime/scene/tiny_meshes.h"

namespace probe::scene {
namespace {

using namespace test;
using run::TemporaryFolder;
namespace fs = std::filesystem;

std::shared_ptr<const Mesh> load(const std::string& path, const MeshLimits& limits = {},
                                 const Vec3& scale = {1, 1, 1}) {
  auto mesh = load_mesh(path, scale, limits);
  REQUIRE_MESSAGE(mesh.ok(), (mesh.ok() ? "" : to_text(mesh.failure())));
  return *mesh;
}

std::string refusal(const std::string& path, const MeshLimits& limits = {}) {
  const auto mesh = load_mesh(path, {1, 1, 1}, limits);
  REQUIRE_FALSE(mesh.ok());
  CHECK(mesh.failure().where.starts_with(path));
  return to_text(mesh.failure());
}

// Largest coordinates, m.
Vec3 corner_of(const Mesh& mesh) {
  Vec3 corner = Vec3::Constant(-1e9);
  for (const MeshPart& part : mesh.parts) {
    for (std::size_t i = 0; i < part.positions.size(); i += 3) {
      corner =
          corner.cwiseMax(Vec3(part.positions[i], part.positions[i + 1], part.positions[i + 2]));
    }
  }
  return corner;
}

bool near(const Vec3& a, const Vec3& b) { return (a - b).cwiseAbs().maxCoeff() < 1e-6; }

const Vec3 kBox(kHalf[0], kHalf[1], kHalf[2]);

TEST_CASE("obj and both kinds of stl are taken in the axes they are written in, times the scale") {
  TemporaryFolder folder;
  CHECK(near(corner_of(*load(write_text(folder / "a/box.obj", obj_box()))), kBox));
  CHECK(near(corner_of(*load(write_text(folder / "a/box.stl", stl_box()))), kBox));
  CHECK(near(corner_of(*load(write_text(folder / "a/binary.stl", binary_stl_box()))), kBox));
  const std::string millimetres = write_text(folder / "a/mm.obj", obj_box("", 0.001));
  CHECK(near(corner_of(*load(millimetres, {}, {0.001, 0.001, 0.001})), kBox));
}

TEST_CASE("Collada's unit is metres afterwards and its up axis is z, unless it is to stay") {
  TemporaryFolder folder;
  CHECK(near(corner_of(*load(write_text(folder / "d/z.dae", dae_box("Z_UP")))), kBox));
  CHECK(near(corner_of(*load(write_text(folder / "d/cm.dae", dae_box("Z_UP", 0.01)))), kBox));
  // Y up: what the file calls y is z, its z points to the front.
  const std::string y_up = write_text(folder / "d/y.dae", dae_box("Y_UP"));
  CHECK(near(corner_of(*load(y_up)), {kBox.x(), kBox.z(), kBox.y()}));
  MeshLimits as_written;
  as_written.turn_up_axis = false;
  CHECK(near(corner_of(*load(y_up, as_written)), kBox));
  const std::string x_up = write_text(folder / "d/x.dae", dae_box("X_UP"));
  CHECK(near(corner_of(*load(x_up)), {kBox.y(), kBox.z(), kBox.x()}));
  const auto mesh = load(folder / "d/z.dae");
  CHECK(mesh->materials[0].base_color[1] == doctest::Approx(0.25));
}

TEST_CASE("node transforms of glTF are baked in, with the buffer in the file or beside it") {
  TemporaryFolder folder;
  const GltfBox inside = gltf_box("");
  CHECK(near(corner_of(*load(write_text(folder / "g/box.glb", glb_file(inside)))),
             kBox + Vec3(1, 0, 0)));
  const GltfBox beside = gltf_box("my%20box.bin");
  const std::string path = write_text(folder / "g/box.gltf", beside.json);
  CHECK(refusal(path).find("my box.bin") != std::string::npos);
  write_text(folder / "g/my box.bin", beside.bytes);
  const auto mesh = load(path);
  CHECK(near(corner_of(*mesh), kBox + Vec3(1, 0, 0)));
  CHECK(mesh->materials[0].base_color[0] == doctest::Approx(0.5));
  write_text(folder / "g/my box.bin", beside.bytes.substr(0, 40));
  refusal(path);
}

TEST_CASE("vertex colours are linear factors in glTF and display values elsewhere") {
  TemporaryFolder folder;
  const auto one = load(write_text(folder / "c/one.glb", glb_file(gltf_box("", {1, 0.5f, 0.25f}))));
  CHECK(one->textures.empty());  // all equal: the factor alone
  CHECK(one->materials[0].base_color[1] == doctest::Approx(0.5 * 0.25));

  std::string text;
  int i = 0;
  for (const Corner& c : box_corners()) {
    // A third of the corners red, green and blue each.
    text += "v " + number(c.x) + " " + number(c.y) + " " + number(c.z) +
            (i % 3 == 0   ? " 1 0 0\n"
             : i % 3 == 1 ? " 0 1 0\n"
                          : " 0 0 0.5\n");
    if (++i % 3 == 0) {
      text += "f " + std::to_string(i - 2) + " " + std::to_string(i - 1) + " " + std::to_string(i) +
              "\n";
    }
  }
  const auto many = load(write_text(folder / "c/many.obj", text));
  REQUIRE(many->textures.size() == 1);
  const MeshPart& part = many->parts[0];
  REQUIRE(part.uv.size() == 2 * part.positions.size() / 3);
  // At its corner each triangle shows the corner's colour, in its middle the mean.
  float u = 0, v = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::uint32_t corner = part.indices[k];
    const LinearRgb c =
        sample_texture(many->textures[0], part.uv[2 * corner], part.uv[2 * corner + 1]);
    CHECK(c.r + c.g + c.b > 0.2f);
    u += part.uv[2 * corner] / 3;
    v += part.uv[2 * corner + 1] / 3;
  }
  const LinearRgb middle = sample_texture(many->textures[0], u, v);
  CHECK(middle.r == doctest::Approx(1 / 3.0).epsilon(0.02));
  CHECK(middle.g == doctest::Approx(1 / 3.0).epsilon(0.02));
  CHECK(middle.b == doctest::Approx(kSrgbToLinear[128] / 3).epsilon(0.03));
}

TEST_CASE("the sRGB byte nearest to a linear value") {
  CHECK(to_srgb_byte(-1) == 0);
  CHECK(to_srgb_byte(2) == 255);
  for (const int byte : {0, 1, 17, 128, 254, 255}) {
    CHECK(to_srgb_byte(kSrgbToLinear[static_cast<std::size_t>(byte)]) == byte);
  }
}

TEST_CASE("the files a mesh names are found without reading it, options and blanks included") {
  TemporaryFolder folder;
  const std::string obj = write_text(folder / "r/m/box.obj", obj_box("mtllib my box.mtl\n"));
  write_text(folder / "r/m/my box.mtl",
             "newmtl a\nmap_Kd -s 1 1 1 -bm 0.5 my wood.png\nbump ../../out.png\n");
  write_text(folder / "r/m/my wood.png", "x");
  const auto references = mesh_references(obj, "");
  REQUIRE(references.ok());
  REQUIRE(references->size() == 3);
  CHECK((*references)[0].written == "my box.mtl");
  CHECK((*references)[1].path == folder / "r/m/my wood.png");
  CHECK((*references)[2].problem.find("outside") != std::string::npos);

  const std::string dae =
      write_text(folder / "r/m/box.dae", dae_box("Z_UP", 1, "file://my%20wood.png"));
  REQUIRE(mesh_references(dae, "")->size() == 1);
  CHECK(mesh_references(dae, "")->front().path == folder / "r/m/my wood.png");
  CHECK(mesh_references(write_text(folder / "r/m/box.stl", stl_box()), "")->empty());

  // A plan freezes one file a mesh.
  MeshLimits alone;
  alone.self_contained = true;
  CHECK(refusal(obj, alone).find("assets pack") != std::string::npos);
  load(write_text(folder / "r/m/plain.obj", obj_box()), alone);
}

TEST_CASE("a link that leads out of the asset folder is not followed") {
  TemporaryFolder folder;
  write_text(folder / "secret/a.mtl", "newmtl a\nKd 1 0 0\n");
  const std::string obj =
      write_text(folder / "root/m/box.obj", obj_box("mtllib a.mtl\nusemtl a\n"));
  fs::create_symlink(folder / "secret/a.mtl", folder / "root/m/a.mtl");
  MeshLimits limits;
  limits.asset_root = folder / "root";
  CHECK(refusal(obj, limits).find("link that leads out") != std::string::npos);
  // The asset folder itself may be a link.
  fs::remove(folder / "root/m/a.mtl");
  write_text(folder / "root/m/a.mtl", "newmtl a\nKd 1 0 0\n");
  fs::create_symlink(folder / "root", folder / "link");
  limits.asset_root = folder / "link";
  CHECK(load(folder / "link/m/box.obj", limits)->materials[0].base_color[1] == 0);
}

TEST_CASE("collision shapes: components of a collision obj by its indices, else by place") {
  TemporaryFolder folder;
  // The box's triangles share no index: as a picture mesh they are one box, as a collision.obj
  // twelve flat pieces, which are nothing.
  for (const char* name : {"k/box.obj", "k/box.stl", "k/box.dae"}) {
    const std::string path =
        write_text(folder / name, std::string(name).ends_with("obj")   ? obj_box()
                                  : std::string(name).ends_with("stl") ? binary_stl_box()
                                                                       : dae_box("Z_UP"));
    const auto shape = load_collision_mesh(path, {1, 1, 1});
    REQUIRE_MESSAGE(shape.ok(), (shape.ok() ? "" : to_text(shape.failure())));
    CHECK(shape->parts.size() == 1);
    CHECK(shape->volume == doctest::Approx(8 * kHalf[0] * kHalf[1] * kHalf[2]).epsilon(1e-4));
  }
  CHECK_FALSE(load_collision_mesh(write_text(folder / "k/collision.obj", obj_box()), {1, 1, 1}));
  // Two boxes apart are two parts.
  std::string two = obj_box();
  int i = 36;
  for (const Corner& c : box_corners()) {
    two += "v " + number(c.x + 1) + " " + number(c.y) + " " + number(c.z) + "\n";
    if (++i % 3 == 0) {
      two += "f " + std::to_string(i - 2) + " " + std::to_string(i - 1) + " " + std::to_string(i) +
             "\n";
    }
  }
  CHECK(load_collision_mesh(write_text(folder / "k/two.obj", two), {1, 1, 1})->parts.size() == 2);
}

TEST_CASE("a written glb is the mesh again: materials, textures as they were encoded, places") {
  TemporaryFolder folder;
  const std::vector<std::uint8_t> rgb{255, 0, 0, 0, 0, 255, 9, 9, 9, 1, 2, 3};
  fs::create_directories(folder / "w");
  REQUIRE(write_png(folder / "w/p.png", 2, 2, rgb).ok());
  const std::string path = write_text(
      folder / "w/t.obj",
      "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl a\n"
      "f 1/1 2/2 3/3\nusemtl b\nf 1 2 4\n");
  write_text(
      folder / "w/m.mtl",
      "newmtl a\nmap_Kd p.png\nKs 0.5 0.5 0.5\nNs 250\nnewmtl b\nKd 0.1 0.2 0.3\nKe 0 0.4 0\n");
  MeshLimits keep;
  keep.keep_encoded = true;
  const auto mesh = load(path, keep);
  REQUIRE(mesh->encoded.size() == mesh->textures.size());
  CHECK(mesh->encoded[0].mime == "image/png");
  const auto bytes = glb_bytes(*mesh, "t", "test");
  REQUIRE(bytes.ok());
  const auto again = load(write_text(folder / "w/t.glb", *bytes), keep);
  REQUIRE(again->parts.size() == 2);
  CHECK(again->encoded[0].bytes == mesh->encoded[0].bytes);
  CHECK(near(corner_of(*again), {1, 1, 1}));
  for (std::size_t i = 0; i < 2; ++i) {
    const Material& a = mesh->materials[static_cast<std::size_t>(mesh->parts[i].material)];
    const Material& b = again->materials[static_cast<std::size_t>(again->parts[i].material)];
    CHECK(a.roughness == b.roughness);
    CHECK(a.emission == b.emission);
    CHECK((a.base_color_texture >= 0) == (b.base_color_texture >= 0));
    if (a.base_color_texture < 0) CHECK(a.base_color == b.base_color);
  }
  CHECK(again->textures[0].width == mesh->textures[0].width);
  CHECK(again->textures[0].height == mesh->textures[0].height);
  CHECK(again->textures[0].rgba == mesh->textures[0].rgba);
  Mesh clear = *mesh;
  for (Material& material : clear.materials) material.opacity = 0.25f;
  const auto clear_bytes = glb_bytes(clear, "t", "test");
  REQUIRE(clear_bytes.ok());
  const auto still_clear = load(write_text(folder / "w/c.glb", *clear_bytes), keep);
  for (const MeshPart& part : still_clear->parts)
    CHECK(still_clear->materials[static_cast<std::size_t>(part.material)].opacity == 0.25f);
  // An alpha that no file says to blend by hides nothing.
  std::string opaque = *clear_bytes;
  for (std::size_t at = 0; (at = opaque.find("BLEND", at)) != std::string::npos; ++at)
    opaque.replace(at, 5, "OTHER");
  for (const Material& material : load(write_text(folder / "w/o.glb", opaque), keep)->materials)
    CHECK(material.opacity == 1);
}

TEST_CASE("absurd meshes and pictures are refused with the limit") {
  TemporaryFolder folder;
  CHECK(refusal(write_text(folder / "b/far.obj", "v 0 0 1e30\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"))
            .find("more than 1000 m") != std::string::npos);
  CHECK(refusal(write_text(folder / "b/point.obj", "v 1 1 1\nv 1 1 1\nv 1 1 1\nf 1 2 3\n"))
            .find("no ") != std::string::npos);
  const auto far = load_obj_triangles(
      write_text(folder / "b/collision.obj", "v 0 0 1e30\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"), {1, 1, 1});
  REQUIRE_FALSE(far.ok());
  CHECK(to_text(far.failure()) ==
        folder / "b/collision.obj:1: a vertex lies more than 1000 m from the origin");

  // A header that promises 16384 x 16384 and nothing behind it: refused before it is decoded.
  std::string png("\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\x40\0\0\0\x40\0\x08\x06\0\0\0", 29);
  png += std::string(100, 'x');
  const auto image = load_image(write_text(folder / "b/big.png", png));
  REQUIRE_FALSE(image.ok());
  CHECK(image.failure().message.find("16384 x 16384 pixels, at most 8192") != std::string::npos);
  CHECK(image.failure().where == folder / "b/big.png");
}

TEST_CASE("files cut anywhere are read or refused, never more than that") {
  TemporaryFolder folder;
  const std::string whole[] = {obj_box(), stl_box(), binary_stl_box(), dae_box("Z_UP"),
                               glb_file(gltf_box(""))};
  const char* const names[] = {"t/a.obj", "t/a.stl", "t/b.stl", "t/a.dae", "t/a.glb"};
  int refused = 0;
  for (std::size_t f = 0; f < 5; ++f) {
    for (std::size_t tenth = 0; tenth < 10; ++tenth) {
      const std::string path =
          write_text(folder / names[f], whole[f].substr(0, whole[f].size() * tenth / 10));
      const auto mesh = load_mesh(path);
      if (mesh) continue;
      ++refused;
      CHECK(mesh.failure().where == path);
    }
  }
  CHECK(refused > 25);
  CHECK(to_text(load_mesh(folder / "t/none.gltf").failure()) ==
        folder / "t/none.gltf: there is no such mesh file");
}

}  // namespace
}  // namespace probe::scene
