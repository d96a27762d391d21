// Samples a pixel and rays of ambient occlusion: what is good, what is not.
#include <doctest/doctest.h>

#include "tests/compiler/small_suite.h"

using namespace probe;
using test::analyze_with_suite;

namespace {

std::string codes(const std::string& more) { return analyze_with_suite(more)->codes(); }

}  // namespace

TEST_CASE("a camera takes 1, 4 or 16 samples a pixel, ambient light up to 16 rays") {
  for (const char* good : {"1", "4", "16"}) {
    CHECK(codes(std::string("camera c like eye { image 64 x 48 samples ") + good + " }\n")
              .find("P0304") == std::string::npos);
  }
  for (const char* bad : {"0", "2", "5", "64"}) {
    CHECK(codes(std::string("camera c like eye { image 64 x 48 samples ") + bad + " }\n")
              .find("P0304") != std::string::npos);
  }
  // Traced with all samples a side has at most 8192 pixels.
  CHECK(codes("camera c like eye { image 2048 x 1536 samples 16 }\n").find("P0304") ==
        std::string::npos);
  CHECK(codes("camera c like eye { image 2049 x 1536 samples 16 }\n").find("P0304") !=
        std::string::npos);
  for (const char* bad : {"0", "17"}) {
    CHECK(codes(std::string("light l { ambient 0.3 occlusion ") + bad + " }\n").find("P0304") !=
          std::string::npos);
  }
  CHECK(codes("light l { ambient 0.3 occlusion 8 }\n").find("P0304") == std::string::npos);
  CHECK(codes("light l { ambient 0.3 occlusion }\n").find("P0101") != std::string::npos);
}

TEST_CASE("noise and blur that nobody sees are refused with the least that is seen") {
  const auto said = [](const std::string& sensor) {
    const auto a = analyze_with_suite("camera c like eye { sensor " + sensor + " }\n");
    return a->codes().find("P0304") == std::string::npos ? "" : a->diagnostics.items()[0].message;
  };
  CHECK(said("noise 0.003") ==
        "a noise of less than 1/255, which is 0.00392, is less than one level of a picture");
  CHECK(said("noise 0.004") == "");
  CHECK(said("noise 0") == "");
  CHECK(said("blur 0.009px") == "a blur of less than 0.01px moves no light to another pixel");
  CHECK(said("blur 0.01px") == "");
}
