#include "runtime/inspect/ground_image.h"

#include <array>
#include <cstddef>

namespace probe::inspect {

std::vector<Vec3> frame_on_plane(const Pinhole& camera, double plane_z, double far) {
  const double above = camera.eye.z() - plane_z;
  if (!(above > 0)) return {};
  // The frame as directions of unit depth; a direction reaches the plane within `far` depths when
  // it falls by at least above / far. Linear in the direction, so a polygon can be clipped by it.
  std::array<Vec3, 4> corners;
  const std::array<std::array<double, 2>, 4> pixels = {
      {{0, 0}, {camera.width, 0}, {camera.width, camera.height}, {0, camera.height}}};
  for (std::size_t i = 0; i < 4; ++i) {
    corners[i] = camera.axes * Vec3(1, (camera.cx - pixels[i][0]) / camera.fx,
                                    (camera.cy - pixels[i][1]) / camera.fy);
  }
  const auto excess = [&](const Vec3& d) { return -d.z() - above / far; };
  std::vector<Vec3> frame;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3& from = corners[i];
    const Vec3& to = corners[(i + 1) % 4];
    const double here = excess(from);
    const double there = excess(to);
    if (here >= 0) frame.push_back(from);
    if ((here < 0) != (there < 0)) frame.push_back(from + (to - from) * (here / (here - there)));
  }
  for (Vec3& direction : frame) direction = camera.eye + direction * (above / -direction.z());
  return frame;
}

}  // namespace probe::inspect
