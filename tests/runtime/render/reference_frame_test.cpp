// Against a published picture of the reference simulator, with the reference's own meshes and
// photo, where they are present. The picture is a lossy video frame, so its background alone
// differs from the photo by 1.8 levels.
#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>

#include "runtime/scene/image.h"
#include "tests/runtime/render/bench_scene.h"

namespace probe::render {
namespace {

using namespace test;

const std::string kReference = VLAPROBE_SOURCE_DIR "/../shared/reference";
const std::string kModels = kReference + "/simpler_assets/data/custom/models/";
const std::string kUrdf = kReference +
                          "/simpler_assets/mani_skill2_real2sim/assets/descriptions/"
                          "widowx_description/wx250s.urdf";

struct Difference {
  double all = 0, foreground = 0;
};

// Root mean square over pixels and channels; foreground is where our id is a link or an object.
Difference compare(const FrameView& frame, const scene::Texture& picture) {
  double all = 0, foreground = 0;
  std::size_t count = 0;
  for (std::size_t k = 0; k < frame.segmentation.size(); ++k) {
    double sum = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const double d = frame.rgb[3 * k + c] - picture.rgba[4 * k + c];
      sum += d * d;
    }
    all += sum;
    if (frame.segmentation[k] == 0 || frame.segmentation[k] == 65535) continue;
    foreground += sum;
    ++count;
  }
  return {std::sqrt(all / (3.0 * static_cast<double>(frame.segmentation.size()))),
          std::sqrt(foreground / (3.0 * static_cast<double>(count)))};
}

TEST_CASE("the stack-cube start looks as the reference's picture of it") {
  if (!std::filesystem::exists(kUrdf)) {
    MESSAGE("skipped: no ../shared/reference");
    return;
  }
  Result<Arm> arm = load_arm(kUrdf);
  REQUIRE_MESSAGE(arm.ok(), (arm.ok() ? "" : to_text(arm.failure())));
  SceneSpec spec;
  spec.camera = bench_camera();
  spec.lights = table_lights();
  spec.dynamics = arm->visuals;
  std::vector<Pose> poses = arm->poses(kArmStart);
  const auto add_cube = [&](const std::string& model, std::uint16_t body, double y) {
    auto mesh = scene::load_mesh(kModels + model + "/textured.dae");
    REQUIRE_MESSAGE(mesh.ok(), (mesh.ok() ? "" : to_text(mesh.failure())));
    spec.dynamics.push_back(visual(mesh.value(), body, model.c_str()));
    poses.push_back({Vec3(-0.21, y, 0.87 + 0.015), Quat::Identity()});
  };
  add_cube("baked_green_cube_3cm", 0, -0.05);
  add_cube("baked_yellow_cube_3cm", 1, 0.05);
  auto photo =
      scene::load_image(kReference + "/simpler_assets/data/real_inpainting/bridge_real_eval_1.png");
  REQUIRE(photo.ok());
  spec.photo = std::make_shared<scene::Texture>(std::move(photo).value());
  const auto picture =
      scene::load_image(kReference + "/simpler_frames/widowx_stack_cube_visual_matching.png");
  REQUIRE(picture.ok());

  Result<std::unique_ptr<Renderer>> renderer = Renderer::create(spec);
  REQUIRE_MESSAGE(renderer.ok(), (renderer.ok() ? "" : to_text(renderer.failure())));
  const Result<FrameView> frame = (*renderer)->render(poses);
  REQUIRE(frame.ok());
  CHECK(scene::write_png(VLAPROBE_BINARY_DIR "/stack_cube.png", 640, 480, frame->rgb).ok());
  const Difference difference = compare(*frame, *picture);
  MESSAGE("RMSE " << difference.all << " all, " << difference.foreground << " foreground");
  CHECK(difference.all <= 2.6);
  CHECK(difference.foreground <= 7.0);

  // The comparison is sharp enough to see half a pixel.
  spec.camera.cx += 0.5;
  Result<std::unique_ptr<Renderer>> shifted = Renderer::create(spec);
  REQUIRE(shifted.ok());
  const Result<FrameView> off = (*shifted)->render(poses);
  REQUIRE(off.ok());
  CHECK(compare(*off, *picture).foreground > 9.0);
}

}  // namespace
}  // namespace probe::render
