// One MJCF model as an asset of ours: a thing that can be picked up becomes an object, what stands
// and may have drawers, doors and knobs a fixture, a room a backdrop. Files in memory and the text
// of a declaration; nothing is written here.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "runtime/base/geometry.h"
#include "runtime/base/result.h"

namespace probe::assets {

enum class MujocoKind {
  kEither,    // a fixture where a hinge or a slide is in it, else an object
  kObject,    // its `object` declaration
  kFixture,   // its `fixture` declaration, also of what has no joint: a rack, a shelf
  kBackdrop,  // what only is seen: everything that stands in the world and moves on no joint
};

// What code says of a body, a geom or a texture after the file is read, as robosuite's arenas do of
// their tables and LIBERO's of its walls.
struct MujocoChange {
  std::string name;                // of the body, the geom or, where `picture` is said, the texture
  std::optional<Vec3> position;    // m, in its parent's or its body's frame
  std::optional<Vec3> size;        // half sizes, of a geom
  std::optional<double> friction;  // sliding, of a geom
  std::string picture;             // file of a texture, beside the model's own; empty: no change
};

// What code shows of a fixture only while a joint stands so, as robosuite's `vis_site_names` does:
// a site of the file becomes a link that is seen alone.
struct MujocoGlow {
  std::string site, joint;  // names in the file
  double from = 0;          // m or rad, seen there and above
};

struct MujocoOptions {
  std::string file;         // the MJCF
  std::string name;         // identifier to declare it by; empty: from the file's stem
  std::string folder;       // below objects, fixtures or scenes; empty: as `name`
  std::string called;       // what instructions call it; empty: `name` with blanks
  std::string merged_into;  // the MJCF that the model is made a part of, robosuite's base.xml; or
                            // empty (mjcf/read.h)
  MujocoKind kind = MujocoKind::kEither;
  // Of the free joint that code gives an object whose file has none: N s/m and N m s/rad.
  double free_damping = 0;
  std::vector<MujocoChange> changes;
  std::vector<MujocoGlow> glows;  // of a fixture
};

struct MujocoFile {
  std::string path;  // below the asset folder: "objects/butter/visual.glb"
  std::string bytes;
  std::string source;  // what it was made from
};

// A site, in the frame of the part that it moves with.
struct MujocoSite {
  std::string name;
  std::string part;          // as declared; empty: the object, or the fixture's root
  Pose pose;                 // m, in the part's frame
  Vec3 half = Vec3::Zero();  // m, half extents of its box (of a ball the radius thrice, of a
                             // cylinder r, r, half length)
  std::string region;        // by which the declaration has it as a region; empty: it has not
  bool outside = false;      // of the body around the thing: `pose` is as written there
};

struct MujocoJoint {
  std::string name, part;  // as declared; the part that it moves
  bool slides = false;
  double lower = 0, upper = 0;  // m or rad; both 0: it turns without end
};

// A box or a plane that stands in a room and is felt.
struct MujocoSurface {
  std::string body, name;    // names in the file; may be empty
  Pose pose;                 // m, in the world
  Vec3 half = Vec3::Zero();  // of a plane x, y, 0; 0: without end
  double friction = 1;       // sliding
  double top = 0;            // m, the height of its highest corner; of a plane its own
};

struct MujocoAsset {
  MujocoKind kind = MujocoKind::kObject;  // never kEither
  std::string name;
  std::vector<MujocoFile> files;
  std::string declaration;             // "object butter {\n ...}\n", formatted; of a backdrop empty
  std::vector<MujocoSite> sites;       // in the file's order; those outside the thing last
  std::vector<MujocoJoint> joints;     // in the file's order
  double mass = 0;                     // kg, of all of it
  Vec3 center_of_mass = Vec3::Zero();  // m, in the thing's frame, joints at 0
  double friction = 1;                 // sliding, of what is felt
  Vec3 low = Vec3::Zero(),
       high = Vec3::Zero();  // m, bounds of what is felt, in the thing's frame, joints at 0
  std::vector<MujocoSurface> surfaces;  // of a backdrop
  std::vector<std::string>
      notes;  // what is odd, missing or not read, each with file and line where it has one
};

// The thing is the only body of the world, or where that one holds nothing but sites and a body
// `object` (robosuite's form), that one. Its own place in the file does not count: its frame is the
// asset's frame, so poses of a simulation's state are poses of ours. Bodies without joints are one
// with what carries them. Fails (kAsset, where = FILE:LINE) as mjcf::read_model does, on a mesh or
// texture that is missing or no mesh or picture, and on what cannot be made: two joints of one
// body, a change of what is not there, a ball joint, a hinge that moves an object's part,
// nothing that is felt.
Result<MujocoAsset> convert_mujoco(const MujocoOptions& options);

}  // namespace probe::assets
