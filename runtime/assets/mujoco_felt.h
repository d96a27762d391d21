// What of a model is felt: convex parts.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "runtime/assets/mujoco_thing.h"
#include "runtime/base/result.h"

namespace probe::assets {

inline constexpr int kMostCorners = 64;  // of a hull

struct FeltPart {
  std::vector<Vec3> corners;  // m, in the link's frame
  std::vector<std::array<std::uint32_t, 3>> triangles;
  struct Box {
    Vec3 half;
    Pose pose;
  };
  std::optional<Box> box;  // where it is one
  std::string kind;        // what it was: "capsule"
};

// The parts of a link's geoms that can be touched: boxes by their corners, a cylinder as a prism of
// 32 sides, capsules, balls and ellipsoids as polyhedra of 62 corners on their surface, a mesh as
// its convex hull of at most 64 corners. `notes` gets what that changes. Of two at one place and of
// one size both stay where parts weigh by what they fill
// (`keep_doubles`): MuJoCo counts both.
Result<std::vector<FeltPart>> felt_parts(const mjcf::Model& model, const MujocoLink& link,
                                         MujocoMeshes& meshes, bool keep_doubles,
                                         std::vector<std::string>& notes);

// A Wavefront file of them, no vertex shared between parts.
std::string felt_obj(const std::vector<FeltPart>& parts);

}  // namespace probe::assets
