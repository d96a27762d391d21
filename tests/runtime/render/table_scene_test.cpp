// The shipped table scene as policies see it. The picture is left in the build folder for people to
// look at.
#include <doctest/doctest.h>

#include <ctime>
#include <filesystem>

#include "runtime/base/trig.h"
#include "runtime/scene/image.h"
#include "tests/runtime/render/bench_scene.h"

namespace probe::render {
namespace {

using namespace test;

// Seconds of this thread on a CPU: what a frame costs however busy the machine is.
double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

std::shared_ptr<const scene::Mesh> asset(const std::string& path) {
  auto mesh = scene::load_mesh(std::string(VLAPROBE_SOURCE_DIR) + "/assets/" + path);
  REQUIRE_MESSAGE(mesh.ok(), (mesh.ok() ? "" : to_text(mesh.failure())));
  return mesh.value();
}

struct Mean {
  double r = 0, g = 0, b = 0;
  int pixels = 0;
};

Mean mean_of(const FrameView& frame, std::uint16_t id) {
  Mean mean;
  for (std::size_t k = 0; k < frame.segmentation.size(); ++k) {
    if (frame.segmentation[k] != id) continue;
    mean.r += frame.rgb[3 * k];
    mean.g += frame.rgb[3 * k + 1];
    mean.b += frame.rgb[3 * k + 2];
    ++mean.pixels;
  }
  const double n = std::max(1, mean.pixels);
  return {mean.r / n, mean.g / n, mean.b / n, mean.pixels};
}

TEST_CASE("the table scene shows an orange carrot, a pale plate, a black arm and a brown table") {
  Result<Arm> arm =
      load_arm(std::string(VLAPROBE_SOURCE_DIR) + "/assets/robots/widowx/wx250s.urdf");
  REQUIRE_MESSAGE(arm.ok(), (arm.ok() ? "" : to_text(arm.failure())));
  SceneSpec spec;
  spec.camera = bench_camera();
  spec.lights = table_lights();
  spec.statics = {visual(asset("scenes/table/visual.glb"), kBackdrop, "table")};
  spec.dynamics = arm->visuals;
  spec.dynamics.push_back(visual(asset("objects/carrot/visual.glb"), 0, "carrot"));
  spec.dynamics.push_back(visual(asset("objects/plate/visual.glb"), 1, "plate"));
  std::vector<Pose> poses = arm->poses(kArmStart);
  poses.push_back({Vec3(-0.235, -0.075, 0.87 + 0.019), Quat::Identity()});
  poses.push_back({Vec3(-0.125, 0.025, 0.87 + 0.003), Quat::Identity()});

  Result<std::unique_ptr<Renderer>> renderer = Renderer::create(spec);
  REQUIRE_MESSAGE(renderer.ok(), (renderer.ok() ? "" : to_text(renderer.failure())));
  const Result<FrameView> frame = (*renderer)->render(poses);
  REQUIRE(frame.ok());
  CHECK(scene::write_png(VLAPROBE_BINARY_DIR "/table_scene.png", 640, 480, frame->rgb).ok());

  const Mean carrot = mean_of(*frame, 1);
  CHECK(carrot.pixels > 500);
  CHECK(carrot.r > carrot.g);
  CHECK(carrot.g > carrot.b);
  CHECK(carrot.r > 120);
  const Mean plate = mean_of(*frame, 2);
  CHECK(plate.pixels > 3000);
  CHECK(plate.g > 190);
  const int gripper = arm->model.find_link("gripper_link");
  const Mean body = mean_of(*frame, static_cast<std::uint16_t>(101 + gripper));
  CHECK(body.pixels > 500);
  CHECK(body.r < 90);
  const Mean table = mean_of(*frame, 65535);
  CHECK(table.pixels > 150'000);
  CHECK(table.r > table.b);
}

TEST_CASE("milliseconds a frame with the arm moving are printed") {
  Result<Arm> arm =
      load_arm(std::string(VLAPROBE_SOURCE_DIR) + "/assets/robots/widowx/wx250s.urdf");
  REQUIRE(arm.ok());
  SceneSpec spec;
  spec.camera = bench_camera();
  spec.lights = table_lights();
  spec.statics = {visual(asset("scenes/table/visual.glb"), kBackdrop, "table")};
  spec.dynamics = arm->visuals;
  spec.dynamics.push_back(visual(asset("objects/carrot/visual.glb"), 0, "carrot"));
  spec.dynamics.push_back(visual(asset("objects/plate/visual.glb"), 1, "plate"));
  Result<std::unique_ptr<Renderer>> renderer = Renderer::create(spec);
  REQUIRE(renderer.ok());
  double seconds = 0;
  long foreground = 0;
  constexpr int kFrames = 60;
  for (int f = 0; f < kFrames; ++f) {
    std::array<double, 8> joints = kArmStart;
    joints[0] += 0.2 * portable_sin(0.1 * f);
    joints[1] += 0.1 * portable_sin(0.07 * f);
    std::vector<Pose> poses = arm->poses(joints);
    poses.push_back({Vec3(-0.235, -0.075, 0.87 + 0.019), Quat::Identity()});
    poses.push_back({Vec3(-0.125, 0.025, 0.87 + 0.003), Quat::Identity()});
    const double start = thread_seconds();
    const Result<FrameView> frame = (*renderer)->render(poses);
    seconds += thread_seconds() - start;
    REQUIRE(frame.ok());
    for (const std::uint16_t id : frame->segmentation) foreground += id != 0 && id != 65535;
  }
  MESSAGE("render/640x480: " << 1e3 * seconds / kFrames << " ms a frame, " << foreground / kFrames
                             << " foreground pixels");
  CHECK(seconds / kFrames < 1.0);  // the budget itself belongs to the benchmark
}

}  // namespace
}  // namespace probe::render
