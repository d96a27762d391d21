#include <cmath>

#include "assets/make/solid.h"
#include "tests/assets/asset_files.h"

using namespace probe;

namespace {

constexpr double kMillimetre = 0.001;

struct Pair {
  std::string visual, collision;
};

std::vector<Pair> all_pairs() {
  std::vector<Pair> pairs;
  for (const std::string& object : test::object_names()) {
    pairs.push_back(
        {test::object_file(object, "visual.glb"), test::object_file(object, "collision.obj")});
  }
  pairs.push_back({test::asset_path("fixtures/sink/visual.glb"),
                   test::asset_path("fixtures/sink/collision.obj")});
  for (const std::string& link : test::link_names()) {
    pairs.push_back({test::link_mesh(link), test::link_hull(link)});
  }
  return pairs;
}

void check_equal(const Vec3& found, const Vec3& wanted, double tolerance) {
  for (int axis = 0; axis < 3; ++axis) {
    CAPTURE(axis);
    CHECK(std::abs(found[axis] - wanted[axis]) <= tolerance);
  }
}

}  // namespace

TEST_CASE("objects fill the published boxes to a tenth of a millimetre") {
  const std::string path = VLAPROBE_SOURCE_DIR "/../shared/reference/intact_tasks.json";
  if (!std::filesystem::exists(path)) {
    MESSAGE("skipped: " << path << " is not there");
    return;
  }
  const auto objects = Json::parse(test::read_bytes(path)).at("objects");
  for (const std::string& name : test::published_names()) {
    CAPTURE(name);
    const auto& entry = objects.at(name == "half_sponge" ? "sponge_small" : name);
    const auto vector = [&](const char* key) -> Vec3 {
      return Vec3(entry.at(key)[0].get<double>(), entry.at(key)[1].get<double>(),
                  entry.at(key)[2].get<double>()) *
             entry.at("scale").get<double>();
    };
    const test::Bounds seen = test::read_visual(test::object_file(name, "visual.glb")).box;
    const test::Bounds felt =
        test::bounds_of(test::read_collision(test::object_file(name, "collision.obj")));
    check_equal(seen.low, vector("bbox_min"), 0.1 * kMillimetre);
    check_equal(seen.high, vector("bbox_max"), 0.1 * kMillimetre);
    check_equal(felt.low, vector("bbox_min"), 0.1 * kMillimetre);
    check_equal(felt.high, vector("bbox_max"), 0.1 * kMillimetre);
  }
}

TEST_CASE("collision parts are closed and convex with at most 32 corners") {
  for (const Pair& pair : all_pairs()) {
    CAPTURE(pair.collision);
    const auto parts = test::read_collision(pair.collision);
    CHECK(!parts.empty());
    for (const test::ConvexObject& part : parts) {
      CAPTURE(part.name);
      CHECK(part.vertices.size() <= 32);
      std::map<std::array<std::size_t, 2>, int> edges;
      std::set<std::size_t> used;
      for (const auto& loop : part.faces) {
        REQUIRE(loop.size() >= 3);
        Vec3 normal = Vec3::Zero();  // Newell's, longer than one edge pair would give
        for (std::size_t i = 0; i < loop.size(); ++i) {
          const Vec3 &a = part.vertices[loop[i]], &b = part.vertices[loop[(i + 1) % loop.size()]];
          normal += a.cross(b);
          ++edges[{loop[i], loop[(i + 1) % loop.size()]}];
          used.insert(loop[i]);
        }
        normal.normalize();
        double offset = -1e9, lowest_of_face = 1e9;
        for (const std::size_t i : loop) {
          offset = std::max(offset, normal.dot(part.vertices[i]));
          lowest_of_face = std::min(lowest_of_face, normal.dot(part.vertices[i]));
        }
        // Flat, and nothing sticks out: to the micrometres that the file's rounding leaves.
        CHECK(offset - lowest_of_face < 0.01 * kMillimetre);
        for (const Vec3& p : part.vertices) CHECK(normal.dot(p) <= offset + 0.01 * kMillimetre);
      }
      CHECK(used.size() == part.vertices.size());
      for (const auto& [edge, count] : edges) {
        CHECK(count == 1);
        CHECK(edges.count({edge[1], edge[0]}) == 1);
      }
    }
  }
}

TEST_CASE("collision shapes stay within half a millimetre of the visual's box") {
  for (const Pair& pair : all_pairs()) {
    CAPTURE(pair.collision);
    const test::Bounds seen = test::read_visual(pair.visual).box;
    const test::Bounds felt = test::bounds_of(test::read_collision(pair.collision));
    for (int axis = 0; axis < 3; ++axis) {
      CHECK(felt.low[axis] >= seen.low[axis] - 0.5 * kMillimetre);
      CHECK(felt.high[axis] <= seen.high[axis] + 0.5 * kMillimetre);
    }
  }
}

TEST_CASE("link hulls reach the visual's box, so that nothing seen is out of touch") {
  for (const std::string& link : test::link_names()) {
    CAPTURE(link);
    const test::Bounds seen = test::read_visual(test::link_mesh(link)).box;
    const auto hull = test::read_collision(test::link_hull(link));
    CHECK(hull.size() == 1);
    const test::Bounds felt = test::bounds_of(hull);
    check_equal(felt.low, seen.low, 0.5 * kMillimetre);
    check_equal(felt.high, seen.high, 0.5 * kMillimetre);
  }
}

TEST_CASE("both fingers slope from the pins to a flat tip and mirror each other") {
  const auto left = test::read_collision(test::link_hull("widowx/left_finger_link")).at(0);
  const auto right = test::read_collision(test::link_hull("widowx/right_finger_link")).at(0);
  int pins = 0, tip = 0;
  for (const Vec3& p : left.vertices) {
    CHECK(p.y() >= -0.011);
    if (p.y() < -0.011 + 1e-6) {
      ++pins;
      CHECK(std::abs(p.x()) <= 0.0019);
      CHECK(std::abs(p.z()) <= 0.0119);
    }
    if (p.x() > 0.043 - 1e-6 && p.y() < -0.00895 + 1e-6) ++tip;
    // Nothing but the pins stands over the flat face.
    if (p.y() > -0.011 + 1e-6) CHECK(p.y() >= -0.00895 - 1e-6);
  }
  CHECK(pins == 4);
  CHECK(tip == 2);
  REQUIRE(left.vertices.size() == right.vertices.size());
  for (const Vec3& p : left.vertices) {
    const Vec3 twin(p.x(), -p.y(), p.z());
    const auto same = [&](const Vec3& q) { return (q - twin).norm() < 1e-6; };
    CHECK(std::any_of(right.vertices.begin(), right.vertices.end(), same));
  }
}

TEST_CASE("the carrot rests on a flat facet under its centre of mass") {
  const auto parts = test::read_collision(test::asset_path("objects/carrot/collision.obj"));
  REQUIRE(parts.size() == 2);
  test::Bounds facet;
  for (const Vec3& p : parts[0].vertices) {
    if (p.z() < -0.019 + 1e-6) facet.add(p);
  }
  CHECK(facet.high.y() - facet.low.y() >= 0.012);
  CHECK(facet.high.x() - facet.low.x() >= 0.05);
  const test::Solid solid = test::solid_of(parts);
  CHECK(solid.volume > 40e-6);
  // A centimetre from both ends of the facet, and where the grip is: near the model's origin.
  CHECK(solid.centre.x() > facet.low.x() + 0.01);
  CHECK(solid.centre.x() < facet.high.x() - 0.01);
  CHECK(std::abs(solid.centre.x()) < 0.01);
  CHECK(std::abs(solid.centre.y()) < 1e-6);
}

TEST_CASE("the plate touches the table with its base alone and its parts do not overlap") {
  const auto parts = test::read_collision(test::asset_path("objects/plate/collision.obj"));
  CHECK(parts.size() == 13);
  for (const test::ConvexObject& part : parts) {
    const test::Bounds box = test::bounds_of({part});
    CAPTURE(part.name);
    CHECK((box.low.z() < -0.0029) == (part.name == "base"));
    // The base ends where the rim begins.
    CHECK((part.name == "base" ? box.high.z() <= -0.0005 + 1e-9 : box.low.z() >= -0.0005 - 1e-9));
  }
  CHECK(std::abs(test::solid_of(parts).centre.x()) < 1e-6);
}

TEST_CASE("ramekin, bowl and mug are hollow, the nut has a hole and the sink has two basins") {
  // True where no part of the shape lies on the upright line from z to the sky.
  const auto open_above = [](const std::vector<test::ConvexObject>& parts, double x, double y,
                             double z) {
    for (const test::ConvexObject& part : parts) {
      for (double height = z; height < 0.2; height += 0.002) {
        bool inside = true;
        for (const auto& loop : part.faces) {
          const Vec3 &a = part.vertices[loop[0]], &b = part.vertices[loop[1]],
                     &c = part.vertices[loop[2]];
          inside = inside && (b - a).cross(c - a).dot(Vec3(x, y, height) - a) < 0;
        }
        if (inside) return false;
      }
    }
    return true;
  };
  const auto ramekin = test::read_collision(test::object_file("ramekin", "collision.obj"));
  for (const double x : {-0.038, 0.0, 0.038}) CHECK(open_above(ramekin, x, 0, -0.019));
  CHECK(!open_above(ramekin, 0.05, 0, -0.019));
  const auto bowl = test::read_collision(test::object_file("bowl", "collision.obj"));
  for (const double x : {-0.034, 0.0, 0.034}) CHECK(open_above(bowl, x, 0, -0.0215));
  CHECK(!open_above(bowl, 0.05, 0.003, -0.0215));
  const auto mug = test::read_collision(test::object_file("mug", "collision.obj"));
  for (const double x : {-0.026, 0.0, 0.026, 0.04})
    CHECK(open_above(mug, x, x > 0.03 ? 0.01 : 0, -0.0375));
  CHECK(!open_above(mug, 0.04, 0, -0.0375));  // under the handle
  CHECK(open_above(test::read_collision(test::object_file("nut", "collision.obj")), 0, 0, -0.02));
  const auto sink = test::read_collision(test::asset_path("fixtures/sink/collision.obj"));
  // Where eggplants start and where the basket's plane lies, from the sink's frame.
  CHECK(open_above(sink, 0.055, 0.076, 0.041));
  for (const double x : {-0.030, 0.098}) {
    for (const double y : {-0.144, -0.066}) CHECK(open_above(sink, x, y, 0.052));
  }
  CHECK(!open_above(sink, 0.02, -0.03, 0.06));
}

TEST_CASE("triangles stay within the renderer's budget") {
  std::map<std::string, std::size_t> robots;
  for (const std::string& link : test::link_names()) {
    robots[link.substr(0, link.find('/'))] += test::read_visual(test::link_mesh(link)).triangles;
  }
  CHECK(robots.size() == 2);
  for (const auto& [robot, triangles] : robots) CHECK_MESSAGE(triangles <= 8000, robot);
  for (const std::string& object : test::object_names()) {
    CAPTURE(object);
    CHECK(test::read_visual(test::object_file(object, "visual.glb")).triangles <= 3000);
  }
  CHECK(test::read_visual(test::asset_path("fixtures/sink/visual.glb")).triangles <= 8000);
}

TEST_CASE("the table's top is at 0.87 m under the whole workspace") {
  const test::Bounds box = test::read_visual(test::asset_path("scenes/table/visual.glb")).box;
  CHECK(box.low.x() <= -0.345);
  CHECK(box.high.z() > 0.87);
  CHECK(box.low.y() <= -0.295);
}

TEST_CASE("a hull drops points inside it, on its faces and on its edges") {
  std::vector<Vec3> points = make::box_points({0, 0, 0}, {1, 2, 3}, 0);
  points.insert(points.end(), {{0.5, 1, 1.5}, {0.5, 1, 3}, {1, 2, 1}, {0, 0, 0}});
  const make::Polyhedron hull = make::convex_hull(points, "box");
  CHECK(hull.vertices.size() == 8);
  CHECK(hull.faces.size() == 6);
}
