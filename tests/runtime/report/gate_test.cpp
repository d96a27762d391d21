#include "runtime/report/gate.h"

#include <random>

#include "tests/runtime/report/fake_runs.h"

namespace probe::report {
namespace {

const std::vector<std::string> kTasks = {"carrot_on_plate", "carrot_on_plate_lang_action",
                                         "carrot_on_plate_lang_color",
                                         "carrot_on_plate_lang_common"};

Gate held(const Script& now, const Script& before, const GateOptions& options,
          const FakeRunOptions& of = {.tasks = kTasks, .seeds = {1, 2, 3}}) {
  RunsFolder folder;
  fake_run(folder / "new", suite_plan(), "new", of, now);
  fake_run(folder / "old", suite_plan(), "old", of, before);
  const std::vector<std::string> dirs = {folder / "new", folder / "old"};
  const auto benchmark = load(dirs, {.sets = {}, .join = false});
  REQUIRE(benchmark.ok());
  auto result = gate(*benchmark, options);
  REQUIRE_MESSAGE(result.ok(), (result.ok() ? "" : to_text(result.failure())));
  return std::move(result).value();
}

Script below(int limit) {
  return [limit](const std::string&, int episode, int) { return Outcome{.success = episode < limit}; };
}

}  // namespace

TEST_CASE("a drop that the data show is worse, an equal run is not, and few starts decide nothing") {
  const Gate worse = held(below(6), below(20), {.allow = 0.02});
  CHECK(worse.is_worse());
  CHECK(worse.rows.size() == 1);
  CHECK(worse.rows[0].drop == doctest::Approx(14.0 / 24));
  CHECK(worse.rows[0].low > 0.02);
  CHECK(worse.rows[0].high > worse.rows[0].drop);
  CHECK(worse.rows[0].starts == 96);
  CHECK(worse.rows[0].episodes == 288);
  CHECK(to_text(worse).find("new against old\nworse      all tasks: success 25.0 % against 83.3 % in "
                            "the same 288 episodes (96 starts): a drop of 58.3 points") == 0);

  const Gate same = held(below(20), below(20), {.allow = 0.15});
  CHECK_FALSE(same.is_worse());
  CHECK(same.is_decided());
  CHECK(same.rows[0].high <= 0.15);

  const Gate few = held(below(2), below(3), {.allow = 0},
                        {.tasks = {"carrot_on_plate"}, .first = 0, .last = 3});
  CHECK_FALSE(few.is_worse());
  CHECK_FALSE(few.is_decided());
  CHECK(few.rows[0].verdict == Verdict::kUndecided);
}

TEST_CASE("where fewer is better, more of it is worse") {
  const auto wrong = [](int limit) {
    return [limit](const std::string&, int episode, int) {
      return Outcome{.wrong = episode < limit};
    };
  };
  const Gate more = held(wrong(20), wrong(4), {.metric = "wrong", .allow = 0.05});
  CHECK(more.is_worse());
  CHECK(to_text(more).find("a rise of 66.7 points") != std::string::npos);
  CHECK_FALSE(held(wrong(4), wrong(20), {.metric = "wrong", .allow = 0.05}).is_worse());
}

TEST_CASE("invalid episodes in which a drop may hide are no pass, a few that cannot matter are") {
  const auto broken = [](int from) {
    return [from](const std::string&, int episode, int) {
      Outcome outcome{.success = true};
      if (episode >= from) outcome.invalid = "timeout";
      return outcome;
    };
  };
  const FakeRunOptions of{.tasks = kTasks, .seeds = {1, 2, 3}};
  RunsFolder folder;
  fake_run(folder / "new", suite_plan(), "new", of, broken(12));
  fake_run(folder / "old", suite_plan(), "old", of, always(true));
  const std::vector<std::string> dirs = {folder / "new", folder / "old"};
  const auto benchmark = load(dirs, {.sets = {}, .join = false});
  REQUIRE(benchmark.ok());
  const auto refused = gate(*benchmark, {.allow = 0.02});
  REQUIRE_FALSE(refused.ok());
  CHECK(to_text(refused.failure()).find("144 episodes that both have run are invalid in one of them") !=
        std::string::npos);

  const Gate few = held(broken(23), always(true), {.allow = 0.1});
  CHECK_FALSE(few.is_worse());
  REQUIRE_FALSE(few.notes.empty());
  CHECK(few.notes.back().find("12 episodes that both have run are invalid") == 0);
}

TEST_CASE("a metric that is not there or has no better side is refused by name") {
  RunsFolder folder;
  const FakeRunOptions of{.tasks = kTasks};
  fake_run(folder / "new", suite_plan(), "new", of, always(true));
  fake_run(folder / "old", suite_plan(), "old", of, always(true));
  const std::vector<std::string> dirs = {folder / "new", folder / "old"};
  const auto benchmark = load(dirs, {.sets = {}, .join = false});
  REQUIRE(benchmark.ok());
  const auto refused = [&](const GateOptions& options) {
    const auto result = gate(*benchmark, options);
    REQUIRE_FALSE(result.ok());
    return to_text(result.failure());
  };
  CHECK(refused({.metric = "succes"}).find("no metric `succes`") != std::string::npos);
  CHECK(refused({.allow = 1}).find("--allow") != std::string::npos);
  CHECK(refused({.error = 0}).find("--error") != std::string::npos);
  const auto twice = gate_folders(folder / "new", folder / "new", {});
  CHECK_FALSE(twice.ok());
}

TEST_CASE("JUnit's XML and Markdown hold what was found, whatever a policy is called") {
  Gate gate;
  gate.now = "new <a> & \"b\" | c";
  gate.before = "old";
  gate.options = {.allow = 0.02};
  gate.rows = {{"all tasks", 96, 288, 72, 240, 0.583, 0.4, 0.7, 1e-9, Verdict::kWorse},
               {"colour", 24, 72, 72, 72, 0, -0.1, 0.1, 1, Verdict::kUndecided}};
  gate.notes = {"3 of 4 episodes of `x` have been run"};
  const std::string xml = to_junit(gate);
  CHECK(xml.find("tests=\"2\" failures=\"1\"") != std::string::npos);
  CHECK(xml.find("classname=\"new &lt;a&gt; &amp; &quot;b&quot; | c against old\"") !=
        std::string::npos);
  CHECK(xml.find("<failure message=") != std::string::npos);
  const std::string page = to_markdown(gate);
  CHECK(page.find("### Worse: new \\<a> & \"b\" \\| c against old") == 0);
  CHECK(page.find("| all tasks | worse | 25.0 % | 83.3 % | +58.3 | +40.0 | +70.0 | 288 |") !=
        std::string::npos);
  CHECK(to_json(gate)["rows"][0]["verdict"] == "worse");
}

// Made-up runs of 96 starts with three seeds, 200 of each kind: policies whose chances differ by
// start, three that are alike or differ by less than is allowed, three that are worse.
TEST_CASE("the gate errs as stated over made-up regressions and null cases") {
  struct Kind {
    std::string name;
    double drop, allow;
    bool is_null;
  };
  for (const Kind& kind : {Kind{"alike", 0, 0, true}, Kind{"alike, 2 % allowed", 0, 0.02, true},
                          Kind{"5 % worse, 5 % allowed", 0.05, 0.05, true},
                          Kind{"15 % worse, 2 % allowed", 0.15, 0.02, false},
                          Kind{"25 % worse, 2 % allowed", 0.25, 0.02, false},
                          Kind{"40 % worse, 5 % allowed", 0.40, 0.05, false}}) {
    std::mt19937 bits(3);
    std::uniform_real_distribution<double> share(0, 1);
    int worse = 0;
    for (int run = 0; run < 200; ++run) {
      Benchmark benchmark;
      benchmark.metrics = {{"success", true, 1}};
      benchmark.policies.resize(2);
      for (int t = 0; t < 4; ++t) {
        Task task;
        task.metrics = {0};
        for (int s = 0; s < 24; ++s) {
          StartPlace place;
          place.cluster = static_cast<std::uint32_t>(24 * t + s);
          task.starts.push_back(place);
        }
        benchmark.tasks.push_back(task);
      }
      for (int t = 0; t < 4; ++t) {
        for (int s = 0; s < 24; ++s) {
          const double before = kind.drop + (1 - kind.drop) * share(bits);
          for (int policy = 0; policy < 2; ++policy) {
            for (int seed = 0; seed < 3; ++seed) {
              Episode e;
              e.policy = policy;
              e.task = t;
              e.start = s;
              e.seed = seed;
              e.truths.set(0, share(bits) < (policy == 0 ? before - kind.drop : before));
              benchmark.episodes.push_back(e);
            }
          }
        }
      }
      index_episodes(benchmark);
      const auto result = gate(benchmark, {.allow = kind.allow});
      REQUIRE(result.ok());
      worse += result->is_worse() ? 1 : 0;
    }
    MESSAGE(kind.name << ": called worse " << worse << " of 200");
    if (kind.is_null) {
      CHECK(worse <= 10);
    } else if (kind.drop >= 0.25) {
      CHECK(worse >= 190);
    }
  }
}

}  // namespace probe::report
