// Stage 2, the records of what tasks are made from: assets, objects, robots, cameras, lights,
// scenes, views.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "runtime/plan/masses.h"
#include "runtime/plan/verify.h"
#include "runtime/plan/verify_records.h"

namespace probe::plan {

bool is_asset_path(std::string_view path) {
  if (path.starts_with('/') || path.find('\\') != std::string_view::npos) return false;
  while (!path.empty()) {
    const std::size_t slash = std::min(path.find('/'), path.size());
    const std::string_view part = path.substr(0, slash);
    if (part.empty() || part == "." || part == "..") return false;
    path.remove_prefix(std::min(slash + 1, path.size()));
  }
  return true;
}

Status RecordCheck::check(const AssetRecord& a) const {
  PROBE_TRY(check_name(a.path, "the path of an asset"));
  if (!is_asset_path(t.text(a.path))) {
    return fail(Rule::kAssetPath, &a.path,
                fmt::format("asset path `{}` leads out of the asset folder", t.text(a.path)));
  }
  if (a.kind < static_cast<std::uint32_t>(AssetKind::kVisualMesh) ||
      a.kind > static_cast<std::uint32_t>(AssetKind::kPhoto)) {
    return fail(Rule::kAssetKind, &a.kind, fmt::format("asset kind {} is not known", a.kind));
  }
  PROBE_TRY(check_zero(a.zero));
  if (a.byte_size == 0)
    return fail(Rule::kAssetSize, &a.byte_size, "an asset has at least one byte");
  return check_zero({&a.zero2, 1});
}

Status RecordCheck::check_friction(const double& value) const {
  PROBE_TRY(check_not_negative(value, "a friction"));
  return check_magnitude(value, Magnitude::kFriction);
}

Status RecordCheck::check_length(const double& value, const char* what) const {
  PROBE_TRY(check_not_negative(value, what));
  return check_magnitude(value, Magnitude::kLength);
}

Status RecordCheck::check(const ObjectRecord& o) const {
  PROBE_TRY(check_word(o.name, "the name of an object"));
  PROBE_TRY(check_text(o.text));
  PROBE_TRY(check_asset(o.visual, AssetKind::kVisualMesh, true));
  PROBE_TRY(check_asset(o.collision, AssetKind::kCollisionMesh, true));
  PROBE_TRY(check_magnitude(o.box_min, Magnitude::kPlace));
  PROBE_TRY(check_magnitude(o.box_max, Magnitude::kPlace));
  for (std::size_t i = 0; i < 3; ++i) {
    if (!(o.box_min[i] < o.box_max[i]))
      return fail(Rule::kBox, &o.box_min[i], "a box has a positive extent on each axis");
    PROBE_TRY(check_magnitude(o.box_max[i] - o.box_min[i], Magnitude::kExtent, o.box_min[i]));
  }
  PROBE_TRY(check_slice(o.mass, t.masses.size(), "MASS"));
  if (o.mass.count == 0) PROBE_TRY(check_positive(o.density, "a density"));
  if (o.mass.count != 0 && o.density != 0)
    return fail(Rule::kMass, &o.density, "an object has a density or a mass, not both");
  PROBE_TRY(check_magnitude(o.density, Magnitude::kDensity));
  PROBE_TRY(check_friction(o.friction));
  if (o.scale != 0 && !(o.scale >= kMinScale && o.scale <= kMaxScale))
    return fail(
        Rule::kScale, &o.scale,
        fmt::format("an object is scaled by {} to {}, not {}", kMinScale, kMaxScale, o.scale));
  if (o.paint[3] > 1 || (o.paint[3] == 0 && o.paint != std::array<std::uint8_t, 4>{}))
    return fail(Rule::kPaint, &o.paint, "an object is painted (1) or not (0, and no colour)");
  PROBE_TRY(check_slice(o.cover, t.covers.size(), "COVR"));
  PROBE_TRY(check_slice(o.damping, t.dampings.size(), "DAMP"));
  return check_zero(o.zero);
}

Status RecordCheck::check(const DampingRecord& d) const {
  for (const double& value : {std::cref(d.shift), std::cref(d.turn)}) {
    PROBE_TRY(check_not_negative(value, "a damping"));
    PROBE_TRY(check_magnitude(value, Magnitude::kGain));
  }
  if (d.shift == 0 && d.turn == 0)
    return fail(Rule::kDamping, &d, "a damping resists nothing");
  return {};
}

Status RecordCheck::check(const MassRecord& m) const {
  PROBE_TRY(check_positive(m.mass, "a mass"));
  PROBE_TRY(check_magnitude(m.mass, Magnitude::kMass));
  PROBE_TRY(check_magnitude(m.centre, Magnitude::kPlace));
  PROBE_TRY(check_magnitude(m.inertia, Magnitude::kInertia));
  if (m.inertia == std::array<double, 6>{}) {
    if (m.centre == std::array<double, 3>{}) return {};
    return fail(Rule::kMass, &m.centre, "a mass with a centre has an inertia");
  }
  if (const auto wrong = inertia_fault(m.inertia)) return fail(Rule::kMass, &m.inertia, *wrong);
  return {};
}

Status RecordCheck::check(const DriveRecord& d) const {
  PROBE_TRY(check_name(d.joint, "the joint of a drive"));
  PROBE_TRY(check_not_negative(d.stiffness, "a stiffness"));
  PROBE_TRY(check_not_negative(d.damping, "a damping"));
  PROBE_TRY(check_magnitude(d.stiffness, Magnitude::kGain));
  PROBE_TRY(check_magnitude(d.damping, Magnitude::kGain));
  PROBE_TRY(check_positive(d.limit, "the limit of a drive"));
  return check_magnitude(d.limit, Magnitude::kForce);
}

Status RecordCheck::check(const RobotRecord& r) const {
  PROBE_TRY(check_word(r.name, "the name of a robot"));
  PROBE_TRY(check_name(r.tcp, "the tool centre point"));
  PROBE_TRY(check_asset(r.urdf, AssetKind::kUrdf, false));
  if (r.control < static_cast<std::uint32_t>(Control::kEeDeltaPose) ||
      r.control > static_cast<std::uint32_t>(Control::kEeDeltaInterpolated)) {
    return fail(Rule::kControl, &r.control, fmt::format("control law {} is not known", r.control));
  }
  PROBE_TRY(check_positive(r.control_hz, "a control rate"));
  PROBE_TRY(check_magnitude(r.control_hz, Magnitude::kControlRate));
  for (const FingerRecord& finger : r.fingers) {
    if (finger.link.length != 0) {
      PROBE_TRY(check(finger));
    } else if (finger.link.offset != 0 || finger.opens != std::array<double, 3>{}) {
      return fail(Rule::kFingerOrder, &finger, "a finger that opens has a link");
    }
  }
  PROBE_TRY(check_magnitude(r.grip_closed, Magnitude::kJointPosition));
  PROBE_TRY(check_magnitude(r.grip_open, Magnitude::kJointPosition));
  PROBE_TRY(check_friction(r.finger_friction));
  PROBE_TRY(check_length(r.finger_patch, "a patch radius"));
  PROBE_TRY(check_friction(r.link_friction));
  PROBE_TRY(check_length(r.reach_min, "a reach"));
  PROBE_TRY(check_length(r.reach_max, "a reach"));
  if (r.reach_min > r.reach_max)
    return fail(Rule::kReach, &r.reach_min, "the least reach is not more than the greatest");
  PROBE_TRY(check_slice(r.law, t.laws.size(), "LAWS"));
  PROBE_TRY(check_slice(r.gears, t.gears.size(), "GEAR"));
  PROBE_TRY(check_slice(r.more_fingers, t.fingers.size(), "FING"));
  PROBE_TRY(check_slice(r.drives, t.drives.size(), "DRIV"));
  if (r.drives.count == 0 || r.drives.count > kMaxDrives) {
    return fail(Rule::kDriveCount, &r.drives,
                fmt::format("a robot has 1 to {} drives, not {}", kMaxDrives, r.drives.count));
  }
  PROBE_TRY(check_slice(r.meshes, t.list.size(), "LIST"));
  if (r.meshes.count > kMaxMeshes) {
    return fail(Rule::kMeshCount, &r.meshes,
                fmt::format("a robot names at most {} meshes, not {}", kMaxMeshes, r.meshes.count));
  }
  for (const std::uint32_t& mesh : slice_of(t.list, r.meshes)) {
    PROBE_TRY(check_index(mesh, t.assets.size(), "ASST"));
  }
  return {};
}

Status RecordCheck::check(const CameraRecord& c) const {
  PROBE_TRY(check_word(c.name, "the name of a camera"));
  PROBE_TRY(check_name(c.mount_link, "the mount of a camera"));
  PROBE_TRY(check_magnitude(c.position, Magnitude::kPlace));
  PROBE_TRY(check_finite(c.aim_values));
  if (c.aim == static_cast<std::uint32_t>(CameraAim::kLook)) {
    if (c.aim_values[0] == 0 && c.aim_values[1] == 0 && c.aim_values[2] == 0) {
      return fail(Rule::kCameraDirection, &c.aim_values,
                  "a camera looks in a direction other than zero");
    }
    const auto& look = c.aim_values;
    PROBE_TRY(
        check_magnitude(std::hypot(look[0], look[1], look[2]), Magnitude::kDirection, look[0]));
    if (c.aim_values[3] != 0)
      return fail(Rule::kCameraFourth, &c.aim_values[3],
                  "the fourth number of a direction is zero");
  } else if (c.aim == static_cast<std::uint32_t>(CameraAim::kQuat)) {
    PROBE_TRY(check_unit(c.aim_values, "the quaternion of a camera"));
  } else {
    return fail(Rule::kCameraAim, &c.aim,
                fmt::format("a camera aims by 1 (look) or 2 (quat), not {}", c.aim));
  }
  if (c.width < 1 || c.width > kMaxPixels || c.height < 1 || c.height > kMaxPixels) {
    return fail(Rule::kImageSize, &c.width,
                fmt::format("an image has 1 to {} pixels a side, not {} x {}", kMaxPixels, c.width,
                            c.height));
  }
  if (c.samples != 0 && c.samples != 4 && c.samples != 16) {
    return fail(Rule::kCameraSamples, &c.samples,
                fmt::format("a pixel has 0 (one), 4 or 16 samples, not {}", c.samples));
  }
  PROBE_TRY(check_positive(c.fx, "a focal length"));
  PROBE_TRY(check_positive(c.fy, "a focal length"));
  PROBE_TRY(check_magnitude(c.fx, Magnitude::kFocal));
  PROBE_TRY(check_magnitude(c.fy, Magnitude::kFocal));
  PROBE_TRY(check_magnitude(c.cx, Magnitude::kPixel));
  PROBE_TRY(check_magnitude(c.cy, Magnitude::kPixel));
  return check_slice(c.sensor, t.sensors.size(), "SENS");
}

Status RecordCheck::check(const SunRecord& s) const {
  PROBE_TRY(check_finite(s.direction));
  if (s.direction == std::array<double, 3>{0, 0, 0}) {
    return fail(Rule::kSunDirection, &s.direction, "light travels in a direction other than zero");
  }
  PROBE_TRY(check_magnitude(std::hypot(s.direction[0], s.direction[1], s.direction[2]),
                            Magnitude::kDirection, s.direction[0]));
  PROBE_TRY(check_not_negative(s.power, "the power of a sun"));
  PROBE_TRY(check_magnitude(s.power, Magnitude::kLight));
  if (s.shadow > 1) return fail(Rule::kSunShadow, &s.shadow, "a sun casts shadows (1) or none (0)");
  return check_zero(s.zero);
}

Status RecordCheck::check(const LampRecord& l) const {
  const auto kind = static_cast<LampKind>(l.kind);
  const bool is_spot = kind == LampKind::kSpot, is_sun = kind == LampKind::kSun;
  if (!is_spot && !is_sun && kind != LampKind::kHeadlight)
    return fail(Rule::kLamp, &l.kind, "a lamp is a spot (1), a sun (2) or a headlight (3)");
  PROBE_TRY(check_finite(l.position));
  PROBE_TRY(check_finite(l.direction));
  PROBE_TRY(check_finite(l.fade));
  constexpr std::array<double, 3> kNothing{};
  if (!is_spot && l.position != kNothing)
    return fail(Rule::kLamp, &l.position, "only a spot has a place");
  if ((is_spot || is_sun) == (l.direction == kNothing))
    return fail(Rule::kLamp, &l.direction, "a spot and a sun have a direction, a headlight none");
  for (const double& along : l.position) PROBE_TRY(check_magnitude(along, Magnitude::kPlace));
  if (is_spot || is_sun) {
    PROBE_TRY(check_magnitude(std::hypot(l.direction[0], l.direction[1], l.direction[2]),
                              Magnitude::kDirection, l.direction[0]));
  }
  for (const double* strength : {&l.power, &l.specular, &l.ambient}) {
    PROBE_TRY(check_not_negative(*strength, "the strength of a lamp"));
    PROBE_TRY(check_magnitude(*strength, Magnitude::kLight));
  }
  constexpr double kQuarter = 1.5707963267948966;
  if (!(l.cutoff >= 0 && l.cutoff <= (is_spot ? kQuarter : 0)))
    return fail(Rule::kLamp, &l.cutoff,
                "a spot's cutoff is at most a quarter turn, others have none");
  if (!(l.exponent >= 0 && l.exponent <= (is_spot ? 128 : 0)))
    return fail(Rule::kLamp, &l.exponent, "a spot's exponent is 0 to 128, others have none");
  for (const double& factor : l.fade) {
    PROBE_TRY(check_not_negative(factor, "the fading of a lamp"));
    PROBE_TRY(check_magnitude(factor, Magnitude::kLight));
    if (is_sun && factor != 0) return fail(Rule::kLamp, &l.fade, "a sun does not fade");
  }
  return check_zero(l.zero);
}

Status RecordCheck::check(const LightRecord& l) const {
  PROBE_TRY(check_word(l.name, "the name of a light"));
  PROBE_TRY(check_not_negative(l.ambient, "ambient light"));
  PROBE_TRY(check_magnitude(l.ambient, Magnitude::kLight));
  PROBE_TRY(check_slice(l.suns, t.suns.size(), "SUNS"));
  if (l.suns.count > kMaxSuns) {
    return fail(Rule::kSunCount, &l.suns,
                fmt::format("a light has at most {} suns, not {}", kMaxSuns, l.suns.count));
  }
  if (l.occlusion > kMaxOcclusion) {
    return fail(Rule::kOcclusion, &l.occlusion,
                fmt::format("ambient light is traced by at most {} rays, not {}", kMaxOcclusion,
                            l.occlusion));
  }
  for (const double& channel : l.color) {
    PROBE_TRY(check_not_negative(channel, "the colour of a light"));
    PROBE_TRY(check_magnitude(channel, Magnitude::kLight));
  }
  PROBE_TRY(check_slice(l.lamps, t.lamps.size(), "LAMP"));
  if (l.lamps.count > kMaxSuns)
    return fail(Rule::kLamp, &l.lamps,
                fmt::format("a light has at most {} lamps, not {}", kMaxSuns, l.lamps.count));
  if (l.shading > 1)
    return fail(Rule::kShading, &l.shading,
                "a light lights pixels (0) or corners of triangles (1)");
  if (l.shading == 0 && l.lamps.count > 0)
    return fail(Rule::kShading, &l.lamps, "lamps light corners of triangles, no pixels");
  if (l.shading == 1 && (l.suns.count > 0 || l.occlusion > 0))
    return fail(Rule::kShading, &l.suns, "corners of triangles have no suns and no occlusion");
  return {};
}

Status RecordCheck::check(const SceneRecord& s) const {
  PROBE_TRY(check_word(s.name, "the name of a scene"));
  PROBE_TRY(check_index(s.robot, t.robots.size(), "ROBT"));
  PROBE_TRY(check_asset(s.photo, AssetKind::kPhoto, true));
  PROBE_TRY(check_asset(s.backdrop, AssetKind::kVisualMesh, true));
  PROBE_TRY(check_asset(s.fixture_visual, AssetKind::kVisualMesh, true));
  PROBE_TRY(check_asset(s.fixture_collision, AssetKind::kCollisionMesh, true));
  if (s.backdrop_stands > 1 || (s.backdrop_stands == 1 && s.backdrop == kNone) ||
      (s.backdrop_stands == 0 && s.backdrop_z != 0))
    return fail(Rule::kBackdrop, &s.backdrop_stands,
                "a backdrop stands (1) or not (0, and no height), and one that stands is there");
  PROBE_TRY(check_magnitude(s.backdrop_z, Magnitude::kPlace));
  PROBE_TRY(check_magnitude(s.fixture_position, Magnitude::kPlace));
  PROBE_TRY(check_magnitude(s.base_position, Magnitude::kPlace));
  PROBE_TRY(check_unit(s.base_rotation, "the rotation of a robot's base"));
  const RobotRecord& r = t.robots[s.robot];
  PROBE_TRY(check_slice(s.joints, t.reals.size(), "REAL"));
  if (s.joints.count != r.drives.count) {
    return fail(Rule::kJointCount, &s.joints,
                fmt::format("a scene gives {} joint positions, its robot has {} drives",
                            s.joints.count, r.drives.count));
  }
  PROBE_TRY(check_magnitude(slice_of(t.reals, s.joints), Magnitude::kJointPosition));
  PROBE_TRY(check_magnitude(s.surface_z, Magnitude::kPlace));
  PROBE_TRY(check_magnitude(s.area, Magnitude::kPlace));
  if (!(s.area[0] < s.area[2]) || !(s.area[1] < s.area[3])) {
    return fail(Rule::kArea, &s.area, "the area of a surface has a positive extent on each axis");
  }
  for (const std::size_t i : {std::size_t{0}, std::size_t{1}})
    PROBE_TRY(check_magnitude(s.area[i + 2] - s.area[i], Magnitude::kExtent, s.area[i]));
  PROBE_TRY(check_positive(s.physics_hz, "a physics rate"));
  PROBE_TRY(check_magnitude(s.physics_hz, Magnitude::kPhysicsRate));
  const double substeps = s.physics_hz / r.control_hz;
  if (!(substeps >= 1 && substeps <= kMaxSubsteps && substeps == std::floor(substeps))) {
    return fail(Rule::kSubsteps, &s.physics_hz,
                fmt::format("a control step has a whole number of physics steps up to {}, not {}",
                            kMaxSubsteps, substeps));
  }
  PROBE_TRY(check_friction(s.friction));
  PROBE_TRY(check_slice(s.fixtures, t.list.size(), "LIST"));
  for (const std::uint32_t& fixture : slice_of(t.list, s.fixtures))
    PROBE_TRY(check_index(fixture, t.fixtures.size(), "FIXT"));
  for (const double* of_air : {&s.air_density, &s.air_viscosity}) {
    PROBE_TRY(check_not_negative(*of_air, "a density or viscosity of air"));
    PROBE_TRY(check_magnitude(*of_air, Magnitude::kAir));
  }
  PROBE_TRY(check_slice(s.covers, t.covers.size(), "COVR"));
  return check_zero(s.zero2);
}

Status RecordCheck::check(const ViewRecord& v) const {
  PROBE_TRY(check_word(v.name, "the name of a camera in its scene"));
  PROBE_TRY(check_index(v.camera, t.cameras.size(), "CAMR"));
  return check_asset(v.photo, AssetKind::kPhoto, true);
}

}  // namespace probe::plan
