// Which file a path inside an asset means. Files name each other by relative paths; none may lead
// out of the asset folder, by dots or by a link.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <string_view>

#include "runtime/base/result.h"

namespace probe {

// A folder out of which no path may lead; where it really lies is asked of the system once.
class AssetFolder {
 public:
  explicit AssetFolder(const std::filesystem::path& root);

  // The absolute path of `written`, read from a file in `folder`, backslashes taken as slashes.
  // Fails (kAsset, where = written) on an absolute path, a drive or a URL, on one that leads out
  // of the root as written or through a symbolic link, and where no file is.
  Result<std::string> resolve(const std::filesystem::path& folder,
                              const std::string& written) const;
  // The same, of a path from the root.
  Result<std::string> resolve(const std::string& written) const { return resolve(root_, written); }

 private:
  std::filesystem::path root_;  // absolute, as written
  std::filesystem::path real_;  // behind its links; empty where it is not there
};

// AssetFolder(root).resolve(folder, written)
Result<std::string> resolve_inside(const std::filesystem::path& folder, const std::string& written,
                                   const std::filesystem::path& root);

// ".glb" of "Mug.GLB".
std::string lower_extension(const std::filesystem::path& path);

// What is read, in the order in which a folder is searched.
inline constexpr std::array<std::string_view, 5> kMeshExtensions{".glb", ".gltf", ".dae", ".obj",
                                                                 ".stl"};
inline constexpr std::array<std::string_view, 3> kPhotoExtensions{".png", ".jpg", ".jpeg"};

}  // namespace probe
