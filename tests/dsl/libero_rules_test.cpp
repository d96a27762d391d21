// LIBERO's rules as the suite has them, against a plain rewrite of the benchmark's own, over worlds
// made at random: regions turned and not, on parts that are turned, too.
#include <doctest/doctest.h>

#include <random>

#include "runtime/vm/judge.h"
#include "tests/dsl/built.h"

using namespace probe;
using namespace probe::test;

namespace {

std::string rules() { return places() + page_of("suite/libero/predicates.probe"); }

const char* const kScene = R"(
fixture box {
  urdf "chest/chest.urdf"; at (0cm, 30cm, 85cm) yaw 40deg
  part drawer link drawer name "drawer"
  part door link door name "door"
  region slot of drawer box (-10cm, -2cm, -1cm) .. (10cm, 2cm, 1cm) at (1cm, -2cm, 3cm) roll -62.5deg yaw 30deg
  region bin of drawer box (-3cm, -7cm, -10cm) .. (3cm, 7cm, 10cm) at (0cm, 1cm, 4cm) pitch 90deg
  region top of box box (-8cm, -6cm, -1mm) .. (8cm, 6cm, 1mm) at (0cm, 0cm, 6cm)
}
scene room like bench { fixture box; region mark of surface box (20cm, 30cm, 1.3cm) .. (40cm, 50cm, 2.7cm) }
metrics rules like plain {
  slot_on = at end on_site(source, box.slot)
  slot_in = at end in_site(source, box.slot)
  bin_on  = at end on_site(source, box.bin)
  bin_in  = at end in_site(source, box.bin)
  top_on  = at end on_site(source, box.top)
  top_in  = at end in_site(source, box.top)
  mark_on = at end on_zone(source, surface.mark)
  thing   = at end on_thing(source, target)
  inside  = at end within(origin(source), box.slot)
}
variant v of red_on_tray { scene room; metrics rules }
)";

// A site of the benchmark: a box about its own origin, in a body's frame.
struct Site {
  const char* body;
  Vec3 position;
  Mat3 turn;
  Vec3 size;
};

Mat3 about(double degrees, const Vec3& axis) {
  return Eigen::AngleAxisd(degrees * 3.14159265358979323846 / 180, axis).toRotationMatrix();
}

// The benchmark's SiteObjectState.check_ontop and check_contain,
// object_states/base_object_states.py and objects/site_object.py: the site's matrix turns the
// offset as it is.
bool is_on(const vm::BodySample& body, const Site& site, const Vec3& p) {
  const Mat3 matrix = body.rotation.toRotationMatrix() * site.turn;
  const Vec3 centre = body.origin + body.rotation.toRotationMatrix() * site.position;
  const Vec3 delta = matrix * (p - centre);
  return site.size.z() - 0.005 < delta.z() && delta.z() < site.size.z() + 0.10 &&
         std::abs(delta.x()) < site.size.x() && std::abs(delta.y()) < site.size.y();
}
bool is_in(const vm::BodySample& body, const Site& site, const Vec3& p) {
  const Mat3 matrix = body.rotation.toRotationMatrix() * site.turn;
  const Vec3 centre = body.origin + body.rotation.toRotationMatrix() * site.position;
  const Vec3 total = (matrix * site.size).cwiseAbs();
  Vec3 low = centre - total;
  low.z() -= 0.01;
  return (p.array() > low.array()).all() && (p.array() < (centre + total).array()).all();
}

}  // namespace

TEST_CASE("LIBERO's predicates agree with a plain rewrite in random worlds") {
  const Built built(rules() + kScene);
  const plan::Plan& plan = built.plan();
  const plan::TaskRecord& task = plan.tasks()[built.index("v")];
  const auto bodies = plan.bodies(task);
  const auto find = [&](std::string_view name) {
    std::size_t at = 0;
    while (plan.text(bodies[at].name) != name) ++at;
    return at;
  };
  const Mat3 still = Mat3::Identity();
  const Site slot{"box.drawer",
                  {0.01, -0.02, 0.03},
                  about(30, Vec3::UnitZ()) * about(-62.5, Vec3::UnitX()),
                  {0.1, 0.02, 0.01}};
  const Site bin{"box.drawer", {0, 0.01, 0.04}, about(90, Vec3::UnitY()), {0.03, 0.07, 0.1}};
  const Site top{"box", {0, 0, 0.06}, still, {0.08, 0.06, 0.001}};
  const Site mark{"surface", {0.3, 0.4, 0.02}, still, {0.1, 0.1, 0.007}};
  const std::size_t target = 1, parts[] = {find("box"), find("box.drawer"), find("box.door")};

  std::mt19937_64 draws(5);
  const auto draw = [&](double least, double most) {
    return least + (most - least) * static_cast<double>(draws() >> 11) * 0x1p-53;
  };
  std::map<std::string, int> yes;
  constexpr int kWorlds = 6000;
  for (int world = 0; world < kWorlds; ++world) {
    std::vector<vm::BodyStart> starts(bodies.size());
    vm::StepSample sample;
    sample.bodies.resize(bodies.size());
    sample.joints.resize(3 + 3);
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      vm::BodySample& body = sample.bodies[b];
      body.origin = Vec3(0.3, 0.4, 0.85);
      if (b == find("surface")) {
        body.origin = Vec3(0, 0, 0.8);
      } else {
        // Half of them stand as furniture does, the others anyhow.
        body.rotation = Quat(about(draw(-180, 180), Vec3::UnitZ()));
        if (world % 2 == 0) body.rotation = body.rotation * Quat(about(draw(0, 90), Vec3::UnitX()));
      }
      body.position = body.origin + Vec3(0.003, 0.001, 0.002);
    }
    const double reach = world % 3 == 0 ? 0.03 : 0.12;
    vm::BodySample& source = sample.bodies[0];
    source.origin += Vec3(draw(-reach, reach), draw(-reach, reach), draw(-reach, reach));
    source.position = source.origin;
    // Who touches the source.
    bool touches_target = false, touches_box = false;
    if (draw(0, 1) < 0.6) {
      touches_target = true;
      sample.contacts.push_back({0, 1, {0, 0, 0.01}});
    }
    for (const std::size_t part : parts) {
      if (draw(0, 1) < 0.7) continue;
      touches_box = true;
      sample.contacts.push_back({0, static_cast<std::uint16_t>(part), {0, 0, 0.01}});
    }
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      starts[b].position = sample.bodies[b].position;
      starts[b].half = {0.02, 0.01, 0.01};
    }
    sample.step = 1;
    vm::Judge judge(plan, built.index("v"));
    REQUIRE(judge.begin(starts).ok());
    REQUIRE(judge.step(sample).ok());
    const auto body = [&](const Site& site) -> const vm::BodySample& {
      return sample.bodies[find(site.body)];
    };
    const Vec3 p = source.origin;
    const auto check = [&](const std::string& metric, bool wanted) {
      CAPTURE(world);
      CAPTURE(metric);
      CHECK((judge.value(*judge.find_metric(metric)) != 0) == wanted);
      yes[metric] += wanted ? 1 : 0;
    };
    check("slot_on", is_on(body(slot), slot, p) && touches_box);
    check("slot_in", is_in(body(slot), slot, p));
    check("bin_on", is_on(body(bin), bin, p) && touches_box);
    check("bin_in", is_in(body(bin), bin, p));
    check("top_on", is_on(body(top), top, p) && touches_box);
    check("top_in", is_in(body(top), top, p));
    check("mark_on", is_on(body(mark), mark, p));
    const Vec3 other = sample.bodies[target].origin;
    check("thing", p.z() >= other.z() && touches_target && (p - other).head<2>().norm() < 0.03);
    // A box that is turned as boxes are: the transpose.
    const Mat3 turned = body(slot).rotation.toRotationMatrix() * slot.turn;
    const Vec3 local =
        turned.transpose() *
        (p - body(slot).origin - body(slot).rotation.toRotationMatrix() * slot.position);
    check("inside", (local.array().abs() <= slot.size.array()).all());
  }
  for (const auto& [metric, count] : yes) {
    CAPTURE(metric);
    CHECK(count > 20);
    CHECK(count < kWorlds - 20);
  }
}

namespace {

// Joints of the benchmark's four classes with joints as their models limit them, m and rad.
std::string furniture_urdf() {
  std::string links, joints;
  const auto add = [&](const std::string& name, const std::string& type,
                       const std::string& limits) {
    links += "<link name=\"" + name +
             "\"><inertial><mass value=\"1\"/><inertia ixx=\"0.1\" iyy=\"0.1\" izz=\"0.1\" "
             "ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial><collision><geometry><box size=\"0.1 "
             "0.1 0.1\"/></geometry></collision></link>";
    if (type.empty()) return;
    joints += "<joint name=\"" + name + "_joint\" type=\"" + type +
              "\"><parent link=\"body\"/><child link=\"" + name +
              "\"/><axis xyz=\"0 0 1\"/><limit " + limits +
              " effort=\"1\" velocity=\"1\"/></joint>";
  };
  add("body", "", "");
  add("drawer", "prismatic", "lower=\"-0.16\" upper=\"0.01\"");  // both cabinets
  add("door", "revolute", "lower=\"-2.094\" upper=\"0\"");       // the microwave
  add("knob", "revolute", "lower=\"-0.005\" upper=\"2.1\"");     // the stove
  return "<robot name=\"furniture\">" + links + joints + "</robot>";
}

const char* const kFurnished = R"(
fixture furniture {
  urdf "libero/furniture.urdf"; at (0cm, 30cm, 120cm)
  part drawer link drawer; part door link door; part knob link knob
}
scene furnished like bench { fixture furniture }
metrics joints like plain {
  is_drawer_opened = at end drawer_opened(furniture.drawer)
  is_drawer_closed = at end drawer_closed(furniture.drawer)
  is_door_opened = at end door_opened(furniture.door)
  is_door_closed = at end door_closed(furniture.door)
  is_knob_on = at end knob_on(furniture.knob)
  is_knob_off = at end knob_off(furniture.knob)
}
variant v of red_on_tray { scene furnished; metrics joints }
)";

// is_open, is_close, turn_on and turn_off of WoodenCabinet, WhiteCabinet, Microwave and FlatStove,
// objects/articulated_objects.py of the benchmark: a joint's position against the inner end of its
// default_open_ranges, default_close_ranges, default_turnon_ranges and default_turnoff_ranges.
struct JointRule {
  std::string_view metric;
  std::size_t joint;  // of the fixture
  double bound;       // m or rad
  bool below, at, above;
};
constexpr JointRule kJointRules[] = {
    {"is_drawer_opened", 0, -0.14, true, false, false},
    {"is_drawer_closed", 0, 0, false, false, true},
    {"is_door_opened", 1, -1.3, true, false, false},
    {"is_door_closed", 1, -0.005, false, false, true},
    {"is_knob_on", 2, 0.5, false, true, true},
    {"is_knob_off", 2, 0, true, false, false},
};

}  // namespace

TEST_CASE("LIBERO's joints are open, closed, on and off where the benchmark's classes say so") {
  write_text(asset_root() + "/libero/furniture.urdf", furniture_urdf());
  const Built built(rules() + kFurnished);
  const std::uint32_t task = built.index("v");
  const std::vector<vm::BodyStart> starts(built.plan().bodies(built.task("v")).size(),
                                          {{0, 0, 0.8}, {0.02, 0.01, 0.01}});
  for (const JointRule& rule : kJointRules) {
    CAPTURE(rule.metric);
    const auto judged = [&](double position) {
      vm::StepSample sample;
      sample.bodies.resize(starts.size());
      sample.joints.resize(3 + 3);
      sample.joints[3 + rule.joint].position = position;
      sample.step = 1;
      vm::Judge judge(built.plan(), task);
      REQUIRE(judge.begin(starts).ok());
      REQUIRE(judge.step(sample).ok());
      return judge.value(*judge.find_metric(rule.metric)) != 0;
    };
    CHECK(judged(rule.bound - 1e-9) == rule.below);
    CHECK(judged(rule.bound) == rule.at);
    CHECK(judged(rule.bound + 1e-9) == rule.above);
  }
}
