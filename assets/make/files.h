// The bytes of asset files: binary glTF, OBJ, and the manifest over all of them. Knows nothing of
// what the shapes are.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "assets/make/image.h"
#include "assets/make/solid.h"
#include "runtime/base/result.h"

namespace probe::make {

struct Material {
  std::string name;
  Colour base_color{1, 1, 1};    // linear factor; a texture replaces it
  std::optional<Image> texture;  // embedded as PNG
  double roughness = 1;
  // Its light is baked in: black, and its colour is seen whatever the lights are.
  bool is_baked = false;
};

struct Part {
  Surface surface;
  Material material;
};

// A file below the output folder.
struct OutputFile {
  std::string path;
  std::string bytes;
};

// glTF 2.0, binary: one node without a transform, one mesh, one primitive a part. Axes are the
// model's own, z up.
std::string glb_bytes(const std::string& name, const std::vector<Part>& parts);

// One object per polyhedron, no vertex shared between objects, coordinates in metres to a
// micrometre.
std::string obj_bytes(const std::vector<Polyhedron>& parts);

// manifest.json: path, bytes and sha256 of every file, sorted by path.
std::string manifest_bytes(const std::vector<OutputFile>& files);

// Writes all files and manifest.json below `folder`, making folders as needed.
Status write_files(const std::string& folder, std::vector<OutputFile> files);

}  // namespace probe::make
