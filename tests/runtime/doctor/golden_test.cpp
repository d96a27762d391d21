// Golden pictures of every object and scene, and of the suite's own first frames.
// VLAPROBE_UPDATE=1 stores them anew.
#include <doctest/doctest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>

#include "compiler/emit/compile.h"
#include "runtime/doctor/golden_frames.h"
#include "runtime/doctor/golden_starts.h"

namespace probe::doctor {
using namespace probe::store;
namespace {

namespace fs = std::filesystem;

const std::string kAssets = std::string(VLAPROBE_SOURCE_DIR) + "/assets";
const std::string kGolden = std::string(VLAPROBE_SOURCE_DIR) + "/tests/golden_frames";

plan::Plan suite_plan() {
  const auto files = golden_suites();
  REQUIRE(files.size() == 2);
  auto built =
      build(files, {.asset_root = kAssets, .library_folders = {VLAPROBE_SOURCE_DIR "/dsl"}});
  REQUIRE_MESSAGE(built.ok(), (built.ok() ? "" : to_text(built.failure())));
  REQUIRE(built->ok);
  auto plan = plan::Plan::from_bytes(std::move(built->plan));
  REQUIRE(plan.ok());
  return std::move(*plan);
}

struct Drawn {
  std::vector<GoldenFrame> frames;
  GoldenSettle settle;
};

Drawn draw_all() {
  auto frames = draw_golden_frames(kAssets);
  REQUIRE_MESSAGE(frames.ok(), (frames.ok() ? "" : to_text(frames.failure())));
  auto settle = settle_golden_objects(kAssets);
  REQUIRE_MESSAGE(settle.ok(), (settle.ok() ? "" : to_text(settle.failure())));
  auto starts = draw_first_frames(suite_plan(), kAssets);
  REQUIRE_MESSAGE(starts.ok(), (starts.ok() ? "" : to_text(starts.failure())));
  CHECK(starts->size() == 4);  // the suite's table and its sink, the Panda's table by two cameras
  for (GoldenFrame& frame : *starts) frames->push_back(std::move(frame));
  return {std::move(*frames), std::move(*settle)};
}

TEST_CASE("every object and scene looks as its golden picture, by hash on the same build") {
  const Drawn here = draw_all();
  if (std::getenv("VLAPROBE_UPDATE") != nullptr) {
    REQUIRE(write_golden(kGolden, here.frames, here.settle).ok());
  }
  const auto report = check_golden(kGolden, here.frames, here.settle);
  REQUIRE_MESSAGE(report.ok(), (report.ok() ? "" : to_text(report.failure())));
  for (const std::string& line : report->other_build) MESSAGE("another build: ", line);
  for (std::size_t i = 0; i < here.frames.size(); ++i) {
    const GoldenCheck& check = report->frames[i];
    const bool fine = check.state == GoldenState::kIdentical || check.state == GoldenState::kClose;
    CHECK_MESSAGE(fine, check.name, " ", std::string(to_text(check.state)), ": ", check.ids,
                  " ids, ", check.levels, " colours, depth by ", check.depth, " m");
    if (fine) continue;
    const std::string png = VLAPROBE_BINARY_DIR "/golden_" + check.name + ".png";
    if (write_golden_difference(kGolden, here.frames[i], png).ok()) MESSAGE("see ", png);
  }
  CHECK_MESSAGE(
      (report->settle == GoldenState::kIdentical || report->settle == GoldenState::kClose),
      "objects settled ", report->settle_distance, " m elsewhere");
}

TEST_CASE("a golden picture tells a moved object, another colour and what is not stored") {
  const fs::path folder =
      fs::temp_directory_path() / ("probe_golden_" + std::to_string(::getpid()));
  GoldenFrame frame{"a",
                    32,
                    32,
                    std::vector<std::uint8_t>(3 * 32 * 32, 100),
                    std::vector<float>(32 * 32, 0.75f),
                    std::vector<std::uint16_t>(32 * 32, 65535)};
  const GoldenSettle settle{Sha256{}, {Vec3(0, 0, 0.5)}};
  REQUIRE(write_golden(folder.string(), std::vector{frame}, settle).ok());
  const auto state = [&](const GoldenFrame& seen) {
    const auto report = check_golden(folder.string(), std::vector{seen}, settle);
    REQUIRE(report.ok());
    CHECK(report->settle == GoldenState::kIdentical);
    return report->frames[0];
  };
  CHECK(state(frame).state == GoldenState::kIdentical);
  GoldenFrame near = frame;
  near.rgb[7] = 101;
  near.depth[9] += 5e-6f;
  // On the same build even one level is a change; what it is is told.
  CHECK(state(near).state == GoldenState::kDiffers);
  CHECK(state(near).levels == 0);
  CHECK(state(near).depth == doctest::Approx(5e-6).epsilon(0.02));
  GoldenFrame moved = frame;
  std::fill(moved.ids.begin(), moved.ids.begin() + 50, std::uint16_t{1});
  std::fill(moved.rgb.begin(), moved.rgb.begin() + 90, std::uint8_t{0});
  CHECK(state(moved).state == GoldenState::kDiffers);
  CHECK(state(moved).ids == 50);
  CHECK(state(moved).levels == 30);
  moved.name = "b";
  CHECK(state(moved).state == GoldenState::kMissing);
  CHECK_FALSE(check_golden((folder / "none").string(), std::vector{frame}, settle).ok());
  CHECK(write_golden_difference(folder.string(), frame, (folder / "d.png").string()).ok());
  fs::remove_all(folder);
}

}  // namespace
}  // namespace probe::doctor
