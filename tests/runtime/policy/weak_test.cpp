// A policy whose weak spot is known: what tests of searches go by.
#include "runtime/policy/weak.h"

#include <doctest/doctest.h>

namespace probe::policy {
namespace {

double chance(std::string_view spot, const Surroundings& there) {
  const auto read = read_weak_spot(spot);
  REQUIRE_MESSAGE(read.ok(), to_text(read.failure()));
  return chance_of(*read, there);
}

TEST_CASE("a weak spot is met below or from a number on, and where all of its terms are") {
  CHECK(chance("ambient<0.12", {.ambient = 0.11}) == 1);
  CHECK(chance("ambient<0.12", {.ambient = 0.12}) == 0);
  CHECK(chance("camera>=3cm", {.camera_moved = 0.03}) == 1);
  CHECK(chance("camera>=0.03m", {.camera_moved = 0.029}) == 0);
  CHECK(chance("power<0.5", {.power = 0.4}) == 1);
  CHECK(chance("clutter>=2+reworded", {.clutter = 2, .reworded = true}) == 1);
  CHECK(chance("clutter>=2+reworded", {.clutter = 1, .reworded = true}) == 0);
  CHECK(chance("clutter>=2+reworded", {.clutter = 5}) == 0);
}

TEST_CASE("a soft edge is met in half of the episodes at its number, and more seldom inside") {
  CHECK(chance("ambient<0.12~0.02", {.ambient = 0.12}) == doctest::Approx(0.5));
  CHECK(chance("ambient<0.12~0.02", {.ambient = 0.14}) == doctest::Approx(0.2689414));
  CHECK(chance("clutter>=2~0.5", {.clutter = 3}) == doctest::Approx(0.8807970));
}

TEST_CASE("what is no weak spot is refused with how one is written") {
  for (const char* text :
       {"", "dark", "ambient", "ambient<", "ambient<x", "ambient<0.1cm", "reworded>=1",
        "clutter>=2+", "ambient<0.1~", "camera>=-1cm", "power<nan"}) {
    CAPTURE(text);
    const auto read = read_weak_spot(text);
    REQUIRE_FALSE(read.ok());
    CHECK(read.failure().message.find("ambient<0.12") != std::string::npos);
    CHECK(read.failure().where == "--policy");
  }
}

}  // namespace
}  // namespace probe::policy
