// Damaged files of every format that is read: they are taken or refused with a reason, whatever
// was changed in them. What the importer itself could not stand is kept here by hand.
#include <doctest/doctest.h>

#include <cmath>
#include <map>

#include "runtime/base/large.h"
#include "runtime/scene/collision_mesh.h"
#include "runtime/scene/image.h"
#include "runtime/scene/mesh_import.h"
#include "tests/runtime/run/temporary_folder.h"
#include "tests/runtime/scene/mutate.h"
#include "tests/runtime/scene/tiny_meshes.h"

namespace probe::scene {
namespace {

using namespace test;
using run::TemporaryFolder;

// 16 x 16 pixels, baseline, as PIL wrote them.
constexpr std::string_view kJpeg =
    "ffd8ffe000104a46494600010100000100010000ffdb0043001b12141714111b1716171e1c1b2028422b28252528"
    "513a3d3042605565645f555d5b6a7899816a7190735b5d85b586909ea3abadab6780bcc9baa6c799a8aba4ffdb00"
    "43011c1e1e2823284e2b2b4ea46e5d6ea4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4"
    "a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4ffc00011080010001003012200021101031101ffc40015000101"
    "00000000000000000000000000000405ffc40017100003010000000000000000000000000000030461ffc4001501"
    "010100000000000000000000000000000104ffc4001811000203000000000000000000000000000004010212ffda"
    "000c03010002110311003f0090a9b062a5c1699b07a65c268b685664ffd9";

std::string from_hex(std::string_view hex) {
  std::string bytes;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 2) {
    bytes += static_cast<char>(std::stoi(std::string(hex.substr(i, 2)), nullptr, 16));
  }
  return bytes;
}

std::string file_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  REQUIRE(at != std::string::npos);
  return text.replace(at, what.size(), by);
}

// Every index is one of its table, every coordinate a number.
bool is_whole(const Mesh& mesh) {
  bool whole = !mesh.parts.empty() && !mesh.materials.empty();
  for (const MeshPart& part : mesh.parts) {
    const std::size_t vertices = part.positions.size() / 3;
    whole = whole && part.normals.size() == 3 * vertices && part.indices.size() % 3 == 0 &&
            (part.uv.empty() || part.uv.size() == 2 * vertices) &&
            static_cast<std::size_t>(part.material) < mesh.materials.size();
    for (const std::uint32_t i : part.indices) whole = whole && i < vertices;
    for (const float x : part.positions) whole = whole && std::isfinite(x);
    for (const float x : part.normals) whole = whole && std::isfinite(x);
  }
  for (const Material& material : mesh.materials) {
    for (const int texture : {material.base_color_texture, material.emission_texture})
      whole = whole && texture < static_cast<int>(mesh.textures.size());
  }
  return whole;
}

TEST_CASE("thousands of damaged meshes and pictures are taken whole or refused with a reason") {
  TemporaryFolder folder;
  std::vector<std::uint8_t> rgb;
  for (int i = 0; i < 3 * 16 * 16; ++i) rgb.push_back(static_cast<std::uint8_t>(7 * i));
  std::filesystem::create_directories(folder / "f");
  REQUIRE(write_png(folder / "f/t.png", 16, 16, rgb).ok());
  write_text(folder / "f/m.mtl", "newmtl a\nKd 1 0 0\nmap_Kd t.png\n");
  write_text(folder / "f/box.bin", gltf_box("").bytes);
  const std::string png = file_of(folder / "f/t.png"), jpeg = from_hex(kJpeg);
  REQUIRE(load_image(write_text(folder / "f/whole.jpg", jpeg)).ok());
  const std::string lists = replaced(
      replaced(replaced(dae_box("X_UP"), "<triangles", "<polylist"), "</triangles", "</polylist"),
      "<p>", "<vcount>3 3 3 3 3 3 3 3 3 3 3 3</vcount><p>");
  const std::map<std::string, std::string> seeds = {
      {"a.obj", obj_box("mtllib m.mtl\nusemtl a\n")},
      {"collision.obj", obj_box()},
      {"a.stl", stl_box()},
      {"b.stl", binary_stl_box()},
      {"a.dae", dae_box("Z_UP")},
      {"b.dae", dae_box("Y_UP", 0.01, "t.png")},
      {"c.dae", lists},
      {"a.glb", glb_file(gltf_box(""))},
      {"b.glb", glb_file(gltf_box("", {1, 0, 0.5f}))},
      {"c.glb", file_of(VLAPROBE_SOURCE_DIR "/assets/objects/small_plate/visual.glb")},
      {"a.gltf", gltf_box("box.bin").json},
      {"a.png", png},
      {"a.jpg", jpeg}};
  constexpr std::uint64_t kEach = 300;
  int taken = 0, refused = 0;
  for (const auto& [name, whole] : seeds) {
    const std::string path = folder / "f/" + name;
    const bool is_image = name.ends_with("png") || name.ends_with("jpg");
    const auto tally = [&](const auto& read) {
      if (read.ok()) {
        ++taken;
        return;
      }
      ++refused;
      CHECK(read.failure().code == Fault::kAsset);
      CHECK(!read.failure().message.empty());
      CHECK_MESSAGE(read.failure().where.starts_with(path), read.failure().where);
    };
    write_text(path, whole);
    const bool is_fine = is_image ? load_image(path).ok() : load_mesh(path).ok();
    REQUIRE_MESSAGE(is_fine, name);
    for (std::uint64_t number = 0; number < kEach; ++number) {
      CAPTURE(name);
      CAPTURE(number);
      write_text(path, mutated(whole, 1'000'003 * number + 7));
      if (is_image) {
        tally(load_image(path));
        continue;
      }
      const auto mesh = load_mesh(path);
      tally(mesh);
      if (mesh.ok()) CHECK(is_whole(**mesh));
      tally(load_triangles(path, {1, 1, 1}));
    }
  }
  CHECK(taken > 500);
  CHECK(refused > 500);
  MESSAGE(taken << " taken, " << refused << " refused");
}

TEST_CASE("counts that a mesh file states and does not keep are refused before they are believed") {
  TemporaryFolder folder;
  const auto says = [&](const std::string& name, const std::string& bytes,
                        const std::string& reason) {
    const std::string path = write_text(folder / "c/" + name, bytes);
    const auto mesh = load_mesh(path);
    REQUIRE_FALSE(mesh.ok());
    CHECK(mesh.failure().where == path);
    CHECK_MESSAGE(mesh.failure().message.find(reason) != std::string::npos, mesh.failure().message);
  };
  const std::string dae = dae_box("Z_UP");
  // The importer takes what is no number for 0 and then reads beyond the array.
  says("a.dae", replaced(dae, "count=\"108\"", "count=\"inf\""),
       "`count` of <float_array> is `inf`");
  says("b.dae", replaced(dae, "count=\"108\"", "count=\"107\""),
       "takes 108 values of `pa`, which has 107");
  says("c.dae", replaced(dae, "count=\"108\"", "count=\"109\""),
       "says it has 109 values and has 108");
  says("d.dae", replaced(dae, "stride=\"3\"", "stride=\"9\""), "takes 318 values");
  says("e.dae", replaced(dae, "stride=\"3\"", "stride=\"99999999999\""), "`stride` of <accessor>");
  // Here it adds zeros until there is no memory left.
  says("f.dae", replaced(dae, "<p>0 1", "<p>0 x"), "<p> lists whole numbers and has `x`");
  says("g.dae", dae.substr(0, dae.size() - 5), "the last tag does not end");
  // And here it takes as much memory as it is told.
  std::string glb = glb_file(gltf_box(""));
  std::memcpy(glb.data() + 12, "\xff\xff\xff\x7f", 4);
  says("a.glb", glb, "a chunk of 2147483647 bytes at byte 12 ends beyond the file");
  says("b.glb", glb_file({"[1]", ""}), "is no JSON object");
  write_text(folder / "c/x.bin", gltf_box("").bytes);
  says("a.gltf", replaced(gltf_box("x.bin").json, "\"count\":36", "\"count\":-1"),
       "`count` of `accessors` 0 is -1");
}

TEST_CASE("a mesh of a million triangles is read, one more is the stated limit") {
  TemporaryFolder folder;
  const auto stl = [](std::uint32_t triangles) {
    std::string out(80, ' ');
    out.append(reinterpret_cast<const char*>(&triangles), 4);
    for (std::uint32_t i = 0; i < triangles; ++i) {
      const float x = static_cast<float>(i % 1000) / 1000, y = static_cast<float>(i / 1000) / 1000;
      const float facet[12] = {0, 0, 1, x, y, 0, x + 1e-3f, y, 0, x, y + 1e-3f, 0};
      out.append(reinterpret_cast<const char*>(facet), sizeof facet);
      out.append(2, '\0');
    }
    return out;
  };
  const std::string path = write_text(folder / "m/million.stl", stl(1'000'000));
  const auto mesh = load_mesh(path);
  REQUIRE_MESSAGE(mesh.ok(), (mesh.ok() ? "" : to_text(mesh.failure())));
  CHECK((*mesh)->parts[0].indices.size() == 3'000'000);
  write_text(path, stl(1'000'001));
  const auto more = load_mesh(path);
  REQUIRE_FALSE(more.ok());
  CHECK(to_text(more.failure()) == path + ": more than 1000000 triangles" + large_hint());
}

}  // namespace
}  // namespace probe::scene
