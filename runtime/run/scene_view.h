// What the camera of a task sees: the plan's scene as a renderer's, given joint positions and
// object poses. Knows no physics, so stored episodes can be drawn with it too.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/plan/plan.h"
#include "runtime/render/renderer.h"
#include "runtime/robot/kinematics.h"
#include "runtime/run/assets.h"

namespace probe::run {

// Pixels. Zero: the camera's own size; another one squeezes the picture, intrinsics with it.
struct ImageSize {
  int width = 0, height = 0;
};

class SceneView {
 public:
  // `assets` were loaded for this task; the plan may go afterwards.
  static Result<std::unique_ptr<SceneView>> create(const plan::Plan& plan, std::uint32_t task,
                                                   std::shared_ptr<const SharedAssets> assets,
                                                   ImageSize size = {});

  // `q` in drive order; `objects` are model poses in world, in the order source, target,
  // distractors.
  Result<render::FrameView> render(std::span<const double> q, std::span<const Pose> objects);
  // Every pixel traced again: the same picture, for tests.
  Result<render::FrameView> render_full(std::span<const double> q, std::span<const Pose> objects);

 private:
  render::Camera place(std::span<const double> q, std::span<const Pose> objects);
  SceneView(std::shared_ptr<const SharedAssets> assets, robot::Tree tree)
      : assets_(std::move(assets)), tree_(std::move(tree)) {}

  std::shared_ptr<const SharedAssets> assets_;
  robot::Tree tree_;
  Pose base_;
  std::size_t objects_ = 0;
  std::vector<int> visual_links_;  // of the dynamic visuals after the objects
  std::vector<Pose> links_, poses_;
  // A camera on a link that moves: its place in the link, its picture's size and lens.
  int moving_mount_ = -1;
  render::Camera on_mount_;
  std::unique_ptr<render::Renderer> renderer_;
};

// Shared with the physics side: names of the driven joints in order, and the robot's base in world.
std::vector<std::string> drive_joints(const plan::Plan& plan, const plan::RobotRecord& robot);
Pose base_pose(const plan::SceneRecord& scene);

}  // namespace probe::run
