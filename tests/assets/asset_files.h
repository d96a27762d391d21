// Readers just good enough for the files that make_assets writes; the tests must not trust the code
// they test.
#pragma once

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "runtime/base/geometry.h"
#include "runtime/base/json.h"

namespace probe::test {

inline std::string asset_path(const std::string& path) {
  return std::string(VLAPROBE_SOURCE_DIR "/assets/") + path;
}

inline std::string read_bytes(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  REQUIRE_MESSAGE(in.good(), "cannot read " << path);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

struct Bounds {
  Vec3 low = Vec3::Constant(1e9), high = Vec3::Constant(-1e9);
  void add(const Vec3& p) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
};

// The header of a binary glTF file.
inline Json glb_header(const std::string& bytes) {
  std::uint32_t length = 0;
  REQUIRE(bytes.size() > 20);
  std::memcpy(&length, bytes.data() + 12, 4);
  REQUIRE(bytes.size() >= 20 + length);
  return Json::parse(bytes.substr(20, length));
}

struct Visual {
  Bounds box;
  std::size_t triangles = 0;
};

// Positions are read from the binary chunk, not from the accessor's min and max.
inline Visual read_visual(const std::string& path) {
  const std::string bytes = read_bytes(path);
  const Json header = glb_header(bytes);
  std::uint32_t length = 0;
  std::memcpy(&length, bytes.data() + 12, 4);
  const std::size_t start = 20 + length + 8;
  Visual visual;
  for (const auto& primitive : header.at("meshes")[0].at("primitives")) {
    const auto& position =
        header["accessors"][primitive["attributes"]["POSITION"].get<std::size_t>()];
    const auto& view = header["bufferViews"][position["bufferView"].get<std::size_t>()];
    const std::size_t count = position["count"].get<std::size_t>();
    REQUIRE(start + view["byteOffset"].get<std::size_t>() + count * 12 <= bytes.size());
    for (std::size_t i = 0; i < count; ++i) {
      std::array<float, 3> p{};
      std::memcpy(p.data(), bytes.data() + start + view["byteOffset"].get<std::size_t>() + i * 12,
                  12);
      visual.box.add({p[0], p[1], p[2]});
    }
    const auto& indices = header["accessors"][primitive["indices"].get<std::size_t>()];
    visual.triangles += indices["count"].get<std::size_t>() / 3;
  }
  return visual;
}

struct ConvexObject {
  std::string name;
  std::vector<Vec3> vertices;
  std::vector<std::vector<std::size_t>> faces;  // into `vertices`
};

inline std::vector<ConvexObject> read_collision(const std::string& path) {
  std::istringstream in(read_bytes(path));
  std::vector<ConvexObject> objects;
  std::size_t before = 0;  // vertices of earlier objects
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    std::string kind;
    words >> kind;
    if (kind == "o") {
      if (!objects.empty()) before += objects.back().vertices.size();
      objects.emplace_back();
      words >> objects.back().name;
    } else if (kind == "v") {
      Vec3 p;
      words >> p.x() >> p.y() >> p.z();
      objects.back().vertices.push_back(p);
    } else if (kind == "f") {
      std::vector<std::size_t> loop;
      for (std::size_t i = 0; words >> i;) {
        REQUIRE(i > before);  // no vertex of another object: connected components are the parts
        REQUIRE(i - before <= objects.back().vertices.size());
        loop.push_back(i - before - 1);
      }
      objects.back().faces.push_back(loop);
    }
  }
  return objects;
}

inline Bounds bounds_of(const std::vector<ConvexObject>& objects) {
  Bounds box;
  for (const ConvexObject& object : objects) {
    for (const Vec3& p : object.vertices) box.add(p);
  }
  return box;
}

// Volume and centroid by tetrahedra from the origin.
struct Solid {
  double volume = 0;
  Vec3 centre = Vec3::Zero();
};
inline Solid solid_of(const std::vector<ConvexObject>& objects) {
  Solid solid;
  for (const ConvexObject& object : objects) {
    for (const auto& loop : object.faces) {
      for (std::size_t i = 2; i < loop.size(); ++i) {
        const Vec3 &a = object.vertices[loop[0]], &b = object.vertices[loop[i - 1]],
                   &c = object.vertices[loop[i]];
        const double volume = a.dot(b.cross(c)) / 6;
        solid.volume += volume;
        solid.centre += volume * (a + b + c) / 4;
      }
    }
  }
  solid.centre /= solid.volume;
  return solid;
}

// Links that collide, as "robot/link".
inline const std::vector<std::string>& link_names() {
  static const std::vector<std::string> names{"widowx/base_link",
                                              "widowx/shoulder_link",
                                              "widowx/upper_arm_link",
                                              "widowx/upper_forearm_link",
                                              "widowx/lower_forearm_link",
                                              "widowx/wrist_link",
                                              "widowx/gripper_link",
                                              "widowx/gripper_prop_link",
                                              "widowx/gripper_bar_link",
                                              "widowx/left_finger_link",
                                              "widowx/right_finger_link",
                                              "panda/link0",
                                              "panda/link1",
                                              "panda/link2",
                                              "panda/link3",
                                              "panda/link4",
                                              "panda/link5",
                                              "panda/link6",
                                              "panda/link7",
                                              "panda/hand",
                                              "panda/left_finger",
                                              "panda/right_finger"};
  return names;
}

// Those that fill a published box.
inline const std::vector<std::string>& published_names() {
  static const std::vector<std::string> names{
      "basket",      "carrot", "coke_can",     "eggplant",  "green_cube", "half_sponge", "keyboard",
      "nut",         "orange", "orange_juice", "pepsi_can", "plate",      "rabbit",      "ramekin",
      "small_plate", "sponge", "spoon",        "towel",     "wheel",      "yellow_cube"};
  return names;
}

// All of them.
inline const std::vector<std::string>& object_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all = published_names();
    for (const char* name :
         {"apple", "baked_7up_can", "baked_apple", "baked_apple_v2", "baked_coke_can",
          "baked_long_sponge", "baked_pepsi_can", "baked_slim_can", "bottle", "bowl", "long_sponge",
          "mug", "slim_can", "tray", "water_bottle", "wicker_basket"})
      all.emplace_back(name);
    return all;
  }();
  return names;
}

inline std::string object_file(const std::string& object, const std::string& file) {
  return asset_path("objects/" + object + "/" + file);
}

// Of "robot/link".
inline std::string link_file(const std::string& link, const std::string& ending) {
  const std::size_t slash = link.find('/');
  return asset_path("robots/" + link.substr(0, slash) + "/meshes" + link.substr(slash) + ending);
}
inline std::string link_mesh(const std::string& link) { return link_file(link, ".glb"); }
inline std::string link_hull(const std::string& link) { return link_file(link, "_collision.obj"); }

}  // namespace probe::test
