// Success that is true before anything has moved.
#include <doctest/doctest.h>

#include "tests/compiler/small_suite.h"

using namespace probe;

namespace {

std::string begun_of(const std::string& success, const std::string& more = "") {
  const std::string said =
      test::analyze_with_suite(std::string(test::kChest) +
                               "predicate on_ground(o: object) = any x in bodies - objects - "
                               "links: impulse(o, x) > 1e-6Ns\n"
                               "metrics m { success = at end " +
                               success + " }\n" +
                               "task t like red_on_tray { metrics m; say \"use {the source} and "
                               "{the target}\" " +
                               more + " }\n")
          ->said();
  return said.substr(0, said.find('\n'));
}

const char* const kSome = "warning[P0607]: `success` of `t` is true before anything moves in ";

}  // namespace

TEST_CASE("success that holds in some starts before anything moves is told, with the starts") {
  // 2 x 2 cells, source before target: 12 placements at 2 turns, 8 of them one before the other
  // along x.
  CHECK(begun_of("x(source) < x(target) - 1cm") ==
        std::string(kSome) + "8 of 24 starts: 2, 3, 4, 5, 8, 9, 10, 11");
  CHECK(begun_of("(x(source) < x(target) - 1cm and on_ground(source) and moved_xy(target) < "
                 "1cm)")
            .find(kSome) == 0);
  CHECK(begun_of("x(source) < x(target) - 1cm for 5 steps").find(kSome) == 0);
  CHECK(begun_of("(x(source) < x(target) - 1cm and moved_xy(source) > 3cm)") == "");
  CHECK(begun_of("(x(source) < x(target) - 1cm and impulse(source, target) > 1e-6Ns)") == "");
  CHECK(begun_of("(x(source) < x(target) - 1cm and any f in fingers: impulse(f, source) > "
                 "1e-6Ns)") == "");
}

TEST_CASE("what cannot be told before things settle says nothing, nor does what holds always") {
  CHECK(begun_of("height(source) > height(target)") == "");
  CHECK(begun_of("x(tcp) > x(target)") == "");
  CHECK(begun_of("x(source) < x(target) - 9.9cm") != "");
  CHECK(begun_of("x(source) < x(target) - 20cm") == "");
  // Exactly as far apart as the cells: what settles may be on either side.
  CHECK(begun_of("x(source) < x(target) - 20.05cm") == "");
}

TEST_CASE("a joint that begins where it shall be counts as well") {
  CHECK(begun_of("(travel(chest.slide) > 10cm and x(source) < x(target))", "; scene room") == "");
  CHECK(begun_of("(travel(chest.slide) > 3cm and x(source) < x(target))", "; scene room")
            .find(kSome) == 0);
}

TEST_CASE("where places are not known joints are, and what they decide alone is told") {
  const std::string joints = "travel(chest.slide) > 3cm";
  for (const char* more :
       {"; scene room; layout placed", "; scene room; moves source along (2cm, 0cm) at 5cm/s"}) {
    CAPTURE(more);
    const auto of = [&](const std::string& success) {
      return test::analyze_with_suite(
                 std::string(test::kChest) +
                 "layout placed { place source at (-10cm, -10cm); place target at (-10cm, 10cm)\n"
                 "orient by rest; drop none }\nmetrics m { success = at end " +
                 success +
                 " }\ntask t like red_on_tray { metrics m; say \"use {the source} and {the "
                 "target}\" " +
                 more + " }\n")
          ->said();
    };
    CHECK_MESSAGE(of(joints).find(kSome) == 0, of(joints));
    CHECK(of("travel(chest.slide) > 10cm").find(kSome) == std::string::npos);
    CHECK(of("(x(source) < x(target) + 1m)").find(kSome) == std::string::npos);
  }
}

TEST_CASE("what ends an episode and is so before anything moves is told, unless it is success") {
  const auto said = [](const std::string& success, const std::string& ends) {
    return test::analyze_with_suite(std::string(test::kChest) + "metrics m { success = at end " +
                                    success + "; ends when " + ends +
                                    " }\ntask t like red_on_tray { metrics m; scene room; say "
                                    "\"use {the source} and {the target}\" }\n")
        ->said();
  };
  const std::string begun = "travel(chest.slide) > 3cm", later = "travel(chest.slide) > 10cm";
  CHECK(said(later, begun).find("`ends when` of `t` is true before anything moves in all of its") !=
        std::string::npos);
  CHECK(said(begun, begun).find("`ends when` of `t` is true") == std::string::npos);
  CHECK(said(begun, begun).find(kSome) == 0);
  CHECK(said(later, later).find("before anything moves") == std::string::npos);
}

TEST_CASE("success that holds in all starts is told as well, but for what has to hold throughout") {
  CHECK(begun_of("moved_xy(source) < 1cm") == std::string(kSome) + "all of its 24 starts");
  CHECK(begun_of("(x(source) < x(target) + 90cm and moved_xy(source) <= 1cm)") ==
        std::string(kSome) + "all of its 24 starts");
  const auto throughout = test::analyze_with_suite(
      "metrics m { success = always moved_xy(target) < 1cm }\n"
      "task t like red_on_tray { metrics m; say \"use {the source} and {the target}\" }\n");
  CHECK_MESSAGE(throughout->codes() == "", throughout->said());
  const auto alone = test::analyze_with_suite(
      "metrics m { success = at end moved_xy(source) < 1cm }\n"
      "layout one { place source at (0cm, -20cm); place target at (0cm, 0cm); orient by rest\n"
      "drop 10cm settle 0.5s }\n"
      "task t like red_on_tray { layout one; metrics m; say \"use {the source} and {the target}\" }\n");
  CHECK_MESSAGE(alone->said().find("before anything moves in ") != std::string::npos, alone->said());
}

TEST_CASE("what is asked whether it was ever so, and is so in every start, is told") {
  const auto said = [](const std::string& more) {
    return test::analyze_with_suite(std::string(test::kChest) +
                                    "metrics m { success = at end moved_xy(source) > 5cm; seen = once "
                                    "travel(chest.slide) > 3cm }\n"
                                    "task t like red_on_tray { metrics m; scene room; say \"move {the "
                                    "source}\"" + more + " }\n")
        ->said();
  };
  CHECK_MESSAGE(said("").find("`seen` of `t` is true before anything moves in all of its 24 starts") !=
                    std::string::npos,
                said(""));
  CHECK(said("; start chest.slide 0cm").find("`seen`") == std::string::npos);
}
