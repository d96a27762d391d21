#include <doctest/doctest.h>

#include <filesystem>

#include "compiler/diag/text.h"
#include "compiler/emit/compile.h"
#include "runtime/plan/places.h"
#include "runtime/plan/plan.h"

using namespace probe;
namespace fs = std::filesystem;

TEST_CASE("every example compiles without a word") {
  std::size_t seen = 0;
  for (const auto& entry : fs::directory_iterator(fs::path(VLAPROBE_SOURCE_DIR) / "examples")) {
    if (entry.path().extension() != ".probe") continue;
    // Its robot is the user's own; tests/runtime/stage/my_robot_test.cpp makes one.
    if (entry.path().stem() == "my_robot") continue;
    ++seen;
    const std::string file = entry.path().string();
    CAPTURE(file);
    const auto built = build(std::span<const std::string>(&file, 1),
                             {VLAPROBE_SOURCE_DIR "/assets", "", {VLAPROBE_SOURCE_DIR "/dsl"}});
    REQUIRE_MESSAGE(built.ok(), to_text(built.failure()));
    CHECK_MESSAGE(built->diagnostics.empty(), render_text(built->diagnostics, built->sources));
    REQUIRE(built->ok);
    const auto plan = plan::Plan::from_bytes(built->plan);
    REQUIRE_MESSAGE(plan.ok(), to_text(plan.failure()));
    CHECK(plan->suites().size() >= 1);
  }
  CHECK(seen >= 3);
}

TEST_CASE("a contrast pair is paired start by start: roles change, nothing moves") {
  const std::string file = VLAPROBE_SOURCE_DIR "/examples/left_right.probe";
  const auto built = build(std::span<const std::string>(&file, 1),
                           {VLAPROBE_SOURCE_DIR "/assets", "", {VLAPROBE_SOURCE_DIR "/dsl"}});
  REQUIRE(built.ok());
  const auto plan = plan::Plan::from_bytes(built->plan);
  REQUIRE_MESSAGE(plan.ok(), to_text(plan.failure()));
  const auto keys = [&](std::string_view name) {
    std::vector<std::string> all;
    for (const plan::TaskRecord& task : plan->tasks()) {
      if (plan->text(task.name) != name) continue;
      for (const plan::EpisodeRecord& episode : plan->episodes(task))
        all.push_back(plan::taken_key(*plan, task, episode));
    }
    return all;
  };
  CHECK(keys("left_can").size() == 12);
  CHECK(keys("left_can") == keys("right_can"));
}
