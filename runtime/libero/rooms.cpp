#include "runtime/libero/rooms.h"

#include <filesystem>

namespace probe::libero {
namespace {

constexpr Room kRooms[] = {
#define LIBERO_ROOM(scene, file, floor, wall, friction) {#scene, file, floor, wall, friction},
#include "runtime/libero/rooms.def"
};

// What the arenas' code makes of a table: its top is 1 x 1.2 x 0.05 m and ends at 0.9 m, its legs
// stand 10 cm inside the corners.
void set_table(const Room& room, std::vector<assets::MujocoChange>& changes) {
  const Vec3 half(0.5, 0.6, 0.025);
  constexpr double kTop = 0.9, kInside = 0.1, kLeg = 0.025;
  const auto change = [&](const std::string& name) -> assets::MujocoChange& {
    assets::MujocoChange& made = changes.emplace_back();
    made.name = name;
    return made;
  };
  change("table").position = Vec3(0, 0, kTop - half.z());
  change("table_collision").size = half;
  changes.back().friction = room.table_friction;
  change("table_visual").size = half;
  const double high = (kTop - half.z()) / 2;
  const double x = half.x() - kInside, y = half.y() - kInside;
  const Vec3 legs[] = {{x, y, -high}, {-x, y, -high}, {-x, -y, -high}, {x, -y, -high}};
  for (int i = 0; i < 4; ++i) {
    change("table_leg" + std::to_string(i + 1) + "_visual").position = legs[i];
    changes.back().size = Vec3(kLeg, high, 0);
  }
}

}  // namespace

std::span<const Room> rooms() { return kRooms; }

std::string with_room(std::string_view scene) { return std::string(scene) + "_room"; }

Result<assets::MujocoAsset> make_room(const Room& room, const std::string& assets,
                                      const std::string& base) {
  assets::MujocoOptions options;
  options.file = (std::filesystem::path(assets) / "scenes" / room.file).string();
  options.name = room.scene;
  options.merged_into = base;
  options.kind = assets::MujocoKind::kBackdrop;
  for (const auto& [texture, picture] :
       {std::pair("texplane", room.floor), std::pair("tex-wall", room.wall)}) {
    assets::MujocoChange& change = options.changes.emplace_back();
    change.name = texture;
    change.picture = "../textures/" + std::string(picture);
  }
  if (room.table_friction > 0) set_table(room, options.changes);
  return assets::convert_mujoco(options);
}

}  // namespace probe::libero
