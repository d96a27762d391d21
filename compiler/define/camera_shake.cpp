#include "compiler/define/camera_shake.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "runtime/base/hash_number.h"
#include "runtime/base/sha256.h"
#include "runtime/base/trig.h"
#include "runtime/plan/shakes.h"

namespace probe::sema {
namespace {

// From -1 to 1, of 53 bits.
double shake_draw(std::size_t start, const std::string& view, std::uint8_t number) {
  Hasher hasher;
  hasher.text("camera jitter").u64(start).text(view).u8(number);
  return static_cast<double>(big_endian_number(hasher.finish()) >> 11) * 0x1p-52 - 1;
}

std::array<double, 4> quaternion_of(const std::array<double, 3>& turn) {
  const double angle = std::sqrt(turn[0] * turn[0] + turn[1] * turn[1] + turn[2] * turn[2]);
  if (angle == 0) return {1, 0, 0, 0};
  const double sine = portable_sin(angle / 2) / angle;
  return {portable_cos(angle / 2), sine * turn[0], sine * turn[1], sine * turn[2]};
}

}  // namespace

std::vector<double> shakes_of(const Model& model, const std::vector<View>& views,
                              std::size_t start) {
  const auto jitters = [&](const View& view) { return model.cameras[view.camera].jitters(); };
  if (std::none_of(views.begin(), views.end(), jitters)) return {};
  std::vector<double> shakes;
  for (const View& view : views) {
    const Camera& camera = model.cameras[view.camera];
    std::array<double, 3> turn{};
    for (std::uint8_t i = 0; i < 3; ++i) {
      shakes.push_back(camera.jitter_place * shake_draw(start, view.name, i));
      turn[i] = camera.jitter_turn * shake_draw(start, view.name, static_cast<std::uint8_t>(3 + i));
    }
    const std::array<double, 4> rotation = quaternion_of(turn);
    shakes.insert(shakes.end(), rotation.begin(), rotation.end());
  }
  return shakes;
}

Camera shaken(const Camera& camera, const std::vector<double>& shakes, std::size_t view) {
  Camera there = camera;
  if (shakes.empty()) return there;
  const plan::Shake shake = plan::shake_of(shakes, view);
  for (std::size_t i = 0; i < 3; ++i) there.position[i] += shake.moved[i];
  there.turned = shake.turned;
  return there;
}

}  // namespace probe::sema
