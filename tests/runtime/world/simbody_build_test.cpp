// The multibody library and the file that includes it are compiled alike, whichever build is
// linked.
#include <doctest/doctest.h>

#include <cstdio>
#include <string>

#include "runtime/world/multibody.h"

namespace probe::world {
namespace {

TEST_CASE("the linked Simbody and its adapter agree about NDEBUG") {
  const MultibodyBuild build = multibody_build();
  MESSAGE("Simbody ", build.version,
          std::string(build.library_asserts ? ", as Debian builds it" : ", NDEBUG"));
  CHECK(build.version.starts_with("3.7"));
  CHECK(check_layout(build).ok());
}

TEST_CASE("a Simbody of the other layout is refused with both sides named") {
  for (const bool library : {false, true}) {
    const Status status = check_layout({"3.7", library, !library});
    REQUIRE(!status.ok());
    CHECK(status.failure().code == Fault::kWorld);
    CHECK(status.failure().message ==
          std::string("the linked Simbody 3.7 is built ") + (library ? "without" : "with") +
              " NDEBUG, but vlaprobe was compiled for one " + (library ? "with" : "without") +
              " NDEBUG: their data do not fit");
  }
}

// What the preprocessor says of the adapter; the guard stands above all it includes.
std::string preprocess(const std::string& definitions) {
  const std::string command = "c++ -std=c++17 -E " + definitions +
                              " '" VLAPROBE_SOURCE_DIR
                              "/runtime/world/multibody.cpp' 2>&1 >/dev/null";
  FILE* pipe = popen(command.c_str(), "r");
  REQUIRE(pipe != nullptr);
  std::string text;
  char line[512];
  while (std::fgets(line, sizeof line, pipe) != nullptr) text += line;
  pclose(pipe);
  return text;
}

TEST_CASE("the adapter does not compile with the other layout") {
  CHECK(preprocess("-DNDEBUG").find("#error \"NDEBUG: this Simbody") != std::string::npos);
  CHECK(preprocess("-DPROBE_SIMBODY_NDEBUG").find("#error \"no NDEBUG: this Simbody") !=
        std::string::npos);
  CHECK(preprocess("").find("#error") == std::string::npos);
  CHECK(preprocess("-DNDEBUG -DPROBE_SIMBODY_NDEBUG").find("#error") == std::string::npos);
}

}  // namespace
}  // namespace probe::world
