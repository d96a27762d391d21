// The Python package, by tests in Python: each file of the folder `python`, run by Debian's Python
// with the module as it was built. A PYTHONPATH of the caller's is looked at last: packages that
// Debian has not, such as gymnasium, are tried with from there.
#include <doctest/doctest.h>

#include <filesystem>
#include <string>

#include "tests/runtime/cli/program.h"

namespace probe {
namespace {

constexpr const char* kPython = "/usr/bin/python3";

void run(const std::string& file) {
#if defined(__SANITIZE_ADDRESS__)
  MESSAGE("SKIPPED: Python is not built with the address sanitizer that the module wants");
  return;
#endif
  REQUIRE_MESSAGE(std::filesystem::exists(VLAPROBE_BINARY_DIR "/python/vlaprobe/__init__.py"),
                  "python3-dev and pybind11-dev are installed, so that the module is built");
  const test::Sandbox sandbox;
  const std::string folder = VLAPROBE_SOURCE_DIR "/tests/runtime/api/python";
  const test::Outcome ran = sandbox.run(
      "env VLAPROBE_SOURCE_DIR='" VLAPROBE_SOURCE_DIR "' VLAPROBE_BINARY_DIR='" VLAPROBE_BINARY_DIR
      "' PYTHONDONTWRITEBYTECODE=1 PYTHONPATH='" VLAPROBE_BINARY_DIR "/python:" +
      folder + "':\"$PYTHONPATH\" " + kPython + " '" + folder + "/" + file + "' -v");
  for (std::size_t at = 0; (at = ran.err.find("... skipped", at)) != std::string::npos; ++at)
    MESSAGE("SKIPPED: " << ran.err.substr(at, ran.err.find('\n', at) - at));
  CHECK_MESSAGE(ran.exit == 0, ran.err);
  CHECK_MESSAGE(ran.err.find("\nOK") != std::string::npos, ran.err);
}

TEST_CASE("plans from Python") { run("plan_test.py"); }
TEST_CASE("one world from Python keeps gymnasium's rules") { run("env_test.py"); }
TEST_CASE("worlds side by side keep gymnasium's rules") { run("vec_test.py"); }
TEST_CASE("gymnasium's own checks, where it is installed") { run("gymnasium_test.py"); }
TEST_CASE("worlds as LeRobot evaluates policies in them") { run("lerobot_test.py"); }
TEST_CASE("what notebooks and terminals show") { run("notebook_test.py"); }
TEST_CASE("the wheel works in an empty environment") { run("wheel_test.py"); }
TEST_CASE("the notebooks show what is stored in them") { run("notebooks_test.py"); }
TEST_CASE("the recipes of the Python package's README run") { run("readme_test.py"); }
TEST_CASE("models are asked from Python, callables among them") { run("ask_test.py"); }
TEST_CASE("robots that are told their joints, from Python") { run("joints_test.py"); }
TEST_CASE("callables are evaluated by the program's runner") { run("evaluate_test.py"); }

}  // namespace
}  // namespace probe
