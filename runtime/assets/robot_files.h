// A robot description and its meshes as this program keeps them: the text as it was, but for the
// mesh elements, which name converted files beside it.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/scene/mesh_import.h"

namespace probe::assets {

struct MeshElement {
  std::string file;   // as written
  std::string scale;  // as written: "0.001 0.001 0.001"; empty when there is none
  bool is_collision = false;
};

// `text` with every <mesh> element replaced by <mesh filename="..."/> naming what `rename` gives.
// Comments stay as they are.
Result<std::string> replace_meshes(
    const std::string& text, const std::function<Result<std::string>(const MeshElement&)>& rename);

// A file of the URDF in `folder`: relative to it, or package://NAME/... where NAME is a folder
// above it. Nothing outside `root`.
Result<std::string> resolve_urdf_file(const std::string& folder, const std::string& written,
                                      const std::string& root);

struct RobotFiles {
  struct File {
    std::string path;  // below the description's folder
    std::string bytes;
    std::string source;
    bool is_untextured = false;  // to be seen, in colours alone
  };
  std::string urdf;
  std::vector<File> meshes;
};

// Reads and checks the description and converts every mesh it names, scales baked in. Fails as
// robot::load_urdf and the mesh readers do. Files may stand anywhere below limits.asset_root.
Result<RobotFiles> convert_robot(const std::string& urdf, const scene::MeshLimits& limits);

}  // namespace probe::assets
