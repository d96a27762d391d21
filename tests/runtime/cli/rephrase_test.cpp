// vlaprobe rephrase through the program, on the published suite with everything that rewords it.
#include <doctest/doctest.h>

#include <algorithm>
#include <map>
#include <set>
#include <sstream>

#include "runtime/base/json.h"
#include "tests/runtime/cli/program.h"

using probe::Json;
using probe::test::contains;
using probe::test::Outcome;
using probe::test::read_file;
using probe::test::Sandbox;
using probe::test::write_file;

namespace {

const std::string kSuite = "'" VLAPROBE_SOURCE_DIR "/suite/";
const std::string kText = kSuite + "rephrase.probe' ";
const std::string kNotIn =
    "--not-in " + kSuite + "intact.probe' --not-in " + kSuite + "beyond.probe' ";

std::vector<Json> rows(const std::string& lines) {
  std::vector<Json> all;
  std::istringstream text(lines);
  for (std::string line; std::getline(text, line);) {
    all.push_back(Json::parse(line));
    REQUIRE_FALSE(all.back().is_discarded());
  }
  return all;
}

}  // namespace

TEST_CASE("the published suite has as many proved wordings of each task as were counted") {
  Sandbox box;
  const Outcome made = box.vlaprobe("rephrase " + kText + "--json");
  REQUIRE_MESSAGE(made.exit == 0, made.err);
  const Json summary = Json::parse(made.out);
  std::string counts = "task,train,held_out\n";
  for (const Json& task : summary["tasks"])
    counts +=
        task["task"].text() + "," + task["train"].dump() + "," + task["held_out"].dump() + "\n";
  CHECK(counts == read_file(VLAPROBE_SOURCE_DIR "/tests/runtime/cli/rephrase_counts.csv"));
  CHECK(summary["tasks_without"].get<int>() == 0);
  CHECK(made.err.empty());
}

TEST_CASE("a phrase that says where things are is a wording of tasks whose starts it is clear in") {
  Sandbox box;
  const std::string spatial = std::string(VLAPROBE_SOURCE_DIR) + "/examples/spatial.probe";
  const Outcome made = box.vlaprobe("rephrase '" + spatial + "' -o words.csv");
  REQUIRE_MESSAGE(made.exit == 0, made.err);
  const std::string words = read_file(box / "words.csv");
  CHECK(contains(words,
                 "\nleft_can_named,put coke can on plate,put the can on the left on the plate,"));
  CHECK(contains(made.err + made.out, "left_can_on_the_left"));
}

TEST_CASE("every wording, fed back as words on the spot, compiles without a finding") {
  Sandbox box;
  REQUIRE(box.vlaprobe("rephrase " + kText + "-o words.jsonl").exit == 0);
  std::string text = "use \"suite/rephrase.probe\"\n";
  std::size_t count = 0;
  for (const Json& row : rows(read_file(box / "words.jsonl"))) {
    const std::string& task = row["task"].text();
    // Its published instruction tells of an object that is not there, and so do its rewordings.
    if (task == "spoon_on_towel_lang_neg") text += "@allow(absent, \"as published\")\n";
    text += "task fed_" + std::to_string(count++) + " like " + task + " { say \"" +
            row["wording"].text() + "\" }\n";
  }
  CHECK(count > 6000);
  write_file(box / "fed.probe", text);
  const Outcome checked = box.vlaprobe("check fed.probe");
  CHECK(checked.exit == 0);
  CHECK_MESSAGE(checked.err.find(" files: no findings, ") != std::string::npos,
                checked.err.substr(0, 2000));
  CHECK(std::ranges::count(checked.err, '\n') == 1);
}

TEST_CASE("training and held-out wordings are disjoint, and the same bytes come twice") {
  Sandbox box;
  const std::string half = "rephrase " + kText + "--held-out 0.5 --seed 3 ";
  REQUIRE(box.vlaprobe(half + "-o a.jsonl").exit == 0);
  REQUIRE(box.vlaprobe(half + "-o b.jsonl").exit == 0);
  const std::string lines = read_file(box / "a.jsonl");
  CHECK(lines == read_file(box / "b.jsonl"));
  std::map<std::string, std::string> split, core;
  std::set<std::string> both;
  for (const Json& row : rows(lines)) {
    CHECK(split.try_emplace(row["wording"].text(), row["split"].text()).first->second ==
          row["split"].text());
    // A policy that was trained on "please put ..." has seen "put ...".
    std::string plain = row["wording"].text();
    for (const std::string polite : {"please ", "could you "}) {
      if (plain.starts_with(polite)) plain.erase(0, polite.size());
    }
    if (plain.ends_with('?')) plain.pop_back();
    CHECK_MESSAGE(core.try_emplace(plain, row["split"].text()).first->second == row["split"].text(),
                  plain);
    both.insert(row["split"].text());
  }
  CHECK(both.size() == 2);
}

TEST_CASE("instructions of the suites that are asked are an error by name, or left out") {
  Sandbox box;
  const Outcome refused = box.vlaprobe("rephrase " + kText + kNotIn + "-o words.jsonl");
  CHECK(refused.exit == 1);
  CHECK(contains(refused.err,
                 "\"put the orange object on the yellow object\" of `carrot_on_plate` is the "
                 "instruction of `carrot_on_plate_lang_color` in "));
  CHECK(contains(refused.err, "--drop-leaks leaves them out"));
  CHECK_FALSE(std::filesystem::exists(box / "words.jsonl"));

  REQUIRE(box.vlaprobe("rephrase " + kText + kNotIn + "--drop-leaks -o words.csv").exit == 0);
  CHECK(read_file(box / "words.csv").starts_with("task,original,wording,"));
  REQUIRE(box.vlaprobe("rephrase " + kText + kNotIn + "--drop-leaks -o words.jsonl").exit == 0);
  std::set<std::string> asked;
  for (const char* suite : {"intact.probe'", "beyond.probe'"}) {
    for (const Json& task : Json::parse(box.vlaprobe("list " + kSuite + suite + " --json").out))
      asked.insert(task["prompt"].text());
  }
  CHECK(asked.size() > 1000);
  const std::vector<Json> kept = rows(read_file(box / "words.jsonl"));
  CHECK(kept.size() > 4000);
  for (const Json& row : kept)
    CHECK_MESSAGE(!asked.contains(row["wording"].text()), row["wording"].text());
}

TEST_CASE("a plan is compared with as its text is, and is no text to reword") {
  Sandbox box;
  REQUIRE(box.vlaprobe("build \"$SUITE\" --suite language -o asked.plan").exit == 0);
  const Outcome refused =
      box.vlaprobe("rephrase " + kText + "--tasks carrot_on_plate --not-in asked.plan");
  CHECK(refused.exit == 1);
  CHECK(contains(refused.err, "in asked.plan"));
  const Outcome none = box.vlaprobe("rephrase asked.plan");
  CHECK(none.exit == 1);
  CHECK(contains(none.err, "a plan has no templates"));
}

TEST_CASE(
    "the preset gives several wordings and half to the instruction, in the published layout") {
  Sandbox box;
  REQUIRE(box.vlaprobe("rephrase " + kText + "--preset intact -o words.jsonl").exit == 0);
  std::map<std::string, int> of_task;
  for (const Json& row : rows(read_file(box / "words.jsonl"))) {
    CHECK(row["original_probability"].get<double>() == 0.5);
    CHECK(row["split"].text() == "train");
    ++of_task[row["task"].text()];
  }
  CHECK(of_task.size() == 51);
  for (const auto& task : of_task) CHECK_MESSAGE(task.second == 10, task.first);

  const std::string published = "rephrase " + kText + "--preset intact --format intact -o words";
  const Outcome json = box.vlaprobe(published + ".json");
  REQUIRE_MESSAGE(json.exit == 0, json.err);
  CHECK(contains(json.err, "separates wordings by full stops"));
  REQUIRE(box.vlaprobe(published + ".pkl").exit == 0);
  const Outcome same = box.run(
      "python3 -c 'import json, pickle; a = pickle.load(open(\"words.pkl\", \"rb\"));"
      "print(a == json.load(open(\"words.json\")), all(v.count(\".\") == 9 for v in a.values()),"
      " all(w and w == w.strip() for v in a.values() for w in v.split(\".\")))'");
  CHECK_MESSAGE(same.out == "True True True\n", same.err);
}

TEST_CASE("what cannot be done is said before anything is written") {
  Sandbox box;
  const auto says = [&](const std::string& arguments, const char* words) {
    const Outcome outcome = box.vlaprobe("rephrase " + kText + arguments);
    CHECK_MESSAGE(outcome.exit == 1, arguments);
    CHECK_MESSAGE(contains(outcome.err, words), outcome.err);
  };
  says("--tasks 'nothing_*'", "no task is called like `nothing_*`");
  says("--suite intct", "did you mean `intact`?");
  says("--held-out 1.5", "no share between 0 and 1");
  says("--held-out half", "no share between 0 and 1");
  says("--held-out nan", "no share between 0 and 1");
  says("--per-task 0", "expected 1 to 10000");
  says("-o words.txt", "ends in .jsonl or .csv");
  says("--format intact -o words.jsonl", ".json or .pkl");
  says("--not-in ''", "--not-in: is empty");
  CHECK(box.vlaprobe("rephrase absent.probe").exit == 2);
  CHECK(box.vlaprobe("rephrase " + kText + "--not-in absent.plan").exit == 2);
  CHECK_FALSE(std::filesystem::exists(box / "words.txt"));
  CHECK_FALSE(std::filesystem::exists(box / "words.jsonl"));
  const Outcome one = box.vlaprobe("rephrase " + kText + "--tasks 'stack_*'");
  CHECK(contains(one.out, "stack_cube_lang_action"));
  CHECK_FALSE(contains(one.out, "carrot_on_plate"));
}
