#include "runtime/report/tables.h"

#include <fstream>

#include "runtime/report/page_data.h"
#include "runtime/report/table_text.h"
#include "tests/runtime/report/fake_runs.h"

namespace probe::report {
namespace {

constexpr char kBase[] = "carrot_on_plate";
constexpr char kVariant[] = "carrot_on_plate_lang_action";

// Succeeds on every start of the original and on the first eight of the variant.
Outcome loses_words(const std::string& task, int episode, int) {
  return {.success = task == kBase || episode < 8};
}

struct Made {
  RunsFolder folder;
  Benchmark benchmark;
  explicit Made(const Script& script, const FakeRunOptions& options, const char* policy = "pi0") {
    const plan::Plan plan = suite_plan();
    fake_run(folder / "a", plan, policy, options, script);
    const std::vector<std::string> dirs = {folder / "a"};
    auto loaded = load(dirs);
    REQUIRE(loaded.ok());
    benchmark = std::move(loaded).value();
  }
};

}  // namespace

// 16 of 24 starts are lost and none is won: 2 / 2^16.
TEST_CASE("a variant is compared with its baseline start by start") {
  const Made made(loses_words, {.tasks = {kBase, kVariant}});
  const int success = made.benchmark.find_metric("success");
  const Contrast c =
      variant_contrast(made.benchmark, 0, success, made.benchmark.find_task(kVariant));
  CHECK(c.pairs.both == 8);
  CHECK(c.pairs.only_b == 16);
  CHECK(c.difference == doctest::Approx(-16.0 / 24));
  CHECK(c.here.p == doctest::Approx(2.0 / 65536));
  CHECK(c.anew.p == doctest::Approx(2.0 / 65536));
  CHECK(c.here.interval.high < 0);
  CHECK(c.anew.interval.high < 0);
}

TEST_CASE("seeds that repeat a start add no evidence") {
  const Made made(loses_words, {.tasks = {kBase, kVariant}, .seeds = {42, 7, 314}});
  const int success = made.benchmark.find_metric("success");
  const Contrast c =
      variant_contrast(made.benchmark, 0, success, made.benchmark.find_task(kVariant));
  CHECK(c.pairs.pairs() == 72);
  CHECK(c.starts == 24);
  CHECK(c.here.p == doctest::Approx(2.0 / 65536));
  CHECK(c.anew.p == doctest::Approx(2.0 / 65536));
}

TEST_CASE("a task of another scene is compared unpaired, and left out of its category") {
  const Made made([](const std::string& task, int,
                     int) { return Outcome{.success = task == "put_eggplant_in_basket"}; },
                  {.tasks = {"put_eggplant_in_basket", "eggplant_on_sponge_clean"}});
  const Benchmark& b = made.benchmark;
  const int success = b.find_metric("success");
  const int task = b.find_task("eggplant_on_sponge_clean");
  CHECK(b.tasks[static_cast<std::size_t>(task)].unpaired.find("scene") != std::string::npos);
  const Contrast c = variant_contrast(b, 0, success, task);
  CHECK(!c.paired);
  CHECK(c.difference == -1);
  CHECK(c.here.p < 1e-9);
  CHECK(c.anew.p == c.here.p);
  int left_out = 0;
  CHECK(category_contrast(b, 0, success, {task}, left_out).first.n == 0);
  CHECK(left_out == 1);
}

TEST_CASE("adjusted values are at least the raw ones, and every percentage has its count") {
  const Made made(loses_words, {.tasks = {kBase, kVariant, "carrot_on_plate_distract"}});
  const Tables tables = make_tables(made.benchmark);
  REQUIRE(!tables.deltas.empty());
  for (const DeltaRow& row : tables.deltas) {
    CHECK(row.contrast.here.adjusted >= row.contrast.here.p);
    CHECK(row.contrast.anew.adjusted >= row.contrast.anew.p);
  }
  for (const CategoryDeltaRow& row : tables.category_deltas) {
    CHECK(row.contrast.here.adjusted >= row.contrast.here.p);
    CHECK(row.contrast.anew.adjusted >= row.contrast.anew.p);
  }
  const std::string csv = table_text(made.benchmark, tables, {}, TableFormat::kCsv);
  CHECK(csv.find("policy,metric,avg,original,ood_source") == 0);
  CHECK(csv.find("pi0,success,") != std::string::npos);
  CHECK(csv.find(",40,72,") != std::string::npos);  // avg_k, avg_n
  const auto again = parse_published(csv, "ours.csv");
  REQUIRE_MESSAGE(again.ok(), to_text(again.failure()));
  CHECK(again->columns.size() == 12);
  CHECK(again->rows[0].cells[0]->text == "100.0");
}

// 54 of 96 is 56.25 %.
TEST_CASE("halves of a percentage are rounded alike in every format") {
  const Made made(
      [](const std::string& task, int episode, int) {
        return Outcome{.success = episode < (task == kBase || task.ends_with("color") ? 13 : 14)};
      },
      {.tasks = {"carrot_on_plate", "carrot_on_plate_lang_action", "carrot_on_plate_lang_color",
                 "carrot_on_plate_lang_common"}});
  const Tables tables = make_tables(made.benchmark);
  const std::string csv = table_text(made.benchmark, tables, {}, TableFormat::kCsv);
  const std::string latex = table_text(made.benchmark, tables, {}, TableFormat::kLatex);
  const auto all = estimate(made.benchmark, 0, made.benchmark.find_metric("success"),
                            made.benchmark.all_tasks());
  REQUIRE(all->count.n == 96);
  CHECK(all->count.k == 54);
  CHECK(csv.find("pi0,success,56.3,") != std::string::npos);
  CHECK(latex.find("\\cell{56.3}{54/96}") != std::string::npos);
}

TEST_CASE("a name that would obey a terminal or break a line is made printable") {
  const Made made(loses_words, {.tasks = {kBase}, .last = 1}, "evil\x1b[2J\nend");
  CHECK(made.benchmark.policies[0].label == "evil [2J end");
}

TEST_CASE("LaTeX and JSON hold the names as text") {
  const Made made(loses_words, {.tasks = {kBase, kVariant}}, "my_policy & 50% {x}");
  const Tables tables = make_tables(made.benchmark);
  const std::string latex = table_text(made.benchmark, tables, {}, TableFormat::kLatex);
  CHECK(latex.find("my\\_policy \\& 50\\% \\{x\\}") != std::string::npos);
  CHECK(latex.find("\\toprule") != std::string::npos);
  CHECK(latex.find("\\cell{33.3}{8/24}{") != std::string::npos);
  const auto json = Json::parse(table_text(made.benchmark, tables, {}, TableFormat::kJson));
  CHECK(json["main"][0]["policy"] == "my_policy & 50% {x}");
  CHECK(json["task_differences"][0]["pairs"].contains("both"));
}

// The baseline wins all of 24 starts against three variants that lie in the same places.
TEST_CASE("every table of differences answers both questions by name") {
  const Made made(
      [](const std::string& task, int, int) { return Outcome{.success = task == kBase}; },
      {.tasks = {kBase, kVariant, "carrot_on_plate_lang_color"}});
  const Tables tables = make_tables(made.benchmark);
  const auto json = Json::parse(table_text(made.benchmark, tables, {}, TableFormat::kJson));
  REQUIRE(!json["category_differences"].empty());
  for (const char* table : {"category_differences", "task_differences"}) {
    for (const auto& row : json[table]) {
      for (const char* question : {"on_these_starts", "for_starts_never_tried"}) {
        CHECK(row[question].contains("p_adjusted"));
        CHECK(row[question]["low"].get<double>() <= row["points"].get<double>());
      }
    }
  }
  // The older keys of a category: p of these starts, the interval of starts never tried.
  const auto& category = json["category_differences"][0];
  CHECK(category["p"] == category["on_these_starts"]["p"]);
  CHECK(category["low"] == category["for_starts_never_tried"]["low"]);
  const std::string csv = table_text(made.benchmark, tables, {}, TableFormat::kDifferencesCsv);
  CHECK(csv.find("kind,of,against,scope,metric,k,n,against_k,against_n,points,"
                 "on_these_starts_units,") == 0);
  CHECK(csv.find("task,pi0,carrot_on_plate,carrot_on_plate_lang_action,success,0,24,24,24,-100.0,"
                 "24,-100.0,") != std::string::npos);
  const std::string latex = table_text(made.benchmark, tables, {}, TableFormat::kLatex);
  CHECK(latex.find("$p$, these & $p$, new") != std::string::npos);
  const auto page = page_data(made.benchmark, tables, {.title = "", .models = false});
  for (const char* table : {"deltas", "category_deltas", "language", "gap"}) {
    REQUIRE(!page["tables"][table].empty());
    CHECK(page["tables"][table][0]["on_these_starts"].contains("p"));
    CHECK(page["tables"][table][0]["for_starts_never_tried"]["units"] == 24);
  }
}

TEST_CASE("the gap is that of the same episodes") {
  const Made made([](const std::string&, int episode,
                     int) { return Outcome{.success = episode % 2 == 0, .intention = true}; },
                  {.tasks = {kBase}});
  const Tables tables = make_tables(made.benchmark);
  REQUIRE(!tables.gap.empty());
  CHECK(tables.gap[0].contrast.difference == doctest::Approx(0.5));
  CHECK(tables.gap[0].contrast.pairs.only_b == 0);
}

TEST_CASE("floors that were measured before are read, with a warning if of another plan") {
  Made made(always(true), {.tasks = {kBase}});
  Tables tables = make_tables(made.benchmark);
  const std::string path = made.folder / "floors.csv";
  std::ofstream(path) << "# plan 00\ntask,policy,episodes,intention,grasp,success,wrong\n"
                         "carrot_on_plate,expert,24,24,24,23,0\ncarrot_on_plate,null,24,0,0,0,0\n";
  REQUIRE(add_floors(path, made.benchmark, tables).ok());
  const int success = made.benchmark.find_metric("success");
  bool found = false;
  for (const FloorRow& row : tables.floors) {
    if (row.metric != success) continue;
    found = true;
    REQUIRE(row.ceiling);
    CHECK(row.ceiling->count.k == 23);
    CHECK(row.floor->count.k == 0);
  }
  CHECK(found);
  CHECK(made.benchmark.notes.back().text.find("another plan") != std::string::npos);
  std::ofstream(path) << "task,policy\nx,y\n";
  CHECK(add_floors(path, made.benchmark, tables).failure().where == path + ":1");
}

}  // namespace probe::report
