// The verb `report` on small real runs: what the page holds, what is refused, and the page of real
// results in a browser.
#include <doctest/doctest.h>

#include <filesystem>

#include "runtime/base/json.h"
#include "tests/runtime/cli/program.h"

using namespace probe::test;
using json = probe::Json;

namespace {

// Two policies at two starts of a task and of one of its variants; the second run has videos.
struct RunOnce {
  Sandbox box;
  Outcome wrong = box.vlaprobe(
      "run $SUITE --tasks carrot_on_plate_distract --policy wrong --episodes 0-1 --seeds 42 "
      "--assets $ASSETS -o 'a run'");
  Outcome expert = box.vlaprobe(
      "run $SUITE --tasks 'carrot_on_plate*t' --policy expert --episodes 0-0 --video all "
      "--assets $ASSETS -o expert");
};

const Sandbox& sandbox() {
  static const RunOnce once;
  REQUIRE_MESSAGE(once.wrong.exit == 0, once.wrong.err);
  REQUIRE_MESSAGE(once.expert.exit == 0, once.expert.err);
  return once.box;
}

json document(const std::string& page, const std::string& id) {
  const std::string open = "<script type=\"application/json\" id=\"" + id + "\">";
  const auto begin = page.find(open);
  REQUIRE(begin != std::string::npos);
  const auto end = page.find("</script>", begin);
  const json value = json::parse(page.substr(begin + open.size(), end - begin - open.size()));
  REQUIRE(!value.is_discarded());
  return value;
}

}  // namespace

TEST_CASE("a report is one page with every episode, its timeline, its video and why") {
  const Outcome report =
      sandbox().vlaprobe("report 'a run' expert --title 'Two <policies>' -o page.html");
  REQUIRE_MESSAGE(report.exit == 0, report.err);
  CHECK(report.out.empty());
  const std::string page = read_file(sandbox() / "page.html");
  const json data = document(page, "data");
  CHECK(data["title"] == "Two <policies>");
  CHECK(page.find("Two <policies>") == std::string::npos);
  CHECK(data["policies"].size() == 2);
  const std::size_t count = data["episodes"]["count"].get<std::size_t>();
  CHECK(count >= 3);
  const json timelines = document(page, "timelines");
  REQUIRE(timelines["e"].size() == count);
  for (const json& line : timelines["e"])
    CHECK(line.get<std::string>().find("d:") != std::string::npos);
  const json whys = document(page, "whys");
  CHECK(whys["e"].size() == count);
  CHECK(whys["e"]["0"][0][0] == "success");
  // Videos are linked from where the page lies.
  bool linked = false;
  for (const json& text : data["strings"]) {
    const auto path = sandbox() / text.get<std::string>();
    linked = linked || (path.extension() == ".mp4" && std::filesystem::exists(path));
  }
  CHECK(linked);
}

TEST_CASE("a report of real runs has every panel in a browser") {
  if (!std::filesystem::exists("/usr/bin/chromium")) {
    MESSAGE("SKIPPED: the report page was not opened, chromium is not installed");
    return;
  }
  const Outcome report = sandbox().vlaprobe("report 'a run' expert -o real.html");
  REQUIRE_MESSAGE(report.exit == 0, report.err);
  const std::string build = VLAPROBE_BINARY_DIR "/report_page";
  const std::string command =
      "timeout 180 node '" VLAPROBE_SOURCE_DIR "/runtime/report/page/test/browser.mjs' '" + build +
      "' '" + build + "/real' given '" + (sandbox() / "real.html").string() + "' >'" + build +
      "/real.log' 2>&1";
  const int status = std::system(command.c_str());
  INFO(read_file(build + "/real.log"));
  CHECK(status == 0);
}

TEST_CASE("a report without traces says of every episode how to ask why") {
  const Outcome report = sandbox().vlaprobe("report expert --no-traces -o bare.html");
  REQUIRE_MESSAGE(report.exit == 0, report.err);
  const std::string page = read_file(sandbox() / "bare.html");
  CHECK(document(page, "timelines").empty());
  CHECK(document(page, "whys").empty());
}

TEST_CASE("a report refuses what it cannot read, and names it") {
  const Outcome nothing = sandbox().vlaprobe("report expert");
  CHECK(nothing.exit == 1);
  CHECK(nothing.err.find("-o page.html") != std::string::npos);
  const Outcome absent = sandbox().vlaprobe("report expert no_such_run -o page2.html");
  CHECK(absent.exit == 2);
  CHECK(absent.err.find("no_such_run") != std::string::npos);
  CHECK(!std::filesystem::exists(sandbox() / "page2.html"));
  const Outcome table = sandbox().vlaprobe("report expert --with $SUITE -o page2.html");
  CHECK(table.exit == 1);
  CHECK(table.err.find("intact.probe") != std::string::npos);
  const Outcome folder = sandbox().vlaprobe("report expert -o no/such/page.html");
  CHECK(folder.exit == 2);
  CHECK(folder.err.find("no/such/page.html") != std::string::npos);
}

TEST_CASE("the numbers of a report are there as JSON too") {
  const Outcome report = sandbox().vlaprobe("report 'a run' expert --json");
  REQUIRE_MESSAGE(report.exit == 0, report.err);
  const json data = json::parse(report.out);
  REQUIRE(!data.is_discarded());
  CHECK(data["format"] == "vlaprobe-report");
  CHECK(data["tables"].contains("main"));
}

TEST_CASE("a report is not written over a part of a run") {
  for (const char* part : {"results.sqlite", "suite.plan", "lock", "traces/x.html"}) {
    const std::string path = std::string("expert/") + part;
    const Outcome refused = sandbox().vlaprobe("report 'a run' --format csv -o " + path);
    CHECK(refused.exit == 1);
    CHECK(refused.err.find("belongs to the run") != std::string::npos);
  }
  CHECK(sandbox().vlaprobe("report expert --format csv -o expert/tables.csv").exit == 0);
}

TEST_CASE("a published table's slips are told on stderr") {
  const Outcome told = sandbox().vlaprobe(
      "report expert --format csv --with \"$(printf 'policy,metric,orignal\\npi0,sucess,1\\n' > "
      "slips.csv; echo slips.csv)\"");
  CHECK(told.exit == 0);
  CHECK(told.err.find("warning: slips.csv:1: column `orignal`") != std::string::npos);
  CHECK(told.err.find("warning: slips.csv:2: metric `sucess`") != std::string::npos);
}

TEST_CASE("a policy's name is a line of text") {
  for (const char* name : {"\"$(printf 'a\\033[2Jb')\"", "\"$(printf 'a\\377')\"", "'a\nb'"}) {
    const Outcome refused = sandbox().vlaprobe(
        std::string("run $SUITE --tasks carrot_on_plate --policy null --assets $ASSETS -o named "
                    "--name ") +
        name);
    CHECK(refused.exit == 1);
    CHECK(refused.err.find("without control characters") != std::string::npos);
    CHECK(refused.err.find('\x1b') == std::string::npos);
  }
}

TEST_CASE("a report says in which step a later sentence was said, and which never was") {
  const Sandbox box;
  write_file(box / "turns.probe",
             "use \"" VLAPROBE_SOURCE_DIR
             "/suite/intact.probe\"\n"
             "task in_turn like carrot_on_plate {\n"
             "  horizon 12 steps\n"
             "  then say drop_on when step >= 3\n"
             "  then say put when grasped(source)\n"
             "}\n"
             "suite mine trained on bridge_v2 { tasks { in_turn }; seeds 1 }\n");
  const Outcome ran = box.vlaprobe("run turns.probe --suite mine --episodes 0-0 --policy null -o run");
  REQUIRE_MESSAGE(ran.exit == 0, ran.err);
  const Outcome told = box.vlaprobe("report run --json");
  REQUIRE_MESSAGE(told.exit == 0, told.err);
  std::string text = told.out;
  std::erase_if(text, [](char c) { return c == ' ' || c == '\n'; });
  CHECK_MESSAGE(contains(text, "\"told\":{\"0\":[4]}"), told.out);
  // What no episode came to is a finding of the delivery.
  CHECK(contains(told.out, "was said in none of 1 episode"));
  CHECK(box.vlaprobe("report run -o page.html").exit == 0);
}
