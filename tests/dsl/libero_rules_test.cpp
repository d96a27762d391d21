// LIBERO's rules as the suite has them, against a plain rewrite of the benchmark's own, over worlds
// made at random: regions turned and not, on parts that are turned, too.
#include <doctest/doctest.h>

#include <fstream>
#include <iterator>
#include <random>

#include "runtime/vm/judge.h"
#include "tests/dsl/built.h"

using namespace probe;
using namespace probe::test;

namespace {

std::string rules() {
  std::ifstream file(VLAPROBE_SOURCE_DIR "/suite/libero/predicates.probe");
  return {std::istreambuf_iterator<char>(file), {}};
}

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
  open    = at end slide(box.drawer) > 4cm
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
