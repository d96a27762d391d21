// A policy in front of several cameras: what it is shown, what is hashed, what people see.
#include <doctest/doctest.h>

#include "compiler/emit/compile.h"
#include "runtime/run/episode.h"
#include "runtime/scene/image.h"
#include "runtime/show/episode_video.h"
#include "runtime/show/picture_grid.h"
#include "runtime/show/preview.h"
#include "tests/runtime/run/temporary_folder.h"
#include "tests/runtime/show/inspect_video.h"

namespace probe::show {
using namespace probe::stage;
using namespace probe::store;
using namespace probe::run;
namespace {

const std::string kAssets = VLAPROBE_SOURCE_DIR "/assets";

plan::Plan example_plan() {
  const std::string file = VLAPROBE_SOURCE_DIR "/examples/wrist_camera.probe";
  auto built = build(
      std::span(&file, 1),
      {.asset_root = kAssets, .suite = "eyes", .library_folders = {VLAPROBE_SOURCE_DIR "/dsl"}});
  REQUIRE_MESSAGE(built.ok(), (built.ok() ? "" : to_text(built.failure())));
  REQUIRE(built->ok);
  auto plan = plan::Plan::from_bytes(std::move(built->plan));
  REQUIRE(plan.ok());
  return std::move(*plan);
}

// Stays where it is and remembers what it saw.
class Watcher final : public policy::Policy {
 public:
  Status begin(const policy::EpisodeStart&) override { return {}; }
  Result<policy::Action> act(const policy::Observation& seen) override {
    Hasher all;
    std::string names;
    for (const policy::CameraImage& camera : seen.cameras) {
      names += std::string(camera.camera) + " " + std::to_string(camera.image.width) + " ";
      all.hash(sha256(std::as_bytes(camera.image.rgb)));
    }
    if (cameras.empty()) cameras = names;
    same_names = same_names && cameras == names;
    first_is_image = first_is_image && seen.image.rgb.data() == seen.cameras[0].image.rgb.data();
    single = to_hex(sha256(std::as_bytes(seen.image.rgb)));
    hashes.push_back(to_hex(all.finish()));
    return policy::Action{0, 0, 0.01, 0, 0, 0, 1};
  }
  std::string cameras, single;
  std::vector<std::string> hashes;
  bool same_names = true, first_is_image = true;
};

struct Episode {
  Watcher watcher;
  ResultRow row;
};

Episode watch(const plan::Plan& plan, const std::string& task, const std::string& folder) {
  const std::uint32_t index = plan.find_task(task).value();
  const std::uint32_t tasks[] = {index};
  auto assets = SharedAssets::load(plan, kAssets, tasks);
  REQUIRE(assets.ok());
  auto stage = stage::Stage::create(plan, index, *assets);
  REQUIRE_MESSAGE(stage.ok(), (stage.ok() ? "" : to_text(stage.failure())));
  const EpisodeJob job{index, 0, 42};
  const TraceHeader header = make_trace_header(plan, job, **stage, "watcher", "{}");
  auto trace = TraceWriter::create(folder + "/" + task + ".trace", header);
  REQUIRE(trace.ok());
  EpisodeVideo video(header, folder + "/" + task + ".mp4");
  Episode episode;
  auto played = run_episode(**stage, plan, job, "watcher", episode.watcher, **trace, &video, 2);
  REQUIRE_MESSAGE(played.ok(), (played.ok() ? "" : to_text(played.failure())));
  CHECK_MESSAGE(!played->row.invalid, played->row.invalid.value_or(""));
  REQUIRE(video.finish().ok());
  episode.row = std::move(played->row);
  return episode;
}

TEST_CASE("a policy gets every camera's picture by name, and their hash covers all of them") {
  TemporaryFolder folder;
  std::filesystem::create_directories(folder / "v");
  const plan::Plan plan = example_plan();
  const Episode two = watch(plan, "carrot_two_eyes", folder / "v");
  CHECK(two.watcher.cameras == "third_view 640 wrist 224 ");
  CHECK(two.watcher.same_names);
  CHECK(two.watcher.first_is_image);
  CHECK(two.row.image_sha256 == two.watcher.hashes[0]);
  CHECK(two.watcher.hashes[0] != two.watcher.hashes[1]);
  const auto video = inspect_video(folder / "v/carrot_two_eyes.mp4");
  REQUIRE(video.ok());
  CHECK(video->width == 640 + 2 + 224);
  CHECK(video->height == 480);

  // Another camera in the place of `wrist`: the same names, the same first picture, another hash.
  const Episode tilted = watch(plan, "carrot_tilted_wrist", folder / "v");
  CHECK(tilted.watcher.cameras == two.watcher.cameras);
  CHECK(tilted.watcher.single == two.watcher.single);
  CHECK(tilted.row.image_sha256 != two.row.image_sha256);
}

TEST_CASE("people see several cameras side by side, or the one they ask for") {
  TemporaryFolder folder;
  std::filesystem::create_directories(folder / "v");
  const plan::Plan plan = example_plan();
  const std::uint32_t task = plan.find_task("carrot_two_eyes").value();
  REQUIRE(write_start(plan, task, 0, folder / "v/all.png", kAssets).ok());
  REQUIRE(write_start(plan, task, 0, folder / "v/one.png", kAssets, "wrist").ok());
  const auto all = scene::load_image(folder / "v/all.png"),
             one = scene::load_image(folder / "v/one.png");
  REQUIRE(all.ok());
  REQUIRE(one.ok());
  CHECK(all->width == 866);
  CHECK(one->width == 224);
  bool same = true;
  for (std::size_t y = 0; y < 224; ++y) {
    for (std::size_t x = 0; x < 4 * 224; ++x)
      same = same && all->rgba[4 * (866 * (y + 128) + 642) + x] == one->rgba[4 * 224 * y + x];
  }
  CHECK(same);
  const Status none = write_start(plan, task, 0, folder / "v/no.png", kAssets, "wirst");
  REQUIRE_FALSE(none.ok());
  CHECK(to_text(none.failure()).find("it has `third_view`, `wrist`") != std::string::npos);
}

}  // namespace
}  // namespace probe::show
