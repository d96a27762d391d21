#include "runtime/search/shown_value.h"

#include <doctest/doctest.h>

using namespace probe::search;

TEST_CASE("a stored value is written as a space writes it: units, factors, counts") {
  CHECK(shown_text("light.ambient", "", 0.12110871) == "0.121");
  CHECK(shown_text("light.power", "", 0.2) == "x 0.2");
  CHECK(shown_text("camera.third_view.x", "cm", -2.5) == "-2.5cm");
  CHECK(shown_text("clutter", "", 2.0) == "2");
  CHECK(shown_text("delay", "steps", 3.0) == "3 steps");
  CHECK(shown_text("light.ambient", "", -0.0) == "0");
}

TEST_CASE("how far along a side a value is follows its steps, equal ones or equal factors") {
  CHECK(share_of_side("light.ambient", 0.3, 0.1, 0.2) == doctest::Approx(0.5));
  CHECK(share_of_side("light.power", 1, 0.25, 0.5) == doctest::Approx(0.5));
  CHECK(share_of_side("light.power", 1, 4, 2) == doctest::Approx(0.5));
  CHECK(share_of_side("clutter", 0, 4, 3) == doctest::Approx(0.75));
}

TEST_CASE("values beyond a side, and sides of no length, stay on the track") {
  CHECK(share_of_side("light.ambient", 0.3, 0.1, 0.0) == 1);
  CHECK(share_of_side("light.ambient", 0.3, 0.1, 0.5) == 0);
  CHECK(share_of_side("light.ambient", 0.3, 0.3, 0.5) == 0);
  // Of a factor that is none, as in a file that was tampered with.
  CHECK(share_of_side("light.power", 1, 0.2, -1) == 1);
}
