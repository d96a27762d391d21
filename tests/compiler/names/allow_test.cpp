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

TEST_CASE("above a member of variants an @allow is about that member alone") {
  const std::string two = "a { light night; distractors blue }\n";
  const auto said = [&](const std::string& lines) {
    return analyze_with_suite("variants of red_on_tray {\n" + lines + "}")->codes();
  };
  CHECK(said(two) == "P0701");
  CHECK(said("  @allow(confounded, \"why\")\n" + two) == "");
  CHECK(said("  @allow(confounded, \"why\")\n" + two +
             "b { light night; distractors pale }\n") == "P0701");
  CHECK(said("  @allow(confounded, \"why\")\nc { light night }\n") == "P0209");
}

TEST_CASE(
    "a word that nothing can be allowed by is reported on every declaration, with the nearest") {
  for (const std::string decl : {"object o like red { unseen }", "light l { ambient 0.1 }",
                                 "suite s { tasks tasks; seeds 1 }", "set s = tasks",
                                 "variant v of red_on_tray { light night }"}) {
    CAPTURE(decl);
    const auto a = analyze_with_suite("@allow(confunded, \"why\")\n" + decl);
    CHECK(a->codes().starts_with("P0208"));
    REQUIRE(a->diagnostics.items().front().fix.has_value());
    CHECK(a->diagnostics.items().front().fix->message == "write `confounded`");
  }
}
