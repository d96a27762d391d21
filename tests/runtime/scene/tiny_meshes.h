// The same small box in every format that is read, written out by hand: 2 x 4 x 6 cm on its centre,
// triangles that share corners only in place.
#pragma once

#include <array>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace probe::scene::test {

inline constexpr std::array<double, 3> kHalf{0.01, 0.02, 0.03};  // m

struct Corner {
  double x, y, z;
};

// 36 corners, outward faces.
inline std::vector<Corner> box_corners(double unit = 1) {
  std::vector<Corner> out;
  for (int axis = 0; axis < 3; ++axis) {
    for (int side = -1; side <= 1; side += 2) {
      const auto at = [&](double u, double v) {
        std::array<double, 3> p{};
        const auto a = static_cast<std::size_t>(axis);
        p[a] = side * kHalf[a];
        p[(a + 1) % 3] = u * side * kHalf[(a + 1) % 3];
        p[(a + 2) % 3] = v * kHalf[(a + 2) % 3];
        return Corner{p[0] / unit, p[1] / unit, p[2] / unit};
      };
      for (const Corner& c : {at(-1, -1), at(1, -1), at(1, 1), at(-1, -1), at(1, 1), at(-1, 1)}) {
        out.push_back(c);
      }
    }
  }
  return out;
}

inline std::string number(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", x);
  return text;
}

inline std::string obj_box(const std::string& head = "", double unit = 1) {
  std::string out = head;
  int i = 0;
  for (const Corner& c : box_corners(unit)) {
    out += "v " + number(c.x) + " " + number(c.y) + " " + number(c.z) + "\n";
    if (++i % 3 == 0) {
      out += "f " + std::to_string(i - 2) + " " + std::to_string(i - 1) + " " + std::to_string(i) +
             "\n";
    }
  }
  return out;
}

inline std::string stl_box() {
  std::string out = "solid box\n";
  int i = 0;
  for (const Corner& c : box_corners()) {
    if (i % 3 == 0) out += "facet normal 0 0 0\nouter loop\n";
    out += "vertex " + number(c.x) + " " + number(c.y) + " " + number(c.z) + "\n";
    if (++i % 3 == 0) out += "endloop\nendfacet\n";
  }
  return out + "endsolid box\n";
}

inline std::string binary_stl_box() {
  std::string out(80, ' ');
  const auto corners = box_corners();
  const auto count = static_cast<std::uint32_t>(corners.size() / 3);
  out.append(reinterpret_cast<const char*>(&count), 4);
  for (std::size_t i = 0; i < corners.size(); i += 3) {
    float facet[12] = {};
    for (std::size_t k = 0; k < 3; ++k) {
      facet[3 + 3 * k] = static_cast<float>(corners[i + k].x);
      facet[4 + 3 * k] = static_cast<float>(corners[i + k].y);
      facet[5 + 3 * k] = static_cast<float>(corners[i + k].z);
    }
    out.append(reinterpret_cast<const char*>(facet), sizeof facet);
    out.append(2, '\0');
  }
  return out;
}

// `up`: what the file says, "Z_UP"; `unit`: metres a unit of its numbers; `image`: a texture's
// file.
inline std::string dae_box(const std::string& up, double unit = 1, const std::string& image = "") {
  std::string positions, indices;
  const auto corners = box_corners(unit);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Corner& c = corners[i];
    positions += number(c.x) + " " + number(c.y) + " " + number(c.z) + " ";
    indices += std::to_string(i) + " ";
  }
  const std::string count = std::to_string(corners.size());
  const std::string diffuse =
      image.empty() ? "<color>0.5 0.25 0.125 1</color>" : "<texture texture=\"s\" texcoord=\"t\"/>";
  const std::string library = image.empty() ? ""
                                            : "<library_images><image id=\"i\"><init_from>" +
                                                  image + "</init_from></image></library_images>";
  const std::string parameters =
      image.empty() ? ""
                    : "<newparam sid=\"f\"><surface type=\"2D\"><init_from>i</init_from></surface>"
                      "</newparam><newparam sid=\"s\"><sampler2D><source>f</source></sampler2D>"
                      "</newparam>";
  return "<?xml version=\"1.0\"?><COLLADA "
         "xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" version=\"1.4.1\"><asset>"
         "<unit name=\"u\" meter=\"" +
         number(unit) + "\"/><up_axis>" + up + "</up_axis></asset>" + library +
         "<library_effects><effect id=\"e\"><profile_COMMON>" + parameters +
         "<technique sid=\"c\"><lambert><diffuse>" + diffuse +
         "</diffuse></lambert></technique></profile_COMMON></effect></library_effects>"
         "<library_materials><material id=\"m\"><instance_effect url=\"#e\"/></material>"
         "</library_materials><library_geometries><geometry id=\"g\"><mesh><source id=\"p\">"
         "<float_array id=\"pa\" count=\"" +
         std::to_string(3 * corners.size()) + "\">" + positions +
         "</float_array><technique_common><accessor source=\"#pa\" count=\"" + count +
         "\" stride=\"3\"><param name=\"X\" type=\"float\"/><param name=\"Y\" type=\"float\"/>"
         "<param name=\"Z\" type=\"float\"/></accessor></technique_common></source>"
         "<vertices id=\"v\"><input semantic=\"POSITION\" source=\"#p\"/></vertices>"
         "<triangles material=\"m\" count=\"12\"><input semantic=\"VERTEX\" source=\"#v\" "
         "offset=\"0\"/><p>" +
         indices +
         "</p></triangles></mesh></geometry></library_geometries><library_visual_scenes>"
         "<visual_scene id=\"w\"><node><instance_geometry url=\"#g\"><bind_material>"
         "<technique_common><instance_material symbol=\"m\" target=\"#m\"/></technique_common>"
         "</bind_material></instance_geometry></node></visual_scene></library_visual_scenes>"
         "<scene><instance_visual_scene url=\"#w\"/></scene></COLLADA>";
}

// Positions of the box as bytes, which a .gltf names as `buffer` and a .glb carries; a node moves
// it by 1 m along x and halves it. `colors`: linear RGB of the corners, cycled.
struct GltfBox {
  std::string json, bytes;
};
inline GltfBox gltf_box(const std::string& buffer, const std::vector<float>& colors = {}) {
  GltfBox box;
  const auto corners = box_corners(0.5);
  for (const Corner& c : corners) {
    const float p[] = {static_cast<float>(c.x), static_cast<float>(c.y), static_cast<float>(c.z)};
    box.bytes.append(reinterpret_cast<const char*>(p), sizeof p);
  }
  const std::size_t positions = box.bytes.size();
  for (std::size_t i = 0; !colors.empty() && i < 3 * corners.size(); ++i) {
    box.bytes.append(reinterpret_cast<const char*>(&colors[i % colors.size()]), 4);
  }
  const std::string count = std::to_string(corners.size());
  const std::string uri = buffer.empty() ? "" : "\"uri\":\"" + buffer + "\",";
  box.json =
      R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,)"
      R"("translation":[1,0,0],"scale":[0.5,0.5,0.5]}],"meshes":[{"primitives":[{"attributes":)"
      R"({"POSITION":0)" +
      std::string(colors.empty() ? "" : ",\"COLOR_0\":1") +
      R"(},"material":0}]}],"materials":[{"pbrMetallicRoughness":{"baseColorFactor":)"
      R"([0.5,0.25,0.125,1]}}],"accessors":[{"bufferView":0,"componentType":5126,"count":)" +
      count + R"(,"type":"VEC3","min":[-1,-1,-1],"max":[1,1,1]})" +
      (colors.empty()
           ? ""
           : R"(,{"bufferView":1,"componentType":5126,"count":)" + count + R"(,"type":"VEC3"})") +
      R"(],"bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":)" + std::to_string(positions) +
      "}" +
      (colors.empty() ? ""
                      : R"(,{"buffer":0,"byteOffset":)" + std::to_string(positions) +
                            R"(,"byteLength":)" + std::to_string(positions) + "}") +
      R"(],"buffers":[{)" + uri + R"("byteLength":)" + std::to_string(box.bytes.size()) + "}]}";
  return box;
}

inline std::string glb_file(GltfBox box) {
  const auto chunk = [](std::string body, const char(&type)[5], char filler) {
    while (body.size() % 4 != 0) body += filler;
    const auto size = static_cast<std::uint32_t>(body.size());
    return std::string(reinterpret_cast<const char*>(&size), 4) + std::string(type, 4) + body;
  };
  const std::string body = chunk(box.json, "JSON", ' ') + chunk(box.bytes, "BIN\0", '\0');
  const auto total = static_cast<std::uint32_t>(12 + body.size());
  return std::string("glTF\2\0\0\0", 8) + std::string(reinterpret_cast<const char*>(&total), 4) +
         body;
}

inline std::string write_text(const std::filesystem::path& path, const std::string& text) {
  std::filesystem::create_directories(path.parent_path());
  std::ofstream(path, std::ios::binary) << text;
  return path.string();
}

}  // namespace probe::scene::test
