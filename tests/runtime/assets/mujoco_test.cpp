#include "runtime/assets/mujoco.h"

#include <doctest/doctest.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <span>
#include <sstream>

#include <nlohmann/json.hpp>

#include "compiler/emit/compile.h"
#include "runtime/assets/mujoco_folder.h"
#include "runtime/assets/mujoco_thing.h"
#include "runtime/base/file.h"
#include "runtime/base/large.h"
#include "runtime/mjcf/read.h"
#include "runtime/plan/plan.h"
#include "runtime/robot/urdf.h"
#include "runtime/scene/collision_mesh.h"
#include "runtime/scene/image.h"
#include "runtime/scene/mesh_import.h"
#include "runtime/show/preview.h"
#include "tests/runtime/mjcf/mjcf_files.h"

namespace probe::assets {
namespace {

namespace fs = std::filesystem;
using mjcf::MjcfFolder;

// Left half red, right half green, 4 x 2 pixels.
std::string red_and_green() {
  std::vector<std::uint8_t> rgb;
  for (int i = 0; i < 8; ++i) {
    const bool left = i % 4 < 2;
    for (const int value : {left ? 255 : 0, left ? 0 : 255, 0})
      rgb.push_back(static_cast<std::uint8_t>(value));
  }
  return *scene::png_bytes(4, 2, rgb);
}

// A cup in robosuite's form: a mesh to be seen, two boxes to be felt, the upper half as heavy, a
// turned box as a site.
constexpr const char* kCup = R"(<mujoco model="cup">
  <asset>
    <texture file="cup.png" name="tex" type="2d"/>
    <material name="mat" texture="tex" specular="0.1"/>
    <mesh file="cup.msh" name="cup_vis" scale="0.1 0.1 0.1"/>
  </asset>
  <worldbody>
    <body>
      <body name="object" pos="0 -0.1 0">
        <geom type="mesh" mesh="cup_vis" material="mat" contype="0" conaffinity="0" group="1"/>
        <geom type="box" size="0.03 0.03 0.02" pos="0 0 -0.02" density="100" friction="0.95 0.3 0.1"/>
        <geom type="box" size="0.03 0.03 0.02" pos="0 0 0.02" density="100" friction="0.95 0.3 0.1"/>
        <site name="inside" type="box" size="0.02 0.02 0.03" pos="0 0 0.01"/>
        <site name="dot" size="0.01"/>
      </body>
      <site name="bottom_site" pos="0 0 -0.04" size="0.005"/>
    </body>
  </worldbody>
</mujoco>)";

void write_cup(const MjcfFolder& folder, const std::string& text = kCup) {
  folder.write("cup.xml", text);
  folder.write("cup.msh", mjcf::box_msh(0.3f, 0.3f, 0.4f, true));
  folder.write("cup.png", red_and_green());
  folder.write("base.xml",
               "<mujoco><compiler angle=\"radian\" inertiagrouprange=\"0 0\"/></mujoco>");
}

MujocoOptions cup_options(const MjcfFolder& folder) {
  MujocoOptions options;
  options.file = folder.path("cup.xml");
  options.merged_into = folder.path("base.xml");
  return options;
}

MujocoAsset converted(const MujocoOptions& options) {
  const auto asset = convert_mujoco(options);
  INFO((asset ? std::string() : to_text(asset.failure())));
  REQUIRE(asset.ok());
  return *asset;
}

std::string failure_of(const MjcfFolder& folder, const MujocoOptions& options) {
  const auto asset = convert_mujoco(options);
  REQUIRE(!asset.ok());
  std::string text = to_text(asset.failure());
  for (auto at = text.find(folder.path()); at != text.npos; at = text.find(folder.path()))
    text.erase(at, folder.path().size());
  return text;
}

const MujocoFile& file_of(const MujocoAsset& asset, const std::string& path) {
  for (const MujocoFile& file : asset.files) {
    if (file.path == path) return file;
  }
  FAIL("no file " << path);
  return asset.files.front();
}

scene::Mesh mesh_of(const MjcfFolder& folder, const MujocoAsset& asset, const std::string& path) {
  const auto mesh = scene::load_mesh(
      folder.write("made/" + fs::path(path).filename().string(), file_of(asset, path).bytes));
  INFO((mesh ? std::string() : to_text(mesh.failure())));
  REQUIRE(mesh.ok());
  return **mesh;
}

TEST_CASE(
    "one mesh in ever more geoms is refused by its triangles, which are made something of each "
    "time") {
  const MjcfFolder folder;
  write_cup(folder);
  const auto model = mjcf::read_model(folder.path("cup.xml"));
  REQUIRE_MESSAGE(model.ok(), to_text(model.failure()));
  MujocoMeshes meshes(*model, scene::MeshLimits());
  int uses = 0;
  auto mesh = meshes.get(0);
  for (; mesh.ok() && uses < 2'000'000; mesh = meshes.get(0)) ++uses;
  REQUIRE(!mesh.ok());
  CHECK(mesh.failure().message ==
        "the meshes of all geoms together have more than 20 million triangles");
  CHECK(uses == 20'000'000 / 12);
}

TEST_CASE(
    "an object is seen by its mesh with its texture, felt by its boxes, and declared with its "
    "density") {
  const MjcfFolder folder;
  write_cup(folder);
  const MujocoAsset cup = converted(cup_options(folder));
  CHECK(cup.kind == MujocoKind::kObject);
  CHECK(cup.declaration ==
        "object cup {\n"
        "  mesh \"cup\"\n"
        "  box (-3cm, -3cm, -4cm) .. (3cm, 3cm, 4cm)\n"
        "  density 100kg/m3; friction 0.95; name \"cup\"\n"
        "  region inside box (-2cm, -2cm, -2cm) .. (2cm, 2cm, 4cm)\n"
        "}\n");
  CHECK(cup.notes.empty());
  MujocoOptions damped = cup_options(folder);
  damped.free_damping = 0.0005;
  CHECK(converted(damped).declaration.find(
            "name \"cup\"\n  damping 0.0005Ns/m 0.0005Nms/rad\n  region") != std::string::npos);
  CHECK(cup.mass == doctest::Approx(0.0288));
  CHECK(cup.center_of_mass.norm() < 1e-12);
  CHECK(cup.friction == 0.95);
  REQUIRE(cup.sites.size() == 3);
  CHECK(cup.sites[0].region == "inside");
  CHECK(cup.sites[1].region.empty());
  CHECK(cup.sites[2].name == "bottom_site");
  CHECK(cup.sites[2].outside);
  CHECK(cup.sites[2].pose.position.z() == -0.04);
  REQUIRE(cup.files.size() == 2);
  const std::string obj =
      folder.write("made/collision.obj", file_of(cup, "objects/cup/collision.obj").bytes);
  const auto shape = scene::load_collision_mesh(obj, {1, 1, 1});
  REQUIRE(shape.ok());
  CHECK(shape->parts.size() == 2);
  CHECK(shape->volume == doctest::Approx(0.000288));
  const scene::Mesh seen = mesh_of(folder, cup, "objects/cup/visual.glb");
  REQUIRE(seen.textures.size() == 1);
  CHECK(seen.textures[0].width == 4);
  float highest = 0;
  for (const scene::MeshPart& part : seen.parts) {
    CHECK(part.uv.size() / 2 == part.positions.size() / 3);
    for (std::size_t i = 2; i < part.positions.size(); i += 3)
      highest = std::max(highest, part.positions[i]);
  }
  CHECK(highest == doctest::Approx(0.04f));
}

TEST_CASE("a box that stands twice weighs twice in an object, and is felt once in a fixture") {
  const MjcfFolder folder;
  std::string text = kCup;
  const std::string lower =
      "<geom type=\"box\" size=\"0.03 0.03 0.02\" pos=\"0 0 -0.02\" density=\"100\"/>";
  text.replace(text.find("<site name=\"inside\""), 0, lower);
  write_cup(folder, text);
  MujocoOptions options = cup_options(folder);
  const MujocoAsset cup = converted(options);
  CHECK(cup.mass == doctest::Approx(0.0432));
  CHECK(cup.declaration.find("density 100kg/m3;") != std::string::npos);
  const std::string place = folder.path("cup.xml:10: ");
  CHECK(cup.notes[0] ==
        place + "1 geom stands where another of the same size does: all are felt, as all weigh");
  options.kind = MujocoKind::kFixture;
  CHECK(converted(options).notes[0] ==
        place + "1 geom stands where another of the same size does: felt once");
}

TEST_CASE("what is not spread evenly has its mass, its centre and its moments") {
  const MjcfFolder folder;
  std::string text = kCup;
  const std::string upper = "pos=\"0 0 0.02\" density=\"100\"";
  text.replace(text.find(upper), upper.size(), "pos=\"0 0 0.02\" density=\"300\"");
  write_cup(folder, text);
  const MujocoAsset cup = converted(cup_options(folder));
  CHECK(cup.mass == doctest::Approx(0.0576));
  CHECK(cup.center_of_mass.z() == doctest::Approx(0.01));
  CHECK(cup.notes.empty());
  // Two boxes of 14.4 and 43.2 g, 2 cm below and above the middle.
  CHECK(cup.declaration.find("  mass 0.0576kg com (0cm, 0cm, 1cm) inertia (4.224e-05kgm2, "
                             "4.224e-05kgm2, 3.456e-05kgm2); friction 0.95; name \"cup\"\n") !=
        std::string::npos);
}

TEST_CASE("alone, without the model that it is merged into, its picture weighs as well") {
  const MjcfFolder folder;
  write_cup(folder);
  MujocoOptions options = cup_options(folder);
  options.merged_into.clear();
  CHECK(converted(options).mass == doctest::Approx(0.0288 + 1000 * 8 * 0.03 * 0.03 * 0.04));
}

TEST_CASE("the same model is the same files") {
  const MjcfFolder folder;
  write_cup(folder);
  const MujocoAsset a = converted(cup_options(folder)), b = converted(cup_options(folder));
  REQUIRE(a.files.size() == b.files.size());
  for (std::size_t i = 0; i < a.files.size(); ++i) {
    CHECK(a.files[i].path == b.files[i].path);
    CHECK(a.files[i].bytes == b.files[i].bytes);
  }
  CHECK(a.declaration == b.declaration);
}

constexpr const char* kCupboard = R"(<mujoco>
  <worldbody>
    <body name="cupboard" pos="1 2 3">
      <geom type="box" size="0.2 0.1 0.01" density="500"/>
      <body name="shelf" pos="0 0 0.1">
        <geom type="box" size="0.2 0.1 0.01" density="500"/>
        <site name="on_shelf" type="box" pos="0 0 0.05" size="0.1 0.05 0.04"/>
        <body name="drawer" pos="0 0 0.1" euler="0 0 90">
          <inertial pos="0 0 0.01" mass="3" diaginertia="1 1 1"/>
          <joint name="drawer" type="slide" axis="0 1 0" range="-0.16 0.01" damping="50" frictionloss="2" armature="0.1"/>
          <geom type="box" size="0.1 0.05 0.01" friction="0.5"/>
          <geom type="cylinder" size="0.01 0.02" pos="0 0.06 0"/>
          <site name="in_drawer" type="box" size="0.1 0.05 0.04"/>
          <site name="slanted" type="box" size="0.1 0.05 0.04" pos="0 0 0.01" euler="30 0 0"/>
        </body>
        <body name="knob" pos="0.1 0 0">
          <joint name="turn" pos="0.02 0 0" axis="1 0 0" range="0 90" ref="30" stiffness="2" springref="10"/>
          <geom type="capsule" size="0.01 0.02"/>
        </body>
      </body>
    </body>
  </worldbody>
</mujoco>)";

TEST_CASE("a fixture is a URDF with a link a joint, its joints, parts and regions a declaration") {
  const MjcfFolder folder;
  MujocoOptions options;
  options.file = folder.write("cupboard.xml", kCupboard);
  options.folder = "mine/cupboard";
  const MujocoAsset made = converted(options);
  CHECK(made.kind == MujocoKind::kFixture);
  CHECK(made.declaration ==
        "fixture cupboard {\n"
        "  urdf \"fixtures/mine/cupboard/cupboard.urdf\"; at (0cm, 0cm, 0cm)\n"
        "  friction 1\n"
        "  joint drawer friction 2N damping 50Ns/m armature 0.1kg\n"
        "  joint turn stiffness 2Nm/rad at 10deg\n"
        "  part drawer_part link drawer_part name \"drawer\"\n"
        "  part knob link knob name \"knob\"\n"
        "  region on_shelf of cupboard box (-10cm, -5cm, 11cm) .. (10cm, 5cm, 19cm)\n"
        "  region in_drawer of drawer_part box (-10cm, -5cm, -4cm) .. (10cm, 5cm, 4cm)\n"
        "  region slanted of drawer_part box (-10cm, -5cm, -4cm) .. (10cm, 5cm, 4cm) at (0cm, 0cm, "
        "1cm) roll 30deg\n"
        "}\n");
  std::string notes;
  for (const std::string& note : made.notes) notes += note.substr(folder.path().size()) + "\n";
  CHECK(notes ==
        "cupboard.xml:11: 1 cylinder is felt as polyhedra whose corners lie on them\n"
        "cupboard.xml:18: 1 capsule is felt as polyhedra whose corners lie on them\n"
        "cupboard.xml: friction differs by geom (0.5 of 1, 1 of 4), 1 is taken for all\n");
  for (const MujocoFile& file : made.files) folder.write("assets/" + file.path, file.bytes);
  const auto urdf = robot::load_urdf(folder.path("assets/fixtures/mine/cupboard/cupboard.urdf"));
  INFO((urdf ? std::string() : to_text(urdf.failure())));
  REQUIRE(urdf.ok());
  REQUIRE(urdf->links.size() == 3);
  // Two boards of 8 cm3 ... in one link, the upper 10 cm higher.
  CHECK(urdf->links[0].mass == doctest::Approx(2 * 0.4 * 0.2 * 0.02 * 500));
  CHECK(urdf->links[0].center_of_mass.z() == doctest::Approx(0.05));
  CHECK(urdf->links[0].primitives.size() == 2);
  CHECK(urdf->links[1].mass == 3);
  CHECK(urdf->links[1].inertia(0, 0) == doctest::Approx(1));
  CHECK(urdf->links[1].collisions.size() == 1);
  const robot::Joint& drawer = urdf->joints[0];
  CHECK(drawer.kind == robot::JointKind::kPrismatic);
  CHECK(drawer.lower == -0.16);
  CHECK(drawer.upper == 0.01);
  CHECK((drawer.origin.position - Vec3(0, 0, 0.2)).norm() < 1e-12);
  CHECK((drawer.origin.rotation * Vec3::UnitX() - Vec3::UnitY()).norm() < 1e-12);
  // At its reference of 30 degrees the knob is as the file has it: at 0 it is turned back.
  const robot::Joint& knob = urdf->joints[1];
  CHECK((knob.origin.position - Vec3(0.12, 0, 0.1)).norm() < 1e-12);
  CHECK((knob.origin.rotation * Vec3::UnitY() - Vec3(0, std::sqrt(0.75), -0.5)).norm() < 1e-9);
  CHECK(knob.upper == doctest::Approx(1.5707963267948966));
  // A tenth of a millimetre around it: it stands as in the file when it is turned by 30 degrees.
  CHECK(made.high.z() == doctest::Approx(0.22));
  REQUIRE(made.joints.size() == 2);
  CHECK(made.joints[0].part == "drawer_part");
  CHECK(made.joints[0].slides);
}

TEST_CASE("a site that code shows by a joint is a link of its own, seen alone") {
  const MjcfFolder folder;
  MujocoOptions options;
  options.file = folder.write("cupboard.xml", kCupboard);
  options.glows = {{"on_shelf", "drawer", -0.1}};
  const MujocoAsset made = converted(options);
  CHECK(made.declaration.find("  shown on_shelf_glow while drawer >= -10cm\n}\n") !=
        std::string::npos);
  for (const MujocoFile& file : made.files) folder.write("assets/" + file.path, file.bytes);
  const auto urdf = robot::load_urdf(folder.path("assets/fixtures/cupboard/cupboard.urdf"));
  REQUIRE_MESSAGE(urdf.ok(), (urdf ? std::string() : to_text(urdf.failure())));
  const int link = urdf->find_link("on_shelf_glow");
  REQUIRE(link >= 0);
  CHECK_FALSE(urdf->links[static_cast<std::size_t>(link)].can_collide());
  CHECK(urdf->links[static_cast<std::size_t>(link)].visuals.size() == 1);
  for (const auto& [site, joint, said] :
       {std::tuple{"nowhere", "drawer", "no site `nowhere`, which is to be shown"},
        {"on_shelf", "nothing", "no joint `nothing`, which is to show a site"}}) {
    options.glows = {{site, joint, 0}};
    // A stove without its disc is a stove.
    const MujocoAsset without = converted(options);
    CHECK(without.declaration.find("shown") == std::string::npos);
    CHECK(without.notes.back().ends_with(said));
  }
}

// Corners by position, with their texture coordinates.
template <typename Use>
void each_corner(const scene::Mesh& mesh, const Use& use) {
  for (const scene::MeshPart& part : mesh.parts) {
    REQUIRE(part.uv.size() / 2 == part.positions.size() / 3);
    for (std::size_t i = 0; i < part.positions.size() / 3; ++i)
      use(Vec3(part.positions[3 * i], part.positions[3 * i + 1], part.positions[3 * i + 2]),
          Vec3(part.normals[3 * i], part.normals[3 * i + 1], part.normals[3 * i + 2]),
          part.uv[2 * i], part.uv[2 * i + 1]);
  }
}

TEST_CASE(
    "generated texture coordinates are MuJoCo's: 1.5 pictures a metre, or the whole picture on "
    "each face") {
  const MjcfFolder folder;
  folder.write("cup.png", red_and_green());
  const auto wall = [&](const std::string& texture, const std::string& material) {
    MujocoOptions options;
    options.kind = MujocoKind::kBackdrop;
    options.name = "room";
    options.file = folder.write(
        "room.xml", "<mujoco><asset><texture name=\"t\" file=\"cup.png\" " + texture +
                        "/><material name=\"m\" texture=\"t\" " + material +
                        "/></asset><worldbody><geom type=\"box\" size=\"1.5 2 0.01\" pos=\"0 0 5\" "
                        "material=\"m\"/></worldbody></mujoco>");
    const MujocoAsset room = converted(options);
    CHECK(room.declaration.empty());
    return mesh_of(folder, room, "scenes/room/visual.glb");
  };
  std::size_t corners = 0;
  each_corner(wall("type=\"2d\"", "texrepeat=\"3 3\" texuniform=\"true\""),
              [&](const Vec3& p, const Vec3&, float u, float v) {
                ++corners;
                CHECK(u == doctest::Approx(1.5 * p.x() - 0.5));
                CHECK(v == doctest::Approx(-1.5 * p.y() - 0.5));
              });
  CHECK(corners == 6 * 25);
  each_corner(wall("type=\"2d\"", "texrepeat=\"2 1\""),
              [&](const Vec3& p, const Vec3&, float u, float v) {
                CHECK(u == doctest::Approx(p.x() / 1.5 - 0.5));
                CHECK(v == doctest::Approx(-0.5 * p.y() / 2 - 0.5));
              });
  std::array<int, 4> seen{};
  each_corner(wall("type=\"cube\"", ""), [&](const Vec3& p, const Vec3& n, float u, float v) {
    if (n.z() < 0.5) return;  // the upper face: x to the right, y upwards in the picture
    CHECK(u == doctest::Approx((p.x() / 1.5 + 1) / 2).epsilon(1e-5));
    CHECK(v == doctest::Approx((1 - p.y() / 2) / 2).epsilon(1e-5));
    ++seen[(u > 0.5f ? 1u : 0u) + (v > 0.5f ? 2u : 0u)];
  });
  for (const int quarter : seen) CHECK(quarter > 0);
}

constexpr const char* kRoom = R"(<mujoco>
  <worldbody>
    <geom name="floor" type="plane" size="3 2 0.1" group="1"/>
    <body name="table" pos="0 0 0.4" euler="0 0 90">
      <geom name="table_felt" type="box" size="0.4 0.4 0.4" friction="0.6 0.005 0.0001"/>
      <geom name="table_seen" type="box" size="0.4 0.4 0.4" contype="0" conaffinity="0" group="1"/>
      <site name="table_top" pos="0 0 0.4"/>
    </body>
    <body name="door"><joint/><geom size="0.1" group="1"/></body>
  </worldbody>
</mujoco>)";

TEST_CASE(
    "a room is a backdrop, and what is felt in it are surfaces with their height and friction") {
  const MjcfFolder folder;
  MujocoOptions options;
  options.kind = MujocoKind::kBackdrop;
  options.file = folder.write("room.xml", kRoom);
  options.changes = {{"table", Vec3(1, 0, 0.875), {}, {}, {}},
                     {"table_felt", {}, Vec3(0.5, 0.6, 0.025), 0.7, {}},
                     {"table_seen", {}, Vec3(0.5, 0.6, 0.025), {}, {}}};
  const MujocoAsset room = converted(options);
  REQUIRE(room.surfaces.size() == 2);
  CHECK(room.surfaces[0].name == "floor");
  CHECK(room.surfaces[0].top == 0);
  CHECK(room.surfaces[0].half == Vec3(3, 2, 0));
  const MujocoSurface& table = room.surfaces[1];
  CHECK(table.body == "table");
  CHECK(table.friction == 0.7);
  CHECK(table.top == doctest::Approx(0.9));
  CHECK((table.pose.position - Vec3(1, 0, 0.875)).norm() < 1e-12);
  CHECK((table.pose.rotation * Vec3::UnitX() - Vec3::UnitY()).norm() < 1e-12);
  REQUIRE(room.sites.size() == 1);
  REQUIRE(room.notes.size() == 1);
  CHECK(room.notes[0] == folder.path("room.xml:9: body `door` moves and is left out"));
  float left = 0, high = 0;
  const scene::Mesh seen = mesh_of(folder, room, "scenes/room/visual.glb");
  for (const scene::MeshPart& part : seen.parts) {
    for (std::size_t i = 0; i < part.positions.size(); i += 3) {
      left = std::min(left, part.positions[i]);
      high = std::max(high, part.positions[i + 2]);
    }
  }
  CHECK(left == -3.0f);
  CHECK(high == doctest::Approx(0.9f));
  options.changes = {{"chair", Vec3(0, 0, 0), {}, {}, {}}};
  CHECK(failure_of(folder, options) ==
        "room.xml: 0 bodies and geoms are called `chair`, which is to be changed");
}

TEST_CASE("a colour on a texture is in its pixels, clear geoms are told") {
  const MjcfFolder folder;
  std::string text = kCup;
  text.replace(text.find("specular"), 8, "rgba=\"0.5 0.5 0.5 1\" specular");
  text.replace(text.find("<site name=\"dot\""), 0,
               "<geom type=\"sphere\" size=\"0.01\" contype=\"0\" conaffinity=\"0\" group=\"1\" "
               "rgba=\"1 1 1 0.2\"/>");
  write_cup(folder, text);
  MujocoAsset cup = converted(cup_options(folder));
  scene::Mesh seen = mesh_of(folder, cup, "objects/cup/visual.glb");
  REQUIRE(seen.textures.size() == 1);
  CHECK(seen.textures[0].rgba[0] == 128);
  REQUIRE(cup.notes.size() == 1);
  CHECK(cup.notes[0] == folder.path("cup.xml:14: a geom of opacity 0.2 is drawn as one of 0.25"));
  const auto clearest = [&] {
    float least = 1;
    for (const scene::Material& material : seen.materials)
      least = std::min(least, material.opacity);
    return least;
  };
  CHECK(clearest() == 0.2f);
  text.replace(text.find("1 1 1 0.2"), 9, "1 1 1 0.1");
  write_cup(folder, text);
  cup = converted(cup_options(folder));
  seen = mesh_of(folder, cup, "objects/cup/visual.glb");
  REQUIRE(cup.notes.size() == 1);
  CHECK(cup.notes[0] == folder.path("cup.xml:14: a geom of opacity 0.1 is not drawn"));
  CHECK(clearest() == 1);
}

TEST_CASE("bad models are refused with what is wrong and where") {
  const MjcfFolder folder;
  const auto cup = [&](const std::string& from, const std::string& to) {
    std::string text = kCup;
    text.replace(text.find(from), from.size(), to);
    write_cup(folder, text);
    return failure_of(folder, cup_options(folder));
  };
  CHECK(cup("cup.png", "none.png") == "cup.xml:3: texture `none.png`: no such file");
  CHECK(cup("cup.png", "cup.msh").starts_with("cup.xml:3: texture `cup.msh`: "));
  CHECK(cup("cup.msh", "none.msh") == "cup.xml:5: mesh `none.msh`: no such file");
  CHECK(cup("<site name=\"inside\"", "<joint/><site name=\"inside\"") ==
        "cup.xml:13: a joint that moves the thing itself");
  CHECK(cup("<site name=\"dot\" size=\"0.01\"/>",
            "<body name=\"lid\"><joint type=\"ball\"/></body>") ==
        "cup.xml:14: a ball or a free joint within a thing");
  CHECK(cup("<site name=\"dot\" size=\"0.01\"/>", "<body><joint/><joint/></body>") ==
        "cup.xml:14: a second joint of one body: each has a link of its own here");
  CHECK(cup("<worldbody>", "<worldbody><body/>") ==
        "cup.xml:1: the world has 2 bodies, expected one: the thing");
  // 9,000 pixels across, told by the header alone.
  std::string huge = red_and_green();
  for (const std::size_t at : {18u, 22u}) {
    huge[at] = 0x23;
    huge[at + 1] = 0x28;
  }
  std::uint32_t crc = 0xffffffff;  // of the header, as PNG has it
  for (std::size_t i = 12; i < 29; ++i) {
    crc ^= static_cast<std::uint8_t>(huge[i]);
    for (int k = 0; k < 8; ++k) crc = (crc >> 1) ^ (crc & 1 ? 0xedb88320u : 0u);
  }
  for (std::size_t i = 0; i < 4; ++i) huge[29 + i] = static_cast<char>(~crc >> (24 - 8 * i));
  write_cup(folder);
  folder.write("cup.png", huge);
  CHECK(failure_of(folder, cup_options(folder)) ==
        "cup.xml:3: texture `cup.png`: the image has 9000 x 9000 pixels, at most 8192 a side are "
        "read" +
            large_hint());
  write_cup(folder,
            "<mujoco><worldbody><body><geom size=\"1\" contype=\"0\" "
            "conaffinity=\"0\"/></body></worldbody></mujoco>");
  CHECK(failure_of(folder, cup_options(folder)) == "cup.xml: nothing of it can be touched");
  MujocoOptions object;
  object.kind = MujocoKind::kObject;
  object.file = folder.write("cupboard.xml", kCupboard);
  CHECK(failure_of(folder, object) ==
        "cupboard.xml:10: an object whose parts move on joints: it can only be a fixture");
}

// Our own assets and texts with what was made beside them.
TEST_CASE("a text that uses what was made is checked without a word and drawn") {
  const MjcfFolder folder;
  write_cup(folder);
  const fs::path source = VLAPROBE_SOURCE_DIR;
  fs::create_directories(folder.path("all"));
  for (const char* part : {"objects", "robots", "scenes", "textures"})
    fs::copy(source / "assets" / part, folder.path(std::string("all/") + part),
             fs::copy_options::recursive);
  fs::create_directories(folder.path("texts"));
  for (const auto& entry : fs::directory_iterator(source / "suite")) {
    if (entry.path().extension() == ".probe") fs::copy(entry.path(), folder.path("texts"));
  }
  std::string cupboard = kCupboard;  // without the turned site
  const auto slanted = cupboard.find("<site name=\"slanted\"");
  cupboard.erase(slanted, cupboard.find("/>", slanted) + 2 - slanted);
  const std::string files[] = {folder.path("cup.xml"), folder.write("cupboard.xml", cupboard)};
  MujocoFolderOptions options;
  options.files.assign(std::begin(files), std::end(files));
  options.to = folder.path("made");
  options.merged_into = folder.path("base.xml");
  const auto made = make_mujoco_folder(options);
  INFO((made ? std::string() : to_text(made.failure())));
  REQUIRE(made.ok());
  CHECK(made->lines[0].word == "object");
  CHECK(made->lines[0].text == "cup  2 files, 0.0 MB; 6 x 6 x 8 cm, 28.8 g");
  CHECK(made->lines[1].word == "fixture");
  CHECK(!make_mujoco_folder(options).ok());  // it is there
  for (const char* part : {"objects", "fixtures"})
    fs::copy(folder.path(std::string("made/") + part), folder.path(std::string("all/") + part),
             fs::copy_options::recursive);
  for (const char* text : {"cup.probe", "cupboard.probe"})
    fs::copy(folder.path(std::string("made/") + text), folder.path("texts"));
  const std::string text = folder.write("texts/try.probe", R"(use "panda.probe"
use "cup.probe"
use "cupboard.probe"
fixture mine like cupboard { at (-10cm, -35cm, 91cm) }
object my_cup like cup { unseen }
scene desk like panda_table { surface 90cm area (-45cm, -45cm) .. (25cm, 45cm); fixture mine; camera agentview }
layout one { cells spots = grid 1 x 2 at (-15cm, 15cm) spread (0cm, 17cm); place source, target in distinct spots; drop 10cm settle 0.5s }
task t { scene desk; layout one; metrics put_loose; say put; horizon 300 steps; source my_cup; target plate }
suite tried trained on bridge_v2 { tasks { t }; seeds 42 }
)");
  CompileOptions compile{.asset_root = folder.path("all"),
                         .library_folders = {VLAPROBE_SOURCE_DIR "/dsl"}};
  auto built = build(std::span(&text, 1), compile);
  REQUIRE(built.ok());
  std::string found;
  for (const Diagnostic& diagnostic : built->diagnostics.items())
    found += diagnostic.message + "\n";
  CHECK(found == "");
  REQUIRE(built->ok);
  const auto plan = plan::Plan::from_bytes(std::move(built->plan));
  REQUIRE(plan.ok());
  const std::string png = folder.path("start.png");
  const auto task = plan->find_task("t");
  REQUIRE(task.has_value());
  const auto drawn = show::write_start(*plan, *task, 0, png, folder.path("all"));
  INFO((drawn ? std::string() : to_text(drawn.failure())));
  REQUIRE(drawn.ok());
  const auto picture = scene::load_image(png);
  REQUIRE(picture.ok());
  // The cup stands there in its red and green.
  std::size_t red = 0, green = 0;
  for (std::size_t i = 0; i < picture->rgba.size(); i += 4) {
    const int r = picture->rgba[i], g = picture->rgba[i + 1], b = picture->rgba[i + 2];
    red += r > 60 && 3 * g < r && 3 * b < r;
    green += g > 60 && 3 * r < g && 3 * b < g;
  }
  CHECK(red > 20);
  CHECK(green > 20);
}

TEST_CASE("all classes of LIBERO become assets, twice the same") {
  const char* elsewhere = std::getenv("VLAPROBE_REFERENCE");
  const std::string root =
      (elsewhere != nullptr ? elsewhere : VLAPROBE_SOURCE_DIR "/../shared/reference") +
      std::string("/libero/");
  std::ifstream in(root + "libero_object_classes.json");
  if (!in) {
    MESSAGE("skipped: no ../shared/reference/libero");
    return;
  }
  std::size_t objects = 0, fixtures = 0;
  const nlohmann::json classes = nlohmann::json::parse(in);
  for (const auto& [name, entry] : classes.items()) {
    CAPTURE(name);
    MujocoOptions options;
    options.file = root + "libero_assets/libero/" + entry["xml"].get<std::string>();
    options.merged_into = root + "libero_assets/robosuite/base.xml";
    const bool is_object = entry["kind"] == "object";
    options.kind = is_object ? MujocoKind::kObject : MujocoKind::kFixture;
    const MujocoAsset asset = converted(options);
    CHECK(asset.mass == doctest::Approx(entry["total_mass"].get<double>()).epsilon(1e-9));
    // By density alone each weighs what it weighs there, and where.
    for (const std::string& note : asset.notes)
      CHECK(note.find("spread evenly") == std::string::npos);
    if (is_object) CHECK(asset.declaration.find("  density 100kg/m3;") != std::string::npos);
    std::size_t joints = 0;
    for (const auto& body : entry["bodies"]) joints += body["joints"].size();
    CHECK(asset.joints.size() == joints);
    const MujocoAsset again = converted(options);
    CHECK(asset.declaration == again.declaration);
    for (std::size_t i = 0; i < asset.files.size(); ++i)
      CHECK((asset.files[i].bytes == again.files[i].bytes));
    ++(is_object ? objects : fixtures);
  }
  CHECK(objects + fixtures == 33);
  MESSAGE(objects, " objects, ", fixtures, " fixtures");
}

TEST_CASE("the rooms of LIBERO become backdrops") {
  const char* elsewhere = std::getenv("VLAPROBE_REFERENCE");
  const std::string root =
      (elsewhere != nullptr ? elsewhere : VLAPROBE_SOURCE_DIR "/../shared/reference") +
      std::string("/libero/libero_assets/libero/scenes/");
  if (!fs::is_directory(root)) {
    MESSAGE("skipped: no ../shared/reference/libero");
    return;
  }
  for (const char* name :
       {"floor", "tabletop", "living_room_tabletop", "study", "kitchen_tabletop"}) {
    CAPTURE(name);
    MujocoOptions options;
    options.kind = MujocoKind::kBackdrop;
    options.file = root + "libero_" + name + "_base_style.xml";
    const MujocoAsset room = converted(options);
    CHECK(room.files.size() == 1);
    CHECK(!room.surfaces.empty());
    CHECK(room.notes.empty());
  }
}

}  // namespace
}  // namespace probe::assets
