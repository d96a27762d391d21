#include "runtime/report/benchmark.h"

#include <algorithm>
#include <filesystem>

#include "runtime/report/page_data.h"
#include "runtime/report/table_text.h"
#include "tests/runtime/report/fake_runs.h"

namespace probe::report {
namespace {

const std::vector<std::string> kFour = {"carrot_on_plate", "spoon_on_towel",
                                        "carrot_on_plate_lang_action", "carrot_on_plate_distract"};

bool says(const Benchmark& benchmark, std::string_view words) {
  return std::any_of(benchmark.notes.begin(), benchmark.notes.end(),
                     [&](const Note& note) { return note.text.find(words) != std::string::npos; });
}

Benchmark loaded(const std::vector<std::string>& dirs, const LoadOptions& options = {}) {
  auto benchmark = load(dirs, options);
  REQUIRE_MESSAGE(benchmark.ok(), to_text(benchmark.failure()));
  return std::move(benchmark).value();
}

}  // namespace

TEST_CASE("the paper's eleven categories are found among the plan's sets, originals first") {
  const plan::Plan plan = suite_plan();
  RunsFolder folder;
  fake_run(folder / "a", plan, "pi0", {.tasks = kFour, .last = 1}, always(true));
  const Benchmark benchmark = loaded({folder / "a"});
  CHECK(benchmark.tasks.size() == 50);
  REQUIRE(benchmark.categories.size() == 11);
  CHECK(benchmark.categories[0].label == "original");
  CHECK(benchmark.categories[0].tasks.size() == 4);
  CHECK(benchmark.categories[10].name == "commonsense_distraction");
  CHECK(benchmark.metrics[0].name == "success");
  CHECK(benchmark.episodes.size() == 8);
  CHECK(says(benchmark, "`pi0` is partial: 8 of 1200 episodes"));
  CHECK(loaded({folder / "a"}, {.sets = {"worded", "nowhere"}}).categories.size() == 1);
}

TEST_CASE("traces are not read") {
  const plan::Plan plan = suite_plan();
  RunsFolder folder;
  fake_run(folder / "a", plan, "pi0", {.tasks = {kFour[0]}, .last = 2}, always(true));
  std::filesystem::remove_all(folder / "a/traces");
  CHECK(loaded({folder / "a"}).episodes.size() == 3);
}

TEST_CASE("a folder named twice counts once, two runs of a policy stand apart, shards are one") {
  const plan::Plan plan = suite_plan();
  RunsFolder folder;
  fake_run(folder / "a", plan, "pi0", {.tasks = {kFour[0]}, .last = 2}, always(true));
  fake_run(folder / "again", plan, "pi0", {.tasks = {kFour[0]}, .last = 2}, always(false));
  fake_run(folder / "rest", plan, "pi0", {.tasks = {kFour[1]}, .last = 2}, always(true));
  const Benchmark twice = loaded({folder / "a", folder.path + "/./a"});
  CHECK(twice.policies.size() == 1);
  CHECK(twice.episodes.size() == 3);
  CHECK(says(twice, "named twice"));
  const Benchmark apart = loaded({folder / "a", folder / "again"});
  REQUIRE(apart.policies.size() == 2);
  CHECK(apart.policies[0].label != apart.policies[1].label);
  const Benchmark joined = loaded({folder / "a", folder / "rest"});
  CHECK(joined.policies.size() == 1);
  CHECK(joined.policies[0].runs.size() == 2);
  CHECK(loaded({folder / "a", folder / "rest"}, {.sets = {}, .join = false}).policies.size() == 2);
}

TEST_CASE("a folder of successes alone is no policy's result") {
  const plan::Plan plan = suite_plan();
  RunsFolder folder;
  fake_run(folder / "a", plan, "pi0", {.tasks = {kFour[0]}, .last = 2}, always(true));
  fake_run(folder / "demos", plan, "pi0",
           {.tasks = {kFour[0]}, .last = 2, .only_success = true}, always(true));
  const std::vector<std::string> both = {folder / "a", folder / "demos"};
  const auto refused = load(both);
  REQUIRE(!refused.ok());
  CHECK(refused.failure().code == Fault::kUsage);
  CHECK(refused.failure().where == both[1]);
  CHECK(refused.failure().message.find("holds successes alone") == 0);
}

TEST_CASE("no folder, no run and no episode are told apart") {
  const plan::Plan plan = suite_plan();
  RunsFolder folder;
  CHECK(load({}).failure().code == Fault::kUsage);
  const std::vector<std::string> nowhere = {folder / "nowhere"};
  CHECK(to_text(load(nowhere).failure()).find("no run here") != std::string::npos);
  fake_run(folder / "empty", plan, "pi0", {}, always(true));
  const std::vector<std::string> empty = {folder / "empty"};
  CHECK(to_text(load(empty).failure()).find("no episode has been run yet") != std::string::npos);
}

TEST_CASE("invalid episodes count neither way, and tasks with no other have no numbers") {
  const plan::Plan plan = suite_plan();
  RunsFolder folder;
  fake_run(folder / "a", plan, "pi0", {.tasks = kFour, .last = 3},
           [](const std::string& task, int episode, int) {
             Outcome outcome{.success = true};
             if (task == "spoon_on_towel" || episode == 0) outcome.invalid = "the server went away";
             return outcome;
           });
  const Benchmark benchmark = loaded({folder / "a"});
  CHECK(says(benchmark, "7 of 16 episodes are invalid"));
  const int success = benchmark.find_metric("success");
  CHECK(!estimate(benchmark, 0, success, {benchmark.find_task("spoon_on_towel")}));
  const auto carrot = estimate(benchmark, 0, success, {benchmark.find_task("carrot_on_plate")});
  REQUIRE(carrot);
  CHECK(carrot->count.n == 3);

  fake_run(folder / "b", plan, "gone", {.tasks = {kFour[0]}, .last = 1},
           [](const std::string&, int, int) {
             return Outcome{false, false, false, false, "policy: no answer"};
           });
  const Benchmark none = loaded({folder / "b"});
  const auto data = page_data(none, {.title = "none"});
  CHECK(data["tables"]["main"]["rows"][0]["all"].is_null());
  CHECK(data["reasons"][0] == "policy: no answer");
}

TEST_CASE("why episodes were not attempted is said as it was, whatever the reason") {
  const plan::Plan plan = suite_plan();
  RunsFolder folder;
  fake_run(folder / "a", plan, "expert", {.tasks = {kFour[0]}, .last = 2},
           [](const std::string&, int episode, int) {
             Outcome outcome{.success = true};
             if (episode < 2) outcome.invalid = "not attempted: the expert does not plan ahead";
             return outcome;
           });
  const Benchmark benchmark = loaded({folder / "a"});
  CHECK(says(benchmark, "2 of 3 episodes were not attempted: the expert does not plan ahead"));
  CHECK_FALSE(says(benchmark, "skills"));
  CHECK_FALSE(says(benchmark, "invalid"));
  // The page counts them beside the invalid ones, and each says why.
  const auto data = page_data(benchmark, {.title = "apart"});
  CHECK(data["policies"][0]["runs"][0]["not_attempted"] == 2);
  CHECK(data["policies"][0]["runs"][0]["invalid"] == 0);
  CHECK(data["reasons"][0] == "not attempted: the expert does not plan ahead");
}

TEST_CASE("runs of different plans are joined where tasks agree and kept apart where they do not") {
  const plan::Plan published = suite_plan();
  const plan::Plan repaired = suite_plan("intact_clean.probe");
  RunsFolder folder;
  const std::vector<std::string> tasks = {"carrot_on_plate", "spoon_on_towel_distract"};
  fake_run(folder / "a", published, "pi0", {.tasks = tasks, .last = 1}, always(true));
  fake_run(folder / "b", repaired, "magma", {.tasks = tasks, .last = 1}, always(true));
  const Benchmark benchmark = loaded({folder / "a", folder / "b"});
  CHECK(benchmark.plans.size() == 2);
  CHECK(says(benchmark, "the runs are of 2 plans"));
  CHECK(says(benchmark, "tasks mean different things in different plans"));
  CHECK(benchmark.tasks.size() > 50);
  // Each plan's tasks are in the columns.
  const int success = benchmark.find_metric("success");
  for (int policy = 0; policy < 2; ++policy)
    CHECK(estimate(benchmark, policy, success, benchmark.categories[0].tasks)->count.n == 2);
}

TEST_CASE("a set that only serves to make others is no column") {
  RunsFolder folder;
  const std::string file = folder / "mine.probe";
  std::ofstream(file) << "use \"" VLAPROBE_SOURCE_DIR "/suite/intact.probe\"\n"
                      << "set quiet = { carrot_on_plate, coke_can_on_plate_clean }\n"
                      << "derive \"{t}_dark\" for t in quiet { light faint }\n"
                      << "set dark = variants of quiet where axis light\n"
                      << "suite mine trained on bridge_v2 { tasks published | dark; seeds 42 }\n";
  const plan::Plan plan = plan_of(file);
  fake_run(folder / "a", plan, "pi0", {.tasks = {"carrot_on_plate_dark"}, .last = 1}, always(true));
  const Benchmark benchmark = loaded({folder / "a"});
  REQUIRE(benchmark.categories.size() == 12);
  CHECK(benchmark.categories[0].name == "core");
  CHECK(benchmark.categories.back().name == "dark");
  CHECK(says(benchmark, "since other columns have all their tasks: `quiet`"));
  const Benchmark chosen = loaded({folder / "a"}, {.sets = {"quiet", "dark"}});
  REQUIRE(chosen.categories.size() == 2);
  CHECK(chosen.categories[0].tasks.size() == 2);
}

TEST_CASE("a set that shares most of its tasks is no column, and the task it had alone is named") {
  RunsFolder folder;
  const std::string file = folder / "mine.probe";
  std::ofstream(file)
      << "use \"" VLAPROBE_SOURCE_DIR "/suite/intact.probe\"\n"
      << "variant lonely of carrot_on_plate { horizon 70 steps }\n"
      << "set quiet = { carrot_on_plate, coke_can_on_plate_clean, lonely }\n"
      << "derive \"{t}_dim\" for t in quiet - { lonely } { light faint }\n"
      << "set dim = variants of quiet where axis light\n"
      << "suite mine trained on bridge_v2 { tasks published | dim | { lonely }; seeds 42 }\n";
  const plan::Plan plan = plan_of(file);
  fake_run(folder / "a", plan, "pi0", {.tasks = {"lonely"}, .last = 1}, always(true));
  const auto has = [](const Benchmark& benchmark, const char* name) {
    return std::any_of(benchmark.categories.begin(), benchmark.categories.end(),
                       [&](const Category& category) { return category.name == name; });
  };
  const Benchmark benchmark = loaded({folder / "a"});
  CHECK_FALSE(has(benchmark, "quiet"));
  CHECK(has(benchmark, "core"));
  CHECK(has(benchmark, "dim"));
  CHECK(says(benchmark, "since other columns have most of their tasks: `quiet`"));
  CHECK(says(benchmark, "1 tasks are in no category and count only under `all`: `lonely`"));
}

TEST_CASE("what a name says is text, whatever it looks like") {
  const plan::Plan plan = suite_plan();
  RunsFolder folder;
  const std::string name = "<script>alert(1)</script>\xff & \"co\"";
  fake_run(folder / "a", plan, name, {.tasks = {kFour[0]}, .last = 1}, always(true));
  const auto data = page_data(loaded({folder / "a"}), {.title = "<b>"});
  const std::string text = data.dump();
  const auto back = Json::parse(text);
  CHECK(back["policies"][0]["label"].get<std::string>().find("<script>alert(1)") == 0);
}

TEST_CASE("fifty policies make a table in little time") {
  const plan::Plan plan = suite_plan();
  RunsFolder folder;
  std::vector<std::string> dirs;
  for (int p = 0; p < 50; ++p) {
    dirs.push_back(folder / std::to_string(p));
    fake_run(dirs.back(), plan, "checkpoint_" + std::to_string(p),
             {.tasks = {kFour[0], kFour[2]}, .last = 1}, [&](const std::string&, int episode, int) {
               return Outcome{.success = (episode + p) % 3 == 0};
             });
  }
  const Benchmark benchmark = loaded(dirs);
  CHECK(benchmark.policies.size() == 50);
  const auto data = page_data(benchmark, {.title = "many"});
  CHECK(data["tables"]["ranking"].size() == 50);
  CHECK(data["tables"]["main"]["rows"].size() == 200);
}

TEST_CASE("a server's profile, and whether it reads, stand with what reached the policy") {
  const plan::Plan plan = suite_plan();
  RunsFolder folder;
  const auto lines_of = [&](const std::string& name, const policy::Reading& reading) {
    fake_run(
        folder / name, plan, "gr00t://h:1",
        {.tasks = kFour, .last = 1, .content = "gr00t profile gr00t_bridge_as_published sha256 1"},
        always(true));
    auto store = store::Store::open(folder / name, store::read_run_record(folder / name).value(),
                                    plan.bytes());
    REQUIRE_MESSAGE(store.ok(), to_text(store.failure()));
    store::RunCall call;
    call.reading = reading;
    REQUIRE((*store)->write_call(call).ok());
    store->reset();
    const Benchmark benchmark = loaded({folder / name});
    std::string lines;
    const Json data = page_data(benchmark, {.title = "one"});
    for (const auto& row : data["tables"]["delivery"])
      lines += row["level"].text() + ": " + row["text"].text() + "\n";
    return lines;
  };
  policy::Reading reading;
  reading.server = "h:1";
  reading.answers = 3;
  reading.answers_sha256 = "ab";
  const std::string good = lines_of("good", reading);
  CHECK(good.find("good: gr00t://h:1: asked by gr00t profile gr00t_bridge_as_published") !=
        std::string::npos);
  CHECK(good.find("good: gr00t://h:1: other words and other pictures had other answers") !=
        std::string::npos);
  reading.is_deaf = true;
  CHECK(lines_of("deaf", reading)
            .find("bad: gr00t://h:1: the policy at h:1 answers two "
                  "instructions with one picture bit for bit the same") != std::string::npos);
  reading = {.server = "h:1", .answers = 3, .answers_sha256 = "ab", .is_unchecked = true};
  CHECK(lines_of("unchecked", reading)
            .find("bad: gr00t://h:1 (--insecure): the policy at h:1 was asked with --insecure: its "
                  "certificate "
                  "was not checked") != std::string::npos);
  // Tables in papers have no notes.
  const Benchmark unchecked = loaded({folder / "unchecked"}), checked = loaded({folder / "good"});
  const auto texts = [](const Benchmark& benchmark) {
    const Tables tables = make_tables(benchmark);
    return table_text(benchmark, tables, {}, TableFormat::kCsv) +
           table_text(benchmark, tables, {}, TableFormat::kLatex);
  };
  CHECK(unchecked.policies[0].label.ends_with(" (--insecure)"));
  CHECK(texts(unchecked).find(" (--insecure)") != std::string::npos);
  CHECK(texts(checked).find("insecure") == std::string::npos);
}

TEST_CASE("of many episodes all are counted, some of each task are kept as stored, and a page has columns packed") {
  RunsFolder folder;
  const plan::Plan plan = suite_plan();
  std::vector<int> seeds(60);
  for (int i = 0; i < 60; ++i) seeds[static_cast<std::size_t>(i)] = i;
  fake_run(folder / "a", plan, "pi0", {.tasks = {kFour[0], kFour[1]}, .seeds = seeds},
           [](const std::string&, int episode, int seed) {
             return Outcome{.success = (episode + seed) % 3 == 0};
           });
  const std::vector<std::string> dirs = {folder / "a"};
  const auto all = load(dirs), some = load(dirs, {.most_rows = 1000});
  REQUIRE(all.ok());
  REQUIRE(some.ok());
  CHECK(all->rows.size() == 2880);
  CHECK(some->rows.size() == 24);  // six failures and six successes of each task
  CHECK(some->episodes.size() == 2880);
  const Json whole = page_data(*all, {.title = "x"}), few = page_data(*some, {.title = "x"});
  CHECK(whole["episodes"] == few["episodes"]);
  CHECK(whole["tables"] == few["tables"]);
  const Json packed = page_data(*some, {.title = "x", .plain = 100})["episodes"];
  CHECK(packed["policy"]["runs"] == Json::array({0, 2880}));
  CHECK(packed["task"]["runs"].size() == 4);
  CHECK(packed["seed"]["width"] == 1);
  CHECK(packed["seed"]["bytes"].text().size() == 4 * 2880 / 3);
  CHECK(packed["seed"]["bytes"].text().starts_with("AAECAwQF"));  // 0 1 2 3 4 5
  CHECK(!packed.contains("sha"));
}

TEST_CASE("seventy-five truths stay apart, also where another run has other ones") {
  const plan::Plan plan = suite_plan();
  RunsFolder folder;
  const auto script = [](const std::string& prefix) {
    return [prefix](const std::string&, int, int) {
      Outcome outcome{.success = true};
      for (int i = 0; i < 71; ++i) {
        outcome.more.push_back({prefix + std::to_string(i), i % 2 == 0, 1});
        outcome.more.push_back({prefix + "odd_" + std::to_string(i), true, i % 2 == 1 ? 1.0 : 0.0});
      }
      return outcome;
    };
  };
  fake_run(folder / "a", plan, "pi0", {.tasks = {kFour[0]}, .last = 0}, script("a_"));
  fake_run(folder / "b", plan, "null", {.tasks = {kFour[0]}, .last = 0}, script("b_"));
  const Benchmark benchmark = loaded({folder / "a", folder / "b"});
  REQUIRE(benchmark.episodes.size() == 2);
  const Json data = page_data(benchmark, {.title = "many truths"});
  for (std::size_t e = 0; e < 2; ++e) {
    const store::ResultRow& row =
        benchmark.rows[static_cast<std::size_t>(benchmark.episodes[e].row)];
    for (std::size_t m = 0; m < benchmark.metrics.size(); ++m) {
      const Metric& metric = benchmark.metrics[m];
      const auto stored =
          std::find_if(row.metrics.begin(), row.metrics.end(),
                       [&](const store::MetricValue& value) { return value.name == metric.name; });
      const bool truth =
          metric.truth && stored != row.metrics.end() && stored->is_bool && stored->value != 0;
      CAPTURE(metric.name);
      CHECK(benchmark.episodes[e].is(static_cast<int>(m)) == truth);
      if (!metric.truth) continue;
      const Json& column =
          m < 52 ? data["episodes"]["bits"] : data["episodes"]["more_bits"][m / 52 - 1];
      CHECK((column[e].get<std::uint64_t>() >> m % 52 & 1U) == (truth ? 1U : 0U));
    }
  }
}

TEST_CASE("the document has every key that the page is promised") {
  const plan::Plan plan = suite_plan();
  RunsFolder folder;
  fake_run(folder / "a", plan, "expert", {.tasks = kFour, .last = 5}, always(true));
  fake_run(folder / "b", plan, "null", {.tasks = kFour, .last = 5}, always(false));
  const auto data = page_data(loaded({folder / "a", folder / "b"}), {.title = "two"});
  for (const char* key : {"format", "version", "title", "interval", "run", "findings", "notes",
                          "metrics", "categories", "objects", "plans", "fingerprints", "prompts",
                          "reasons", "strings", "policies", "tasks", "episodes", "tables"}) {
    CAPTURE(key);
    CHECK(data.contains(key));
  }
  for (const char* key :
       {"main", "by_task", "deltas", "category_deltas", "language", "pairs", "objects", "gap",
        "floors", "compare", "ranking", "sequential", "mixed", "delivery", "confounded"}) {
    CAPTURE(key);
    CHECK(data["tables"].contains(key));
  }
  CHECK(data["policies"][0]["role"] == "ceiling");
  CHECK(data["policies"][1]["role"] == "floor");
  CHECK(data["episodes"]["count"] == 48);
  CHECK(data["tables"]["delivery"][0]["level"] == "good");
  CHECK(!data["tables"]["confounded"].empty());
}

}  // namespace probe::report
