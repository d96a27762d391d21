#include <doctest/doctest.h>

#include "tests/compiler/small_suite.h"

using namespace probe;

TEST_CASE("what was painted or covered anew is not called by its old colour") {
  const auto codes = [](const std::string& object, const std::string& words = "") {
    return test::analyze_with_suite("object o like red { " + object +
                                    " }\nvariant v of red_on_tray { source o" + words + " }\n")
        ->codes();
  };
  CHECK(codes("paint blue; color blue; name \"blue toy\"") == "");
  CHECK(codes("paint blue; color blue") == "P1510");
  CHECK(codes("paint blue; color blue", "; refer source as toy") == "P0701");  // other words, too
  CHECK(codes("texture \"wood\"") == "P1510");
  CHECK(codes("texture \"wood\"; name \"wooden block\"") == "");
  CHECK(codes("texture \"wood\"; color red") == "");
}

TEST_CASE("a copy of another colour is painted") {
  const auto said = [](const std::string& object) {
    const auto analysis = test::analyze_with_suite("object o like red { " + object +
                                                   " }\nvariant v of red_on_tray { distractors o }\n");
    return analysis->said().substr(0, analysis->said().find('\n'));
  };
  CHECK(said("color blue; name \"toy\"") ==
        "warning[P1510]: `o` is said to be blue and shows the mesh of `red`, which is red");
  CHECK(said("color blue; paint blue; name \"toy\"") == "");
  CHECK(said("name \"toy\"").find("P1510") == std::string::npos);
}
