#include "runtime/scene/hull.h"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <limits>

#include "runtime/base/trig.h"

namespace probe::scene {
namespace {

std::vector<Vec3> box_points(const Vec3& low, const Vec3& high) {
  std::vector<Vec3> points;
  for (int i = 0; i < 8; ++i) {
    points.emplace_back(i & 1 ? high.x() : low.x(), i & 2 ? high.y() : low.y(),
                        i & 4 ? high.z() : low.z());
  }
  return points;
}

// Every point lies behind every face, every loop turns about its normal, edges are shared by two
// faces.
void check_closed(const ConvexPart& part) {
  CHECK(part.vertices.size() <= 64);
  CHECK(part.vertices.size() + part.faces.size() == part.edges.size() + 2);  // Euler
  for (const ConvexPart::Face& face : part.faces) {
    CHECK(face.normal.norm() == doctest::Approx(1));
    double largest = -1e30;
    for (const Vec3& v : part.vertices) largest = std::max(largest, face.normal.dot(v));
    CHECK(largest == face.offset);
    const Vec3 ab = part.vertices[face.loop[1]] - part.vertices[face.loop[0]];
    const Vec3 bc = part.vertices[face.loop[2]] - part.vertices[face.loop[1]];
    CHECK(ab.cross(bc).dot(face.normal) > 0);
  }
  CHECK(part.x.size() % 4 == 0);
}

std::string write_file(const std::string& name, const std::string& text) {
  const std::string path = (std::filesystem::temp_directory_path() / name).string();
  std::ofstream(path) << text;
  return path;
}

constexpr const char* kTwoBoxes =
    "v 0 0 0\nv 10 0 0\nv 0 10 0\nv 10 10 0\nv 0 0 10\nv 10 0 10\nv 0 10 10\nv 10 10 10\n"
    "v 20 0 0\nv 30 0 0\nv 20 10 0\nv 30 10 0\nv 20 0 10\nv 30 0 10\nv 20 10 10\nv 30 10 10\n"
    "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n"
    "f 9/1 11 12 10\nf 13 14 16 15\nf 9 10 14 13\nf -6 -2 -1 -5\nf 9 13 15 11\nf 10 12 16 14\n";

TEST_CASE("a box has six square faces and the textbook inertia") {
  const CollisionShape box = make_box_shape({0.01, 0.02, 0.03});
  REQUIRE(box.parts.size() == 1);
  check_closed(box.parts[0]);
  CHECK(box.volume == doctest::Approx(8 * 0.01 * 0.02 * 0.03));
  CHECK(box.unit_inertia(0, 0) == doctest::Approx(box.volume / 3 * (0.02 * 0.02 + 0.03 * 0.03)));
  CHECK(box.unit_inertia(2, 2) == doctest::Approx(box.volume / 3 * (0.02 * 0.02 + 0.01 * 0.01)));
  CHECK(std::fabs(box.unit_inertia(0, 1)) < 1e-18);
  CHECK(box.bounding_radius == doctest::Approx(std::sqrt(0.0014)));
}

TEST_CASE("a hull of box corners equals the box, wherever it lies") {
  const auto shape = make_collision_shape({box_points({0.1, 0.2, 0.3}, {0.12, 0.24, 0.36})}, "box");
  REQUIRE(shape.ok());
  const CollisionShape box = make_box_shape({0.01, 0.02, 0.03});
  REQUIRE(shape->parts.size() == 1);
  check_closed(shape->parts[0]);
  CHECK(shape->parts[0].faces.size() == 6);
  CHECK(shape->parts[0].edges.size() == 12);
  CHECK((shape->center_of_mass - Vec3(0.11, 0.22, 0.33)).norm() < 1e-12);
  CHECK((shape->unit_inertia - box.unit_inertia).norm() < 1e-9 * box.unit_inertia.norm());
}

TEST_CASE("a ball of many points is reduced to 32 or 64 vertices and stays closed") {
  std::vector<Vec3> points;
  for (int i = 0; i < 400; ++i) {
    const double z = 1 - (2 * i + 1) / 400.0;
    const SinCos a = portable_sincos(2.399963 * i);
    const double r = std::sqrt(1 - z * z);
    points.push_back(0.03 * Vec3(r * a.cos, r * a.sin, z));
  }
  for (const int limit : {32, 64}) {
    const auto shape = make_collision_shape({points}, "ball", {.max_vertices = limit});
    REQUIRE(shape.ok());
    check_closed(shape->parts[0]);
    CHECK(shape->parts[0].vertices.size() <= static_cast<std::size_t>(limit));
    CHECK(shape->volume > 0.8 * 4.18879 * 0.03 * 0.03 * 0.03);
    const auto hull = make_hull(points, "ball", limit);
    REQUIRE(hull.ok());
    CHECK(hull->reduction_error < (limit == 32 ? 0.004 : 0.002));
  }
}

TEST_CASE("components without shared vertices become parts of one body") {
  const std::string path = write_file("vlaprobe_two_boxes.obj", kTwoBoxes);
  const auto shape = load_collision_obj(path, Vec3(0.001, 0.001, 0.001));
  REQUIRE_MESSAGE(shape.ok(), to_text(shape.failure()));
  CHECK(shape->parts.size() == 2);
  CHECK(shape->volume == doctest::Approx(2e-6));
  CHECK((shape->center_of_mass - Vec3(0.015, 0.005, 0.005)).norm() < 1e-12);
  const auto one = load_collision_obj(path, Vec3(0.001, 0.001, 0.001), {.single_hull = true});
  REQUIRE(one.ok());
  CHECK(one->parts.size() == 1);
  CHECK(one->volume == doctest::Approx(3e-6));
  std::filesystem::remove(path);
}

TEST_CASE("a mesh that is no solid is refused with its name") {
  const auto flat = make_collision_shape({box_points({0, 0, 0}, {1, 1, 0})}, "flat.obj");
  REQUIRE(!flat.ok());
  CHECK(flat.failure().where == "flat.obj");
  auto points = box_points({0, 0, 0}, {1, 1, 1});
  points[3].y() = std::numeric_limits<double>::quiet_NaN();
  const auto nan = make_collision_shape({points}, "nan.obj");
  REQUIRE(!nan.ok());
  CHECK(nan.failure().message.find("finite") != std::string::npos);
  CHECK(!make_collision_shape(std::vector<std::vector<Vec3>>{}, "none.obj").ok());
  CHECK(!make_collision_shape({std::vector<Vec3>(9, Vec3(1, 2, 3))}, "point.obj").ok());
}

TEST_CASE("a shape about another centre of mass is the same solid, with the inertia that is given") {
  const CollisionShape box = make_box_shape(Vec3(0.1, 0.2, 0.3));
  Mat3 inertia;
  inertia << 3e-3, 1e-4, 0, 1e-4, 2.5e-3, 0, 0, 0, 1.5e-3;
  const Vec3 center(0.01, -0.02, 0.05);
  const CollisionShape shape = shape_weighing(box, 0.4, center, inertia);
  CHECK(shape.center_of_mass == center);
  CHECK(shape.volume == box.volume);
  const double density = 0.4 / shape.volume;
  CHECK((density * shape.unit_inertia - inertia).norm() < 1e-15);
  REQUIRE(shape.parts.size() == 1);
  for (std::size_t i = 0; i < 8; ++i) {
    const Vec3 there = shape.parts[0].vertices[i] + shape.center_of_mass;
    CHECK((there - box.parts[0].vertices[i]).norm() < 1e-15);
  }
  for (const ConvexPart::Face& face : shape.parts[0].faces)
    CHECK(std::abs(face.normal.dot(shape.parts[0].vertices[face.loop[0]]) - face.offset) < 1e-15);
  CHECK(shape.bounding_radius ==
        doctest::Approx((Vec3(-0.1, 0.2, -0.3) - center).norm()).epsilon(1e-12));
}

TEST_CASE("a mesh file that is missing or broken is refused with file and line") {
  const auto load = [](const std::string& text) {
    const std::string path = write_file("vlaprobe_broken.obj", text);
    const auto result = load_collision_obj(path, Vec3(1, 1, 1));
    std::filesystem::remove(path);
    REQUIRE(!result.ok());
    return to_text(result.failure());
  };
  CHECK(to_text(load_collision_obj("/nowhere/x.obj", Vec3(1, 1, 1)).failure())
            .find("/nowhere/x.obj") == 0);
  CHECK(load("").find("no faces") != std::string::npos);
  CHECK(load("v 0 0 nan\n").find(".obj:1: a vertex is not a finite") != std::string::npos);
  CHECK(load("v 0 0\n").find(".obj:1") != std::string::npos);
  CHECK(load("v 0 0 0\nf 1 2 3\n").find(".obj:2: a face names") != std::string::npos);
}

}  // namespace
}  // namespace probe::scene
