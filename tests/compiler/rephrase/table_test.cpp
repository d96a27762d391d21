#include "compiler/rephrase/table.h"

#include <doctest/doctest.h>

#include <span>
#include <sstream>

#include "compiler/rephrase/published.h"
#include "tests/compiler/small_suite.h"

using namespace probe;

namespace {

const std::string kMore = R"(
template place frame put "place {the source} on {the target}"
template stop frame put "place {the source} on {the target}. Thanks"
template comma frame put "on {the target}, \"put\" {the source}"
task crowded like red_on_tray { distractors blue }
task ended like red_on_tray { say "put {source} on {the target}." }
)";

struct Made {
  std::unique_ptr<test::Analysis> analysis = test::analyze_with_suite(kMore);
  rephrase::Options options;
  rephrase::Rephrased all;

  explicit Made(const rephrase::Options& wanted) : options(wanted) {
    REQUIRE_MESSAGE(!analysis->diagnostics.has_errors(), analysis->said());
    std::vector<sema::TaskId> tasks;
    const auto& known = analysis->model.tasks;
    for (std::size_t i = 0; i < known.size(); ++i) {
      if (!known[known.id(i)].abstract) tasks.push_back(known.id(i));
    }
    all = rephrase::rephrase(analysis->model, tasks, {}, options);
  }
  Sha256 hash() const { return rephrase::sources_hash(analysis->sources); }
};

}  // namespace

TEST_CASE("a line says how a wording was made, how likely it is and what proves it") {
  const Made made({.held_out = 0, .keep_original = 0.5});
  const Sha256 starts = sha256(std::string_view("starts"));
  std::istringstream lines(rephrase::to_json_lines(made.analysis->model, made.all,
                                                   {made.hash(), {{"red_on_tray", starts}}}));
  std::size_t count = 0;
  for (std::string line; std::getline(lines, line); ++count) {
    const Json row = Json::parse(line);
    REQUIRE_FALSE(row.is_discarded());
    if (row["wording"].text() != "place the red thing on the tray" ||
        row["task"].text() != "red_on_tray")
      continue;
    CHECK(row["original"].text() == "put red block on the tray");
    CHECK(row["split"].text() == "train");
    CHECK(row["original_probability"].get<double>() == 0.5);
    CHECK(row["probability"].get<double>() ==
          doctest::Approx(0.5 / static_cast<double>(made.all.tasks[0].train)));
    CHECK(row["template"].text() == "place");
    CHECK(row["frame"].text() == "put");
    CHECK(row["source_as"].text() == "by_color");
    CHECK(row["target_as"].is_null());
    CHECK(row["uses"].dump() == "[\"appearance\"]");
    CHECK(row["wording_sha256"].text() == to_hex(sha256("place the red thing on the tray")));
    CHECK(row["made_from_sha256"].text() == to_hex(made.hash()));
    CHECK(row["starts_sha256"].text() == to_hex(starts));
  }
  std::size_t expected = 0;
  for (const auto& of_task : made.all.tasks) expected += of_task.lines.size();
  CHECK(count == expected);
  CHECK(count > 10);
}

TEST_CASE("comma-separated values quote commas and quotes") {
  const Made made({.held_out = 0});
  const std::string csv = rephrase::to_csv(made.analysis->model, made.all, {made.hash()});
  CHECK(csv.starts_with("task,original,wording,split,probability,original_probability,template,"));
  CHECK(csv.find("\"on the tray, \"\"put\"\" the red block\"") != csv.npos);
}

TEST_CASE("the summary counts every candidate once") {
  const Made made({.held_out = 0.5, .per_task = 3});
  const Json json = rephrase::summary(made.analysis->model, made.all, made.options);
  const auto total = [](const Json& of) {
    std::uint64_t sum = 0;
    for (const char* key : {"train", "held_out", "same_words", "of_some_tasks", "over_cap"})
      sum += of[key].get<std::uint64_t>();
    for (const auto& reason : of["refused"].items()) sum += reason.second.get<std::uint64_t>();
    return sum;
  };
  CHECK(total(json) == json["candidates"].get<std::uint64_t>());
  REQUIRE(json["tasks"].size() == 3);
  for (const Json& task : json["tasks"]) {
    CHECK(total(task) == task["candidates"].get<std::uint64_t>());
    CHECK(task["over_cap"].get<std::uint64_t>() > 0);
  }
  const std::string text = rephrase::summary_text(json);
  CHECK(text.find("crowded") != text.npos);
  CHECK(text.find("another verb") != text.npos);
}

TEST_CASE("the published layout has an instruction once, with what holds for all its tasks") {
  const Made made({.held_out = 0, .by_instruction = true});
  const rephrase::Published published = rephrase::publish(made.analysis->model, made.all);
  REQUIRE(published.wordings.size() == 1);  // `ended` ends in a full stop, at which the loader cuts
  CHECK(published.stopped_originals == std::vector<std::string>{"put red block on the tray."});
  const auto& wordings = published.wordings.at("put red block on the tray");
  for (const std::string& wording : wordings) {
    CHECK(wording.find('.') == wording.npos);
    CHECK_MESSAGE(wording.find("toy") == wording.npos, "`crowded` has two toys: ", wording);
  }
  CHECK(published.with_stops > 0);
  CHECK(made.all.tasks[0].of_some_tasks > 0);
  CHECK(made.all.tasks[1].of_some_tasks == 0);
  const Json json = Json::parse(rephrase::to_published_json(published));
  const std::string joined = json["put red block on the tray"].text();
  CHECK(joined.starts_with("put red thing on the tray.place the red block on the tray."));
  CHECK_FALSE(joined.ends_with("."));
}

TEST_CASE("tasks with one instruction share a cap in the published layout, not its intersection") {
  const Made made({.held_out = 0, .per_task = 2, .by_instruction = true});
  const auto& tasks = made.all.tasks;
  REQUIRE(tasks.size() == 3);  // the first two have one instruction
  REQUIRE(tasks[0].lines.size() == 2);
  REQUIRE(tasks[1].lines.size() == 2);
  for (std::size_t i = 0; i < 2; ++i)
    CHECK(tasks[0].lines[i].wording.text == tasks[1].lines[i].wording.text);
}

TEST_CASE("a wording holds for all tasks of an instruction, whichever of them are asked for") {
  const Made whole({.held_out = 0, .by_instruction = true});
  const auto& tasks = whole.all.tasks;
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    const sema::TaskId alone = tasks[i].task;
    const rephrase::Rephrased some = rephrase::rephrase(
        whole.analysis->model, std::span(&alone, 1), {}, {.held_out = 0, .by_instruction = true});
    REQUIRE(some.tasks.size() == 1);
    CHECK(some.tasks[0].of_some_tasks == tasks[i].of_some_tasks);
    REQUIRE(some.tasks[0].lines.size() == tasks[i].lines.size());
    for (std::size_t n = 0; n < tasks[i].lines.size(); ++n)
      CHECK(some.tasks[0].lines[n].wording.text == tasks[i].lines[n].wording.text);
  }
}

TEST_CASE("what is held out is in no published file") {
  const Made made({.held_out = 1, .by_instruction = true});
  const rephrase::Published published = rephrase::publish(made.analysis->model, made.all);
  CHECK(published.held_out > 0);
  for (const auto& of_task : made.all.tasks) {
    for (const auto& line : of_task.lines) {
      if (line.is_held_out)
        CHECK(rephrase::to_published_json(published).find(line.wording.text) == std::string::npos);
    }
  }
}

TEST_CASE("a pickle holds the dictionary in opcodes of protocol 2") {
  rephrase::Published published;
  published.wordings["a"] = {"b", "c"};
  using namespace std::string_literals;
  CHECK(rephrase::to_published_pickle(published) == "\x80\x02}(X\x01\0\0\0aX\x03\0\0\0b.cu."s);
}
