// Folders of small MJCF files, written by tests.
#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

namespace probe::mjcf {

class MjcfFolder {
 public:
  MjcfFolder() {
    static int made = 0;
    path_ = std::filesystem::temp_directory_path() /
            ("vlaprobe_mjcf_" + std::to_string(::getpid()) + "_" + std::to_string(made++));
    std::filesystem::create_directories(path_);
  }
  ~MjcfFolder() { std::filesystem::remove_all(path_); }
  MjcfFolder(const MjcfFolder&) = delete;
  MjcfFolder& operator=(const MjcfFolder&) = delete;

  std::string write(const std::string& name, std::string_view bytes) const {
    const auto file = path_ / name;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary) << bytes;
    return file.string();
  }
  std::string path(const std::string& name = "") const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

// A .msh file of a box with half sizes x, y, z: 8 vertices, outward faces, texture coordinates
// where wanted.
inline std::string box_msh(float x, float y, float z, bool coordinates = false) {
  std::string out;
  const auto put = [&](const auto& value) {
    out.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  for (const int n : {8, 0, coordinates ? 8 : 0, 12}) put(n);
  for (int i = 0; i < 8; ++i) {
    put(i & 1 ? x : -x);
    put(i & 2 ? y : -y);
    put(i & 4 ? z : -z);
  }
  for (int i = 0; i < (coordinates ? 8 : 0); ++i) {
    put(i & 1 ? 1.0f : 0.0f);
    put(i & 2 ? 1.0f : 0.0f);
  }
  constexpr int kFaces[12][3] = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                                 {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  for (const auto& face : kFaces) {
    for (const int corner : face) put(corner);
  }
  return out;
}

}  // namespace probe::mjcf
