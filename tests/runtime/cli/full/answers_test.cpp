// Folders of answers that somebody changed, as a user looks at them.
#include <doctest/doctest.h>

#include "runtime/ask/ask.h"
#include "runtime/store/database.h"
#include "tests/runtime/ask/asking_plan.h"
#include "tests/runtime/cli/program.h"

namespace probe::cli {
namespace {

using test::Outcome;
using test::Sandbox;

void change(const Sandbox& box, const std::string& sql) {
  auto database =
      store::Database::open((box / "A/answers.sqlite").string(), store::Database::Access::kWrite);
  REQUIRE(database.ok());
  const Status done = database->execute(sql.c_str());
  REQUIRE_MESSAGE(done.ok(), to_text(done.failure()));
}

// A byte of a control, or U+202E, which turns the order of a line around.
bool repaints(const std::string& text) {
  return test::contains(text, "\x1b") || test::contains(text, "\xe2\x80\xae");
}

}  // namespace

TEST_CASE(
    "answers that do not follow from what they hold are told by the exit code, in clean words") {
  const Sandbox box;
  ask::AskOptions options;
  options.model = "truth";
  options.out = (box / "A").string();
  options.assets = std::string(VLAPROBE_SOURCE_DIR) + "/assets";
  const plan::Plan plan = ask::asking_plan(1);
  const auto asked = ask::ask(plan, options);
  REQUIRE_MESSAGE(asked.ok(), to_text(asked.failure()));

  const auto why = [&] { return box.vlaprobe("why A carrot_on_plate 0"); };
  for (const char* form : {"", "--json", "--csv"})
    CHECK(box.vlaprobe(std::string("results A ") + form).exit == 0);
  CHECK(why().exit == 0);
  CHECK(box.vlaprobe("merge A -o whole").exit == 0);

  change(box, "update answers set invalid = 'server lost' where family = 'many'");
  change(box, "update answers set model = char(27) || '[31m' || char(8238) where family = 'there'");
  change(box, "update answers set rule = char(27) || char(8238) where family = 'source'");
  for (const char* form : {"", "--json", "--csv"}) {
    CAPTURE(form);
    const Outcome results = box.vlaprobe(std::string("results A ") + form);
    CHECK(results.exit == 2);
    CHECK(test::contains(
        results.out + results.err,
        "1 answer counts neither way: it is said to be invalid and holds an answer"));
    if (std::string(form).empty()) CHECK(!repaints(results.out));
    CHECK(!repaints(results.err));
  }
  CHECK(why().exit == 2);
  CHECK(!repaints(why().out));
  const Outcome merged = box.vlaprobe("merge A -o joined");
  CHECK(merged.exit == 2);
  CHECK(!repaints(merged.err));
  // What was written so is told again.
  CHECK(box.vlaprobe("results joined").exit == 2);
}

}  // namespace probe::cli
