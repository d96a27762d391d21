// An MJCF model as plain data: metre, kilogram, second, radian; quaternions w x y z; frames as
// MuJoCo has them, z up. What the file leaves to defaults, to classes and to the compiler's
// settings is filled in.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "runtime/base/geometry.h"
#include "runtime/mjcf/xml.h"

namespace probe::mjcf {

inline constexpr int kNone = -1;  // of an index

using Rgba = std::array<double, 4>;  // display values, 0 to 1

// What of `compiler` matters to a reader; MuJoCo 3.2's defaults.
struct Compiler {
  enum class FromGeom { kNever, kAlways, kAuto };
  bool degrees = true;
  bool autolimits = true;
  std::string eulerseq =
      "xyz";  // lower case turns about the axes as they were turned, upper case about fixed ones
  std::string meshdir, texturedir;
  bool strippath = false;
  FromGeom inertia_from_geom = FromGeom::kAuto;
  int first_group = 0, last_group = 5;  // of the geoms that have mass
  bool exact_mesh_inertia = false;
  double bound_mass = 0, bound_inertia = 0;  // least of a moving body
};

struct Texture {
  enum class Type { k2d, kCube, kSkybox };
  enum class Builtin { kFile, kGradient, kChecker, kFlat };
  std::string name;
  Type type = Type::kCube;
  std::string file;                  // as it can be opened; empty: builtin, or `faces`
  std::array<std::string, 6> faces;  // right left up down front back; of a cube alone
  Builtin builtin = Builtin::kFile;
  std::array<double, 3> rgb1{0.8, 0.8, 0.8}, rgb2{0.5, 0.5, 0.5};
  int width = 0, height = 0;  // of a builtin, pixels
  bool flip_across = false, flip_down = false;
  At at;
};

struct Material {
  std::string name;
  int texture = kNone;
  std::array<double, 2> repeat{1, 1};
  bool uniform = false;  // repeats a metre, not an object
  double emission = 0, specular = 0.5, shininess = 0.5, reflectance = 0;
  Rgba rgba{1, 1, 1, 1};
  At at;
};

struct MeshAsset {
  std::string name;
  std::string file;  // as it can be opened
  Vec3 scale = Vec3::Ones();
  Vec3 origin = Vec3::Zero();    // refpos: what becomes 0, in the file's units
  Quat turn = Quat::Identity();  // refquat: what becomes no turn
  enum class Inertia { kVolume, kShell } inertia = Inertia::kVolume;
  At at;
};

enum class Shape { kPlane, kSphere, kCapsule, kEllipsoid, kCylinder, kBox, kMesh };

struct Geom {
  std::string name;  // may be empty
  Shape shape = Shape::kSphere;
  Pose pose;  // in its body's frame
  // m, half sizes: sphere r; capsule r, half length without caps (along z); cylinder r, half
  // length; box and ellipsoid x y z; plane x, y (0: without end)
  Vec3 size = Vec3::Zero();
  int mesh = kNone, material = kNone;
  Rgba rgba{0.5, 0.5, 0.5, 1};  // its own, or its material's
  std::optional<double> mass;   // kg; else by density
  double density = 1000;        // kg/m3
  bool shell = false;           // mass on its surface
  int group = 0, contype = 1, conaffinity = 1, condim = 3;
  std::array<double, 3> friction{1, 0.005, 0.0001};  // sliding; torsional, m; rolling, m
  std::array<double, 2> solref{0.02, 1};
  std::array<double, 5> solimp{0.9, 0.95, 0.001, 0.5, 2};
  double margin = 0;
  At at;

  bool can_touch() const { return contype != 0 || conaffinity != 0; }
};

struct Site {
  std::string name;
  Shape shape = Shape::kSphere;
  Pose pose;                              // in its body's frame
  Vec3 size = Vec3(0.005, 0.005, 0.005);  // as of a geom
  Rgba rgba{0.5, 0.5, 0.5, 1};
  int group = 0;
  At at;
};

enum class Motion { kHinge, kSlide, kBall, kFree };

struct Joint {
  std::string name;
  Motion motion = Motion::kHinge;
  Vec3 position = Vec3::Zero();  // m, in its body's frame
  Vec3 axis{0, 0, 1};            // unit, in its body's frame
  bool limited = false;
  double lower = 0, upper = 0;  // rad or m
  double reference = 0;         // `ref`: its value where the body is as the file has it
  double damping = 0;           // N m s, N s/m
  double friction = 0;          // `frictionloss`: N m, N
  double armature = 0;          // kg m2, kg
  double stiffness = 0;         // N m/rad, N/m
  double rest = 0;              // `springref`: rad or m
  At at;
};

struct Inertial {
  Pose pose;  // of the frame of `inertia`, in the body's frame; its place is the centre of mass
  double mass = 0;
  Mat3 inertia = Mat3::Zero();  // about the centre of mass, in the frame of `pose`
};

struct Camera {
  std::string name;
  Pose pose;        // in its body's frame; looks along -z, y up
  double fovy = 0;  // rad, of the height
  At at;
};

struct Light {
  std::string name;
  Vec3 position = Vec3::Zero(), direction{0, 0, -1};  // in its body's frame
  bool directional = false, casts_shadow = true;
  std::array<double, 3> ambient{0, 0, 0}, diffuse{0.7, 0.7, 0.7}, specular{0.3, 0.3, 0.3};
  std::array<double, 3> attenuation{1, 0, 0};
  double cutoff = 0;  // rad, half of the cone
  double exponent = 10;
  At at;
};

struct Body {
  std::string name;
  int parent = kNone;
  Pose pose;  // in its parent's frame
  std::vector<Joint> joints;
  std::vector<Geom> geoms;
  std::vector<Site> sites;
  std::vector<Camera> cameras;
  std::vector<Light> lights;
  std::optional<Inertial> inertial;
  At at;
};

// What stands in the file and is not in the data, or is not as it was meant.
struct Note {
  At at;
  std::string text;
};

struct Model {
  std::string name;
  Compiler compiler;
  std::vector<Texture> textures;
  std::vector<Material> materials;
  std::vector<MeshAsset> meshes;
  std::vector<Body> bodies;  // parents before children; the first is the world
  std::vector<Note> notes;
  std::vector<std::string> files;

  std::string where(const At& at) const;
};

}  // namespace probe::mjcf
