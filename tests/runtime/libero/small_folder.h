// A small folder in the benchmark's form, with one task, and what made-up records are written with.
#pragma once

#include <unistd.h>

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "runtime/libero/import.h"
#include "tests/hex.h"
#include "tests/runtime/libero/small.h"

namespace probe::test {

inline const char* const kSmallTask = "KITCHEN_SCENE1_fill_the_drawer_and_close_it";

struct SmallFolder {
  std::filesystem::path root =
      std::filesystem::temp_directory_path() / ("vlaprobe_libero_" + std::to_string(getpid()));
  SmallFolder() {
    std::filesystem::remove_all(root);
    write("bddl_files/libero_90/" + std::string(kSmallTask) + ".bddl", kSmallProblem);
    const auto states = from_hex(kSmallStates);
    write("init_files/libero_90/" + std::string(kSmallTask) + ".pruned_init",
          {reinterpret_cast<const char*>(states.data()), states.size()});
    write("assets/stable_scanned_objects/cup/cup.xml", model("cup", box("0.03 0.03 0.04")));
    write("assets/turbosquid_objects/lid/lid.xml", model("lid", box("0.04 0.04 0.01")));
    write(
        "assets/articulated_objects/chest.xml",
        model(
            "chest",
            box("0.1 0.1 0.01") +
                R"(<body name="drawer"><joint name="drawer_slide" type="slide" axis="0 1 0" range="-0.16 0.01" damping="50"/>
                       <geom type="box" size="0.08 0.08 0.005" pos="0 0 0.06" group="0" density="100"/>
                       <site name="drawer" type="box" pos="0 0 0.1" size="0.07 0.06 0.03" quat="0.7071068 0 0.7071068 0"/></body>)"));
    write(
        "robosuite/base.xml",
        R"(<mujoco model="base"><compiler angle="radian" inertiagrouprange="0 0"/><worldbody/></mujoco>)");
  }
  ~SmallFolder() { std::filesystem::remove_all(root); }

  static std::string box(const std::string& size) {
    return "<geom type=\"box\" size=\"" + size +
           "\" pos=\"0 0 0.04\" group=\"0\" density=\"100\" friction=\"0.95 0.3 0.1\"/>"
           "<geom type=\"box\" size=\"" +
           size +
           "\" pos=\"0 0 0.04\" group=\"1\" contype=\"0\" conaffinity=\"0\" rgba=\"0.5 0.2 0.1 "
           "1\"/>";
  }
  static std::string model(const std::string& name, const std::string& inside) {
    return "<mujoco model=\"" + name + "\"><worldbody><body><body name=\"object\">" + inside +
           "</body><site name=\"bottom_site\" pos=\"0 0 -0.06\" size=\"0.005\" rgba=\"0 0 0 0\"/>"
           "</body></worldbody></mujoco>";
  }
  void write(const std::string& path, std::string_view bytes) const {
    std::filesystem::create_directories((root / path).parent_path());
    std::ofstream(root / path, std::ios::binary) << bytes;
  }
  Result<libero::ImportReport> import(const std::string& to = "out") const {
    std::filesystem::remove_all(root / to);
    libero::ImportOptions options;
    options.from = root.string();
    options.robosuite = (root / "robosuite").string();
    options.to = (root / to).string();
    options.own = VLAPROBE_SOURCE_DIR "/assets";
    return libero::import_libero(options);
  }
};

inline std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

// A matrix of float64 as numpy writes it.
inline std::string npy(const std::vector<std::vector<double>>& rows) {
  std::string header = "{'descr': '<f8', 'fortran_order': False, 'shape': (" +
                       std::to_string(rows.size()) + ", " + std::to_string(rows[0].size()) + "), }";
  while ((10 + header.size() + 1) % 64 != 0) header += ' ';
  header += '\n';
  std::string out = "\x93NUMPY\x01";
  out += '\0';
  out += static_cast<char>(header.size() & 0xff);
  out += static_cast<char>(header.size() >> 8);
  out += header;
  for (const auto& row : rows) {
    const std::size_t at = out.size();
    out.resize(at + row.size() * sizeof(double));
    std::memcpy(out.data() + at, row.data(), row.size() * sizeof(double));
  }
  return out;
}

// An array of bytes as numpy writes it; `shape` as Python has it: "(3,)".
inline std::string npy(const std::string& descr, const std::string& shape,
                       const std::string& bytes) {
  std::string header =
      "{'descr': '" + descr + "', 'fortran_order': False, 'shape': " + shape + ", }";
  while ((10 + header.size() + 1) % 64 != 0) header += ' ';
  header += '\n';
  std::string out("\x93NUMPY\x01\0", 8);
  out += static_cast<char>(header.size() & 0xff);
  out += static_cast<char>(header.size() >> 8);
  return out + header + bytes;
}

// A zip archive of stored members: names and bytes.
inline std::string stored_zip(const std::vector<std::pair<std::string, std::string>>& members) {
  const auto number = [](std::uint64_t value, int count) {
    std::string out;
    for (int i = 0; i < count; ++i) out += static_cast<char>((value >> (8 * i)) & 0xff);
    return out;
  };
  std::string locals, centrals;
  for (const auto& [name, bytes] : members) {
    std::uint32_t crc = 0xffffffffU;
    for (const char c : bytes) {
      crc ^= static_cast<std::uint8_t>(c);
      for (int k = 0; k < 8; ++k) crc = (crc >> 1) ^ (0xedb88320U & (0U - (crc & 1)));
    }
    const std::string common = number(20, 2) + number(0, 2) + number(0, 2) + number(0, 4) +
                               number(~crc, 4) + number(bytes.size(), 4) +
                               number(bytes.size(), 4) + number(name.size(), 2) + number(0, 2);
    centrals += "PK\x01\x02" + number(20, 2) + common + number(0, 2) + number(0, 2) + number(0, 2) +
                number(0, 4) + number(locals.size(), 4) + name;
    locals += "PK\x03\x04" + common + name + bytes;
  }
  return locals + centrals + "PK\x05\x06" + number(0, 4) + number(members.size(), 2) +
         number(members.size(), 2) + number(centrals.size(), 4) + number(locals.size(), 4) +
         number(0, 2);
}
inline std::string stored_zip(const std::string& name, const std::string& bytes) {
  return stored_zip({{name, bytes}});
}

}  // namespace probe::test
