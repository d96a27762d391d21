// Rooms of the benchmark's scenes: walls, floors, tables and what stands behind, as backdrops.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "runtime/assets/mujoco.h"
#include "runtime/base/result.h"

namespace probe::libero {

struct Room {
  std::string_view scene;        // of suite/libero/stage.probe
  std::string_view file;         // below assets/scenes
  std::string_view floor, wall;  // below assets/textures
  double table_friction;         // 0: as the file says
};
std::span<const Room> rooms();

// How a text calls the scene with its room.
std::string with_room(std::string_view scene);

// `assets` is the benchmark's folder. Fails as convert_mujoco does.
Result<assets::MujocoAsset> make_room(const Room& room, const std::string& assets,
                                      const std::string& base);

}  // namespace probe::libero
