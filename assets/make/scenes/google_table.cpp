// The backdrops of the Google robot in world coordinates: a plain counter whose top is at 0.8875 m
// with floor and wall, and a room of floor and walls, in which the cabinet stands. Where the
// counter's edges are was read off the released photo.
#include "assets/make/generators.h"
#include "assets/make/shapes.h"

namespace probe::make {

std::vector<OutputFile> make_google_table_scene() {
  constexpr double kTop = 0.8875, kThickness = 0.04, kFloor = 0.017;
  constexpr double kBack = -0.72, kFront = -0.02, kRight = -0.11, kLeft = 0.52;
  constexpr double kWall = -1.9, kRoomWall = -1.2;
  Surface top, body, floor, wall, room_floor, room_walls;
  add_faces(
      top, convex_hull(box_points({kBack, kRight, kTop - kThickness}, {kFront, kLeft, kTop}, 0.002),
                       "top"));
  add_faces(body, convex_hull(box_points({kBack + 0.02, kRight + 0.02, kFloor},
                                         {kFront - 0.02, kLeft - 0.02, kTop - kThickness}, 0),
                              "body"));
  floor = sheet({kWall, -2.5, kFloor}, {4, 0, 0}, {0, 5, 0}, {1, 1});
  wall = sheet({kWall, -2.5, kFloor}, {0, 5, 0}, {0, 0, 2.6}, {1, 1});
  room_floor = sheet({kRoomWall, -2.5, kFloor}, {4, 0, 0}, {0, 5, 0}, {1, 1});
  room_walls = sheet({kRoomWall, -2.5, kFloor}, {0, 5, 0}, {0, 0, 2.6}, {1, 1});
  const auto plain = [](Surface surface, const char* name, const Colour& lit, double gain) {
    return plain_part(std::move(surface), name, albedo_for(lit, gain, 0.004), 0.9);
  };
  return {
      {"scenes/google_table/visual.glb",
       glb_bytes("google_table", {plain(std::move(top), "top", {172, 152, 128}, kGainUp),
                                  plain(std::move(body), "body", {118, 104, 92}, kGainPlusX),
                                  plain(std::move(floor), "floor", {150, 148, 144}, kGainUp),
                                  plain(std::move(wall), "wall", {176, 176, 172}, kGainPlusX)})},
      {"scenes/google_room/visual.glb",
       glb_bytes("google_room",
                 {plain(std::move(room_floor), "floor", {150, 142, 130}, kGainUp),
                  plain(std::move(room_walls), "walls", {186, 184, 176}, kGainPlusX)})}};
}

}  // namespace probe::make
