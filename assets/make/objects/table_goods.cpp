// What the Google robot's tasks handle beside cans and an orange of double size: an apple, a slim
// can, a water bottle and a sponge that lies along x. Measures are the released things', shapes and
// colours our own.
#include <string_view>
#include <tuple>

#include "assets/make/generators.h"
#include "assets/make/shapes.h"
#include "runtime/base/trig.h"

namespace probe::make {
namespace {

constexpr double kSide = 0.62;  // gain between an upright wall's and a top's
constexpr double kGloss = 0.01;

// A convex shape from regular polygons (apothem, height, corners), each looking along z.
using Rings = std::initializer_list<std::tuple<double, double, int>>;
std::vector<Vec3> rings(Rings all) {
  std::vector<Vec3> points;
  for (const auto& [apothem, z, corners] : all) {
    for (const Vec3& p : flat_sided(apothem, corners, z)) points.push_back(p);
  }
  return points;
}
// z becomes y.
std::vector<Vec3> laid(std::vector<Vec3> points) {
  for (Vec3& p : points) p = Vec3(p.y(), p.z(), p.x());
  return points;
}

struct Band {
  const char* name;
  std::vector<Vec2> profile;
  Colour lit;
};

// Turned parts that stand along y and fill the box together.
std::vector<OutputFile> standing(const std::string& name, const std::vector<Band>& bands,
                                 const Vec3& size, Rings hull, bool is_baked = false) {
  std::vector<Surface> surfaces;
  for (const Band& band : bands) {
    surfaces.push_back(lathe(band.profile, 48, around_and_along));
    lay_along(surfaces.back(), 1);
  }
  std::vector<Surface*> all;
  for (Surface& surface : surfaces) all.push_back(&surface);
  fit_to_box(all, box_of(size));
  // The hull has the plain thing's name: what is felt is equal to the byte.
  const std::string felt = name.substr(is_baked ? std::string_view("baked_").size() : 0);
  std::vector<Part> parts;
  for (std::size_t i = 0; i < bands.size(); ++i) {
    smooth_normals(surfaces[i], 40);
    parts.push_back(plain_part(std::move(surfaces[i]), bands[i].name,
                               albedo_for(bands[i].lit, kSide, kGloss), 0.4));
  }
  return (is_baked ? baked_files : object_files)(name, parts, {hull_mm(laid(rings(hull)), felt)});
}

// 8 cm each way, a dent above and below; it rests on a flat facet.
std::vector<OutputFile> apple(const std::string& name, bool is_baked) {
  const std::vector<Vec2> profile{{0, 33},   {3, 34},   {9, 38.5}, {16, 40},   {24, 38},
                                  {32, 31},  {38, 20},  {40, 8},   {39, -6},   {35, -20},
                                  {29, -30}, {22, -37}, {15, -40}, {8, -38.5}, {0, -36}};
  Surface skin_of = lathe(profile, 48, around_and_along);
  Surface stalk = rod({.path = {{0, 0, 33}, {1, 0, 37}, {2.5, 0, 39.5}}, .radius = 1.3});
  Surface* both[] = {&skin_of, &stalk};
  fit_to_box(both, box_of({80, 80, 80}));
  smooth_normals(skin_of, 60);
  smooth_normals(stalk, 50);
  return (is_baked ? baked_files : object_files)(
      name,
      {plain_part(skin_of, "skin", albedo_for({178, 34, 30}, kGainUp, kGloss), 0.4),
       plain_part(stalk, "stalk", albedo_for({86, 60, 34}, kGainUp, 0.004), 0.9)},
      {hull_mm(rings({{15, 40, 4}, {40, 8, 12}, {40, -4, 12}, {17, -40, 4}}), "fruit")});
}

// 5.85 cm across and 13.3 cm tall.
std::vector<OutputFile> slim_can(const std::string& name, bool is_baked) {
  return standing(
      name,
      {{"lid", {{0, 64.5}, {22, 64.5}, {23.5, 66.5}, {25, 64.5}}, {196, 199, 204}},
       {"upper", {{25, 64.5}, {29.25, 58}, {29.25, 22}}, {196, 200, 208}},
       {"belt", {{29.25, 22}, {29.25, -20}}, {28, 60, 150}},
       {"lower", {{29.25, -20}, {29.25, -58}, {25, -66.5}, {0, -66.5}}, {196, 200, 208}}},
      {58.5, 133, 58.5}, {{20, 66.5, 4}, {29.25, 58, 12}, {29.25, -58, 12}, {20, -66.5, 4}},
      is_baked);
}

// 10 cm along x, 7 cm along y, 3.6 cm high; a scourer on top.
std::vector<OutputFile> long_sponge(const std::string& name, bool is_baked) {
  const auto slab = [](double low, double high) {
    const double half = (high - low) / 2;
    Surface surface = cushion({.half = {50, 35, half}, .corner = 5, .rim = 1.5}, around_and_along);
    move_points(surface, [&](const Vec3& p) { return Vec3(p.x(), p.y(), p.z() + low + half); });
    return surface;
  };
  Surface foam = slab(-18, 9.5), scourer = slab(9.5, 18);
  Surface* both[] = {&foam, &scourer};
  fit_to_box(both, box_of({100, 70, 36}));
  smooth_normals(foam, 50);
  smooth_normals(scourer, 50);
  return (is_baked ? baked_files : object_files)(
      name,
      {plain_part(foam, "foam", albedo_for({232, 200, 70}, kGainUp, 0.002), 1),
       plain_part(scourer, "scourer", albedo_for({48, 112, 68}, kGainUp, 0.002), 1)},
      {hull_mm(box_points({-50, -35, -18}, {50, 35, 18}, 4), "sponge")});
}

}  // namespace

std::vector<OutputFile> make_apple() { return apple("apple", false); }
std::vector<OutputFile> make_slim_can() { return slim_can("slim_can", false); }
std::vector<OutputFile> make_long_sponge() { return long_sponge("long_sponge", false); }

std::vector<OutputFile> make_baked_goods() {
  std::vector<OutputFile> all;
  for (auto& files : {apple("baked_apple", true), apple("baked_apple_v2", true),
                      slim_can("baked_slim_can", true), long_sponge("baked_long_sponge", true)}) {
    all.insert(all.end(), files.begin(), files.end());
  }
  return all;
}

// 6.0 cm across and 20.3 cm tall, clear blue with a white belt and cap.
std::vector<OutputFile> make_water_bottle() {
  return standing(
      "water_bottle",
      {{"cap", {{0, 101.5}, {14, 101.5}, {15, 100}, {15, 84}, {11, 83}}, {226, 228, 232}},
       {"neck", {{11, 83}, {12, 76}, {22, 58}, {29, 44}, {30, 30}}, {70, 130, 190}},
       {"belt", {{30, 30}, {30, -26}}, {226, 230, 236}},
       {"body", {{30, -26}, {30, -94}, {27, -101.5}, {0, -101.5}}, {70, 130, 190}}},
      {60.1, 203, 60.5},
      {{12, 101.5, 4}, {14, 84, 8}, {30.05, 44, 8}, {30.05, -96, 8}, {23, -101.5, 4}});
}

}  // namespace probe::make
