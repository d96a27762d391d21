// What the stepper promises of grasps, stacks and rest, with every bound in one place and the
// measured values printed as a table.
#include <doctest/doctest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <random>

#include "runtime/world/stepper.h"
#include "tests/runtime/world/arm_bench.h"

namespace probe::world {
namespace {

// Uniform numbers from the generator's bits: the standard distributions differ between libraries.
double uniform(std::mt19937_64* random, double low, double high) {
  return low + (high - low) * static_cast<double>((*random)() >> 11) * 0x1p-53;
}

Pose turned(const Vec3& place, double yaw) {
  const SinCos half = portable_sincos(0.5 * yaw);
  return {place, Quat(half.cos, 0, 0, half.sin)};
}

// All that have a collision mesh; what has its light baked in has the plain thing's.
std::vector<std::string> object_names() {
  std::vector<std::string> names;
  const std::string folder = std::string(VLAPROBE_SOURCE_DIR) + "/assets/objects";
  if (!std::filesystem::is_directory(folder)) return names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (std::filesystem::exists(entry.path() / "collision.obj") && !name.starts_with("baked_"))
      names.push_back(name);
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::shared_ptr<const scene::CollisionShape> try_object(const std::string& name) {
  auto shape = scene::load_collision_obj(
      std::string(VLAPROBE_SOURCE_DIR) + "/assets/objects/" + name + "/collision.obj",
      Vec3(1, 1, 1));
  if (!shape.ok()) return nullptr;
  return std::make_shared<scene::CollisionShape>(std::move(shape).value());
}

double lowest_vertex(const scene::CollisionShape& shape, const Quat& turn = Quat::Identity()) {
  double low = 0;
  for (const scene::ConvexPart& part : shape.parts) {
    for (const Vec3& v : part.vertices) low = std::min(low, (turn * v).z() - part.round);
  }
  return low;
}

// The widest extent across the fingers (along y), m.
double width(const scene::CollisionShape& shape, const Quat& turn) {
  double low = 0, high = 0;
  for (const scene::ConvexPart& part : shape.parts) {
    for (const Vec3& v : part.vertices) {
      low = std::min(low, (turn * v).y() - part.round);
      high = std::max(high, (turn * v).y() + part.round);
    }
  }
  return high - low;
}

struct Hold {
  bool held = false;
  bool wedged = false;        // by the limits of the fingers, which then are no grasp: it creeps
  double slip = 0, turn = 0;  // m, rad
};

// Lifts a body lying at its place, waits until it hangs still and watches it in the hand.
Hold lift_and_hold(Bench* bench, const Vec3& center, int watch_substeps) {
  const double lay = bench->world->body(0).center.z();
  close_on(bench, center);
  bench->move(center, center + Vec3(0, 0, 0.1), 5);
  bench->run(500);
  const Pose before = bench->in_gripper(0);
  Hold out;
  out.wedged = std::max(bench->world->joints()[6], bench->world->joints()[7]) > kOpen + 1e-4;
  for (int i = 0; i < watch_substeps / 100; ++i) {
    bench->run(100);
    const Pose now = bench->in_gripper(0);
    out.slip = std::max(out.slip, (now.position - before.position).norm());
    out.turn = std::max(out.turn, 2 * (before.rotation.conjugate() * now.rotation).vec().norm());
  }
  out.held = bench->world->body(0).center.z() > lay + 0.08;
  return out;
}

bool is_required(const std::string& name) {
  for (const char* one : {"cube 3 cm", "carrot", "spoon", "coke_can", "eggplant", "nut"}) {
    if (name == one) return true;
  }
  return false;
}

TEST_CASE("table: slip in the hand over 10 s of every object that fits it") {
  struct Item {
    std::string name;
    std::shared_ptr<const scene::CollisionShape> shape;
  };
  std::vector<Item> items{{"cube 3 cm", small_cube()}};
  for (const std::string& name : object_names()) items.push_back({name, try_object(name)});
  for (const Item& item : items) {
    if (item.shape == nullptr) continue;
    // Cans stand on their ends.
    const bool stands = item.name.ends_with("_can");
    const Quat turn = stands ? Quat(std::sqrt(0.5), std::sqrt(0.5), 0, 0) : Quat::Identity();
    if (width(*item.shape, turn) > 0.06) {
      MESSAGE(item.name, ": wider than the gripper opens, not grasped");
      CHECK(!is_required(item.name));
      continue;
    }
    const double up = -lowest_vertex(*item.shape, turn);
    const double density = item.name == "cube 3 cm" ? 1000 : 700;
    BodySpec body = lying(item.name.c_str(), item.shape, density * item.shape->volume, kSpot);
    body.pose = Pose{Vec3(kSpot.x(), kSpot.y(), kTable + up + 1e-4), turn} *
                Pose{-item.shape->center_of_mass, Quat::Identity()};
    Bench bench;
    if (!make_bench(&bench, {body})) return;
    bench.run(500);
    const Hold hold = lift_and_hold(&bench, bench.world->body(0).center, 5000);
    if (hold.wedged) {
      MESSAGE(item.name, ": the hand does not span it, the fingers' limits wedge it");
      CHECK(item.name == "slim_can");
      continue;
    }
    if (!hold.held) {
      MESSAGE(item.name, ": slid out of the fingers on the way up");
      CHECK(!is_required(item.name));
      continue;
    }
    MESSAGE(item.name, ": slip ", hold.slip * 1e3, " mm, turn ", hold.turn * 57.29578, " deg");
    CHECK(hold.slip < 1e-5);
    if (item.name == "carrot" || item.name == "cube 3 cm") {
      CHECK(hold.slip < 1e-6);
      CHECK(hold.turn < 0.001 / 57.3);
    }
  }
}

TEST_CASE("table: drift over 20 s at rest while the arm swings, and none at all asleep") {
  std::vector<BodySpec> bodies{
      lying("cube", small_cube(), 0.027, kSpot + Vec3(0, 0.15, 0)),
      lying("cube below", small_cube(), 0.027, kSpot + Vec3(-0.12, -0.15, 0)),
      lying("cube above", small_cube(), 0.027, kSpot + Vec3(-0.118, -0.149, 0.03))};
  for (const std::string& name : object_names()) {
    const auto shape = try_object(name);
    if (shape == nullptr || bodies.size() > 6) continue;
    bodies.push_back(lying(name.c_str(), shape, 700 * shape->volume,
                           Vec3(-0.45 + 0.2 * static_cast<double>(bodies.size() % 3),
                                0.35 + 0.2 * static_cast<double>(bodies.size() / 3),
                                kTable - lowest_vertex(*shape) + 1e-4)));
  }
  for (const bool sleeping : {false, true}) {
    Bench bench;
    if (!make_bench(&bench, bodies, sleeping)) return;
    bench.run(1500);
    std::vector<Vec3> before;
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      before.push_back(bench.world->body(b).pose.position);
    }
    for (int i = 0; i < 100; ++i) {
      std::array<double, 8> q = bench.target;
      q[0] = -0.018 + 0.05 * (i % 5);
      bench.go(q);
      bench.run(100);
    }
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      const double drift = (bench.world->body(b).pose.position - before[b]).norm();
      MESSAGE(bodies[b].name, std::string(sleeping ? " (sleeping)" : ""), ": drift ", drift * 1e3,
              " mm");
      // What is round at the bottom has no place it must stay at; it stays within the bound.
      CHECK(drift <= (sleeping ? 0.0 : 1e-5));
      if (b < 3) CHECK(drift <= 1e-9);
    }
  }
}

TEST_CASE("table: a stack of four turned cubes, awake for 20 s") {
  WorldSpec spec;
  spec.sleeping = false;
  for (int i = 0; i < 4; ++i) {
    spec.bodies.push_back({"cube " + std::to_string(i), small_cube(), 1000, 0.5,
                           turned({0, 0, 0.015 + 0.03 * i}, 0.3 * i)});
  }
  auto world = World::create(spec);
  REQUIRE(world.ok());
  REQUIRE((*world)->step(500).ok());
  std::vector<Vec3> before;
  for (std::size_t b = 0; b < 4; ++b) before.push_back((*world)->body(b).pose.position);
  REQUIRE((*world)->step(10000).ok());
  double drift = 0;
  for (std::size_t b = 0; b < 4; ++b) {
    drift = std::max(drift, ((*world)->body(b).pose.position - before[b]).norm());
  }
  MESSAGE("stack of four cubes: drift ", drift * 1e3, " mm");
  CHECK(drift < 1e-6);
}

// A body picked somewhere near the spot and carried 0.18 m to the plate. Slip is of the carry.
struct Trial {
  bool on_plate = false;
  double slip = 0;
};
Trial grasp_and_place(bool carrot, const Vec3& shift, double yaw, double dt) {
  const auto shape = carrot ? object("carrot") : small_cube();
  const auto plate = object("plate");
  const Vec3 goal = kSpot + Vec3(0, 0.18, 0);
  BodySpec body = lying("object", shape, carrot ? 0.055 : 0.027, Vec3::Zero());
  body.pose = turned(kSpot + shift, yaw) * Pose{-shape->center_of_mass, Quat::Identity()};
  body.pose.position.z() +=
      kTable - lowest_vertex(*shape) + 1e-4 - (body.pose.apply(shape->center_of_mass)).z();
  BodySpec disc = lying("plate", plate, 0.0213, goal);
  disc.pose.position.z() = kTable + 1e-4 - lowest_vertex(*plate) - plate->center_of_mass.z();
  Bench bench;
  REQUIRE(make_bench(&bench, {body, disc}, true, dt));
  const int control = static_cast<int>(std::lround(0.2 / dt));
  const auto move = [&](const Vec3& from, const Vec3& to, int steps) {
    for (int i = 1; i <= steps; ++i) {
      std::array<double, 8> q = bench.reach(from + (to - from) * i / steps);
      q[6] = bench.target[6];
      q[7] = bench.target[7];
      bench.go(q);
      bench.run(control);
    }
  };
  bench.run(3 * control);
  // The hand goes where the benchmark's would: to the nominal spot, not to the object.
  const Vec3 spot(kSpot.x(), kSpot.y(), bench.world->body(0).center.z());
  std::array<double, 8> q = bench.reach(spot);
  q[6] = q[7] = 0.037;
  bench.world->set_joints(q);
  bench.target = q;
  bench.grip(0.014);
  bench.run(3 * control);
  const Vec3 up(0, 0, 0.08), side(0, 0.18, 0);
  move(spot, spot + up, 5);
  bench.run(3 * control);
  const Pose before = bench.in_gripper(0);
  Trial out;
  for (int i = 1; i <= 15; ++i) {
    move(spot + up + side * (i - 1) / 15, spot + up + side * i / 15, 1);
    out.slip = std::max(out.slip, (bench.in_gripper(0).position - before.position).norm());
  }
  const Vec3 down = up * 0.12;
  move(spot + up + side, spot + down + side, 5);
  bench.grip(0.037);
  bench.run(2 * control);
  move(spot + down + side, spot + up + side, 4);
  bench.run(3 * control);
  const Vec3 at = bench.world->body(0).center, on = bench.world->body(1).center;
  out.on_plate = std::hypot(at.x() - on.x(), at.y() - on.y()) < 0.06 && at.z() > on.z() + 0.005 &&
                 at.z() < on.z() + 0.04;
  return out;
}

TEST_CASE("a carry over 0.18 m ends on the plate with next to no slip, at several substeps") {
  if (!load_widowx().ok()) return;
  for (const double dt : {0.001, 0.002, 0.004, 0.005}) {
    for (const bool carrot : {false, true}) {
      const Trial trial = grasp_and_place(carrot, Vec3::Zero(), 0, dt);
      MESSAGE("dt ", dt * 1e3, " ms, ", std::string(carrot ? "carrot" : "cube"),
              ": slip of the carry ", trial.slip * 1e3, " mm");
      CHECK(trial.on_plate);
      CHECK(trial.slip < (dt > 0.003 ? 2e-4 : 1e-4));
    }
  }
}

TEST_CASE("random grasps and places: all on the plate (VLAPROBE_TRIALS sets the number)") {
  if (!load_widowx().ok()) return;
  const char* asked = std::getenv("VLAPROBE_TRIALS");
  const int trials = asked != nullptr ? std::atoi(asked) : 30;
  std::mt19937_64 random(5);
  int placed = 0;
  double worst = 0;
  for (int i = 0; i < trials; ++i) {
    const bool carrot = asked == nullptr && i % 3 == 2;
    const Vec3 shift(uniform(&random, -0.008, 0.008), uniform(&random, -0.01, 0.01), 0);
    const double yaw = uniform(&random, carrot ? -0.15 : -0.6, carrot ? 0.15 : 0.6);
    const Trial trial = grasp_and_place(carrot, shift, yaw, 0.002);
    placed += trial.on_plate ? 1 : 0;
    worst = std::max(worst, trial.slip);
    CHECK_MESSAGE(trial.on_plate, "trial ", i, carrot ? " carrot" : " cube");
  }
  MESSAGE(placed, " of ", trials, " on the plate, largest slip of a carry ", worst * 1e3, " mm");
}

TEST_CASE("a carrot held beside its centre of mass does not swing, without torsion it does") {
  const auto shape = object("carrot");
  for (const double patch : {0.01, 0.0}) {
    for (const double off : {0.0, 0.02, 0.04}) {
      if (patch == 0 && off > 0) continue;
      Bench bench;
      if (!make_bench(&bench,
                      {lying("carrot", shape, 0.055,
                             Vec3(kSpot.x(), kSpot.y(), kTable - lowest_vertex(*shape) + 1e-4))})) {
        return;
      }
      WorldSpec spec = bench.world->spec();
      for (ArticulationSpec::Link& link : spec.articulations[0].links) {
        if (link.patch > 0) link.patch = patch;
      }
      auto world = World::create(spec);
      REQUIRE(world.ok());
      bench.world = std::move(world).value();
      bench.run(250);
      const Vec3 grip = bench.world->body(0).center + Vec3(off, 0, 0);
      close_on(&bench, grip);
      bench.move(grip, grip + Vec3(0, 0, 0.1), 5);
      if (patch > 0) bench.run(500);
      const Pose before = bench.in_gripper(0);
      double swing = 0;
      for (int i = 0; i < 25; ++i) {
        bench.run(100);
        const Pose now = bench.in_gripper(0);
        swing = std::max(swing, 2 * (before.rotation.conjugate() * now.rotation).vec().norm());
      }
      MESSAGE("patch ", patch, ", ", off * 100, " cm off: turns ", swing * 57.29578, " deg in 5 s");
      if (patch > 0) CHECK(swing < 0.005 / 57.3);
      if (patch == 0) CHECK(swing > 0.02 / 57.3);
    }
  }
}

TEST_CASE("pressing closed fingers into objects: no blow, no overlap, no drive beyond its force") {
  for (const bool jump : {false, true}) {
    for (const bool carrot : {false, true}) {
      const auto shape = carrot ? object("carrot") : small_cube();
      Bench bench;
      if (!make_bench(&bench,
                      {lying("object", shape, carrot ? 0.055 : 0.027,
                             Vec3(kSpot.x(), kSpot.y(), kTable - lowest_vertex(*shape) + 1e-4))})) {
        return;
      }
      std::array<double, 8> q = bench.reach(kSpot + Vec3(0, 0, 0.08));
      q[6] = q[7] = 0.015;
      bench.world->set_joints(q);
      bench.target = q;
      double fastest = 0, overlap = 0, force = 0;
      for (int i = 1; i <= 5000; ++i) {
        if (i % 100 == 1 && i <= 4000) {
          // Down to 4 cm below the table: at once, or over 3 s; and up again in the last second.
          const double depth = jump || i > 1500 ? 1.0 : (i + 99) / 1500.0;
          q = bench.reach(kSpot + Vec3(0, 0, 0.08 - 0.135 * depth));
          q[6] = q[7] = 0.014;
          bench.go(q);
        }
        if (i == 4001) {
          q = bench.reach(kSpot + Vec3(0, 0, 0.08));
          q[6] = q[7] = 0.014;
          bench.go(q);
        }
        bench.run(1);
        force = std::max(force, bench.world->drive_load());
        const BodyState body = bench.world->body(0);
        fastest = std::max(fastest, body.velocity.norm());
        for (const scene::ConvexPart& part : shape->parts) {
          for (const Vec3& v : part.vertices) {
            overlap = std::max(overlap, kTable - (body.center + body.pose.rotation * v).z());
          }
        }
      }
      MESSAGE(std::string(carrot ? "carrot" : "cube"), std::string(jump ? ", jump" : ", slowly"),
              ": fastest ", fastest, " m/s, overlap with the table ", overlap * 1e3, " mm, drive ",
              force, " of its limit");
      CHECK(fastest < 1.5);
      CHECK(overlap < 1e-3);
      CHECK(force <= 1.01);
    }
  }
}

}  // namespace
}  // namespace probe::world
