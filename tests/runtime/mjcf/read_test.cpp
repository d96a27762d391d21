#include "runtime/mjcf/read.h"

#include <doctest/doctest.h>

#include <numbers>

#include "tests/runtime/mjcf/mjcf_files.h"

namespace probe::mjcf {
namespace {

Model model_of(std::string_view text) {
  const MjcfFolder folder;
  const auto model = read_model(folder.write("model.xml", text));
  INFO((model ? std::string() : to_text(model.failure())));
  REQUIRE(model.ok());
  return *model;
}

// The failure without its folder: "model.xml:3: ...".
std::string failure_of(std::string_view text) {
  const MjcfFolder folder;
  const auto model = read_model(folder.write("model.xml", text));
  REQUIRE(!model.ok());
  CHECK(model.failure().code == Fault::kAsset);
  const std::string whole = to_text(model.failure());
  const auto at = whole.find(folder.path());
  return at == whole.npos ? whole : "/" + whole.substr(at + folder.path().size());
}

std::string in_body(const std::string& content, const std::string& around = "") {
  return "<mujoco>" + around + "<worldbody><body name=\"b\">\n" + content +
         "</body></worldbody></mujoco>";
}

void check_near(const Vec3& a, const Vec3& b) { CHECK((a - b).norm() < 1e-12); }

TEST_CASE(
    "an element has what it says, then what its class says, then what the classes around say") {
  const Model model = model_of(R"(<mujoco>
    <default>
      <geom density="100" rgba="1 0 0 1"/>
      <default class="felt">
        <geom friction="0.9 0.3" group="3"/>
        <default class="hard"><geom group="4"/></default>
      </default>
    </default>
    <worldbody>
      <body name="b" childclass="felt">
        <geom size="0.1"/>
        <geom class="hard" size="0.1" density="7"/>
        <geom class="main" size="0.1"/>
        <body childclass="hard"><geom size="0.1"/></body>
      </body>
    </worldbody></mujoco>)");
  const auto& geoms = model.bodies[1].geoms;
  REQUIRE(geoms.size() == 3);
  CHECK(geoms[0].group == 3);
  CHECK(geoms[0].density == 100);
  CHECK(geoms[0].friction == std::array<double, 3>{0.9, 0.3, 0.0001});
  CHECK(geoms[0].rgba == Rgba{1, 0, 0, 1});
  CHECK(geoms[1].group == 4);
  CHECK(geoms[1].density == 7);
  CHECK(geoms[1].friction[0] == 0.9);
  CHECK(geoms[2].group == 0);
  CHECK(geoms[2].density == 100);
  CHECK(model.bodies[2].geoms[0].group == 4);
  CHECK(model.notes.empty());
}

TEST_CASE("angles are degrees unless the compiler says radian, and turn in the order of eulerseq") {
  const std::string body = "<body euler=\"0 90 90\"/>";
  const auto turned = [&](const std::string& compiler, const std::string& inner) {
    return model_of(in_body(inner, compiler)).bodies[2].pose.rotation;
  };
  // x is turned about y to -z, which the turn about the new z leaves; y about the new z.
  Quat q = turned("", body);
  check_near(q * Vec3::UnitZ(), Vec3::UnitX());
  check_near(q * Vec3::UnitX(), Vec3::UnitY());
  q = turned("<compiler eulerseq=\"XYZ\"/>", body);
  check_near(q * Vec3::UnitZ(), Vec3::UnitY());
  q = turned("<compiler angle=\"radian\"/>", "<body axisangle=\"0 0 2 1.5707963267948966\"/>");
  check_near(q * Vec3::UnitX(), Vec3::UnitY());
  q = turned("", "<body xyaxes=\"0 1 0 -1 1 0\"/>");
  check_near(q * Vec3::UnitX(), Vec3::UnitY());
  check_near(q * Vec3::UnitZ(), Vec3::UnitZ());
  for (const Vec3& axis :
       {Vec3(0, 0, 3), Vec3(0, 0, -1), Vec3(1, 2, 3), Vec3(1e-9, 0, -1), Vec3(1, 0, -2)}) {
    const std::string text = "<body zaxis=\"" + std::to_string(axis.x()) + " " +
                             std::to_string(axis.y()) + " " + std::to_string(axis.z()) + "\"/>";
    q = turned("", text);
    CHECK((q * Vec3::UnitZ() - axis.normalized()).norm() < 1e-6);
  }
  q = turned("", "<body quat=\"2 0 0 2\"/>");
  check_near(q * Vec3::UnitX(), Vec3::UnitY());
  CHECK(failure_of(in_body("<body quat=\"1 0 0 0\" euler=\"0 0 0\"/>")) ==
        "/model.xml:2: both `euler` and `quat` are said");
}

TEST_CASE("two points give a capsule its middle, its axis and its half length") {
  const Model model =
      model_of(in_body("<geom type=\"capsule\" fromto=\"0 0 0.1 0 0.4 0.1\" size=\"0.02\"/>"
                       "<geom type=\"box\" fromto=\"1 0 0 3 0 0\" size=\"0.1\"/>"));
  const auto& geoms = model.bodies[1].geoms;
  check_near(geoms[0].pose.position, {0, 0.2, 0.1});
  check_near(geoms[0].pose.rotation * Vec3::UnitZ(), -Vec3::UnitY());
  CHECK(geoms[0].size[0] == 0.02);
  CHECK(geoms[0].size[1] == doctest::Approx(0.2));
  CHECK(geoms[1].size == Vec3(0.1, 0.1, 1));
}

TEST_CASE("frames, joints, sites, lights and cameras stand in their body's frame") {
  const Model model = model_of(in_body(R"(
    <frame pos="0 0 1" euler="0 0 90">
      <joint name="j" type="slide" pos="1 0 0" axis="2 0 0" range="-0.2 0.1" damping="50" armature="1"
             frictionloss="0.5" stiffness="3" springref="0.1"/>
      <site name="s" type="box" pos="1 0 0" size="0.1 0.2 0.3"/>
      <light name="l" pos="0 0 1" dir="1 0 0" directional="true" castshadow="false" cutoff="30"/>
    </frame>
    <camera name="c" mode="fixed" pos="0 1 0" fovy="60"/>
    <body name="free"><freejoint name="f"/></body>
    <body name="turning"><joint range="0 90" ref="45"/></body>)"));
  const Body& b = model.bodies[1];
  REQUIRE(b.joints.size() == 1);
  const Joint& j = b.joints[0];
  CHECK(j.motion == Motion::kSlide);
  check_near(j.axis, Vec3::UnitY());
  check_near(j.position, {0, 1, 1});
  CHECK(j.limited);
  CHECK(j.lower == -0.2);
  CHECK(j.upper == 0.1);
  CHECK(j.damping == 50);
  CHECK(j.armature == 1);
  CHECK(j.friction == 0.5);
  CHECK(j.stiffness == 3);
  CHECK(j.rest == 0.1);
  check_near(b.sites[0].pose.position, {0, 1, 1});
  CHECK(b.sites[0].shape == Shape::kBox);
  check_near(b.lights[0].direction, Vec3::UnitY());
  CHECK(b.lights[0].directional);
  CHECK(!b.lights[0].casts_shadow);
  CHECK(b.lights[0].cutoff == doctest::Approx(std::numbers::pi / 6));
  CHECK(b.cameras[0].fovy == doctest::Approx(std::numbers::pi / 3));
  CHECK(model.notes.empty());
  CHECK(model_of(in_body("<camera mode=\"trackcom\"/>")).notes[0].text ==
        "`mode` of `camera` is read as `fixed`");
  CHECK(model.bodies[2].joints[0].motion == Motion::kFree);
  CHECK(model.bodies[3].joints[0].upper == doctest::Approx(std::numbers::pi / 2));
  CHECK(model.bodies[3].joints[0].reference == doctest::Approx(std::numbers::pi / 4));
  CHECK(model.bodies[3].parent == 1);
}

TEST_CASE("assets are found by name, files beside the model or in the compiler's folders") {
  const MjcfFolder folder;
  const std::string text = R"(<mujoco><compiler meshdir="m" texturedir="t"/>
    <asset>
      <material name="wood" texture="grain" texrepeat="3 2" texuniform="true" rgba="1 0.5 0.25 1"/>
      <texture name="grain" type="2d" file="a/grain.png"/>
      <texture name="sky" builtin="gradient" width="4" height="24" rgb1="0 0 1" rgb2="1 1 1"/>
      <mesh file="../cup.msh" scale="2 2 -2" refpos="1 0 0" refquat="0 0 0 2"/>
    </asset>
    <worldbody><body><geom type="mesh" mesh="cup" material="wood"/>
      <geom size="1" material="wood" rgba="0 0 0 1"/></body></worldbody></mujoco>)";
  const auto model = read_model(folder.write("model.xml", text));
  REQUIRE(model.ok());
  CHECK(model->textures[0].file == folder.path("t/a/grain.png"));
  CHECK(model->textures[0].type == Texture::Type::k2d);
  CHECK(model->textures[1].builtin == Texture::Builtin::kGradient);
  CHECK(model->textures[1].type == Texture::Type::kCube);
  CHECK(model->materials[0].texture == 0);
  CHECK(model->materials[0].repeat == std::array<double, 2>{3, 2});
  CHECK(model->materials[0].uniform);
  CHECK(model->meshes[0].name == "cup");
  CHECK(model->meshes[0].file == folder.path("cup.msh"));
  CHECK(model->meshes[0].scale == Vec3(2, 2, -2));
  const auto& geoms = model->bodies[1].geoms;
  CHECK(geoms[0].mesh == 0);
  CHECK(geoms[0].rgba == Rgba{1, 0.5, 0.25, 1});
  CHECK(geoms[1].rgba == Rgba{0, 0, 0, 1});
}

TEST_CASE("what is merged into another model has that one's compiler and its files beside itself") {
  const MjcfFolder folder;
  const std::string base = folder.write(
      "base.xml",
      "<mujoco><compiler angle=\"radian\" inertiagrouprange=\"0 0\" meshdir=\"far\"/></mujoco>");
  const std::string file = folder.write("model.xml", R"(<mujoco>
    <compiler inertiagrouprange="4 4"/>
    <asset><mesh name="m" file="m.stl"/></asset>
    <worldbody><body euler="0 0 1.5707963267948966"/></worldbody></mujoco>)");
  const auto model = read_model(file, {base});
  REQUIRE(model.ok());
  CHECK(model->compiler.last_group == 0);
  CHECK(model->meshes[0].file == folder.path("m.stl"));
  check_near(model->bodies[1].pose.rotation * Vec3::UnitX(), Vec3::UnitY());
  CHECK(model->notes.empty());
}

TEST_CASE("included files are part of the model, and their mistakes have their own file and line") {
  const MjcfFolder folder;
  folder.write("parts/classes.xml",
               "<mujocoinclude><default><geom group=\"2\"/></default></mujocoinclude>");
  const std::string file = folder.write("model.xml", R"(<mujoco>
    <include file="parts/classes.xml"/>
    <worldbody><body><geom size="1"/></body></worldbody></mujoco>)");
  auto model = read_model(file);
  REQUIRE(model.ok());
  CHECK(model->bodies[1].geoms[0].group == 2);
  CHECK(model->files.size() == 2);
  folder.write("parts/classes.xml",
               "<mujocoinclude>\n<default><geom gruop=\"2\"/></default></mujocoinclude>");
  model = read_model(file);
  REQUIRE(!model.ok());
  CHECK(model.failure().where == folder.path("parts/classes.xml:2"));
  CHECK(model.failure().message == "`geom` has no attribute `gruop`");
  folder.write("parts/classes.xml",
               "<mujocoinclude>\n<include file=\"model.xml\"/></mujocoinclude>");
  model = read_model(file);
  REQUIRE(!model.ok());
  CHECK(model.failure().where == folder.path("parts/classes.xml:2"));
  CHECK(model.failure().message == "includes `" + file + "`, which is read already");
  folder.write("parts/classes.xml", "<mujocoinclude><include file=\"none.xml\"/></mujocoinclude>");
  model = read_model(file);
  REQUIRE(!model.ok());
  CHECK(model.failure().message == "includes `" + folder.path("none.xml") + "`, which is no file");
}

TEST_CASE("what is known and not read is a note with its place") {
  const Model model = model_of(R"(<mujoco>
    <option timestep="0.002"/>
    <actuator>
      <motor joint="j"/></actuator>
    <equality/>
    <asset><texture name="t" type="2d" file="a.png"/>
      <texture name="t" type="2d" file="b.png"/></asset>
    <tendon><fixed/></tendon>
    <worldbody><body mocap="true"><composite type="cable"/></body></worldbody></mujoco>)");
  std::string notes;
  for (const Note& note : model.notes)
    notes += std::to_string(note.at.line) + " " + note.text + "\n";
  const std::string folder = model.files[0].substr(0, model.files[0].rfind('/'));
  if (const auto at = notes.find(folder); at != notes.npos) notes.erase(at, folder.size());
  CHECK(notes ==
        "2 `option` is not read\n"
        "3 `actuator` is not read\n"
        "8 `tendon` is not read\n"
        "7 a second texture `t`: the one of /model.xml:6 counts\n"
        "9 `mocap` of `body` is not read\n"
        "9 `composite` is not read\n");
  CHECK(model.textures.size() == 1);
}

TEST_CASE("bad input is refused with its file and line") {
  const auto geom = [](const std::string& attributes) {
    return failure_of(in_body("<geom " + attributes + "/>"));
  };
  CHECK(failure_of("<mujoco>\n<worldbody></mujoco>").starts_with("/model.xml:2: not XML: "));
  CHECK(failure_of("<robot/>") == "/model.xml:1: the outermost element is `robot`, not `mujoco`");
  CHECK(failure_of("<mujoco>\n<wordlbody/></mujoco>") ==
        "/model.xml:2: `wordlbody` is no element of `mujoco`");
  CHECK(failure_of(in_body("<gem/>")) == "/model.xml:2: `gem` is no element of a body");
  CHECK(geom("sice=\"1\"") == "/model.xml:2: `geom` has no attribute `sice`");
  CHECK(geom("size=\"nan\"") == "/model.xml:2: `size` of `geom` is `nan`, expected finite numbers");
  CHECK(geom("size=\"1 2 x\"") ==
        "/model.xml:2: `size` of `geom` is `1 2 x`, expected finite numbers");
  CHECK(geom("size=\"1 1 1 1\"") ==
        "/model.xml:2: `size` of `geom` is `1 1 1 1`, expected 3 numbers");
  CHECK(geom("type=\"box\" size=\"1 1\"") == "/model.xml:2: `box` has 2 sizes, expected 3");
  CHECK(geom("type=\"box\" size=\"1 1 0\"") == "/model.xml:2: a size of `box` is 0");
  CHECK(geom("size=\"-1\"") == "/model.xml:2: a size below 0");
  CHECK(geom("size=\"1\" density=\"-3\"") == "/model.xml:2: `density` of `geom` is below 0");
  CHECK(geom("size=\"1\" pos=\"1 2\"") ==
        "/model.xml:2: `pos` of `geom` is `1 2`, expected 3 numbers");
  CHECK(geom("size=\"1\" quat=\"0 0 0 0\"") == "/model.xml:2: `quat` has a direction of no length");
  CHECK(
      geom("type=\"bx\"") ==
      "/model.xml:2: `type` of `geom` is `bx`, expected `plane`, `sphere`, `capsule`, `ellipsoid`, "
      "`cylinder`, `box` or `mesh`");
  CHECK(geom("type=\"hfield\"") == "/model.xml:2: a geom of type `hfield` is not read");
  CHECK(geom("type=\"mesh\" mesh=\"m\"") == "/model.xml:2: there is no mesh `m`");
  CHECK(geom("type=\"mesh\"") == "/model.xml:2: a geom of type `mesh` without a mesh");
  CHECK(geom("size=\"1\" material=\"m\"") == "/model.xml:2: there is no material `m`");
  CHECK(geom("size=\"1\" class=\"c\"") == "/model.xml:2: there is no class `c`");
  CHECK(geom("size=\"1\" rgba=\"2 0 0 1\"") ==
        "/model.xml:2: `rgba` has a number that is not from 0 to 1");
  CHECK(failure_of("<mujoco><default>\n<goem group=\"3\"/></default></mujoco>") ==
        "/model.xml:2: `goem` is no element of a class");
  CHECK(failure_of("<mujoco>\n<default clas=\"c\"/></mujoco>") ==
        "/model.xml:2: `default` has no attribute `clas`");
  CHECK(failure_of("<mujoco>\n<asset name=\"a\"/></mujoco>") ==
        "/model.xml:2: `asset` has no attribute `name`");
  CHECK(failure_of("<mujoco>\n<worldbody pos=\"0 0 1\"/></mujoco>") ==
        "/model.xml:2: `worldbody` has no attribute `pos`");
  CHECK(failure_of(in_body("<geom size=\"1\">\n<joint/></geom>")) ==
        "/model.xml:3: `joint` is no element of `geom`");
  CHECK(failure_of(in_body("<site>\n<geom/></site>")) ==
        "/model.xml:3: `geom` is no element of `site`");
  CHECK(failure_of(in_body(
            "<inertial pos=\"0 0 0\" mass=\"1\" diaginertia=\"1 1 1\">\n<x/></inertial>")) ==
        "/model.xml:3: `x` is no element of `inertial`");
  CHECK(model_of("<mujoco><default><motor ctrlrange=\"0 1\"/></default></mujoco>").notes.size() ==
        1);
  CHECK(model_of("<mujoco><asset><material name=\"m\"><layer/></material></asset></mujoco>")
            .notes.size() == 1);
  CHECK(failure_of(in_body("<joint range=\"1 0\"/>")) ==
        "/model.xml:2: a range whose second number is not above the first");
  CHECK(failure_of(in_body("<joint axis=\"0 0 0\"/>")) == "/model.xml:2: an axis of no length");
  CHECK(failure_of(in_body("<joint name=\"j\"/>\n<body><joint name=\"j\"/></body>")) ==
        "/model.xml:3: a second joint `j`");
  CHECK(failure_of(in_body("<body name=\"b\"/>")) == "/model.xml:2: a second body `b`");
  CHECK(failure_of(in_body("<inertial pos=\"0 0 0\" mass=\"1\" diaginertia=\"1 1 3\"/>")) ==
        "/model.xml:2: an inertia that no body can have");
  CHECK(failure_of("<mujoco><asset>\n<texture name=\"t\"/></asset></mujoco>") ==
        "/model.xml:2: a texture without `file` and without `builtin`");
  CHECK(failure_of("<mujoco><asset>\n<mesh name=\"m\" vertex=\"0 0 0\"/></asset></mujoco>") ==
        "/model.xml:2: a mesh without `file`, which is not read");
  CHECK(failure_of("<mujoco><default><default><geom/></default></default></mujoco>") ==
        "/model.xml:1: a `default` within another has no `class`");
  CHECK(failure_of("<mujoco><compiler eulerseq=\"xyw\"/></mujoco>") ==
        "/model.xml:1: `eulerseq` is three of x, y, z, X, Y and Z");
  const auto missing = read_model("/nowhere/model.xml");
  REQUIRE(!missing.ok());
  CHECK(to_text(missing.failure()) == "/nowhere/model.xml: no such file");
  std::string deep = "<mujoco><worldbody>";
  for (int i = 0; i < 600; ++i) deep += "<body>";
  CHECK(failure_of(deep) == "/model.xml: elements nested deeper than 500");
  // What looks like an end within a value, or a name that is no letter's, hides none.
  deep = "<mujoco><worldbody>";
  for (int i = 0; i < 600; ++i) deep += "<body name=\"/>\">";
  CHECK(failure_of(deep) == "/model.xml: elements nested deeper than 500");
}

TEST_CASE("a file of more than any model has is refused before anything is made of it") {
  const auto times = [](int count, std::string_view text) {
    std::string all;
    for (int i = 0; i < count; ++i) {
      for (const char c : text) all += c == '#' ? std::to_string(i) : std::string(1, c);
    }
    return all;
  };
  const auto world = [&](int count, std::string_view text) {
    return failure_of("<mujoco><worldbody>" + times(count, text) + "</worldbody></mujoco>");
  };
  const auto asset = [&](int count, std::string_view text) {
    return failure_of("<mujoco><asset>" + times(count, text) + "</asset></mujoco>");
  };
  CHECK(world(4097, "<geom size=\"1\"/>") == "/model.xml:1: more than 4096 geoms");
  CHECK(world(2049, "<body/>") == "/model.xml:1: more than 2048 bodies");
  CHECK(world(4097, "<site/>") == "/model.xml:1: more than 4096 sites");
  CHECK(world(1, "<body>" + times(4097, "<joint/>") + "</body>") ==
        "/model.xml:1: more than 4096 joints");
  CHECK(world(1025, "<light/>") == "/model.xml:1: more than 1024 lights");
  CHECK(world(1025, "<camera/>") == "/model.xml:1: more than 1024 cameras");
  CHECK(asset(2049, "<material name=\"m#\"/>") == "/model.xml:1: more than 2048 materials");
  CHECK(asset(2049, "<mesh file=\"m#.obj\"/>") == "/model.xml:1: more than 2048 meshes");
  CHECK(asset(1025, "<texture name=\"t#\" file=\"t.png\"/>") ==
        "/model.xml:1: more than 1024 textures");
  CHECK(failure_of("<mujoco><default>" + times(1025, "<default class=\"c#\"/>") +
                   "</default></mujoco>") == "/model.xml:1: more than 1024 classes");
  CHECK(failure_of("<mujoco>" + times(100'001, "<size/>") + "</mujoco>") ==
        "/model.xml: more than 100000 elements");
  CHECK(failure_of("<mujoco" + times(50'000, " a#=\"\"") + "/>") ==
        "/model.xml: an element of more than 100 attributes");
}

}  // namespace
}  // namespace probe::mjcf
