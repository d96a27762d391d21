#include "runtime/mjcf/mass.h"

#include <doctest/doctest.h>

#include <array>
#include <numbers>
#include <random>
#include <sstream>

#include "runtime/mjcf/mesh_file.h"
#include "runtime/mjcf/obj_file.h"
#include "runtime/mjcf/read.h"
#include "tests/runtime/mjcf/mjcf_files.h"

namespace probe::mjcf {
namespace {

struct Weighed {
  Model model;
  MassProperties mass;  // of the first body
};

Weighed weighed(const std::string& content, const std::string& around = "",
                const MjcfFolder& folder = {}) {
  const auto model =
      read_model(folder.write("model.xml", "<mujoco>" + around + "<worldbody><body>" + content +
                                               "</body></worldbody></mujoco>"));
  INFO((model ? std::string() : to_text(model.failure())));
  REQUIRE(model.ok());
  std::vector<MassProperties> solids;
  for (const MeshAsset& asset : model->meshes) {
    const auto mesh = load_mesh_file(*model, asset);
    INFO((mesh ? std::string() : to_text(mesh.failure())));
    REQUIRE(mesh.ok());
    solids.push_back(solid_of(*mesh, model->compiler.exact_mesh_inertia));
  }
  const auto mass = mass_of(*model, model->bodies[1], solids);
  INFO((mass ? std::string() : to_text(mass.failure())));
  REQUIRE(mass.ok());
  return {*model, *mass};
}

bool is_inside(const Geom& g, const Vec3& p) {
  const double across = std::hypot(p.x(), p.y());
  switch (g.shape) {
    case Shape::kSphere:
      return p.norm() <= g.size[0];
    case Shape::kEllipsoid:
      return p.cwiseQuotient(g.size).norm() <= 1;
    case Shape::kBox:
      return (p.cwiseAbs().array() <= g.size.array()).all();
    case Shape::kCylinder:
      return across <= g.size[0] && std::abs(p.z()) <= g.size[1];
    case Shape::kCapsule:
      return std::hypot(across, std::max(std::abs(p.z()) - g.size[1], 0.0)) <= g.size[0];
    case Shape::kPlane:
    case Shape::kMesh:
      break;
  }
  return false;
}

// The formulas against points on a fine grid.
TEST_CASE("volumes and moments of the shapes are those of their points") {
  for (const char* text :
       {"type=\"sphere\" size=\"0.5\"", "type=\"ellipsoid\" size=\"0.3 0.5 0.7\"",
        "type=\"box\" size=\"0.3 0.5 0.7\"", "type=\"cylinder\" size=\"0.4 0.6\"",
        "type=\"capsule\" size=\"0.3 0.5\""}) {
    CAPTURE(text);
    const Weighed w = weighed(std::string("<geom density=\"10\" ") + text + "/>");
    double volume = 0;
    Mat3 second = Mat3::Zero();
    constexpr int kCells = 80;
    constexpr double kCell = 2.0 / kCells;
    for (int i = 0; i < kCells; ++i) {
      for (int j = 0; j < kCells; ++j) {
        for (int k = 0; k < kCells; ++k) {
          const Vec3 p = Vec3(i + 0.5, j + 0.5, k + 0.5) * kCell - Vec3::Ones();
          if (!is_inside(w.model.bodies[1].geoms[0], p)) continue;
          volume += kCell * kCell * kCell;
          second += kCell * kCell * kCell * p * p.transpose();
        }
      }
    }
    const Mat3 inertia = second.trace() * Mat3::Identity() - second;
    CHECK(w.mass.mass == doctest::Approx(10 * volume).epsilon(0.02));
    CHECK((w.mass.inertia - 10 * inertia).norm() < 0.03 * w.mass.inertia.norm());
  }
}

TEST_CASE(
    "overlaps count twice, masses that are said replace densities, other groups weigh nothing") {
  const std::string two =
      "<geom type=\"box\" size=\"1 1 1\" density=\"1\"/><geom type=\"box\" size=\"1 1 1\" "
      "density=\"1\"/>";
  CHECK(weighed(two).mass.mass == doctest::Approx(16));
  const Weighed far = weighed(
      "<geom type=\"box\" size=\"1 1 1\" mass=\"3\" pos=\"1 0 0\"/>"
      "<geom type=\"box\" size=\"1 1 1\" mass=\"1\" pos=\"-3 0 0\"/>"
      "<geom type=\"box\" size=\"1 1 1\" mass=\"1\" group=\"2\"/>",
      "<compiler inertiagrouprange=\"0 1\"/>");
  CHECK(far.mass.mass == doctest::Approx(4));
  CHECK(far.mass.center.norm() < 1e-12);
  CHECK(far.mass.inertia(0, 0) == doctest::Approx(4 * 2.0 / 3));
  CHECK(far.mass.inertia(1, 1) == doctest::Approx(4 * 2.0 / 3 + 3 + 9));
}

TEST_CASE("an inertial replaces what geoms weigh, unless the compiler says otherwise") {
  const std::string body =
      "<inertial pos=\"0 0 1\" euler=\"0 0 90\" mass=\"2\" diaginertia=\"1 2 2.5\"/>"
      "<geom type=\"box\" size=\"0.5 0.5 0.5\" density=\"7\"/>";
  const Weighed said = weighed(body);
  CHECK(said.mass.mass == 2);
  CHECK(said.mass.center == Vec3(0, 0, 1));
  CHECK((said.mass.inertia - Mat3(Vec3(2, 1, 2.5).asDiagonal())).norm() < 1e-12);
  CHECK(weighed(body, "<compiler inertiafromgeom=\"true\"/>").mass.mass == doctest::Approx(7));
  CHECK(weighed("<geom size=\"1\"/>", "<compiler inertiafromgeom=\"false\"/>").mass.mass == 0);
  const Weighed full =
      weighed("<inertial pos=\"0 0 0\" mass=\"1\" fullinertia=\"3 3 3 0.1 0.2 0.3\"/>");
  CHECK(full.mass.inertia(0, 1) == 0.1);
  CHECK(full.mass.inertia(0, 2) == 0.2);
  CHECK(full.mass.inertia(2, 1) == 0.3);
  CHECK(weighed("<geom size=\"0.01\" density=\"1\"/>", "<compiler boundmass=\"0.5\"/>").mass.mass ==
        0.5);
}

TEST_CASE("a mesh is moved, turned and scaled, and weighs what is in it") {
  const MjcfFolder folder;
  folder.write("box.msh", box_msh(1, 2, 3));
  const Weighed w = weighed("<geom type=\"mesh\" mesh=\"box\" density=\"1\" pos=\"0 0 1\"/>",
                            "<asset><mesh file=\"box.msh\" refpos=\"1 0 0\" refquat=\"1 0 0 1\" "
                            "scale=\"1 1 -0.5\"/></asset>",
                            folder);
  // A quarter turn about z back: x to -y, y to x. What was at (1, 0, 0) is the origin.
  CHECK(w.mass.mass == doctest::Approx(24));
  CHECK((w.mass.center - Vec3(0, 1, 1)).norm() < 1e-6);
  CHECK(w.mass.inertia(0, 0) == doctest::Approx(24 * (1 + 2.25) / 3));
  CHECK(w.mass.inertia(1, 1) == doctest::Approx(24 * (4 + 2.25) / 3));
  const auto mesh = load_mesh_file(w.model, w.model.meshes[0]);
  REQUIRE(mesh.ok());
  // Mirrored, and still seen from outside: its volume with signs is above 0.
  CHECK(solid_of(*mesh, true).mass == doctest::Approx(24));
  const auto& part = mesh->parts[0];
  REQUIRE(part.normals.size() == part.positions.size());
}

TEST_CASE("a .msh file that is not what its sizes say is refused") {
  const std::string good = box_msh(1, 1, 1, true);
  REQUIRE(msh_mesh(good, "good").ok());
  CHECK(msh_mesh(good, "good")->parts[0].uv.size() == 16);
  const auto message = [](const std::string& bytes) {
    const auto mesh = msh_mesh(bytes, "bad.msh");
    REQUIRE(!mesh.ok());
    return to_text(mesh.failure());
  };
  CHECK(message("abc") == "bad.msh: not a .msh mesh: no room for its sizes");
  CHECK(message(good.substr(0, 100)) == "bad.msh: a .msh mesh of 100 bytes whose sizes say 320");
  std::string bad = good;
  bad[0] = 0;
  CHECK(message(bad) ==
        "bad.msh: not a .msh mesh: 0 vertices, 0 normals, 8 texture coordinates, 12 faces");
  bad = good;
  bad[good.size() - 4] = 9;
  CHECK(message(bad) == "bad.msh: a face names a vertex that is not there");
  bad = good;
  for (std::size_t i = 16; i < 20; ++i) bad[i] = '\xff';
  CHECK(message(bad) == "bad.msh: has a number that is not finite");
  bad = good;
  bad[15] = 0x70;
  CHECK(message(bad).starts_with("bad.msh: has "));
  std::mt19937 random(7);
  for (int i = 0; i < 2000; ++i) {  // whatever it is, it is an answer
    bad = good;
    for (int k = 0; k < 3; ++k) bad[random() % bad.size()] = static_cast<char>(random());
    const auto mesh = msh_mesh(bad, "bad.msh");
    if (!mesh.ok()) {
      CHECK(mesh.failure().where == "bad.msh");
      continue;
    }
    for (const std::uint32_t corner : mesh->parts[0].indices)
      CHECK(3 * corner + 2 < mesh->parts[0].positions.size());
  }
}

TEST_CASE("an OBJ file is read without the materials that it names") {
  const auto mesh = read_obj(
      "mtllib gone.mtl\nusemtl grey\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0.25 0.75\nvn 0 0 1\n"
      "f 1/1/1 2/1/1 3/1/1 4/1/1\nf -4/1/1 -3/1/1 -2/1/1\n",
      "card.obj", 10);
  REQUIRE_MESSAGE(mesh.ok(), to_text(mesh.failure()));
  const scene::MeshPart& part = mesh->parts.at(0);
  CHECK(part.positions.size() == 12);
  CHECK(part.indices == std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3, 0, 1, 2});
  CHECK(part.normals[2] == 1);
  CHECK(part.uv[0] == 0.25f);
  CHECK(part.uv[1] == 0.25f);  // counted from the picture's top
  const auto message = [](const char* text) {
    const auto bad = read_obj(text, "bad.obj", 1);
    REQUIRE(!bad.ok());
    return to_text(bad.failure());
  };
  CHECK(message("v 0 0 0\n") == "bad.obj:1: has no face");
  CHECK(message("v 0 x 0\n") == "bad.obj:1: expected a number, found `x`");
  CHECK(message("v 0 0 0\nf 1 1\n") == "bad.obj:2: a face has three corners or more");
  CHECK(message("v 0 0 0\nf 1 1 2\n") == "bad.obj:2: a face names what is not there: `2`");
  CHECK(message("v 0 0 0\nf 1 1 1 1\n") == "bad.obj:2: has too many faces");
}

TEST_CASE("the frame of an inertia has the largest moment first") {
  CHECK(inertia_frame(Vec3(3, 2, 1).asDiagonal()).isApprox(Mat3::Identity()));
  const Mat3 turn = Quat(Eigen::AngleAxisd(0.7, Vec3(1, -2, 0.5).normalized())).toRotationMatrix();
  const Mat3 inertia = turn * Vec3(1, 2, 3).asDiagonal() * turn.transpose();
  const Mat3 frame = inertia_frame(inertia);
  CHECK(frame.determinant() == doctest::Approx(1));
  const Mat3 left = frame.transpose() * inertia * frame;
  CHECK((left - Mat3(Vec3(3, 2, 1).asDiagonal())).norm() < 1e-7);
}

TEST_CASE("a mesh that is missing or none is named with the line that names it") {
  const MjcfFolder folder;
  folder.write("bad.msh", "nothing");
  const auto model = read_model(folder.write("model.xml", R"(<mujoco><asset>
    <mesh file="none.stl"/>
    <mesh file="bad.msh"/>
    <mesh file="cup.ply"/></asset></mujoco>)"));
  REQUIRE(model.ok());
  const auto message = [&](std::size_t i) {
    const auto mesh = load_mesh_file(*model, model->meshes[i]);
    REQUIRE(!mesh.ok());
    return to_text(mesh.failure());
  };
  CHECK(message(0) ==
        folder.path("model.xml:2: mesh `") + folder.path("none.stl") + "`: no such file");
  CHECK(message(1) == folder.path("model.xml:3: mesh `") + folder.path("bad.msh") +
                          "`: not a .msh mesh: no room for its sizes");
  folder.write("cup.ply", "ply");
  CHECK(message(2) == folder.path("model.xml:4: mesh `") + folder.path("cup.ply") +
                          "`: a mesh is .msh, .stl or .obj");
}

}  // namespace
}  // namespace probe::mjcf
