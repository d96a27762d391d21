// Rows of a folder that somebody changed, or that an older program read.
#include "runtime/ask/vouch.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <optional>

#include "runtime/ask/answers.h"
#include "runtime/ask/ask.h"
#include "runtime/ask/merge.h"
#include "runtime/ask/score.h"
#include "runtime/store/database.h"
#include "tests/runtime/ask/asking_plan.h"
#include "tests/runtime/run/temporary_folder.h"

namespace probe::ask {
namespace {

using run::TemporaryFolder;

constexpr int kQueries = 8;  // about a start of asking_plan

AskOptions options_for(const std::string& out) {
  AskOptions options;
  options.model = "truth";
  options.out = out;
  options.assets = std::string(VLAPROBE_SOURCE_DIR) + "/assets";
  return options;
}

void must_answer(const plan::Plan& plan, const std::string& out) {
  const auto summary = ask::ask(plan, options_for(out));
  REQUIRE_MESSAGE(summary.ok(), to_text(summary.failure()));
  REQUIRE(summary->right == kQueries);
}

void change(const std::string& dir, const std::string& sql) {
  auto database = store::Database::open(dir + "/answers.sqlite", store::Database::Access::kWrite);
  REQUIRE(database.ok());
  const Status done = database->execute(sql.c_str());
  REQUIRE_MESSAGE(done.ok(), to_text(done.failure()));
}

std::vector<AnswerRow> rows_of(const std::string& dir) {
  auto rows = read_answers(dir);
  REQUIRE_MESSAGE(rows.ok(), to_text(rows.failure()));
  return *rows;
}

TEST_CASE("a row that does not follow from its words or from the plan is invalid, and says why") {
  struct Change {
    std::string sql, why;
  };
  const std::string where = " where family = ";
  const std::vector<Change> changes = {
      {"set \"right\" = 0" + where + "'many'", "its `right` does not follow from its `raw`"},
      {"set raw = 'B'" + where + "'source' and rotation = 0",
       "its `option` does not follow from its `raw`"},
      {"set raw = 'B', \"option\" = 1" + where + "'source' and rotation = 0",
       "its `right` does not follow from its `raw`"},
      {"set raw = 'No idea'" + where + "'source' and rotation = 0",
       "its `verdict` does not follow from its `raw`"},
      {"set yes = 1, \"right\" = 1" + where + "'there'",
       "its `yes` does not follow from its `raw`"},
      {"set expected = 'yes'" + where + "'there'", "its `expected` does not follow from the plan"},
      {"set expected = 'perhaps'" + where + "'left'", "its `expected` is neither yes nor no"},
      {"set expected = case expected when 'yes' then 'no' else 'yes' end" + where + "'left'",
       "its `right` does not follow from its `raw`"},
      {"set number = 2, raw = '2'" + where + "'many'",
       "its `right` does not follow from its `raw`"},
      {"set raw = 'Put the plate on the carrot.'" + where + "'restate'",
       "does not follow from its `raw`"},
      {"set copied = 0.123" + where + "'restate'", "its `copied` does not follow from its `raw`"},
      {"set raw = 'somewhere'" + where + "'where'", "its `verdict` does not follow from its `raw`"},
      {"set text = text || ' Say A.'" + where + "'source' and rotation = 0",
       "its `text` does not follow from the plan's question"},
      {"set prompt_sha256 = image_sha256" + where + "'many'",
       "its `prompt_sha256` does not follow from its `text`"},
      {"set question_id = '00'" + where + "'many'", "the plan has no question 00"},
      {"set task = 'spoon_on_towel'" + where + "'many'", "not as understanding.many of spoon"},
      {"set family = 'there'" + where + "'many'", "not as understanding.there of carrot_on_plate"},
      {"set episode = 7" + where + "'many'", "carrot_on_plate has no start "},
      {"set rotation = 5" + where + "'many'", "rotation 5 is none of its options"},
      {"set seed = 3" + where + "'many'", "it is asked of starts alone"},
      {"set \"right\" = null" + where + "'many'", "it is neither right nor wrong"},
      {"set invalid = 'server lost'" + where + "'many'",
       "it is said to be invalid and holds an answer"},
      {"set invalid = 'server lost', \"right\" = null" + where + "'many'",
       "it is said to be invalid and holds an answer"},
      {"set model = char(27) || '[31m' || char(8238)" + where + "'many'",
       "it is of ` [31m `, the folder is of `truth`"},
      {"set model = 'another'" + where + "'many'", "it is of `another`, the folder is of `truth`"},
      {"set rotation = -1" + where + "'many'", "its `rotation` in answers.sqlite cannot be read"},
      {"set episode = -1" + where + "'many'", "carrot_on_plate has no start "},
      {"set prompt_tokens = -5" + where + "'many'", "its `prompt_tokens` is below 0"},
      {"set completion_tokens = -5" + where + "'many'", "its `completion_tokens` is below 0"},
      {"set latency_s = -1" + where + "'many'", "its `latency_s` is below 0"},
      {"set attempts = 0" + where + "'many'", "its `attempts` is below 1"},
      {"set letter_logprobs = '[-1.0, -2.0]'" + where + "'source' and rotation = 0",
       "its `letter_logprobs` are 2, its letters "},
      {"set letter_logprobs = '[-1.0]'" + where + "'many'",
       "its `letter_logprobs` are 1, its letters 0"},
      // What was shown: a row of one arm is none of another.
      {"set arm = 'prior'" + where + "'many'",
       "its `shown_start_id` is no other start of the plan"},
      {"set arm = 'prior', shown_start_id = start_id" + where + "'many'",
       "its `shown_start_id` is no other start of the plan"},
      {"set arm = 'blind', image_sha256 = start_id" + where + "'many'",
       "its `image_sha256` does not follow from its `arm`"},
      {"set request_sha256 = start_id" + where + "'many'",
       "its `image_sha256` does not follow from its `arm`"},
      {"set shown_start_id = start_id" + where + "'many'",
       "its `shown_start_id` does not follow from its `arm`"},
  };
  const plan::Plan plan = asking_plan(1);
  TemporaryFolder folder;
  must_answer(plan, folder / "whole");
  for (const AnswerRow& row : rows_of(folder / "whole")) CHECK(!row.invalid);
  for (std::size_t i = 0; i < changes.size(); ++i) {
    CAPTURE(changes[i].sql);
    const std::string dir = folder / std::to_string(i);
    std::filesystem::copy(folder / "whole", dir, std::filesystem::copy_options::recursive);
    change(dir, "update answers " + changes[i].sql);
    const auto rows = rows_of(dir);
    REQUIRE(rows.size() == kQueries);
    const auto refused =
        std::ranges::find_if(rows, [](const auto& row) { return row.invalid.has_value(); });
    REQUIRE(refused != rows.end());
    CHECK(std::ranges::count_if(rows, [](const auto& row) { return row.invalid.has_value(); }) ==
          1);
    CHECK_MESSAGE(refused->invalid->find(changes[i].why) != std::string::npos, *refused->invalid);
    CHECK(refused->invalid->starts_with("store: "));
    CHECK(!refused->right);
    // Counts neither way, wherever it would stand, and is told.
    Tally tally(plan);
    RowFindings findings;
    for (const AnswerRow& row : rows) {
      CHECK(tally.add(row).ok());
      findings.add(row);
    }
    REQUIRE(findings.sentences().size() == 1);
    CHECK(findings.sentences()[0].starts_with("1 answer counts neither way: "));
    // The next call asks it again; what stood under another key stays what it is.
    constexpr std::size_t kAskedAgain = 7;  // every so many: each draws a picture
    if (i % kAskedAgain != 0) continue;
    const auto again = ask::ask(plan, options_for(dir));
    REQUIRE_MESSAGE(again.ok(), to_text(again.failure()));
    CHECK(again->done == 1);
    const auto after = rows_of(dir);
    CHECK(std::ranges::count_if(after, [](const auto& row) { return row.right == true; }) ==
          kQueries);
  }
}

TEST_CASE("what another version of the reader read is read anew, and that is said") {
  const plan::Plan plan = asking_plan(1);
  TemporaryFolder folder;
  must_answer(plan, folder / "old");
  // As if an older reader had taken these for something else.
  change(folder / "old", "update answers set reader = 1");
  change(
      folder / "old",
      "update answers set \"option\" = 2, \"right\" = 0, rule = 'guess' where family = 'source'");
  change(folder / "old",
         "update answers set mentioned = '[]', \"right\" = 0 where family = 'restate'");
  const auto rows = rows_of(folder / "old");
  RowFindings findings;
  for (const AnswerRow& row : rows) {
    CAPTURE(row.family);
    CHECK(row.right == true);
    CHECK(!row.invalid);
    CHECK(row.reader == 1);
    findings.add(row);
  }
  CHECK(findings.sentences() ==
        std::vector<std::string>{"8 answers were read by another version of the reader and are "
                                 "read anew by today's rules"});
  // A merged folder holds today's reading.
  const auto merged = merge({.dirs = {folder / "old"}, .out = folder / "new"});
  REQUIRE_MESSAGE(merged.ok(), to_text(merged.failure()));
  REQUIRE(merged->notes.size() == 1);
  CHECK(merged->notes[0].find("are read anew by today's rules") != std::string::npos);
  for (const AnswerRow& row : rows_of(folder / "new")) {
    CHECK(row.reader == kReaderVersion);
    CHECK(row.right == true);
  }
  // Which pixels are right is not stored: another point than then is asked for again.
  change(folder / "old", "update answers set point = '[1,1]' where family = 'where'");
  const auto pointed = rows_of(folder / "old");
  const auto where = std::ranges::find(pointed, "where", &AnswerRow::family);
  REQUIRE(where != pointed.end());
  CHECK(where->invalid == "store: today's reader takes another point from it; ask again");
}

TEST_CASE("a folder whose plan is lost shows no rows that nobody can vouch for") {
  const plan::Plan plan = asking_plan(1);
  TemporaryFolder folder;
  must_answer(plan, folder / "answers");
  std::filesystem::remove(folder / "answers" + "/suite.plan");
  const auto rows = read_answers(folder / "answers");
  REQUIRE(!rows.ok());
  CHECK(rows.failure().message.starts_with("the plan cannot be read"));
}

}  // namespace
}  // namespace probe::ask
