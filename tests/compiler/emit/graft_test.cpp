#include "compiler/emit/graft.h"

#include <doctest/doctest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "compiler/emit/analyzed.h"

using namespace probe;

namespace {

CompileOptions options() {
  const std::string root = VLAPROBE_SOURCE_DIR;
  return {.asset_root = root + "/assets", .suite = "", .library_folders = {root + "/dsl", root}};
}

AnalyzedText analyzed(const std::string& text) {
  const auto file = std::filesystem::temp_directory_path() /
                    ("probe_graft_" + std::to_string(getpid()) + ".probe");
  std::ofstream(file) << text;
  const std::string name = file.string();
  auto made = analyze_text({&name, 1}, options());
  std::filesystem::remove(file);
  REQUIRE_MESSAGE(made.ok(), to_text(made.failure()));
  REQUIRE(made->compilation.ok);
  return std::move(*made);
}

plan::Plan kitchen() {
  const std::string file = VLAPROBE_SOURCE_DIR "/suite/kitchen.probe";
  const auto built = build({&file, 1}, options());
  REQUIRE(built.ok());
  auto stored = plan::Plan::from_bytes(built->plan);
  REQUIRE(stored.ok());
  return std::move(*stored);
}

const std::string kOpened =
    "use \"suite/kitchen.probe\"\nmetrics extra { far = max travel(cabinet.top) }\n";

}  // namespace

TEST_CASE(
    "metrics of a text that uses another with tasks, as for its fixtures, are metrics alone") {
  AnalyzedText text = analyzed(kOpened);
  REQUIRE(is_metrics_alone(text));
  const plan::Plan stored = kitchen();
  const auto grafted = graft_metrics(stored, std::move(text));
  REQUIRE_MESSAGE(grafted.ok(), to_text(grafted.failure()));
  CHECK(grafted->metrics == std::vector<std::string>{"far"});
  REQUIRE(grafted->left_out.size() == 1);  // of tasks in a scene without it
  CHECK(grafted->left_out[0].tasks.size() < stored.tasks().size());
}

TEST_CASE("a text with tasks or a suite of its own is judged as a plan") {
  CHECK_FALSE(is_metrics_alone(analyzed(kOpened + "task t like carrot_away { horizon 30s }\n")));
  CHECK_FALSE(is_metrics_alone(analyzed(kOpened + "suite s { tasks { carrot_away }; seeds 0 }\n")));
}

TEST_CASE("only a metric that is measured from a camera is refused, whatever else the text uses") {
  const plan::Plan stored = kitchen();
  const std::string seen =
      "use \"std/space.probe\"\nmetrics extra { side = min view_x(surface) }\n";
  CHECK_FALSE(graft_metrics(stored, analyzed(seen)).ok());
  const std::string unseen = "use \"std/space.probe\"\nmetrics extra { on = final time }\n";
  CHECK(graft_metrics(stored, analyzed(unseen)).ok());
}
