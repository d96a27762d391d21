// The words behind --until.
#include "runtime/adaptive/rule.h"

#include <doctest/doctest.h>

namespace probe::adaptive {

TEST_CASE("a rule is read as it is written, and written as it is read") {
  const auto check = [](const char* given, const char* kept) {
    const auto rule = parse_rule(given);
    REQUIRE_MESSAGE(rule.ok(), given);
    CHECK(to_text(*rule) == kept);
    CHECK(to_text(*rule_from_text(kept, "run")) == kept);
  };
  check("width 10%", "width 10 % of each task");
  check("width 10 % of each task", "width 10 % of each task");
  check(" width 2.5% of all ", "width 2.5 % of all tasks");
  check("width 0.1% of all tasks", "width 0.1 % of all tasks");
  Rule decided = *parse_rule("decided-against runs/old policy");
  CHECK(decided.dir == "runs/old policy");
  decided.against = "pi0 (outcomes of others)";
  decided.outcomes = "0123456789abcdef";
  const std::string text = to_text(decided);
  CHECK(text == "decided against `pi0 (outcomes of others)` (outcomes 0123456789abcdef)");
  CHECK(rule_from_text(text, "run")->against == decided.against);
  CHECK(in_words(text) == "decided against `pi0 (outcomes of others)`");
  CHECK(in_words("width 10 % of each task") == "width 10 % of each task");
  CHECK(rule_from_text(text, "run")->outcomes == decided.outcomes);
}

TEST_CASE("what is no rule is refused with what would be one") {
  for (const char* text :
       {"", "width", "width 0%", "width -1%", "width 100%", "width nan%", "width 10", "width 10% of some",
        "width 10%%", "decided-against", "decided-against  ", "until it is good", "width ten%"}) {
    const auto rule = parse_rule(text);
    REQUIRE_FALSE_MESSAGE(rule.ok(), text);
    CHECK(rule.failure().code == Fault::kUsage);
    CHECK(rule.failure().message.find("decided-against DIR") != std::string::npos);
  }
  for (const char* text : {"width 10%", "better than before", "decided against `x`", ""}) {
    const auto rule = rule_from_text(text, "run");
    REQUIRE_FALSE_MESSAGE(rule.ok(), text);
    CHECK(rule.failure().where == "run");
  }
  CHECK(rule_from_text("\x1b[31mred", "run").failure().message.find('\x1b') == std::string::npos);
}

TEST_CASE("the order of a decision keeps a start's seeds together, that of a width does not") {
  const Sha256 one = sha256("one");
  CHECK(rank_of(Rule::Kind::kDecided, "t", one, 1) == rank_of(Rule::Kind::kDecided, "t", one, 2));
  CHECK(rank_of(Rule::Kind::kEachTask, "t", one, 1) != rank_of(Rule::Kind::kEachTask, "t", one, 2));
  CHECK(rank_of(Rule::Kind::kEachTask, "t", one, 1) == rank_of(Rule::Kind::kAllTasks, "t", one, 1));
}

TEST_CASE("tasks whose episodes are the same have orders of their own") {
  const Sha256 one = sha256("one");
  for (const auto kind : {Rule::Kind::kEachTask, Rule::Kind::kAllTasks, Rule::Kind::kDecided})
    CHECK(rank_of(kind, "a", one, 1) != rank_of(kind, "b", one, 1));
}

}  // namespace probe::adaptive
