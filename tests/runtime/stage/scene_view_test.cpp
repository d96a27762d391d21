// What the plan says of lights, backdrops and cameras is what is drawn; and over an episode of
// every scene a cached picture is a full one.
#include "runtime/stage/scene_view.h"

#include <doctest/doctest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <set>

#include "compiler/emit/compile.h"
#include "runtime/base/trig.h"
#include "runtime/scene/image.h"
#include "runtime/stage/episode_world.h"
#include "runtime/stage/robot_of.h"

namespace probe::stage {
namespace {

namespace fs = std::filesystem;

const char* const kVariants = R"(
use "suite/intact.probe"

light evening { ambient 0.1; sun (0, 0, -1) power 0.4 }
light lamp { ambient 0.3; sun (-1, -0.5, -1.5) power 2.2 shadow }
light corners { ambient 0.9 occlusion 8 }
light no_corners { ambient 0.9 }
camera nearer like third_view { mount widowx.base_link at (0cm, -10cm, 30cm) look (1, 0.5, -1.1) }
camera small { mount widowx.base_link at (0cm, -16cm, 36cm) look (1, 0.553, -1.085)
  image 320 x 240; lens 311.794px, 311.794px, 159.7505px, 119.7725px }
camera shifted like small { lens 311.794px, 311.794px, 169.7505px, 119.7725px }
camera smooth like small { image 320 x 240 samples 4 }
camera wrist { mount widowx.gripper_link at (0cm, 0cm, 8cm) look (1, 0, -0.4)
  image 320 x 240; lens 250px, 250px, 160px, 120px }
camera loose like small { jitter 3cm 5deg }
camera wrist_loose like wrist { jitter 5mm 3deg }
scene loose_eyes like table { camera loose, wrist_loose as hand }
scene photographed like table { camera third_view overlay "wall.png" }
scene lowered like table { surface 82cm area (-34cm, -20cm) .. (4cm, 20cm) }
scene raised  like table { surface 89cm area (-34cm, -20cm) .. (4cm, 20cm) }
scene lowered_photo like lowered { camera third_view overlay "wall.png" }
scene three_eyes like table { camera third_view, wrist, small as left overlay "wall.png" }

variants of carrot_on_plate {
  carrot_evening { light evening }
  carrot_lamp    { light lamp }
  carrot_corners { light corners }
  carrot_no_corners { light no_corners }
  carrot_nearer  { camera nearer }
  carrot_small   { camera small }
  carrot_shifted { camera shifted }
  carrot_smooth  { camera smooth }
  carrot_wrist   { camera wrist }
  carrot_loose   { scene loose_eyes }
  carrot_photo   { scene photographed }
  carrot_eyes    { scene three_eyes }
  carrot_lowered { scene lowered }
  carrot_raised  { scene raised }
  carrot_lowered_photo { scene lowered_photo }
}
@allow(confounded, "a picture of both")
variant carrot_photo_lamp of carrot_photo { light lamp }
variant eggplant_fine of put_eggplant_in_basket { light lamp }
suite pictures trained on bridge_v2 {
  tasks { carrot_on_plate, carrot_evening, carrot_lamp, carrot_corners, carrot_no_corners, carrot_nearer,
          carrot_small, carrot_shifted, carrot_smooth, carrot_wrist, carrot_photo, carrot_photo_lamp, carrot_eyes, carrot_loose,
          carrot_lowered, carrot_raised, carrot_lowered_photo,
          put_eggplant_in_basket, eggplant_fine }
  seeds 42
}
)";

// A copy of the assets with a photo added.
class Pictures {
 public:
  Pictures() {
    folder_ = fs::temp_directory_path() / ("probe_view_" + std::to_string(::getpid()));
    fs::create_directories(folder_);
    fs::copy(fs::path(VLAPROBE_SOURCE_DIR) / "assets", folder_ / "assets",
             fs::copy_options::recursive);
    const std::vector<std::uint8_t> photo(3 * 320 * 240, 123);
    REQUIRE(scene::write_png((folder_ / "assets/scenes/wall.png").string(), 320, 240, photo).ok());
    const std::string text = (folder_ / "pictures.probe").string();
    std::ofstream(text) << kVariants;
    const std::string files[] = {text};
    auto compiled =
        build(files, {.asset_root = root(),
                      .suite = "pictures",
                      .library_folders = {VLAPROBE_SOURCE_DIR "/dsl", VLAPROBE_SOURCE_DIR}});
    REQUIRE_MESSAGE(compiled.ok(), (compiled.ok() ? "" : to_text(compiled.failure())));
    for (const Diagnostic& diagnostic : compiled->diagnostics.items()) {
      if (!compiled->ok) MESSAGE(diagnostic.message);
    }
    REQUIRE(compiled->ok);
    auto plan = plan::Plan::from_bytes(std::move(compiled->plan));
    REQUIRE_MESSAGE(plan.ok(), (plan.ok() ? "" : to_text(plan.failure())));
    plan_ = std::move(*plan);
  }
  ~Pictures() { fs::remove_all(folder_); }

  std::string root() const { return (folder_ / "assets").string(); }
  const plan::Plan& plan() const { return *plan_; }
  std::uint32_t task(const std::string& name) const { return plan_->find_task(name).value(); }

  struct Stage {
    std::unique_ptr<EpisodeWorld> world;
    std::unique_ptr<SceneView> view;
  };
  Stage stage(const std::string& name) const {
    const std::uint32_t tasks[] = {task(name)};
    auto assets = SharedAssets::load(*plan_, root(), tasks);
    REQUIRE_MESSAGE(assets.ok(), (assets.ok() ? "" : to_text(assets.failure())));
    auto world = EpisodeWorld::create(*plan_, task(name), *assets);
    REQUIRE(world.ok());
    auto view = SceneView::create(*plan_, task(name), *assets);
    REQUIRE_MESSAGE(view.ok(), (view.ok() ? "" : to_text(view.failure())));
    return {std::move(*world), std::move(*view)};
  }

 private:
  fs::path folder_;
  std::optional<plan::Plan> plan_;
};

struct Picture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;
  std::vector<float> depth;
  std::vector<std::uint16_t> ids;
  bool operator==(const Picture&) const = default;

  double mean() const {
    double sum = 0;
    for (const std::uint8_t byte : rgb) sum += byte;
    return sum / static_cast<double>(rgb.size());
  }
  std::size_t pixels(std::uint16_t id) const {
    return static_cast<std::size_t>(std::count(ids.begin(), ids.end(), id));
  }
};

Picture copy(const Result<render::FrameView>& frame) {
  REQUIRE_MESSAGE(frame.ok(), (frame.ok() ? "" : to_text(frame.failure())));
  return {frame->width,
          frame->height,
          {frame->rgb.begin(), frame->rgb.end()},
          {frame->depth.begin(), frame->depth.end()},
          {frame->segmentation.begin(), frame->segmentation.end()}};
}

// The picture of the plan's first start, objects where they are placed.
Picture first(const Pictures& pictures, const std::string& task) {
  const auto stage = pictures.stage(task);
  const plan::Plan& plan = pictures.plan();
  const plan::TaskRecord& record = plan.tasks()[pictures.task(task)];
  std::vector<Pose> objects;
  for (const auto& placement : plan.placements(plan.episodes(record)[0])) {
    const auto& p = placement.position;
    const auto& r = placement.rotation;
    objects.push_back({Vec3(p[0], p[1], 0.89), Quat(r[0], r[1], r[2], r[3])});
  }
  return copy(stage.view->render(plan.joints(plan.scenes()[record.scene]), objects));
}

TEST_CASE("lights, cameras and backdrops of the language are what is drawn") {
  const Pictures pictures;
  const Picture plain = first(pictures, "carrot_on_plate");
  const Picture evening = first(pictures, "carrot_evening");
  CHECK(evening.mean() < 0.7 * plain.mean());
  CHECK(evening.depth == plain.depth);
  CHECK(evening.ids == plain.ids);

  // A shadow darkens table that was bright, and nothing else changes place.
  const Picture lamp = first(pictures, "carrot_lamp");
  CHECK(lamp.ids == plain.ids);
  CHECK(lamp.rgb != plain.rgb);

  const Picture corners = first(pictures, "carrot_corners");
  const Picture no_corners = first(pictures, "carrot_no_corners");
  CHECK(corners.mean() < no_corners.mean() - 0.5);
  CHECK(corners.mean() > 0.8 * no_corners.mean());

  const Picture nearer = first(pictures, "carrot_nearer");
  CHECK(nearer.pixels(1) > plain.pixels(1));

  // The principal point moves the picture by whole pixels.
  const Picture small = first(pictures, "carrot_small"),
                shifted = first(pictures, "carrot_shifted");
  CHECK(small.width == 320);
  CHECK(4.0 * static_cast<double>(small.pixels(2)) ==
        doctest::Approx(static_cast<double>(plain.pixels(2))).epsilon(0.02));
  int wrong = 0;
  for (std::size_t y = 0; y < 240; ++y) {
    for (std::size_t x = 0; x < 310; ++x) {
      wrong += small.ids[320 * y + x] != shifted.ids[320 * y + x + 10];
    }
  }
  CHECK(wrong < 20);  // edges round otherwise

  const Picture smooth = first(pictures, "carrot_smooth");
  CHECK(smooth.rgb != small.rgb);
  CHECK(smooth.mean() == doctest::Approx(small.mean()).epsilon(0.01));

  const Picture photo = first(pictures, "carrot_photo");
  CHECK(photo.depth == plain.depth);
  std::size_t shown = 0;
  for (std::size_t k = 0; k < photo.ids.size(); ++k) shown += photo.rgb[3 * k] == 123;
  CHECK(shown >= photo.pixels(65535));
  const Picture caught = first(pictures, "carrot_photo_lamp");
  std::size_t darker = 0;
  for (std::size_t k = 0; k < caught.ids.size(); ++k) {
    if (caught.ids[k] == 65535) darker += caught.rgb[3 * k] < 123;
  }
  CHECK(darker > 1000);
  CHECK(darker < caught.ids.size() / 4);

  std::set<Sha256> starts;
  for (const plan::TaskRecord& task : pictures.plan().tasks()) {
    starts.insert(Sha256{pictures.plan().episodes(task)[0].start_id});
  }
  CHECK(starts.size() == pictures.plan().tasks().size());  // every one of these is in the id
}

// Share of the picture that shows the backdrop within a millimetre of height `z`.
double share_at(const Pictures& pictures, const std::string& task, const Picture& picture,
                double z) {
  const plan::Plan& plan = pictures.plan();
  const plan::TaskRecord& record = plan.tasks()[pictures.task(task)];
  const plan::CameraRecord& camera = plan.cameras()[plan.views(record)[0].camera];
  const Pose base = base_pose(plan.scenes()[record.scene]);
  const auto& at = camera.position;
  const auto& aim = camera.aim_values;
  const Vec3 eye = base.apply(Vec3(at[0], at[1], at[2]));
  const Mat3 axes =
      base.rotation.toRotationMatrix() * render::look_along(Vec3(aim[0], aim[1], aim[2])).value();
  std::size_t count = 0;
  for (std::size_t k = 0; k < picture.ids.size(); ++k) {
    if (picture.ids[k] != 65535) continue;
    const double x = static_cast<double>(k % static_cast<std::size_t>(picture.width)) + 0.5;
    const double y = static_cast<double>(k / static_cast<std::size_t>(picture.width)) + 0.5;
    const Vec3 point =
        eye + static_cast<double>(picture.depth[k]) *
                  (axes * Vec3(1, -(x - camera.cx) / camera.fx, -(y - camera.cy) / camera.fy));
    count += std::abs(point.z() - z) < 1e-3;
  }
  return static_cast<double>(count) / static_cast<double>(picture.ids.size());
}

TEST_CASE(
    "the table goes down and up with the surface, so that objects stand on it in the picture") {
  const Pictures pictures;
  const auto settled = [&](const std::string& task) {
    const auto stage = pictures.stage(task);
    REQUIRE(stage.world->reset(0).ok());
    return copy(stage.view->render(stage.world->q(), stage.world->objects()));
  };
  for (const auto& [task, z] :
       {std::pair{"carrot_on_plate", 0.87}, {"carrot_lowered", 0.82}, {"carrot_raised", 0.89}}) {
    const Picture picture = settled(task);
    INFO(task);
    CHECK(share_at(pictures, task, picture, z) > 0.25);
    CHECK(picture.pixels(1) > 500);   // the carrot
    CHECK(picture.pixels(2) > 2000);  // the plate
  }
}

TEST_CASE("a photo cannot go down with the surface, so that such a scene is refused by name") {
  const Pictures pictures;
  const std::uint32_t tasks[] = {pictures.task("carrot_lowered_photo")};
  auto assets = SharedAssets::load(pictures.plan(), pictures.root(), tasks);
  REQUIRE(assets.ok());
  const auto view = SceneView::create(pictures.plan(), tasks[0], *assets);
  REQUIRE_FALSE(view.ok());
  CHECK(view.failure().where == "scene `lowered_photo`");
  CHECK(view.failure().message.find("0.870 m") != std::string::npos);
  CHECK(view.failure().message.find("0.820 m") != std::string::npos);
}

TEST_CASE("a camera on the wrist sees the fingers in one place and the table pass by") {
  const Pictures pictures;
  const auto stage = pictures.stage("carrot_wrist");
  REQUIRE(stage.world->reset(0).ok());
  const Picture before = copy(stage.view->render(stage.world->q(), stage.world->objects()));
  std::vector<double> q(stage.world->q().begin(), stage.world->q().end());
  q[0] += 0.3;
  const Picture after = copy(stage.view->render(q, stage.world->objects()));
  const plan::TaskRecord& task = pictures.plan().tasks()[pictures.task("carrot_wrist")];
  const auto bodies = pictures.plan().bodies(task);
  std::uint16_t finger = 0;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (pictures.plan().text(bodies[i].name) == "left_finger_link") {
      finger = static_cast<std::uint16_t>(i + 1);
    }
  }
  REQUIRE(finger > 0);
  CHECK(before.pixels(finger) > 100);
  std::size_t moved = 0;
  for (std::size_t k = 0; k < before.ids.size(); ++k) {
    moved += (before.ids[k] == finger) != (after.ids[k] == finger);
  }
  CHECK(moved < 20);
  CHECK(before.rgb != after.rgb);
}

TEST_CASE("each of several cameras shows what it shows alone, under its name in the scene") {
  const Pictures pictures;
  const auto all = pictures.stage("carrot_eyes");
  REQUIRE(all.world->reset(0).ok());
  const auto outside = pictures.stage("carrot_on_plate");
  const auto wrist = pictures.stage("carrot_wrist");
  const auto small = pictures.stage("carrot_small");
  std::vector<double> q(all.world->q().begin(), all.world->q().end());
  for (int step = 0; step < 3; ++step) {
    const auto objects = all.world->objects();
    const auto frames = all.view->render_all(q, objects);
    REQUIRE(frames.ok());
    REQUIRE(frames->size() == 3);
    CHECK((*frames)[0].camera == "third_view");
    CHECK((*frames)[1].camera == "wrist");
    CHECK((*frames)[2].camera == "left");
    const Picture first = copy((*frames)[0].frame), second = copy((*frames)[1].frame),
                  third = copy((*frames)[2].frame);
    CHECK(first == copy(outside.view->render(q, objects)));
    CHECK(second == copy(wrist.view->render(q, objects)));
    CHECK(third.ids == copy(small.view->render(q, objects)).ids);
    CHECK(third.rgb != copy(small.view->render(q, objects)).rgb);  // before its photo
    CHECK(second == copy(all.view->render(q, objects, 1)));
    CHECK(first == copy(all.view->render_full(q, objects, 0)));
    q[0] += 0.2;
    q[1] += 0.1;
  }
}

TEST_CASE("over an episode of every scene a cached picture equals one traced anew") {
  const Pictures pictures;
  for (const char* name :
       {"carrot_on_plate", "carrot_photo_lamp", "put_eggplant_in_basket", "eggplant_fine"}) {
    CAPTURE(name);
    const auto cached = pictures.stage(name);
    const auto full = pictures.stage(name);
    REQUIRE(cached.world->reset(0).ok());
    int different = 0;
    for (int step = 0; step < 24; ++step) {
      const auto q = cached.world->q();
      const auto objects = cached.world->objects();
      const Picture a = copy(cached.view->render(q, objects));
      different += !(a == copy(full.view->render_full(q, objects)));
      // Down and across, so that things move; the fingers open and close.
      policy::Action action = policy::Action::zeros(7);
      action[0] = 0.02 * portable_sin(0.7 * step);
      action[1] = 0.015;
      action[2] = step < 12 ? -0.02 : 0.02;
      action[6] = step % 8 < 4 ? 1 : -1;
      REQUIRE(cached.world->act(action).ok());
    }
    CHECK(different == 0);
  }
}

}  // namespace

TEST_CASE("a camera that jitters stands in each start where the plan says, bit for bit again") {
  const Pictures pictures;
  const auto stage = pictures.stage("carrot_loose");
  const plan::Plan& plan = pictures.plan();
  const plan::TaskRecord& record = plan.tasks()[pictures.task("carrot_loose")];
  std::vector<Pose> objects;
  for (const auto& placement : plan.placements(plan.episodes(record)[0])) {
    const auto& p = placement.position;
    const auto& r = placement.rotation;
    objects.push_back({Vec3(p[0], p[1], 0.89), Quat(r[0], r[1], r[2], r[3])});
  }
  const auto q = plan.joints(plan.scenes()[record.scene]);
  const auto seen = [&](std::size_t start) {
    const Sha256 id{plan.episodes(record)[start].start_id};
    const auto frames = stage.view->render_seen({id, 0}, [&](int) {
      return SceneView::Placed{q, objects};
    });
    REQUIRE_MESSAGE(frames.ok(), (frames.ok() ? "" : to_text(frames.failure())));
    return std::pair(copy((*frames)[0].frame), copy((*frames)[1].frame));
  };
  const Picture written = copy(stage.view->render(q, objects));
  const auto first = seen(0), second = seen(1);
  CHECK(first.first != written);
  CHECK(first.first != second.first);
  CHECK(first.second.rgb != second.second.rgb);  // the one on the wrist, too
  CHECK(seen(0) == first);
  // A cached picture is a full one, there too.
  CHECK(copy(stage.view->render_full(q, objects)) == copy(stage.view->render(q, objects)));
  // The nearest point of the table is where a camera that is moved so would see it: of every pixel
  // its ray from the shaken eye meets the plane of the surface at the depth of the picture.
  const plan::Shake shake =
      plan::shake_of(plan::shakes_of(plan.tables(), plan.episodes(record)[0]), 0);
  const auto look = render::look_along({1, 0.553, -1.085});
  REQUIRE(look.ok());
  const plan::SceneRecord& scene = plan.scenes()[record.scene];
  const Quat base(scene.base_rotation[0], scene.base_rotation[1], scene.base_rotation[2],
                  scene.base_rotation[3]);
  const Vec3 eye =
      Vec3(scene.base_position.data()) + base * (Vec3(0, -0.16, 0.36) + Vec3(shake.moved.data()));
  const Mat3 axes =
      base.toRotationMatrix() * *look *
      Quat(shake.turned[0], shake.turned[1], shake.turned[2], shake.turned[3]).toRotationMatrix();
  std::size_t on_table = 0, all = 0;
  for (int row = 200; row < 240; row += 4) {
    for (int column = 0; column < 320; column += 4) {
      const Vec3 ray =
          axes * Vec3(1, -(column + 0.5 - 159.7505) / 311.794, -(row + 0.5 - 119.7725) / 311.794);
      const double depth = (scene.surface_z - eye.z()) / ray.z();
      const double drawn =
          first.first.depth[static_cast<std::size_t>(row) * 320 + static_cast<std::size_t>(column)];
      ++all;
      if (std::abs(depth - drawn) < 2e-4) ++on_table;
    }
  }
  CHECK(on_table > all / 2);
  // And a start that is of another task is refused.
  const auto strange = stage.view->render_seen({Sha256{}, 0}, [&](int) {
    return SceneView::Placed{q, objects};
  });
  REQUIRE_FALSE(strange.ok());
  CHECK(strange.failure().message == "no start of this task");
}

}  // namespace probe::stage
