// What a dataset's episode is made of, whatever the format.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/robot/action.h"
#include "runtime/store/results.h"

namespace probe::dataset {

// What all episodes of a dataset have in common.
struct CameraShape {
  std::string name;
  int width = 0, height = 0;  // of the pictures as they are written
  // What tasks call it, each by one of these; empty: as it is called here.
  std::vector<std::string> views = {};
  bool is(std::string_view view) const {
    return views.empty() ? view == name : std::ranges::find(views, view) != views.end();
  }
  bool operator==(const CameraShape&) const = default;
};
struct Shape {
  std::string robot;
  double control_hz = 0;
  int fps = 0;
  std::vector<CameraShape> cameras;
  std::vector<std::string> joints;  // the robot's, in drive order
  // The control law whose numbers actions have: one for each of the first joints, and the
  // gripper's; empty: a tool's seven.
  std::string law;
  std::size_t action_size = robot::kActionSize;
  bool operator==(const Shape&) const = default;
};

// Of an end effector: x, y, z (m), roll, pitch, yaw (rad, Rz Ry Rx) of the tool centre point in the
// robot's base frame; gripper 0 closed .. 1 open.
inline constexpr std::size_t kStateSize = 7;
inline constexpr std::array<std::string_view, kStateSize> kStateNames = {
    "x", "y", "z", "roll", "pitch", "yaw", "gripper"};
// Of an action's numbers, as robot::Action has them.
std::vector<std::string> action_names(const Shape& shape);
// What an action's numbers are, for people.
std::string action_meaning(const Shape& shape);

// What was there when the policy was asked, and what it answered.
struct Step {
  std::array<double, kStateSize> state{};
  std::vector<double> joints;  // rad and m
  robot::Action action{};
};

// A camera's picture in the dataset's size.
struct Picture {
  const CameraShape* camera = nullptr;
  std::span<const std::uint8_t> rgb;  // width * height * 3, row 0 on top
};

struct Demonstration {
  std::string run;  // the folder as it was named
  store::ResultRow row;
  std::string prompt;                 // as the policy was told
  std::vector<std::string> wordings;  // how it is told in the dataset, at least one
  std::vector<Step> steps;
  bool success = false;
  // Of a run of pushes: the steps whose action is not the expert's alone.
  std::optional<std::vector<int>> pushed = {};
};

}  // namespace probe::dataset
