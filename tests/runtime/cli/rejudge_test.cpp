// judge, why and export through the program, on a small real run.
#include <doctest/doctest.h>

#include <filesystem>

#include "runtime/base/json.h"
#include "tests/runtime/cli/program.h"

using namespace probe::test;
using json = probe::Json;

namespace {

// Two episodes of the first task, run once for all tests of this file.
struct RunOnce {
  Sandbox box;
  Outcome run = box.vlaprobe(
      "run $SUITE --tasks carrot_on_plate --policy expert --episodes 0-1 --assets $ASSETS -o run");
};

const Sandbox& sandbox() {
  static const RunOnce once;
  REQUIRE_MESSAGE(once.run.exit == 0, once.run.err);
  return once.box;
}

json parsed(const std::string& text) {
  const json value = json::parse(text);
  REQUIRE(!value.is_discarded());
  return value;
}

json rows_of(const std::string& folder) {
  const Outcome results = sandbox().vlaprobe("results " + folder + " --json");
  REQUIRE_MESSAGE(results.exit == 0, results.err);
  return parsed(results.out);
}

const std::string kSemantics = "'" VLAPROBE_SOURCE_DIR "/suite/semantics.probe'";

}  // namespace

TEST_CASE("judged under its own plan, a run has the same values and traces, bit for bit") {
  const Outcome judged =
      sandbox().vlaprobe("judge run --with run/suite.plan -o again --json --assets $ASSETS");
  REQUIRE_MESSAGE(judged.exit == 0, judged.err);
  const json report = parsed(judged.out);
  CHECK(report["same_plan"] == true);
  for (const json& metric : report["metrics"]) CHECK(metric["changed"] == 0);
  json before = rows_of("run"), after = rows_of("again");
  REQUIRE(before.size() == after.size());
  REQUIRE(before.size() >= 2);
  for (std::size_t i = 0; i < before.size(); ++i) {
    CHECK(before[i]["trace"] != after[i]["trace"]);
    before[i].erase("trace");
    after[i].erase("trace");
    CHECK(before[i] == after[i]);  // with trace_sha256: every byte that is hashed
  }
}

TEST_CASE("one run is read under every rule of semantics.probe without physics") {
  for (const std::string suite : {"released", "ever", "held", "settled", "gripper_open",
                                  "ever_let_go", "loose", "contact", "last_step", "latched"}) {
    CAPTURE(suite);
    const Outcome judged = sandbox().vlaprobe("judge run --with " + kSemantics + " --suite " +
                                              suite + " --json --assets $ASSETS");
    REQUIRE_MESSAGE(judged.exit == 0, judged.err);
    const json report = parsed(judged.out);
    CHECK(report["same_plan"] == false);
    for (const json& metric : report["metrics"]) {
      CHECK(metric["episodes"] == report["valid"]);
      CHECK(metric["before"].get<int>() - metric["lost"].get<int>() + metric["gained"].get<int>() ==
            metric["after"].get<int>());
      // What the expert let go of at the end counts no longer when nothing is latched.
      if (suite == "last_step" && metric["metric"] == "grasp") CHECK(metric["after"] == 0);
      if (suite == "released") CHECK(metric["changed"] == 0);
    }
  }
}

TEST_CASE("several rules are read at once: a line for each, or task by task for one metric") {
  const std::string judge = "judge run --with " + kSemantics + " --assets $ASSETS ";
  const Outcome table = sandbox().vlaprobe(judge + "--suite released --suite 'ever*' --suite held");
  REQUIRE_MESSAGE(table.exit == 0, table.err);
  for (const char* part :
       {"suite", "as stored", "released", "ever", "ever_let_go", "held", "grasp"})
    CHECK_MESSAGE(contains(table.out, part), part);
  CHECK(!contains(table.out, "settled"));
  const Outcome by_task = sandbox().vlaprobe(judge + "--metric success");
  REQUIRE_MESSAGE(by_task.exit == 0, by_task.err);
  CHECK(contains(by_task.out, "carrot_on_plate"));
  CHECK(contains(by_task.out, "settled"));
  // The same numbers as one suite at a time.
  const Outcome all = sandbox().vlaprobe(judge + "--suite '*' --json");
  REQUIRE_MESSAGE(all.exit == 0, all.err);
  std::size_t suites = 0;
  const json report = parsed(all.out);
  for (const json& reading : report["suites"]) {
    const Outcome one =
        sandbox().vlaprobe(judge + "--suite " + reading["suite"].get<std::string>() + " --json");
    REQUIRE_MESSAGE(one.exit == 0, one.err);
    CHECK(parsed(one.out)["metrics"] == reading["metrics"]);
    CHECK(reading["tasks"][0]["task"] == "carrot_on_plate");
    ++suites;
  }
  CHECK(suites >= 10);
  CHECK(sandbox().vlaprobe(judge + "--suite 'x*'").exit == 1);
  CHECK(sandbox().vlaprobe(judge + "--suite eve").exit == 1);
  CHECK(sandbox().vlaprobe(judge + "--metric succes").exit == 1);
  CHECK(sandbox().vlaprobe(judge + "--suite '*' -o several").exit == 1);
  CHECK(!std::filesystem::exists(sandbox() / "several"));
}

TEST_CASE("judge writes a results folder that results, why and judge read") {
  const Outcome judged = sandbox().vlaprobe("judge run --with " + kSemantics +
                                            " --suite held -o held --assets $ASSETS");
  REQUIRE_MESSAGE(judged.exit == 0, judged.err);
  CHECK(contains(judged.out, "metric"));
  CHECK(contains(judged.out, "gained"));
  const json rows = rows_of("held");
  REQUIRE(rows.size() >= 2);
  CHECK(rows[0]["task"] == "carrot_on_plate_held");
  const Outcome why = sandbox().vlaprobe("why held carrot_on_plate_held 1 --metric success");
  REQUIRE_MESSAGE(why.exit == 0, why.err);
  CHECK(contains(why.out, "5 steps"));
  const Outcome onto_itself =
      sandbox().vlaprobe("judge run --with run/suite.plan -o run --assets $ASSETS");
  CHECK(onto_itself.exit == 1);
}

TEST_CASE("a plan whose starts differ is refused, and the part that differs is named") {
  write_file(sandbox() / "lower.probe",
             "use \"" VLAPROBE_SOURCE_DIR
             "/suite/intact.probe\"\n"
             "layout lower like grid_24 { drop 40cm settle 0.5s }\n"
             "variant carrot_on_plate_lower of carrot_on_plate { layout lower }\n"
             "suite lower { tasks { carrot_on_plate_lower }; seeds 1 }\n");
  const Outcome built = sandbox().vlaprobe("build lower.probe -o lower.plan --assets $ASSETS");
  REQUIRE_MESSAGE(built.exit == 0, built.err);
  // A variant with another layout does not stand for its baseline.
  const Outcome stranger =
      sandbox().vlaprobe("judge run --with lower.plan --suite lower --assets $ASSETS");
  CHECK(stranger.exit == 1);
  CHECK(contains(stranger.err, "none of the stored tasks"));
  // The task of the same name with other starts, in a run judged with a mangled copy of the suite.
  std::filesystem::copy(
      VLAPROBE_SOURCE_DIR "/suite", sandbox() / "suite",
      std::filesystem::copy_options::recursive | std::filesystem::copy_options::overwrite_existing);
  std::string layouts = read_file(sandbox() / "suite/layouts.probe");
  const std::size_t at = layouts.find("drop 50cm");
  REQUIRE(at != std::string::npos);
  for (std::size_t p = at; p != std::string::npos; p = layouts.find("drop 50cm", p))
    layouts.replace(p, 9, "drop 40cm");
  write_file(sandbox() / "suite/layouts.probe", layouts);
  const Outcome refused =
      sandbox().vlaprobe("judge run --with suite/intact.probe -o refused --assets $ASSETS");
  CHECK(refused.exit == 1);
  CHECK(contains(refused.err, "carrot_on_plate episode 0"));
  CHECK(contains(refused.err, "another start"));
  CHECK(contains(refused.err, "drop"));
  CHECK(contains(refused.err, "pose of the source"));
  CHECK(!std::filesystem::exists(sandbox() / "refused"));
}

TEST_CASE("why explains each metric by source lines with measured numbers") {
  const Outcome why = sandbox().vlaprobe("why run carrot_on_plate 1");
  REQUIRE_MESSAGE(why.exit == 0, why.err);
  for (const char* part :
       {"success = true at step 60", "intention = true since step", "grasp = true since step",
        "manipulation.probe", "height(a) > height(b)", "cm <= 2cm", "deg <= 60deg",
        "distance(tcp, origin(source)) < 5cm", "Ns > 1e-06Ns", "wrong = false"}) {
    CHECK_MESSAGE(contains(why.out, part), part);
  }
  const Outcome prefixed = sandbox().vlaprobe("why run widowx_carrot_on_plate 1 --json");
  REQUIRE_MESSAGE(prefixed.exit == 0, prefixed.err);
  const json object = parsed(prefixed.out);
  CHECK(object["task"] == "carrot_on_plate");
  CHECK(object["metrics"][0]["conditions"].size() >= 4);
  CHECK(object["metrics"][0]["conditions"][0]["line"].get<int>() > 0);

  CHECK(sandbox().vlaprobe("why run carrot_on_plate 99").exit == 1);
  CHECK(sandbox().vlaprobe("why run carrot_on_plat 1").exit == 1);
  const Outcome unknown = sandbox().vlaprobe("why run carrot_on_plate 1 --metric succes");
  CHECK(unknown.exit == 1);
  CHECK(contains(unknown.err, "success"));
  CHECK(sandbox().vlaprobe("why absent carrot_on_plate 1").exit == 2);
}

TEST_CASE("export writes every step as a line of JSON and as HDF5") {
  const Outcome lines = sandbox().vlaprobe("export run -o run.jsonl");
  REQUIRE_MESSAGE(lines.exit == 0, lines.err);
  std::istringstream text(read_file(sandbox() / "run.jsonl"));
  int episodes = 0, steps = 0;
  for (std::string line; std::getline(text, line);) {
    const json object = parsed(line);
    (object["kind"] == "episode" ? episodes : steps) += 1;
    if (object["kind"] == "step") {
      CHECK(object["action"].size() == 7);
      CHECK(object["bodies"].contains("carrot"));
    }
  }
  CHECK(episodes >= 2);
  CHECK(steps == 60 * episodes);
  const Outcome hdf5 = sandbox().vlaprobe("export run -o run.h5 --tasks 'carrot*'");
  REQUIRE_MESSAGE(hdf5.exit == 0, hdf5.err);
  CHECK(read_file(sandbox() / "run.h5").substr(1, 3) == "HDF");
  CHECK(sandbox().vlaprobe("export run -o run.txt").exit == 1);
  CHECK(sandbox().vlaprobe("export run -o run.h5 --tasks nothing").exit == 1);
  CHECK(sandbox().vlaprobe("export run -o no/such/folder/x.h5").exit == 2);
  CHECK(!std::filesystem::exists(sandbox() / "run.h5.part"));
}

TEST_CASE("build gives one root from any directory, and whatever order files are listed in") {
  std::filesystem::create_directories(sandbox() / "elsewhere");
  std::filesystem::copy(
      VLAPROBE_SOURCE_DIR "/suite", sandbox() / "elsewhere/deep",
      std::filesystem::copy_options::recursive | std::filesystem::copy_options::overwrite_existing);
  const std::string parts[] = {"catalog", "stage", "layouts", "manipulation", "language", "intact"};
  std::string forwards, backwards;
  for (const std::string& part : parts) {
    forwards += " elsewhere/deep/" + part + ".probe";
    backwards = " elsewhere/deep/" + part + ".probe" + backwards;
  }
  const auto root = [](const std::string& files, const std::string& out) {
    const Outcome built = sandbox().vlaprobe("build " + files + " -o " + out + " --assets $ASSETS");
    REQUIRE_MESSAGE(built.exit == 0, built.err);
    return built.out;
  };
  const std::string here = root("$SUITE", "a.plan");
  CHECK(root("elsewhere/deep/intact.probe", "b.plan") == here);
  CHECK(read_file(sandbox() / "a.plan") == read_file(sandbox() / "b.plan"));
  CHECK(root(forwards, "c.plan") == here);
  CHECK(root(backwards, "d.plan") == here);
  CHECK(read_file(sandbox() / "c.plan") == read_file(sandbox() / "d.plan"));
}

TEST_CASE("a run made without them is told of by the library's events, in words, JSON and CSV") {
  const Outcome table = sandbox().vlaprobe("results run --events --assets $ASSETS");
  REQUIRE_MESSAGE(table.exit == 0, table.err);
  CHECK(contains(table.out, "carrot_on_plate: 2 episodes\n"));
  CHECK(contains(table.out, "came as far as reached it 2, grasped it 2, lifted it 2"));
  const Outcome told = sandbox().vlaprobe("results run --events --json --assets $ASSETS");
  REQUIRE_MESSAGE(told.exit == 0, told.err);
  const json rows = parsed(told.out);
  REQUIRE(rows.size() == 2);
  for (const json& row : rows) {
    CHECK(row["reached"] == 6);
    CHECK(row["events"]["left_table"] == 0);
    CHECK(row["motion"]["path"].get<double>() > 0.3);
    CHECK(row["motion"]["sparc"].get<double>() < -1);
    CHECK(row["motion"]["hand_over"].get<double>() > 0);
    // Subgoals in their order, each not before the one before.
    int last = 0;
    for (const json& subgoal : row["subgoals"]) {
      CHECK(subgoal["step"].get<int>() >= last);
      last = subgoal["step"].get<int>();
    }
  }
  const Outcome csv = sandbox().vlaprobe("results run --events --csv --assets $ASSETS");
  CHECK(csv.out.starts_with("task,episode,seed,policy,steps,reached,subgoals,dropped,bumped,"));
}

TEST_CASE("a text of metrics alone judges a run, and what it writes is a run with them") {
  const Outcome judged =
      sandbox().vlaprobe("judge run --with std/events.probe -o told --json --assets $ASSETS");
  REQUIRE_MESSAGE(judged.exit == 0, judged.err);
  const json report = parsed(judged.out);
  for (const json& metric : report["metrics"]) {
    if (metric["metric"] == "success") CHECK(metric["changed"] == 0);
    if (metric["metric"] == "dropped") CHECK(metric["only_after"] == 2);
  }
  for (const json& row : rows_of("told")) {
    CHECK(row["success"] == true);
    CHECK(row["freed_it"].get<int>() > row["grasped_it"].get<int>());
  }
  const Outcome why = sandbox().vlaprobe("why told carrot_on_plate 0 --metric grasped_it");
  REQUIRE_MESSAGE(why.exit == 0, why.err);
  CHECK(contains(why.out, "grasped_it = "));
  CHECK(contains(why.out, "(first)\n  contact.probe\n"));  // what `held` is, in its library
  CHECK(contains(why.out, "[carrot, left_finger_link]"));
}

TEST_CASE("events are asked for by a text of metrics alone, and of runs") {
  const Outcome other =
      sandbox().vlaprobe("results run --events --with " + kSemantics + " --assets $ASSETS");
  CHECK(other.exit != 0);
  CHECK(contains(other.err, "has tasks of its own; events are told by a text of metrics alone"));
  const Outcome without = sandbox().vlaprobe("results run --with std/events.probe");
  CHECK(without.exit != 0);
  CHECK(contains(without.err, "says what events are, which --events asks for"));
}

TEST_CASE("of an episode whose trace was cut nothing is told but the reason") {
  namespace fs = std::filesystem;
  const fs::path from = sandbox() / "run", to = sandbox() / "cut";
  fs::copy(from, to, fs::copy_options::recursive);
  for (const auto& file : fs::directory_iterator(to / "traces/carrot_on_plate")) {
    if (file.path().filename().string().starts_with("1-")) fs::resize_file(file.path(), 3000);
  }
  const Outcome told = sandbox().vlaprobe("results cut --events --json --assets $ASSETS");
  CHECK(told.exit != 0);
  const json rows = parsed(told.out);
  REQUIRE(rows.size() == 2);
  CHECK(!rows[0].contains("untold"));
  CHECK(rows[1].contains("untold"));
  CHECK(!rows[1].contains("events"));
  CHECK(!rows[1].contains("motion"));
}
