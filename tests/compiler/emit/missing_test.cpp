// Files of the assets that are not there, and who needs them.
#include <doctest/doctest.h>

#include <fstream>

#include "compiler/diag/text.h"
#include "compiler/emit/compile.h"
#include "tests/runtime/run/temporary_folder.h"

using namespace probe;

namespace {

bool says(const std::string& text, const std::string& what) {
  INFO(text);
  return text.find(what) != std::string::npos;
}

}  // namespace

TEST_CASE("all tasks that need a file are named, whoever of their things and scenes shares it") {
  run::TemporaryFolder folder;
  const std::string text = folder / "t.probe";
  std::ofstream(text) << R"(use "suite/intact.probe"
object yam like carrot { mesh "no_such_root"; name "yam" }
object beet like yam { name "beet" }
scene seen like table { camera third_view overlay "none.png" }
scene seen_too like seen { surface 87cm area (-34cm, -20cm) .. (3cm, 20cm) }
task eats_yam like carrot_on_plate { source yam }
task eats_beet like carrot_on_plate { source beet }
task sees like carrot_on_plate { scene seen }
task sees_too like carrot_on_plate { scene seen_too }
suite s trained on bridge_v2 { tasks { eats_yam, eats_beet, sees, sees_too }; seeds 1 }
)";
  const auto checked = check(
      std::span<const std::string>(&text, 1),
      {.asset_root = VLAPROBE_SOURCE_DIR "/assets",
       .suite = "s",
       .library_folders = {VLAPROBE_SOURCE_DIR "/dsl", VLAPROBE_SOURCE_DIR}});
  REQUIRE(checked.ok());
  const std::string said = render_text(checked->diagnostics, checked->sources);
  CHECK(says(said, "needed by `eats_yam`, `eats_beet`\n"));
  CHECK(says(said, "needed by `sees`, `sees_too`\n"));
}
