// The whole way with a user's data: import, compile the suite on it, settle, render, and compare
// with published pictures of the simulator the data was made for. These are lossy video frames:
// their background alone differs from the photo by 1.8 levels.
#include <doctest/doctest.h>

#include <array>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <map>
#include <vector>

#include "compiler/emit/compile.h"
#include "runtime/assets/asset_check.h"
#include "runtime/assets/import.h"
#include "runtime/plan/plan.h"
#include "runtime/scene/image.h"
#include "runtime/show/preview.h"
#include "runtime/stage/assets.h"
#include "runtime/stage/episode_world.h"
#include "runtime/stage/scene_view.h"
#include "tests/runtime/run/temporary_folder.h"

namespace probe::assets {
namespace {

namespace fs = std::filesystem;

const std::string kReference = VLAPROBE_SOURCE_DIR "/../shared/reference/";

// Imported once for all cases; empty where the reference data is absent.
const std::string& imported() {
  static const run::TemporaryFolder folder;
  static const std::string path = [] {
    if (!fs::exists(kReference + "simpler_assets")) return std::string();
    const auto begin = std::chrono::steady_clock::now();
    ImportOptions options{kReference + "simpler_assets", folder / "assets",
                          VLAPROBE_SOURCE_DIR "/assets"};
    const auto report = import_data(options);
    REQUIRE_MESSAGE(report.ok(), (report.ok() ? "" : to_text(report.failure())));
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
    MESSAGE("imported in " << seconds.count() << " s, " << report->files << " files, "
                           << static_cast<double>(report->bytes) / 1e6 << " MB");
    return options.to;
  }();
  return path;
}

// The same of the Google robot's data, with the suite's own robot and cabinet, and ours for what
// has no mesh.
const std::string& google_imported() {
  static const run::TemporaryFolder folder;
  static const std::string path = [] {
    const std::string released = kReference + "google/google_assets";
    if (!fs::exists(released)) return std::string();
    const std::string own = VLAPROBE_SOURCE_DIR "/assets";
    const auto report = import_data({released, folder / "assets", own, ImportFor::kGoogle, {own}});
    REQUIRE_MESSAGE(report.ok(), to_text(report.failure()));
    return folder / "assets";
  }();
  return path;
}

struct Difference {
  double all = 0, foreground = 0;
};

// What of a suite's text compiles on imported assets: one task alone, or all of `suite`.
plan::Plan compiled(const std::string& text, const std::string& root, const std::string& task_name,
                    const std::string& suite = "") {
  auto inspect = AssetCheck::open(root);
  REQUIRE(inspect.ok());
  CompileOptions options{.asset_root = root,
                         .suite = suite,
                         .library_folders = {VLAPROBE_SOURCE_DIR "/dsl"},
                         .inspect_asset = *inspect};
  if (!task_name.empty())
    options.wants_task = [&](std::string_view name) { return name == task_name; };
  const std::string file = VLAPROBE_SOURCE_DIR "/suite/" + text;
  auto built = build(std::span(&file, 1), options);
  REQUIRE(built.ok());
  const std::string said =
      built->diagnostics.empty() ? "" : built->diagnostics.items().front().message;
  REQUIRE_MESSAGE(built->ok, said);
  if (task_name.empty()) CHECK_MESSAGE(built->diagnostics.empty(), said);
  auto plan = plan::Plan::from_bytes(std::move(built->plan));
  REQUIRE(plan.ok());
  return std::move(plan).value();
}

// The segmentation of a task's picture as it starts.
std::vector<std::uint16_t> segmentation_of(const plan::Plan& plan, std::uint32_t task,
                                           std::uint32_t start, const std::string& root) {
  const std::uint32_t tasks[] = {task};
  const auto assets = stage::SharedAssets::load(plan, root, tasks);
  REQUIRE(assets.ok());
  auto world = stage::EpisodeWorld::create(plan, task, *assets);
  auto view = stage::SceneView::create(plan, task, *assets);
  REQUIRE(world.ok());
  REQUIRE(view.ok());
  REQUIRE((*world)->reset(start).ok());
  const auto frame = (*view)->render((*world)->q(), (*world)->objects());
  REQUIRE(frame.ok());
  return {frame->segmentation.begin(), frame->segmentation.end()};
}

// Root mean square over pixels and channels, 8-bit levels; foreground is where our segmentation
// shows a link or a movable object.
Difference compare(const std::string& task_name, std::uint32_t start, const std::string& picture,
                   const std::string& suite = "intact.probe",
                   const std::string& root = imported()) {
  const plan::Plan plan = compiled(suite, root, task_name);
  const auto task = plan.find_task(task_name);
  REQUIRE(task.has_value());

  const std::string png = std::string(VLAPROBE_BINARY_DIR "/") + task_name + ".png";
  const auto wrote = show::write_start(plan, *task, start, png, root);
  REQUIRE_MESSAGE(wrote.ok(), (wrote.ok() ? "" : to_text(wrote.failure())));
  const auto ours = scene::load_image(png);
  const auto theirs = scene::load_image(kReference + "simpler_frames/" + picture);
  REQUIRE(ours.ok());
  REQUIRE(theirs.ok());
  REQUIRE(ours->rgba.size() == theirs->rgba.size());

  // The same picture again, for its segmentation.
  const std::vector<std::uint16_t> segmentation = segmentation_of(plan, *task, start, root);

  double all = 0, foreground = 0;
  std::size_t count = 0;
  for (std::size_t k = 0; k < segmentation.size(); ++k) {
    double sum = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const double d = double{static_cast<double>(ours->rgba[4 * k + c])} -
                       static_cast<double>(theirs->rgba[4 * k + c]);
      sum += d * d;
    }
    all += sum;
    const auto fixtures = plan.scenes()[plan.tasks()[*task].scene].fixture_visual;
    const std::uint16_t id = segmentation[k];
    if (id == 0 || id == 65535) continue;
    const auto body = plan.bodies(plan.tasks()[*task])[id - 1u];
    if (fixtures != plan::kNone &&
        body.kind == static_cast<std::uint32_t>(plan::BodyKind::kFixture)) {
      continue;
    }
    foreground += sum;
    ++count;
  }
  const Difference difference{std::sqrt(all / (3.0 * static_cast<double>(segmentation.size()))),
                              std::sqrt(foreground / (3.0 * static_cast<double>(count)))};
  MESSAGE(task_name << " start " << start << ": RMSE " << difference.all << " all, "
                    << difference.foreground << " foreground (" << count << " pixels)");
  return difference;
}

bool is_absent() {
  if (!imported().empty()) return false;
  MESSAGE("skipped: no ../shared/reference/simpler_assets");
  return true;
}

TEST_CASE("imported, the stack-cube start looks as the simulator's own picture of it") {
  if (is_absent()) return;
  const Difference difference = compare("stack_cube", 0, "widowx_stack_cube_visual_matching.png");
  CHECK(difference.all <= 3.0);
  CHECK(difference.foreground <= 8.0);
}

TEST_CASE("imported, the spoon start looks as the simulator's own picture of it") {
  if (is_absent()) return;
  const Difference difference =
      compare("spoon_on_towel", 0, "widowx_spoon_on_towel_visual_matching.png");
  CHECK(difference.all <= 4.5);
}

// These two pictures show another moment than a start, and other objects: a smaller plate, and an
// eggplant that the data has no mesh of. The figures are for comparison over time.
TEST_CASE("imported, carrot and sink stay as near to the published pictures as they were") {
  if (is_absent()) return;
  CHECK(compare("carrot_on_plate", 0, "widowx_carrot_on_plate_visual_matching.png").all <= 13);
  CHECK(compare("put_eggplant_in_basket", 0, "widowx_put_eggplant_in_basket_visual_matching.png")
            .all <= 23);
}

// Can and photos are the released ones, arm and cabinet ours; suite/google/README.md says where the
// rest of the difference is.
TEST_CASE(
    "imported, the Google robot's starts before photos are as near to the published pictures as "
    "they were") {
  if (google_imported().empty()) {
    MESSAGE("skipped: no ../shared/reference/google/google_assets");
    return;
  }
  const auto all = [](const char* task, std::uint32_t start, const std::string& picture) {
    return compare(task, start, "google_robot_" + picture + "_visual_matching.png",
                   "google/photos.probe", google_imported())
        .all;
  };
  CHECK(all("pick_horizontal_photo", 12, "coke_can") <= 14.5);
  CHECK(all("open_middle_matched_b1_photo", 0, "open_drawer") <= 33);
  CHECK(all("close_top_matched_b1_photo", 0, "close_drawer") <= 31.3);
}

// The released frame is a screenshot of twice the size: pixel (x, y) of ours is at (2 x + 3, 2 y +
// 1). Of the two things with their light baked in: their mean colour, theirs and ours, and the
// difference pixel by pixel. The bottle is ours. Lit, as before, the can was (36, 105, 49).
TEST_CASE("imported, what shines in move near has the colours of the simulator's own picture") {
  if (google_imported().empty()) {
    MESSAGE("skipped: no ../shared/reference/google/google_assets");
    return;
  }
  const std::string name = "sponge_near_bottle_by_seven_up_baked_photo";
  const plan::Plan plan = compiled("google/photos.probe", google_imported(), name);
  const auto task = plan.find_task(name);
  REQUIRE(task.has_value());
  const std::string png = std::string(VLAPROBE_BINARY_DIR "/") + name + ".png";
  REQUIRE(show::write_start(plan, *task, 0, png, google_imported()).ok());
  const auto ours = scene::load_image(png);
  const auto theirs =
      scene::load_image(kReference + "simpler_frames/google_robot_move_near_visual_matching.png");
  REQUIRE(ours.ok());
  REQUIRE(theirs.ok());
  const auto segmentation = segmentation_of(plan, *task, 0, google_imported());
  REQUIRE(segmentation.size() * 4 == ours->rgba.size());
  const auto width = static_cast<std::size_t>(ours->width);
  std::size_t seen = 0;
  for (const auto& body : plan.bodies(plan.tasks()[*task])) {
    ++seen;
    if (body.kind != static_cast<std::uint32_t>(plan::BodyKind::kObject)) continue;
    const std::string thing(plan.text(plan.objects()[body.index].name));
    if (!thing.starts_with("baked_")) continue;
    std::array<double, 3> our_sum{}, their_sum{};
    double squares = 0;
    std::size_t count = 0;
    for (std::size_t k = 0; k < segmentation.size(); ++k) {
      if (segmentation[k] != seen) continue;
      const std::size_t at =
          (2 * (k / width) + 1) * static_cast<std::size_t>(theirs->width) + 2 * (k % width) + 3;
      REQUIRE(4 * at + 3 < theirs->rgba.size());
      ++count;
      for (std::size_t c = 0; c < 3; ++c) {
        const double a = static_cast<double>(ours->rgba[4 * k + c]);
        const double b = static_cast<double>(theirs->rgba[4 * at + c]);
        our_sum[c] += a;
        their_sum[c] += b;
        squares += (a - b) * (a - b);
      }
    }
    CAPTURE(thing);
    REQUIRE(count > 2000);
    const double n = static_cast<double>(count);
    const double rmse = std::sqrt(squares / (3 * n));
    MESSAGE(thing << ": " << count << " pixels, RMSE " << rmse << ", mean " << our_sum[0] / n << " "
                  << our_sum[1] / n << " " << our_sum[2] / n << ", theirs " << their_sum[0] / n
                  << " " << their_sum[1] / n << " " << their_sum[2] / n);
    for (std::size_t c = 0; c < 3; ++c) CHECK(std::abs(our_sum[c] - their_sum[c]) / n <= 12);
    CHECK(rmse <= 36);
  }
}

TEST_CASE("imported, the whole of visual matching before photos compiles, without a finding") {
  if (google_imported().empty()) {
    MESSAGE("skipped: no ../shared/reference/google/google_assets");
    return;
  }
  const plan::Plan plan = compiled("google/photos.probe", google_imported(), "", "google_photos");
  const plan::Tables& tables = plan.tables();
  REQUIRE(tables.suites.size() == 1);
  const auto members = plan::slice_of(tables.list, tables.suites[0].members);
  CHECK(members.size() == 360);
  std::size_t episodes = 0;
  std::map<std::string, std::size_t> photos;  // trials before each
  for (const std::uint32_t member : members) {
    const plan::TaskRecord& task = tables.tasks[member];
    const std::size_t trials = plan::slice_of(tables.episodes, task.episodes).size();
    episodes += trials;
    const std::uint32_t photo = tables.scenes[task.scene].photo;
    REQUIRE(photo != plan::kNone);
    photos[std::string(plan.text(tables.assets[photo].path))] += trials;
  }
  CHECK(episodes == 864);
  CHECK(photos.size() == 11);
  CHECK(photos["scenes/google/google_coke_can_real_eval_1.png"] == 300);
  CHECK(photos["scenes/google/google_move_near_real_eval_1.png"] == 240);
  CHECK(photos["scenes/google/open_drawer_a0.png"] == 4 * (6 + 9));
  CHECK(photos["scenes/google/open_drawer_c2.png"] == 4 * 6);
}

}  // namespace
}  // namespace probe::assets
