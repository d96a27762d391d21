// A task seen from above, as data: where things may stand, what the robot reaches and what the
// cameras see of the table. Metres in world, x and y. Needs no simulator and no meshes; of the
// assets it reads only the URDF, for the links that carry the cameras.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

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
};

// As it stands when the robot is in its initial position.
struct TopCamera {
  std::string name;
  Point eye;
  std::vector<Point> image;  // the picture's frame on the surface; empty: it shows none of it
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
};

// `asset_root` as the plan's paths are relative to. Fails (kAsset) when the URDF is not the
// one the plan was built with, (kUrdf) when it cannot be used.
Result<TopView> top_view(const plan::Plan& plan, std::uint32_t task, const std::string& asset_root);

// A box seen from above after a turn: its outline around (0, 0) without edges shorter than a
// nanometre. `half` are half extents along the box's axes, `rotation` is (w, x, y, z).
std::vector<Point> box_outline(const std::array<double, 3>& half,
                               const std::array<double, 4>& rotation);

}  // namespace probe::inspect
