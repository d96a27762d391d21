// Photos of another shape than the camera's picture are refused where they are named.
#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>

#include "compiler/diag/text.h"
#include "compiler/emit/compile.h"
#include "runtime/scene/image.h"
#include "tests/runtime/run/temporary_folder.h"

using namespace probe;
namespace fs = std::filesystem;

namespace {

// What check() says of a carrot's task before a photo of that size; `overlay`: written in the text,
// else in the backdrop's folder.
std::string said_of(int width, int height, bool overlay, const std::string& camera = "third_view") {
  run::TemporaryFolder folder;
  fs::create_directories(folder / "scenes/wall");
  const std::string photo = overlay ? "scenes/wall.png" : "scenes/wall/photo.png";
  const std::vector<std::uint8_t> rgb(3 * static_cast<std::size_t>(width * height), 90);
  REQUIRE(scene::write_png(folder / photo, width, height, rgb).ok());
  const std::string text = folder / "t.probe";
  std::ofstream(text) << "use \"suite/intact.probe\"\n"
                         "camera hand { mount widowx.gripper_link at (0cm, 0cm, 8cm) look (1, 0, -0.4)\n"
                         "  image 320 x 240; lens 250px, 250px, 160px, 120px }\n"
                         "scene seen like table { " +
                             (overlay ? "camera " + camera + " overlay \"wall.png\""
                                      : std::string("backdrop \"wall\"")) +
                             " }\n"
                             "@allow(confounded, \"a test\")\n"
                             "variant t of carrot_on_plate { scene seen }\n"
                             "suite s trained on bridge_v2 { tasks { t }; seeds 1 }\n";
  const AssetRoot root = AssetRoot::chosen({VLAPROBE_SOURCE_DIR "/assets", folder.path});
  const auto checked = check(
      std::span<const std::string>(&text, 1),
      {.asset_root = root, .suite = "s", .library_folders = {VLAPROBE_SOURCE_DIR "/dsl", VLAPROBE_SOURCE_DIR}});
  REQUIRE(checked.ok());
  return render_text(checked->diagnostics, checked->sources);
}

bool says(const std::string& text, const std::string& what) {
  INFO(text);
  return text.find(what) != std::string::npos;
}

}  // namespace

TEST_CASE("check tells a photo of another shape at the place that names it") {
  const std::string said = said_of(320, 200, true);
  CHECK(says(said, "error[P0304]: `third_view`, photo `scenes/wall.png`: the photo is 320 x 200 pixels, the "
                   "camera's picture 640 x 480"));
  CHECK(says(said, "camera third_view overlay \"wall.png\""));
  const std::string behind = said_of(320, 200, false);
  CHECK(says(behind, "photo `scenes/wall/photo.png`: the photo is 320 x 200"));
  CHECK_FALSE(says(said_of(320, 240, true), "P0304"));
  CHECK_FALSE(says(said_of(320, 240, false), "P0304"));
}

TEST_CASE("a camera that moves has no photo, so its shape is nothing to it") {
  CHECK_FALSE(says(said_of(320, 200, true, "hand"), "P0304"));
}
