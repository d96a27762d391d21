// What varies without a new mesh, in worlds and pictures: sizes, paints, textures, the colour of
// light, sensors, late actions, arms that begin elsewhere.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <memory>
#include <numeric>
#include <string>
#include <vector>

#include "runtime/scene/covered_mesh.h"
#include "runtime/scene/image.h"
#include "runtime/stage/backdrop.h"
#include "runtime/stage/stage.h"
#include "tests/runtime/run/plan_of_text.h"

namespace probe::stage {
namespace {

const char* const kVaried = R"(use "suite/intact.probe"
object large like carrot { scale 1.25 }
object red_one like carrot { paint red; color red }
object boarded like plate { texture "checks" 6cm }
light warm { ambient 0.3; sun (0, 0, -1) power 2.2; sun (-1, -0.5, -1) power 0.7; sun (1, 1, -1) power 0.7
  color (1, 0.7, 0.4) }
scene wooden like table { texture surface "marble" 40cm; texture walls "bricks" }
camera noisy like third_view { sensor noise 0.05 }
camera blurred like third_view { sensor blur 2px }
camera dark like third_view { sensor exposure 0.3 }
camera dirty like third_view { sensor patch (0.25, 0.5) .. (0.5, 0.75) }
camera gappy like third_view { sensor dropped 0.6 }
layout unsteady like grid_24 { joints jitter 2deg }
layout thrown like grid_24 { joints jitter 180deg }
variants of carrot_on_plate {
  v_large { source large }
  v_red { source red_one }
  v_boarded { target boarded }
  v_warm { light warm }
  v_wooden { scene wooden }
  v_noisy { camera noisy }
  v_blurred { camera blurred }
  v_dark { camera dark }
  v_dirty { camera dirty }
  v_gappy { camera gappy }
  v_unsteady { layout unsteady }
  v_thrown { layout thrown }
  v_late { delay 400ms }
}
suite mine trained on bridge_v2 { tasks { carrot_on_plate } | variants of { carrot_on_plate }; seeds 42 }
)";

const plan::Plan& varied() {
  static const plan::Plan plan = run::plan_of_text(kVaried);
  return plan;
}

std::unique_ptr<Stage> stage_of(const std::string& task, bool pictures = true) {
  const auto index = varied().find_task(task);
  REQUIRE_MESSAGE(index, task);
  const std::uint32_t tasks[] = {*index};
  auto assets = SharedAssets::load(varied(), VLAPROBE_SOURCE_DIR "/assets", tasks);
  REQUIRE_MESSAGE(assets.ok(), to_text(assets.failure()));
  auto stage =
      Stage::create(varied(), *index, *assets, {.image = {320, 240}, .pictures = pictures});
  REQUIRE_MESSAGE(stage.ok(), to_text(stage.failure()));
  const Status begun = (*stage)->reset(0);
  REQUIRE_MESSAGE(begun.ok(), to_text(begun.failure()));
  return std::move(stage).value();
}

struct Seen {
  std::vector<std::uint8_t> rgb;
  std::vector<std::uint16_t> ids;
  double mean(std::size_t channel) const {
    double sum = 0;
    for (std::size_t i = channel; i < rgb.size(); i += 3) sum += rgb[i];
    return sum / (static_cast<double>(rgb.size()) / 3);
  }
  // Of one body's pixels.
  double mean_of(std::uint16_t id, std::size_t channel) const {
    double sum = 0, count = 0;
    for (std::size_t i = 0; i < ids.size(); ++i) {
      if (ids[i] != id) continue;
      sum += rgb[3 * i + channel];
      ++count;
    }
    return count == 0 ? 0 : sum / count;
  }
  double differs_from(const Seen& other) const {
    double sum = 0;
    for (std::size_t i = 0; i < rgb.size(); ++i) sum += std::abs(rgb[i] - other.rgb[i]);
    return sum / static_cast<double>(rgb.size());
  }
};

Seen look(Stage& stage, const char* keep_as = nullptr) {
  const auto seen = stage.observe();
  REQUIRE_MESSAGE(seen.ok(), to_text(seen.failure()));
  const render::FrameView& frame = stage.frames().front().frame;
  if (const char* folder = std::getenv("VLAPROBE_KEEP_PICTURES"); folder != nullptr && keep_as)
    CHECK(scene::write_png(std::string(folder) + "/" + keep_as + ".png", frame.width, frame.height,
                           frame.rgb)
              .ok());
  return {{frame.rgb.begin(), frame.rgb.end()},
          {frame.segmentation.begin(), frame.segmentation.end()}};
}

constexpr std::uint16_t kSource = 1, kTarget = 2;

const policy::Action& still() {
  static const policy::Action stay{0, 0, 0, 0, 0, 0, 1};
  return stay;
}

TEST_CASE("a scaled object is larger in the picture and in the world, its mass by volume") {
  const auto plain = stage_of("carrot_on_plate"), large = stage_of("v_large");
  const auto& before = plain->privileged().objects[0];
  const auto& after = large->privileged().objects[0];
  CHECK(after.box_max.x() == doctest::Approx(1.25 * before.box_max.x()));
  REQUIRE(after.parts.size() == before.parts.size());
  // Corners as loaded, to the rounding of a hull.
  const auto extent = [](const policy::PrivilegedObject& object) {
    double most = 0;
    for (const auto& part : object.parts) {
      for (const Vec3& corner : part) most = std::max(most, std::abs(corner.x()));
    }
    return most;
  };
  CHECK(extent(after) == doctest::Approx(1.25 * extent(before)).epsilon(1e-6));
  const Seen a = look(*plain, "plain"), b = look(*large, "large");
  const auto area = [](const Seen& seen) { return std::ranges::count(seen.ids, kSource); };
  CHECK(static_cast<double>(area(b)) > 1.3 * static_cast<double>(area(a)));
}

TEST_CASE("paint and textures are on the object they are of, and light has its colour") {
  const auto plain = stage_of("carrot_on_plate");
  const Seen a = look(*plain);
  const auto red = stage_of("v_red");
  const Seen b = look(*red, "red");
  CHECK(b.mean_of(kSource, 0) > 2 * b.mean_of(kSource, 1));
  CHECK(b.mean_of(kTarget, 1) == a.mean_of(kTarget, 1));
  const auto boarded = stage_of("v_boarded");
  const Seen c = look(*boarded, "boarded");
  CHECK(std::abs(c.mean_of(kTarget, 0) - a.mean_of(kTarget, 0)) > 30);
  CHECK(c.mean_of(kSource, 0) == a.mean_of(kSource, 0));
  const auto warm = stage_of("v_warm");
  const Seen d = look(*warm, "warm");
  CHECK(d.mean(0) == a.mean(0));
  CHECK(d.mean(1) < 0.95 * a.mean(1));
  CHECK(d.mean(2) < 0.8 * a.mean(2));
  const auto wooden = stage_of("v_wooden");
  const Seen e = look(*wooden, "wooden");
  CHECK(e.ids == a.ids);
  CHECK(e.differs_from(a) > 10);
  CHECK(e.mean_of(kSource, 0) == a.mean_of(kSource, 0));
}

TEST_CASE("a texture that covers nothing of a backdrop is refused by its part") {
  scene::Mesh wall;
  wall.materials.emplace_back();
  wall.parts.push_back(
      {0, {0, 0, 1, 0, 1, 1, 0, 0, 2}, {1, 0, 0, 1, 0, 0, 1, 0, 0}, {}, {0, 1, 2}});
  const scene::Texture dot{1, 1, {255, 0, 0, 255}};
  const std::array<double, 4> area = {-1, -1, 1, 1};
  const Cover on_wall[] = {{plan::CoverOf::kWalls, &dot, 0.5}};
  const auto covered = covered_backdrop(wall, {}, area, 0.9, on_wall);
  REQUIRE(covered.ok());
  REQUIRE(covered->parts.size() == 1);
  CHECK(covered->parts[0].uv == std::vector<float>{0, -2, 2, -2, 0, -4});
  const Cover on_floor[] = {{plan::CoverOf::kFloor, &dot, 0.5}};
  const auto refused = covered_backdrop(wall, {}, area, 0.9, on_floor);
  REQUIRE(!refused.ok());
  CHECK(refused.failure().message.find("a floor") != std::string::npos);
}

TEST_CASE("noise, blur, exposure and a patch are in what a policy gets and in nothing else") {
  const auto plain = stage_of("carrot_on_plate");
  const Seen a = look(*plain);
  const auto noisy = stage_of("v_noisy");
  const Seen b = look(*noisy, "noisy");
  // 0.05 of 255, where nothing is cut off.
  double squares = 0, count = 0;
  for (std::size_t i = 0; i < a.rgb.size(); ++i) {
    if (a.rgb[i] < 60 || a.rgb[i] > 195) continue;
    squares += std::pow(b.rgb[i] - a.rgb[i], 2);
    ++count;
  }
  CHECK(std::sqrt(squares / count) == doctest::Approx(0.05 * 255).epsilon(0.02));
  CHECK(look(*noisy).rgb == b.rgb);  // the same moment, the same noise
  CHECK(noisy->state_hash() == plain->state_hash());
  REQUIRE(noisy->step(still()).ok());
  CHECK(look(*noisy).rgb != b.rgb);
  const auto again = stage_of("v_noisy");
  REQUIRE(again->step(still()).ok());
  CHECK(look(*again).rgb == look(*noisy).rgb);

  const auto blurred = stage_of("v_blurred");
  const Seen c = look(*blurred, "blurred");
  CHECK(c.mean(0) == doctest::Approx(a.mean(0)).epsilon(0.01));
  CHECK(c.differs_from(a) > 0.5);
  const auto dark = stage_of("v_dark");
  const Seen d = look(*dark, "dark");
  CHECK(d.mean(1) == doctest::Approx(std::pow(0.3, 1 / 2.2) * a.mean(1)).epsilon(0.03));
  const auto dirty = stage_of("v_dirty");
  const Seen e = look(*dirty, "dirty");
  for (int y = 0; y < 240; ++y) {
    for (int x = 0; x < 320; ++x) {
      const auto pixel = static_cast<std::size_t>(320 * y + x);
      const bool hidden = x >= 80 && x < 160 && y >= 120 && y < 180;
      REQUIRE(e.ids[pixel] == (hidden ? 0 : a.ids[pixel]));
      REQUIRE(e.rgb[3 * pixel] == (hidden ? 0 : a.rgb[3 * pixel]));
    }
  }
}

TEST_CASE("a picture that is dropped shows the one before, also behind a saved state") {
  const auto gappy = stage_of("v_gappy"), plain = stage_of("carrot_on_plate");
  policy::Action move = still();
  move[0] = 0.01;
  std::vector<Seen> shown, real;
  std::vector<std::byte> saved;
  for (int step = 0; step < 12; ++step) {
    shown.push_back(look(*gappy));
    real.push_back(look(*plain));
    if (step == 5) saved = gappy->save().to_bytes();
    REQUIRE(gappy->step(move).ok());
    REQUIRE(plain->step(move).ok());
  }
  CHECK(shown[0].rgb == real[0].rgb);
  int dropped = 0;
  for (std::size_t i = 1; i < shown.size(); ++i) {
    if (shown[i].rgb == real[i].rgb) continue;
    CHECK(shown[i].rgb == shown[i - 1].rgb);
    ++dropped;
  }
  CHECK(dropped > 2);
  CHECK(dropped < 11);
  const auto state = StageState::from_bytes(saved);
  REQUIRE(state.ok());
  const auto other = stage_of("v_gappy");
  const Status restored = other->restore(*state);
  REQUIRE_MESSAGE(restored.ok(), to_text(restored.failure()));
  for (std::size_t step = 5; step < 12; ++step) {
    CHECK(look(*other).rgb == shown[step].rgb);
    REQUIRE(other->step(move).ok());
  }
}

TEST_CASE("a late action acts two steps later, also behind a saved state") {
  const auto late = stage_of("v_late", false), plain = stage_of("carrot_on_plate", false);
  policy::Action move = still();
  const auto tcp = [](const Stage& stage) { return stage.sample().tcp; };
  // What the late stage does is what the other does with the same actions behind two of standing.
  for (int step = 0; step < 8; ++step) {
    move[0] = 0.005 * step;
    REQUIRE(late->step(move).ok());
    policy::Action then = still();
    if (step >= 2) then[0] = 0.005 * (step - 2);
    REQUIRE(plain->step(then).ok());
    CHECK(tcp(*late) == tcp(*plain));
  }
  const auto state = StageState::from_bytes(late->save().to_bytes());
  REQUIRE(state.ok());
  const auto other = stage_of("v_late", false);
  REQUIRE(other->restore(*state).ok());
  for (int step = 0; step < 4; ++step) {
    REQUIRE(late->step(still()).ok());
    REQUIRE(other->step(still()).ok());
    CHECK(late->state_hash() == other->state_hash());
  }
  const auto wrong = stage_of("carrot_on_plate", false);
  CHECK(!wrong->restore(*state).ok());
  policy::Action bad = still();
  bad[1] = std::nan("");
  CHECK(!late->step(bad).ok());
}

TEST_CASE("a shaken arm begins where its start says, the objects where they did") {
  const auto plain = stage_of("carrot_on_plate", false), shaken = stage_of("v_unsteady", false);
  const plan::TaskRecord& task = varied().tasks()[*varied().find_task("v_unsteady")];
  const auto arm = varied().joints(varied().scenes()[task.scene], varied().episodes(task)[0]);
  REQUIRE(arm.size() <= shaken->q().size());
  double moved = 0;
  for (std::size_t i = 0; i < arm.size(); ++i) {
    CHECK(shaken->q()[i] == arm[i]);
    moved = std::max(moved, std::abs(arm[i] - plain->q()[i]));
  }
  CHECK(moved > 0.003);
  CHECK(moved <= 2 * 3.14159265 / 180);
  CHECK(shaken->objects()[0].position == plain->objects()[0].position);
}

TEST_CASE("an arm that begins in the table or in a thing begins no episode") {
  const auto index = varied().find_task("v_thrown");
  REQUIRE(index);
  const std::uint32_t tasks[] = {*index};
  auto assets = SharedAssets::load(varied(), VLAPROBE_SOURCE_DIR "/assets", tasks);
  REQUIRE(assets.ok());
  auto stage = Stage::create(varied(), *index, *assets, {.image = {320, 240}, .pictures = false});
  REQUIRE(stage.ok());
  int begun = 0, refused = 0;
  for (std::uint32_t e = 0; e < 24; ++e) {
    const Status reset = (*stage)->reset(e);
    begun += reset.ok() ? 1 : 0;
    if (reset.ok()) continue;
    ++refused;
    CHECK(reset.failure().message.starts_with("the arm begins "));
    CHECK(reset.failure().message.find(" cm in ") != std::string::npos);
  }
  CHECK(begun > 0);
  CHECK(refused > 0);
}

}  // namespace
}  // namespace probe::stage
