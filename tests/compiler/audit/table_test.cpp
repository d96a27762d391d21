// Published percentages that a category of so many episodes can and cannot give.
#include "compiler/audit/table.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <sstream>

#include "compiler/diag/text.h"

using namespace probe;

namespace {

struct Suite {
  Compilation compilation;
  plan::Plan plan;
};

const Suite& published() {
  static const Suite suite = [] {
    const std::string file = VLAPROBE_SOURCE_DIR "/suite/intact.probe";
    auto compiled =
        build(std::span(&file, 1), {.asset_root = VLAPROBE_SOURCE_DIR "/assets", .suite = ""});
    REQUIRE(compiled.ok());
    auto plan = plan::Plan::from_bytes(std::move(compiled->plan));
    REQUIRE(plan.ok());
    return Suite{std::move(compiled).value(), std::move(plan).value()};
  }();
  return suite;
}

Result<audit::Audit> checked(const std::string& table) {
  audit::Audit audit;
  PROBE_TRY(
      audit::check_table(audit, published().compilation, published().plan, 0, table, "paper.csv"));
  return audit;
}

}  // namespace

TEST_CASE("numbers that the category's episodes can give are no finding") {
  // 4 tasks of 24 starts and 3 seeds: 25 / 288, 287 / 288, and all.
  const auto fine =
      checked("policy,metric,ood_source\nx,success,8.7\ny,success,99.7\nz,grasp,100\n");
  REQUIRE(fine.ok());
  CHECK(fine->findings.empty());
  CHECK(fine->unchecked.empty());
}

TEST_CASE("numbers that they cannot give are counted, with the tasks that would and the place") {
  // 7 / 360 and 17 / 360: over five tasks.
  const auto odd = checked("policy,total,ood_target\nx,5.0,1.9\ny,6.0,4.7\nz,6.0,50\n");
  REQUIRE(odd.ok());
  REQUIRE(odd->findings.size() == 1);
  const audit::Finding& finding = odd->findings[0];
  CHECK(finding.kind == audit::Kind::kTable);
  CHECK(finding.tasks.size() == 4);
  CHECK(finding.message ==
        "2 of the 3 percentages of `ood_target` in paper.csv are no averages over its 4 tasks (288 "
        "episodes); all are over 5 such tasks");
  CHECK(finding.place.file.ends_with("suite/intact.probe"));
  CHECK(finding.place.line > 100);
  CHECK(odd->unchecked == std::vector<std::string>{"total"});
}

TEST_CASE("a table that is about something else is refused") {
  const auto none = checked("policy,total\nx,5.0\n");
  REQUIRE_FALSE(none.ok());
  CHECK(none.failure().where == "paper.csv");
  CHECK_FALSE(checked("").ok());
}

TEST_CASE("the paper's own table fits its categories but for one") {
  std::ifstream in(VLAPROBE_SOURCE_DIR "/../shared/reference/paper_table_main.csv");
  if (!in) {
    MESSAGE("no published table on this machine");
    return;
  }
  std::stringstream text;
  text << in.rdbuf();
  const auto paper = checked(text.str());
  REQUIRE(paper.ok());
  REQUIRE(paper->findings.size() == 1);
  MESSAGE(paper->findings[0].message);
  CHECK(paper->findings[0].message.find("`ood_target`") != std::string::npos);
  CHECK(paper->findings[0].message.ends_with("all are over 5 such tasks"));
}

TEST_CASE(
    "of the Google robot's Table IV no trials give three percentages, and six of the variants") {
  const std::string folder = VLAPROBE_SOURCE_DIR "/suite/";
  const std::string file = folder + "google.probe";
  const auto of = [&](const std::string& name, const std::string& csv) {
    auto compiled =
        build(std::span(&file, 1), {.asset_root = VLAPROBE_SOURCE_DIR "/assets", .suite = name});
    REQUIRE(compiled.ok());
    REQUIRE_MESSAGE(compiled->ok, render_text(compiled->diagnostics, compiled->sources));
    const auto plan = plan::Plan::from_bytes(std::move(compiled->plan));
    REQUIRE(plan.ok());
    std::ifstream in(folder + "google/" + csv);
    const std::string table((std::istreambuf_iterator<char>(in)), {});
    audit::Audit audit;
    REQUIRE(audit::check_table(audit, *compiled, *plan, 0, table, csv).ok());
    CHECK(audit.unchecked.empty());
    std::map<std::string, int> odd;  // by column
    for (const audit::Finding& finding : audit.findings) {
      CHECK(finding.kind == audit::Kind::kTable);
      const std::size_t at = finding.message.find('`') + 1;
      odd[finding.message.substr(at, finding.message.find('`', at) - at)] +=
          std::stoi(finding.message);
    }
    return odd;
  };
  const auto sum = [](const std::map<std::string, int>& odd) {
    int all = 0;
    for (const auto& [column, count] : odd) all += count;
    return all;
  };
  const auto matching = of("google_visual_matching", "published_visual_matching.csv");
  CHECK(matching ==
        std::map<std::string, int>{{"drawer_open", 1}, {"drawer_close", 1}, {"drawer", 1}});
  CHECK(sum(matching) == 3);
  CHECK(sum(of("google_variants", "published_variants.csv")) == 6);
}
