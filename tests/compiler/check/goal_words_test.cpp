// Words of instructions, held to what success is.
#include <doctest/doctest.h>

#include "tests/compiler/small_suite.h"

using namespace probe;

namespace {

// Two things that are put on the tray, in an order that `goal` may judge, and the words for it.
std::string said_of_two(const std::string& goal, const std::string& words,
                        const std::string& more = "") {
  return test::analyze_with_suite(
             "role helper\n"
             "predicate over(a: object, b: object) = height(a) > height(b) and distance_xy(a, b) < "
             "5cm\n"
             "predicate done(a: object) = over(a, target)\n" +
             more +
             "layout row { place source at (0cm, -20cm); place target at (0cm, 0cm)\n"
             "place helper at (0cm, 20cm); orient by rest; drop 10cm settle 0.5s }\n"
             "metrics m { success = " +
             goal +
             " }\n"
             "task t like base { layout row; source red; helper blue; target tray; metrics m; say "
             "\"" +
             words + "\" }\n")
      ->said();
}

// That success holds at once (P0607) is no matter here.
std::string first_line(const std::string& text) {
  const std::string line = text.substr(0, text.find('\n'));
  return line.starts_with("warning[P0607]") ? "" : line;
}

}  // namespace

TEST_CASE("words for a joint go the way that success goes") {
  const auto told = [](const std::string& words) {
    return test::analyze_with_suite(std::string(test::kChest) +
                                    "metrics far { success = at end travel(chest.slide) > 10cm }\n"
                                    "task t like red_on_tray { scene room; metrics far; say \"" +
                                    words + " with {the source}, before {the target}\" }\n")
        ->codes();
  };
  CHECK(told("open the drawer") == "");
  CHECK(told("close the drawer") == "P1202");
  CHECK(told("close the door and open the drawer") == "");
  CHECK(told("turn on the stove") == "");
  CHECK(told("turn off the stove") == "P1202");
  CHECK(told("switch off the stove") == "P1202");
  CHECK(told("carefully close the drawer") == "P1202");
  // How a thing is, no order to do so.
  CHECK(told("pull out the shut drawer") == "");
  CHECK(told("pull out the drawer, close to the robot") == "");
  CHECK(told("pull out the drawer that was left closed") == "");
}

TEST_CASE("a name of several objects says which of them") {
  const auto told = [](const std::string& words) {
    return test::analyze_with_suite(
               "object second like blue { name \"red block\" }\n"
               "task t like red_on_tray { distractors second; say \"" +
               words + "\" }\n")
        ->said();
  };
  const std::string open = "error[P0402]: \"the red block\" denotes 2 objects in `t`";
  CHECK(told("put the red block on {the target}, {the source}").find(open) != std::string::npos);
  CHECK(told("put a red block on {the target}, {the source}").find("P0402") == std::string::npos);
  CHECK(told("put the red block with the dot on {the target}, {the source}").find("P0402") ==
        std::string::npos);
}

TEST_CASE("a noun at the end of several names says which of them") {
  const auto told = [](const std::string& words) {
    return first_line(
        test::analyze_with_suite("object coke like blue { name \"coke can\" }\n"
                                 "object pepsi like blue { name \"pepsi can\" }\n"
                                 "task t like red_on_tray { distractors coke, pepsi; say \"" +
                                 words + "\" }\n")
            ->said());
  };
  const std::string open = "error[P0402]: \"the can\" denotes 2 objects in `t`";
  CHECK(told("put the can on {the target}, {the source}") == open);
  CHECK(told("take the can. Put it on {the target}, {the source}") == open);
  CHECK(told("{the source}, {the target} and the can") == open);
  CHECK(told("put the coke can on {the target}, {the source}") == "");
  // The one that was named before; another thing; one of them; all of them; P1203's.
  CHECK(told("take the coke can and put the can on {the target}, {the source}") == "");
  CHECK(told("put the can opener on {the target}, {the source}") == "");
  CHECK(told("put a can on {the target}, {the source}") == "");
  CHECK(told("put the cans on {the target}, {the source}") == "");
  CHECK(told("take the can on the left to {the target}, {the source}") != open);
}

TEST_CASE("words for a part are those of one that success measures") {
  const auto said_of = [](const std::string& words) {
    return test::analyze_with_suite(
               std::string(test::kChest) +
               "metrics far { success = at end travel(chest.slide) > 10cm }\n"
               "task t like red_on_tray { scene room; metrics far; say \"open " +
               words + " with {the source}, before {the target}\" }\n")
        ->codes();
  };
  CHECK(said_of("the drawer") == "");
  CHECK(said_of("{the chest.drawer}") == "");
  CHECK(said_of("{the chest.door}") == "P1202");
  CHECK(said_of("the door") == "P1202");
  CHECK(said_of("what opens") == "");
  CHECK(said_of("the drawer beside the door") == "");
}

TEST_CASE("words that put two things in an order say the one that success judges") {
  const std::string wrong =
      "error[P1202]: `t` says \"then\" and succeeds when `red` comes before `blue`";
  const std::string forward = "put {the source} on {the target}, then put {the helper} there",
                    backward =
                        "first put {the helper} on {the target}, then put {the source} there";
  for (const std::string goal :
       {"at end (done(helper) and done(source) and once (done(source) and not once done(helper)))",
        "at end (done(source) and done(helper) and once (done(source) and not done(helper)))"}) {
    CAPTURE(goal);
    CHECK(said_of_two(goal, forward) == "");
    CHECK(first_line(said_of_two(goal, backward)) == wrong);
  }
  // What lay there all along never was otherwise, which counts as now.
  CHECK(first_line(said_of_two("at end (done(source) and done(helper) and latest(step, not "
                               "done(source)) < latest(step, not done(helper)))",
                               forward))
            .find("error[P1202]") == 0);
  const std::string judged =
      "at end (done(helper) and once (done(source) and not once done(helper)))";
  CHECK(said_of_two(judged, "put {the source} on {the target} before you put {the helper} there") ==
        "");
  CHECK(said_of_two(judged, "put {the helper} on {the target} after {the source}") == "");
  CHECK(said_of_two(judged,
                    "before you put {the helper} on {the target}, put {the source} there") == "");
  CHECK(first_line(said_of_two(
            judged, "put {the helper} on {the target} before you put {the source} there")) ==
        "error[P1202]: `t` says \"before\" and succeeds when `red` comes before `blue`");
  CHECK(first_line(said_of_two(judged, "put the red block on {the target} after {the helper}")) ==
        "error[P1202]: `t` says \"after\" and succeeds when `red` comes before `blue`");
  CHECK(first_line(said_of_two("at end (done(helper) and once leads(source, helper))", backward,
                               "predicate leads(a: object, b: object) = done(a) and not once "
                               "done(b)\n")) == wrong);
  CHECK(said_of_two(judged, "put {the helper} and {the source} on {the target}") == "");
}

TEST_CASE("what looks back says the order of what was said") {
  const std::string judged =
      "at end (done(source) and done(helper) and once (done(source) and not once done(helper)))";
  for (const std::string words :
       {"put {the source} on {the target}. After that put {the helper} there",
        "put {the source} on {the target}, and after it {the helper}",
        "put {the helper} on {the target}, and before it {the source}",
        "put {the helper} on {the target}, but not before {the source} is there"}) {
    CAPTURE(words);
    CHECK(said_of_two(judged, words) == "");
  }
  CHECK(first_line(said_of_two(judged,
                               "put {the helper} there. After that put {the source} on "
                               "{the target}")) ==
        "error[P1202]: `t` says \"after\" and succeeds when `red` comes before `blue`");
}

TEST_CASE("words that put two things in an order want one") {
  const std::string words = "first put {the source} on {the target}, then put {the helper} there";
  const std::string none =
      "error[P1202]: `t` says \"then\" and its success wants no order of `red` and `blue`";
  // Whoever puts the second first and leaves it there has both of these as well.
  for (const std::string goal :
       {"at end (done(source) and done(helper))", "once (done(helper) and once done(source))",
        "at end (done(helper) and done(source) and once (done(helper) and once done(source)))"}) {
    CAPTURE(goal);
    CHECK(first_line(said_of_two(goal, words)) == none);
  }
  CHECK(first_line(said_of_two("once (done(source) and not done(helper))", words)) ==
        "error[P1202]: `t` says \"then\" and succeeds without `blue`");
  // One thing that is done in two steps, and a word that stands before both.
  CHECK(said_of_two("at end done(source)",
                    "pick up {the source}, then drop it on {the target} beside {the helper}") ==
        "");
  CHECK(said_of_two("at end (done(source) and done(helper))",
                    "then put {the source} and {the helper} on {the target}") == "");
}

TEST_CASE(
    "words that put two things in an order are many, and a goal may say it the other way round") {
  const std::string judged =
      "at end (done(source) and done(helper) and once (done(source) and not once done(helper)))";
  const std::string never =
      "at end (done(source) and done(helper) and not once (done(helper) and not once "
      "done(source)))";
  for (const std::string& goal : {judged, never}) {
    CAPTURE(goal);
    CHECK(said_of_two(goal, "put {the source} on {the target}, then put {the helper} there") == "");
    CHECK(said_of_two(goal, "put {the source} on {the target}, followed by {the helper}") == "");
    CHECK(first_line(
              said_of_two(goal, "put {the helper} on {the target}, followed by {the source}")) ==
          "error[P1202]: `t` says \"followed by\" and succeeds when `red` comes before `blue`");
    CHECK(first_line(
              said_of_two(goal, "put {the helper} on {the target} and finally {the source}")) ==
          "error[P1202]: `t` says \"finally\" and succeeds when `red` comes before `blue`");
  }
}

TEST_CASE("both of two is neither of them nor one of them") {
  const std::string words = "put both {the source} and {the helper} on {the target}";
  CHECK(said_of_two("at end (done(source) and done(helper))", words) == "");
  CHECK(first_line(said_of_two("at end (done(source) or done(helper))", words)) ==
        "error[P1202]: `t` says \"both\" and succeeds with one of 2 (`or`, not `and`)");
  CHECK(first_line(said_of_two("at end done(source)", words)) ==
        "error[P1202]: `t` says \"both\" and succeeds without `blue`");
  CHECK(said_of_two("at end (done(source) or done(helper))",
                    "put {the source} or {the helper} on {the target}") == "");
}

TEST_CASE("words for each of several things are not judged by one of them") {
  const auto told = [](const std::string& goal, const std::string& words) {
    return first_line(test::analyze_with_suite(
                          "role goods: set\n"
                          "predicate over(a: object, b: object) = height(a) > height(b)\n"
                          "layout row { cells ends = grid 2 x 2 at (0cm, 0cm) spread (10cm, 20cm)\n"
                          "place goods in distinct ends; place target at (0cm, 0cm)\n"
                          "orient by rest; drop 10cm settle 0.5s }\n"
                          "metrics m { success = at end " +
                          goal +
                          " }\n"
                          "task t like base { layout row; goods red, blue; target tray; metrics m; "
                          "say \"" +
                          words + "\" }\n")
                          ->said());
  };
  const std::string one = "(any g in goods: over(g, target))",
                    each = "(all g in goods: over(g, target))";
  CHECK(told(one, "put {both goods} on {the target}") ==
        "error[P1202]: `t` says \"both\" and succeeds with one of 2 (`any`, not `all`)");
  CHECK(told(one, "put all {goods} on {the target}") ==
        "error[P1202]: `t` says \"all\" and succeeds with one of 2 (`any`, not `all`)");
  CHECK(told(each, "put {both goods} on {the target}") == "");
  CHECK(told(one, "put one of {the goods} on {the target}") == "");
}

TEST_CASE("what success asks of two things is said of both") {
  const std::string both = "at end (over(source, target) and over(helper, target))";
  CHECK(first_line(said_of_two(both, "put {the source} on {the target}")) ==
        "error[P1202]: `t` says `red` and not `blue`, of which success asks `over` as well");
  CHECK(said_of_two(both, "put {the source} on {the target} with {the helper}") == "");
  CHECK(said_of_two(both, "put {the source} and the blue block on {the target}") == "");
  CHECK(said_of_two(both, "put both blocks on {the target}") == "");
  CHECK(said_of_two(both, "tidy up") == "");
  CHECK(first_line(said_of_two("at end (all o in {source, helper}: over(o, target))",
                               "put {the helper} on {the target}")) ==
        "error[P1202]: `t` says `blue` and not `red`, of which success asks `over` as well");
  // What is asked otherwise, or denied, is no part of what is to be done.
  CHECK(said_of_two("at end (over(source, target) and not over(helper, target))",
                    "put {the source} on {the target}") == "");
  CHECK(said_of_two("at end (over(source, target) or over(helper, target))",
                    "put {the source} on {the target}") == "");
}

TEST_CASE("between two is measured to both") {
  const std::string words = "put {the source} between {the target} and {the helper}";
  CHECK(first_line(said_of_two("at end over(source, target)", words)) ==
        "error[P1202]: `t` says \"between\" and its success measures nothing to both of what that "
        "stands before");
  CHECK(said_of_two("at end (distance_xy(source, target) + distance_xy(source, helper) < 30cm)",
                    words) == "");
  CHECK(said_of_two("at end (distance(source, target) < 9cm and distance(source, helper) < 9cm)",
                    words) == "");
  CHECK(first_line(said_of_two("at end (over(source, target) and over(helper, target))", words)) ==
        "error[P1202]: `t` says \"between\" and its success measures nothing to both of what that "
        "stands before");
  CHECK(said_of_two("at end y(source) > 0cm", words) == "");
  CHECK(said_of_two("at end over(source, target)",
                    "put {the source}, not {the helper}, between yourself and {the target}") == "");
  // Which thing is picked up, not where it is put.
  CHECK(said_of_two("at end over(source, target)",
                    "pick up {the source} between {the target} and {the helper} and place it on "
                    "{the target}") == "");
  CHECK(said_of_two("at end over(source, target)",
                    "pick up {the source} and place it between {the target} and {the helper}") !=
        "");
}

TEST_CASE("a side that is said is one that success can tell") {
  const auto told = [](const std::string& goal, const std::string& words) {
    return first_line(said_of_two("at end (" + goal + " and moved_xy(helper) < 1cm)",
                                  words + " and leave {the helper} alone"));
  };
  const std::string to_the_left = "put {the source} to the left of {the target}";
  CHECK(told("over(source, target)", to_the_left) ==
        "error[P1202]: `t` says \"left of\" and its success measures nothing that tells one side "
        "from another");
  CHECK(told("y(source) < y(target)", to_the_left) == "");
  CHECK(told("over(source, target)", "put {the source} behind {the target}") ==
        "error[P1202]: `t` says \"behind\" and its success measures nothing that tells one side "
        "from another");
  CHECK(told("over(source, target)", "put {the source} on the right") ==
        "error[P1202]: `t` says \"on the right\" and its success measures nothing that tells one "
        "side from another");
  CHECK(told("over(source, target)", "put {the source} next to the left knob") == "");
}

TEST_CASE("a side that says which thing is picked up asks nothing of success") {
  const auto told = [](const std::string& words) {
    return said_of_two("at end over(source, target)", words + ", not {the helper}");
  };
  CHECK(told("pick up {the source} on the right and place it on {the target}") == "");
  CHECK(told("pick up {the source} behind the knob and place it on {the target}") == "");
  CHECK(told("pick up {the source} and place it on the right of {the target}") != "");
  CHECK(told("take {the source} to the right of {the target}") != "");
}

TEST_CASE("what is the same on either side tells none") {
  const std::string lack =
      "error[P1202]: `t` says \"left of\" and its success measures nothing that tells one side "
      "from another";
  const auto told = [](const std::string& goal, const std::string& more = "") {
    return first_line(said_of_two(
        "at end " + goal, "put {the source} to the left of {the target}, not {the helper}", more));
  };
  CHECK(told("abs(x(source) - x(target)) < 5cm") == lack);
  CHECK(told("(x(source) - x(target)) * (x(source) - x(target)) < 5cm * 5cm") == lack);
  CHECK(told("angle(axis_x(source), up) < 45deg") == lack);
  CHECK(told("off(x(local(position(source), target)), x(half_size(target)))",
             "predicate off(along: length, long: length) = along * along <= long * long\n") ==
        lack);
  CHECK(told("x(source) - x(target) < 5cm") == "");
  CHECK(told("off(x(local(position(source), target)), x(half_size(target)))",
             "predicate off(along: length, long: length) = along <= long\n") == "");
}

TEST_CASE("once and as soon as say an order") {
  const std::string judged =
      "at end (done(source) and done(helper) and once (done(source) and not once done(helper)))";
  for (const std::string word : {"once", "as soon as"}) {
    CAPTURE(word);
    CHECK(said_of_two(judged,
                      "put {the helper} on {the target} " + word + " {the source} is on it") == "");
    CHECK(said_of_two(judged, word + " {the source} is on {the target}, put {the helper} there") ==
          "");
    CHECK(first_line(said_of_two(
              judged, "put {the source} on {the target} " + word + " {the helper} is on it")) ==
          "error[P1202]: `t` says \"" + word + "\" and succeeds when `red` comes before `blue`");
    CHECK(first_line(
              said_of_two("at end (done(source) and done(helper))",
                          "put {the helper} on {the target} " + word + " {the source} is on it")) ==
          "error[P1202]: `t` says \"" + word +
              "\" and its success wants no order of `blue` and `red`");
  }
  CHECK(said_of_two("at end (done(source) and done(helper))",
                    "put {the helper} and {the source} on {the target} at once") == "");
}

TEST_CASE("what is to be spared is measured") {
  const std::string words = "put {the source} on {the target} without touching {the helper}";
  CHECK(first_line(said_of_two("at end done(source)", words)) ==
        "error[P1202]: `t` says \"without touching\" and its success measures nothing of `blue`");
  CHECK(said_of_two("at end (done(source) and moved_xy(helper) < 1cm)", words) == "");
  CHECK(said_of_two("at end (done(source) and no o in distractors | {helper}: moved_xy(o) > 1cm)",
                    words) == "");
}

TEST_CASE("a noun of several parts says which of them") {
  const auto told = [](const std::string& words, const std::string& more = "") {
    return test::analyze_with_suite(std::string(test::kChest) + R"(
fixture pair like chest {
  part drawer link drawer name "upper drawer"
  part door link door name "lower drawer"
}
scene both like bench { fixture pair }
metrics far { success = at end travel(pair.drawer) > 10cm }
)" + more + "task t like red_on_tray { scene both; metrics far; say \"" +
                                    words + "\" }\n")
        ->said();
  };
  CHECK(first_line(told("open the drawer with {the source} at {the target}")) == "");
  CHECK(first_line(told("open the drawer, {the source} to {the target}")) ==
        "error[P0402]: \"drawer\" denotes 2 parts of fixtures in `t`");
  CHECK(told("open the upper drawer and close the drawer, {the source} on {the target}") == "");
  CHECK(told("open {the pair.drawer}, then close the drawer, {the source} on {the target}") == "");
  CHECK(told("open a drawer, {the source} to {the target}") == "");
}

TEST_CASE("a fault of a task is shown in its own file, whatever the used one says") {
  test::Analysis a;
  const std::string used = std::string(test::kSmallSuite) +
                           "template told \"put {the source} to the left of {the target}\"\n"
                           "metrics left { success = at end y(source) < y(target) }\n"
                           "task lefts like red_on_tray { metrics left; say told }\n";
  const std::string own = "variant mine of lefts { metrics plain }\n";
  for (const std::string& text : {used, own}) {
    const FileId id = a.sources.add(text == own ? "own.probe" : "used.probe", text);
    a.files.push_back(syntax::parse(a.sources, id, a.diagnostics));
  }
  const FileId root = a.files[1].file.id;
  a.model = sema::analyze(a.sources, {&a.files[0].file, &a.files[1].file}, test::asset_root(),
                          a.diagnostics, {root});
  REQUIRE_MESSAGE(a.codes() == "P1202", a.said());
  CHECK(a.underlined() == "mine");
  REQUIRE(!a.diagnostics.items().front().labels.empty());
  CHECK(a.sources.text(a.diagnostics.items().front().labels.front().span) == "say told");
}
