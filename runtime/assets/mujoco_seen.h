// What of a model is seen, as MuJoCo lays textures on: a binary glTF.
#pragma once

#include <map>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "runtime/assets/mujoco_thing.h"
#include "runtime/base/result.h"
#include "runtime/scene/glb_writer.h"
#include "runtime/scene/image.h"

namespace probe::assets {

// The groups that a thing is seen by: those of its geoms that nothing touches where it has some
// (pictures beside collision shapes), else 0 to 2, which MuJoCo's viewer shows.
std::set<int> seen_groups(const std::vector<MujocoLink>& links);

// Pictures that materials name, each read once.
class MujocoPictures {
 public:
  // PNG or JPEG bytes of a texture's file or face as they are, flipped as the texture says and
  // multiplied by `rgba` where that is not white (then PNG). Fails (kAsset, where = the texture's
  // place) naming the file: missing, no picture, more than scene::kMaxImageSide pixels a side.
  Result<scene::EncodedImage> get(const mjcf::Model& model, const mjcf::Texture& texture,
                                  const std::string& file, const mjcf::Rgba& rgba);

 private:
  struct Picture {
    scene::EncodedImage encoded;
    scene::Texture decoded;
  };
  std::map<std::string, Picture> pictures_;
};

// Geoms of `groups` that are not clear. Boxes have faces of 4 x 4 squares, planes squares of the
// side that their third size says, round shapes 28 slices and 16 stacks, as MuJoCo draws them.
// Where a mesh has no texture coordinates, or is no mesh, those of a 2D texture are MuJoCo's
// generated ones, and cube textures are cut at the edges of the cube. `notes` gets what is drawn
// otherwise than there. Empty: nothing of it is seen.
Result<std::string> seen_link(const mjcf::Model& model, const MujocoLink& link,
                              const std::set<int>& groups, const std::string& name,
                              MujocoMeshes& meshes, MujocoPictures& pictures,
                              std::vector<std::string>& notes);

// What is seen of bodies of a model, of each alone and in its own frame: a robot's links. `links`:
// the name to give it, by body; bodies of one name are one, and their frames must be the same.
// Returns binary glTF by name; nothing of what is not seen. Fails as mjcf::read_model and seen_link
// do, and on a body that the file does not have.
Result<std::map<std::string, std::string>> seen_bodies(
    const std::string& file, const std::string& merged_into,
    const std::map<std::string, std::string>& links, std::vector<std::string>& notes);

}  // namespace probe::assets
