// Starts in and on other things. Each case begins with the productions it holds.
#include <doctest/doctest.h>

#include "tests/dsl/built.h"

using namespace probe;
using namespace probe::test;

namespace {

// The chest's drawer slides along y from (0cm, 30cm, 85cm); its collision is a box of 10 cm around
// its link, the region stands above it.
const std::string kPut = R"(
fixture chest {
  urdf "chest/chest.urdf"; at (0cm, 30cm, 85cm) yaw 90deg
  part drawer link drawer name "drawer"
  region above of drawer box (-4cm, -3cm, 3cm) .. (4cm, 3cm, 15cm)
}
scene room like bench { fixture chest }
layout low {
  cells spots = grid 2 x 1 at (0cm, -10cm) spread (10cm, 0cm)
  place target in distinct spots
  orient by rest; drop 10cm settle 0.5s
}
)";

std::string height_text(const sema::Start::Placed& placed) {
  return placed.z ? number_text(100 * *placed.z) : "falls";
}

}  // namespace

TEST_CASE("layout_st, thing: what is put on an object stands on it, in every one of its places") {
  const auto a = clean(kPut +
                       "layout onto like low { place source on target }\n"
                       "task t like red_on_tray { layout onto }\n");
  // Two cells at two turns, as without the source.
  CHECK(starts_text(*a, "t") ==
        std::vector<std::string>{"red -10,-10@0 tray -10,-10@0", "red -10,-10@90 tray -10,-10@0",
                                 "red 10,-10@0 tray 10,-10@0", "red 10,-10@90 tray 10,-10@0"});
  const auto& placed = a->task("t").starts[0].placed;
  // The tray is 1 cm high and stands 1 mm above 80 cm, the block of 2 cm 1 mm above that.
  CHECK(height_text(placed[1]) == "80.6");
  CHECK(height_text(placed[0]) == "82.2");
}

TEST_CASE(
    "layout_st, thing: a region of a part goes where its joint begins, and its floor counts") {
  const auto a = clean(kPut +
                       "layout stored like low { place source in chest.above }\n"
                       "task t like red_on_tray { scene room; layout stored }\n"
                       "variant ajar of t { start chest.slide 10cm }\n");
  // The region begins 2 cm below the drawer's top, at 90 cm.
  CHECK(starts_text(*a, "t")[0] == "red 0,30@0 tray -10,-10@0");
  CHECK(height_text(a->task("t").starts[0].placed[0]) == "91.1");
  CHECK(height_text(a->task("t").starts[0].placed[1]) == "falls");
  CHECK(starts_text(*a, "ajar")[0] == "red 0,40@0 tray -10,-10@0");
  CHECK(axes_text(*a, "ajar") == "fixture");
}

TEST_CASE(
    "layout_st, thing: several of one line share its longer side; jitter moves what carries") {
  const auto a = clean(kPut +
                       "layout both like low { place source, distractors in chest.above }\n"
                       "layout shaken like low { place source on target; jitter 1cm }\n"
                       "task t like red_on_tray { scene room; layout both; distractors pale }\n"
                       "task u like red_on_tray { layout shaken }\n");
  // The region's 8 cm lie along y; the block's 4 cm stand across.
  CHECK(starts_text(*a, "t")[0] == "red 0,28@0 tray -10,-10@0 pale 0,32@0");
  for (const sema::Start& start : a->task("u").starts) {
    CHECK(start.placed[0].x == doctest::Approx(start.placed[1].x));
    CHECK(start.placed[0].y == doctest::Approx(start.placed[1].y));
    CHECK(start.placed[1].y != -0.1);
  }
}

TEST_CASE("layout_st: what cannot stand where it is put, and what it stands on") {
  const auto said = [&](const std::string& more) {
    return analyze_with_suite(kPut + more)->codes();
  };
  CHECK(said("object wide like red { box 9cm x 7cm x 2cm; name \"wide block\" }\n"
             "layout stored like low { place source in chest.above }\n"
             "task t like red_on_tray { source wide; scene room; layout stored }\n") == "P1504");
  CHECK(said("layout stored like low { place source on chest.drawer }\n"
             "task t like red_on_tray { scene room; layout stored }\n") == "P1504");
  CHECK(said("layout stored like low { place source in chest.above }\n"
             "task t like red_on_tray { layout stored }\n") == "P1504");
  CHECK(said("layout circle { place source on target; place target on source\n"
             "  drop 10cm settle 0.5s }\n"
             "task t like red_on_tray { layout circle }\n") == "P1504");
  CHECK(said("layout stored like low { place source on shelf }\n") == "P0201");
}

TEST_CASE("layout_st: what is put has a claim to lie there when all is at rest") {
  const Built built(kPut +
                    "layout stored like low { place source in chest.above }\n"
                    "layout onto like low { place source on target }\n"
                    "task t like red_on_tray { scene room; layout stored }\n"
                    "task u like red_on_tray { scene room; layout onto }\n");
  const auto& claims = built.plan().tables().claims;
  REQUIRE(claims.size() == 2);
  CHECK(built.plan().text(claims[0].text) == "red in chest.above");
  CHECK(built.plan().text(claims[1].text) == "red on tray");
  CHECK(claims[0].body == 0);
}
