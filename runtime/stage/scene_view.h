// What the cameras of a task see: the plan's scene as a renderer's, given joint positions and
// object poses. Knows no physics, so stored episodes can be drawn with it too.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/plan/plan.h"
#include "runtime/plan/shakes.h"
#include "runtime/render/renderer.h"
#include "runtime/stage/assets.h"
#include "runtime/stage/placed_tree.h"
#include "runtime/stage/sensor.h"

namespace probe::stage {

// Pixels. Zero: the camera's own size; another one squeezes the picture, intrinsics with it.
struct ImageSize {
  int width = 0, height = 0;
  bool is_single = false;  // one sample a pixel, in its middle, however many the camera takes
};

// A camera's picture under the name that policies know it by.
struct CameraFrame {
  std::string_view camera;
  render::FrameView frame;
};

class SceneView {
 public:
  // `assets` were loaded for this task; the plan may go afterwards.
  static Result<std::unique_ptr<SceneView>> create(const plan::Plan& plan, std::uint32_t task,
                                                   std::shared_ptr<const SharedAssets> assets,
                                                   ImageSize size = {});

  // `q`: the robot's joints in drive order, then those of fixtures. `objects` are model poses in
  // world, in the order of the task's bodies. A picture is valid until the same camera's
  // next.
  Result<render::FrameView> render(std::span<const double> q, std::span<const Pose> objects,
                                   std::size_t camera = 0);
  // Every camera's picture, valid until the next call.
  Result<std::span<const CameraFrame>> render_all(std::span<const double> q,
                                                  std::span<const Pose> objects);
  // What a policy sees at `moment`: every camera's picture as its sensor gives it, which may be
  // that of an earlier step. `at` says where things were then; what it points to lives until the
  // next call of `at`. Valid until the next call. Cameras that jitter stand as in the moment's
  // start; `render` and `render_all` show them as they stood last, at first as they are written.
  struct Placed {
    std::span<const double> q;
    std::span<const Pose> objects;
  };
  Result<std::span<const CameraFrame>> render_seen(const Moment& moment,
                                                   const std::function<Placed(int step)>& at);
  // Whether a camera may show an earlier step.
  bool drops() const;
  // Every pixel traced again: the same picture, for tests.
  Result<render::FrameView> render_full(std::span<const double> q, std::span<const Pose> objects,
                                        std::size_t camera = 0);

 private:
  struct Eye {
    std::string name;
    int moving_mount = -1;    // the robot's link that carries it, where that moves
    render::Camera written;   // its place in the link, its picture's size and lens
    render::Camera on_mount;  // the same in the start that is looked at
    plan::Shake shake;        // by which it differs
    Pose mount;               // in world, where that stands still
    std::shared_ptr<const scene::Texture> photo;
    int samples = 1;  // a side
    std::unique_ptr<render::Renderer> renderer;
    std::optional<Sensor> sensor;
  };

  // Puts the cameras where they stand in that start.
  Status begin(const Sha256& start_id);
  Result<std::unique_ptr<render::Renderer>> open_renderer(const Eye& eye) const;
  Result<Eye> open_eye(const plan::Plan& plan, const plan::SceneRecord& scene,
                       const plan::ViewRecord& record, ImageSize size);
  void place(std::span<const double> q, std::span<const Pose> objects);
  void hide_from(const render::Camera& camera);
  Result<render::FrameView> look(Eye& eye, bool full);
  SceneView(std::shared_ptr<const SharedAssets> assets, std::vector<PlacedTree> trees)
      : assets_(std::move(assets)), trees_(std::move(trees)) {}
  const PlacedTree& robot() const { return trees_.front(); }

  std::shared_ptr<const SharedAssets> assets_;
  std::vector<PlacedTree> trees_;
  std::size_t objects_ = 0;
  std::vector<Pose> poses_;          // of the dynamic visuals: objects, then links tree by tree
  std::vector<std::size_t> hidden_;  // of these, what is not to be seen where joints stand
  render::SceneSpec seen_;           // the scene as every camera sees it
  std::vector<Eye> eyes_;
  std::map<Sha256, std::vector<plan::Shake>> shakes_;  // by start, then eye; of tasks that have any
  std::optional<Sha256> begun_;
  std::vector<CameraFrame> frames_;
};

}  // namespace probe::stage
