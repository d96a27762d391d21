// What models know beside what policies do, from folders whose answers and episodes are known.
#include "runtime/report/knowledge.h"

#include <algorithm>
#include <map>
#include <set>

#include "runtime/report/compare.h"
#include "runtime/report/page_data.h"
#include "runtime/report/table_text.h"
#include "tests/runtime/report/fake_answers.h"
#include "tests/runtime/report/fake_runs.h"

namespace probe::report {
namespace {

Benchmark loaded(const std::vector<std::string>& dirs) {
  auto benchmark = load(dirs);
  REQUIRE_MESSAGE(benchmark.ok(), to_text(benchmark.failure()));
  return std::move(benchmark).value();
}

const std::string kCarrot = "carrot_on_plate", kSpoon = "spoon_on_towel";

// Knows the first 18 starts of the carrot and none of the spoon's.
Said knows_carrots(const std::string& family, const std::string& task, int episode) {
  if (family != "source") return Said::kUnclear;
  return task == kCarrot && episode < 18 ? Said::kRight : Said::kWrong;
}

// Goes for the carrot from start 12 on and succeeds at the last two; always does the spoon.
Outcome carrots_late(const std::string& task, int episode, int) {
  if (task == kSpoon) return {.success = true};
  return {.success = episode >= 22, .intention = episode >= 12};
}

const KnowsRow& row_of(const Benchmark& benchmark, const Knowledge& knowledge, int category) {
  for (const KnowsRow& row : knowledge.knows) {
    if (question_name(benchmark, row) == "understanding.source" && row.category == category)
      return row;
  }
  FAIL("no such row");
  std::abort();
}

TEST_CASE("episodes are counted by whether the model knows, the policy goes and the task is done") {
  RunsFolder folder;
  const plan::Plan asked = suite_plan("questions.probe");
  fake_answers(folder / "answers", asked, "paligemma", knows_carrots);
  fake_run(folder / "run", suite_plan(), "pi0", {.tasks = {kCarrot, kSpoon}}, carrots_late);
  const Benchmark benchmark = loaded({folder / "run", folder / "answers"});
  REQUIRE(benchmark.models.size() == 1);
  const Knowledge knowledge = make_knowledge(benchmark);
  const KnowsRow& all = row_of(benchmark, knowledge, kAbsent);
  CHECK(all.episodes() == 48);
  // Carrot: 12 known and not gone for, 6 known and gone for, 4 gone for unknown, 2 done unknown.
  CHECK(all.with(true, false) == 12);
  CHECK(all.counts[6] == 6);
  CHECK(all.counts[7] == 0);
  CHECK(all.counts[2] == 4);
  CHECK(all.counts[3] == 2 + 24);
  CHECK(all.with(false, false) == 0);
  CHECK(all.contrast.pairs.only_a == 12);
  CHECK(all.contrast.pairs.only_b == 30);
  CHECK(knows_sentence(benchmark, all) ==
        "of the 12 episodes in which pi0 did not go for the right object, paligemma named it in "
        "12");
}

TEST_CASE("an invalid answer and an invalid episode stand in no count") {
  RunsFolder folder;
  const plan::Plan asked = suite_plan("questions.probe");
  fake_answers(folder / "answers", asked, "paligemma",
               [](const std::string&, const std::string&, int episode) {
                 return episode < 3 ? Said::kInvalid : Said::kRight;
               });
  fake_run(folder / "run", suite_plan(), "pi0", {.tasks = {kCarrot}},
           [](const std::string&, int episode, int) {
             Outcome outcome;
             if (episode >= 20) outcome.invalid = "fell over";
             return outcome;
           });
  const Benchmark benchmark = loaded({folder / "run", folder / "answers"});
  const Knowledge knowledge = make_knowledge(benchmark);
  CHECK(row_of(benchmark, knowledge, kAbsent).episodes() == 17);
}

TEST_CASE("answers without a run make tables and a page of their own") {
  RunsFolder folder;
  fake_answers(folder / "answers", suite_plan("questions.probe"), "paligemma", knows_carrots);
  const Benchmark benchmark = loaded({folder / "answers"});
  CHECK(benchmark.policies.empty());
  const Tables tables = make_tables(benchmark);
  const std::string csv = table_text(benchmark, tables, {}, TableFormat::kCsv);
  CHECK(csv.find("paligemma,understanding.source,") != std::string::npos);
  const Json page = page_data(benchmark, tables, {.title = "", .models = false});
  REQUIRE(page["models"].size() == 1);
  CHECK(page["models"][0]["label"] == "paligemma");
  CHECK(!page["tables"]["accuracy"].empty());
  CHECK(page["tables"]["knows"].empty());
  for (const TableFormat format :
       {TableFormat::kDifferencesCsv, TableFormat::kJson, TableFormat::kLatex})
    CHECK(!table_text(benchmark, tables, {}, format).empty());
}

TEST_CASE("tables of models have what stands beside: one order, no picture, another one, luck") {
  RunsFolder folder;
  const plan::Plan asked = suite_plan("questions.probe");
  fake_answers(folder / "answers", asked, "pali_gemma", knows_carrots);
  const auto blind = [](const std::string&, const std::string& task, int episode) {
    return task == kCarrot && episode < 6 ? Said::kRight : Said::kWrong;
  };
  fake_answers(folder / "answers", asked, "pali_gemma", blind, ask::Arm::kBlind);
  const Benchmark benchmark = loaded({folder / "answers"});
  const Tables tables = make_tables(benchmark);
  const std::string n = std::to_string(51 * 24);

  const std::string csv = table_text(benchmark, tables, {}, TableFormat::kCsv);
  const std::string head = csv.substr(0, csv.find('\n'));
  const auto fields = [](const std::string& line) {
    return std::count(line.begin(), line.end(), ',');
  };
  std::map<std::string, std::string> lines;  // of the source, by metric
  for (std::size_t at = 0; at < csv.size(); at = csv.find('\n', at) + 1) {
    const std::string line = csv.substr(at, csv.find('\n', at) - at);
    CHECK_MESSAGE(fields(line) == fields(head), line);
    const std::string begin = "pali_gemma,understanding.source";
    if (line.starts_with(begin))
      lines[line.substr(begin.size(), line.find(',', begin.size()) - begin.size())] = line;
  }
  REQUIRE(lines.size() == 4);
  CHECK(lines[""].find(",18," + n) != std::string::npos);
  CHECK(lines[" (plain)"].find(",18," + n) != std::string::npos);
  CHECK(lines[" (blind)"].find(",6," + n) != std::string::npos);
  CHECK(lines[" (blind)"].starts_with("pali_gemma,understanding.source (blind),0.5,"));
  // Two to four objects a task; nothing was counted.
  CHECK(lines[" (luck)"].ends_with(",computed"));
  CHECK(lines[" (luck)"].find(n) == std::string::npos);
  CHECK(!lines.contains(" (prior)"));

  const Json json = Json::parse(table_text(benchmark, tables, {}, TableFormat::kJson));
  std::map<std::string, Json> rates;
  for (const Json& row : json["models"]["rates"]) {
    if (row["metric"] == "understanding.source") rates[row["rate"].text()] = row["columns"]["avg"];
  }
  REQUIRE(rates.size() == 3);
  CHECK(rates["plain"]["k"] == 18);
  CHECK(rates["blind"]["k"] == 6);
  CHECK(rates["blind"]["n"] == 51 * 24);
  CHECK(!rates["luck"].contains("n"));
  // The page has them from the same computation.
  const Json page = page_data(benchmark, tables, {.title = "", .models = false});
  const Json& on_page = page["tables"]["accuracy"][0];
  REQUIRE(page["models"][0]["families"][0]["name"] == "understanding.source");
  REQUIRE(on_page["category"] == kAbsent);
  CHECK(on_page["blind"]["circular"][0] == 6);
  CHECK(rounded(100 * on_page["random"].get<double>()) ==
        doctest::Approx(rates["luck"]["percent"].get<double>()).epsilon(0.01));

  const std::string latex = table_text(benchmark, tables, {}, TableFormat::kLatex);
  const std::size_t heads =
      latex.find("in one order & by likeliest letters & without the picture & with ");
  REQUIRE(heads != std::string::npos);
  const std::size_t row = latex.find("pali\\_gemma & understanding.source & ", heads);
  REQUIRE(row != std::string::npos);
  const std::string cells = latex.substr(row, latex.find("\\\\\n", row) - row);
  CHECK(cells.find("{18/" + n + "}") != std::string::npos);
  CHECK(cells.find("{6/" + n + "}") != std::string::npos);
  CHECK(std::count(cells.begin(), cells.end(), '&') == 6);
}

TEST_CASE("where a server tells probabilities, every table has what the likeliest letters get") {
  RunsFolder folder;
  const plan::Plan asked = suite_plan("questions.probe");
  // The words know 18 starts; the probabilities know all, or nothing where all letters are alike.
  fake_answers(folder / "right", asked, "told", knows_carrots, ask::Arm::kPicture, Letters::kRight);
  fake_answers(folder / "tied", asked, "tied", knows_carrots, ask::Arm::kPicture, Letters::kTied);
  const Benchmark benchmark = loaded({folder / "right", folder / "tied"});
  const Tables tables = make_tables(benchmark);
  const std::string n = std::to_string(51 * 24);

  const std::string csv = table_text(benchmark, tables, {}, TableFormat::kCsv);
  CHECK(csv.find("\ntold,understanding.source (letters),100.0,") != csv.npos);
  CHECK(csv.find("\ntied,understanding.source (letters),0.0,") != csv.npos);
  CHECK(csv.find("understanding.there (letters)") == csv.npos);
  const Json json = Json::parse(table_text(benchmark, tables, {}, TableFormat::kJson));
  std::map<std::string, Json> rates;
  for (const Json& row : json["models"]["rates"]) {
    if (row["metric"] == "understanding.source" && row["rate"] == "letters")
      rates[row["policy"].text()] = row["columns"]["avg"];
  }
  REQUIRE(rates.size() == 2);
  CHECK(rates["told"]["k"] == 51 * 24);
  CHECK(rates["told"]["n"] == 51 * 24);
  CHECK(rates["tied"]["k"] == 0);
  const std::string latex = table_text(benchmark, tables, {}, TableFormat::kLatex);
  const std::size_t row = latex.find("told & understanding.source & ", latex.find("likeliest"));
  REQUIRE(row != latex.npos);
  CHECK(latex.substr(row, latex.find("\\\\\n", row) - row).find("{" + n + "/" + n + "}") !=
        latex.npos);
  const Json page = page_data(benchmark, tables, {.title = "", .models = false});
  CHECK(page["tables"]["accuracy"][0]["picture"]["likely_circular"][0] == 51 * 24);
}

TEST_CASE("two models are compared on the same questions") {
  RunsFolder folder;
  const plan::Plan asked = suite_plan("questions.probe");
  fake_answers(folder / "a", asked, "paligemma", knows_carrots);
  fake_answers(folder / "b", asked, "qwen",
               [](const std::string&, const std::string&, int) { return Said::kRight; });
  const Benchmark models = models_as_policies(loaded({folder / "a", folder / "b"}));
  REQUIRE(models.policies.size() == 2);
  const int metric = models.find_metric("understanding.source");
  REQUIRE(metric != kAbsent);
  const auto compared = compare(models, 0, 1, {.metrics = {"understanding.source"}});
  REQUIRE(compared.ok());
  const ComparedRow& all = compared->rows.front();
  CHECK(all.contrast.first.k == 18);
  CHECK(all.contrast.second.k == all.contrast.second.n);
  CHECK(all.contrast.second.n <= 51 * 24);
  CHECK(compared->words.front().starts_with("understanding.source: qwen is better"));
}

TEST_CASE(
    "an answer that several tasks share counts once in a sum, and in each of their categories") {
  RunsFolder folder;
  fake_answers(folder / "a", suite_plan("questions.probe"), "paligemma",
               [](const std::string&, const std::string&, int) { return Said::kRight; });
  const Benchmark benchmark = loaded({folder / "a"});
  const Benchmark models = models_as_policies(benchmark);
  const int metric = models.find_metric("understanding.left");
  REQUIRE(metric != kAbsent);
  const Knowledge knowledge = make_knowledge(benchmark);
  int compared = 0;
  for (const AccuracyRow& row : knowledge.accuracy) {
    if (family_name(benchmark.plan_files[0], row.family) != "understanding.left") continue;
    const auto tasks = row.category == kAbsent
                           ? models.all_tasks()
                           : models.categories[static_cast<std::size_t>(row.category)].tasks;
    const auto in_table = estimate(models, 0, metric, tasks);
    REQUIRE(in_table);
    CHECK(in_table->count.n == row.score->of(ask::Arm::kPicture)->circular.count.n);
    ++compared;
  }
  CHECK(compared == 12);
  // Fewer than 51 tasks of 24 starts: variants of words ask the same of the same picture.
  CHECK(estimate(models, 0, metric, models.all_tasks())->count.n < 51 * 24);
}

TEST_CASE("a question that one model was not asked shifts no other: equal answers compare equal") {
  RunsFolder folder;
  const plan::Plan asked = suite_plan("questions.probe");
  int count = 0;
  // Right and wrong in turns, whichever question of a family it is; the second folder lacks one.
  const auto turns = [&](const std::string&, const std::string&, int) {
    return ++count % 2 == 0 ? Said::kRight : Said::kWrong;
  };
  fake_answers(folder / "a", asked, "whole", turns);
  count = 0;
  bool is_first = true;
  fake_answers(folder / "b", asked, "lacking",
               [&](const std::string& family, const std::string& task, int episode) {
                 const Said said = turns(family, task, episode);
                 const bool lacks = is_first && family == "there";
                 if (lacks) is_first = false;
                 return lacks ? Said::kNotAsked : said;
               });
  const Benchmark models = models_as_policies(loaded({folder / "a", folder / "b"}));
  const auto compared = compare(models, 0, 1, {.metrics = {"understanding.there"}});
  REQUIRE(compared.ok());
  const ComparedRow& all = compared->rows.front();
  CHECK(all.contrast.pairs.only_a == 0);
  CHECK(all.contrast.pairs.only_b == 0);
  CHECK(all.contrast.pairs.pairs() > 1000);
}

TEST_CASE("what is asked at the end of one task's episode is no question about another's") {
  const plan::Plan asked = suite_plan("questions.probe");
  std::map<std::string, std::set<std::uint32_t>> at_start, at_end;
  for (const plan::QuestionRecord& question : asked.questions()) {
    const bool is_end =
        plan::moment_of(asked.families()[question.family]) == plan::QuestionMoment::kEnd;
    (is_end ? at_end : at_start)[to_hex(plan::to_sha256(question.question_id))].insert(
        question.task);
  }
  CHECK(at_end.size() == 2 * 51);
  for (const auto& [id, tasks] : at_end) CHECK(tasks.size() == 1);
  // Of starts, tasks that differ in their words alone ask some things in common.
  CHECK(std::ranges::any_of(at_start, [](const auto& one) { return one.second.size() > 1; }));
}

}  // namespace
}  // namespace probe::report
