// Values that a shell leaves empty: they are refused and mean no default.
#include <doctest/doctest.h>

#include "tests/runtime/cli/program.h"

namespace probe::test {
namespace {

TEST_CASE("an empty value of an option or argument is refused by name and makes no folder") {
  const Sandbox here;
  for (const char* name : {"--episodes", "--seeds", "--suite", "--tasks", "--shard"}) {
    CAPTURE(name);
    const Outcome run =
        here.vlaprobe(std::string("run \"$SUITE\" --policy null -o out ") + name + " ''");
    CHECK(run.exit == 1);
    CHECK(run.err.find(std::string(name) + ": is empty") != std::string::npos);
  }
  CHECK(here.vlaprobe("run '' --policy null -o out").err.find("F: is empty") != std::string::npos);
  CHECK(here.vlaprobe("run \"$SUITE\" --policy null -o ''").exit == 1);
  CHECK(here.vlaprobe("results ''").err.find("DIR: is empty") != std::string::npos);
  CHECK_FALSE(std::filesystem::exists(here / "out"));
}

}  // namespace
}  // namespace probe::test
