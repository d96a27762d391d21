#include <doctest/doctest.h>

#include "tests/compiler/small_suite.h"

using namespace probe;
using test::analyze_with_suite;

TEST_CASE("an @allow silences warnings about its declaration, and a word when there are none") {
  const char* night = "variant v of red_on_tray { light night }";
  CHECK(analyze_with_suite(std::string("@allow(confounded, \"why\")\n") + night)->codes() ==
        "P0209");
  CHECK(analyze_with_suite("@allow(shared_name, \"why\")\nobject blue_two like blue { }\n"
                           "variant v of red_on_tray { distractors blue_two }")
            ->codes() == "P0209");
}
