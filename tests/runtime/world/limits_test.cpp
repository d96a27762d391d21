// What the stepper does where numbers get bad or come from closed forms; that substeps do not
// allocate; that equal worlds have equal bits in any process.
#include <doctest/doctest.h>

#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <new>
#include <random>

#include "runtime/base/trig.h"
#include "runtime/world/stepper.h"
#include "tests/runtime/world/arm_bench.h"

namespace {
std::atomic<long> g_allocations{0};  // of the whole test program
std::atomic<long> g_bytes{0};        // asked for, ever
}  // namespace

// Not inlined: the compiler would see free() meet what it takes for its own operator new.
[[gnu::noinline]] void* operator new(std::size_t size) {
  ++g_allocations;
  g_bytes += static_cast<long>(size);
  if (void* p = std::malloc(size == 0 ? 1 : size)) return p;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* p) noexcept { std::free(p); }
[[gnu::noinline]] void operator delete(void* p, std::size_t) noexcept { std::free(p); }

namespace probe::world {
namespace {

std::unique_ptr<World> make(const WorldSpec& spec) {
  auto world = World::create(spec);
  REQUIRE_MESSAGE(world.ok(), (world.ok() ? "" : to_text(world.failure())));
  return std::move(world).value();
}

Pose at(double x, double y, double z) { return {{x, y, z}, Quat::Identity()}; }

std::shared_ptr<const scene::CollisionShape> box(const Vec3& half) {
  return std::make_shared<scene::CollisionShape>(scene::make_box_shape(half));
}

TEST_CASE("a drive swings as the closed form of its implicit step says") {
  // One joint about the vertical: a constant inertia, so the step is linear.
  robot::RobotModel model;
  model.name = "door";
  robot::Link frame, door;
  frame.name = "frame";
  door.name = "door";
  door.parent_joint = 0;
  door.mass = 2;
  door.center_of_mass = Vec3(0.3, 0, 0);
  door.inertia = Vec3(0.02, 0.05, 0.06).asDiagonal();
  robot::Joint hinge;
  hinge.name = "hinge";
  hinge.kind = robot::JointKind::kContinuous;
  hinge.parent_link = 0;
  hinge.child_link = 1;
  hinge.axis = Vec3::UnitZ();
  model.links = {frame, door};
  model.joints = {hinge};
  WorldSpec spec;
  spec.articulations.emplace_back();
  spec.articulations[0].model = &model;
  spec.articulations[0].joints = {{"hinge", 40, 0.5, 1e6}};
  spec.articulations[0].positions = {0.4};
  const auto world = make(spec);
  world->set_targets(std::vector<double>{0.1});
  const double dt = spec.dt, m = 0.06 + 2 * 0.3 * 0.3;
  const double d = m + dt * 0.5 + dt * dt * 40;
  // x' = x + dt u', u' = (m u - dt KP x) / d: a rotation by theta that shrinks by rho.
  const double rho = std::sqrt(m / d), trace = 1 + m / d - dt * dt * 40 / d;
  const double theta = std::acos(trace / (2 * rho)), x0 = 0.3;
  const double b = (x0 * (1 - dt * dt * 40 / d) / rho - x0 * std::cos(theta)) / std::sin(theta);
  for (int n = 1; n <= 2000; ++n) {
    REQUIRE(world->step(1).ok());
    const double x = std::pow(rho, n) * (x0 * std::cos(n * theta) + b * std::sin(n * theta));
    if (n % 100 == 0) CHECK(std::fabs(world->joints()[0] - 0.1 - x) < 1e-11);
  }
  CHECK(world->drive_load() < 1);
}

TEST_CASE("a tall box tips just above the angle of its diagonal") {
  const auto tipped = [](double degrees) {
    WorldSpec spec;
    spec.sleeping = false;
    const SinCos a = portable_sincos_deg(degrees);
    spec.gravity = 9.81 * Vec3(a.sin, 0, -a.cos);
    spec.bodies.push_back({"box", box({0.01, 0.01, 0.03}), 1000, 0.5, at(0, 0, 0.03)});
    const auto world = make(spec);
    REQUIRE(world->step(1000).ok());
    return world->body(0).pose.position.z() < 0.02;
  };
  // atan(1 / 3) is 18.435 degrees.
  CHECK(!tipped(18.2));
  CHECK(tipped(18.7));
}

TEST_CASE("a woken stack hardly moves, and other supports keep still for 20 s") {
  WorldSpec spec;
  for (int i = 0; i < 4; ++i) {
    const SinCos half = portable_sincos(0.15 * i);
    spec.bodies.push_back({"cube", small_cube(), 1000, 0.5,
                           Pose{{0, 0, 0.015 + 0.03 * i}, Quat(half.cos, 0, 0, half.sin)}});
  }
  spec.bodies.push_back({"far", small_cube(), 1000, 0.5, at(1, 0, 0.015)});
  const auto world = make(spec);
  REQUIRE(world->step(1500).ok());
  CHECK(world->body(3).velocity == Vec3::Zero());
  world->set_body(4, at(1, 1, 0.015));  // wakes all
  double fastest = 0;
  for (int i = 0; i < 500; ++i) {
    REQUIRE(world->step(1).ok());
    for (std::size_t b = 0; b < 4; ++b) fastest = std::max(fastest, world->body(b).velocity.norm());
  }
  MESSAGE("a woken stack moves at ", fastest, " m/s");
  CHECK(fastest < 1e-4);

  WorldSpec other;
  other.sleeping = false;
  const auto plate = object("plate");
  const auto tin = std::make_shared<scene::CollisionShape>(scene::make_cylinder_shape(0.033, 0.06));
  other.bodies = {lying("plate", plate, 0.021, Vec3(0, 0, plate->center_of_mass.z() + 0.001)),
                  {"cube on plate", small_cube(), 1000, 0.5, at(0, 0, 0.03)},
                  {"tin", tin, 300, 0.5, at(0.4, 0, 0.06)},
                  {"cube on tin", small_cube(), 1000, 0.5, at(0.4, 0, 0.1351)}};
  const auto supports = make(other);
  REQUIRE(supports->step(1000).ok());
  std::vector<Vec3> before;
  for (std::size_t b = 0; b < 4; ++b) before.push_back(supports->body(b).pose.position);
  REQUIRE(supports->step(10000).ok());
  for (std::size_t b = 0; b < 4; ++b) {
    const double drift = (supports->body(b).pose.position - before[b]).norm();
    CHECK_MESSAGE(drift < 1e-6, other.bodies[b].name, " drifts ", drift);
  }
}

TEST_CASE("a cube, a carrot and a plate stay where a grasp is saved, restored and run for 15 s") {
  const std::vector<BodySpec> bodies{
      lying("cube", small_cube(), 0.027, kSpot),
      lying("carrot", object("carrot"), 0.055, kSpot + Vec3(0, 0.12, 0.005)),
      lying("plate", object("plate"), 0.021, kSpot + Vec3(0, -0.2, -0.01))};
  Bench first, second;
  if (!make_bench(&first, bodies)) return;
  REQUIRE(make_bench(&second, bodies));
  first.run(300);
  close_on(&first, kSpot);
  first.move(kSpot, kSpot + Vec3(0, 0, 0.08), 4);
  REQUIRE(second.world->restore(first.world->save()).ok());
  second.target = first.target;
  for (int i = 0; i < 75; ++i) {
    for (Bench* bench : {&first, &second}) {
      std::array<double, 8> q = bench->target;
      q[0] += i % 20 < 10 ? 0.02 : -0.02;
      bench->go(q);
      bench->run(100);
    }
    REQUIRE(first.world->state_hash() == second.world->state_hash());
  }
}

TEST_CASE("substeps do not allocate") {
  Bench bench;
  if (!make_bench(&bench, {lying("cube", small_cube(), 0.027, kSpot),
                           lying("carrot", object("carrot"), 0.055, kSpot + Vec3(0, 0.12, 0))})) {
    return;
  }
  bench.run(200);
  close_on(&bench, kSpot);
  bench.move(kSpot, kSpot + Vec3(0, 0, 0.05), 3);
  const long before = g_allocations;
  REQUIRE(bench.world->step(1000).ok());
  CHECK(g_allocations - before == 0);
}

// A plate of 16 x 16 boxes.
std::shared_ptr<const scene::CollisionShape> many_parts() {
  std::vector<std::vector<Vec3>> hulls;
  for (int x = 0; x < 16; ++x) {
    for (int y = 0; y < 16; ++y) {
      std::vector<Vec3>& hull = hulls.emplace_back();
      for (int i = 0; i < 8; ++i) {
        hull.emplace_back(0.01 * (x + (i & 1 ? 1 : 0)), 0.01 * (y + (i & 2 ? 1 : 0)),
                          i & 4 ? 0.01 : 0.0);
      }
    }
  }
  auto shape = scene::make_collision_shape(hulls, "plate");
  REQUIRE_MESSAGE(shape.ok(), (shape.ok() ? "" : to_text(shape.failure())));
  return std::make_shared<scene::CollisionShape>(std::move(shape).value());
}

TEST_CASE("pairs of parts are remembered where they are near, not for all that could touch") {
  const auto plate = many_parts();
  REQUIRE(plate->parts.size() == 256);
  WorldSpec spec;
  spec.sleeping = false;
  spec.bodies = {{"lower", plate, 500, 0.5, at(0, 0, 0.0001)},
                 {"upper", plate, 500, 0.5, at(0.055, 0.055, 0.0103)}};
  const long before = g_bytes;
  const auto world = make(spec);
  REQUIRE(world->step(200).ok());
  const long bytes = g_bytes - before;
  const std::size_t records = world->stepper().table.records_in_use();
  MESSAGE((bytes / 1024), " KiB asked for, ", records, " records of ", sizeof(PairRecord), " bytes");
  CHECK(world->body(1).center.z() == doctest::Approx(0.015).epsilon(0.01));
  // 65,536 records would be 57 MB; each part of the upper is near at most nine of the lower.
  CHECK(records <= 2 + 9 * 256);
  CHECK(records >= 100);
  CHECK(bytes < 8'000'000);
  // Apart, nothing is remembered but the lower one on the surface.
  world->set_body(1, at(1, 1, 1));
  REQUIRE(world->step(1).ok());
  CHECK(world->stepper().table.records_in_use() == 1);
}

TEST_CASE("bodies that start deep inside each other part slowly") {
  for (const double shift : {0.0, 1e-4, 0.01}) {
    WorldSpec spec;
    spec.sleeping = false;
    const auto ball = std::make_shared<scene::CollisionShape>(scene::make_sphere_shape(0.02));
    const auto rod = std::make_shared<scene::CollisionShape>(scene::make_capsule_shape(0.01, 0.03));
    spec.bodies = {{"a", small_cube(), 1000, 0.5, at(0, 0, 0.015)},
                   {"b", small_cube(), 1000, 0.5, at(shift, 0, 0.015)},
                   {"c", object("carrot"), 700, 0.5, at(0.3, 0, 0)},
                   {"d", object("plate"), 700, 0.5, at(0.3 + shift, 0, 0)},
                   {"e", ball, 1000, 0.5, at(0.7, 0, 0.02)},
                   {"f", ball, 1000, 0.5, at(0.7 + shift, 0, 0.02)},
                   {"g", rod, 1000, 0.5, at(-0.5, 0, 0.01)},
                   {"h", small_cube(), 1000, 0.5, at(-0.5, shift, -0.05)}};
    const auto world = make(spec);
    double fastest = 0;
    for (int i = 0; i < 1000; ++i) {
      REQUIRE(world->step(1).ok());
      for (std::size_t b = 0; b < 8; ++b) {
        fastest = std::max(fastest, world->body(b).velocity.norm());
      }
    }
    MESSAGE("shift ", shift, ": fastest ", fastest, " m/s");
    CHECK(fastest < 1.5);
  }
}

TEST_CASE("impossible bodies, fixtures and robots are refused by name") {
  const auto refused = [](const WorldSpec& spec) {
    const auto world = World::create(spec);
    REQUIRE(!world.ok());
    CHECK(world.failure().code == Fault::kWorld);
    return world.failure().message;
  };
  for (const double density : {0.0, -1.0, std::nan(""), HUGE_VAL}) {
    WorldSpec spec;
    spec.bodies.push_back({"brick", small_cube(), density, 0.5, at(0, 0, 0)});
    CHECK(refused(spec).find("body `brick`") == 0);
  }
  for (const double bad : {-1.0, std::nan(""), HUGE_VAL}) {
    WorldSpec spec;
    spec.fixtures.push_back({"sink", small_cube(), at(0, 0, 0), bad});
    CHECK(refused(spec).find("fixture `sink`") == 0);
  }
  WorldSpec spec;
  spec.fixtures.push_back({"sink", nullptr, at(0, 0, 0), 1});
  CHECK(refused(spec).find("fixture `sink` has no shape") == 0);
  spec.fixtures = {{"sink", small_cube(), at(0, std::nan(""), 0), 1}};
  CHECK(refused(spec).find("fixture `sink` stands") == 0);

  auto robot = load_widowx();
  if (!robot.ok()) return;
  const auto spoilt = [&](auto change) {
    robot::RobotModel model = robot.value()->model;
    const auto link = static_cast<std::size_t>(model.find_link("upper_forearm_link"));
    change(model.links[link]);
    WorldSpec with;
    with.articulations = {robot.value()->spec};
    with.articulations[0].model = &model;
    return refused(with);
  };
  CHECK(spoilt([](robot::Link& l) { l.mass = -0.3; }).find("`upper_forearm_link`") !=
        std::string::npos);
  CHECK(spoilt([](robot::Link& l) { l.mass = std::nan(""); }).find("no body can have") !=
        std::string::npos);
  CHECK(spoilt([](robot::Link& l) { l.inertia(0, 0) *= 100; }).find("no body can have") !=
        std::string::npos);
}

TEST_CASE("a robot file with a number that is not one is refused") {
  const std::string from = widowx_folder() + "/wx250s.urdf";
  std::ifstream file(from);
  std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  if (text.empty()) {
    MESSAGE("skipped: no ", from);
    return;
  }
  const auto mass = text.find("<mass value=\"");
  REQUIRE(mass != std::string::npos);
  for (const char* bad : {"nan", "-1", "inf"}) {
    std::string spoilt = text;
    const auto begin = mass + 13, end = spoilt.find('"', begin);
    spoilt.replace(begin, end - begin, bad);
    const std::string path =
        (std::filesystem::temp_directory_path() / "vlaprobe_spoilt.urdf").string();
    std::ofstream(path) << spoilt;
    const auto model = robot::load_urdf(path);
    std::filesystem::remove(path);
    CHECK(!model.ok());
  }
}

TEST_CASE("a target beyond everything stops at limits; bodies that left the room do not count") {
  Bench bench;
  if (!make_bench(&bench, {lying("cube", small_cube(), 0.027, kSpot)})) return;
  for (const double target : {1e9, -1e9, 1e300}) {
    std::vector<double> all(8, target);
    bench.world->set_joints(bench.robot->spec.positions);
    bench.world->set_targets(all);
    const Status status = bench.world->step(1000);
    // It flails at its force limits; if that flings the cube away, the world says so.
    if (!status.ok()) {
      CHECK(status.failure().message.find("body `cube`") == 0);
      return;
    }
    for (std::size_t j = 0; j < 8; ++j) {
      const JointSpec& drive = bench.robot->spec.joints[j];
      const robot::Joint& joint =
          bench.robot->model
              .joints[static_cast<std::size_t>(bench.robot->model.find_joint(drive.joint))];
      CHECK(bench.world->joints()[j] < joint.upper + 0.05);
      CHECK(bench.world->joints()[j] > joint.lower - 0.05);
    }
    CHECK(bench.world->drive_load() <= 1.01);
  }
  const auto lost = [&](const Vec3& place) {
    WorldSpec spec;
    spec.bodies.push_back({"cube", small_cube(), 1000, 0.5, at(0, 0, 0.015)});
    const auto world = make(spec);
    world->set_body(0, {place, Quat::Identity()});
    const Status status = world->step(1);
    REQUIRE(!status.ok());
    return status.failure().message;
  };
  CHECK(lost({1e9, 0, 1}).find("farther than 100 m") != std::string::npos);
  CHECK(lost({0, 0, HUGE_VAL}).find("not finite") != std::string::npos);
  CHECK(lost({0, std::nan(""), 0}).find("not finite") != std::string::npos);
  CHECK(lost({0, 0, -3}).find("below the surface") != std::string::npos);
}

// A short episode: a cube and a carrot somewhere, the arm goes somewhere and closes.
struct Episode {
  std::unique_ptr<World> world;
  std::mt19937_64 random;
  std::vector<double> target;

  Episode(const WidowX& robot, unsigned seed) : random(seed) {
    WorldSpec spec = table_spec(robot.spec);
    spec.sleeping = true;
    const Vec3 shift(number(-0.02, 0.02), number(-0.02, 0.02), 0);
    spec.bodies = {lying("cube", small_cube(), 0.027, kSpot + shift),
                   lying("carrot", carrot(), 0.055, kSpot + Vec3(0, 0.08, 0.02) + shift)};
    world = make(spec);
    target.assign(spec.articulations[0].positions.begin(), spec.articulations[0].positions.end());
  }
  static std::shared_ptr<const scene::CollisionShape> carrot() {
    static const auto shape = object("carrot");
    return shape;
  }
  double number(double low, double high) {
    return low + (high - low) * static_cast<double>(random() >> 11) * 0x1p-53;
  }
  void control_step() {
    for (std::size_t j = 0; j < 6; ++j) target[j] += number(-0.15, 0.15);
    target[1] += 0.1;  // downwards, where the objects are
    target[6] = target[7] = number(0.014, 0.038);
    world->set_targets(target);
    REQUIRE(world->step(50).ok());
  }
};

constexpr unsigned kEpisodes = 100;
constexpr int kControlSteps = 4;

std::string all_hashes(const WidowX& robot) {
  Hasher hasher;
  for (unsigned seed = 0; seed < kEpisodes; ++seed) {
    Episode episode(robot, seed);
    for (int i = 0; i < kControlSteps; ++i) episode.control_step();
    hasher.text(to_hex(episode.world->state_hash()));
  }
  return to_hex(hasher.finish());
}

TEST_CASE("hashes of a hundred episodes, for another process") {
  if (std::getenv("VLAPROBE_PRINT_HASHES") == nullptr) return;
  auto robot = load_widowx();
  REQUIRE(robot.ok());
  std::printf("hashes %s\n", all_hashes(*robot.value()).c_str());
}

std::string hashes_elsewhere(const std::string& environment) {
  const std::string command =
      environment + " VLAPROBE_PRINT_HASHES=1 /proc/self/exe -tc=\"hashes of a hundred*\"";
  // The shell's /proc/self is the shell: name this program.
  std::string self = std::filesystem::read_symlink("/proc/self/exe").string();
  std::string run = command;
  run.replace(run.find("/proc/self/exe"), 14, "'" + self + "'");
  FILE* pipe = popen(run.c_str(), "r");
  REQUIRE(pipe != nullptr);
  std::string out;
  char line[512];
  while (std::fgets(line, sizeof line, pipe) != nullptr) {
    if (std::string(line).starts_with("hashes ")) out = line + 7;
  }
  CHECK(pclose(pipe) == 0);
  while (!out.empty() && out.back() == '\n') out.pop_back();
  return out;
}

TEST_CASE(
    "a hundred episodes have equal bits again, interleaved, restored and in other processes") {
  auto robot = load_widowx();
  if (!robot.ok()) {
    MESSAGE("skipped: ", to_text(robot.failure()));
    return;
  }
  const WidowX& arm = *robot.value();
  const std::string once = all_hashes(arm);
  CHECK(once == hashes_elsewhere(""));
  CHECK(once == hashes_elsewhere("GLIBC_TUNABLES=glibc.cpu.hwcaps=-FMA,-AVX2,-AVX"));
  // Two at a time, each continued in a third world from its middle.
  Hasher interleaved, restored;
  for (unsigned seed = 0; seed < kEpisodes; seed += 2) {
    Episode a(arm, seed), b(arm, seed + 1), c(arm, seed + 7), d(arm, seed + 9);
    for (int i = 0; i < kControlSteps; ++i) {
      if (i == kControlSteps / 2) {
        for (auto [from, to] : {std::pair{&a, &c}, std::pair{&b, &d}}) {
          REQUIRE(to->world->restore(from->world->save()).ok());
          to->random = from->random;
          to->target = from->target;
        }
      }
      a.control_step();
      b.control_step();
      if (i < kControlSteps / 2) continue;
      d.control_step();
      c.control_step();
    }
    for (const Episode* e : {&a, &b}) interleaved.text(to_hex(e->world->state_hash()));
    for (const Episode* e : {&c, &d}) restored.text(to_hex(e->world->state_hash()));
  }
  CHECK(to_hex(interleaved.finish()) == once);
  CHECK(to_hex(restored.finish()) == once);
  MESSAGE(kEpisodes, " episodes, five ways: ", once.substr(0, 16));
}

}  // namespace
}  // namespace probe::world
