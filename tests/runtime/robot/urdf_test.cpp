#include "runtime/robot/urdf.h"

#include <clocale>
#include <filesystem>
#include <locale>

#include "tests/runtime/robot/test_robots.h"

namespace probe::robot {
namespace {

using test::TextFile;

std::string load_message(const std::string& text) {
  const TextFile file(text);
  const auto loaded = load_urdf(file.path());
  REQUIRE(!loaded.ok());
  CHECK(loaded.failure().code == Fault::kUrdf);
  CHECK(loaded.failure().where.starts_with(file.path()));
  return loaded.failure().message;
}

constexpr const char* kBody =
    "<inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/>"
    "</inertial>";

std::string two_links(const std::string& joint, const std::string& inertial = kBody) {
  return "<robot name='r'>\n<link name='a'/>\n<link name='b'>" + inertial + "</link>\n" + joint +
         "\n</robot>";
}

std::string revolute(const std::string& inside) {
  return "<joint name='waist' type='revolute'><parent link='a'/><child link='b'/>" + inside +
         "</joint>";
}

constexpr const char* kLimit = "<limit lower='-1' upper='1' effort='1' velocity='1'/>";

TEST_CASE("the WidowX loads with links and joints in the file's order") {
  const RobotModel robot = test::widowx();
  CHECK(robot.name == "wx250s");
  REQUIRE(robot.links.size() == 14);
  REQUIRE(robot.joints.size() == 13);
  CHECK(robot.links[0].name == "base_link");
  CHECK(robot.root == 0);
  CHECK(robot.links[13].name == "ee_gripper_link");
  CHECK(robot.joints[0].name == "waist");
  CHECK(robot.joints[5].name == "wrist_rotate");
  CHECK(robot.joints[5].upper == 3.141582653589793);
  const Joint& right = robot.joints[std::size_t(robot.find_joint("right_finger"))];
  CHECK(right.kind == JointKind::kPrismatic);
  CHECK(right.axis == Vec3(0, -1, 0));
  CHECK(right.mimic == robot.find_joint("left_finger"));
  CHECK(robot.links[0].visuals.at(0).path == "meshes/base_link.glb");
  CHECK(robot.links[0].collisions.at(0).path == "meshes/base_link_collision.obj");
  CHECK(robot.find_link("nobody") == -1);
}

TEST_CASE("our WidowX has the reference's kinematics, masses and inertias") {
  const std::string path = VLAPROBE_SOURCE_DIR
      "/../shared/reference/simpler_assets/ManiSkill2_real2sim/mani_skill2_real2sim/assets/"
      "descriptions/widowx_description/wx250s.urdf";
  std::string found = std::filesystem::exists(path) ? path : "";
  const std::string folder = VLAPROBE_SOURCE_DIR "/../shared/reference/simpler_assets";
  if (found.empty() && std::filesystem::exists(folder)) {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
      if (entry.path().filename() == "wx250s.urdf") found = entry.path().string();
    }
  }
  if (found.empty()) {
    MESSAGE("skipped: the reference's URDF is not beside this checkout");
    return;
  }
  const auto loaded = load_urdf(found);
  REQUIRE_MESSAGE(loaded.ok(), (loaded.ok() ? std::string() : to_text(loaded.failure())));
  const RobotModel& theirs = loaded.value();
  const RobotModel ours = test::widowx();
  REQUIRE(ours.links.size() == theirs.links.size());
  REQUIRE(ours.joints.size() == theirs.joints.size());
  for (const Link& link : theirs.links) {
    CAPTURE(link.name);
    const int i = ours.find_link(link.name);
    REQUIRE(i >= 0);
    const Link& mine = ours.links[std::size_t(i)];
    CHECK(mine.mass == link.mass);
    CHECK((mine.center_of_mass - link.center_of_mass).norm() < 1e-15);
    CHECK((mine.inertia - link.inertia).cwiseAbs().maxCoeff() < 1e-15);
    CHECK(mine.visuals.size() == link.visuals.size());
    CHECK(mine.collisions.size() == link.collisions.size());
  }
  for (const Joint& joint : theirs.joints) {
    CAPTURE(joint.name);
    const int i = ours.find_joint(joint.name);
    REQUIRE(i >= 0);
    const Joint& mine = ours.joints[std::size_t(i)];
    CHECK(mine.kind == joint.kind);
    CHECK(mine.axis == joint.axis);
    CHECK(mine.origin.position == joint.origin.position);
    CHECK(mine.origin.rotation.coeffs() == joint.origin.rotation.coeffs());
    CHECK(mine.lower == joint.lower);
    CHECK(mine.upper == joint.upper);
    CHECK(mine.effort == joint.effort);
    CHECK(mine.velocity == joint.velocity);
    CHECK(ours.links[std::size_t(mine.child_link)].name ==
          theirs.links[std::size_t(joint.child_link)].name);
    CHECK(ours.links[std::size_t(mine.parent_link)].name ==
          theirs.links[std::size_t(joint.parent_link)].name);
  }
}

TEST_CASE("an inertia written in a turned frame is turned into link axes") {
  const TextFile file(
      two_links(revolute(kLimit),
                "<inertial><origin xyz='.1 0 0' rpy='0 0 1.5707963267948966'/><mass value='2'/>"
                "<inertia ixx='1' iyy='2' izz='2.5' ixy='.1' ixz='0' iyz='0'/></inertial>"));
  const auto loaded = load_urdf(file.path());
  REQUIRE(loaded.ok());
  const Mat3& inertia = loaded->links[1].inertia;
  CHECK(inertia(0, 0) == doctest::Approx(2));
  CHECK(inertia(1, 1) == doctest::Approx(1));
  CHECK(inertia(0, 1) == doctest::Approx(-0.1));
  CHECK(loaded->links[1].center_of_mass == Vec3(0.1, 0, 0));
}

struct DecimalComma : std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
};

TEST_CASE("numbers are read the same under a locale with decimal commas") {
  const std::locale before = std::locale::global(
      std::locale(std::locale::classic(), new DecimalComma));  // the locale owns the facet
  std::setlocale(LC_ALL, "de_DE.UTF-8");  // where it is installed, the C functions' too
  const RobotModel robot = test::widowx();
  std::locale::global(before);
  std::setlocale(LC_ALL, "C");
  CHECK(robot.joints[0].origin.position.z() == 0.072);
  CHECK(robot.links[0].mass == 0.538736);
  CHECK(robot.joints[1].upper == 1.9896753472735358);
}

TEST_CASE("a Panda-like robot with a continuous and a mimicking joint loads") {
  const TextFile file(test::panda_like());
  const auto loaded = load_urdf(file.path());
  REQUIRE_MESSAGE(loaded.ok(), (loaded.ok() ? std::string() : to_text(loaded.failure())));
  CHECK(loaded->joints[0].kind == JointKind::kContinuous);
  CHECK(loaded->joints.back().mimic == int(loaded->joints.size()) - 2);
}

TEST_CASE("a file that is not there or is no XML is named") {
  const auto missing = load_urdf("/nowhere/robot.urdf");
  REQUIRE(!missing.ok());
  CHECK(to_text(missing.failure()) == "/nowhere/robot.urdf: there is no such file");
  CHECK(!load_urdf("/tmp").ok());
  CHECK(load_message("") == "the file is empty");
  CHECK(load_message("solid ascii stl").starts_with("not XML"));
  CHECK(load_message("<robot name='r'><link name='a'></robot>").starts_with("not XML"));
  CHECK(load_message(std::string("<robot\0name='r'/>", 17)) == "not text");
  CHECK(load_message("<mujoco/>") == "the outermost element is `mujoco`, not `robot`");
  CHECK(load_message("<robot name='r'/>") == "a robot without links");
  std::string deep = "<robot name='r'>";
  for (int i = 0; i < 100000; ++i) deep += "<a>";
  CHECK(load_message(deep) == "elements nested deeper than 500");
  for (const char* one : {"<_>", "<a b='/>'>", "<a b=\"</\">", "<\xc3\xa9>"}) {
    deep = "<robot name='r'>";
    for (int i = 0; i < 50000; ++i) deep += one;
    CHECK(load_message(deep) == "elements nested deeper than 500");
  }
  std::string wide = "<robot name='r'";
  for (int i = 0; i < 50000; ++i) wide += " a" + std::to_string(i) + "=''";
  CHECK(load_message(wide + "/>") == "an element of more than 100 attributes");
}

TEST_CASE("every truncation of a good file fails without a crash") {
  const std::string text = test::panda_like();
  for (std::size_t n = 0; n < text.size() - 10; n += 37) {
    const TextFile file(text.substr(0, n));
    CHECK(!load_urdf(file.path()).ok());
  }
}

TEST_CASE("a joint that names a link which is not there is said with its line") {
  const TextFile file(
      two_links("<joint name='waist' type='fixed'><parent link='a'/>"
                "<child link='x'/></joint>"));
  const auto loaded = load_urdf(file.path());
  REQUIRE(!loaded.ok());
  CHECK(loaded.failure().message == "joint `waist` names the link `x`, which is not there");
  CHECK(loaded.failure().where == file.path() + ":4");
}

TEST_CASE("what is no tree is said by its links and joints") {
  CHECK(load_message(two_links("")) == "several roots: no joint leads to `a` nor to `b`");
  CHECK(load_message(two_links("<joint name='j' type='fixed'><parent link='a'/><child link='b'/>"
                               "</joint><joint name='k' type='fixed'><parent link='b'/>"
                               "<child link='a'/></joint>"))
            .starts_with("a loop: joint `"));
  CHECK(load_message(two_links("<joint name='j' type='fixed'><parent link='b'/><child link='b'/>"
                               "</joint>")) == "a loop: joint `j` leads from `b` back to `b`");
  CHECK(load_message(two_links("<joint name='j' type='fixed'><parent link='a'/><child link='b'/>"
                               "</joint><joint name='k' type='fixed'><parent link='a'/>"
                               "<child link='b'/></joint>")) ==
        "link `b` hangs on two joints, `j` and `k`");
  CHECK(load_message("<robot name='r'><link name='a'/><link name='a'/></robot>") ==
        "two links are named `a`");
  CHECK(load_message("<robot name='r'><link/></robot>") == "a `link` without its `name`");
}

TEST_CASE("a joint without limits, with turned limits, or of an unknown type is refused") {
  CHECK(load_message(two_links(revolute(""))) == "joint `waist` has no `lower` limit");
  CHECK(load_message(two_links(revolute("<limit lower='0' effort='1' velocity='1'/>"))) ==
        "joint `waist` has no `upper` limit");
  CHECK(
      load_message(two_links(revolute("<limit lower='1' upper='-1' effort='1' velocity='1'/>"))) ==
      "joint `waist` has limits 1 to -1, lower must be below upper");
  CHECK(load_message(two_links("<joint name='j' type='floating'><parent link='a'/>"
                               "<child link='b'/></joint>"))
            .starts_with("joint `j` is of type `floating`"));
  CHECK(load_message(two_links(revolute(std::string(kLimit) + "<axis xyz='0 0 0'/>"))) ==
        "joint `waist` has an axis without direction");
  CHECK(load_message(two_links(revolute(std::string(kLimit) + "<mimic joint='elbow'/>"))) ==
        "joint `waist` mimics the joint `elbow`, which is not there");
  CHECK(load_message(two_links(revolute(std::string(kLimit) + "<mimic joint='waist'/>"))) ==
        "joint `waist` mimics `waist`, which itself mimics");
}

TEST_CASE("a wheel without ends is continuous, what is fixed loses them, half an end is refused") {
  const std::string endless = "<limit lower='-inf' upper='inf' effort='1' velocity='1'/>";
  const TextFile wheel(two_links(revolute(endless)));
  const auto turns = load_urdf(wheel.path());
  REQUIRE_MESSAGE(turns.ok(), (turns.ok() ? "" : to_text(turns.failure())));
  CHECK(turns->joints[0].kind == JointKind::kContinuous);
  const TextFile fixed(
      two_links("<joint name='waist' type='fixed'><parent link='a'/><child "
                "link='b'/>" +
                endless + "</joint>"));
  const auto stands = load_urdf(fixed.path());
  REQUIRE_MESSAGE(stands.ok(), (stands.ok() ? "" : to_text(stands.failure())));
  CHECK(stands->joints[0].kind == JointKind::kFixed);
  const TextFile half(
      two_links(revolute("<limit lower='-inf' upper='1' effort='1' velocity='1'/>")));
  const auto refused = load_urdf(half.path());
  REQUIRE(!refused.ok());
  CHECK(refused.failure().message ==
        "joint `waist` goes from `-inf` to `1`: both are numbers, or `-inf` and `inf` of what "
        "turns without end");
  CHECK(refused.failure().where == half.path() + ":4");
  for (const char* ends :
       {"lower='inf' upper='-inf'", "lower='inf' upper='inf'", "lower='-inf' upper='infinite'"}) {
    CAPTURE(ends);
    const std::string limit = std::string("<limit effort='1' velocity='1' ") + ends + "/>";
    CHECK(load_message(two_links(revolute(limit))).starts_with("joint `waist` goes from `"));
  }
  const std::string slides =
      "<joint name='waist' type='prismatic'><parent link='a'/>"
      "<child link='b'/>" +
      endless + "</joint>";
  CHECK(load_message(two_links(slides)) ==
        "joint `waist` goes from `-inf` to `inf`: of what slides both are numbers");
}

TEST_CASE("the released Google robot is read in each of its colourings") {
  const std::filesystem::path folder = VLAPROBE_SOURCE_DIR
      "/../shared/reference/google/google_assets/mani_skill2_real2sim/assets/descriptions/"
      "googlerobot_description";
  if (!std::filesystem::exists(folder)) {
    MESSAGE("skipped: the released assets of the Google robot are not on this machine");
    return;
  }
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".urdf") continue;
    CAPTURE(entry.path().string());
    const auto loaded = load_urdf(entry.path().string());
    CHECK_MESSAGE(loaded.ok(), (loaded.ok() ? "" : to_text(loaded.failure())));
    ++count;
  }
  CHECK(count == 5);
}

TEST_CASE("numbers that are none fail and urdfdom's own words are kept") {
  for (const char* bad : {"nan", "inf", "1e999", "0.1.2", "one", ""}) {
    CAPTURE(bad);
    const std::string number(bad);
    CHECK(!load_message(two_links(revolute("<limit lower='" + number +
                                           "' upper='1' effort='1' velocity='1'/>")))
               .empty());
    CHECK(!load_message(
               two_links(revolute(std::string(kLimit) + "<origin xyz='0 " + number + " 0'/>")))
               .empty());
    CHECK(!load_message(
               two_links(revolute(std::string(kLimit) + "<origin rpy='0 " + number + " 0'/>")))
               .empty());
    CHECK(
        !load_message(two_links(revolute(kLimit),
                                "<inertial><mass value='" + number +
                                    "'/><inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/>"
                                    "</inertial>"))
             .empty());
  }
}

TEST_CASE("a description of thousands of links or elements is refused before it is built") {
  std::string links;
  for (int i = 0; i < 20'000; ++i) links += "<link name='l" + std::to_string(i) + "'/>";
  for (int i = 1; i < 20'000; ++i) {
    links += "<joint name='j" + std::to_string(i) + "' type='fixed'><parent link='l" +
             std::to_string(i - 1) + "'/><child link='l" + std::to_string(i) + "'/></joint>";
  }
  CHECK(load_message("<robot name='r'>" + links + "</robot>") == "more than 1024 links or joints");
  std::string elements;
  for (int i = 0; i < 100'001; ++i) elements += "<a/>";
  CHECK(load_message("<robot name='r'>" + elements + "</robot>") == "more than 100000 elements");
}

TEST_CASE("masses and inertias that no body has are refused by name") {
  const auto with = [](const std::string& mass, const std::string& moments) {
    return load_message(
        two_links(revolute(kLimit),
                  "<inertial><mass value='" + mass + "'/><inertia " + moments + "/></inertial>"));
  };
  const std::string round = "ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'";
  CHECK(with("-1", round) == "link `b` weighs -1 kg");
  CHECK(with("0", round) == "link `b` moves, but it and what is fixed to it weigh nothing");
  CHECK(load_message(two_links(revolute(kLimit), "")) ==
        "link `b` moves, but it and what is fixed to it weigh nothing");
  CHECK(with("1", "ixx='1' iyy='1' izz='3' ixy='0' ixz='0' iyz='0'") ==
        "link `b` has an inertia no body can have: of its principal moments 1, 1, 3 the last "
        "exceeds the sum of the others");
  CHECK(with("1", "ixx='1' iyy='1' izz='1' ixy='2' ixz='0' iyz='0'")
            .starts_with("link `b` has an inertia with the principal moment -1"));
  CHECK(with("1", "ixx='0' iyy='0' izz='0' ixy='0' ixz='0' iyz='0'")
            .starts_with("link `b` has an inertia with the principal moment 0"));
}

std::string colliding(const std::string& geometry) {
  return two_links(revolute(kLimit), std::string(kBody) +
                                         "<collision><origin xyz='1 2 3' rpy='0 0 1'/><geometry>" +
                                         geometry + "</geometry></collision>");
}

TEST_CASE("boxes, spheres and cylinders are collision shapes") {
  const auto read = [](const std::string& geometry) {
    const test::TextFile file(colliding(geometry));
    auto model = load_urdf(file.path());
    REQUIRE_MESSAGE(model.ok(), (model.ok() ? std::string() : to_text(model.failure())));
    const Link& link = model->links[std::size_t(model->find_link("b"))];
    REQUIRE(link.primitives.size() == 1);
    CHECK(link.collisions.empty());
    CHECK(link.can_collide());
    CHECK(link.primitives[0].origin.position == Vec3(1, 2, 3));
    CHECK(link.primitives[0].origin.rotation.z() == doctest::Approx(std::sin(0.5)));
    return link.primitives[0];
  };
  const Primitive box = read("<box size='0.2 0.4 0.6'/>");
  CHECK(box.kind == Primitive::Kind::kBox);
  CHECK((box.half - Vec3(0.1, 0.2, 0.3)).norm() < 1e-15);
  const Primitive sphere = read("<sphere radius='0.05'/>");
  CHECK(sphere.kind == Primitive::Kind::kSphere);
  CHECK(sphere.half == Vec3(0.05, 0.05, 0.05));
  const Primitive cylinder = read("<cylinder radius='0.05' length='0.3'/>");
  CHECK(cylinder.kind == Primitive::Kind::kCylinder);
  CHECK((cylinder.half - Vec3(0.05, 0.05, 0.15)).norm() < 1e-15);
}

TEST_CASE("a primitive without extent is refused by its link's name") {
  for (const char* geometry : {"<box size='1 0 1'/>", "<box size='1 -1 1'/>",
                               "<sphere radius='0'/>", "<cylinder radius='0.1' length='-1'/>",
                               "<sphere radius='nan'/>", "<box size='1 inf 1'/>"}) {
    const std::string message = load_message(colliding(geometry));
    CHECK_MESSAGE(!message.empty(), geometry);
    if (std::string(geometry).find("nan") == std::string::npos &&
        std::string(geometry).find("inf") == std::string::npos) {
      CHECK(message ==
            "link `b` has a collision shape of a size that is not positive or a place that is not "
            "finite");
    }
  }
}

TEST_CASE("boxes, spheres and cylinders that are drawn are read with their colour") {
  const TextFile file(
      two_links(revolute(kLimit),
                std::string(kBody) +
                    "<visual><origin xyz='0 0 0.5'/><geometry><box size='1 2 4'/></geometry>"
                    "<material name='red'><color rgba='1 0 0.5 1'/></material></visual>"
                    "<visual><geometry><cylinder radius='0.1' length='0.4'/></geometry></visual>"));
  const auto model = load_urdf(file.path());
  REQUIRE_MESSAGE(model.ok(), (model.ok() ? "" : to_text(model.failure())));
  const Link& link = model->links[1];
  CHECK(link.visuals.empty());
  REQUIRE(link.drawn.size() == 2);
  CHECK(link.drawn[0].shape.half == Vec3(0.5, 1, 2));
  CHECK(link.drawn[0].shape.origin.position == Vec3(0, 0, 0.5));
  CHECK(link.drawn[0].color == Vec3(1, 0, 0.5));
  CHECK(link.drawn[1].shape.half == Vec3(0.1, 0.1, 0.2));
  CHECK(link.drawn[1].color == Vec3(0.7, 0.7, 0.7));
  CHECK_FALSE(link.can_collide());
}

TEST_CASE("a visual shape that is nothing is refused rather than dropped") {
  CHECK(!load_message(two_links(revolute(kLimit), std::string(kBody) +
                                                      "<visual><geometry><mesh/></geometry>"
                                                      "</visual>"))
             .empty());
}

}  // namespace
}  // namespace probe::robot
