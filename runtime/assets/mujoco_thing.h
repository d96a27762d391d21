// The thing in a model: what is rigid in one link, with its mass, and joints between links.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "runtime/base/geometry.h"
#include "runtime/base/result.h"
#include "runtime/mjcf/mass.h"
#include "runtime/mjcf/model.h"
#include "runtime/scene/mesh.h"
#include "runtime/scene/mesh_import.h"

namespace probe::assets {

inline constexpr char kMujocoGenerator[] = "vlaprobe assets mujoco";

// A geom or a site of the model, placed in its link's frame.
template <typename T>
struct Placed {
  const T* it = nullptr;
  Pose pose;
};

struct MujocoLink {
  std::string name;
  int parent = -1;                     // index of links, before its own; -1: the root
  const mjcf::Joint* joint = nullptr;  // by which it moves; null of the root
  Pose at;                             // its frame in its parent's, the joint at 0
  mjcf::MassProperties mass;           // in its frame
  std::vector<Placed<mjcf::Geom>> geoms;
  std::vector<Placed<mjcf::Site>> sites;
};

struct MujocoThing {
  std::vector<MujocoLink> links;  // the root first
  bool is_free = false;           // a free joint is in the file
  double free_damping = 0;        // N s/m and N m s/rad, of that joint
  bool is_wrapped = false;        // robosuite's form
  std::vector<const mjcf::Site*> outside;
  std::vector<const mjcf::Geom*> of_world;  // geoms of the world itself
};

// Meshes are read once, when they are asked for. Fails (kAsset) as load_mesh_file does, and where
// files together, or what was asked for with each mesh counted as often as it was, take minutes.
class MujocoMeshes {
 public:
  explicit MujocoMeshes(const mjcf::Model& model, scene::MeshLimits limits);
  Result<const scene::Mesh*> get(int mesh);

 private:
  const mjcf::Model& model_;
  scene::MeshLimits limits_;
  std::map<int, scene::Mesh> meshes_;
  std::uintmax_t bytes_ = 0, triangles_ = 0;
};

// The thing as convert_mujoco says. A link's frame is its body's, moved to where its joint is.
// Fails as it says.
Result<MujocoThing> find_thing(const mjcf::Model& model, MujocoMeshes& meshes);

// All that stands in the world and does not move, as one link in the world's frame; what moves is
// left out with a note.
MujocoThing standing_things(const mjcf::Model& model, std::vector<std::string>& notes);

}  // namespace probe::assets
