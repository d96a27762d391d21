// Small pictures of everything that is shipped, and a drop of four objects: always the same, so
// that a build, a machine or a change can be compared with the stored ones. Needs no plan.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "runtime/base/geometry.h"
#include "runtime/base/result.h"
#include "runtime/base/sha256.h"

namespace probe::doctor {

struct GoldenFrame {
  std::string name;  // "carrot", "scene_table"
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;
  std::vector<float> depth;  // m
  std::vector<std::uint16_t> ids;
};

// One of every folder of objects/, by name; the table and the sink with robot and objects; the
// table again with shadows, 4 samples a pixel and ambient occlusion. `root` is an asset folder.
Result<std::vector<GoldenFrame>> draw_golden_frames(const std::string& root);

struct GoldenSettle {
  Sha256 state;                 // after one second
  std::vector<Vec3> positions;  // of the four objects, m
};
Result<GoldenSettle> settle_golden_objects(const std::string& root);

}  // namespace probe::doctor
