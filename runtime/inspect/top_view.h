// A task seen from above, as data: where things may stand, what the robot reaches and what the
// cameras see of the table. Metres in world, x and y. Needs no simulator; of the assets it reads
// the URDFs, for the links that carry the cameras and for fixtures with joints, and the meshes that
// a fixture is felt by.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "runtime/base/asset_root.h"
#include "runtime/base/geometry.h"
#include "runtime/base/result.h"
#include "runtime/plan/plan.h"

namespace probe::inspect {

struct Point {
  double x = 0, y = 0;
  auto operator<=>(const Point&) const = default;
};

enum class Role : std::uint8_t { kSource, kTarget, kDistractor, kOther, kPlaced };

// One way an object stands, with all starts in which it stands so.
struct Footprint {
  Role role = Role::kSource;
  std::string object;
  Point at;                    // model origin
  double yaw_deg = 0;          // of the object's x axis
  std::vector<Point> outline;  // the box seen from above, convex, counter-clockwise
  std::vector<std::uint32_t> starts;
  std::vector<Point> way;  // where its origin goes by itself, corner by corner; empty: it stays
  std::string moves;       // the same in words
};

// As it stands when the robot is in its initial position.
struct TopCamera {
  std::string name;
  Point eye;
  std::vector<Point> image;  // the picture's frame on the surface; empty: it shows none of it
  Point right;               // the picture's right along the ground, unit; 0: it moves with the arm
};

// A link of a fixture with joints, by the boxes around its collision shapes.
struct TopPart {
  std::string name;                          // "cabinet.top_drawer"
  std::vector<std::vector<Point>> outlines;  // as the first episode begins
  std::vector<std::vector<Point>> open;      // its joint at the end of its way; empty: it has none
  std::vector<std::uint32_t> starts;         // that begin so; empty: all
  struct Begun {
    std::vector<std::vector<Point>> outlines;
    std::vector<std::uint32_t> starts;
  };
  std::vector<Begun> others;  // as other starts begin
};
struct TopRegion {
  std::string name;  // "cabinet.inside_top"; one of these for each place where starts have it
  std::vector<Point> outline;
  std::vector<std::uint32_t> starts;  // that have it there; empty: all
};

struct TopView {
  std::string task, prompt;
  std::size_t starts = 0;
  std::array<double, 4> area{};  // x min, y min, x max, y max of the surface
  std::vector<Point> cells;      // where origins stand, ascending
  std::vector<Footprint> footprints;
  std::vector<std::string> sources, targets, distractors;  // object names by role
  struct NamedRole {
    std::string role;  // "helper"; empty: what the layout placed by name
    std::vector<std::string> objects;
  };
  std::vector<NamedRole> others;
  Point base;
  double base_yaw_deg = 0;
  double reach_min = 0, reach_max = 0;
  std::string robot;
  std::vector<TopCamera> cameras;  // in the scene's order
  std::vector<TopPart> parts;
  std::vector<TopRegion> regions;
};

// `asset_root` as the plan's paths are relative to. Fails (kAsset) when the URDF is not the
// one the plan was built with, (kUrdf) when it cannot be used.
Result<TopView> top_view(const plan::Plan& plan, std::uint32_t task, const AssetRoot& asset_root);

// A box seen from above: its outline around (0, 0) without edges shorter than a nanometre. `axes`
// are half of each side, in world.
std::vector<Point> box_outline(const std::array<Vec3, 3>& axes);

}  // namespace probe::inspect
