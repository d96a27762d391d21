// Rates of simulations against real ones, from a table: by hand, and Table IV of the paper that the
// measures are from.
#include "runtime/report/agreement.h"

#include <doctest/doctest.h>

#include <algorithm>

#include "runtime/base/file.h"
#include "tests/runtime/report/fake_runs.h"

namespace probe::report {
namespace {

// Three policies; the simulation turns the second and the third round.
const std::string kSmall =
    "source,protocol,metric,policy,task,subtask,value,trials\n"
    "P,real,success_rate,a,lift,average,0.900,10\n"
    "P,real,success_rate,b,lift,average,0.500,10\n"
    "P,real,success_rate,c,lift,average,0.200,10\n"
    "P,sim,success_rate,a,lift,average,0.800,20\n"
    "P,sim,success_rate,b,lift,average,0.100,20\n"
    "P,sim,success_rate,c,lift,average,0.410,20\n"
    "P,sim,MMRV,(3),lift,average,0.200,\n"
    "P,sim,Pearson,(3),lift,average,0.9,\n"
    "Q,sim,success_rate,a,lift,average,0.5/0.6,20\n";

RateTable parsed(const std::string& csv) {
  auto table = parse_rate_table(csv, "t.csv");
  REQUIRE_MESSAGE(table.ok(), to_text(table.failure()));
  return std::move(table).value();
}
std::string refused(const std::string& csv) {
  const auto table = parse_rate_table(csv, "t.csv");
  return table.ok() ? "fine" : table.failure().where + ": " + table.failure().message;
}

}  // namespace

TEST_CASE("a table of rates gives its violations, what it states beside them, and what no count gives") {
  const RateTable table = parsed(kSmall);
  CHECK(table.unread == std::vector<std::string>{"t.csv:10: a, sim, lift: `0.5/0.6` is no number"});
  const auto rows = agreements(table);
  REQUIRE(rows.size() == 1);
  CHECK(rows[0].policies == std::vector<std::string>{"a", "b", "c"});
  CHECK(rows[0].agreement.violation == doctest::Approx(0.2));
  CHECK(rows[0].agreement.violation_by_trials.has_value());
  const auto stated = stated_agreements(table, rows);
  REQUIRE(stated.size() == 2);
  CHECK(stated[0].is_close);
  CHECK_FALSE(stated[1].is_close);
  const auto impossible = impossible_rates(table);
  REQUIRE(impossible.size() == 1);
  CHECK(impossible[0] ==
        "t.csv:7: c, sim, lift: 0.410 is no count of 20 trials; nearest: 8 (0.4000) and 9 (0.4500)");
  const std::string text = agreement_text(table);
  CHECK_MESSAGE(text.find("P: 1 of 2 figures are what these rates give, to 0.003") != text.npos, text);
  CHECK_MESSAGE(text.find("t.csv:9: Pearson of lift, sim: 0.9 is written") != text.npos, text);
}

TEST_CASE("real rates of the same source come first, else the first in the file") {
  const RateTable table = parsed(kSmall +
                                 "R,sim,success_rate,a,lift,average,0.9,\n"
                                 "R,sim,success_rate,b,lift,average,0.5,\n"
                                 "R,sim,success_rate,c,lift,average,0.2,\n");
  const auto rows = agreements(table);
  REQUIRE(rows.size() == 2);
  CHECK(rows[1].source == "R");
  CHECK(rows[1].agreement.violation == 0);
  CHECK_FALSE(rows[1].agreement.violation_by_trials);
}

TEST_CASE("two policies are no agreement, and another layout is refused with its place") {
  CHECK(agreements(parsed(kSmall.substr(0, kSmall.find("P,sim,success_rate,c")))).empty());
  CHECK(refused("policy,metric,avg\n") ==
        "t.csv:1: a table of rates has the columns source, protocol, metric, policy, task, subtask and "
        "value, and no `source` is here");
  const std::string header = kSmall.substr(0, kSmall.find('\n') + 1);
  CHECK(refused(header) == "t.csv: holds no row of figures");
  CHECK(refused(header + "P,real,success_rate,a,lift,average,0.9\n") ==
        "t.csv:2: 7 cells where the first line has 8");
  CHECK(refused(header + "P,real,success_rate,a,lift,average,1.9,10\n") ==
        "t.csv:2: `1.9` is no rate from 0 to 1");
  CHECK(refused(header + "P,real,success_rate,a,lift,average,0.9,ten\n") ==
        "t.csv:2: `ten` is no number of trials");
}

TEST_CASE("a table that says a thing twice, or not where it is looked for, is refused with its place") {
  const std::string header = kSmall.substr(0, kSmall.find('\n') + 1);
  CHECK(refused(kSmall + "P,sim,success_rate,b,lift,average,0.7,20\n") ==
        "t.csv:11: b, sim, lift: success_rate of this source is on line 6 already");
  CHECK(refused(kSmall + "P,sim,MMRV,(3),lift,average,0.3,\n") ==
        "t.csv:11: (3), sim, lift: MMRV of this source is on line 8 already");
  CHECK(refused("source,protocol,metric,policy,task,subtask,value,value\n"
                "P,real,success_rate,a,lift,,0.9,0.5\n") ==
        "t.csv:1: the column `value` is here twice");
  CHECK(refused(header + "P,real,success_rate,,lift,average,0.9,10\n") ==
        "t.csv:2: a row has no policy");
  CHECK(refused(header + "\"P\nQ\",real,success_rate,a,lift,average,0.9,10\n") ==
        "t.csv:2: a quote is not closed on its line");
  // Of a row that is left out another may tell the value.
  CHECK(refused(kSmall + "Q,sim,success_rate,a,lift,average,0.55,20\n") == "fine");
  std::string lines = kSmall;
  std::ranges::replace(lines, '\n', '\r');
  CHECK(refused(lines) == "t.csv:1: lines end in a carriage return alone: save it with line feeds");
}

TEST_CASE("columns that are called alike are one, however sources divide the name") {
  const std::string header = kSmall.substr(0, kSmall.find('\n') + 1);
  const std::string table = header +
                            "P,real,success_rate,a,pick_can,,0.9,10\n"
                            "P,real,success_rate,b,pick_can,average,0.5,10\n"
                            "P,real,success_rate,c,pick,can,0.2,10\n"
                            "Q,sim,success_rate,a,pick_can,average,0.8,20\n"
                            "Q,sim,success_rate,b,pick_can,,0.1,20\n"
                            "Q,sim,success_rate,c,pick,can,0.4,20\n"
                            "Q,sim,MMRV,(3),pick_can,,0.2,\n";
  const RateTable read = parsed(table);
  const auto rows = agreements(read);
  REQUIRE(rows.size() == 1);
  CHECK(rows[0].policies == std::vector<std::string>{"a", "b", "c"});
  CHECK(rows[0].without_simulated.empty());
  REQUIRE(stated_agreements(read, rows).size() == 1);
  CHECK(stated_agreements(read, rows)[0].is_close);
  CHECK(refused(table + "Q,sim,success_rate,b,pick,can,0.7,20\n") ==
        "t.csv:9: b, sim, pick_can: success_rate of this source is on line 6 already");
}

TEST_CASE("a table in UTF-16 is told as such, in either order, with and without a mark") {
  for (const bool is_big : {false, true}) {
    std::string wide;
    for (const char c : kSmall) {
      if (is_big) wide += '\0';
      wide += c;
      if (!is_big) wide += '\0';
    }
    CHECK(refused(wide) == "t.csv: is in UTF-16: save it as UTF-8");
    CHECK(refused((is_big ? "\xfe\xff" : "\xff\xfe") + wide) ==
          "t.csv: is in UTF-16: save it as UTF-8");
  }
}

TEST_CASE("values that are no number, and policies with one rate of two, are left out by name") {
  for (const char* value : {"nan", "NaN", "inf", "-inf", "1e9", "9e-1", "0x1", "90%", "+0.9", ""}) {
    CAPTURE(value);
    const std::string real = "P,real,success_rate,d,lift,average,";
    const RateTable table = parsed(kSmall + real + value +
                                   ",10\nP,sim,success_rate,d,lift,average,0.3,20\n"
                                   "P,real,success_rate,e,lift,average,0.3,10\n");
    CHECK(std::ranges::find(table.unread, "t.csv:11: d, real, lift: `" + std::string(value) +
                                              "` is no number") != table.unread.end());
    if (value != std::string("nan")) continue;  // they are all left out alike
    const auto rows = agreements(table);
    REQUIRE(rows.size() == 1);
    CHECK(rows[0].policies == std::vector<std::string>{"a", "b", "c"});
    CHECK(rows[0].without_real == std::vector<std::string>{"d"});
    CHECK(rows[0].without_simulated == std::vector<std::string>{"e"});
    const std::string text = agreement_text(table);
    CHECK_MESSAGE(text.find("P, sim, lift: no real rate of d\n") != text.npos, text);
    CHECK_MESSAGE(text.find("P, sim, lift: no simulated rate of e\n") != text.npos, text);
    CHECK_MESSAGE(text.find("the rates of 3 policies give") != text.npos, text);
    CHECK(agreement_json(table)["agreement"][0]["without_real"].dump() == "[\"d\"]");
  }
  for (const char* value : {"1.5", "-0.1", "1000000000"})
    CHECK(refused(kSmall + "P,real,success_rate,d,lift,average," + value + ",10\n") ==
          "t.csv:11: `" + std::string(value) + "` is no rate from 0 to 1");
}

TEST_CASE(
    "runs stand beside real rates by name and set; a part of a set, or a name twice, is told") {
  const plan::Plan plan = suite_plan();
  RunsFolder folder;
  const std::vector<std::string> dirs = {folder / "a", folder / "b", folder / "c"};
  for (std::size_t i = 0; i < dirs.size(); ++i) {
    fake_run(dirs[i], plan, std::string(1, static_cast<char>('a' + i)),
             {.tasks = {"carrot_on_plate"}, .last = i == 0 ? 11 : 23}, always(i == 0));
  }
  const std::string real =
      "source,protocol,metric,policy,task,subtask,value,trials\n"
      "P,real,success_rate,a,core,,0.900,10\nP,real,success_rate,b,core,,0.500,10\n"
      "P,real,success_rate,c,core,,0.200,10\n";
  const auto benchmark = load(dirs);
  REQUIRE_MESSAGE(benchmark.ok(), to_text(benchmark.failure()));
  RateTable table = parsed(real);
  const std::vector<std::string> said = add_runs(table, *benchmark);
  const auto rows = agreements(table);
  REQUIRE(rows.size() == 1);
  CHECK(rows[0].protocol == kTheseRuns);
  CHECK(rows[0].policies == std::vector<std::string>{"a", "b", "c"});
  REQUIRE(said.size() == 3);
  std::size_t planned = 0;
  std::vector<std::string> core;
  for (const plan::SetRecord& set : plan.sets()) {
    if (plan.text(set.name) != "core") continue;
    for (const std::uint32_t task : plan.members(set)) {
      planned += plan.episodes(plan.suites()[0], task).size();
      core.emplace_back(plan.text(plan.tasks()[task].name));
    }
  }
  CHECK(said[0] ==
        "`a` has 12 of " + std::to_string(planned) + " starts of `core`: its rates are of these");

  // Whole as far as the plan knows, which may be of some tasks alone: the table's own simulations
  // have more trials.
  const std::string simulated =
      real + "P,sim,success_rate,a,core,average,0.9,1000\nP,sim,success_rate,b,core,,0.4,2000\n";
  fake_run(folder / "whole", plan, "b", {.tasks = core, .last = 23}, always(false));
  const std::vector<std::string> whole = {folder / "whole"};
  const auto fewer = load(whole);
  REQUIRE_MESSAGE(fewer.ok(), to_text(fewer.failure()));
  table = parsed(simulated);
  CHECK(add_runs(table, *fewer)[0] == "`b` has " + std::to_string(planned) +
                                          " starts of `core` (the table's simulated rates: 1000 or "
                                          "more): its rates are of these");
  table = parsed(real);
  for (const std::string& line : add_runs(table, *fewer))
    CHECK_MESSAGE(line.find("its rates are of these") == line.npos, line);

  // Two folders of one name that cannot be one run.
  fake_run(folder / "d", plan, "c", {.tasks = {"carrot_on_plate"}, .content = "other"},
           always(true));
  const std::vector<std::string> more = {dirs[0], dirs[1], dirs[2], folder / "d"};
  const auto twice = load(more);
  REQUIRE_MESSAGE(twice.ok(), to_text(twice.failure()));
  table = parsed(real);
  const std::vector<std::string> of_twice = add_runs(table, *twice);
  CHECK(std::ranges::count_if(of_twice, [](const std::string& line) {
          return line.find("is left out: another of the runs has its name") != line.npos;
        }) == 2);
  CHECK(agreements(table).empty());
}

TEST_CASE("Table IV of arXiv:2405.05941 is redone to 0.003, and nine of its rates are no counts") {
  const auto csv = read_file(VLAPROBE_SOURCE_DIR "/../shared/reference/google/google_table.csv");
  if (!csv) {
    MESSAGE("skipped: the published numbers of the Google robot are not on this machine");
    return;
  }
  const RateTable table = parsed(*csv);
  CHECK(table.figures.size() + table.unread.size() == 408);
  const auto rows = agreements(table);
  const std::string source = "arXiv:2405.05941v1 Table IV";
  std::size_t of_table = 0, redone = 0;
  for (const StatedAgreement& one : stated_agreements(table, rows)) {
    if (one.stated->source != source) continue;
    ++of_table;
    redone += one.is_close;
    CAPTURE(one.stated->line);
    CHECK(one.is_close);
  }
  CHECK(of_table == 36);  // two measures of nine columns under two protocols
  CHECK(redone == of_table);
  std::size_t impossible = 0;
  for (const std::string& sentence : impossible_rates(table)) {
    const std::size_t colon = sentence.find(".csv:") + 5;
    const auto line = static_cast<std::size_t>(std::stoul(sentence.substr(colon)));
    const auto figure = std::ranges::find(table.figures, line, &PublishedFigure::line);
    impossible += figure != table.figures.end() && figure->source == source;
  }
  CHECK(impossible == 9);
}

}  // namespace probe::report
