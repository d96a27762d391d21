// The example of a program from outside: built as others would, run in processes of its own.
#include <doctest/doctest.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

#include "runtime/stage/stage.h"
#include "tests/parity/published.h"
#include "tests/runtime/run/temporary_folder.h"

namespace probe {
namespace {

constexpr const char* kTask = "carrot_on_plate";

struct Ended {
  std::string text;  // of both streams
  int status = 0;
};

Ended output_of(const std::string& command) {
  FILE* pipe = ::popen((command + " 2>&1").c_str(), "r");
  REQUIRE(pipe != nullptr);
  std::string text;
  char buffer[256];
  while (std::fgets(buffer, sizeof buffer, pipe) != nullptr) text += buffer;
  return {text, ::pclose(pipe)};
}

TEST_CASE("a program from outside steps a stage, and a second process goes on from its bytes") {
  const run::TemporaryFolder folder;
  const plan::Plan& plan = test::suite_plan();
  const auto bytes = plan.bytes();
  std::ofstream(folder / "suite.plan", std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
  const std::string state = folder / "at_ten.stage";
  const std::string command = VLAPROBE_BINARY_DIR "/examples/stage/stage_example " +
                              (folder / "suite.plan") + " " VLAPROBE_SOURCE_DIR "/assets " + kTask +
                              " " + state;
  const Ended first = output_of(command);
  const std::string& whole = first.text;
  REQUIRE_MESSAGE(first.status == 0, whole);
  CHECK(whole.find("60 steps, state ") != std::string::npos);
  REQUIRE(std::filesystem::exists(state));
  const Ended second = output_of(command);
  CHECK(second.text == whole);
  CHECK(second.status == 0);

  // The same bits as in this process, which was compiled and linked otherwise.
  const std::uint32_t tasks[] = {plan.find_task(kTask).value()};
  const auto assets = stage::SharedAssets::load(plan, VLAPROBE_SOURCE_DIR "/assets", tasks);
  REQUIRE(assets.ok());
  const auto stage = stage::Stage::create(plan, tasks[0], *assets, {.pictures = false});
  REQUIRE(stage.ok());
  REQUIRE((*stage)->reset(0).ok());
  for (int step = 0; step < 60; ++step) {
    const bool down = step < 30;
    REQUIRE((*stage)
                ->step({down ? 0.005 : 0.0, 0, down ? -0.01 : 0.01, 0, 0, 0.02, down ? 1.0 : -1.0})
                .ok());
  }
  CHECK(whole.find(to_hex((*stage)->state_hash())) != std::string::npos);

  // What is wrong is said, and the program ends.
  std::ofstream(state, std::ios::app) << "more";
  const Ended refused = output_of(command);
  CHECK(refused.status != 0);
  CHECK(refused.text.find("check word") != std::string::npos);
}

}  // namespace
}  // namespace probe
