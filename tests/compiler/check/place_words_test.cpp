// "The left can" written out: which one that is, is proved of phrases alone.
#include <doctest/doctest.h>

#include "tests/compiler/small_suite.h"

using namespace probe;

namespace {

std::string told(const std::string& words, const std::string& more = "") {
  return test::analyze_with_suite(
             R"(
relation left_of(a: object, b: object, by: length = 2cm) "left" = view_x(a) < view_x(b) - by
relation leftmost(a: object) "left" = all o in alike - {a}: left_of(a, o)
object sided like red { phrase side spatial "left block" means category toy and leftmost }
object knob like pale { name "left knob" }
layout row { place sided at (0cm, -20cm); place blue at (0cm, 20cm); place tray at (0cm, 0cm)
             orient by rest; drop 10cm settle 0.5s }
)" + more + "task t like base { layout row; source sided; target tray; distractors blue; say \"" +
             words + "\" }\n")
      ->said();
}

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

}  // namespace

TEST_CASE(
    "words of places at a noun of the scene are not proved, and the phrase is named that is") {
  const std::string said = told("put the left block on {the target}");
  CHECK(
      first_line(said) ==
      "warning[P1203]: \"left block\" says in `t` which thing is meant by where it is, and nothing "
      "proves it");
  CHECK(said.find("help: `refer source as side` and `{the source}` say \"left block\", proved in "
                  "every start") != std::string::npos);
  CHECK(first_line(told("put the Rightmost red block on {the target}"))
            .find("\"rightmost red block\"") != std::string::npos);
  const std::string other = told("put {the source} on the left dish");
  CHECK(other.find("help: give `tray` a phrase that is proved in every start, `phrase by_place "
                   "spatial \"left dish\" means .. and leftmost`, and say `{the target}` with "
                   "`refer target as by_place`") != std::string::npos);
  CHECK(first_line(told("put the block nearest to {the target} on it")).find("\"block nearest\"") !=
        std::string::npos);
  CHECK(first_line(told("put the left one on {the target}")).find("\"left one\"") !=
        std::string::npos);
}

TEST_CASE("words of places that are names, sides or something else are no such reference") {
  for (const char* words :
       {"put {the source} on {the target}, right now", "put {the source} back on {the target}",
        "put back the red block on {the target}",
        "put {the source} on the left side of {the target}",
        "push the left knob with {the source} at {the target}"}) {
    CAPTURE(words);
    CHECK(told(words).find("P1203") == std::string::npos);
  }
  CHECK(
      told("put {the source} to the left of {the target}",
           "metrics m { success = at end left_of(source, target) }\nabstract task base2 like base "
           "{ metrics m }\n")
          .find("P1203") == std::string::npos);
  CHECK(first_line(told("pick up the left block", "@allow(unproved_place, \"published so\")\n")) ==
        "");
}
