#include "runtime/report/published.h"

#include "runtime/report/published_match.h"

#include <doctest/doctest.h>

#include <filesystem>

namespace probe::report {

// A published 43.9 % of 500 episodes: 219 are 43.8 and 220 are 44.0.
TEST_CASE("a percentage that no count gives is told with the nearest ones") {
  const auto flag = impossible({43.9, 1, "43.9"}, 1, 500);
  REQUIRE(flag);
  CHECK(flag->find("219 (43.80 %) and 220 (44.00 %)") != std::string::npos);
  const auto tasks = impossible({66.1, 1, "66.1"}, 4, 72);
  REQUIRE(tasks);
  CHECK(tasks->find("5 tasks could give it: 238 of 360") != std::string::npos);
  CHECK(!impossible({50, 1, "50.0"}, 4, 72));
  CHECK(!impossible({50, 1, "50.0"}, 0, 72));
}

TEST_CASE("the paper's layout is read with quotes, percent signs and gaps") {
  const auto table = parse_published(
      "\xef\xbb\xbfpolicy,metric,avg,original\r\n# a remark\r\n\"pi0, finetuned\",success,30.4%,\n"
      "Magma,success,21.6,-\n",
      "x.csv");
  REQUIRE_MESSAGE(table.ok(), to_text(table.failure()));
  CHECK(table->columns.size() == 2);
  CHECK(table->rows[0].policy == "pi0, finetuned");
  CHECK(table->rows[0].cells[0]->value == 30.4);
  CHECK(table->rows[0].cells[0]->decimals == 1);
  CHECK(!table->rows[0].cells[1]);
  CHECK(!table->rows[1].cells[1]);
}

TEST_CASE("another layout is refused with its line") {
  const auto where = [](std::string_view csv) {
    const auto table = parse_published(csv, "x.csv");
    return table.ok() ? std::string("fine") : table.failure().where;
  };
  CHECK(where("") == "x.csv");
  CHECK(where("a,b,c\n") == "x.csv:1");
  CHECK(where("policy,metric,avg\npi0,success\n") == "x.csv:2");
  CHECK(where("policy,metric,avg\npi0,success,lots\n") == "x.csv:2");
  CHECK(where("policy,metric,avg\npi0,success,101\n") == "x.csv:2");
  CHECK(where("policy,metric,avg\npi0,success,nan\n") == "x.csv:2");
  CHECK(where("policy,metric,avg\npi0,success,1\npi0,success,2\n") == "x.csv:3");
  CHECK(where("policy,metric,avg,original,avg\npi0,success,1,2,3\n") == "x.csv:1");
  CHECK(where("policy,metric,avg\n") == "x.csv");
}

TEST_CASE("a table of more than any page shows is refused where it gets too long") {
  const auto said = [](int rows, int columns) {
    std::string csv = "policy,metric";
    for (int k = 0; k < columns; ++k) csv += ",c" + std::to_string(k);
    for (int i = 0; i < rows; ++i) {
      csv += "\np" + std::to_string(i) + ",success";
      for (int k = 0; k < columns; ++k) csv += ",5";
    }
    const auto table = parse_published(csv, "x.csv");
    return table.ok() ? std::string() : to_text(table.failure());
  };
  CHECK(said(10'000, 1).empty());
  CHECK(said(10'001, 1) == "x.csv:10002: more than 10000 rows of percentages");
  CHECK(said(1, 1000).empty());
  CHECK(said(1, 1001) == "x.csv:1: more than 1000 columns of percentages");
  CHECK(said(201, 1000) == "x.csv:202: more than 200000 cells of percentages");
}

TEST_CASE("what the runs do not have is told with its line and the nearest name") {
  Benchmark benchmark;
  benchmark.metrics = {{"success", true, 1}};
  benchmark.categories = {{"bare", "original", {}}, {"ood_source", "OOD source", {}}};
  const auto table = parse_published(
      "# theirs\npolicy,metric,avg,orignal,ood_source\npi0,success,1,2,3\npi0,sucess,1,2,3\n",
      "x.csv");
  REQUIRE(table.ok());
  const auto columns = matched_columns(benchmark, *table);
  REQUIRE(columns.size() == 3);
  CHECK(columns[0] == 0);
  CHECK(!columns[1]);
  CHECK(columns[2] == 2);
  const std::vector<Note> notes = unmatched(benchmark, *table);
  REQUIRE(notes.size() == 2);
  CHECK(notes[0].text.find("x.csv:2: column `orignal`") == 0);
  CHECK(notes[0].text.find("did you mean `original`?") != std::string::npos);
  CHECK(notes[1].text.find("x.csv:4: metric `sucess`") == 0);
  CHECK(notes[1].text.find("did you mean `success`?") != std::string::npos);
  const auto fine = parse_published("policy,metric,all,original\npi0,success,1,2\n", "x.csv");
  CHECK(unmatched(benchmark, *fine).empty());
}

// The published OOD Target column fits five tasks, not the four that its list has: ten of its
// values are no count of 4 x 72 episodes.
TEST_CASE("the paper's own table is read and its odd column found") {
  const std::string path = VLAPROBE_SOURCE_DIR "/../shared/reference/paper_table_main.csv";
  if (!std::filesystem::exists(path)) {
    MESSAGE("skipped: the published table is not here");
    return;
  }
  const auto table = read_published(path);
  REQUIRE_MESSAGE(table.ok(), to_text(table.failure()));
  CHECK(table->rows.size() == 18);
  REQUIRE(table->columns.size() == 12);
  const std::vector<std::int64_t> tasks = {50, 4, 4, 4, 4, 4, 4, 4, 4, 6, 7, 5};
  std::vector<int> flags(tasks.size(), 0);
  for (const PublishedRow& row : table->rows) {
    for (std::size_t c = 0; c < tasks.size(); ++c)
      flags[c] += impossible(*row.cells[c], tasks[c], 72) ? 1 : 0;
  }
  int others = 0;
  for (std::size_t c = 0; c < flags.size(); ++c) {
    if (table->columns[c] != "ood_target") others += flags[c];
  }
  CHECK(flags[3] == 10);
  CHECK(others == 0);
}

}  // namespace probe::report
