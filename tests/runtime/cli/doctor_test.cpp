// What `doctor` says of a whole installation and of a damaged one.
#include <doctest/doctest.h>

#include "runtime/base/json.h"
#include "tests/runtime/cli/program.h"

using json = probe::Json;

using probe::test::Sandbox;
namespace fs = std::filesystem;

TEST_CASE("doctor names builds, instruction sets, assets, golden pictures and the settled state") {
  const Sandbox box;
  const auto outcome = box.vlaprobe("doctor --json");
  const json report = json::parse(outcome.out);
  CHECK(outcome.exit == (report["fine"].get<bool>() ? 0 : 2));
  CHECK(report["assets"]["damage"].empty());
  CHECK(report["assets"]["files"].get<int>() > 50);
  CHECK(report["ray_engine"].get<std::string>().starts_with("Embree 3."));
  CHECK(report["instruction_sets"].is_array());
  CHECK(report["settle"]["state"].get<std::string>().size() == 64);
  CHECK(report["fingerprint"].contains("compiler"));
  CHECK(report["golden"]["frames"].size() >= 25);
  CHECK(report["golden"]["frames"].back()["name"] == "start_sink_put_eggplant_in_basket");
  CHECK(report["suite"].is_null());
  for (const json& frame : report["golden"]["frames"]) CHECK(frame["result"] != "not stored");
  CHECK(box.vlaprobe("doctor").out.find("golden pictures") != std::string::npos);
}

TEST_CASE("doctor names a damaged asset, and a folder that is none") {
  const Sandbox box;
  fs::copy(fs::path(VLAPROBE_SOURCE_DIR) / "assets", box / "assets", fs::copy_options::recursive);
  probe::test::write_file(box / "assets/objects/nut/collision.obj", "v 0 0 0\n");
  const auto outcome = box.vlaprobe("doctor --assets assets");
  CHECK(outcome.exit == 2);
  CHECK(outcome.out.find("objects/nut/collision.obj: has other bytes") != std::string::npos);
  fs::remove(box / "assets/objects/nut/visual.glb");
  fs::remove(box / "assets/scenes/table/visual.glb");
  const auto worse = box.vlaprobe("doctor --assets assets");
  CHECK(worse.exit == 2);
  CHECK(worse.err.find("scenes/table/visual.glb") != std::string::npos);
  CHECK(box.vlaprobe("doctor --assets nowhere").exit == 2);
}

TEST_CASE("doctor compares no golden pictures with assets that they do not show") {
  const Sandbox box;
  fs::create_directories(box / "assets");
  probe::test::write_file(box / "assets/manifest.json", R"({"files": []})");
  const auto outcome = box.vlaprobe("doctor --assets assets");
  CHECK(outcome.exit == 0);
  CHECK(outcome.out.find("not compared: they show vlaprobe's own assets") != std::string::npos);
}
