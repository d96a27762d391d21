// What starts with the program: `vlaprobe check` runs at every save of an editor and must not wait
// for a simulator's libraries.
#include <doctest/doctest.h>

#include <array>
#include <cstdio>

#include "tests/runtime/cli/program.h"

namespace probe::test {
namespace {

// The shared libraries that the dynamic linker would load, one a line.
std::string libraries_of(const std::string& program) {
  const std::string command = "LD_TRACE_LOADED_OBJECTS=1 '" VLAPROBE_BINARY_DIR "/" + program + "'";
  std::FILE* pipe = popen(command.c_str(), "r");
  REQUIRE(pipe != nullptr);
  std::string text;
  std::array<char, 4096> block;
  while (const std::size_t n = std::fread(block.data(), 1, block.size(), pipe)) {
    text.append(block.data(), n);
  }
  CHECK(pclose(pipe) == 0);
  return text;
}

TEST_CASE("the program that checks texts links no simulator, renderer, video, HDF5 or database") {
  const std::string libraries = libraries_of("vlaprobe");
  CHECK(contains(libraries, "libstdc++"));
  for (const char* library : {"libSimTK", "libembree", "libav", "libswscale", "libhdf5",
                              "libsqlite", "libzmq", "libgrpc", "libcholmod"}) {
    CAPTURE(library);
    CHECK(!contains(libraries, library));
    CHECK((contains(libraries_of("vlaprobe-full"), library) ||
           std::string(library) == "libSimTK"));  // may be linked statically
  }
}

TEST_CASE("a verb that needs the simulator is handed over with its arguments and its exit code") {
  const Sandbox here;
  const Outcome results = here.vlaprobe("results 'no such folder'");
  CHECK(results.exit == 2);
  CHECK(contains(results.err, "no such folder"));
  const Outcome phrases = here.vlaprobe("draw \"$SUITE\" carrot_on_plate --phrases");
  CHECK(phrases.exit == 1);
  CHECK(contains(phrases.err, "--phrases needs -o X.png"));
  const Outcome unknown = here.vlaprobe("chekc");
  CHECK(unknown.exit == 1);
  CHECK(contains(unknown.err, "did you mean `check`?"));
}

}  // namespace
}  // namespace probe::test
