// Every object is let go 2 cm over the table in its rest pose and must lie still and level after
// two seconds.
#include <cmath>
#include <memory>

#include "assets/make/shapes.h"
#include "runtime/scene/hull.h"
#include "runtime/world/world.h"
#include "tests/assets/asset_files.h"
#include "tests/runtime/world/widowx.h"

using namespace probe;

namespace {

constexpr double kTable = 0.87;

// The model's turn in its rest pose: roll about x first, then yaw.
struct Rest {
  std::string object;
  double roll_deg = 0, yaw_deg = 0;
};

std::vector<Rest> rest_poses() {
  std::vector<Rest> poses;
  for (const std::string& object : test::object_names()) {
    const bool lies_or_stands =
        object == "coke_can" || object == "pepsi_can" || object == "orange_juice";
    if (lies_or_stands) {
      poses.push_back({object, 90, 0});
      poses.push_back({object, 0, 90});
      continue;
    }
    const bool stands = object == "slim_can" || object == "water_bottle";
    poses.push_back({object, stands ? 90.0 : 0.0, 0});
  }
  poses.push_back({"carrot", 0, 180});
  poses.push_back({"spoon", 0, 90});
  poses.push_back({"nut", 0, -90});
  poses.push_back({"green_cube", 0, 45});
  poses.push_back({"eggplant", 0, -45});
  return poses;
}

Quat turn(const Rest& rest) {
  const double degree = make::kPi / 180;
  return Quat(Eigen::AngleAxisd(rest.yaw_deg * degree, Vec3::UnitZ())) *
         Quat(Eigen::AngleAxisd(rest.roll_deg * degree, Vec3::UnitX()));
}

Result<std::shared_ptr<const scene::CollisionShape>> shape_of(const std::string& object) {
  PROBE_ASSIGN(scene::CollisionShape shape,
               scene::load_collision_obj(test::object_file(object, "collision.obj"), Vec3::Ones()));
  return std::make_shared<const scene::CollisionShape>(std::move(shape));
}

double lowest_point(const scene::CollisionShape& shape, const Quat& rotation) {
  double lowest = 1e9;
  for (const scene::ConvexPart& part : shape.parts) {
    for (const Vec3& v : part.vertices) {
      lowest = std::min(lowest, (rotation * (v + shape.center_of_mass)).z());
    }
  }
  return lowest;
}

}  // namespace

TEST_CASE("every object comes to rest level in its rest pose") {
  auto arm = world::load_widowx();
  REQUIRE_MESSAGE(arm.ok(), to_text(arm.failure()));
  world::WorldSpec spec;
  spec.articulations = {(*arm)->spec};
  spec.surface_z = kTable;
  const std::vector<Rest> poses = rest_poses();
  for (std::size_t i = 0; i < poses.size(); ++i) {
    auto shape = shape_of(poses[i].object);
    REQUIRE_MESSAGE(shape.ok(), poses[i].object);
    const Quat rotation = turn(poses[i]);
    const double z = kTable + 0.02 - lowest_point(*shape.value(), rotation);
    // Far from one another and from the arm.
    const Vec3 at(1 + 0.3 * static_cast<double>(i), 0, z);
    spec.bodies.push_back({.name = poses[i].object + "_" + std::to_string(i),
                           .shape = shape.value(),
                           .density = 700,
                           .pose = {at, rotation}});
  }
  auto world = world::World::create(std::move(spec));
  REQUIRE_MESSAGE(world.ok(), to_text(world.failure()));
  REQUIRE((*world)->step(1000).ok());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    CAPTURE(poses[i].object);
    CAPTURE(poses[i].roll_deg);
    const world::BodyState body = (*world)->body(i);
    const Quat moved = body.pose.rotation * turn(poses[i]).conjugate();
    const double tilt_deg = std::acos(std::min(1.0, (moved * Vec3::UnitZ()).z())) * 180 / make::kPi;
    CHECK(tilt_deg < 3);
    CHECK(body.velocity.norm() < 1e-3);
    CHECK(body.spin.norm() < 1e-2);
    const Vec3 start(1 + 0.3 * static_cast<double>(i), 0, 0);
    CHECK((body.pose.position - start).head<2>().norm() < 0.005);
  }
}
