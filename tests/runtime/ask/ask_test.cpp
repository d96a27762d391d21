// Whole calls of `ask` on real pictures, with the models of this process.
#include "runtime/ask/ask.h"

#include <doctest/doctest.h>

#include <map>

#include "runtime/ask/answers.h"
#include "runtime/ask/merge.h"
#include "tests/runtime/ask/asking_plan.h"
#include "tests/runtime/run/temporary_folder.h"

namespace probe::ask {
namespace {

using run::TemporaryFolder;

AskOptions asking_options(const std::string& model, const std::string& out) {
  AskOptions options;
  options.model = model;
  options.out = out;
  options.assets = std::string(VLAPROBE_SOURCE_DIR) + "/assets";
  return options;
}

AskSummary must_ask(const plan::Plan& plan, const AskOptions& options) {
  auto summary = ask::ask(plan, options);
  REQUIRE_MESSAGE(summary.ok(), to_text(summary.failure()));
  return *summary;
}

std::vector<AnswerRow> rows_in(const std::string& dir) {
  auto rows = read_answers(dir);
  REQUIRE_MESSAGE(rows.ok(), to_text(rows.failure()));
  return *rows;
}

TEST_CASE("the model that knows is right everywhere, in every form and rotation") {
  TemporaryFolder folder;
  const plan::Plan plan = asking_plan(2);
  AskOptions options = asking_options("truth", folder / "truth");
  options.jobs = 3;
  const AskSummary summary = must_ask(plan, options);
  const auto rows = rows_in(folder / "truth");
  CHECK(summary.total == 2 * (3 + 1 + 1 + 1 + 1 + 1));
  CHECK(static_cast<std::int64_t>(rows.size()) + summary.left_out == summary.total);
  CHECK(summary.invalid == 0);
  CHECK(summary.right == summary.done);
  std::map<std::string, int> families;
  for (const AnswerRow& row : rows) {
    ++families[row.family];
    CHECK_MESSAGE(row.right == true, row.family, ": ", row.raw, " for ", row.expected);
    CHECK(row.model == "truth");
    CHECK(row.task == "carrot_on_plate");
    CHECK(row.start_id.size() == 64);
  }
  CHECK(families["source"] == 6);
  CHECK(families["where"] == 2);
  CHECK(rows.front().text ==
        "A robot is told: \"put carrot on plate\". Which object must it pick up?\nA. carrot\nB. "
        "plate\nC. towel\nAnswer with the letter of one option.");
  CHECK(rows[1].raw == "C");  // the same question, one place on

  // Again: nothing is left to do, also of what was left out.
  const AskSummary again = must_ask(plan, options);
  CHECK(again.done == 0);
  CHECK(again.skipped == summary.total);
}

TEST_CASE("a habit has no sentence: it is right about none, and about one order of a choice") {
  TemporaryFolder folder;
  must_ask(asking_plan(2), asking_options("first", folder / "first"));
  int sentences = 0, choices = 0;
  for (const AnswerRow& row : rows_in(folder / "first")) {
    CAPTURE(row.family);
    if (row.family == "source") choices += row.right == true ? 1 : 0;
    if (row.family != "restate") continue;
    CHECK(row.right == false);
    ++sentences;
  }
  CHECK(sentences == 2);
  CHECK(choices == 2);
}

TEST_CASE("one job or three, in one go or in shards: the same answers") {
  TemporaryFolder folder;
  const plan::Plan plan = asking_plan(3);
  must_ask(plan, asking_options("random", folder / "one"));
  AskOptions three = asking_options("random", folder / "three");
  three.jobs = 3;
  must_ask(plan, three);
  const auto words = [](const std::vector<AnswerRow>& rows) {
    std::vector<std::string> all;
    for (const AnswerRow& row : rows) all.push_back(row.family + row.start_id + row.raw);
    return all;
  };
  const auto expected = words(rows_in(folder / "one"));
  CHECK(words(rows_in(folder / "three")) == expected);
  AskOptions part = asking_options("random", folder / "parts");
  part.choice.shards = 3;
  std::int64_t done = 0;
  for (const int shard : {2, 3, 1}) {
    part.choice.shard = shard;
    done += must_ask(plan, part).done;
  }
  CHECK(done == static_cast<std::int64_t>(expected.size()));
  CHECK(words(rows_in(folder / "parts")) == expected);
}

TEST_CASE("a folder is of one model, one plan and one way of asking") {
  TemporaryFolder folder;
  const plan::Plan plan = asking_plan(1);
  must_ask(plan, asking_options("first", folder / "answers"));
  const auto other = ask::ask(plan, asking_options("random", folder / "answers"));
  REQUIRE(!other.ok());
  CHECK(other.failure().message.starts_with("holds answers of model `first`, not `random`, and "));
  const plan::Plan more = asking_plan(2);
  const auto grown = ask::ask(more, asking_options("first", folder / "answers"));
  REQUIRE(!grown.ok());
  CHECK(grown.failure().message.starts_with("holds answers to another plan's questions (root "));
  AskOptions fork = asking_options("random", folder / "answers");
  fork.if_changed = run::IfChanged::kFork;
  CHECK(must_ask(plan, fork).out == (folder / "answers") + "-2");
}

TEST_CASE("questions, tasks and suites that are not there are told, with the nearest") {
  TemporaryFolder folder;
  const plan::Plan plan = asking_plan(1);
  AskOptions options = asking_options("truth", folder / "answers");
  options.choice.questions = {"understanding.sorce"};
  auto asked = ask::ask(plan, options);
  REQUIRE(!asked.ok());
  CHECK(asked.failure().message ==
        "no questions are called `understanding.sorce`, did you mean `understanding.source`?");
  options.choice.questions = {"understanding.source"};
  CHECK(must_ask(plan, options).done == 3);
  options.model = "truht";
  asked = ask::ask(plan, options);
  REQUIRE(!asked.ok());
  CHECK(asked.failure().message.starts_with("unknown model `truht`, did you mean `truth`?"));
  options = asking_options("truth", folder / "blind");
  options.choice.arms = {Arm::kBlind};
  asked = ask::ask(plan, options);
  REQUIRE(!asked.ok());
  CHECK(asked.failure().where == "--arms");
  CHECK(!holds_answers(folder / "blind"));
}

TEST_CASE("the end of a recorded episode is drawn again, and its program knows the right answer") {
  TemporaryFolder folder;
  const plan::Plan plan = asking_plan(2, ask_done);
  AskOptions options = asking_options("truth", folder / "answers");
  const auto without = ask::ask(plan, options);
  REQUIRE(!without.ok());
  CHECK(without.failure().where == "--frames");
  run::RunOptions run;
  run.policy = "random";
  run.out = folder / "run";
  run.assets = options.assets;
  run.seeds = {3, 5};
  const auto ran = run::run(plan, run);
  REQUIRE_MESSAGE(ran.ok(), to_text(ran.failure()));
  options.frames = folder / "run";
  const AskSummary summary = must_ask(plan, options);
  CHECK(summary.total == 4);
  CHECK(summary.right == 4);
  const auto rows = rows_in(folder / "answers");
  REQUIRE(rows.size() == 4);
  for (const AnswerRow& row : rows) {
    CHECK(!row.invalid);
    CHECK((row.seed == 3 || row.seed == 5));
    CHECK(row.expected == "no");  // nobody puts it there by chance in three steps
  }
  CHECK(must_ask(plan, options).done == 0);
  // A run that lacks episodes is told, one of another horizon refused.
  run.seeds = {3};
  run.episodes = {{0, 0}};
  run.out = folder / "short";
  REQUIRE(run::run(plan, run).ok());
  options.frames = folder / "short";
  options.out = folder / "of-short";
  const AskSummary some = must_ask(plan, options);
  CHECK(some.total == 1);
  REQUIRE(!some.notes.empty());
  CHECK(std::ranges::any_of(some.notes, [](const std::string& note) {
    return note.starts_with("the ends of 1 of 2 chosen starts are not asked about");
  }));
  const plan::Plan longer = asking_plan(2, [](plan::Writer& writer) {
    ask_done(writer);
    ++writer.records.tasks[0].horizon;
  });
  options.out = folder / "of-longer";
  const auto late = ask::ask(longer, options);
  REQUIRE(!late.ok());
  CHECK(late.failure().where == "--frames");
  CHECK(late.failure().message.starts_with("`carrot_on_plate` of "));
  CHECK(late.failure().message.find("is left out: it ran for at most ") != std::string::npos);
  options.out = folder / "answers";
  run.episodes.reset();
  // Another run's ends are not these.
  run.policy = "null";
  run.out = folder / "other";
  REQUIRE(run::run(plan, run).ok());
  options.frames = folder / "other";
  const auto other = ask::ask(plan, options);
  REQUIRE(!other.ok());
  CHECK(other.failure().message.starts_with("holds answers about the ends of the run `random, "));
}

TEST_CASE("a condition of the start is judged where things have come to rest, without a run") {
  TemporaryFolder folder;
  const plan::Plan plan = asking_plan(2, ask_begun);
  const AskSummary summary = must_ask(plan, asking_options("truth", folder / "answers"));
  CHECK(summary.total == 2);
  CHECK(summary.right == 2);
  for (const AnswerRow& row : rows_in(folder / "answers")) {
    CHECK(!row.invalid);
    CHECK(row.expected == "no");  // it begins beside it
  }
}

TEST_CASE("folders of shards become one, each answer once, and strangers are refused") {
  TemporaryFolder folder;
  const plan::Plan plan = asking_plan(3);
  std::vector<std::string> parts;
  for (const int shard : {1, 2, 3}) {
    AskOptions options = asking_options("first", folder / ("part" + std::to_string(shard)));
    options.choice.shard = shard;
    options.choice.shards = 3;
    if (!must_ask(plan, options).out.empty()) parts.push_back(options.out);
  }
  must_ask(plan, asking_options("first", folder / "whole"));
  const bool are_all_there = parts.size() == 3;
  // One that lacks shards says which.
  const auto is_partial = [](const std::string& note) {
    return note.find(" is partial: shard") != note.npos;
  };
  const auto some = merge({.dirs = {parts.front()}, .out = folder / "some"});
  REQUIRE(some.ok());
  REQUIRE(std::ranges::count_if(some->notes, is_partial) == 1);
  CHECK(std::ranges::find_if(some->notes, is_partial)->find(" of 3 w") != std::string::npos);
  parts.push_back(parts.front());
  const auto merged = merge({.dirs = parts, .out = folder / "all"});
  REQUIRE_MESSAGE(merged.ok(), to_text(merged.failure()));
  const auto all = rows_in(folder / "all"), whole = rows_in(folder / "whole");
  REQUIRE(all.size() == whole.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    CHECK(all[i].raw == whole[i].raw);
    CHECK(all[i].question_id == whole[i].question_id);
  }
  CHECK(merged->added == static_cast<int>(whole.size()));
  CHECK(std::ranges::any_of(merged->notes, is_partial) == !are_all_there);
  const auto again = merge({.dirs = {folder / "whole"}, .out = folder / "all"});
  REQUIRE(again.ok());
  CHECK(again->added == 0);
  CHECK(again->duplicates == static_cast<int>(whole.size()));
  must_ask(plan, asking_options("random", folder / "other"));
  const auto mixed = merge({.dirs = {folder / "whole", folder / "other"}, .out = folder / "mixed"});
  REQUIRE(!mixed.ok());
  CHECK(mixed.failure().message.starts_with("holds answers of model `random`, not `first`"));
  CHECK(!holds_answers(folder / "mixed"));
}

}  // namespace
}  // namespace probe::ask
