#include "runtime/assets/hollow.h"

#include <doctest/doctest.h>

#include <cmath>
#include <fstream>
#include <numbers>

#include "runtime/assets/pack.h"
#include "tests/runtime/run/temporary_folder.h"

using namespace probe;
using namespace probe::assets;
using probe::run::TemporaryFolder;

namespace {

// A cup: rings of `n` corners at (radius, height), closed by a middle at both ends.
scene::TriangleSoup turned(const std::vector<std::pair<double, double>>& profile, std::uint32_t n) {
  scene::TriangleSoup soup;
  for (const auto& [radius, height] : profile) {
    for (std::uint32_t i = 0; i < n; ++i) {
      const double angle = 2 * std::numbers::pi * i / n;
      soup.vertices.emplace_back(radius * std::cos(angle), radius * std::sin(angle), height);
    }
  }
  const auto rings = static_cast<std::uint32_t>(profile.size());
  for (std::uint32_t ring = 0; ring + 1 < rings; ++ring) {
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t a = ring * n + i, b = ring * n + (i + 1) % n;
      soup.indices.insert(soup.indices.end(), {a, b, b + n, a, b + n, a + n});
    }
  }
  const auto first = static_cast<std::uint32_t>(soup.vertices.size());
  soup.vertices.emplace_back(0, 0, profile.front().second);
  soup.vertices.emplace_back(0, 0, profile.back().second);
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t k = (i + 1) % n, last = (rings - 1) * n;
    soup.indices.insert(soup.indices.end(), {first, k, i, first + 1, last + i, last + k});
  }
  return soup;
}
// Outside up, over the rim, inside down: 8 cm wide, walls of 5 mm, a floor of 1 cm.
scene::TriangleSoup cup() {
  return turned({{0.04, 0}, {0.04, 0.1}, {0.035, 0.1}, {0.035, 0.01}}, 48);
}

bool is_in(const scene::CollisionShape& shape, const Vec3& p) {
  for (const scene::ConvexPart& part : shape.parts) {
    bool inside = true;
    for (const scene::ConvexPart::Face& face : part.faces)
      inside = inside && face.normal.dot(p - shape.center_of_mass) <= face.offset;
    if (inside) return true;
  }
  return false;
}

std::string obj(const scene::TriangleSoup& soup) {
  std::string out;
  const auto line = [&](const char* word, const auto& a, const auto& b, const auto& c) {
    out += word + (" " + std::to_string(a) + " " + std::to_string(b) + " " + std::to_string(c)) + "\n";
  };
  for (const Vec3& p : soup.vertices) line("v", p.x(), p.y(), p.z());
  for (std::size_t i = 0; i < soup.indices.size(); i += 3)
    line("f", soup.indices[i] + 1, soup.indices[i + 1] + 1, soup.indices[i + 2] + 1);
  return out;
}

}  // namespace

TEST_CASE("a cup that is split keeps its inside free and its walls solid") {
  const scene::TriangleSoup whole = cup();
  const double enclosed = enclosed_volume(whole);
  const double circle = 48 * std::sin(2 * std::numbers::pi / 48) / 2;  // area of its 48-gon
  CHECK(enclosed == doctest::Approx(circle * (0.0016 * 0.1 - 0.001225 * 0.09)).epsilon(1e-9));
  const auto split = split_hollow(whole, "cup");
  REQUIRE_MESSAGE(split.ok(), (split.ok() ? "" : to_text(split.failure())));
  const auto shape = scene::make_mesh_shape(*split, "cup");
  REQUIRE(shape.ok());
  CHECK(shape->parts.size() == 17);  // the floor and 16 sectors of the wall
  CHECK(is_in(*shape, {0, 0, 0.005}));
  for (int i = 0; i < 24; ++i) {
    const double angle = 2 * std::numbers::pi * (i + 0.3) / 24;
    const auto at = [&](double radius, double z) {
      return Vec3(radius * std::cos(angle), radius * std::sin(angle), z);
    };
    CHECK_FALSE(is_in(*shape, at(0, 0.05)));
    CHECK_FALSE(is_in(*shape, at(0.033, 0.05)));
    CHECK_FALSE(is_in(*shape, at(0.033, 0.012)));
    CHECK(is_in(*shape, at(0.0385, 0.05)));
    CHECK(is_in(*shape, at(0.0385, 0.099)));
  }
  // Sectors are flat inside, where the wall is round: they fill a little.
  CHECK(shape->volume > enclosed);
  CHECK(shape->volume < 1.06 * enclosed);
}

TEST_CASE("a bowl's curve is cut into slices, and its inside stays free") {
  const auto split = split_hollow(turned({{0.02, 0}, {0.06, 0.01}, {0.078, 0.03}, {0.08, 0.06},
                                          {0.076, 0.06}, {0.074, 0.031}, {0.057, 0.014}, {0.018, 0.004}},
                                         48),
                                  "bowl");
  REQUIRE(split.ok());
  const auto shape = scene::make_mesh_shape(*split, "bowl");
  REQUIRE(shape.ok());
  CHECK(shape->parts.size() > 17);
  CHECK_FALSE(is_in(*shape, {0, 0, 0.03}));
  CHECK_FALSE(is_in(*shape, {0.05, 0, 0.05}));
  CHECK(is_in(*shape, {0, 0, 0.003}));
}

TEST_CASE("what has no inside is not split") {
  const auto solid = split_hollow(turned({{0.04, 0}, {0.04, 0.1}}, 24), "can");
  REQUIRE_FALSE(solid.ok());
  CHECK(to_text(solid.failure()).find("nothing in it is open upwards") != std::string::npos);
  const auto tube =
      split_hollow(turned({{0.035, 0}, {0.04, 0}, {0.04, 0.1}, {0.035, 0.1}}, 24), "closed");
  CHECK_FALSE(tube.ok());
}

TEST_CASE("assets pack says what is probably not meant, and the lines that declare what it made") {
  TemporaryFolder folder;
  scene::TriangleSoup large = cup();
  for (Vec3& p : large.vertices) p *= 1000;  // millimetres
  std::ofstream(folder / "mug.obj") << obj(large);
  const auto unscaled = pack_asset({folder / "mug.obj", folder / "a/big", "", 1});
  REQUIRE_MESSAGE(unscaled.ok(), (unscaled.ok() ? "" : to_text(unscaled.failure())));
  REQUIRE(unscaled->doubts.size() == 2);
  CHECK(unscaled->doubts[0] == "it is 100 m long: with `--scale 0.001` it would be 10 cm");
  CHECK(unscaled->doubts[1].find("`--hollow` splits what is open upwards") != std::string::npos);
  PackOptions options{folder / "mug.obj", folder / "a/my-mug", "", 0.001};
  options.hollow = true;
  const auto packed = pack_asset(options);
  REQUIRE(packed.ok());
  CHECK(packed->doubts.empty());
  CHECK(packed->made.find("17 convex parts") != std::string::npos);
  CHECK(packed->text ==
        "object my_mug {\n  mesh \"my-mug\"\n  box (-4cm, -4cm, 0cm) .. (4cm, 4cm, 10cm)\n"
        "  density 500kg/m3  # a guess, as is the next line\n  friction 0.5\n"
        "  rest yaw 0deg, yaw 90deg  # how it lies in a layout that turns things\n  unseen\n"
        "  name \"my mug\"\n}\n");
}

TEST_CASE("a size that no thing on a table has is refused where nobody said a scale") {
  TemporaryFolder folder;
  scene::TriangleSoup large = cup();
  for (Vec3& p : large.vertices) p *= 1000;  // millimetres
  std::ofstream(folder / "mug.obj") << obj(large);
  PackOptions options{folder / "mug.obj", folder / "a/mug", "", 1};
  options.refuses_odd_size = true;
  CHECK(to_text(pack_asset(options).failure())
            .find("it is 100 m long: with `--scale 0.001` it would be 10 cm; `--scale 1` packs it as "
                  "it is") != std::string::npos);
  CHECK_FALSE(std::filesystem::exists(options.to));
  options.scale = 0.001;
  CHECK(pack_asset(options).ok());
  CHECK(to_text(pack_asset(options).failure()).find("remove it, or name another with -o") !=
        std::string::npos);
}

TEST_CASE("--up turns the axis of an obj upwards, and is refused where the file says its own") {
  TemporaryFolder folder;
  scene::TriangleSoup lying = cup();
  for (Vec3& p : lying.vertices) p = Vec3(p.x(), p.z(), -p.y());  // y is up
  std::ofstream(folder / "mug.obj") << obj(lying);
  PackOptions options{folder / "mug.obj", folder / "a/mug", "", 1};
  options.up = "y";
  const auto packed = pack_asset(options);
  REQUIRE(packed.ok());
  CHECK_MESSAGE(packed->made.find("box (-4cm, -4cm, 0cm) .. (4cm, 4cm, 10cm)") != std::string::npos,
                packed->made);
  options.up = "up";
  options.to = folder / "a/other";
  CHECK(to_text(pack_asset(options).failure()).find("--up is one of x, y and z") !=
        std::string::npos);
  std::ofstream(folder / "mug.glb") << "";
  options.from = folder / "mug.glb";
  options.up = "y";
  CHECK(to_text(pack_asset(options).failure()).find("says itself which axis points up") !=
        std::string::npos);
}
