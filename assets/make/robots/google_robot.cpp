// The links of the Google robot of SimplerEnv from convex pieces, each in its own link frame: a
// foot on wheels, a column that carries a head, an arm of seven axes at its side and two fingers
// that turn. Joints and where the fingertips meet are the released robot's, shapes are our own.
#include <cmath>
#include <utility>

#include "assets/make/generators.h"
#include "assets/make/link_shape.h"

namespace probe::make {
namespace {

// Linear albedos.
const Paint kShell{.name = "shell", .base_color = {0.73, 0.73, 0.73}, .roughness = 0.3};
const Paint kTip{.name = "tip", .base_color = {0.855, 0.708, 0.216}, .roughness = 0.3};
// The three other colourings of visual matching: arm and fingertips.
struct Colouring {
  const char* ending;
  Colour arm, tip;
};
const Colouring kColourings[] = {{"_tabletop_1", {235, 209, 184}, {217, 161, 90}},
                                 {"_tabletop_2", {238, 222, 200}, {242, 205, 126}},
                                 {"_cabinet_1", {201, 169, 139}, {217, 161, 90}}};
const Paint kDark{.name = "dark", .base_color = {0.03, 0.03, 0.033}, .roughness = 0.4};

std::vector<Vec3> along_y(const Vec3& centre, double radius, double low, double high) {
  return disc_points({.axis = 1, .centre = centre, .radius = radius, .low = low, .high = high});
}
std::vector<Vec3> along_z(const Vec3& centre, double radius, double low, double high) {
  return disc_points({.axis = 2, .centre = centre, .radius = radius, .low = low, .high = high});
}

LinkShape foot() {
  LinkShape shape;
  shape.piece(joined(box_points({-380, -160, -25}, {60, 160, 120}, 25),
                     box_points({-300, -190, 10}, {90, 190, 90}, 25)));
  return shape;
}

// Behind the torso's axis, so that the arm's root can turn in front of it, and over it to the head.
LinkShape column() {
  LinkShape shape;
  shape.piece(joined(box_points({-190, -75, 100}, {-20, 75, 140}, 15),
                     box_points({-180, -65, 560}, {-60, 65, 600}, 15)));
  shape.piece(along_z(Vec3::Zero(), 85, 480, 594));
  shape.piece(joined(box_points({-180, -60, 560}, {-90, 60, 600}, 15),
                     box_points({-150, -55, 1090}, {-60, 55, 1130}, 15)));
  shape.piece(joined(box_points({-150, -55, 1090}, {-60, 55, 1130}, 15),
                     along_z(Vec3::Zero(), 45, 1120, 1168)));
  return shape;
}

LinkShape wheels() {
  LinkShape shape;
  for (const double y : {-183.33, 183.33}) shape.piece(along_y({0, y, 0}, 62, y - 17, y + 17));
  for (const double y : {-95.0, 95.0}) shape.piece(along_y({-338, y, -29.3}, 32, y - 12, y + 12));
  return shape;
}

LinkShape torso() {
  LinkShape shape;
  shape.piece(along_z(Vec3::Zero(), 82, 2, 96));
  shape.piece(joined(along_z(Vec3::Zero(), 70, 40, 96), along_y({0, -85, 113}, 62, -110, -85)));
  return shape;
}

LinkShape shoulder() {
  LinkShape shape;
  shape.piece(along_y(Vec3::Zero(), 66, -62, 56));
  shape.piece(joined(along_y(Vec3::Zero(), 58, -50, 52), along_z({0, 2, 0}, 58, 120, 170)));
  shape.piece(along_z({0, 2, 0}, 60, 165, 214));
  return shape;
}

LinkShape bicep() {
  LinkShape shape;
  shape.piece(along_z(Vec3::Zero(), 58, 2, 90));
  shape.piece(joined(along_z(Vec3::Zero(), 54, 60, 92), along_y({0, 0, 185}, 52, -22, 34)));
  return shape;
}

LinkShape elbow() {
  LinkShape shape;
  shape.piece(along_y(Vec3::Zero(), 52, -60, 38));
  shape.piece(joined(along_y(Vec3::Zero(), 48, -60, -20), along_z({0, -101, 0}, 46, 40, 90)));
  return shape;
}

LinkShape forearm() {
  LinkShape shape;
  shape.piece(along_z(Vec3::Zero(), 46, 2, 130));
  shape.piece(joined(along_z(Vec3::Zero(), 46, 120, 132), along_y({0, 0, 273.5}, 38, 22, 48)));
  return shape;
}

LinkShape wrist() {
  LinkShape shape;
  shape.piece(along_y(Vec3::Zero(), 38, -40, 24));
  shape.piece(joined(along_y(Vec3::Zero(), 36, -34, 24), along_z({0, 6, 0}, 38, 80, 107)));
  return shape;
}

LinkShape gripper() {
  LinkShape shape;
  shape.piece(along_z(Vec3::Zero(), 42, 2, 30));
  shape.piece(
      joined(along_z(Vec3::Zero(), 38, 28, 32), box_points({-19, -34, 50}, {19, 34, 70}, 4)));
  return shape;
}

LinkShape head_pan() {
  LinkShape shape;
  shape.piece(along_z(Vec3::Zero(), 44, 2, 40));
  shape.piece(joined(along_z(Vec3::Zero(), 44, 38, 42), along_y({72, 0, 118}, 40, -24, 24)));
  return shape;
}

LinkShape head_tilt() {
  LinkShape shape;
  shape.piece(joined(box_points({-40, -75, -45}, {80, 75, 45}, 14),
                     box_points({80, -55, -30}, {92, 55, 30}, 4)));
  return shape;
}

// In the finger's frame, which turns about x: along z it reaches out, -y is where it closes to.
std::vector<Vec3> finger_base() {
  return joined(box_points({-10.5, -8, -8}, {10.5, 8, 8}, 2),
                box_points({-10.5, -17, 58}, {10.5, -1, 68}, 2));
}

// The tip's inner face leans back, so that two tips lie flat on a thing of 66 mm and meet at their
// ends when nothing is between them: gaps of 145, 108, 55 and 14 mm at 0, 0.4, 0.8 and 1 rad.
std::vector<Vec3> finger_tip() {
  constexpr double kCos = 0.8253356149, kSin = 0.5646424734;  // of 0.6 rad about x
  std::vector<Vec3> points;
  for (const double x : {-10.5, 10.5}) {
    for (const auto& [y, z] :
         {std::pair{-7.6, 0.0}, {-7.6, 11.0}, {3.6, 46.3}, {9.0, 0.0}, {10.0, 46.3}}) {
      points.push_back({x, -10.3567 + kCos * y - kSin * z, 64.1556 + kSin * y + kCos * z});
    }
  }
  return points;
}

LinkShape of(const std::vector<Vec3>& points) {
  LinkShape shape;
  shape.piece(points);
  return shape;
}

}  // namespace

std::vector<OutputFile> make_google_robot() {
  const std::string robot = "google_robot";
  std::vector<OutputFile> files;
  const std::vector<std::pair<std::string, LinkShape>> links{
      {"torso", torso()},     {"shoulder", shoulder()}, {"bicep", bicep()},
      {"elbow", elbow()},     {"forearm", forearm()},   {"wrist", wrist()},
      {"gripper", gripper()}, {"head_pan", head_pan()}};
  for (const auto& [name, shape] : links) {
    files.push_back(link_visual(robot, name, {{shape, kShell}}));
    // What stands beside the table and lower than its top is not felt.
    if (name == "torso" || name == "shoulder") continue;
    files.push_back(link_collision(robot, name, coarse_hull(shape.points_in_metres(), name)));
  }
  files.push_back(
      link_visual(robot, "base", {{foot(), kShell}, {column(), kShell}, {wheels(), kDark}}));
  files.push_back(link_visual(robot, "head_tilt", {{head_tilt(), kDark}}));
  files.push_back(
      link_collision(robot, "head_tilt", coarse_hull(head_tilt().points_in_metres(), "head_tilt")));
  const LinkShape finger = of(finger_base()), tip = of(finger_tip());
  files.push_back(link_visual(robot, "finger", {{finger, kShell}, {tip, kTip}}));
  files.push_back(
      link_collision(robot, "finger_base", convex_hull(finger.points_in_metres(), "finger_base")));
  files.push_back(
      link_collision(robot, "finger_tip", convex_hull(tip.points_in_metres(), "finger_tip")));
  // From shoulder to hand and the fingers; torso, head and base keep their colours.
  for (const Colouring& colouring : kColourings) {
    const auto painted = [](Paint paint, const Colour& srgb) {
      paint.base_color = albedo_for(srgb, 1, 0);
      return paint;
    };
    const Paint arm = painted(kShell, colouring.arm), ends = painted(kTip, colouring.tip);
    for (const auto& [name, shape] : links) {
      if (name == "torso" || name == "head_pan") continue;
      files.push_back(link_visual(robot, name + colouring.ending, {{shape, arm}}));
    }
    files.push_back(
        link_visual(robot, std::string("finger") + colouring.ending, {{finger, arm}, {tip, ends}}));
  }
  return files;
}

}  // namespace probe::make
