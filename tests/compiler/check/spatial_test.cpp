// Phrases that say where things are, proved in every start; and the words they must have.
#include <doctest/doctest.h>

#include "compiler/define/starts.h"
#include "runtime/plan/axes.h"
#include "tests/compiler/small_suite.h"

using namespace probe;

namespace {

const char* const kRelations = R"(
relation left_of(a: object, b: object, by: length = 2cm) "left" = view_x(a) < view_x(b) - by
relation leftmost(a: object) "left" = all o in alike - {a}: left_of(a, o)
relation between(a: object, b: object, c: object) "between" = distance_xy(a, b) + distance_xy(a, c) < distance_xy(b, c) + 20cm
object sided like red {
  phrase side spatial "left block" means category toy and leftmost
  phrase by_tray spatial "block left of the tray" means category toy and left_of tray
  phrase amid spatial "toy between the tray and the pale block" means category toy and between(tray, pale)
}
)";

// Red, blue, the tray and the pale block on one line, which the camera sees from the side: a larger
// y is farther right in its picture.
std::string row(const char* red, const char* blue, const char* tray = "0cm",
                const char* pale = "") {
  std::string text = std::string(kRelations) + "layout row { place sided at (0cm, " + red +
                     "); place blue at (0cm, " + blue + "); place tray at (0cm, " + tray + ")";
  if (*pale != '\0') text += std::string("; place pale at (0cm, ") + pale + ")";
  return text + "; orient by rest; drop 10cm settle 0.5s }\n";
}

std::string said(const std::string& layout, const std::string& phrase,
                 const std::string& distractors = "blue") {
  return test::analyze_with_suite(layout +
                                  "task t like base { layout row; source sided; target tray; "
                                  "distractors " +
                                  distractors + "; refer source as " + phrase + " }")
      ->said();
}

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

}  // namespace

TEST_CASE("a phrase of places is clear where the relation holds of its object alone") {
  CHECK(said(row("-20cm", "20cm"), "side") == "");
  CHECK(said(row("-20cm", "20cm"), "by_tray") == "");
  CHECK(said(row("10cm", "-20cm", "0cm", "20cm"), "amid", "blue, pale") == "");
}

TEST_CASE("who does not say what the words ask for is named where nothing else is in the way") {
  const std::string text =
      std::string(test::kChest) + row("-5cm", "35cm", "15cm") +
      "fixture coffer like chest { at (0cm, -35cm, 85cm) yaw -90deg; part drawer link drawer name "
      "\"drawer\" { color blue } }\n"
      "scene hall like bench { fixture coffer }\n"
      "task t like base { scene hall; source sided; target tray; distractors blue; layout row";
  const auto also = test::analyze_with_suite(text + "; refer source as side }")->said();
  CHECK_MESSAGE(also.find("note: `coffer.drawer` does not say what `category toy and "
                          "leftmost` asks for and may be meant, too") != std::string::npos,
                also);
  const auto clear = test::analyze_with_suite(text + " where clear side of source }")->said();
  CHECK_MESSAGE(clear.find("cannot be told") != std::string::npos, clear);
}

TEST_CASE("what the words denote in that start is said, and what they lack in the scene") {
  CHECK(said(row("20cm", "-20cm"), "side").find("note: there it denotes `blue`\n") !=
        std::string::npos);
  CHECK(said(row("-20cm", "-10cm"), "by_tray").find("note: there it denotes `blue`, too\n") !=
        std::string::npos);
  CHECK(said(row("10cm", "-20cm"), "amid")
            .find("note: `pale` is not in the scene of `t`: nothing is `between` to it\n") !=
        std::string::npos);
}

TEST_CASE("where it does not hold, or of another one too, the start is named and drawn") {
  const std::string wrong = said(row("20cm", "-20cm"), "side");
  CHECK(first_line(wrong) ==
        "error[P0401]: \"left block\" does not denote `sided` in 2 of the 2 starts of `t`");
  CHECK(wrong.find("start 0: sided at (0cm, 20cm), tray at (0cm, 0cm), blue at (0cm, -20cm)") !=
        std::string::npos);
  CHECK_MESSAGE(wrong.find("is not true of `sided`\n") != std::string::npos, wrong);
  CHECK(first_line(said(row("-20cm", "-10cm"), "by_tray")) ==
        "error[P0402]: \"block left of the tray\" does not denote alone `sided` in 2 of the 2 "
        "starts of `t`");
}

TEST_CASE("what settling may turn over is too close to call") {
  CHECK(
      first_line(said(row("-20cm", "-16cm"), "side")) ==
      "error[P0403]: \"left block\" cannot be told to denote `sided` in 1 of the 2 starts of `t`");
  CHECK(said(row("-20cm", "-12cm"), "side") == "");
}

TEST_CASE("in a mirrored picture left is right") {
  const auto a = test::analyze_with_suite(row("-20cm", "20cm") +
                                          "camera turned like eye { sensor mirrored }\n"
                                          "task t like base { layout row; source sided; target "
                                          "tray; distractors blue; refer source as side }\n"
                                          "variant v of t { camera turned }");
  CHECK(a->said().find("note: there it denotes `blue`\n") != std::string::npos);
  const auto b = test::analyze_with_suite(row("20cm", "-20cm") +
                                          "camera turned like eye { sensor mirrored }\n"
                                          "task t like base { layout row; source sided; target "
                                          "tray; distractors blue; refer source as side; "
                                          "camera turned }");
  CHECK(b->said() == "");
}

TEST_CASE("a variant that says where things are moves the spatial axis") {
  const auto a = test::analyze_with_suite(
      row("-20cm", "20cm") +
      "task t like base { layout row; source sided; target tray; distractors blue }\n"
      "variant v of t { refer source as side }");
  CHECK(a->said() == "");
  CHECK(plan::axis_names(a->task("v").axes) == std::vector<std::string_view>{"language.spatial"});
  CHECK(a->task("v").prompt == "put left block on the tray");
}

TEST_CASE("a derive takes the clear phrases of each task's own starts") {
  const auto a = test::analyze_with_suite(
      row("-20cm", "20cm", "0cm", "10cm") +
      "task t like base { layout row; source sided; target tray; distractors blue, pale }\n"
      "derive \"{t}_{p}\" for t in { t }, p in clear phrases spatial of source { refer source as p "
      "}");
  CHECK(a->said() == "");
  std::string names;
  for (const sema::Task& task : a->model.tasks) {
    if (task.derived) names += task.name + " ";
  }
  CHECK(names == "t_side t_by_tray ");
}

TEST_CASE("metrics judge a relation as any predicate, but for the rest of a phrase") {
  const auto judged = [](const char* goal) {
    return test::analyze_with_suite(row("-20cm", "20cm") + "metrics m { success = at end " + goal +
                                    " }\ntask t like base { layout row; source sided; target tray; "
                                    "distractors blue; metrics m }");
  };
  CHECK(judged("(left_of(source, target) and moved_xy(source) > 1cm)")->said() == "");
}

TEST_CASE("a relation measures what is known of a start, of objects alone, and has its words") {
  const auto mistake = [](const char* text) {
    return first_line(test::analyze_with_suite(text)->said());
  };
  CHECK(mistake("relation r(a: object, b: object) \"touching\" = impulse(a, b) > 0Ns") ==
        "error[P1201]: `impulse` is not known before anything moves");
  CHECK(mistake("predicate p(a: object) = once (height(a) > 1cm)\n"
                "relation r(a: object) \"high\" = p(a)") ==
        "error[P1201]: what was is not known before anything moves");
  CHECK(mistake("relation r(a: object) \"clear\" = no x in bodies - {a}: distance(a, x) < 1cm") ==
        "error[P1201]: a relation is one of objects, this set has others");
  CHECK(mistake("relation r(a: object, least: length) \"high\" = height(a) > least") ==
        "error[P1201]: a relation takes one to three objects; whatever stands behind them has a "
        "default");
  CHECK(mistake("relation r(a: object) \" \" = x(a) > 0cm") ==
        "error[P1201]: a relation has words that say it");
  CHECK(mistake("relation r(a: object) \"far\" = x(a)") ==
        "error[P0601]: expected a condition, found a length");
  CHECK(mistake("relation r(a: object, b: object) \"far\" = x(a) > x(b)\n"
                "object other like red { phrase p spatial \"far one\" means r }") ==
        "error[P1201]: `r` takes 1 object behind the one that is described, found 0");
  CHECK(mistake("predicate p(a: object) = all o in alike - {a}: x(a) > x(o)") ==
        "error[P0201]: unknown set of bodies `alike`");
}

TEST_CASE("words say the relation that proves or judges them") {
  const auto mistake = [](const std::string& text) {
    return first_line(test::analyze_with_suite(std::string(kRelations) + text)->said());
  };
  CHECK(mistake("object other like red { phrase p spatial \"right block\" means leftmost }") ==
        "error[P1202]: \"right block\" does not say `leftmost`");
  CHECK(mistake("object other like red { phrase p spatial \"Left block\" means leftmost }") == "");
  CHECK(mistake("template aside \"put {the source} to the right of {the target}\"\n"
                "metrics m { success = at end left_of(source, target) }\n"
                "task t like red_on_tray { metrics m; say aside }") ==
        "error[P1202]: `t` says \"right\" and is judged by `left_of`");
  // Of two things it is the other way round.
  const auto turned = [&](const std::string& side) {
    return mistake(
        "metrics m { success = at end (left_of(target, source) and moved_xy(source) > 3cm) }\n"
        "task t like red_on_tray { metrics m; say \"put {the source} to the " +
        side + " of {the target}\" }");
  };
  CHECK(turned("right") == "");
  CHECK(turned("left") ==
        "error[P1202]: `t` says \"left\" of `red` and is judged by `left_of` of `tray`, the other "
        "way round");
}

TEST_CASE("a layout is cut to the starts in which a phrase is clear, for the baseline too") {
  const std::string two_places =
      std::string(kRelations) +
      "layout any { cells spots = grid 1 x 2 at (0cm, 0cm) spread (0cm, 20cm)\n"
      "place source, blue in distinct spots; place tray at (-20cm, 0cm)\n"
      "orient by rest; drop 10cm settle 0.5s; expect 4 episodes }\n"
      "task all like base { layout any; source sided; target tray; distractors blue }\n";
  const auto cut =
      test::analyze_with_suite(two_places +
                               "task some like all { layout any where clear side of source }\n"
                               "variant v of some { refer source as side }");
  CHECK(cut->said() == "");
  CHECK(cut->task("all").starts.size() == 4);
  CHECK(cut->task("some").starts.size() == 2);
  CHECK(cut->task("v").starts.data() == cut->task("some").starts.data());
  CHECK(plan::axis_names(cut->task("v").axes) == std::vector<std::string_view>{"language.spatial"});

  const std::string uncut =
      test::analyze_with_suite(two_places + "variant v of all { refer source as side }")->said();
  CHECK(first_line(uncut) ==
        "error[P0401]: \"left block\" does not denote `sided` in 2 of the 4 starts of `v`");
  CHECK(uncut.find("help: it is clear in 2 of them: `layout any where clear side of source` keeps "
                   "those, in its baseline, too") != std::string::npos);

  CHECK(first_line(test::analyze_with_suite(
                       two_places + "variant v of all { layout any where clear side of source; "
                                    "refer source as side }")
                       ->said()) == "warning[P0701]: `v` differs from its baseline on 2 axes");
  CHECK(first_line(test::analyze_with_suite(
                       two_places + "task t like all { layout any where clear sight of source }")
                       ->said()) == "error[P0201]: unknown phrase of `sided` `sight`");
  const std::string none =
      test::analyze_with_suite(two_places +
                               "task t like all { layout any where clear amid of source }\n"
                               "variant said_too of t { refer source as amid }")
          ->said();
  CHECK(first_line(none) == "error[P0402]: none of the 4 starts of `t` has clear phrases");
  // Why, where things are, and once for all that have these starts.
  CHECK(none.find("4 of 4 starts are not so of `sided`") != std::string::npos);
  CHECK(none.find("start 0: sided at (") != std::string::npos);
  CHECK(none.find("`said_too` has clear") == std::string::npos);
}

TEST_CASE("a task whose layout is cut is compared with no task that is not whole") {
  const std::string half =
      std::string(kRelations) +
      "layout any { cells spots = grid 1 x 2 at (0cm, 0cm) spread (0cm, 20cm)\n"
      "place source, blue in distinct spots; place tray at (-20cm, 0cm)\n"
      "orient by rest; drop 10cm settle 0.5s }\n"
      "task half { abstract; layout any where clear side of source; source sided }\n"
      "task lost { scene nowhere; layout any where clear side of source; source sided }\n";
  for (const char* task : {"task v like base { against half; layout any where clear side of source; "
                           "source sided; target tray; distractors blue }",
                           "variant v of half { refer source as side }",
                           "variant v of lost { refer source as side }"}) {
    const std::string said = test::analyze_with_suite(half + task)->said();
    CHECK_MESSAGE(said.find("error[P0201]: unknown scene `nowhere`") != std::string::npos, said);
  }
}

TEST_CASE(
    "a relation that need not hold, or is to one object twice, or compares with nobody, is "
    "refused") {
  const auto mistake = [](const std::string& text) {
    return first_line(test::analyze_with_suite(std::string(kRelations) + text)->said());
  };
  const std::string open =
      "error[P1201]: a relation in a phrase holds: it stands alone or behind `and`, not under "
      "`not` "
      "or `or`";
  CHECK(mistake("object o like red { phrase p spatial \"left block\" means not leftmost }") ==
        open);
  CHECK(mistake(
            "object o like red { phrase p spatial \"left block\" means leftmost or color red }") ==
        open);
  CHECK(mistake("object o like red { phrase p spatial \"block between the trays\" means "
                "between(tray, tray) }") == "error[P1201]: `between` is given `tray` twice");
  CHECK(mistake("object o like red { phrase p appearance \"left block\" means leftmost }") ==
        "error[P1201]: a phrase that says where things are is `spatial`");
  CHECK(mistake("object o like red { phrase p spatial \"red block\" means color red }") ==
        "error[P1201]: a `spatial` phrase means a relation");
  CHECK(
      mistake(
          "object o like red { phrase p spatial \"block left of the tray\" means left_of pale }") ==
      "error[P1202]: \"block left of the tray\" does not say to which object: `pale`");
  // One toy alone is not the left one.
  CHECK(mistake("task t like base { source sided; target tray; refer source as side }") ==
        "error[P0401]: \"left block\" does not denote `sided` in 24 of the 24 starts of `t`");
}

TEST_CASE("where all lies where it lay, other roles and other words for them are no other layout") {
  const std::string twins =
      std::string(kRelations) +
      "relation rightmost(a: object) \"right\" = all o in alike - {a}: left_of(o, a)\n"
      "object one like red { phrase side spatial \"left block\" means category toy and leftmost }\n"
      "object other like red { phrase side spatial \"right block\" means category toy and "
      "rightmost }\n"
      "layout apart { cells spots = grid 1 x 2 at (0cm, 0cm) spread (0cm, 20cm)\n"
      "place one in distinct spots; place other in distinct spots; place tray at (-20cm, 0cm)\n"
      "orient by rest; drop 10cm settle 0.5s }\n"
      "task left like base { layout apart where clear side of source; source one; target tray; "
      "refer source as side }\n";
  const auto moved = [&](const std::string& lines) {
    const auto a = test::analyze_with_suite(twins + "variant right of left { " + lines + " }");
    CHECK_MESSAGE(a->said() == "", a->said());
    REQUIRE(a->task("right").starts.size() == 2);
    CHECK(sema::starts_correspond(a->task("right"), a->task("left")));
    return plan::axis_names(a->task("right").axes);
  };
  const std::vector<std::string_view> source = {"object.source"};
  CHECK(moved("source other; refer source as side") == source);
  CHECK(moved("source other; layout apart where clear side of source; refer source as side") ==
        source);
}

TEST_CASE("another camera chooses other starts, which is another layout") {
  const auto a = test::analyze_with_suite(
      std::string(kRelations) +
      "camera opposite like eye { mount arm.base at (100cm, 0cm, 1m) look (-1, 0, -1) }\n"
      "layout any { cells spots = grid 1 x 2 at (0cm, 0cm) spread (0cm, 20cm)\n"
      "place source, blue in distinct spots; place tray at (-20cm, 0cm)\n"
      "orient by rest; drop 10cm settle 0.5s }\n"
      "task some like base { layout any where clear side of source; source sided; target tray; "
      "distractors blue; refer source as side }\n"
      "variant v of some { camera opposite }");
  CHECK(plan::axis_names(a->task("v").axes) == std::vector<std::string_view>{"layout", "camera"});
  CHECK_MESSAGE(a->said().find("note: `where clear` chooses other starts here, 2, than of `some`, "
                               "2: that is the axis layout") != std::string::npos,
                a->said());
}
