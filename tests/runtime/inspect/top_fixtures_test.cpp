#include "runtime/inspect/top_fixtures.h"

#include <doctest/doctest.h>

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "compiler/diag/text.h"
#include "compiler/emit/compile.h"
#include "runtime/inspect/svg.h"
#include "runtime/inspect/task_json.h"
#include "tests/plan/other_link.h"

using namespace probe;
using namespace probe::inspect;

namespace {

const std::string kRoot = VLAPROBE_SOURCE_DIR;

std::vector<std::byte> drawers() {
  const std::vector<std::string> files = {kRoot + "/examples/drawer.probe"};
  auto built = build(
      files,
      {.asset_root = kRoot + "/assets", .suite = "", .library_folders = {kRoot + "/dsl", kRoot}});
  REQUIRE(built.ok());
  REQUIRE(built->ok);
  return std::move(built->plan);
}

TopView view_of(const char* task) {
  const auto plan = plan::Plan::from_bytes(drawers());
  REQUIRE(plan.ok());
  const auto index = plan->find_task(task);
  REQUIRE(index);
  auto view = top_view(*plan, *index, kRoot + "/assets");
  REQUIRE_MESSAGE(view.ok(), (view.ok() ? "" : to_text(view.failure())));
  return std::move(*view);
}

const TopPart& part(const TopView& view, const std::string& name) {
  const auto found = std::ranges::find(view.parts, name, &TopPart::name);
  REQUIRE(found != view.parts.end());
  return *found;
}

double high_y(const std::vector<Point>& outline) {
  return std::ranges::max(outline, {}, &Point::y).y;
}

}  // namespace

TEST_CASE("parts are seen where their joints begin and where they end, regions with their part") {
  const TopView shut = view_of("open_drawer"), ajar = view_of("drawer_ajar");
  CHECK(shut.parts.size() == 4);
  CHECK(part(shut, "cabinet").open.empty());
  const TopPart& drawer = part(shut, "cabinet.top_drawer");
  REQUIRE(drawer.outlines.size() == 6);
  REQUIRE(drawer.open.size() == 6);
  // The cabinet stands at y = 32 cm and looks along -y; the drawer's floor reaches from 9 cm behind
  // it on, and slides 14 cm.
  CHECK(high_y(drawer.outlines[0]) == doctest::Approx(0.41));
  CHECK(high_y(drawer.open[0]) == doctest::Approx(0.27));
  CHECK(high_y(part(ajar, "cabinet.top_drawer").outlines[0]) == doctest::Approx(0.36));
  CHECK(high_y(part(ajar, "cabinet.top_drawer").open[0]) == doctest::Approx(0.27));
  REQUIRE(shut.regions.size() == 1);
  CHECK(shut.regions[0].name == "cabinet.inside_top");
  CHECK(high_y(shut.regions[0].outline) == doctest::Approx(0.40));
  CHECK(high_y(ajar.regions[0].outline) == doctest::Approx(0.35));
}

TEST_CASE("a turned region is drawn and told as it lies, not as the box around it") {
  const std::string text = R"(
use "suite/intact.probe"
scene slotted like table {
  region slot of surface box (-3cm, -9cm, 0cm) .. (3cm, 9cm, 8cm) at (-10cm, 10cm, 0cm) yaw 45deg
}
task turned like carrot_on_plate { scene slotted }
suite all { tasks { turned }; seeds 0 }
)";
  const auto file = std::filesystem::temp_directory_path() /
                    ("probe_turned_" + std::to_string(getpid()) + ".probe");
  std::ofstream(file) << text;
  const std::vector<std::string> files = {file.string()};
  auto built = build(
      files,
      {.asset_root = kRoot + "/assets", .suite = "", .library_folders = {kRoot + "/dsl", kRoot}});
  std::filesystem::remove(file);
  REQUIRE(built.ok());
  REQUIRE_MESSAGE(built->ok, render_text(built->diagnostics, built->sources));
  const auto plan = plan::Plan::from_bytes(std::move(built->plan));
  REQUIRE(plan.ok());
  const std::uint32_t task = plan->find_task("turned").value();
  const auto view = top_view(*plan, task, kRoot + "/assets");
  REQUIRE(view.ok());
  REQUIRE(view->regions.size() == 1);
  REQUIRE(view->regions[0].outline.size() >= 4);
  for (const Point& corner : view->regions[0].outline)
    CHECK(std::hypot(corner.x + 0.10, corner.y - 0.10) == doctest::Approx(std::hypot(0.03, 0.09)));

  const Json regions = describe(*plan, task)["regions"];
  REQUIRE(regions.size() == 1);
  const Json& turned = regions[0]["turned"];
  CHECK(turned["half_m"] == Json::array({0.03, 0.09, 0.04}));
  CHECK(turned["middle_m"][1].get<double>() == doctest::Approx(0.1));
  CHECK(turned["rotation_wxyz"][0].get<double>() ==
        doctest::Approx(std::cos(std::numbers::pi / 8)));
  // Beside it the box around it, as ever.
  CHECK(regions[0]["high_m"][1].get<double>() == doctest::Approx(0.1 + 0.12 * std::sqrt(0.5)));
}

TEST_CASE("the picture names parts and regions and says which way is left") {
  const std::string svg = to_svg(view_of("open_drawer"));
  CHECK(svg.find("<title>cabinet.top_drawer</title>") != std::string::npos);
  CHECK(svg.find("region cabinet.inside_top") != std::string::npos);
  CHECK(svg.find(">left</text>") != std::string::npos);
  CHECK(svg.find("nan") == std::string::npos);
}

TEST_CASE("a part whose link the description lacks is refused by name") {
  const auto whole = plan::Plan::from_bytes(drawers());
  REQUIRE(whole.ok());
  const auto parts = whole->parts(whole->fixtures()[0]);
  REQUIRE(whole->text(parts[1].name) == "cabinet.top_drawer");
  const plan::Plan plan = plan::with_link(drawers(), 1, parts[1].name);
  const auto view = top_view(plan, *plan.find_task("open_drawer"), kRoot + "/assets");
  REQUIRE(!view.ok());
  CHECK(view.failure().message == "no link `cabinet.top_drawer` for part `cabinet.top_drawer`");
  CHECK(view.failure().where.ends_with("fixtures/cabinet/cabinet.urdf"));
}
