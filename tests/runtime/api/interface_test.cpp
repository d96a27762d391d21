// The C interface as a program in C sees it (host.c), against the same worlds in this process.
#include <dlfcn.h>
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>

#include "runtime/base/trig.h"
#include "runtime/stage/stage.h"
#include "tests/parity/published.h"
#include "tests/runtime/cli/program.h"

namespace probe {
namespace {

constexpr const char* kTask = "carrot_on_plate";

std::uint64_t hash(std::uint64_t before, std::span<const std::byte> bytes) {
  for (const std::byte byte : bytes)
    before = (before ^ static_cast<std::uint64_t>(byte)) * 1099511628211u;
  return before;
}
constexpr std::uint64_t kEmptyHash = 14695981039346656037u;

std::string line_of_sine(double (*sine)(double)) {
  std::uint64_t all = kEmptyHash;
  for (int i = 0; i < 4000; ++i) {
    const double y = sine(0.3 + 0.001 * i);
    all = hash(all, std::as_bytes(std::span(&y, 1)));
  }
  return fmt::format("sine {:016x}\n", all);
}

policy::Action act(int step) {
  const bool down = step < 30;
  return {down ? 0.005 : 0.0, 0, down ? -0.01 : 0.01, 0, 0, 0.02, down ? 1.0 : -1.0};
}

TEST_CASE("a program in C steps the same worlds bit for bit and keeps its own sine") {
  const test::Sandbox sandbox;
  const plan::Plan& plan = test::suite_plan();
  const auto bytes = plan.bytes();
  test::write_file(sandbox / "suite.plan",
                   {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  const test::Outcome host =
      sandbox.run(std::string("'" VLAPROBE_BINARY_DIR "/tests/api_host' suite.plan $ASSETS ") +
                  kTask + " '" VLAPROBE_SOURCE_DIR "/tests/golden/P0402_ambiguous.probe' .");
  REQUIRE_MESSAGE(host.exit == 0, host.err);
  CHECK(host.err.empty());  // the library prints nothing

  // The C library's, which this program's own sine stands before.
  void* libm = ::dlopen("libm.so.6", RTLD_NOW | RTLD_LOCAL);
  REQUIRE(libm != nullptr);
  const std::string sine = line_of_sine(reinterpret_cast<double (*)(double)>(::dlsym(libm, "sin")));
  CHECK(sine != line_of_sine(&portable_sin));
  CHECK(host.out.starts_with(sine));
  CHECK(host.out.ends_with(sine));

  const std::uint32_t tasks[] = {plan.find_task(kTask).value()};
  const auto assets = stage::SharedAssets::load(plan, VLAPROBE_SOURCE_DIR "/assets", tasks);
  REQUIRE(assets.ok());
  const auto stage = stage::Stage::create(plan, tasks[0], *assets, {.image = {160, 120}});
  REQUIRE(stage.ok());
  REQUIRE((*stage)->reset(0).ok());
  std::uint64_t pictures = kEmptyHash;
  for (int step = 0; step < 60; ++step) {
    const auto seen = (*stage)->observe();
    REQUIRE(seen.ok());
    pictures = hash(pictures, std::as_bytes(seen->image.rgb));
    REQUIRE((*stage)->step(act(step)).ok());
  }
  std::string verdicts;
  const vm::Judge& judge = (*stage)->judge();
  for (std::uint32_t m = 0; m < judge.metric_count(); ++m)
    verdicts += fmt::format("{} {:g}, ", judge.metric_name(m), judge.value(m));
  const std::string state = to_hex((*stage)->state_hash());
  CHECK(host.out.find(fmt::format("pictures {:016x}\n", pictures)) != std::string::npos);
  CHECK(host.out.find(fmt::format("{}60 steps, state {}\n", verdicts, state)) != std::string::npos);
  // Once with each autoreset that leaves the last step to be looked at.
  const std::string batch = fmt::format("batch {:016x} state {}\n", pictures, state);
  CHECK(host.out.find(batch + batch) != std::string::npos);
}

TEST_CASE("the library exports the functions of its header and nothing else") {
  const test::Sandbox sandbox;
  const test::Outcome names = sandbox.run(
      "( nm -D --defined-only '" VLAPROBE_BINARY_DIR
      "/libvlaprobe.so' | awk '{print $3}' | sed 's/@.*//' | grep -v '^VLAPROBE_1$' | sort -u )");
  REQUIRE(names.exit == 0);
  const test::Outcome declared = sandbox.run(
      "( sed -n 's/^VLAPROBE_EXPORT.*[ *]\\(vlaprobe_[a-z_]*\\)(.*/\\1/p' '" VLAPROBE_SOURCE_DIR
      "/runtime/api/vlaprobe.h' | sort -u )");
  CHECK(names.out == declared.out);
  CHECK(declared.out.find("vlaprobe_stage_step\n") != std::string::npos);
}

TEST_CASE("every function that takes a pointer is called with NULL for it") {
  const test::Sandbox sandbox;
  const test::Outcome untried = sandbox.run(
      "( for f in $(sed -n 's/^VLAPROBE_EXPORT.*[ *]\\(vlaprobe_[a-z_]*\\)(.*/\\1/p' "
      "'" VLAPROBE_SOURCE_DIR "/runtime/api/vlaprobe.h'); do grep -q \"$f(\" '" VLAPROBE_SOURCE_DIR
      "/tests/runtime/api/nulls.c' || echo $f; done )");
  REQUIRE(untried.exit == 0);
  CHECK(untried.out == "vlaprobe_api_version\nvlaprobe_version\nvlaprobe_code_word\n");
}

}  // namespace
}  // namespace probe
