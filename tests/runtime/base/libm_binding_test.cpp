#include "runtime/base/libm_binding.h"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdlib>
#include <string>

#include "runtime/base/trig.h"

namespace probe {

TEST_CASE(
    "loaded into somebody else's program, our libraries call our sine and the program its own") {
  const std::string tests = std::string(VLAPROBE_BINARY_DIR) + "/tests/";
  const int status =
      std::system((tests + "probe_test_host " + tests + "libprobe_test_loaded.so").c_str());
  CHECK(WEXITSTATUS(status) == 0);
}

TEST_CASE("in a program of ours the sine is ours from the start") {
  CHECK(bind_trigonometry({}).ok());
  for (int i = 0; i < 1000; ++i) {
    volatile double x = 0.3 + 0.01 * i;
    CHECK(std::sin(x) == portable_sin(x));
    CHECK(std::cos(x) == portable_cos(x));
  }
}

}  // namespace probe
