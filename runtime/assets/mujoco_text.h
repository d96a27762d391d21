// The texts about a thing: its URDF and its declaration.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "runtime/assets/mujoco.h"
#include "runtime/assets/mujoco_felt.h"
#include "runtime/assets/mujoco_thing.h"

namespace probe::assets {

// A name that a text can say: letters, digits and underscores, a letter first.
std::string mujoco_identifier(const std::string& name);

// A link with the files that it is seen and felt by.
struct DescribedLink {
  const MujocoLink* link = nullptr;
  std::string name;  // of the URDF's link, and of the part
  std::string glb;   // file name; empty: nothing is seen
  std::vector<FeltPart> felt;
  std::vector<std::string> meshes;  // file name by felt part; of boxes empty
};
// Behind those that move stand links that are fixed to theirs.
std::string fixture_urdf(const std::string& name, const std::vector<DescribedLink>& links,
                         const std::vector<MujocoJoint>& joints);

struct ObjectText {
  std::string name, folder, called;
  Vec3 low, high;
  double density = 0;                        // kg/m3
  std::optional<mjcf::MassProperties> mass;  // in place of the density, in the thing's frame
  double friction = 1;
  double damping = 0;  // N s/m and N m s/rad
};
std::string object_text(const ObjectText& object, const std::vector<MujocoSite>& sites);

struct GlowText {
  std::string link, joint;  // as declared
  bool slides = false;
  double from = 0;
};

struct FixtureText {
  std::string name, urdf, called;
  double friction = 1;
  std::vector<const mjcf::Joint*> acting;  // by joint
  std::vector<GlowText> glows;
};
std::string fixture_text(const FixtureText& fixture, const std::vector<DescribedLink>& links,
                         const std::vector<MujocoJoint>& joints,
                         const std::vector<MujocoSite>& sites);

}  // namespace probe::assets
